// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/gdal/access.hpp>

/// How values of the library cross the border to Python and back. Rasters and vectors of numbers are shown as arrays
/// without copying; records (structs) are held as they are.
namespace thalweg::python {

namespace py = pybind11;

/// Where a value stands, for messages: "surface.diffuse", "sigma_cells".
struct Place {
    std::string function;
    std::string name;
    std::string within = {}; ///< "params: " of a field of the argument params

    /// \return the name with what it is within: "params: sigma_cells"
    std::string whole() const { return within + name; }

    /// \return the place of an element
    Place of(std::size_t element) const;
    /// \return the place of a field
    Place of(char const* field) const;
};

/// \throws TypeError "FUNCTION: NAME is VALUE; it must be WANTED"
[[noreturn]] void refuse_type(Place const& place, py::handle value, std::string const& wanted);

/// The words of an enumeration, by value; specialised in the generated files.
template <class Enum> struct Words;

/// How a record is made from its fields, if it can be; specialised in the generated files.
template <class Record> struct Fields;

template <class T> struct is_vector : std::false_type {};
template <class T, class A> struct is_vector<std::vector<T, A>> : std::true_type {};
template <class T> struct is_array : std::false_type {};
template <class T, std::size_t N> struct is_array<std::array<T, N>> : std::true_type {};
template <class T> struct is_optional : std::false_type {};
template <class T> struct is_optional<std::optional<T>> : std::true_type {};
template <class T> struct is_required : std::false_type {};
template <class T> struct is_required<Required<T>> : std::true_type {
    using type = T;
};
template <class T> struct is_raster : std::false_type {};
template <class T> struct is_raster<Raster<T>> : std::true_type {};
template <class T> struct is_pair : std::false_type {};
template <class A, class B> struct is_pair<std::pair<A, B>> : std::true_type {};
template <class T> struct is_map : std::false_type {};
template <class K, class V> struct is_map<std::map<K, V>> : std::true_type {};
template <class T> struct is_variant : std::false_type {};
template <class... T> struct is_variant<std::variant<T...>> : std::true_type {};
template <class T> struct is_span : std::false_type {};
template <class T, std::size_t N> struct is_span<std::span<T, N>> : std::true_type {};
template <class T> struct is_function : std::false_type {};
template <class R, class... A> struct is_function<std::function<R(A...)>> : std::true_type {};

template <class T>
concept Text = std::same_as<T, std::string> || std::same_as<T, std::string_view> || std::same_as<T, char const*>;

/// Numbers of which an element of an array consists: count of them, 1 for a number itself.
template <class T> struct Numbers {
    using type = void;
    static constexpr std::size_t count = 0;
};
template <class T>
    requires(std::is_arithmetic_v<T> && !std::same_as<T, bool>)
struct Numbers<T> {
    using type = T;
    static constexpr std::size_t count = 1;
};
template <> struct Numbers<Vec2> {
    using type = double;
    static constexpr std::size_t count = 2;
};
template <> struct Numbers<Vec3> {
    using type = double;
    static constexpr std::size_t count = 3;
};
template <> struct Numbers<Cell> {
    using type = std::int64_t;
    static constexpr std::size_t count = 2;
};
template <class T, std::size_t N>
    requires(std::is_arithmetic_v<T>)
struct Numbers<std::array<T, N>> {
    using type = T;
    static constexpr std::size_t count = N;
};

/// What numpy calls numbers of C++: size_t, of which the greatest means none, becomes int64 with -1; char uint8.
template <class T>
using InNumpy = std::conditional_t<std::same_as<T, char>, std::uint8_t,
                                   std::conditional_t<std::same_as<T, std::size_t>, std::int64_t, T>>;

/// Everything else that is a struct: held by Python as it is.
template <class T>
concept Record = std::is_class_v<T> && !Text<T> && !is_vector<T>::value && !is_array<T>::value &&
                 !is_optional<T>::value && !is_required<T>::value && !is_raster<T>::value && !is_pair<T>::value &&
                 !is_map<T>::value && !is_variant<T>::value && !is_span<T>::value && !is_function<T>::value &&
                 Numbers<T>::count == 0 && !std::same_as<T, Finding> && !std::same_as<T, Check> &&
                 !std::same_as<T, io::Source> && !std::same_as<T, std::monostate>;

/// A read-only array over memory of the owner.
/// \param shape one number, or two: rows and numbers a row
py::array array_of(py::dtype const& type, std::vector<py::ssize_t> shape, void const* memory, py::handle owner);

/// thalweg.Raster over such an array.
py::object raster_of(py::array const& values, Grid const& grid);

py::object dict_of(Finding const& finding);
py::object dict_of(Check const& check);
py::object text_of(std::string_view bytes);

// -- From C++ to Python
// -------------------------------------------------------------------------------------------------

template <class T> py::object give(T value);

/// Shows a value that lives in owner.
template <class T> py::object show(T const& value, py::handle owner) {
    if constexpr (std::same_as<T, bool> || std::is_arithmetic_v<T>) {
        if constexpr (std::same_as<T, std::size_t>) {
            // the greatest stands for none; a seed is any other
            return value == std::numeric_limits<T>::max() ? py::int_(-1) : py::int_(value);
        } else if constexpr (std::same_as<T, char>) {
            return py::int_(static_cast<int>(value));
        } else {
            return py::cast(value);
        }
    } else if constexpr (std::is_enum_v<T>) {
        return py::str(Words<T>::of(value));
    } else if constexpr (std::same_as<T, char const*>) {
        return text_of(value == nullptr ? "" : value);
    } else if constexpr (Text<T>) {
        return text_of(value);
    } else if constexpr (std::same_as<T, Finding> || std::same_as<T, Check>) {
        return dict_of(value);
    } else if constexpr (std::same_as<T, io::Source>) {
        return text_of(value.path);
    } else if constexpr (std::same_as<T, std::monostate>) {
        return py::none();
    } else if constexpr (is_required<T>::value) {
        return show(static_cast<typename is_required<T>::type const&>(value), owner);
    } else if constexpr (std::same_as<T, Vec2>) {
        return py::make_tuple(value.x, value.y);
    } else if constexpr (std::same_as<T, Vec3>) {
        return py::make_tuple(value.x, value.y, value.z);
    } else if constexpr (std::same_as<T, Cell>) {
        return py::make_tuple(value.col, value.row);
    } else if constexpr (is_optional<T>::value) {
        return value ? show(*value, owner) : py::object(py::none());
    } else if constexpr (is_raster<T>::value) {
        using Value = std::remove_cvref_t<decltype(value.values()[0])>;
        if (value.cells() == 0) {
            return py::none();
        }
        if constexpr (std::same_as<Value, std::uint32_t>) { // counts: numpy's unsigned numbers wrap in differences
            Raster<std::int64_t> counts(value.grid());
            std::ranges::copy(value.values(), counts.values().begin());
            return give(std::move(counts));
        } else if constexpr (std::is_enum_v<Value>) {
            return raster_of(
                array_of(py::dtype::of<std::uint8_t>(), {value.height(), value.width()}, value.values().data(), owner),
                value.grid());
        } else {
            return raster_of(
                array_of(py::dtype::of<Value>(), {value.height(), value.width()}, value.values().data(), owner),
                value.grid());
        }
    } else if constexpr (is_vector<T>::value) {
        using Element = typename T::value_type;
        constexpr std::size_t count = Numbers<Element>::count;
        if constexpr (count > 0) {
            using Number = InNumpy<typename Numbers<Element>::type>;
            std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(value.size())};
            if constexpr (count > 1) {
                shape.push_back(count);
            }
            return array_of(py::dtype::of<Number>(), shape, value.data(), owner);
        } else if constexpr (is_pair<Element>::value) {
            if constexpr (Text<typename Element::first_type>) { // timings: by name
                py::dict dict;
                for (auto const& [name, one] : value) {
                    dict[text_of(name)] = show(one, owner);
                }
                return dict;
            } else {
                py::list list;
                for (auto const& [first, second] : value) {
                    list.append(py::make_tuple(show(first, owner), show(second, owner)));
                }
                return list;
            }
        } else {
            py::list list(value.size());
            for (std::size_t i = 0; i < value.size(); ++i) {
                list[i] = show(value[i], owner);
            }
            return list;
        }
    } else if constexpr (is_array<T>::value || is_span<T>::value) {
        py::tuple tuple(value.size());
        for (std::size_t i = 0; i < value.size(); ++i) {
            tuple[i] = show(value[i], owner);
        }
        return tuple;
    } else if constexpr (is_pair<T>::value) {
        return py::make_tuple(show(value.first, owner), show(value.second, owner));
    } else if constexpr (is_map<T>::value) {
        py::dict dict;
        for (auto const& [key, one] : value) {
            if constexpr (std::same_as<std::remove_cvref_t<decltype(key)>, char>) {
                dict[py::str(std::string(1, key))] = show(one, owner);
            } else {
                dict[show(key, owner)] = show(one, owner);
            }
        }
        return dict;
    } else if constexpr (is_variant<T>::value) {
        return std::visit([&](auto const& one) { return show(one, owner); }, value);
    } else if constexpr (std::is_pointer_v<T>) {
        return value == nullptr ? py::object(py::none()) : show(*value, owner);
    } else {
        return owner ? py::cast(&value, py::return_value_policy::reference_internal, owner)
                     : py::cast(value, py::return_value_policy::copy);
    }
}

