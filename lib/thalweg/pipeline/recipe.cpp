// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/core/suggest.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

namespace thalweg::pipeline {

namespace {

using Pair = std::array<double, 2>;
using Value = std::variant<bool, std::int64_t, double, std::string, Pair>;

/// A key, bound to its field. put throws BadParameter with the reason alone; take gives nothing where the value is
/// unset.
struct Key {
    KeyHelp help;
    std::function<void(Recipe&, Value const&)> put;
    std::function<std::optional<Value>(Recipe const&)> take;
    std::string section() const {
        auto const dot = help.path.rfind('.');
        return dot == std::string::npos ? "" : help.path.substr(0, dot);
    }
};

std::string toml_text(Value const& value) {
    toml::table one;
    std::visit(
        [&](auto const& v) {
            if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Pair>) {
                one.insert("v", toml::array{v[0], v[1]});
            } else {
                one.insert("v", v);
            }
        },
        value);
    std::ostringstream out;
    out << one;
    return out.str().substr(std::string_view("v = ").size());
}

struct Range {
    double least;
    double most;
    bool open = false; ///< least itself is not allowed
    bool holds(double v) const { return std::isfinite(v) && (open ? v > least : v >= least) && v <= most; }
    std::string text() const {
        if (most >= 9.0e15) {
            return fmt::format("{} {}", open ? ">" : ">=", least);
        }
        return fmt::format("{}{}, {}]", open ? "(" : "[", least, most);
    }
};

constexpr double endless = 9.0e15;

double as_number(Value const& v) {
    if (auto const* i = std::get_if<std::int64_t>(&v)) {
        return static_cast<double>(*i);
    }
    if (auto const* d = std::get_if<double>(&v)) {
        return *d;
    }
    throw BadParameter(fmt::format("a number is wanted, not {}", toml_text(v)));
}

std::int64_t as_integer(Value const& v) {
    if (auto const* i = std::get_if<std::int64_t>(&v)) {
        return *i;
    }
    throw BadParameter(fmt::format("an integer is wanted, not {}", toml_text(v)));
}

std::string const& as_text(Value const& v) {
    if (auto const* s = std::get_if<std::string>(&v)) {
        return *s;
    }
    throw BadParameter(fmt::format("a text in quotes is wanted, not {}", toml_text(v)));
}

/// Where a field lives: makes its section when a key is set, finds it (or nothing) when it is written.
template <class T> struct Field {
    std::function<T&(Recipe&)> make;
    std::function<T const*(Recipe const&)> find;
};

template <class T, class F> Field<T> in_recipe(F f) {
    return {[f](Recipe& r) -> T& { return f(r); },
            [f](Recipe const& r) -> T const* { return &f(const_cast<Recipe&>(r)); }};
}
template <class T, class F> Field<T> in_network(F f) {
    return {
        [f](Recipe& r) -> T& {
            if (!r.network) {
                r.network.emplace();
            }
            return f(*r.network);
        },
        [f](Recipe const& r) -> T const* { return r.network ? &f(const_cast<NetworkRecipe&>(*r.network)) : nullptr; }};
}
template <class T, class F> Field<T> in_surface(F f) {
    return {
        [f](Recipe& r) -> T& {
            if (!r.surface) {
                r.surface.emplace();
            }
            return f(*r.surface);
        },
        [f](Recipe const& r) -> T const* { return r.surface ? &f(const_cast<SurfaceRecipe&>(*r.surface)) : nullptr; }};
}

template <class T>
std::function<std::optional<Value>(Recipe const&)> taker(Field<T> field,
                                                         std::function<std::optional<Value>(T const&)> as) {
    return [field, as](Recipe const& r) -> std::optional<Value> {
        T const* const at = field.find(r);
        return at == nullptr ? std::nullopt : as(*at);
    };
}

Key number(char const* path, char const* unit, Range range, char const* meaning, Field<double> field) {
    Key key;
    key.help = {path, "number", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        double const x = as_number(v);
        if (!range.holds(x)) {
            throw BadParameter(fmt::format("{} is outside its range {}", x, range.text()));
        }
        field.make(r) = x;
    };
    key.take = taker<double>(field, [](double const& x) { return std::optional<Value>(x); });
    return key;
}

template <class Int>
Key integer(char const* path, char const* unit, Range range, char const* meaning, Field<Int> field) {
    Key key;
    key.help = {path, "integer", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        std::int64_t const x = as_integer(v);
        if (!range.holds(static_cast<double>(x))) {
            throw BadParameter(fmt::format("{} is outside its range {}", x, range.text()));
        }
        field.make(r) = static_cast<Int>(x);
    };
    key.take = taker<Int>(field, [](Int const& x) { return std::optional<Value>(static_cast<std::int64_t>(x)); });
    return key;
}

/// A side of the grid: 0 inside, never in a file, stands for "left out".
Key side(char const* path, char const* meaning, Field<std::int64_t> field) {
    Key key = integer<std::int64_t>(path, "cells", {1, 1e6}, meaning, field);
    key.take = taker<std::int64_t>(
        field, [](std::int64_t const& x) { return x > 0 ? std::optional<Value>(x) : std::nullopt; });
    return key;
}

Key text(char const* path, char const* range, char const* meaning, Field<std::string> field) {
    Key key;
    key.help = {path, "text", range, "", "", meaning};
    key.put = [field](Recipe& r, Value const& v) {
        std::string const& s = as_text(v);
        if (s.size() > 4096 || s.find('\0') != std::string::npos) {
            throw BadParameter("the text is too long or holds a null byte");
        }
        field.make(r) = s;
    };
    key.take = taker<std::string>(field, [](std::string const& s) { return std::optional<Value>(s); });
    return key;
}

Key yes_no(char const* path, char const* meaning, Field<bool> field) {
    Key key;
    key.help = {path, "yes/no", "true | false", "", "", meaning};
    key.put = [field](Recipe& r, Value const& v) {
        auto const* b = std::get_if<bool>(&v);
        if (b == nullptr) {
            throw BadParameter(fmt::format("true or false is wanted, not {}", toml_text(v)));
        }
        field.make(r) = *b;
    };
    key.take = taker<bool>(field, [](bool const& b) { return std::optional<Value>(b); });
    return key;
}

template <class Enum> using Choices = std::vector<std::pair<std::string, Enum>>;

template <class Enum> Key choice(char const* path, Choices<Enum> choices, char const* meaning, Field<Enum> field) {
    std::vector<std::string> words;
    for (auto const& [word, value] : choices) {
        words.push_back(word);
    }
    Key key;
    key.help = {path, "text", fmt::format("{}", fmt::join(words, " | ")), "", "", meaning};
    key.put = [choices, words, field](Recipe& r, Value const& v) {
        std::string const& s = as_text(v);
        for (auto const& [word, value] : choices) {
            if (word == s) {
                field.make(r) = value;
                return;
            }
        }
        throw BadParameter(
            fmt::format("'{}' is none of its values.{} ({})", s, did_you_mean(s, words), fmt::join(words, ", ")));
    };
    key.take = taker<Enum>(field, [choices](Enum const& e) -> std::optional<Value> {
        for (auto const& [word, value] : choices) {
            if (value == e) {
                return word;
            }
        }
        return std::nullopt;
    });
    return key;
}

template <class T> T& itself(T& t) {
    return t;
}

std::vector<Key> make_keys() {
    using network::BranchChoice;
    using network::Orientation;
    using network::VisitRule;
    std::vector<Key> keys;

    Key seed = integer<std::uint64_t>("seed", "", {0, endless}, "of every chance in the recipe",
                                      in_recipe<std::uint64_t>([](Recipe& r) -> std::uint64_t& { return r.seed; }));
    keys.push_back(std::move(seed));

    keys.push_back(side("grid.width", "columns; left out: the network's box and 5 % around it",
                        in_recipe<std::int64_t>([](Recipe& r) -> std::int64_t& { return r.grid.width; })));
    keys.push_back(side("grid.height", "rows; left out: the network's box and 5 % around it",
                        in_recipe<std::int64_t>([](Recipe& r) -> std::int64_t& { return r.grid.height; })));
    keys.push_back(number("grid.cell", "m", {0, 1e6, true}, "side of a cell",
                          in_recipe<double>([](Recipe& r) -> double& { return r.grid.cell_m; })));
    keys.push_back(text("grid.crs", "EPSG code or WKT; projected, in metres",
                        "coordinate system; \"\" takes the line file's own or its UTM zone, else EPSG:32631",
                        in_recipe<std::string>([](Recipe& r) -> std::string& { return r.grid.crs; })));
    {
        Key key;
        key.help = {
            "grid.origin", "two numbers", "[west, north]", "m", "", "outer corner of the grid in the north-west"};
        key.put = [](Recipe& r, Value const& v) {
            auto const* p = std::get_if<Pair>(&v);
            if (p == nullptr || !std::isfinite((*p)[0]) || !std::isfinite((*p)[1]) || std::fabs((*p)[0]) > 1e9 ||
                std::fabs((*p)[1]) > 1e9) {
                throw BadParameter(
                    fmt::format("two numbers [west, north] within 1e9 are wanted, not {}", toml_text(v)));
            }
            r.grid.origin = *p;
        };
        key.take = [](Recipe const& r) -> std::optional<Value> {
            return r.grid.origin ? std::optional<Value>(*r.grid.origin) : std::nullopt;
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(yes_no("grid.clip", "cut rivers at the grid's edge instead of refusing them",
                          in_recipe<bool>([](Recipe& r) -> bool& { return r.grid.clip; })));

    keys.push_back(choice<Source>("network.source", {{"dla", Source::dla}, {"lines", Source::lines}},
                                  "where the rivers come from: grown, or a file's lines",
                                  in_network<Source>([](NetworkRecipe& n) -> Source& { return n.source; })));
    {
        Key key = number("network.prune", "cells", {0, 1e7}, "L: no leaf arc shorter than this is left",
                         in_network<double>([](NetworkRecipe& n) -> double& {
                             if (!n.prune_cells) {
                                 n.prune_cells = 0.0;
                             }
                             return *n.prune_cells;
                         }));
        key.take = [](Recipe const& r) -> std::optional<Value> {
            return r.network && r.network->prune_cells ? std::optional<Value>(*r.network->prune_cells) : std::nullopt;
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<Heights>("network.heights",
                                   {{"auto", Heights::automatic},
                                    {"straight", Heights::straight},
                                    {"straight_repaired", Heights::straight_repaired},
                                    {"along_stream", Heights::along_stream},
                                    {"file", Heights::file}},
                                   "heights of the rivers; auto: file where lines carry Z, else straight_repaired",
                                   in_network<Heights>([](NetworkRecipe& n) -> Heights& { return n.heights; })));
    keys.push_back(number("network.slope", "m/m", {0, 10, true}, "s: fall of the valleys",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.slope; })));

    keys.push_back(integer<std::int64_t>(
        "network.dla.particles", "", {1, 1e9}, "size of the cluster",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.dla.particles; })));
    keys.push_back(number("network.dla.sticking", "", {0, 1, true}, "S: a site with n neighbours holds with S^(3-n)",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.dla.sticking; })));
    keys.push_back(integer<int>("network.dla.visits", "", {1, 255}, "M: arrivals a site needs before it may hold",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.dla.visits; })));
    keys.push_back(
        choice<VisitRule>("network.dla.rule",
                          {{"count_first", VisitRule::count_first}, {"stick_then_count", VisitRule::stick_then_count}},
                          "whether an arrival counts before or after its stick test",
                          in_network<VisitRule>([](NetworkRecipe& n) -> VisitRule& { return n.dla.rule; })));
    keys.push_back(
        choice<BranchChoice>("network.dla.branch",
                             {{"largest", BranchChoice::largest},
                              {"north", BranchChoice::north},
                              {"east", BranchChoice::east},
                              {"south", BranchChoice::south},
                              {"west", BranchChoice::west},
                              {"all", BranchChoice::all}},
                             "which arm of the cluster becomes the valley",
                             in_network<BranchChoice>([](NetworkRecipe& n) -> BranchChoice& { return n.branch; })));

    keys.push_back(text("network.lines.path", "file name", "any OGR source of lines",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.path; })));
    keys.push_back(text("network.lines.layer", "name", "\"\" takes the only line layer",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.layer; })));
    keys.push_back(text("network.lines.type_field", "name", "field with the river type; need not exist",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.type_field; })));
    keys.push_back(text("network.lines.rank_field", "name",
                        "integer field that falls downstream; \"\" takes hydroseq where there is one",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.lines.rank_field; })));
    keys.push_back(number("network.lines.snap", "m", {0, 1e6}, "ends closer than this are joined; 0: 1e-6 of the box",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.lines.snap_m; })));
    keys.push_back(choice<Orientation>(
        "network.lines.orientation",
        {{"auto", Orientation::automatic},
         {"height", Orientation::height},
         {"rank", Orientation::rank},
         {"as_drawn", Orientation::as_drawn},
         {"topology", Orientation::topology}},
        "what tells which way a line runs",
        in_network<Orientation>([](NetworkRecipe& n) -> Orientation& { return n.lines.orientation; })));

    keys.push_back(choice<Method>("surface.method", {{"dilate", Method::dilate}}, "how the land is drawn",
                                  in_surface<Method>([](SurfaceRecipe& s) -> Method& { return s.method; })));
    keys.push_back(choice<Base>("surface.base", {{"paper", Base::paper}},
                                "height a slope rises from: that of its valley cell",
                                in_surface<Base>([](SurfaceRecipe& s) -> Base& { return s.base; })));
    {
        Key key = text(
            "surface.increment", "uniform | decreasing | rise_fall | an expression in x", "dh of the x-th dilation",
            in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.dilate.increment.increment; }));
        auto const put = key.put;
        key.put = [put](Recipe& r, Value const& v) {
            surface::increments(1, {as_text(v)}); // says what is wrong with it
            put(r, v);
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<surface::Metric>(
        "surface.metric", {{"cityblock", surface::Metric::cityblock}, {"euclid", surface::Metric::euclid}},
        "distance to the valley: the paper's 4 neighbours, or straight",
        in_surface<surface::Metric>([](SurfaceRecipe& s) -> surface::Metric& { return s.dilate.metric; })));
    keys.push_back(
        number("surface.relief", "m", {0, 1e5},
               "scales the increments so that their greatest sum is this; 0: the paper's units times the cell",
               in_surface<double>([](SurfaceRecipe& s) -> double& { return s.dilate.relief_m; })));
    keys.push_back(
        yes_no("surface.allow_negative", "let increments below zero stand",
               in_surface<bool>([](SurfaceRecipe& s) -> bool& { return s.dilate.increment.allow_negative; })));
    keys.push_back(text("surface.mask", "file name", "raster on the grid: cells with 0 or no data are left out",
                        in_surface<std::string>([](SurfaceRecipe& s) -> std::string& { return s.mask; })));

    keys.push_back(text("output.title", "text", "of the pictures",
                        in_recipe<std::string>([](Recipe& r) -> std::string& { return r.output.title; })));
    keys.push_back(number("output.contour_interval", "m", {0, 1e5}, "0 chooses a round number",
                          in_recipe<double>([](Recipe& r) -> double& { return r.output.contour_interval_m; })));

    Recipe standard;
    standard.network.emplace();
    standard.surface.emplace();
    for (Key& key : keys) {
        if (auto const value = key.take(standard)) {
            key.help.standard = toml_text(*value);
        }
    }
    for (Key& key : keys) {
        if (key.help.path == "network.prune") {
            key.help.standard = "20 for dla, 0 for lines";
        } else if (key.help.path == "grid.origin") {
            key.help.standard = "[500000, 5000000], or the line file's box";
        }
    }
    return keys;
}

