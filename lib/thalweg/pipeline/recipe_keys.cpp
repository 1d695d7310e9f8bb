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
            } else if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Triple>) {
                one.insert("v", toml::array{v[0], v[1], v[2]});
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
/// A field of a section, which a recipe may leave out.
template <class T, class Part, class F> Field<T> in_part(std::optional<Part> Recipe::*part, F f) {
    return {[part, f](Recipe& r) -> T& {
                if (!(r.*part)) {
                    (r.*part).emplace();
                }
                return f(*(r.*part));
            },
            [part, f](Recipe const& r) -> T const* { return r.*part ? &f(const_cast<Part&>(*(r.*part))) : nullptr; }};
}
template <class T, class F> Field<T> in_network(F f) {
    return in_part<T>(&Recipe::network, f);
}
template <class T, class F> Field<T> in_skeleton(F f) {
    return in_part<T>(&Recipe::skeleton, f);
}
template <class T, class F> Field<T> in_surface(F f) {
    return in_part<T>(&Recipe::surface, f);
}
template <class T, class F> Field<T> in_statistics(F f) {
    return in_part<T>(&Recipe::statistics, f);
}
template <class T, class F> Field<T> in_detail(F f) {
    return in_part<T>(&Recipe::detail, f);
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

/// A number that may be left out.
Key maybe(char const* path, char const* unit, Range range, char const* meaning, Field<std::optional<double>> field) {
    Key key;
    key.help = {path, "number", range.text(), unit, "", meaning};
    key.put = [range, field](Recipe& r, Value const& v) {
        double const x = as_number(v);
        if (!range.holds(x)) {
            throw BadParameter(fmt::format("{} is outside its range {}", x, range.text()));
        }
        field.make(r) = x;
    };
    key.take = taker<std::optional<double>>(
        field, [](std::optional<double> const& x) { return x ? std::optional<Value>(*x) : std::nullopt; });
    return key;
}

/// A list of numbers that may be left out.
template <class List>
Key numbers(char const* path, char const* type, char const* range, char const* unit, char const* meaning,
            Field<std::optional<List>> field, std::function<bool(List const&)> holds) {
    Key key;
    key.help = {path, type, range, unit, "", meaning};
    key.put = [field, holds, range](Recipe& r, Value const& v) {
        auto const* list = std::get_if<List>(&v);
        if (list == nullptr || !holds(*list)) {
            throw BadParameter(fmt::format("{} is wanted, not {}", range, toml_text(v)));
        }
        field.make(r) = *list;
    };
    key.take = taker<std::optional<List>>(
        field, [](std::optional<List> const& x) { return x ? std::optional<Value>(*x) : std::nullopt; });
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

void add_skeleton_keys(std::vector<Key>& keys) {
    keys.push_back(text("skeleton.points", "file name", "points with heights: CSV, XYZ, or any OGR source of points",
                        in_skeleton<std::string>([](SkeletonRecipe& s) -> std::string& { return s.points; })));
    keys.push_back(integer<std::int64_t>(
        "skeleton.scatter", "", {0, 1e7}, "so many points at random, the extremes of [statistics] among them",
        in_skeleton<std::int64_t>([](SkeletonRecipe& s) -> std::int64_t& { return s.scatter; })));
    keys.push_back(number("skeleton.spacing", "cells", {0, 1e5}, "r: least distance of points at random",
                          in_skeleton<double>([](SkeletonRecipe& s) -> double& { return s.spacing_cells; })));
    keys.push_back(choice<skeleton::HeightLaw>(
        "skeleton.law", {{"uniform", skeleton::HeightLaw::uniform}, {"normal", skeleton::HeightLaw::normal}},
        "how heights of points at random are distributed",
        in_skeleton<skeleton::HeightLaw>([](SkeletonRecipe& s) -> skeleton::HeightLaw& { return s.law; })));
    keys.push_back(yes_no("skeleton.tin", "write the triangles of rivers and points: tin.2dm, tin.ply",
                          in_skeleton<bool>([](SkeletonRecipe& s) -> bool& { return s.tin; })));
}

void add_surface_keys(std::vector<Key>& keys) {
    using skeleton::EighthTerm;
    using skeleton::SlopeMode;
    keys.push_back(choice<Interpolation>(
        "surface.interpolation", {{"linear", Interpolation::linear}, {"natural", Interpolation::natural}},
        "tin: flat triangles, or natural neighbours of points",
        in_surface<Interpolation>([](SurfaceRecipe& s) -> Interpolation& { return s.interpolation; })));
    keys.push_back(number("surface.frequency_x", "cycles", {0, 1e4}, "regress: f_x over the grid's width",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.regress.frequency_x; })));
    keys.push_back(number("surface.frequency_y", "cycles", {0, 1e4}, "regress: f_y over the grid's height",
                          in_surface<double>([](SurfaceRecipe& s) -> double& { return s.regress.frequency_y; })));
    keys.push_back(choice<SlopeMode>(
        "surface.slope_mode", {{"none", SlopeMode::none}, {"centre", SlopeMode::centre}, {"mean", SlopeMode::mean}},
        "regress: the slope statistics.slope holds for nothing here, the middle of the grid, or its mean square",
        in_surface<SlopeMode>([](SurfaceRecipe& s) -> SlopeMode& { return s.regress.slope; })));
    keys.push_back(
        choice<EighthTerm>("surface.eighth_term", {{"x2y2", EighthTerm::x2y2}, {"x3y", EighthTerm::x3y}},
                           "regress: the term whose exponents the paper lost",
                           in_surface<EighthTerm>([](SurfaceRecipe& s) -> EighthTerm& { return s.regress.eighth; })));
}

void add_statistics_keys(std::vector<Key>& keys) {
    using skeleton::Falloff;
    using MaybeNumber = std::optional<double>;
    using MaybeTriple = std::optional<Triple>;
    auto const is_place = [](Triple const& t) {
        return std::fabs(t[0]) <= 1e6 && t[1] >= 0.0 && t[2] >= 0.0 && t[1] < 1e6 && t[2] < 1e6 &&
               t[1] == std::floor(t[1]) && t[2] == std::floor(t[2]);
    };
    keys.push_back(maybe("statistics.mean", "m", {-1e6, 1e6}, "mean height",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.mean; })));
    keys.push_back(maybe("statistics.std", "m", {0, 1e6, true}, "standard deviation of the heights",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.std; })));
    keys.push_back(numbers<Triple>(
        "statistics.max", "three numbers", "[z, column, row], columns and rows from 0 in the north-west", "m",
        "the highest cell", in_statistics<MaybeTriple>([](StatisticsRecipe& s) -> MaybeTriple& { return s.max; }),
        is_place));
    keys.push_back(numbers<Triple>(
        "statistics.min", "three numbers", "[z, column, row], columns and rows from 0 in the north-west", "m",
        "the lowest cell", in_statistics<MaybeTriple>([](StatisticsRecipe& s) -> MaybeTriple& { return s.min; }),
        is_place));
    keys.push_back(numbers<Pair>(
        "statistics.length", "two numbers", "[Lx, Ly] above 0", "cells",
        "correlation lengths: where the autocorrelation falls to 1/e",
        in_statistics<std::optional<Pair>>([](StatisticsRecipe& s) -> std::optional<Pair>& { return s.length; }),
        [](Pair const& p) { return p[0] > 0.0 && p[1] > 0.0 && p[0] <= 1e6 && p[1] <= 1e6; }));
    keys.push_back(maybe("statistics.slope", "rad", {0, 1.5707, true}, "mean arctan of the slope in metres a cell",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.slope; })));
    keys.push_back(maybe("statistics.dimension", "", {2.01, 2.99}, "fractal dimension",
                         in_statistics<MaybeNumber>([](StatisticsRecipe& s) -> MaybeNumber& { return s.dimension; })));
    keys.push_back(choice<Prior>(
        "statistics.skeleton",
        {{"grf", Prior::grf}, {"separable", Prior::separable}, {"markov3", Prior::markov3}, {"points", Prior::points}},
        "the land that is brought to the statistics: a random one, or that of [skeleton]",
        in_statistics<Prior>([](StatisticsRecipe& s) -> Prior& { return s.skeleton; })));
    keys.push_back(number("statistics.reach", "cells", {0, 1e5},
                          "R: within it separable, markov3 and points are drawn to the extremes",
                          in_statistics<double>([](StatisticsRecipe& s) -> double& { return s.reach_cells; })));
    keys.push_back(choice<Falloff>("statistics.falloff",
                                   {{"continuous", Falloff::continuous}, {"literal", Falloff::literal}},
                                   "how the pull ends at R: at nothing, or by a step as printed",
                                   in_statistics<Falloff>([](StatisticsRecipe& s) -> Falloff& { return s.falloff; })));
}

