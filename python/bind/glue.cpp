// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "glue.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>

namespace thalweg::python {

namespace {

constexpr std::array<char const*, 4> run_names = {"threads", "progress", "log", "device"};

/// A value as a message shows it.
std::string shown(py::handle value) {
    std::string text;
    try {
        text = py::isinstance<py::array>(value)
                   ? fmt::format("an array of {} with shape {}", std::string(py::str(value.attr("dtype"))),
                                 std::string(py::str(value.attr("shape"))))
                   : std::string(py::repr(value));
    } catch (py::error_already_set const&) {
        text = "something that cannot be shown";
    }
    return text.size() > 80 ? fmt::format("{}... ({})", text.substr(0, 60),
                                          std::string(py::str(py::type::of(value).attr("__name__"))))
                            : text;
}

/// The names of arguments for which a table or a raster may be given, too.
constexpr std::array<std::string_view, 9> of_files = {"path",   "source", "dem",  "network",   "rivers",
                                                      "target", "mask",   "keep", "breaklines"};

/// A text, or "?" where it is none, or none that UTF-8 can hold.
std::string text_or_nothing(py::handle value) {
    char const* const text = PyUnicode_Check(value.ptr()) != 0 ? PyUnicode_AsUTF8(value.ptr()) : nullptr;
    PyErr_Clear();
    return text == nullptr ? "?" : text;
}

thread_local Args* current = nullptr; ///< the call whose arguments are taken

[[noreturn]] void raise(PyObject* type, std::string const& words) {
    PyErr_SetString(type, words.c_str());
    throw py::error_already_set();
}

/// Whether the interpreter ends or has ended: a thread that asks for its lock then would be ended in the middle.
bool is_at_end() {
#if PY_VERSION_HEX >= 0x030d0000
    return Py_IsInitialized() == 0 || Py_IsFinalizing() != 0;
#else
    return Py_IsInitialized() == 0 || _Py_IsFinalizing() != 0;
#endif
}

/// A whole number of Python's.
/// \throws TypeError that it must be WANTED
py::object index_of(py::handle value, Place const& place, std::string const& wanted) {
    py::object index;
    if (!py::isinstance<py::bool_>(value) && PyIndex_Check(value.ptr()) != 0) {
        index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
        PyErr_Clear();
    }
    if (!index) {
        refuse_type(place, value, wanted);
    }
    return index;
}

py::object from_package(char const* module, char const* name) {
    return py::module_::import(module).attr(name);
}

/// Calls a function of the package; what it refuses names the function that was called.
template <class Call> py::object in_package(Place const& place, Call const& call) {
    try {
        return call();
    } catch (py::error_already_set& fault) {
        if (py::hasattr(fault.value(), "where")) {
            fault.value().attr("where") = place.function;
        }
        throw;
    }
}

/// The grid of a raster, or of a record whose first field is one; None: it is neither.
py::object grid_of(py::handle value) {
    py::object const raster = from_package("thalweg._raster", "Raster");
    if (py::isinstance(value, raster)) {
        return value.attr("grid");
    }
    if (py::hasattr(py::type::of(value), "_fields") && py::len(py::type::of(value).attr("_fields")) > 0) {
        py::object const first = value.attr(py::object(py::type::of(value).attr("_fields")[py::int_(0)]));
        if (py::isinstance(first, raster)) {
            return first.attr("grid");
        }
    }
    return py::none();
}

} // namespace

Place Place::of(std::size_t element) const {
    return {function, fmt::format("{}[{}]", name, element), within};
}

Place Place::of(char const* field) const {
    return {function, fmt::format("{}.{}", name, field), within};
}

void refuse_type(Place const& place, py::handle value, std::string const& wanted) {
    raise(PyExc_TypeError,
          fmt::format("{}: {} is {}; it must be {}", place.function, place.whole(), shown(value), wanted));
}

py::array array_of(py::dtype const& type, std::vector<py::ssize_t> shape, void const* memory, py::handle owner) {
    bool const is_empty = std::find(shape.begin(), shape.end(), 0) != shape.end();
    // pybind11 copies where there is no owner, and memory of nothing has none.
    py::array array = is_empty || !owner ? py::array(type, std::move(shape), is_empty ? nullptr : memory)
                                         : py::array(type, std::move(shape), memory, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

py::object raster_of(py::array const& values, Grid const& grid) {
    return from_package("thalweg._raster", "from_core")(values, py::cast(grid, py::return_value_policy::copy));
}

py::object text_of(std::string_view bytes) {
    std::string const text = as_utf8(bytes);
    return py::str(text);
}

py::object dict_of(Finding const& finding) {
    py::dict dict;
    FindingRow const& row = finding.kind.row();
    dict["kind"] = text_of(row.kind);
    dict["severity"] = name_of(row.severity);
    dict["feature"] = finding.feature;
    dict["where"] =
        is_finite(finding.where) ? py::object(py::make_tuple(finding.where.x, finding.where.y)) : py::none();
    dict["amount"] = finding.amount;
    dict["unit"] = text_of(row.unit);
    dict["text"] = text_of(finding.text);
    dict["remedy"] = text_of(remedy_of(finding));
    dict["key"] = text_of(finding.key);
    dict["layer"] = text_of(finding.layer);
    py::dict numbers;
    for (FindingNumber const& number : finding.numbers) {
        numbers[py::str(number.name)] = py::make_tuple(number.value, text_of(number.unit));
    }
    dict["numbers"] = numbers;
    return dict;
}

py::object dict_of(Check const& check) {
    py::dict dict;
    dict["name"] = text_of(check.name);
    dict["value"] = check.value;
    dict["limit"] = check.limit;
    dict["ok"] = check.ok;
    dict["bound"] = word_of(check.bound);
    return dict;
}

Finding take_finding(py::handle value, Place const& place) {
    py::dict const dict = py::reinterpret_steal<py::dict>(PyDict_Copy(take_dict(value, place).ptr()));
    for (char const* const of_kind : {"severity", "unit"}) {
        dict.attr("pop")(of_kind, py::none());
    }
    py::dict const numbers = dict.attr("pop")("numbers", py::dict());
    if (dict.contains("where") && dict["where"].is_none()) {
        dict.attr("pop")("where");
    }
    Args in(place.function, py::args(), py::kwargs(py::reinterpret_borrow<py::kwargs>(dict)), place.whole() + ": ");
    std::string kind;
    in.option("kind", kind);
    Finding finding{FindingKind::named(kind)};
    for (auto const& [name, number] : numbers) {
        auto const [amount, unit] = number.cast<std::pair<double, std::string>>();
        finding.numbers.push_back({name.cast<std::string>(), amount, unit});
    }
    in.option("remedy", finding.remedy);
    in.option("key", finding.key);
    in.option("layer", finding.layer);
    in.option("feature", finding.feature);
    in.option("where", finding.where);
    in.option("amount", finding.amount);
    in.option("text", finding.text);
    in.done();
    return finding;
}

bool take_bool(py::handle value, Place const& place) {
    py::object const bool_of_numpy = py::module_::import("numpy").attr("bool_");
    if (!py::isinstance<py::bool_>(value) && !py::isinstance(value, bool_of_numpy)) {
        refuse_type(place, value, "True or False");
    }
    return PyObject_IsTrue(value.ptr()) == 1;
}

double take_number(py::handle value, Place const& place) {
    if (py::isinstance<py::str>(value) || py::isinstance<py::bool_>(value) || PyNumber_Check(value.ptr()) == 0) {
        refuse_type(place, value, "a number");
    }
    double const number = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        refuse_type(place, value, "a number");
    }
    return number;
}

std::int64_t take_whole(py::handle value, Place const& place, std::int64_t low, std::int64_t high) {
    std::string const wanted = high == std::numeric_limits<std::int64_t>::max()
                                   ? "a whole number"
                                   : fmt::format("a whole number from {} to {}", low, high);
    py::object const index = index_of(value, place, wanted);
    int overflow = 0;
    long long const number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0 || number < low || number > high) {
        refuse_type(place, value, wanted);
    }
    return number;
}

std::uint64_t take_seed(py::handle value, Place const& place) {
    py::object const index = index_of(value, place, "a whole number");
    int overflow = 0;
    long long const number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow == 0 && number >= -1) {
        return static_cast<std::uint64_t>(number);
    }
    std::uint64_t const large = PyLong_AsUnsignedLongLong(index.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        refuse_type(place, value, "a whole number from 0 to 2^64 - 1");
    }
    return large;
}

