// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/growth/tokunaga/grow_strokes.hpp>
#include <thalweg/make/given.hpp>
#include <thalweg/make/internal/planform.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/land_and_sea.hpp>
#include <thalweg/network/import/open_ends.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

/// A frame for a branch that is rotated before it is placed in the requested grid.
recipe::GridRecipe loosely_framed(recipe::GridRecipe frame) {
    frame.width = 0;
    frame.height = 0;
    return frame;
}

/// The requested grid, or one with room for the whole branch as picked: in the former case the branch is not cut
/// further.
Grid turned_frame(growth::Branch const& branch, Grid frame, recipe::GridRecipe const& wanted, double turn_deg) {
    frame.width = wanted.width;
    frame.height = wanted.height;
    if (frame.width == 0) {
        double const c = portable::cos(turn_deg / 180.0 * portable::pi);
        double const s = portable::sin(turn_deg / 180.0 * portable::pi);
        Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        Vec2 high{-low.x, -low.y};
        for (Cell const& cell : branch.cells) {
            auto const x = static_cast<double>(cell.col);
            auto const y = static_cast<double>(cell.row);
            Vec2 const at{c * x + s * y, c * y - s * x};
            low = {std::min(low.x, at.x), std::min(low.y, at.y)};
            high = {std::max(high.x, at.x), std::max(high.y, at.y)};
        }
        auto const wide = static_cast<std::int64_t>(std::ceil(high.x - low.x + 1.0));
        auto const tall = static_cast<std::int64_t>(std::ceil(high.y - low.y + 1.0));
        std::int64_t const margin = recipe::margin_around(std::max(wide, tall));
        frame.width = wide + 2 * margin;
        frame.height = tall + 2 * margin;
    }
    recipe::check_memory(frame.width, frame.height);
    return frame;
}

/// The arm of a cluster that becomes the rivers.
growth::Branch branch_of(growth::Cluster const& cluster, recipe::Recipe const& recipe) {
    growth::BranchParams params{recipe.network->branch, 0, 0, *recipe.network->rotate_deg};
    if (recipe.grid.width > 0) {
        params.max_width = recipe::room_for_network(recipe.grid.width);
        params.max_height = recipe::room_for_network(recipe.grid.height);
    }
    return growth::pick_branch(cluster, params);
}

// One arm of a cluster that grew by diffusion-limited aggregation, thinned and traced.
SourceRivers rivers_of_cluster(recipe::Recipe const& recipe, StageLog& stage_log, Run const& run) {
    recipe::NetworkRecipe const& wanted = *recipe.network;
    NetworkStatistics statistics;
    run.at(0.0, fmt::format("grow {} particles", wanted.dla.particles).c_str());
    growth::Cluster const cluster = stage_log.stage(recipe::stage::grow.name, [&] { return cluster_of(recipe, run); });
    statistics.wide = cluster.stop == growth::GrowthStop::radius;
    stage_log.say(fmt::format("{} particles  seed {}  radius {:.0f} cells{}", cluster.cells.size(), recipe.seed,
                              cluster.radius, statistics.wide ? ", where it stops" : ""));
    statistics.particles = static_cast<std::int64_t>(cluster.cells.size());
    statistics.walkers = cluster.walkers;

    growth::Branch const branch = branch_of(cluster, recipe);
    statistics.cut = branch.cut;
    double const turn_deg = *wanted.rotate_deg;
    recipe::FramedBranch const framed =
        recipe::frame_branch(branch, turn_deg == 0.0 ? recipe.grid : loosely_framed(recipe.grid));
    Mask const skeleton = stage_log.stage(recipe::stage::thin.name, [&] { return network::thin(framed.mask, run); });
    StreamNetwork network =
        stage_log.stage(recipe::stage::trace.name, [&] { return network::trace(skeleton, {framed.mouth}, run); });
    Grid grid = framed.mask.grid();
    if (turn_deg != 0.0) {
        network::RotatedNetwork turned =
            network::rotate(network, turned_frame(branch, grid, recipe.grid, turn_deg), {turn_deg});
        network = std::move(turned.network);
        grid = turned.grid;
    }
    return {.network = std::move(network), .grid = grid, .statistics = std::move(statistics)};
}