/// Hands a result over to Python.
template <class T> py::object give(T value) {
    if constexpr (is_variant<T>::value) {
        return std::visit([](auto& one) { return give(std::move(one)); }, value);
    } else if constexpr (Record<T>) {
        return py::cast(std::move(value));
    } else if constexpr (is_optional<T>::value) {
        return value ? give(std::move(*value)) : py::object(py::none());
    } else if constexpr (is_raster<T>::value || is_vector<T>::value) {
        T* const held = new T(std::move(value));
        py::capsule const owner(held, [](void* memory) { delete static_cast<T*>(memory); });
        return show(*held, owner);
    } else {
        return show(value, py::handle());
    }
}

// -- From Python to C++
// -------------------------------------------------------------------------------------------------

bool take_bool(py::handle value, Place const& place);
double take_number(py::handle value, Place const& place);
/// \throws TypeError where it is no whole number from low to high
std::int64_t take_whole(py::handle value, Place const& place, std::int64_t low, std::int64_t high);
std::uint64_t take_seed(py::handle value, Place const& place);
/// A text, or a path.
std::string take_text(py::handle value, Place const& place);
/// \throws BadParameter with the words there are, and the nearest
std::size_t take_word(py::handle value, Place const& place, std::span<char const* const> words);
/// An array of numbers, C-contiguous; count: numbers a row, 1 for one dimension.
/// \throws TypeError for another shape, for numbers of another kind, or values that the type cannot hold
py::array take_array(py::handle value, Place const& place, py::dtype const& type, std::size_t count);
/// \return {values, grid}: a C-contiguous array of two dimensions
std::pair<py::array, Grid> take_raster(py::handle value, Place const& place, py::dtype const& type);
/// \throws BadInput naming the first cell whose value is none of the codes
void require_codes(py::array const& values, Place const& place, std::vector<int> const& codes);
/// Keeps an object of Python alive; may be let go in any thread.
std::shared_ptr<void const> kept_alive(py::object object);
Finding take_finding(py::handle value, Place const& place);
std::vector<py::object> take_list(py::handle value, Place const& place);
/// \throws TypeError when it is no dictionary
py::dict take_dict(py::handle value, Place const& place);

