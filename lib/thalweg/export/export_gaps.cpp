// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/export_gaps.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/surface/gaps/close_gaps.hpp>

namespace thalweg::exports {
namespace {

/// The entry of a table that a word names.
template <class Names> auto named_gaps(Names const& table, std::string const& word, char const* option) {
    std::vector<std::string> names;
    for (auto const& known : table) {
        if (word == known.name) {
            return known;
        }
        names.emplace_back(known.name);
    }
    throw BadParameter("export.run_export", fmt::format("{} '{}' is unknown: use {}.{}", option, word,
                                                        fmt::join(names, ", "), did_you_mean(word, names)));
}

surface::CloseGapsParams gap_params(ExportParams const& params) {
    surface::CloseGapsParams out;
    if (!params.rim.empty()) {
        out.rim = named_gaps(rim_gaps(), params.rim, "--rim").rim;
    }
    if (!params.holes.empty()) {
        out.holes = named_gaps(enclosed_gaps(), params.holes, "--holes").holes;
    }
    out.sea_m = params.sea_level_m;
    return out;
}

std::string percent(double share) {
    return fmt::format("{:.{}f} %", 100.0 * share, share < 0.1 ? 1 : 0);
}

std::string rim_text(surface::ClosedGaps const& closed, surface::RimGaps how, Grid const& before, bool has_sea) {
    std::string const cells =
        fmt::format("{} of {} cells have no data and are connected with the border", closed.rim, before.cells());
    switch (how) {
    case surface::RimGaps::nearest: return cells + ": each gets the height of the nearest cell";
    case surface::RimGaps::minimum: return cells + ": they get the lowest height";
    case surface::RimGaps::sea: return cells + ": they lie under the sea";
    case surface::RimGaps::cut: break;
    }
    Grid const& grid = closed.dem.grid();
    double const lost =
        static_cast<double>(closed.cut) / static_cast<double>(std::max<std::int64_t>(1, before.cells() - closed.rim));
    constexpr double much = 0.25; // more than warping takes off a DEM
    return fmt::format("{}: the DEM is cut to its largest rectangle without them, {} x {} of {} x {} cells from column "
                       "{}, row {}, without {} of its land{}",
                       cells, grid.width, grid.height, before.width, before.height, closed.first.col, closed.first.row,
                       percent(lost),
                       lost <= much ? ""
                       : has_sea    ? ". --rim nearest keeps all of it, --rim sea lets the sea cover the gaps"
                                    : ". --rim nearest keeps all of it");
}

std::string holes_text(surface::ClosedGaps const& closed, surface::EnclosedGaps how, std::int64_t cells) {
    std::string const gaps = fmt::format("{} of {} cells have no data, in {} gap{} that land encloses", closed.enclosed,
                                         cells, closed.holes, closed.holes == 1 ? "" : "s");
    std::string const levels = closed.low_m == closed.high_m
                                   ? fmt::format("{:.6g} m", closed.low_m)
                                   : fmt::format("{:.6g} to {:.6g} m", closed.low_m, closed.high_m);
    switch (how) {
    case surface::EnclosedGaps::shore:
        return fmt::format("{}: each gap is level at the lowest cell beside it, {}", gaps, levels);
    case surface::EnclosedGaps::nearest:
        return fmt::format("{}: each cell gets the height of the nearest one, {}", gaps, levels);
    case surface::EnclosedGaps::minimum: break;
    }
    return fmt::format("{}: their samples get the lowest height, {}", gaps, levels);
}

/// Makes the cells under the sea water.
void take_sea(report::Scene& scene, surface::ClosedGaps const& closed, double level_m, ExportResult& made) {
    scene.sea = report::Sea{level_m, false};
    if (scene.lakes.cells() != closed.dem.cells()) {
        scene.lakes = Mask(closed.dem.grid(), 0);
    }
    std::int64_t wet = 0;
    for (std::int64_t i = 0; i < closed.sea.cells(); ++i) {
        if (closed.sea[i] != 0) {
            scene.lakes[i] = 1;
            ++wet;
        }
    }
    made.findings.push_back(
        {.kind = "sea_of_dem",
         .amount = static_cast<double>(wet),
         .text = fmt::format("the sea at {:.6g} m covers {} of {} cells", level_m, wet, closed.dem.cells())});
    if (closed.dry > 0) {
        made.findings.push_back(
            {.kind = "dry_lowland",
             .amount = static_cast<double>(closed.dry),
             .text = fmt::format("{} cells are at or below the sea's {:.6g} m and enclosed by land: they stay dry",
                                 closed.dry, level_m)});
    }
}

/// Appends the point at which a segment of a river crosses a border.
void append_between(RiverSpline& part, RiverSpline const& river, std::size_t i, double share) {
    auto const between = [&](double a, double b) { return a + share * (b - a); };
    Vec3 const a = river.line[i - 1];
    Vec3 const b = river.line[i];
    part.line.push_back({between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)});
    part.discharge_m3s.push_back(between(river.discharge_m3s[i - 1], river.discharge_m3s[i]));
    part.width_m.push_back(between(river.width_m[i - 1], river.width_m[i]));
}

/// The shares of a segment between which it lies inside a grid; nothing: it lies outside.
std::optional<std::pair<double, double>> shares_inside(Vec2 a, Vec2 b, Grid const& grid) {
    double begin = 0.0;
    double end = 1.0;
    auto const clip = [&](double from, double to, double low, double high) { // Liang and Barsky
        if (from == to) {
            return from >= low && from <= high;
        }
        double const s = (low - from) / (to - from);
        double const t = (high - from) / (to - from);
        begin = std::max(begin, std::min(s, t));
        end = std::min(end, std::max(s, t));
        return begin < end;
    };
    bool const is_inside = clip(a.x, b.x, grid.west, grid.east()) && clip(a.y, b.y, grid.south(), grid.north);
    return is_inside ? std::optional(std::pair{begin, end}) : std::nullopt;
}

void append_parts(RiverSpline const& river, Grid const& grid, std::vector<RiverSpline>& out) {
    RiverSpline const empty{river.arc, river.ds_arc, river.strahler, {}, {}, {}};
    RiverSpline part = empty;
    auto const finish = [&] {
        if (part.line.size() > 1) {
            out.push_back(std::move(part));
        }
        part = empty;
    };
    for (std::size_t i = 1; i < river.line.size(); ++i) {
        auto const inside = shares_inside(in_plan(river.line[i - 1]), in_plan(river.line[i]), grid);
        if (!inside) {
            finish();
            continue;
        }
        if (part.line.empty() || inside->first > 0.0) {
            finish();
            append_between(part, river, i, inside->first);
        }
        append_between(part, river, i, inside->second);
        if (inside->second < 1.0) {
            finish();
        }
    }
    finish();
}

} // namespace