/// The area that a network fills, and its mouth.
struct Region {
    std::vector<Vec2> ring;
    Vec2 mouth;
};

/// The grid without a margin of 2 %, so that no river runs along its border.
Region within(Grid const& grid, recipe::Side mouth) {
    double const margin = 0.02 * std::min(grid.east() - grid.west, grid.north - grid.south());
    double const west = grid.west + margin;
    double const east = grid.east() - margin;
    double const south = grid.south() + margin;
    double const north = grid.north - margin;
    Vec2 const middle{0.5 * (west + east), 0.5 * (south + north)};
    Region region{{{west, south}, {east, south}, {east, north}, {west, north}}, middle};
    switch (mouth) {
    case recipe::Side::north: region.mouth.y = north; break;
    case recipe::Side::east: region.mouth.x = east; break;
    case recipe::Side::south: region.mouth.y = south; break;
    case recipe::Side::west: region.mouth.x = west; break;
    }
    return region;
}

/// A polygon of a file; the river leaves it at its extreme point on that side.
Region inside(Polygons const& polygons, recipe::Side mouth) {
    if (polygons.polygons.size() != 1 || polygons.polygons.front().rings.size() != 1) {
        std::size_t rings = 0;
        for (Polygon const& polygon : polygons.polygons) {
            rings += polygon.rings.size();
        }
        throw BadInput(
            "make.make_planform",
            fmt::format("network.tokunaga.region = \"{}\" holds {} polygons of {} rings; a network fills one "
                        "without holes",
                        polygons.name, polygons.polygons.size(), rings));
    }
    Region region{polygons.polygons.front().rings.front(), {}};
    if (region.ring.size() > 1 && region.ring.front() == region.ring.back()) {
        region.ring.pop_back();
    }
    auto const reach = [mouth](Vec2 p) {
        switch (mouth) {
        case recipe::Side::north: return p.y;
        case recipe::Side::east: return p.x;
        case recipe::Side::south: return -p.y;
        case recipe::Side::west: break;
        }
        return -p.x;
    };
    region.mouth =
        *std::max_element(region.ring.begin(), region.ring.end(), [&](Vec2 a, Vec2 b) { return reach(a) < reach(b); });
    return region;
}