std::string take_text(py::handle value, Place const& place) {
    py::object text = py::reinterpret_borrow<py::object>(value);
    if (place.name == "crs" && place.function != "io.crs_in_words") { // which crs_text calls
        text = in_package(place, [&] { return from_package("thalweg._raster", "crs_text")(value); });
    } else if (!py::isinstance<py::str>(text)) {
        if (py::hasattr(text, "__fspath__")) {
            text = py::module_::import("os").attr("fsdecode")(text);
        } else if (std::find(of_files.begin(), of_files.end(), place.name) != of_files.end() && current != nullptr &&
                   current->takes_files_) {
            text = from_package("thalweg._networks", "path_of")(value, place.name);
            current->files_.append(text);
        } else {
            refuse_type(place, value, "a text");
        }
    }
    return py::module_::import("os").attr("fsencode")(text).cast<std::string>(); // bytes that are not UTF-8 stay
}

std::size_t take_word(py::handle value, Place const& place, std::span<char const* const> words) {
    std::vector<std::string> const known(words.begin(), words.end());
    if (!py::isinstance<py::str>(value)) {
        refuse_type(place, value, fmt::format("one of '{}'", fmt::join(known, "', '")));
    }
    std::string const word = text_or_nothing(value);
    auto const found = std::find(known.begin(), known.end(), word);
    if (found == known.end()) {
        throw BadParameter(place.function, fmt::format("{} is '{}'; it must be one of {}.{}", place.whole(), word,
                                                       fmt::join(known, ", "), did_you_mean(word, known)));
    }
    return static_cast<std::size_t>(found - known.begin());
}