std::vector<RimGapsName> const& rim_gaps() {
    static std::vector<RimGapsName> const names{{surface::RimGaps::cut, "cut"},
                                                {surface::RimGaps::nearest, "nearest"},
                                                {surface::RimGaps::minimum, "minimum"},
                                                {surface::RimGaps::sea, "sea"}};
    return names;
}

std::vector<EnclosedGapsName> const& enclosed_gaps() {
    static std::vector<EnclosedGapsName> const names{{surface::EnclosedGaps::shore, "shore"},
                                                     {surface::EnclosedGaps::nearest, "nearest"},
                                                     {surface::EnclosedGaps::minimum, "minimum"}};
    return names;
}

bool asks_for_gaps(ExportParams const& params) {
    return !params.rim.empty() || !params.holes.empty() || params.sea_level_m;
}

void require_gap_options(ExportParams const& params) {
    surface::CloseGapsParams const gaps = gap_params(params);
    require_in("export.run_export", "sea-level", params.sea_level_m.value_or(0.0), Range::finite(), "m");
    refuse_if<BadParameter>(gaps.rim == surface::RimGaps::sea && !gaps.sea_m, "export.run_export",
                            "--rim sea needs the height of the sea: --sea-level 0");
}

void close_gaps_of(report::Scene& scene, ExportParams const& params, ExportResult& made, Run const& run) {
    if (scene.sea) {
        refuse_if<BadInput>(asks_for_gaps(params), "export.run_export",
                            "{} has a sea at {:.6g} m, by its recipe, and its cells without data are that sea: leave "
                            "out --rim, --holes and --sea-level",
                            params.source, scene.sea->level_m);
        return;
    }
    Raster<float> const& dem = *scene.dem;
    bool const has_gaps = std::ranges::any_of(dem.values(), [](float z) { return std::isnan(z); });
    if (!has_gaps && !params.sea_level_m) {
        return;
    }
    surface::CloseGapsParams const how = gap_params(params);
    Grid const before = dem.grid();
    surface::ClosedGaps closed = surface::close_gaps(dem, how, run);
    Grid const& after = closed.dem.grid();
    made.holes = closed.rim + closed.enclosed;
    if (closed.rim > 0) {
        made.gaps.rim = rim_gaps()[static_cast<std::size_t>(how.rim)].name;
        made.gaps.rim_cells = closed.rim;
        made.gaps.is_cut = how.rim == surface::RimGaps::cut;
        made.findings.push_back({.kind = "rim",
                                 .amount = static_cast<double>(closed.rim),
                                 .text = rim_text(closed, how.rim, before, how.sea_m.has_value())});
    }
    if (closed.enclosed > 0) {
        made.gaps.holes = enclosed_gaps()[static_cast<std::size_t>(how.holes)].name;
        made.gaps.hole_cells = closed.enclosed;
        made.gaps.hole_levels_m = {closed.low_m, closed.high_m};
        made.findings.push_back({.kind = "holes",
                                 .amount = static_cast<double>(closed.enclosed),
                                 .text = holes_text(closed, how.holes, before.cells())});
    }
    if (scene.lakes.cells() > 0) {
        scene.lakes = surface::window_of(scene.lakes, closed.first, after);
    }
    if (how.sea_m) {
        made.gaps.sea_level_m = how.sea_m;
        take_sea(scene, closed, *how.sea_m, made);
    }
    scene.dem = std::move(closed.dem);
}