std::vector<std::int64_t> downstream(growth::TokunagaTree const& tree) {
    std::vector<std::int64_t> down;
    down.reserve(tree.links.size());
    for (growth::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    return down;
}

/// Throws if less than half of a network found room; warns if much of it did not.
void judge_room(std::int64_t placed, std::int64_t dropped, Grid const& grid, StageLog& stage_log) {
    std::int64_t const all = placed + dropped;
    std::string const found =
        fmt::format("{} of {} links found no room on {} x {} cells", dropped, all, grid.width, grid.height);
    refuse_if<BadInput>(2 * placed < all || placed == 0, "make.make_planform", "[network.tokunaga]: {}: {}", found,
                        recipe::more_room);
    if (10 * placed < 9 * all) {
        stage_log.find({.kind = "links_without_room",
                        .amount = static_cast<double>(dropped),
                        .text = "[network.tokunaga]: " + found,
                        .remedy = fmt::format("To give them room, {}", recipe::more_room),
                        .key = "network.tokunaga",
                        .numbers = {{"links", static_cast<double>(all)}}});
    }
}

SourceRivers fill_region(RiversInput const& in, StageLog& stage_log, Run const& run) {
    recipe::TokunagaRecipe const& wanted = in.recipe.network->tokunaga;
    growth::TokunagaTree const& tree = *in.tree;
    Grid const& grid = *in.grid;
    TokunagaStatistics statistics;
    statistics.tree = network::count_streams(downstream(tree));
    Region const region = in.region ? inside(*in.region, wanted.mouth) : within(grid, wanted.mouth);
    growth::EmbedParams params;
    params.seed = in.recipe.seed;
    params.region = region.ring;
    params.mouth = region.mouth;
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    growth::EmbeddedTree embedded =
        stage_log.stage(recipe::stage::embed.name, [&] { return growth::embed_tree(tree, params, run); });
    statistics.placed = embedded.placed;
    statistics.dropped = embedded.dropped;
    stage_log.say(
        fmt::format("{} of {} links placed, {:.0f} m apart", embedded.placed, tree.links.size(), embedded.spacing_m));
    judge_room(embedded.placed, embedded.dropped, grid, stage_log);
    return {.network = std::move(embedded.network), .grid = grid, .statistics = {.tokunaga = std::move(statistics)}};
}

SourceRivers follow_strokes(RiversInput const& in, StageLog& stage_log, Run const& run) {
    recipe::TokunagaRecipe const& wanted = in.recipe.network->tokunaga;
    Grid const& grid = *in.grid;
    growth::StrokesParams params;
    params.tree = recipe::tree_of(in.recipe);
    params.max_depth = std::max(wanted.order - 1, 1); // each refinement raises the order by one
    params.min_spacing_m = wanted.spacing_cells * grid.cell_m;
    growth::GrownStrokes grown =
        stage_log.stage(recipe::stage::grow.name, [&] { return growth::grow_strokes(in.lines, grid, params, run); });
    TokunagaStatistics statistics;
    statistics.placed = grown.placed;
    statistics.dropped = grown.dropped;
    stage_log.say(fmt::format("{} of {} links placed", grown.placed, grown.placed + grown.dropped));
    judge_room(grown.placed, grown.dropped, grid, stage_log);
    return {.network = std::move(grown.network), .grid = grid, .statistics = {.tokunaga = std::move(statistics)}};
}

// Networks that branch by Tokunaga's law: one that fills the grid or a region, or one along each stroke of a file.
SourceRivers rivers_of_tree(RiversInput const& in, StageLog& stage_log, Run const& run) {
    return in.tree ? fill_region(in, stage_log, run) : follow_strokes(in, stage_log, run);
}

// Trees that grow from a coast or border inland until the land is full of them. Every outlet lies there.
SourceRivers rivers_of_forest(recipe::Recipe const& recipe, Grid const& grid, recipe::ForestLand const& on,
                              StageLog& stage_log, Run const& run) {
    recipe::ForestRecipe const& wanted = recipe.network->forest;
    growth::ForestParams params = wanted.growth;
    params.step_cells = wanted.spacing_cells / 2;
    params.seed = recipe.seed;
    growth::PlantedForest planted = stage_log.stage(recipe::stage::grow.name, [&] {
        return growth::plant_forest(on.has_sea ? on.land : Mask(grid, 1), on.outlets, params, run);
    });
    stage_log.say(fmt::format("{} trees of {} particles  seed {}", planted.outlets, planted.particles, recipe.seed));
    stage_log.find(planted.notes);
    NetworkStatistics statistics;
    statistics.particles = planted.particles;
    statistics.walkers = planted.walkers;
    statistics.full = planted.stop == growth::ForestStop::full;
    return {.network = std::move(planted.network), .grid = grid, .land = on.land, .statistics = std::move(statistics)};
}

/// The lines of the file that are not rivers.
std::vector<Finding> left_out(RiverLines const& lines) {
    std::vector<Finding> findings;
    for (SecondaryLine const& one : lines.secondary) {
        if (one.cause == LeftOut::grid) {
            continue;
        }
        findings.push_back({"secondary", one.feature, in_plan(one.vertices.front()), length_in_plan(one.vertices),
                            fmt::format("line {} is not a river: {}", one.feature, one.reason)});
    }
    return findings;
}

/// Warns where rivers end or begin near a lake without reaching its shore.
void warn_of_shores(StreamNetwork const& network, std::span<network::Hollow const> beside,
                    std::vector<Polygon> const& lakes, double cell_m, StageLog& stage_log) {
    constexpr double reached_cells = 2.0;
    std::size_t rivers = 0;
    double most_m = 0.0;
    Vec2 at = nowhere;
    for (network::Hollow const& hollow : beside) {
        std::vector<NodeId> ends = hollow.ends;
        auto const to_shore = [&](NodeId end) { return network::distance_to_lakes(network.node(end).at, lakes); };
        if (std::ranges::any_of(ends, [&](NodeId end) { return to_shore(end) <= reached_cells * cell_m; })) {
            continue; // lakes say themselves what they lack
        }
        ends.push_back(hollow.source);
        rivers += ends.size();
        for (NodeId const end : ends) {
            if (double const m = to_shore(end); m > most_m) {
                most_m = m;
                at = network.node(end).at;
            }
        }
    }
    if (rivers == 0) {
        return;
    }
    stage_log.find(
        {.kind = "unjoined_ends",
         .where = at,
         .amount = static_cast<double>(rivers),
         .text = fmt::format("{} rivers end or begin beside a lake, up to {:.3g} m from its shore, at ({:.0f}, {:.0f})",
                             rivers, most_m, at.x, at.y),
         .remedy = fmt::format("If they should meet it: --set network.lines.snap={}", std::ceil(most_m)),
         .key = "network.lines.snap",
         .numbers = {{"most", most_m, "m"}}});
}

/// Warns where rivers end around a place at which another one begins, as at a lake without an outline.
/// \param lakes those whose outlines are given
void warn_of_hollows(StreamNetwork const& network, std::vector<network::Hollow> found,
                     std::vector<Polygon> const& lakes, double cell_m, StageLog& stage_log) {
    constexpr double most_cells = 20.0;
    auto const beside = std::stable_partition(found.begin(), found.end(), [&](network::Hollow const& hollow) {
        return std::ranges::none_of(hollow.ends, [&](NodeId end) {
            return network::distance_to_lakes(network.node(end).at, lakes) <= most_cells * cell_m;
        });
    });
    warn_of_shores(network,
                   std::span<network::Hollow const>(found).subspan(static_cast<std::size_t>(beside - found.begin())),
                   lakes, cell_m, stage_log);
    found.erase(beside, found.end());
    if (found.empty()) {
        return;
    }
    std::size_t ends = 0;
    for (network::Hollow const& hollow : found) {
        ends += hollow.ends.size();
    }
    network::Hollow const& most =
        *std::ranges::max_element(found, {}, [](network::Hollow const& h) { return h.ends.size(); });
    Vec2 const at = network.node(most.source).at;
    stage_log.find(
        {.kind = "lake_without_outline",
         .where = at,
         .amount = static_cast<double>(ends),
         .text = fmt::format("{} at {} as at the shore of a lake, from which another one leaves; so {} up to "
                             "{:.0f} m from ({:.0f}, {:.0f}), where one begins",
                             ends == 1 ? "1 river ends" : fmt::format("{} rivers end", ends),
                             found.size() == 1 ? "1 place" : fmt::format("{} places", found.size()),
                             most.ends.size() == 1 ? "does 1" : fmt::format("do {}", most.ends.size()), most.farthest_m,
                             at.x, at.y),
         .remedy = "Give the lake's outline, --set surface.lakes=FILE or as a polygon in the river file, or "
                   "draw the river through it; if their water sinks there: --set network.inland=sink",
         .key = "surface.lakes",
         .numbers = {{"places", static_cast<double>(found.size())}}});
}

/// Warns where rivers end nearer to others than to the border, away from their mouths: they were probably meant to
/// meet.
/// \param snapped_m [m] the distance within which ends have been joined
/// \param around of these ends wide gaps are told already
void warn_of_gaps(StreamNetwork const& network, Grid const& grid, double snapped_m, bool has_sea,
                  std::vector<network::Hollow> const& around, StageLog& stage_log, Run const& run) {
    constexpr double small_cells = 3.0; // a larger snapping distance would move too much
    double const enough_m = small_cells * grid.cell_m;
    auto gaps = network::gaps_below(network, grid, has_sea ? 2.0 : 20.0, run);
    std::erase_if(gaps, [&](network::GapBelow const& gap) {
        return gap.gap_m > enough_m && std::ranges::any_of(around, [&](network::Hollow const& hollow) {
                   return std::ranges::find(hollow.ends, gap.outlet) != hollow.ends.end();
               });
    });
    if (gaps.empty()) {
        return;
    }
    bool const is_small = snapped_m < enough_m && std::ranges::any_of(gaps, [&](network::GapBelow const& gap) {
                              return gap.gap_m <= enough_m;
                          });
    if (is_small) {
        std::erase_if(gaps, [&](network::GapBelow const& gap) { return gap.gap_m > enough_m; });
    }
    auto const [least, most] = std::ranges::minmax_element(gaps, {}, &network::GapBelow::gap_m);
    Vec2 const at = network.node(least->outlet).at;
    std::string const so_far = gaps.size() == 1 ? fmt::format("{:.3g} m", least->gap_m)
                                                : fmt::format("{:.3g} to {:.3g} m", least->gap_m, most->gap_m);
    double const all_m = std::ceil(most->gap_m);
    stage_log.find(
        {.kind = "unjoined_ends",
         .where = at,
         .amount = static_cast<double>(gaps.size()),
         .text = fmt::format("{} {} from another river without meeting it, the nearest at ({:.0f}, {:.0f})",
                             gaps.size() == 1 ? "1 river ends" : fmt::format("{} rivers end", gaps.size()), so_far,
                             at.x, at.y),
         .remedy = is_small ? fmt::format("If they should meet: --set network.lines.snap={}", all_m)
                            : "If they should meet, draw what is missing between them; if their water sinks there: "
                              "--set network.inland=sink",
         .key = is_small ? "network.lines.snap" : "network.inland",
         .numbers = {{"least", least->gap_m, "m"}, {"most", most->gap_m, "m"}}});
}

/// The land bounded by a file's coastlines.
Mask land_of_coastlines(RiverLines const& lines, Grid const& grid, StageLog& stage_log, Run const& run) {
    RiverLines coast;
    for (SecondaryLine const& line : lines.secondary) {
        if (line.cause == LeftOut::coast) {
            RiverLine& one = coast.lines.emplace_back();
            one.feature = line.feature;
            one.vertices = line.vertices;
        }
    }
    network::LandAndSea divided =
        stage_log.stage(recipe::stage::sea.name, [&] { return network::land_and_sea(coast, lines, grid, run); });
    stage_log.say(fmt::format("{:.3g} % of the grid, by {} coastlines",
                              100.0 * static_cast<double>(divided.sea_cells) / static_cast<double>(grid.cells()),
                              coast.lines.size()));
    if (4 * divided.beyond > divided.behind) {
        stage_log.find({.kind = "rivers_in_sea",
                        .amount = static_cast<double>(divided.beyond),
                        .text = fmt::format("rivers lie on both sides of the coastlines of {} ({} cells, and {} on the "
                                            "side that became sea)",
                                            lines.name, divided.behind, divided.beyond),
                        .remedy = "--set network.lines.coastlines=none leaves the coastlines out",
                        .key = "network.lines.coastlines",
                        .layer = lines.name,
                        .numbers = {{"on_land", static_cast<double>(divided.behind), "cells"}}});
    }
    return std::move(divided.land);
}

/// The file's data besides the network.
RiverFile file_of(RiverLines const& lines, network::ImportedNetwork const& imported) {
    RiverFile file;
    file.secondary = lines.secondary;
    file.attributes = lines.attributes;
    for (RiverLine const& line : lines.lines) {
        if (!line.name.empty() || !line.size.empty()) {
            auto const feature = static_cast<std::size_t>(line.feature);
            file.clues.resize(std::max(file.clues.size(), feature + 1));
            file.clues[feature] = {.name = line.name, .area_m2 = line.area_m2, .size = line.size};
        }
    }
    file.sources = LineSources(imported.network, imported.stretches);
    file.secondary.insert(file.secondary.end(), imported.secondary.begin(), imported.secondary.end());
    file.imported = imported.network;
    for (RiverLine const& line : lines.lines) {
        file.taken_m += length_in_plan(line.vertices);
    }
    return file;
}

/// What heights may rise downstream by noise.
double noise_of(std::vector<std::vector<double>> const& arc_z) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::vector<double> const& heights : arc_z) {
        for (double const z : heights) {
            low = std::min(low, z);
            high = std::max(high, z);
        }
    }
    return network::noise_of_heights(low, high);
}