class Args;

template <class T> T take(py::handle value, Place const& place);

/// A record given, or made for the call.
template <class T> class Held {
public:
    Held(py::handle value, Place const& place) {
        if (py::isinstance<T>(value)) {
            given_ = &value.cast<T const&>();
        } else {
            made_.emplace(take<T>(value, place));
            given_ = &*made_;
        }
    }
    T const& operator*() const { return *given_; }

private:
    std::optional<T> made_;
    T const* given_ = nullptr;
};

/// The arguments of a call.
class Args {
public:
    /// \param within as in Place
    Args(std::string function, py::args positional, py::kwargs named, std::string within = {});
    Args(Args const&) = delete;
    Args& operator=(Args const&) = delete;
    ~Args();

    /// One form of an overloaded function.
    struct Form {
        std::vector<char const*> parameters;
        std::size_t required = 0; ///< the first of them have no default
        std::vector<char const*> keywords;
        bool runs = false; ///< it takes threads, progress, log, device too
        std::function<bool(Args&)> types = {};
    };
    /// \return the form that is meant
    std::size_t choose(std::vector<Form> const& forms);
    /// An argument without taking it; null: not given.
    py::handle peek(std::size_t position, char const* name) const;

    /// The grid of the call's first raster; None: it has none.
    py::object frame() const;