std::vector<Key> const& all_keys() {
    static std::vector<Key> const keys = make_keys();
    return keys;
}

std::vector<std::string> key_paths() {
    std::vector<std::string> paths;
    for (Key const& key : all_keys()) {
        paths.push_back(key.help.path);
    }
    return paths;
}

Key const* find_key(std::string const& path) {
    auto const& keys = all_keys();
    auto const at = std::find_if(keys.begin(), keys.end(), [&](Key const& k) { return k.help.path == path; });
    return at == keys.end() ? nullptr : &*at;
}

std::string unknown_key(std::string const& path) {
    std::vector<std::string> const paths = key_paths();
    std::string near = closest(path, paths);
    if (near.empty()) { // the right word in the wrong section
        std::string const word = path.substr(path.rfind('.') + 1);
        for (std::string const& p : paths) {
            if (p.substr(p.rfind('.') + 1) == word) {
                near = p;
            }
        }
    }
    return fmt::format("{} is not a key.{} `thalweg recipe` lists every key.", path,
                       near.empty() ? "" : " Did you mean '" + near + "'?");
}

std::optional<Value> value_of(toml::node const& node) {
    if (auto const* b = node.as_boolean()) {
        return b->get();
    }
    if (auto const* i = node.as_integer()) {
        return i->get();
    }
    if (auto const* d = node.as_floating_point()) {
        return d->get();
    }
    if (auto const* s = node.as_string()) {
        return s->get();
    }
    if (auto const* a = node.as_array(); a != nullptr && a->size() == 2) {
        auto const x = (*a)[0].value<double>();
        auto const y = (*a)[1].value<double>();
        if (x && y) {
            return Pair{*x, *y};
        }
    }
    return std::nullopt;
}

