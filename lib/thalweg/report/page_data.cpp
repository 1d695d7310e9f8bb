// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/draw/comparison.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/packed.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/report/landmarks.hpp>
#include <thalweg/report/live_page.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::report {
namespace {

using nlohmann::ordered_json;

/// The small print under a metric.
std::string note_of(make::LawRow const& row) {
    struct Way {
        std::string_view detail;
        char const* words;
    };
    static constexpr std::array<Way, 10> ways = {{{"error", "± {:.2g}"},
                                                  {"std_deg", "spread {:.0f}°"},
                                                  {"r2", "r² {:.2f}"},
                                                  {"orders", "{:.0f} orders"},
                                                  {"terms", "{:.0f} T_k"},
                                                  {"bins", "{:.0f} bins"},
                                                  {"median_m", "median {:.0f} m"},
                                                  {"cv", "cv {:.2f}"},
                                                  {"junctions", "{:.0f} junctions"},
                                                  {"links", "{:.0f} links"}}};
    std::string note;
    for (Way const& way : ways) {
        for (auto const& [name, figure] : row.details) {
            if (row.value && name == way.detail && std::isfinite(figure)) {
                note += (note.empty() ? "" : ", ") + fmt::format(fmt::runtime(way.words), figure);
            }
        }
    }
    return note;
}

ordered_json figure_of(make::LawRow const& row) {
    return {{"value", row.value ? ordered_json(*row.value) : ordered_json(nullptr)}, {"note", note_of(row)}};
}

ordered_json rows_of(make::RiverLaws const& laws) {
    std::vector<make::LawRow> const none;
    auto const drawn = laws.network ? make::law_rows(*laws.network) : none;
    auto const drained = laws.dem ? make::law_rows(laws.dem->laws) : none;
    ordered_json rows = ordered_json::array();
    for (std::size_t i = 0; i < std::max(drawn.size(), drained.size()); ++i) {
        make::LawRow const& row = i < drawn.size() ? drawn[i] : drained[i];
        ordered_json one{{"key", row.key}, {"name", row.name}, {"unit", row.unit}};
        one["network"] = drawn.empty() ? ordered_json(nullptr) : figure_of(drawn[i]);
        one["dem"] = drained.empty() ? ordered_json(nullptr) : figure_of(drained[i]);
        one["nature"] = row.nature != nullptr ? ordered_json{row.nature->low, row.nature->high} : ordered_json(nullptr);
        one["source"] = row.nature != nullptr ? row.nature->source : "";
        rows.push_back(std::move(one));
    }
    return rows;
}

ordered_json orders_of(measure::NetworkLaws const* laws) {
    ordered_json orders = ordered_json::array();
    if (laws != nullptr) {
        for (measure::StreamOrder const& o : laws->horton.orders) {
            orders.push_back(
                {{"order", o.order}, {"streams", o.streams}, {"length_m", o.length_m}, {"area_m2", o.area_m2}});
        }
    }
    return orders;
}

/// Bins as [area in km2, value divided by its unit, places], and the two ends of the law's line.
ordered_json power_object(std::optional<measure::PowerLaw> const& law, double unit) {
    if (!law) {
        return nullptr;
    }
    ordered_json bins = ordered_json::array();
    for (measure::AreaBin const& bin : law->bins) {
        bins.push_back({bin.area_m2 / 1e6, bin.value / unit, bin.places});
    }
    ordered_json fit = ordered_json::array();
    for (measure::AreaBin const* end : {&law->bins.front(), &law->bins.back()}) {
        fit.push_back({end->area_m2 / 1e6, law->coefficient * portable::pow(end->area_m2, law->exponent) / unit});
    }
    return {{"bins", bins}, {"fit", fit}};
}

// The laws of rivers as JSON for the page: a table of metrics, and the data of its diagrams (web/README.md).
std::string page_laws(make::RiverLaws const& laws) {
    measure::NetworkLaws const* const drawn = laws.network ? &*laws.network : nullptr;
    measure::NetworkLaws const* const drained = laws.dem ? &laws.dem->laws : nullptr;
    constexpr double kilometre = 1000.0;
    auto const both = [&](auto part) {
        return ordered_json{{"network", drawn != nullptr ? part(*drawn) : ordered_json(nullptr)},
                            {"dem", drained != nullptr ? part(*drained) : ordered_json(nullptr)}};
    };
    ordered_json const out{
        {"rows", rows_of(laws)},
        {"support", laws.dem ? ordered_json{{"cells", laws.dem->support_cells},
                                            {"km2", laws.dem->support_m2 / 1e6},
                                            {"as_dense", laws.dem->as_dense}}
                             : ordered_json(nullptr)},
        {"orders", orders_of(drawn)},
        {"dem_orders", orders_of(drained)},
        {"hack", both([](measure::NetworkLaws const& l) { return power_object(l.hack, kilometre); })},
        {"concavity", both([](measure::NetworkLaws const& l) { return power_object(l.concavity, 1.0); })}};
    return out.dump();
}

constexpr std::size_t most_points = 600;
constexpr std::size_t most_shown = 50;

/// Rounds to 1 mm to keep the JSON small.
double to_millimetres(double metres) {
    constexpr double finest = 1e12; // beyond this, doubles are hardly finer
    return std::fabs(metres) < finest ? std::floor(metres * 1000.0 + 0.5) / 1000.0 : metres;
}

/// At most this many of a list, evenly spaced, the first and last included.
template <class T> std::vector<T> thinned(std::vector<T> const& all, std::size_t most = most_points) {
    if (all.size() <= most) {
        return all;
    }
    std::vector<T> some;
    for (std::size_t i = 0; i < most; ++i) {
        some.push_back(all[i * (all.size() - 1) / (most - 1)]);
    }
    return some;
}

ordered_json grid_object(Grid const& grid) {
    return {{"width", grid.width},
            {"height", grid.height},
            {"cell_m", grid.cell_m},
            {"west", grid.west},
            {"north", grid.north},
            {"crs", grid.crs},
            {"crs_name", io::crs_in_words(grid.crs)}};
}

/// Rows of name, value and unit, without missing ones.
ordered_json given_array(std::optional<make::GivenLength> const& given, std::optional<make::GivenAreas> const& areas) {
    ordered_json rows = ordered_json::array();
    auto const add = [&](std::string const& name, double metres, double unit_m, char const* unit) {
        if (metres > 0.0) {
            rows.push_back({name, to_millimetres(metres) / unit_m, unit});
        }
    };
    if (given) {
        add("read", given->read_m, 1000.0, "km");
        for (std::size_t i = 0; i < given->left_out_m.size(); ++i) {
            add(fmt::format("left out: {}", make::words_of(static_cast<LeftOut>(i))), given->left_out_m[i], 1000.0,
                "km");
        }
        add("in the network", given->kept_m, 1000.0, "km");
        add("added where ends were joined", given->closed_m, 1000.0, "km");
        add("in artificial channels", given->connector_m, 1000.0, "km");
        add("reversed", given->turned_m, 1000.0, "km");
        add("outlets extended by", given->carried_m, 1000.0, "km");
        add("ends moved by up to", given->moved_m, 1.0, "m");
    }
    if (areas) {
        rows.push_back({"drainage area, terrain / file: median", to_millimetres(areas->median), ""});
        rows.push_back({"from (5 % of arcs below)", to_millimetres(areas->low), ""});
        rows.push_back({"to (5 % of arcs above)", to_millimetres(areas->high), ""});
        rows.push_back({"within a factor of 2", to_millimetres(100.0 * areas->within_factor_2), "% of arcs"});
    }
    return rows;
}

ordered_json heights_object(std::optional<PageHeights> const& heights) {
    if (!heights) {
        return nullptr;
    }
    return {{"width", heights->width}, {"height", heights->height}, {"cells", heights->cells},
            {"min", heights->min},     {"max", heights->max},       {"nodata", heights->nodata}};
}

ordered_json arcs_object(make::MakeResult const& t, PageLines const& lines) {
    ordered_json id = ordered_json::array();
    ordered_json downstream = ordered_json::array();
    ordered_json persistence = ordered_json::array();
    ordered_json length = ordered_json::array();
    ordered_json z_up = ordered_json::array();
    ordered_json z_down = ordered_json::array();
    for (std::size_t a = 0; a < t.terrain.rivers.network.planform.arc_count(); ++a) {
        id.push_back(a + 1);
        downstream.push_back(t.terrain.rivers.network.planform.out(t.terrain.rivers.network.planform.to(a)) + 1);
        double const until = t.terrain.rivers.network.planform.arc(a).persistence;
        persistence.push_back(std::isfinite(until) ? ordered_json(to_millimetres(until)) : ordered_json(nullptr));
        length.push_back(to_millimetres(t.terrain.rivers.network.planform.length_m(a)));
        z_up.push_back(to_millimetres(t.terrain.rivers.network.arc_z[a].front()));
        z_down.push_back(to_millimetres(t.terrain.rivers.network.arc_z[a].back()));
    }
    std::vector<std::int64_t> const n(lines.vertices.begin(),
                                      lines.vertices.begin() +
                                          static_cast<std::ptrdiff_t>(t.terrain.rivers.network.planform.arc_count()));
    return {{"id", id},
            {"ds", downstream},
            {"basin", t.terrain.rivers.orders.arc_basin},
            {"strahler", t.terrain.rivers.orders.strahler},
            {"shreve", t.terrain.rivers.orders.shreve},
            {"hack", t.terrain.rivers.orders.hack},
            {"survives", persistence},
            {"length", length},
            {"z_up", z_up},
            {"z_down", z_down},
            {"us_area", t.terrain.water.areas.us_area_m2},
            {"ds_area", t.terrain.water.areas.ds_area_m2},
            {"n", n}};
}

ordered_json ridges_object(make::MakeResult const& t, PageLines const& lines) {
    if (t.terrain.ground.ridges.lines.empty()) {
        return nullptr;
    }
    auto const first =
        lines.vertices.begin() + static_cast<std::ptrdiff_t>(t.terrain.rivers.network.planform.arc_count());
    return {{"n", std::vector<std::int64_t>(first, lines.vertices.end())}};
}

/// A point of a profile.
struct ProfilePoint {
    double to_outlet_m;
    double z;
    Vec2 at;
};

/// A river from its source down.
struct Stem {
    std::int64_t basin;
    std::vector<ProfilePoint> points;
};

Stem stem_along(make::Rivers const& rivers, std::vector<ArcId> const& arcs) {
    Stem stem{arcs.empty() ? 0 : rivers.orders.arc_basin[arcs.front()], {}};
    StreamNetwork const& network = rivers.network.planform;
    for (auto arc = arcs.rbegin(); arc != arcs.rend(); ++arc) {
        std::vector<Vec2> const& line = network.arc(*arc).line;
        double to_outlet = rivers.orders.node_dist_out_m[network.to(*arc)];
        for (std::size_t i = line.size(); i-- > 0;) {
            bool const shared = i + 1 == line.size() && !stem.points.empty();
            to_outlet += i + 1 < line.size() ? distance(line[i], line[i + 1]) : 0.0;
            if (!shared) {
                stem.points.push_back({to_outlet, rivers.network.arc_z[*arc][i], line[i]});
            }
        }
    }
    std::reverse(stem.points.begin(), stem.points.end());
    return stem;
}

/// The main stem, then those of the other basins with the longest, each from its source down.
std::vector<Stem> stems_of(make::Rivers const& rivers) {
    constexpr std::size_t most_stems = 8;
    std::vector<Stem> stems;
    if (rivers.orders.main_stem.empty()) {
        return stems;
    }
    stems.push_back(stem_along(rivers, rivers.orders.main_stem));
    std::map<std::int64_t, std::vector<ArcId>> by_basin;
    for (ArcId arc = 0; arc < rivers.network.planform.arc_count(); ++arc) {
        if (rivers.orders.hack[arc] == 1 && rivers.orders.arc_basin[arc] != stems.front().basin) {
            by_basin[rivers.orders.arc_basin[arc]].push_back(arc);
        }
    }
    std::vector<Stem> others;
    for (auto& [basin, arcs] : by_basin) {
        std::ranges::sort(arcs, std::greater{},
                          [&](ArcId arc) { return rivers.orders.node_dist_out_m[rivers.network.planform.to(arc)]; });
        others.push_back(stem_along(rivers, arcs));
    }
    std::ranges::stable_sort(others, std::greater{}, [](Stem const& s) { return s.points.front().to_outlet_m; });
    others.resize(std::min(others.size(), most_stems - 1));
    std::ranges::move(others, std::back_inserter(stems));
    return stems;
}

ordered_json profiles_array(std::vector<Stem> const& stems, Grid const& grid) {
    auto const cells = [&](double metres) { return std::floor(metres / grid.cell_m * 100.0 + 0.5) / 100.0; };
    ordered_json out = ordered_json::array();
    for (Stem const& stem : stems) {
        ordered_json points = ordered_json::array();
        for (ProfilePoint const& p : thinned(stem.points, out.empty() ? most_points : most_points / 4)) {
            points.push_back({to_millimetres(p.to_outlet_m), to_millimetres(p.z), cells(p.at.x - grid.west),
                              cells(grid.north - p.at.y)});
        }
        out.push_back({{"basin", stem.basin}, {"points", points}});
    }
    return out;
}

ordered_json summits_array(std::vector<Summit> const& summits, Grid const& grid) {
    ordered_json out = ordered_json::array();
    for (Summit const& s : summits) {
        out.push_back({(s.at.x - grid.west) / grid.cell_m, (grid.north - s.at.y) / grid.cell_m, to_millimetres(s.z)});
    }
    return out;
}

ordered_json sea_object(std::optional<Sea> const& sea) {
    return sea ? ordered_json{{"level", sea->level_m}, {"around", sea->is_around}} : ordered_json(nullptr);
}

ordered_json curve_object(make::MakeResult const& t) {
    if (!t.terrain.has_surface() || !t.recipe.surface || t.terrain.ground.dilated().increments.empty()) {
        return nullptr;
    }
    std::vector<ordered_json> points;
    double sum = 0.0;
    for (std::size_t i = 0; i < t.terrain.ground.dilated().increments.size(); ++i) {
        sum += t.terrain.ground.dilated().increments[i];
        points.push_back({i + 1, to_millimetres(t.terrain.ground.dilated().increments[i]), to_millimetres(sum)});
    }
    return {{"name", t.recipe.surface->dilate.increment.increment}, {"points", thinned(points)}};
}

ordered_json hypsometry_object(make::MakeResult const& t) {
    if (!t.assessment.hypsometry) {
        return nullptr;
    }
    ordered_json points = ordered_json::array();
    for (measure::HypsometricPoint const& p : t.assessment.hypsometry->points) {
        points.push_back({p.share_above, to_millimetres(p.z)});
    }
    return {{"integral", t.assessment.hypsometry->integral}, {"points", points}};
}

/// A list of metrics: target, if any, and result.
class Figures {
public:
    template <class Number> void add(char const* name, Number got, char const* unit) {
        rows_.push_back({{"name", name}, {"asked", nullptr}, {"got", got}, {"unit", unit}});
    }
    template <class Number> void add(char const* name, std::optional<Number> asked, Number got, char const* unit) {
        add(name, got, unit);
        if (asked) {
            rows_.back()["asked"] = *asked;
        }
    }
    ordered_json take() { return std::move(rows_); }

private:
    ordered_json rows_ = ordered_json::array();
};

/// The target of [statistics] with the name of a residual.
std::optional<double> target_value(make::MakeResult const& t, char const* name) {
    if (t.terrain.ground.matched) {
        for (fractal::Residual const& r : t.terrain.ground.matched->projection.residuals) {
            if (r.name == name) {
                return r.asked;
            }
        }
    }
    return std::nullopt;
}

void add_land(make::MakeResult const& t, Figures& figures) {
    measure::Statistics const& s = *t.assessment.statistics;
    figures.add("mean height", target_value(t, "mean"), to_millimetres(s.mean), "m");
    figures.add("standard deviation", target_value(t, "std"), to_millimetres(s.std), "m");
    figures.add("lowest height", target_value(t, "min"), to_millimetres(s.min.z), "m");
    figures.add("highest height", target_value(t, "max"), to_millimetres(s.max.z), "m");
    figures.add("relief, highest less lowest", to_millimetres(s.max.z - s.min.z), "m");
    if (!t.terrain.ground.dilated().increments.empty() && t.recipe.surface) {
        double const relief = t.recipe.surface->dilate.relief_m;
        figures.add("greatest rise above the valley", relief > 0.0 ? std::optional(relief) : std::nullopt,
                    to_millimetres(t.terrain.ground.dilated().rise_m), "m");
    }
    figures.add("correlation length along rows", target_value(t, "lx_cells"), s.lx.cells, "cells");
    figures.add("correlation length along columns", target_value(t, "ly_cells"), s.ly.cells, "cells");
    figures.add("fractal dimension", target_value(t, "dimension"), s.dimension, "");
    figures.add("mean slope on unit cells", target_value(t, "slope_rad"), s.slope_rad, "rad");
    figures.add("mean slope", s.slope_true_deg, "degrees");
    figures.add("hypsometric integral", t.assessment.hypsometry->integral, "");
    figures.add("cells in pits", t.assessment.pits, "");
}

void add_rivers(make::MakeResult const& t, std::vector<Stem> const& stems, Figures& figures) {
    std::optional<recipe::NetworkRecipe> const& wanted = t.recipe.network;
    double const length = std::accumulate(t.terrain.rivers.network.planform.length_m().begin(),
                                          t.terrain.rivers.network.planform.length_m().end(), 0.0);
    auto const land =
        static_cast<double>(t.assessment.statistics ? t.assessment.statistics->cells : t.terrain.grid.cells());
    if (wanted && wanted->source == recipe::Source::dla) {
        figures.add("particles of the cluster", std::optional(wanted->dla.particles), t.planform.statistics.particles,
                    "");
    }
    if (wanted && wanted->source == recipe::Source::forest) {
        figures.add("particles of the forest", t.planform.statistics.particles, "");
    }
    figures.add("arcs", t.terrain.rivers.network.planform.arc_count(), "");
    figures.add("outlets", t.terrain.rivers.network.planform.outlets().size(), "");
    figures.add("highest Strahler order",
                t.assessment.laws.network ? t.assessment.laws.network->horton.orders.size() : 0, "");
    figures.add("length of all rivers", to_millimetres(length / 1000.0), "km");
    figures.add("drainage density", length / 1000.0 / (land * t.terrain.grid.cell_m * t.terrain.grid.cell_m / 1e6),
                "km/km2");
    if (!stems.empty() && stems.front().points.front().to_outlet_m > 0.0) {
        std::vector<ProfilePoint> const& stem = stems.front().points;
        // Only along_stream sets a slope along the water; the other methods set one along a straight line.
        figures.add("slope of the main stem",
                    wanted && wanted->heights == recipe::Heights::along_stream ? std::optional(wanted->slope)
                                                                               : std::nullopt,
                    (stem.front().z - stem.back().z) / stem.front().to_outlet_m, "m/m");
    }
}

bool is_warning(Finding const& finding) {
    return finding.severity() == Severity::warning;
}

/// Cells from the north-west corner; nothing: no place, or beyond the grid.
ordered_json place_of(Finding const& f, Grid const& grid) {
    double const x = (f.where.x - grid.west) / grid.cell_m;
    double const y = (grid.north - f.where.y) / grid.cell_m;
    bool const inside = x >= 0.0 && y >= 0.0 && x <= static_cast<double>(grid.width) && // false for NaN
                        y <= static_cast<double>(grid.height);
    return !inside ? ordered_json(nullptr) : ordered_json{x, y};
}

/// At most so many findings that of every kind some are among them: of each the first, then of each the second...
ordered_json shown(std::vector<Finding> const& findings, Grid const& grid) {
    std::map<std::string_view, std::size_t> told;
    std::vector<std::pair<std::size_t, Finding const*>> ranked;
    ranked.reserve(findings.size());
    for (Finding const& f : findings) {
        ranked.emplace_back(told[f.kind.name()]++, &f);
    }
    std::ranges::stable_sort(ranked, std::less{}, [](auto const& one) { return one.first; });
    ranked.resize(std::min(ranked.size(), most_shown));
    ordered_json list = ordered_json::array();
    for (auto const& [rank, f] : ranked) {
        list.push_back({{"kind", f->kind.name()}, {"text", f->text}, {"at", place_of(*f, grid)}});
        if (is_warning(*f)) {
            list.back()["remedy"] = remedy_of(*f);
        }
    }
    return {{"count", findings.size()}, {"shown", list}};
}

/// The comparison with a DEM, with a map of differences.
ordered_json against_on_page(make::Against const& against, make::Terrain const& terrain) {
    constexpr int width_px = 900;
    auto const shape = [](std::string const& name, make::ReliefShape const& of) {
        ordered_json points = ordered_json::array();
        for (measure::HypsometricPoint const& point : of.hypsometry) {
            points.push_back({point.share_above, to_millimetres(point.z)});
        }
        return std::pair{ordered_json{{"name", name}, {"shares_of_2_deg", of.slopes}},
                         ordered_json{{"name", name}, {"points", points}}};
    };
    ordered_json rows = ordered_json::array();
    auto const [slopes_of_dem, heights_of_dem] = shape("DEM", against.real);
    ordered_json slopes = ordered_json::array({slopes_of_dem});
    ordered_json hypsometry = ordered_json::array({heights_of_dem});
    for (make::TerrainAgainst const& one : against.terrains) {
        ordered_json row{{"key", one.key}, {"name", one.name}};
        row.update(ordered_json::parse(figures_against(one)));
        rows.push_back(std::move(row));
        auto const [slopes_here, heights_here] = shape(one.name, one.shape);
        slopes.push_back(slopes_here);
        hypsometry.push_back(heights_here);
    }
    draw::Picture const picture = differences_against(against, terrain, width_px);
    std::string const& bytes = picture.bytes;
    std::string const image = io::base64({reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size()});
    Grid const& grid = against.difference.grid();
    return {{"dem", against.dem},
            {"cells", against.cells},
            {"rows", rows},
            {"real",
             {{"mean_slope_deg", against.real.mean_slope_deg},
              {"hypsometric_integral", against.real.hypsometric_integral}}},
            {"slopes", slopes},
            {"hypsometry", hypsometry},
            {"scatter",
             {{"low", against.pairs.low_m},
              {"high", against.pairs.high_m},
              {"side", against.pairs.side},
              {"counts", against.pairs.counts}}},
            {"difference",
             {{"limit_m", draw::limit_of_differences(against.difference)},
              {"width", grid.width},
              {"height", grid.height},
              {"image", "data:image/png;base64," + image}}}};
}

ordered_json timings_array(make::MakeResult const& t) {
    ordered_json out = ordered_json::array();
    for (StageTime const& time : make::timings_of(t)) {
        out.push_back({time.stage, to_millimetres(time.wall_s)});
    }
    return out;
}

bool is_error(Finding const& finding) {
    return finding.severity() == Severity::error;
}

std::vector<Finding> chosen(std::vector<Finding> const& findings, bool (*is_one)(Finding const&)) {
    std::vector<Finding> some;
    std::ranges::copy_if(findings, std::back_inserter(some), is_one);
    return some;
}

ordered_json notes_array(make::MakeResult const& t, std::vector<Finding> const& findings,
                         std::optional<PageHeights> const& heights, std::vector<std::string> const& further) {
    ordered_json out = further;
    for (Finding const& finding : findings) {
        if (finding.severity() == Severity::note && !is_repair(finding)) {
            out.push_back(finding.text);
        }
    }
    if (!t.terrain.has_surface()) {
        out.push_back("the recipe has no [surface]: the page shows the rivers alone");
    }
    if (t.terrain.ground.matched && t.terrain.ground.matched->fine_forms_cells > 0.0) {
        out.push_back(
            fmt::format("the statistics cannot be reached from this skeleton alone: forms finer than about {} "
                        "cells come from a Gaussian surface",
                        t.terrain.ground.matched->fine_forms_cells));
    }
    if (heights && heights->cells > 1) {
        out.push_back(fmt::format("heights are shown as means of {0}x{0} cells", heights->cells));
    }
    return out;
}

} // namespace