    /// The next argument, by position or name; null: not given.
    py::handle next(char const* name);
    /// \throws TypeError when it is not given
    py::handle required(char const* name);
    /// \throws TypeError when it is not given, or None
    py::handle required_value(char const* name);
    /// An argument that is given by its name alone; null: not given.
    py::handle named(char const* name);
    py::handle required_by_name(char const* name);
    Place place(char const* name) const { return {function_, name, within_}; }
    std::string const& function() const { return function_; }

    template <class T> void option(char const* name, T& target) {
        if (py::handle const value = named(name)) {
            target = take<T>(value, place(name));
        }
    }
    template <class T> void field(char const* name, T& target) {
        if (py::handle const value = next(name)) {
            target = take<T>(value, place(name));
        }
    }

    /// \throws TypeError when something was given that nobody asked for
    void done() const;

    /// Runs a stage in a thread of its own, while this one looks for Ctrl-C.
    /// \throws what the stage, or a function that it called back, throws
    template <class Stage> py::object run(Stage const& stage) {
        using Result = std::invoke_result_t<Stage const&, Run const&>;
        if constexpr (std::is_void_v<Result>) {
            work([&](Run const& run) { stage(run); });
            return py::none();
        } else {
            std::optional<std::remove_cvref_t<Result>> result;
            work([&](Run const& run) { result.emplace(stage(run)); });
            return give(std::move(*result));
        }
    }
    /// Calls a function that is soon done.
    template <class Quick> py::object call(Quick const& quick) {
        done();
        using Result = std::invoke_result_t<Quick const&>;
        if constexpr (std::is_void_v<Result>) {
            py::gil_scoped_release const others;
            quick();
        } else {
            std::optional<std::remove_cvref_t<Result>> result;
            {
                py::gil_scoped_release const others;
                result.emplace(quick());
            }
            return give(std::move(*result));
        }
        return py::none();
    }

private:
    void work(std::function<void(Run const&)> const& stage);

    friend std::string take_text(py::handle value, Place const& place);

    std::string function_;
    std::string within_;
    Args* outer_;      ///< the call in whose arguments this one's are
    bool takes_files_; ///< a table or raster may stand for a file that is read during the call
    py::list files_;   ///< of tables and rasters given instead of names
    py::args positional_;
    py::kwargs named_;
    std::size_t next_ = 0;
    std::vector<std::string> asked_;
};