bool is_section(std::string const& path) {
    return std::any_of(all_keys().begin(), all_keys().end(), [&](Key const& k) {
        std::string const s = k.section();
        return s == path || s.substr(0, path.size() + 1) == path + ".";
    });
}

constexpr std::size_t most_faults = 20;

void read_table(toml::table const& table, std::string const& prefix, Recipe& recipe, std::vector<std::string>& faults) {
    for (auto const& [name, node] : table) {
        if (faults.size() >= most_faults) {
            return;
        }
        std::string const path = prefix + std::string(name.str());
        auto const line = node.source().begin.line;
        if (auto const* inner = node.as_table()) {
            if (!is_section(path)) {
                faults.push_back(fmt::format("line {}: {}", line, unknown_key(path)));
                continue;
            }
            if (path.substr(0, 7) == "network" && !recipe.network) {
                recipe.network.emplace();
            } else if (path.substr(0, 7) == "surface" && !recipe.surface) {
                recipe.surface.emplace();
            }
            read_table(*inner, path + ".", recipe, faults);
            continue;
        }
        Key const* const key = find_key(path);
        if (key == nullptr) {
            faults.push_back(fmt::format("line {}: {}", line, unknown_key(path)));
            continue;
        }
        auto const value = value_of(node);
        try {
            if (!value) {
                throw BadParameter(fmt::format("its value has the wrong type; wanted: {}", key->help.type));
            }
            key->put(recipe, *value);
        } catch (BadParameter const& fault) {
            faults.push_back(fmt::format("line {}: {}: {}", line, path, fault.what()));
        }
    }
}

