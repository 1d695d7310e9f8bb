// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe_keys.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/core/suggest.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

namespace thalweg::pipeline {

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

namespace {

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
    key.help = {path, "yes/no", "true | false", "", "", meaning, {"true", "false"}};
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
    key.help = {path, "text", fmt::format("{}", fmt::join(words, " | ")), "", "", meaning, words};
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
        key.help.choices = {"uniform", "decreasing", "rise_fall"};
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
            auto const* const number = std::get_if<double>(&*value); // for a reader: 0.087, not its 17 digits
            key.help.standard = number != nullptr ? fmt::format("{}", *number) : toml_text(*value);
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

} // namespace

std::vector<Key> const& all_keys() {
    static std::vector<Key> const keys = make_keys();
    return keys;
}

} // namespace thalweg::pipeline