/// The file's heights. Where they rise downstream by noise they are lowered, which is told.
ElevatedNetwork heights_without_noise(RiverLines const& lines, network::ImportedNetwork const& imported,
                                      StageLog& stage_log) {
    network::LoweredNetwork lowered = network::lower_rises(imported.network, imported.arc_z);
    double const most_m = *std::ranges::max_element(lowered.by_m);
    if (!(most_m > 0.0) || most_m > noise_of(imported.arc_z)) {
        return network::take_file_heights({imported.network, imported.arc_z, {}}, lines);
    }
    std::int64_t arcs = 0;
    for (ArcId a = 0; a < imported.network.arc_count(); ++a) {
        if (double const by_m = lowered.by_m[a]; by_m > 0.0) {
            Arc const& arc = imported.network.arc(a);
            ++arcs;
            stage_log.find(
                {"lowered", arc.feature, arc.line.front(), by_m,
                 fmt::format("river {}: heights rise downstream; lowered by up to {:.3g} m", arc.feature, by_m)});
        }
    }
    stage_log.find({.kind = "rising_heights",
                    .amount = most_m,
                    .text = fmt::format("heights in {} rise downstream in {} of {} arcs. They are lowered there, by "
                                        "{:.3g} m at most",
                                        lines.name, arcs, lowered.by_m.size(), most_m),
                    .remedy = "\"findings\" in report.json lists these arcs (lowered)",
                    .key = "network.lines.path",
                    .layer = lines.name,
                    .numbers = {{"arcs", static_cast<double>(arcs)}}});
    return std::move(lowered.network);
}

