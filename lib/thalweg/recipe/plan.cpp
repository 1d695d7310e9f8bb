// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/plan.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/planform/rotate.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/internal/forecast.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stage_recipes.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::recipe {
namespace {

/// The land on its grid: the region's polygons, an island, or all of it.
Mask land_of(Recipe const& recipe, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    if (wanted.region.empty()) {
        Grid const grid = frame_tree(1, recipe.grid);
        return wanted.shape == LandShape::island ? growth::shape_island(grid, {wanted.ruggedness, recipe.seed}, run)
                                                 : Mask(grid, 1);
    }
    Polygons const polygons = io::read_polygons(file_in(recipe, wanted.region), recipe.grid.crs, run);
    return blend::mask_polygons(polygons, frame_polygons(polygons, recipe.grid));
}

/// Selects the cells that lie near marked ones.
std::vector<Cell> near_to(Mask const& marked, std::vector<Cell> const& cells, std::int64_t reach) {
    std::vector<Cell> found;
    for (Cell const c : cells) {
        bool near = false;
        cells_around(marked.grid(), c, reach, [&](Cell other) { near = near || marked[other] != 0; });
        if (near) {
            found.push_back(c);
        }
    }
    return found;
}

std::vector<Cell> spread(Recipe const& recipe, Mask const& land, std::vector<Cell> const& coast, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    constexpr std::int64_t spacings = 6;
    std::int64_t const every =
        wanted.outlet_spacing_cells > 0 ? wanted.outlet_spacing_cells : spacings * wanted.spacing_cells;
    return growth::spread_outlets(land, coast, {wanted.seeds, static_cast<double>(every), recipe.seed}, run);
}

/// The coast cells nearest to the points of a file.
std::vector<Cell> at_points(Recipe const& recipe, Mask const& land, StageLog& stage_log, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    Grid const& grid = land.grid();
    refuse_if<BadInput>(wanted.seeds > 0, "recipe.resolve",
                        "network.forest.outlets = \"{}\" holds points, each an outlet; leave network.forest.seeds out",
                        wanted.outlets);
    refuse_if<BadInput>(
        wanted.outlet_spacing_cells > 0 && recipe.set_at.contains("network.forest.outlet_spacing"), "recipe.resolve",
        "network.forest.outlets = \"{}\" holds points, each an outlet; leave network.forest.outlet_spacing out",
        wanted.outlets);
    io::ReadPointsParams params;
    params.path = file_in(recipe, wanted.outlets);
    params.crs = grid.crs;
    params.heights = io::PointHeights::passed_over;
    std::vector<Cell> const coast = growth::coast_cells(land);
    std::vector<Cell> outlets;
    FeaturePoints const points = io::read_points(params, run);
    stage_log.find(points.findings);
    for (Vec3 const& p : points.points) {
        run.check();
        Vec2 const at{p.x, p.y};
        auto const nearest = std::ranges::min_element(coast, {}, [&](Cell c) {
            Vec2 const there = grid.centre(c);
            return (there.x - at.x) * (there.x - at.x) + (there.y - at.y) * (there.y - at.y);
        });
        if (nearest == coast.end()) {
            return {}; // no land: reported when the forest is planted
        }
        double const moved = distance(at, grid.centre(*nearest));
        if (moved > grid.cell_m) {
            stage_log.find({"moved_outlet", 0, grid.centre(*nearest), moved,
                            fmt::format("the outlet at ({:.1f}, {:.1f}) lies off the coast and was moved {:.0f} m to "
                                        "cell ({}, {})",
                                        at.x, at.y, moved, nearest->col, nearest->row)});
        }
        outlets.push_back(*nearest);
    }
    return outlets;
}

/// The coast along the lines of a file, or along its polygons, which become water.
std::vector<Cell> coast_along_file(Recipe const& recipe, Mask& land, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    Grid const& grid = land.grid();
    io::Source const file = file_in(recipe, wanted.outlets);
    Mask marked;
    std::int64_t reach = 1;
    if (io::holds_polygons(file)) {
        marked = blend::mask_polygons(io::read_polygons(file, grid.crs, run), grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            land[i] = marked[i] != 0 ? 0 : land[i];
        }
    } else {
        RiverLines const lines = io::read_rivers({.path = file, .crs = grid.crs}, run);
        marked = cells_under(network::clip_lines(lines, grid), grid, wanted.outlets);
        reach = wanted.spacing_cells; // coasts are drawn at different levels of detail
    }
    std::vector<Cell> coast = near_to(marked, growth::coast_cells(land), reach);
    refuse_if<BadInput>(coast.empty(), "recipe.resolve",
                        "network.forest.outlets: no coast of the land lies within {} cells of {}; give outlets on the "
                        "coast, or the region whose coast they lie on",
                        reach, wanted.outlets);
    return coast;
}

std::vector<Cell> outlets_of(Recipe const& recipe, Mask& land, StageLog& stage_log, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    io::Source const file = file_in(recipe, wanted.outlets);
    if (wanted.outlets.empty()) {
        std::vector<Cell> const coast = growth::coast_cells(land);
        return coast.empty() ? coast : spread(recipe, land, coast, run);
    }
    bool const points = io::is_text_of_points(file.path) || io::is_point_cloud(file.path) ||
                        (!io::holds_polygons(file) && io::content_of(file).kind == io::FileContent::Kind::points);
    return points ? at_points(recipe, land, stage_log, run)
                  : spread(recipe, land, coast_along_file(recipe, land, run), run);
}

// The recipe with the CRS of its grid, which may be that of a region.
Recipe on_crs_of_region(Recipe recipe) {
    std::string const& region = recipe.network->forest.region;
    std::string& crs = recipe.grid.crs;
    crs = !crs.empty()     ? crs_of_grid(crs)
          : region.empty() ? crs_of_grid("EPSG:32631")
                           : io::crs_for_polygons(file_in(recipe, region));
    return recipe;
}

// The land of a recipe with its CRS (the region's polygons, an island, or all of the grid) and its outlets.
ForestLand forest_land(Recipe const& recipe, Mask land, Raster<float> const& raster, StageLog& stage_log,
                       Run const& run) {
    ForestLand found;
    found.land = std::move(land);
    for (std::int64_t i = 0; i < raster.cells(); ++i) {
        found.land[i] = std::isnan(raster[i]) ? 0 : found.land[i];
    }
    found.outlets = outlets_of(recipe, found.land, stage_log, run);
    found.has_sea = std::ranges::any_of(found.land.values(), [](std::uint8_t v) { return v == 0; });
    if (!found.has_sea) {
        found.land = {};
    }
    return found;
}

/// Throws before a hopeless network is laid out: links would be at less than half the distance they keep.
void require_room(std::int64_t links, Grid const& grid, double spacing_cells) {
    double const apart = std::sqrt(static_cast<double>(grid.cells()) / static_cast<double>(links));
    double const kept = std::max(spacing_cells, 1.0);
    refuse_if<BadInput>(
        links > 1 && apart < 0.5 * kept, "recipe.resolve",
        "[network.tokunaga]: {} links on {} x {} cells lie {:.2g} cells apart, and keep {} cells from one another: {}",
        links, grid.width, grid.height, apart, kept, more_room);
}

// Plans a tree that fills the grid or a region.
Plan plan_tree(Recipe recipe, StageLog& stage_log, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    recipe.grid.crs = crs_of_grid(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    Plan plan;
    plan.tree = stage_log.stage(stage::grow.name, [&] { return growth::grow_tokunaga(tree_of(recipe), run); });
    stage_log.say(
        fmt::format("lambda {}  order {}  {} links", wanted.generator, wanted.order, plan.tree->links.size()));
    if (!wanted.region.empty()) {
        plan.region = io::read_polygons(file_in(recipe, wanted.region), recipe.grid.crs, run);
    }
    auto const links = static_cast<std::int64_t>(plan.tree->links.size());
    plan.grid = plan.region ? frame_polygons(*plan.region, recipe.grid) : frame_tree(links, recipe.grid);
    require_room(links, *plan.grid, wanted.spacing_cells);
    plan.recipe = std::move(recipe);
    return plan;
}

// Plans a tree along each stroke of a file.
Plan plan_strokes(Recipe recipe, StageLog& stage_log, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    std::string const crs = recipe.grid.crs.empty() ? "" : crs_of_grid(recipe.grid.crs);
    RiverLines strokes = stage_log.stage(stage::read.name, [&] {
        return io::read_rivers({.path = file_in(recipe, wanted.strokes), .layer = wanted.layer, .crs = crs}, run);
    });
    if (!strokes.findings.empty()) { // a user who draws strokes needs each of them
        Finding const& none = strokes.findings.front();
        throw BadInput(
            "recipe.resolve",
            fmt::format("stroke {} of {} at ({:.3f}, {:.3f}) is a single point or has no geometry; remove it",
                        none.feature, strokes.name, none.where.x, none.where.y));
    }
    recipe.grid.crs = strokes.crs;
    stage_log.say(fmt::format("{} strokes from {}", strokes.lines.size(), strokes.name));
    Plan plan;
    plan.grid = frame_lines(strokes, recipe.grid);
    plan.lines = std::move(strokes);
    plan.recipe = std::move(recipe);
    return plan;
}

void require_files(Recipe const& recipe) {
    for (NamedFile const& file : files_of(recipe)) {
        std::error_code ignored;
        if (!std::filesystem::exists(file_in(recipe, file.name).path, ignored)) {
            throw BadInput("recipe.resolve",
                           fmt::format("{} = \"{}\": there is no such file", file.key->place(file.item), file.name));
        }
    }
}

/// Plans a cluster, whose grid is known only if it is requested.
Plan plan_cluster(Recipe recipe) {
    NetworkRecipe& wanted = *recipe.network;
    recipe.grid.crs = crs_of_grid(recipe.grid.crs.empty() ? "EPSG:32631" : recipe.grid.crs);
    Plan plan;
    if (recipe.grid.width > 0) {
        plan.grid = frame_tree(1, recipe.grid);
    }
    check_memory_of_cluster(wanted.dla.particles);
    growth::require_growth(wanted.dla);
    wanted.dla.seed = recipe.seed;
    wanted.rotate_deg = wanted.rotate_deg.value_or(in_equilibrium(recipe) ? network::random_turn(recipe.seed) : 0.0);
    plan.recipe = std::move(recipe);
    return plan;
}

Plan plan_forest(Recipe recipe, Raster<float> const& raster, StageLog& stage_log, Run const& run) {
    Plan plan;
    plan.recipe = on_crs_of_region(std::move(recipe));
    Mask land = stage_log.stage(stage::shape.name, [&] { return land_of(plan.recipe, run); });
    plan.grid = land.grid();
    plan.forest = forest_land(plan.recipe, std::move(land), raster, stage_log, run);
    return plan;
}

/// Clips lines to their grid, and to its land.
RiverLines clipped(RiverLines lines, Grid const& grid, Mask const& land) {
    lines = network::end_at_edge(lines, grid);
    if (land.cells() > 0) {
        lines = network::clip_lines(lines, land);
    }
    refuse_if<BadInput>(lines.lines.empty(), "recipe.resolve", "grid: no river of {} runs inside the grid", lines.name);
    return lines;
}

Mask with_heights(Raster<float> const& raster) {
    Mask land(raster.grid());
    std::ranges::transform(raster.values(), land.values().begin(), [](float z) { return std::isnan(z) ? 0 : 1; });
    return land;
}

/// Chooses heights of the file where the recipe leaves them open and lines have them.
Plan with_heights_of_lines(Plan plan, RiverLines const& lines) {
    Heights& heights = plan.recipe.network->heights;
    if (heights == Heights::automatic && lines.has_z && !on_raster(plan.recipe)) {
        plan.heights_of_file = true;
        heights = Heights::file;
    }
    refuse_if<BadInput>(heights == Heights::file && !lines.has_z, "recipe.resolve",
                        "network.heights = \"file\", but {} has lines without Z; choose other heights", lines.name);
    return plan;
}

Plan plan_lines(Recipe recipe, Raster<float> const& raster, StageLog& stage_log, Run const& run) {
    Recipe const of_lines = recipe_for_lines(recipe);
    RiverLines lines = stage_log.stage(stage::read.name, [&] {
        return cached(
            run, "lines", [&] { return cache_key(of_lines); }, [&] { return read_lines(of_lines, run); },
            [](RiverLines const& read) {
                constexpr std::int64_t of_line = 1024; // vertices and attributes
                return of_line * static_cast<std::int64_t>(read.lines.size() + read.secondary.size());
            });
    });
    stage_log.say(fmt::format("{} lines from {}", lines.lines.size(), lines.name));
    stage_log.find(lines.findings);
    OnLines settled = settle_on_lines(std::move(recipe), lines, stage_log, run);
    Plan plan;
    plan.recipe = std::move(settled.recipe);
    Grid const grid = frame_lines(lines, plan.recipe.grid);
    stage_log.find({.kind = "grid",
                    .amount = grid.cell_m,
                    .text = fmt::format("{}x{} cells of {} m{}", grid.width, grid.height, grid.cell_m, settled.why),
                    .numbers = {{"width", static_cast<double>(grid.width), "cells"},
                                {"height", static_cast<double>(grid.height), "cells"}}});
    plan.grid = grid;
    plan = with_heights_of_lines(std::move(plan), lines);
    if (!plan.recipe.output.against.empty()) {
        AgainstOnGrid on = against_on_grid(plan.recipe, grid, stage_log, run);
        plan.against = std::move(on.dem);
        bool const rebuilt = in_equilibrium(plan.recipe) && plan.recipe.network->heights == Heights::file;
        plan.land = rebuilt ? std::move(on.land) : Mask{};
        if (auto const gaps = std::ranges::count(plan.land.values(), 0); gaps > 0) {
            stage_log.find(
                {.kind = "gaps",
                 .amount = static_cast<double>(gaps),
                 .text = fmt::format("{} cells without data in {} are no land", gaps, plan.recipe.output.against),
                 .key = "output.against"});
        }
    }
    Mask const land = raster.cells() > 0 ? with_heights(raster) : plan.land;
    plan.lines = plan.recipe.grid.clip ? clipped(std::move(lines), grid, land) : std::move(lines);
    LinesRecipe const& wanted = plan.recipe.network->lines;
    if (wanted.orientation == network::Orientation::automatic) {
        plan.line_dem =
            read_dem_in(file_in(plan.recipe, wanted.dem), grid.crs, "network.lines.dem", {}, stage_log, run);
    }
    return plan;
}

// The points of [skeleton], from a file, or none. Their CRS is the grid's, also without points.
FeaturePoints given_points(Recipe const& recipe, Run const& run) {
    FeaturePoints points;
    std::string const crs = recipe.grid.crs.empty() ? "" : crs_of_grid(recipe.grid.crs);
    if (recipe.skeleton && !recipe.skeleton->points.empty()) {
        std::string const& name = recipe.skeleton->points;
        io::Source const file = file_in(recipe, name);
        // Of a cloud nobody can remove one of two points.
        auto const duplicates =
            io::is_point_cloud(file.path) ? io::DuplicatePoints::averaged : io::DuplicatePoints::refused;
        points = io::read_points({.path = file,
                                  .crs = crs,
                                  .duplicates = duplicates,
                                  .height_column = recipe.skeleton->height_column,
                                  .nodata = recipe.skeleton->nodata,
                                  .height_option = "--set skeleton.height_column=",
                                  .nodata_option = "--set skeleton.nodata="},
                                 run);
    }
    if (points.crs.empty()) {
        points.crs = crs_of_grid(crs.empty() ? "EPSG:32631" : crs);
    }
    return points;
}

/// The points inside the grid, where what lies off it is left out, with a finding.
FeaturePoints inside(FeaturePoints points, Recipe const& recipe, Grid const& grid, StageLog& stage_log) {
    auto const count = points.points.size();
    std::erase_if(points.points, [&](Vec3 const& p) {
        return p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north;
    });
    if (auto const off = count - points.points.size(); off > 0) {
        stage_log.find({.kind = "points_off_grid",
                        .amount = static_cast<double>(off),
                        .text = fmt::format("{} of the {} points of {} lie off the grid and are left out", off, count,
                                            recipe.skeleton->points),
                        .key = "skeleton.points",
                        .numbers = {{"points", static_cast<double>(count)}}});
    }
    return points;
}

/// Reads the points and ridges of [skeleton].
Plan with_skeleton(Plan plan, StageLog& stage_log, Run const& run) {
    plan.points = plan.recipe.skeleton ? given_points(plan.recipe, run) : FeaturePoints{};
    stage_log.find(plan.points.findings);
    plan.ridge_lines = read_ridge_lines(plan.recipe, run);
    stage_log.find(plan.ridge_lines.findings);
    if (plan.grid && plan.recipe.grid.clip) {
        plan.points = inside(std::move(plan.points), plan.recipe, *plan.grid, stage_log);
        plan.ridge_lines = network::clip_lines(plan.ridge_lines, *plan.grid);
    }
    return plan;
}

/// Plans terrain without rivers.
Plan plan_points(Recipe recipe, StageLog& stage_log, Run const& run) {
    Plan plan;
    plan.points = given_points(recipe, run);
    stage_log.find(plan.points.findings);
    recipe.grid.crs = plan.points.crs;
    plan.grid = frame_land(plan.points, recipe.grid);
    plan.recipe = std::move(recipe);
    return plan;
}

/// Plans by the source of rivers and terrain.
Plan by_source(Recipe const& recipe, Raster<float> const& raster, StageLog& stage_log, Run const& run) {
    if (!recipe.network) {
        return plan_points(recipe, stage_log, run);
    }
    switch (recipe.network->source) {
    case Source::dla: return plan_cluster(recipe);
    case Source::forest: return plan_forest(recipe, raster, stage_log, run);
    case Source::lines: return plan_lines(recipe, raster, stage_log, run);
    case Source::tokunaga: break;
    }
    return recipe.network->tokunaga.strokes.empty() ? plan_tree(recipe, stage_log, run)
                                                    : plan_strokes(recipe, stage_log, run);
}

/// The default strength of meanders: less on a coast, where short rivers fall to the sea.
double meander_of(Plan const& plan) {
    bool const has_sea = plan.forest && plan.forest->has_sea;
    return !grown_for_land(plan.recipe) ? 0.0 : has_sea ? 0.3 : 1.0;
}

/// Resolves settings that depend on the source of the rivers, and their points.
Plan with_rivers_settled(Plan plan, StageLog& stage_log, Run const& run) {
    if (!plan.recipe.network) {
        return plan;
    }
    NetworkRecipe& rivers = *plan.recipe.network;
    if (rivers.heights == Heights::automatic && !on_raster(plan.recipe)) {
        rivers.heights = in_equilibrium(plan.recipe) ? Heights::graded : Heights::straight_repaired;
    }
    bool const all_over = rivers.source == Source::dla || rivers.source == Source::forest;
    rivers.prune_cells = rivers.prune_cells.value_or(all_over ? 20.0 : 0.0);
    rivers.meander = rivers.meander.value_or(meander_of(plan));
    refuse_unused_keys(plan.recipe); // possible now that the rivers' heights are known
    return with_skeleton(std::move(plan), stage_log, run);
}

/// Resolves settings that depend on the method of the surface.
Plan with_surface_settled(Plan plan) {
    if (!plan.recipe.surface) {
        return plan;
    }
    SurfaceRecipe& wanted = *plan.recipe.surface;
    EquilibriumRecipe& land = wanted.equilibrium;
    bool const has_rivers = plan.recipe.network.has_value();
    if (has_rivers && !stage::raise.runs(plan.recipe) && !land.mean_slope_deg && land.like.empty() &&
        !(wanted.dilate.relief_m > 0.0)) {
        land.mean_slope_deg = from_lines(plan.recipe) ? usual_slope_deg(plan.recipe.grid.cell_m)
                                                      : surface::EquilibriumParams{}.mean_slope_deg;
    }
    wanted.drain = wanted.drain.value_or(has_rivers ? flow::Conditioning::carve : flow::Conditioning::none);
    return plan;
}

/// Reads the DEMs that the terrain shall be like, and be compared with.
Plan with_dems(Plan plan, StageLog& stage_log, Run const& run) {
    if (plan.recipe.surface && !plan.recipe.surface->equilibrium.like.empty()) {
        plan.like = measure_like(plan.recipe, plan.recipe.grid.cell_m, stage_log, run);
    }
    if (plan.against.cells() == 0) {
        plan.against = read_against(plan.recipe, plan.recipe.grid.crs, stage_log, run);
    }
    return plan;
}

/// Throws if the grid, if known, cannot hold the planned features.
void require_fit(Plan const& plan) {
    if (!plan.grid) {
        return;
    }
    require_memory(plan.recipe, plan.lines, *plan.grid);
    check_detail(plan.recipe, plan.grid->width, plan.grid->height);
    require_skeleton_on_grid(plan.recipe, plan.points, plan.ridge_lines, *plan.grid);
}

/// The DEM that is the surface, if there is one, on the grid that it settles.
OnRaster with_raster(Recipe const& recipe, StageLog& stage_log, Run const& run) {
    if (!on_raster(recipe)) {
        return {.grid = recipe.grid};
    }
    require_files(recipe);
    Recipe const of_raster = recipe_for_raster(recipe);
    OnRaster on = stage_log.stage(stage::raster.name, [&] {
        return cached(
            run, "raster", [&] { return cache_key(of_raster); }, [&] { return settle_on_raster(of_raster, run); },
            [](OnRaster const& made) { return made.dem.cells() * static_cast<std::int64_t>(sizeof(float)); });
    });
    stage_log.find(on.findings);
    Grid const& grid = on.dem.grid();
    auto const without = std::ranges::count_if(on.dem.values(), [](float z) { return std::isnan(z); });
    stage_log.say(fmt::format("{}x{} cells of {:.6g} m{}", grid.width, grid.height, grid.cell_m,
                              without > 0 ? fmt::format(", {} without data", without) : ""));
    return on;
}

} // namespace

growth::TokunagaParams tree_of(Recipe const& recipe) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    growth::TokunagaParams params;
    params.seed = recipe.seed;
    params.generator = wanted.generator;
    params.order = wanted.order;
    params.rule = wanted.rule;
    return params;
}

Plan resolve(Recipe const& recipe, Run const& run) {
    check_recipe(recipe);
    StageLog stage_log(run);
    OnRaster on = with_raster(recipe, stage_log, run);
    Recipe on_grid = recipe;
    on_grid.grid = std::move(on.grid);
    Plan plan = by_source(on_grid, on.dem, stage_log, run);
    plan.raster = std::move(on.dem);
    plan = with_rivers_settled(std::move(plan), stage_log, run);
    plan = with_surface_settled(std::move(plan));
    require_files(plan.recipe);
    plan = with_dems(std::move(plan), stage_log, run);
    require_fit(plan);
    if (run.planned) {
        run.planned(expected_times(plan.recipe, plan.lines, cells_of(plan.recipe, plan.grid)));
    }
    plan.findings = stage_log.take_findings();
    plan.timings_s = stage_log.take();
    run.report(plan.findings);
    return plan;
}

} // namespace thalweg::recipe