void add_detail_keys(std::vector<Key>& keys) {
    using detail::Adaptation;
    using detail::Noise;
    using detail::Stencil;
    using MaybeNumber = std::optional<double>;
    keys.push_back(
        choice<DetailMethod>("detail.method", {{"midpoint", DetailMethod::midpoint}, {"none", DetailMethod::none}},
                             "fractal detail between every 2^levels-th cell",
                             in_detail<DetailMethod>([](DetailRecipe& d) -> DetailMethod& { return d.method; })));
    keys.push_back(integer<int>("detail.levels", "", {1, 12}, "times the cells are halved",
                                in_detail<int>([](DetailRecipe& d) -> int& { return d.midpoint.levels; })));
    keys.push_back(maybe("detail.hurst", "", {0.05, 0.95}, "H, 3 less the dimension; left out: estimated",
                         in_detail<MaybeNumber>([](DetailRecipe& d) -> MaybeNumber& { return d.midpoint.hurst; })));
    keys.push_back(maybe("detail.sigma", "m", {0, 1e6},
                         "root mean square difference of heights 2^levels cells apart; left out: estimated",
                         in_detail<MaybeNumber>([](DetailRecipe& d) -> MaybeNumber& { return d.midpoint.sigma; })));
    {
        Key key;
        key.help = {"detail.stencil",
                    "integer",
                    "4 | 12 | 16",
                    "",
                    "",
                    "neighbours a height is made of; 4 with the printed variance",
                    {"4", "12", "16"}};
        key.put = [](Recipe& r, Value const& v) {
            std::int64_t const n = as_integer(v);
            if (n != 4 && n != 12 && n != 16) {
                throw BadParameter(fmt::format("{} is none of 4, 12, 16", n));
            }
            if (!r.detail) {
                r.detail.emplace();
            }
            r.detail->midpoint.stencil = n == 4 ? Stencil::four : n == 12 ? Stencil::twelve : Stencil::sixteen;
        };
        key.take = [](Recipe const& r) -> std::optional<Value> {
            if (!r.detail) {
                return std::nullopt;
            }
            Stencil const s = r.detail->midpoint.stencil;
            return std::int64_t{s == Stencil::four ? 4 : s == Stencil::twelve ? 12 : 16};
        };
        keys.push_back(std::move(key));
    }
    keys.push_back(choice<Noise>("detail.noise", {{"normal", Noise::normal}, {"uniform", Noise::uniform}},
                                 "distribution of the displacements",
                                 in_detail<Noise>([](DetailRecipe& d) -> Noise& { return d.midpoint.noise; })));
    keys.push_back(choice<Adaptation>(
        "detail.adaptation", {{"global", Adaptation::global}, {"local", Adaptation::local}},
        "one H and sigma, or those of the surroundings where they differ",
        in_detail<Adaptation>([](DetailRecipe& d) -> Adaptation& { return d.midpoint.adaptation; })));
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

    add_skeleton_keys(keys);

    keys.push_back(choice<Method>("surface.method",
                                  {{"dilate", Method::dilate}, {"tin", Method::tin}, {"regress", Method::regress}},
                                  "how the land is drawn: outward from its valleys, over the triangles of rivers and "
                                  "points, or as twelve terms through points",
                                  in_surface<Method>([](SurfaceRecipe& s) -> Method& { return s.method; })));
    keys.push_back(choice<Base>("surface.base", {{"paper", Base::paper}, {"tin", Base::tin}},
                                "height a slope rises from: that of its valley cell, or of the triangles below it",
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

    add_surface_keys(keys);
    add_statistics_keys(keys);
    add_detail_keys(keys);

    keys.push_back(text("output.title", "text", "of the pictures",
                        in_recipe<std::string>([](Recipe& r) -> std::string& { return r.output.title; })));
    keys.push_back(number("output.contour_interval", "m", {0, 1e5}, "0 chooses a round number",
                          in_recipe<double>([](Recipe& r) -> double& { return r.output.contour_interval_m; })));

    Recipe standard;
    standard.network.emplace();
    standard.skeleton.emplace();
    standard.surface.emplace();
    standard.statistics.emplace();
    standard.detail.emplace();
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