std::string cut(std::string_view s) {
    return s.size() <= 80 ? std::string(s) : std::string(s.substr(0, 77)) + "...";
}

} // namespace

Recipe default_recipe() {
    Recipe recipe;
    recipe.grid.width = 1024;
    recipe.grid.height = 1024;
    recipe.network.emplace();
    recipe.network->dla.particles = 100000;
    recipe.network->branch = network::BranchChoice::south;
    recipe.network->slope = 0.02;
    recipe.surface.emplace();
    recipe.surface->dilate.metric = surface::Metric::euclid;
    recipe.surface->dilate.relief_m = 900.0;
    return recipe;
}

std::vector<KeyHelp> recipe_keys() {
    std::vector<KeyHelp> keys;
    for (Key const& key : all_keys()) {
        keys.push_back(key.help);
    }
    return keys;
}

Recipe read_recipe(std::string const& toml, std::string const& name) {
    // toml++ 3.3 recurses once a dotted part and level: sizes are measured before it sees the text.
    constexpr std::size_t most_bytes = 1 << 20;
    constexpr std::size_t longest_line = 8192;
    if (toml.size() > most_bytes) {
        throw BadParameter(
            fmt::format("{}: a recipe has at most {} bytes, this has {}", name, most_bytes, toml.size()));
    }
    for (std::size_t begin = 0, line = 1; begin < toml.size(); ++line) {
        std::size_t const end = std::min(toml.find('\n', begin), toml.size());
        if (end - begin > longest_line) {
            throw BadParameter(fmt::format("{}: line {} is longer than {} bytes", name, line, longest_line));
        }
        begin = end + 1;
    }
    toml::table table;
    try {
        table = toml::parse(toml, name);
    } catch (toml::parse_error const& fault) {
        throw BadParameter(fmt::format("{}: line {}, column {}: {}", name, fault.source().begin.line,
                                       fault.source().begin.column, cut(fault.description())));
    }
    Recipe recipe;
    std::vector<std::string> faults;
    read_table(table, "", recipe, faults);
    if (!faults.empty()) {
        throw BadParameter(fmt::format("{}: {}", name, fmt::join(faults, fmt::format("\n{}: ", name))));
    }
    return recipe;
}