/// The heights of the file, if the recipe uses them.
std::optional<ElevatedNetwork> heights_of_file(recipe::Heights heights, RiverLines const& lines,
                                               network::ImportedNetwork const& imported, StageLog& stage_log) {
    bool const or_straight =
        heights == recipe::Heights::soft || heights == recipe::Heights::fixed || heights == recipe::Heights::ends;
    if (heights == recipe::Heights::file || (or_straight && lines.has_z)) {
        return heights_without_noise(lines, imported, stage_log);
    }
    return std::nullopt;
}

// The lines of a file.
SourceRivers rivers_of_lines(RiversInput const& in, StageLog& stage_log, Run const& run) {
    recipe::LinesRecipe const& wanted = in.recipe.network->lines;
    bool const has_sea = recipe::stage::sea.runs(in.recipe, in.lines);
    bool const may_end = has_sea || in.recipe.network->inland != recipe::InlandEnds::carry;
    network::ImportParams const params{.snap_m = wanted.snap_m,
                                       .orientation = wanted.orientation,
                                       .divergences = wanted.divergences,
                                       .cell_m = wanted.snap_m > 0.0 ? 0.0 : in.grid->cell_m,
                                       .dem = in.line_dem.cells() > 0 ? &in.line_dem : nullptr,
                                       .frame = &*in.grid,
                                       .drains_lakes = !may_end};
    network::ImportedNetwork imported =
        stage_log.stage(recipe::stage::adopt.name, [&] { return network::import_lines(in.lines, params, run); });
    SourceRivers rivers;
    rivers.grid = *in.grid;
    std::vector<Finding> const left = left_out(in.lines);
    stage_log.find(left);
    if (may_end) {
        std::erase_if(imported.repairs, [](Finding const& f) { return f.kind == FindingKind("lake_without_outflow"); });
    }
    stage_log.find(imported.repairs);
    rivers.file = file_of(in.lines, imported);
    std::size_t const secondary = rivers.file.secondary.size();
    stage_log.say(fmt::format("{} arcs, {} repairs{}", imported.network.arc_count(),
                              left.size() + imported.repairs.size(),
                              secondary == 0 ? "" : fmt::format(", {} secondary", secondary)));
    stage_log.find(direction_findings(imported.directions, params.dem != nullptr ? "" : "--set network.lines.dem=FILE",
                                      "--set network.lines.orientation=as_drawn (or height, rank, topology)"));
    stage_log.find(imported.directions.doubts);
    std::vector<network::Hollow> const around =
        may_end ? std::vector<network::Hollow>() : network::hollows(imported.network, rivers.grid, run);
    warn_of_gaps(imported.network, rivers.grid, wanted.snap_m, has_sea, around, stage_log, run);
    warn_of_hollows(imported.network, around, in.lines.lakes, rivers.grid.cell_m, stage_log);
    rivers.land = has_sea ? land_of_coastlines(in.lines, rivers.grid, stage_log, run) : Mask{};
    rivers.file_heights = heights_of_file(in.recipe.network->heights, in.lines, imported, stage_log);
    rivers.network = std::move(imported.network);
    return rivers;
}