py::array take_array(py::handle value, Place const& place, py::dtype const& type, std::size_t count) {
    std::string const wanted =
        count > 1 ? fmt::format("an array of numbers with shape (n, {})", count) : "an array of numbers";
    py::array numbers;
    try {
        if (py::isinstance<py::str>(value) || py::isinstance<py::dict>(value)) {
            refuse_type(place, value, wanted);
        }
        py::object const numpy = py::module_::import("numpy");
        if (py::isinstance(value, numpy.attr("ma").attr("MaskedArray")) &&
            py::bool_(numpy.attr("any")(value.attr("mask")))) {
            refuse_type(place, value, wanted + " without masked ones");
        }
        numbers = numpy.attr("asarray")(value);
    } catch (py::error_already_set& fault) {
        if (!fault.matches(PyExc_ValueError)) {
            throw;
        }
        refuse_type(place, value, wanted); // rows of unequal lengths
    }
    if (numbers.size() == 0) {
        return py::array(type, count > 1 ? std::vector<py::ssize_t>{0, static_cast<py::ssize_t>(count)}
                                         : std::vector<py::ssize_t>{0});
    }
    bool const has_shape =
        count > 1 ? numbers.ndim() == 2 && numbers.shape(1) == static_cast<py::ssize_t>(count) : numbers.ndim() == 1;
    char const kind = numbers.dtype().kind();
    bool const is_real = type.kind() == 'f';
    if (!has_shape || !(kind == 'i' || kind == 'u' || kind == 'b' || (is_real && kind == 'f'))) {
        refuse_type(place, value, wanted + (is_real ? "" : " that are whole"));
    }
    if (kind == 'b' && !is_real && type.itemsize() > 1) { // 0 and 1 would be taken for numbers of arcs or cells
        refuse_type(place, value, "an array of whole numbers, not a mask: np.flatnonzero(mask) gives its numbers");
    }
    py::object const numpy = py::module_::import("numpy");
    if (!is_real && kind != 'b') {
        py::object const range = numpy.attr("iinfo")(type);
        if (numbers.attr("min")() < range.attr("min") || numbers.attr("max")() > range.attr("max")) {
            refuse_type(place, value,
                        fmt::format("numbers from {} to {}", std::string(py::str(range.attr("min"))),
                                    std::string(py::str(range.attr("max")))));
        }
    }
    return numpy.attr("ascontiguousarray")(numbers, py::arg("dtype") = type);
}