void set_key(Recipe& recipe, std::string const& assignment) {
    auto const equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw BadParameter(fmt::format("--set {}: section.key=value is wanted", cut(assignment)));
    }
    std::string const path = assignment.substr(0, equals);
    std::string const text = assignment.substr(equals + 1);
    Key const* const key = find_key(path);
    if (key == nullptr) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), unknown_key(cut(path))));
    }
    try {
        Value value = text;
        if (key->help.type != "text") {
            if (text.size() > 200) {
                throw BadParameter("the value is too long");
            }
            try {
                toml::table const table = toml::parse("v = " + text);
                value = value_of(*table.get("v")).value_or(Value(text));
            } catch (toml::parse_error const&) {
                value = text; // not TOML: put says what is wanted instead
            }
        }
        key->put(recipe, value);
    } catch (BadParameter const& fault) {
        throw BadParameter(fmt::format("--set {}: {}", cut(assignment), fault.what()));
    }
}

std::string write_recipe(Recipe const& recipe) {
    std::string out;
    std::string section;
    for (Key const& key : all_keys()) {
        if (recipe.network) { // keys of the source that is not used would only confuse
            bool const lines = recipe.network->source == Source::lines;
            if ((lines && key.section() == "network.dla") || (!lines && key.section() == "network.lines")) {
                continue;
            }
        }
        auto const value = key.take(recipe);
        if (!value) {
            continue;
        }
        if (key.section() != section) {
            section = key.section();
            out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", section);
        }
        out +=
            fmt::format("{} = {}\n", key.help.path.substr(section.empty() ? 0 : section.size() + 1), toml_text(*value));
    }
    return out;
}

void check_recipe(Recipe const& recipe) {
    std::vector<std::string> faults;
    if (!recipe.network) {
        faults.emplace_back("[network] is missing: nothing tells where the valleys run");
    } else {
        NetworkRecipe const& n = *recipe.network;
        if (n.source == Source::lines && n.lines.path.empty()) {
            faults.emplace_back("network.lines.path is missing: source = \"lines\" needs a file");
        }
        if (n.source == Source::dla && !n.lines.path.empty()) {
            faults.emplace_back("network.lines.path is given but source = \"dla\": set source = \"lines\"");
        }
        if (n.source == Source::dla && n.heights == Heights::file) {
            faults.emplace_back("network.heights = \"file\" needs source = \"lines\"");
        }
    }
    if ((recipe.grid.width > 0) != (recipe.grid.height > 0)) {
        faults.emplace_back("grid.width and grid.height go together: give both or neither");
    }
    if (!faults.empty()) {
        throw BadParameter(fmt::format("recipe: {}", fmt::join(faults, "\nrecipe: ")));
    }
}

} // namespace thalweg::pipeline