/// Land without the gaps of DEMs: rivers end there as at the sea.
Mask without_gaps(Mask land, Raster<float> const& dem, Mask const& gaps) {
    auto const leave_out = [&](std::int64_t i, Grid const& grid) {
        land = land.cells() > 0 ? std::move(land) : Mask(grid, 1);
        land[i] = 0;
    };
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isnan(dem[i])) {
            leave_out(i, dem.grid());
        }
    }
    for (std::int64_t i = 0; i < gaps.cells(); ++i) {
        if (gaps[i] == 0) {
            leave_out(i, gaps.grid());
        }
    }
    return land;
}

SourceRivers rivers_by_source(RiversInput const& in, StageLog& stage_log, Run const& run) {
    switch (in.recipe.network->source) {
    case recipe::Source::dla: return rivers_of_cluster(in.recipe, stage_log, run);
    case recipe::Source::tokunaga: return rivers_of_tree(in, stage_log, run);
    case recipe::Source::forest: return rivers_of_forest(in.recipe, *in.grid, *in.forest, stage_log, run);
    case recipe::Source::lines: break;
    }
    return rivers_of_lines(in, stage_log, run);
}

} // namespace

growth::Cluster cluster_of(recipe::Recipe const& recipe, Run const& run) {
    recipe::Recipe const read = recipe::recipe_for_cluster(recipe);
    return cached(
        run, "cluster", [&] { return recipe::cache_key(read); },
        [&] { return growth::grow_dla(read.network->dla, run); },
        [](growth::Cluster const& cluster) { return static_cast<std::int64_t>(cluster.cells.size() * sizeof(Cell)); });
}

SourceRivers rivers_of_source(RiversInput const& in, StageLog& stage_log, Run const& run) {
    SourceRivers rivers = rivers_by_source(in, stage_log, run);
    rivers.land = without_gaps(std::move(rivers.land), in.raster, in.gaps);
    return rivers;
}

} // namespace thalweg::make