namespace {

/// Whether a function belongs to a module of the program, which says units itself.
bool is_of_program(std::string_view function) {
    constexpr std::string_view modules[] = {"recipe.", "terrain.", "report.", "export.", "members.", "commands."};
    return std::ranges::any_of(modules, [&](std::string_view module) { return function.starts_with(module); });
}

} // namespace

std::pair<py::array, Grid> take_raster(py::handle value, Place const& place, py::dtype const& type) {
    // A plain array has the frame of the other rasters of the call.
    bool const has_place =
        !py::hasattr(value, "__array__") || py::hasattr(value, "grid") || py::hasattr(value, "coords");
    py::object const frame = has_place || current == nullptr ? py::none() : current->frame();
    py::object const raster =
        in_package(place, [&] { return from_package("thalweg._raster", "to_core")(value, type, place.name, frame); });
    auto values = py::cast<py::array>(raster.attr("values"));
    Grid grid = raster.attr("grid").cast<Grid>();
    if (values.ndim() != 2 || !values.dtype().equal(type) || (values.flags() & py::array::c_style) == 0) {
        refuse_type(place, value, "a raster");
    }
    if (values.shape(0) != grid.height || values.shape(1) != grid.width) {
        throw BadInput(place.function, fmt::format("{} has {} x {} values, and its grid {} x {} cells", place.whole(),
                                                   values.shape(1), values.shape(0), grid.width, grid.height));
    }
    if (type.kind() == 'f' && !grid.crs.empty() && place.function.find("io.") != 0 && !is_of_program(place.function)) {
        from_package("thalweg._raster", "say_unit")(grid.crs, place.name);
    }
    return {std::move(values), std::move(grid)};
}

void require_codes(py::array const& values, Place const& place, std::vector<int> const& codes) {
    py::object const numpy = py::module_::import("numpy");
    py::list list;
    for (int const code : codes) {
        list.append(code);
    }
    py::object const known = numpy.attr("isin")(values, list);
    if (!py::bool_(known.attr("all")())) {
        py::object const at = numpy.attr("argwhere")(numpy.attr("logical_not")(known)).attr("__getitem__")(0);
        throw BadInput(place.function,
                       fmt::format("{} is {} in row {}, column {} (from 0), which is no code of it; they are {}",
                                   place.whole(), std::string(py::str(values.attr("__getitem__")(py::tuple(at)))),
                                   std::string(py::str(at.attr("__getitem__")(0))),
                                   std::string(py::str(at.attr("__getitem__")(1))), fmt::join(codes, ", ")));
    }
}

std::shared_ptr<void const> kept_alive(py::object object) {
    PyObject* const pointer = object.release().ptr();
    return {pointer, [](void const* kept) {
                if (!is_at_end()) {
                    py::gil_scoped_acquire const held;
                    Py_DECREF(static_cast<PyObject*>(const_cast<void*>(kept)));
                }
            }};
}

std::vector<py::object> take_list(py::handle value, Place const& place) {
    if (py::isinstance<py::dict>(value)) { // as lists of a name and a value are shown
        return take_list(py::list(value.attr("items")()), place);
    }
    if (py::isinstance<py::str>(value) || py::isinstance<py::bytes>(value) || !py::isinstance<py::iterable>(value)) {
        refuse_type(place, value, "a list");
    }
    std::vector<py::object> list;
    for (py::handle const one : value) {
        list.push_back(py::reinterpret_borrow<py::object>(one));
    }
    return list;
}

py::dict take_dict(py::handle value, Place const& place) {
    if (!py::isinstance<py::dict>(value)) {
        refuse_type(place, value, "a dictionary");
    }
    return py::reinterpret_borrow<py::dict>(value);
}

Args::Args(std::string function, py::args positional, py::kwargs named, std::string within)
    : function_(std::move(function)), within_(std::move(within)), outer_(std::exchange(current, this)),
      takes_files_(outer_ != nullptr
                       ? outer_->takes_files_
                       : function_.find('.') != std::string::npos && function_.find(".write_") == std::string::npos &&
                             function_ != "Picture.save"),
      positional_(std::move(positional)), named_(std::move(named)) {}