std::string description_of_gaps(ExportResult const& made) {
    nlohmann::ordered_json json;
    json["cells_without_data"] = made.holes;
    if (made.hole_m) {
        json["without_data_m"] = *made.hole_m;
    }
    if (!made.gaps.rim.empty()) {
        json["rim"] = {{"closed_by", made.gaps.rim}, {"cells", made.gaps.rim_cells}};
    }
    if (!made.gaps.holes.empty()) {
        json["holes"] = {{"closed_by", made.gaps.holes},
                         {"cells", made.gaps.hole_cells},
                         {"levels_m", {made.gaps.hole_levels_m.x, made.gaps.hole_levels_m.y}}};
    }
    if (made.gaps.sea_level_m) {
        json["sea_level_m"] = *made.gaps.sea_level_m;
    }
    return json.dump();
}

std::vector<RiverSpline> rivers_inside(std::vector<RiverSpline> const& rivers, Grid const& grid, ExportResult& made) {
    std::vector<RiverSpline> out;
    std::int64_t all = 0;
    std::int64_t outside = 0;
    for (RiverSpline const& river : rivers) {
        append_parts(river, grid, out);
        all += static_cast<std::int64_t>(river.line.size());
        outside += std::ranges::count_if(river.line, [&](Vec3 const& p) {
            return p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north;
        });
    }
    if (outside > 0) {
        made.findings.push_back(
            {.kind = "off_dem",
             .amount = static_cast<double>(outside),
             .text = fmt::format("{} of {} points of rivers lie where the DEM was cut off: rivers end there", outside,
                                 all)});
    }
    return out;
}

} // namespace thalweg::exports