std::string grid_json(Grid const& grid) {
    return grid_object(grid).dump();
}

std::string sea_json(std::optional<Sea> const& sea) {
    return sea_object(sea).dump();
}

std::string without_tags(std::string const& json) {
    std::string out;
    out.reserve(json.size());
    for (char const c : json) {
        if (c == '<') {
            out += "\\u003c";
        } else {
            out += c;
        }
    }
    return out;
}

std::string page_data(make::MakeResult const& t, PageParams const& params, std::optional<PageHeights> const& heights,
                      PageLines const& lines) {
    std::vector<Stem> const stems = stems_of(t.terrain.rivers);
    std::vector<Finding> const findings = make::findings_of(t);
    Figures figures;
    if (t.assessment.statistics) {
        add_land(t, figures);
    }
    if (t.recipe.network || !t.terrain.rivers.network.planform.arcs().empty()) {
        add_rivers(t, stems, figures);
    }
    ordered_json const data{
        {"version", version()},
        {"title", recipe::title_of(t.recipe)},
        {"seed", t.recipe.seed},
        {"command", params.command},
        {"recipe", params.recipe},
        {"grid", grid_object(t.terrain.grid)},
        {"heights", heights_object(heights)},
        {"contour_m", params.contour_interval_m},
        {"rivers",
         {{"step", lines.step},
          {"prune", t.recipe.network ? t.recipe.network->prune_cells.value_or(0.0) : 0.0},
          {"arcs", arcs_object(t, lines)}}},
        {"ridges", ridges_object(t, lines)},
        {"sea", sea_object(params.sea)},
        {"lakes", params.lakes.cells() > 0},
        {"summits", summits_array(params.summits, t.terrain.grid)},
        {"profiles", profiles_array(stems, t.terrain.grid)},
        {"curve", curve_object(t)},
        {"hypsometry", hypsometry_object(t)},
        {"laws", ordered_json::parse(page_laws(t.assessment.laws))},
        {"relief",
         t.assessment.relief ? ordered_json::parse(make::relief_json(*t.assessment.relief)) : ordered_json(nullptr)},
        {"against", t.assessment.against ? against_on_page(*t.assessment.against, t.terrain) : ordered_json(nullptr)},
        {"statistics", figures.take()},
        {"given", given_array(t.assessment.given, t.assessment.given_areas)},
        {"checks", ordered_json::parse(checks_json(t.assessment.checks))},
        {"timings", timings_array(t)},
        {"warnings", shown(chosen(findings, is_warning), t.terrain.grid)},
        {"repairs", shown(chosen(findings, is_repair), t.terrain.grid)},
        {"findings", shown(chosen(findings, is_error), t.terrain.grid)},
        {"notes", notes_array(t, findings, heights, params.notes)}};
    return without_tags(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

} // namespace thalweg::report