Args::~Args() {
    current = outer_;
    if (outer_ != nullptr) { // a record in its arguments: they live as long
        auto const end = static_cast<py::ssize_t>(outer_->files_.size());
        PyList_SetSlice(outer_->files_.ptr(), end, end, files_.ptr());
    }
}

py::handle Args::peek(std::size_t position, char const* name) const {
    if (position < positional_.size()) {
        return {PyTuple_GetItem(positional_.ptr(), static_cast<py::ssize_t>(position))};
    }
    return {PyDict_GetItemString(named_.ptr(), name)};
}

std::size_t Args::choose(std::vector<Form> const& forms) {
    auto const binds = [&](Form const& form) {
        if (positional_.size() > form.parameters.size()) {
            return false;
        }
        for (std::size_t i = 0; i < form.required; ++i) {
            if (!peek(i, form.parameters[i])) {
                return false;
            }
        }
        return !form.types || form.types(*this);
    };
    auto const knows_all = [&](Form const& form) {
        return std::all_of(named_.begin(), named_.end(), [&](auto const& given) {
            std::string const name = text_or_nothing(given.first);
            auto const is_in = [&](auto const& names) {
                return std::any_of(names.begin(), names.end(), [&](char const* one) { return name == one; });
            };
            return is_in(form.parameters) || is_in(form.keywords) || (form.runs && is_in(run_names));
        });
    };
    for (std::size_t i = 0; i < forms.size(); ++i) {
        if (binds(forms[i]) && knows_all(forms[i])) {
            return i;
        }
    }
    for (std::size_t i = 0; i < forms.size(); ++i) {
        if (binds(forms[i])) {
            return i;
        }
    }
    return 0;
}

py::object Args::frame() const {
    if (outer_ != nullptr) {
        return outer_->frame();
    }
    for (py::handle const one : positional_) {
        if (py::object grid = grid_of(one); !grid.is_none()) {
            return grid;
        }
    }
    for (auto const& [name, one] : named_) {
        if (py::object grid = grid_of(one); !grid.is_none()) {
            return grid;
        }
    }
    return py::none();
}

py::handle Args::next(char const* name) {
    asked_.emplace_back(name);
    py::handle const by_name(PyDict_GetItemString(named_.ptr(), name));
    if (next_ < positional_.size()) {
        py::handle const value(PyTuple_GetItem(positional_.ptr(), static_cast<py::ssize_t>(next_++)));
        if (by_name) {
            raise(PyExc_TypeError, fmt::format("{}: {}{} is given twice", function_, within_, name));
        }
        return value;
    }
    return by_name;
}

py::handle Args::required(char const* name) {
    py::handle const value = next(name);
    if (!value) {
        raise(PyExc_TypeError, fmt::format("{}: {}{} is missing", function_, within_, name));
    }
    return value;
}

py::handle Args::required_value(char const* name) {
    py::handle const value = required(name);
    if (value.is_none()) {
        refuse_type(place(name), value, "a raster");
    }
    return value;
}

py::handle Args::named(char const* name) {
    asked_.emplace_back(name);
    return {PyDict_GetItemString(named_.ptr(), name)};
}

py::handle Args::required_by_name(char const* name) {
    py::handle const value = named(name);
    if (!value) {
        raise(PyExc_TypeError,
              fmt::format("{}: {}{} is missing; it has no default: give {}=...", function_, within_, name, name));
    }
    return value;
}

void Args::done() const {
    if (next_ < positional_.size()) {
        raise(PyExc_TypeError,
              fmt::format("{}: {}{} arguments are given without their names, and it takes {}; name the others",
                          function_, within_, positional_.size(), next_));
    }
    for (auto const& [key, value] : named_) {
        std::string const name = text_or_nothing(key);
        if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) {
            raise(PyExc_TypeError, fmt::format("{}: {}there is no argument '{}'.{}", function_, within_, name,
                                               did_you_mean(name, asked_)));
        }
    }
}