template <class T> T take(py::handle value, Place const& place) {
    if constexpr (std::same_as<T, bool>) {
        return take_bool(value, place);
    } else if constexpr (std::same_as<T, std::uint64_t>) { // size_t too: -1 stands for none
        return take_seed(value, place);
    } else if constexpr (std::is_floating_point_v<T>) {
        return static_cast<T>(take_number(value, place));
    } else if constexpr (std::is_integral_v<T>) {
        return static_cast<T>(take_whole(value, place, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
    } else if constexpr (std::is_enum_v<T>) {
        return Words<T>::values[take_word(value, place, Words<T>::names)];
    } else if constexpr (Text<T>) {
        static_assert(std::same_as<T, std::string>);
        return take_text(value, place);
    } else if constexpr (std::same_as<T, Finding>) {
        return take_finding(value, place);
    } else if constexpr (std::same_as<T, io::Source>) {
        return io::Source(take_text(value, place));
    } else if constexpr (is_required<T>::value) {
        return T(take<typename is_required<T>::type>(value, place));
    } else if constexpr (is_optional<T>::value) {
        if (value.is_none()) {
            return std::nullopt;
        }
        return take<typename T::value_type>(value, place);
    } else if constexpr (is_raster<T>::value) {
        using Value = std::remove_cvref_t<decltype(std::declval<T const&>().values()[0])>;
        if (value.is_none()) {
            return T();
        }
        using Number = std::conditional_t<std::is_enum_v<Value>, std::uint8_t, Value>;
        auto [values, grid] = take_raster(value, place, py::dtype::of<Number>());
        if constexpr (std::is_enum_v<Value>) {
            std::vector<int> codes;
            for (Value const one : Words<Value>::values) {
                codes.push_back(static_cast<int>(one));
            }
            require_codes(values, place, codes);
        }
        std::span<Value const> const cells(static_cast<Value const*>(values.data()),
                                           static_cast<std::size_t>(values.size()));
        if constexpr (std::is_enum_v<Value>) { // codes were checked: they stay as they are
            T own(std::move(grid));
            std::copy(cells.begin(), cells.end(), own.values().begin());
            return own;
        }
        return T::view_of(std::move(grid), cells, kept_alive(values));
    } else if constexpr (std::same_as<T, Vec2> || std::same_as<T, Vec3> || std::same_as<T, Cell> ||
                         (is_array<T>::value && Numbers<T>::count > 0)) {
        using Number = typename Numbers<T>::type;
        py::array const numbers = take_array(value, place, py::dtype::of<InNumpy<Number>>(), 1);
        if (static_cast<std::size_t>(numbers.size()) != Numbers<T>::count) {
            refuse_type(place, value, std::to_string(Numbers<T>::count) + " numbers");
        }
        T result{};
        std::memcpy(&result, numbers.data(), sizeof(T));
        return result;
    } else if constexpr (is_vector<T>::value) {
        using Element = typename T::value_type;
        constexpr std::size_t count = Numbers<Element>::count;
        if constexpr (count > 0) {
            using Number = InNumpy<typename Numbers<Element>::type>;
            static_assert(sizeof(Element) == count * sizeof(Number));
            py::array const numbers = take_array(value, place, py::dtype::of<Number>(), count);
            T result(static_cast<std::size_t>(numbers.shape(0)));
            if (!result.empty()) {
                std::memcpy(static_cast<void*>(result.data()), numbers.data(), result.size() * sizeof(Element));
            }
            return result;
        } else {
            T result;
            std::size_t number = 0;
            for (py::object const& one : take_list(value, place)) {
                result.push_back(take<Element>(one, place.of(number++)));
            }
            return result;
        }
    } else if constexpr (is_array<T>::value) {
        T result{};
        std::vector<py::object> const list = take_list(value, place);
        if (list.size() != result.size()) {
            refuse_type(place, value, std::to_string(result.size()) + " values");
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            result[i] = take<typename T::value_type>(list[i], place.of(i));
        }
        return result;
    } else if constexpr (is_pair<T>::value) {
        std::vector<py::object> const list = take_list(value, place);
        if (list.size() != 2) {
            refuse_type(place, value, "two values");
        }
        return {take<typename T::first_type>(list[0], place.of(std::size_t{0})),
                take<typename T::second_type>(list[1], place.of(std::size_t{1}))};
    } else if constexpr (is_map<T>::value) {
        T result;
        for (auto const& [key, one] : take_dict(value, place)) {
            std::string const name = take_text(key, place);
            if constexpr (std::same_as<typename T::key_type, char>) {
                if (name.size() != 1) {
                    refuse_type(place, key, "one letter");
                }
                result[name[0]] = take<typename T::mapped_type>(one, place.of(name.c_str()));
            } else {
                result[name] = take<typename T::mapped_type>(one, place.of(name.c_str()));
            }
        }
        return result;
    } else if constexpr (is_variant<T>::value) {
        // of attributes: None, a whole number, a number or a text
        if (value.is_none()) {
            return std::monostate();
        }
        if (py::isinstance<py::str>(value)) {
            return take_text(value, place);
        }
        return py::isinstance<py::int_>(value) ? T(take<std::int64_t>(value, place)) : T(take_number(value, place));
    } else if constexpr (is_function<T>::value) {
        if (value.is_none()) {
            return T();
        }
        if (!PyCallable_Check(value.ptr())) {
            refuse_type(place, value, "a function");
        }
        return value.cast<T>();
    } else {
        if (py::isinstance<T>(value)) {
            return value.cast<T const&>();
        }
        return Fields<T>::take(value, place);
    }
}

/// Checks what Python made of its parts before a stage relies on it; by_hand.hpp has more of these.
/// \throws BadInput naming what does not fit together
template <class T> void require_sound(T const& /*made*/) {}

/// Whether an argument is given and of a type.
template <class T> bool is_given(py::handle value) {
    return value && py::isinstance<T>(value);
}

/// A record from a dictionary of its fields, or where its only field is a raster from that.
template <class T> T take_record(py::handle value, Place const& place) {
    if constexpr (Fields<T>::can_be_made) {
        if (py::isinstance<py::dict>(value)) {
            Args in(place.function, py::args(), py::kwargs(py::reinterpret_borrow<py::kwargs>(value)),
                    place.whole() + ": ");
            return Fields<T>::made(in);
        }
        if constexpr (Fields<T>::is_raster) {
            return T{take<Raster<float>>(value, place)};
        }
    }
    refuse_type(place, value, std::string("a ") + Fields<T>::name);
}

// -- Declarations
// -------------------------------------------------------------------------------------------------------

using Call = py::object (*)(Args&);
using Getter = py::object (*)(py::object const&);

/// Adds a function to a module.
void add_function(py::handle module, char const* name, char const* words, Call call);
/// Adds a method of its own kind: what Python calls with the object first.
void add_method(py::handle type, char const* name, char const* words,
                py::object (*call)(py::object const&, py::args, py::kwargs));
void add_getter(py::handle type, char const* name, char const* words, Getter getter);
/// Adds repr, as_dict and the names of the fields.
void finish_record(py::handle type, std::initializer_list<char const*> fields);
void add_equality(py::handle type, bool (*equal)(py::object const&, py::object const&));
void add_init(py::handle type, char const* words, void* (*make)(Args&));
/// Stops every call and waits for their threads, when the interpreter ends.
void stop_all_calls();

template <class T, auto Member> py::object get(py::object const& self) {
    return show(self.cast<T const&>().*Member, self);
}

template <class T> void* make_record(Args& in) {
    T made = Fields<T>::made(in);
    return new T(std::move(made));
}

template <class T> py::class_<T> add_record(py::handle scope, char const* name, char const* words, char const* module) {
    py::class_<T> type(scope, name, words);
    type.attr("__module__") = module;
    if constexpr (Fields<T>::can_be_made) {
        add_init(type, Fields<T>::signature, &make_record<T>);
    }
    if constexpr (std::equality_comparable<T>) {
        add_equality(type, [](py::object const& one, py::object const& other) {
            return py::isinstance<T>(other) && one.cast<T const&>() == other.cast<T const&>();
        });
    }
    return type;
}

} // namespace thalweg::python