namespace {

/// The calls that run, so that the end of the interpreter can stop them.
struct Running {
    std::mutex guard;
    std::condition_variable changed;
    std::vector<std::stop_source*> calls;
};

Running& running() {
    static auto* const all = new Running; // threads may outlive static objects
    return *all;
}

/// Keeps a call among those that run, and its thread from being left behind.
class Registered {
public:
    Registered(std::stop_source& stop, std::thread& worker) : stop_(stop), worker_(worker) {
        std::lock_guard const lock(running().guard);
        running().calls.push_back(&stop);
    }
    Registered(Registered const&) = delete;
    Registered& operator=(Registered const&) = delete;
    ~Registered() {
        if (worker_.joinable()) {
            stop_.request_stop();
            worker_.join();
        }
        std::lock_guard const lock(running().guard);
        std::erase(running().calls, &stop_);
        running().changed.notify_all();
    }

private:
    std::stop_source& stop_;
    std::thread& worker_;
};

/// What a stage calls back, in its own threads.
struct Callbacks {
    py::object progress;
    py::object log;
    std::stop_source stop;
    std::mutex guard;
    std::exception_ptr fault; ///< the first that a function of Python raised

    /// \return false: it raised
    bool calls(std::function<void()> const& call) {
        if (is_at_end()) {
            return false;
        }
        py::gil_scoped_acquire const held;
        try {
            call();
            return true;
        } catch (...) {
            std::lock_guard const lock(guard);
            if (!fault) {
                fault = std::current_exception();
            }
            stop.request_stop();
            return false;
        }
    }
};

int tell_progress(double share, char const* what, void* callbacks) {
    auto& all = *static_cast<Callbacks*>(callbacks);
    return all.calls([&] { all.progress(share, what); }) ? 1 : 0;
}

} // namespace

void Args::work(std::function<void(Run const&)> const& stage) {
    Callbacks callbacks;
    Run run;
    option("threads", run.threads);
    if (run.threads < 0 || run.threads > 1024) {
        throw BadParameter(function_,
                           fmt::format("threads is {}; it must be from 0 to 1024, 0 for every core", run.threads));
    }
    if (py::handle const device = named("device")) {
        static constexpr std::array<char const*, 2> devices = {"cpu", "opencl"};
        run.device = static_cast<Device>(take_word(device, place("device"), devices));
    }
    if (py::handle const progress = named("progress"); progress && !progress.is_none()) {
        callbacks.progress = from_package("thalweg._show", "progress_of")(progress);
        if (!callbacks.progress.is_none()) {
            run.progress = tell_progress;
            run.progress_arg = &callbacks;
        }
    }
    if (py::handle const log = named("log"); log && !log.is_none()) {
        if (PyCallable_Check(log.ptr()) == 0) {
            refuse_type(place("log"), log, "a function that takes a line of text, or None");
        }
        callbacks.log = py::reinterpret_borrow<py::object>(log);
        run.log = [&callbacks](std::string_view line) { callbacks.calls([&] { callbacks.log(text_of(line)); }); };
    }
    py::handle const is_stopped = named("_is_stopped"); // of the package itself: signals reach the main thread alone
    done();
    run.stop = callbacks.stop.get_token();

    std::exception_ptr fault;
    std::exception_ptr interrupted;
    std::thread worker;
    Registered const registered(callbacks.stop,
                                worker); // until the lock is held again: who ends the interpreter waits for that
    {
        py::gil_scoped_release const others;
        std::mutex guard;
        std::condition_variable ended;
        bool has_ended = false;
        worker = std::thread([&] {
            try {
                stage(run);
            } catch (...) {
                fault = std::current_exception();
            }
            std::lock_guard const lock(guard);
            has_ended = true;
            ended.notify_one();
        });
        std::unique_lock lock(guard);
        while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return has_ended; })) {
            lock.unlock();
            if (!is_at_end()) {
                py::gil_scoped_acquire const held;
                if (PyErr_CheckSignals() != 0 && !interrupted) {
                    interrupted = std::make_exception_ptr(py::error_already_set());
                    callbacks.stop.request_stop();
                }
                if (is_stopped && py::bool_(is_stopped())) {
                    callbacks.stop.request_stop();
                }
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    for (std::exception_ptr const& one : {interrupted, callbacks.fault, fault}) {
        if (one) {
            std::rethrow_exception(one);
        }
    }
}

void stop_all_calls() {
    py::gil_scoped_release const others;
    std::unique_lock lock(running().guard);
    for (std::stop_source* const call : running().calls) {
        call->request_stop();
    }
    running().changed.wait(lock, [] { return running().calls.empty(); });
}

void add_function(py::handle module, char const* name, char const* words, Call call) {
    std::string const function = module.attr("__name__").cast<std::string>();
    std::string const space = function.substr(function.rfind('.') + 1);
    std::string const where = space == "_core" ? name : space + "." + name;
    module.attr(name) = py::cpp_function(
        [call, where](py::args positional, py::kwargs named) {
            Args in(where, std::move(positional), std::move(named));
            return call(in);
        },
        py::name(name), py::scope(module), py::doc(words));
}

void add_method(py::handle type, char const* name, char const* words,
                py::object (*call)(py::object const&, py::args, py::kwargs)) {
    type.attr(name) = py::cpp_function(call, py::name(name), py::is_method(type), py::scope(type), py::doc(words));
}

void add_getter(py::handle type, char const* name, char const* words, Getter getter) {
    static py::handle const property = reinterpret_cast<PyObject*>(&PyProperty_Type);
    type.attr(name) = property(py::cpp_function(getter, py::is_method(type)), py::none(), py::none(), py::str(words));
}

void add_equality(py::handle type, bool (*equal)(py::object const&, py::object const&)) {
    type.attr("__eq__") = py::cpp_function(equal, py::name("__eq__"), py::is_method(type), py::scope(type));
    type.attr("__hash__") = py::none();
}

void add_init(py::handle type, char const* words, void* (*make)(Args&)) {
    auto const name = type.attr("__name__").cast<std::string>();
    type.attr("__init__") = py::cpp_function(
        [make, name](py::detail::value_and_holder& place, py::args positional, py::kwargs named) {
            Args in(name, std::move(positional), std::move(named));
            place.value_ptr() = make(in);
        },
        py::name("__init__"), py::is_method(type), py::scope(type), py::detail::is_new_style_constructor(),
        py::doc(words));
}

namespace {

py::object repr_of(py::object const& self) {
    std::string text = py::type::of(self).attr("__qualname__").cast<std::string>() + "(";
    bool is_first = true;
    for (py::handle const field : py::type::of(self).attr("_fields")) {
        text += (is_first ? "" : ", ") + field.cast<std::string>() + "=" + shown(self.attr(field));
        is_first = false;
    }
    return py::str(text + ")");
}

/// Records, also in lists, as dictionaries.
py::object plain(py::handle value) {
    if (py::hasattr(py::type::of(value), "_fields")) {
        return value.attr("as_dict")();
    }
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
        py::list list;
        for (py::handle const one : value) {
            list.append(plain(one));
        }
        return list;
    }
    return py::reinterpret_borrow<py::object>(value);
}

py::object dict_of_fields(py::object const& self) {
    py::dict dict;
    for (py::handle const field : py::type::of(self).attr("_fields")) {
        dict[field] = plain(self.attr(field));
    }
    return dict;
}

} // namespace

void finish_record(py::handle type, std::initializer_list<char const*> fields) {
    py::tuple names(fields.size());
    std::size_t number = 0;
    for (char const* const field : fields) {
        names[number++] = py::str(field);
    }
    type.attr("_fields") = names;
    type.attr("__reduce__") = py::cpp_function(
        [](py::object const& self) { return from_package("thalweg._records", "reduced")(self); },
        py::name("__reduce__"), py::is_method(type), py::scope(type), py::doc("Gives what pickle needs."));
    type.attr("__repr__") = py::cpp_function(repr_of, py::name("__repr__"), py::is_method(type), py::scope(type));
    type.attr("as_dict") = py::cpp_function(dict_of_fields, py::name("as_dict"), py::is_method(type), py::scope(type),
                                            py::doc("as_dict(self)\n--\n\nGives the fields as a dictionary, records in "
                                                    "them too.\n\nReturns\n-------\ndict[str, Any]\n"));
}

} // namespace thalweg::python
