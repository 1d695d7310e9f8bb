// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/read_inputs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/texture/texture.hpp>
#include <thalweg/network/import/choose_cell.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/import/river_heights.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

/// A DEM without a CRS in this one.
Raster<float> in_crs(Raster<float> const& dem, std::string const& crs) {
    Grid grid = dem.grid();
    grid.crs = crs;
    Raster<float> framed(grid);
    std::ranges::copy(dem.values(), framed.values().begin());
    return framed;
}

Raster<float> valued_polygons(Polygons const& polygons, Grid const& grid) {
    Raster<std::int32_t> const number = blend::number_polygons(polygons, grid);
    Raster<float> field(grid, 1.0F);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (number[i] > 0) {
            field[i] = static_cast<float>(polygons.polygons[static_cast<std::size_t>(number[i] - 1)].value);
        }
    }
    return field;
}

/// The reason for the cell size.
std::string reason(network::ChosenCell const& chosen) {
    std::string words = fmt::format(", from {} lines of {:.4g} km in all, {:.2g} km apart", chosen.lines,
                                    chosen.length_m / 1000.0, chosen.spacing_m / 1000.0);
    return words;
}

/// Warns where rivers are too close together for the cells.
void warn_of_crowding(network::ChosenCell const& chosen, StageLog& stage_log) {
    constexpr double worth_a_word = 0.002;
    if (chosen.crowded_share <= worth_a_word) {
        return;
    }
    stage_log.find(
        {.kind = "crowded_rivers",
         .amount = chosen.crowded_share,
         .text = fmt::format("{:.1f} % of the river cells lie beside another river", 100.0 * chosen.crowded_share),
         .remedy = chosen.enough_m > 0.0 ? fmt::format("--set grid.cell={} keeps them apart", chosen.enough_m)
                                         : "Take a part of the rivers, or set a smaller grid.cell",
         .key = "grid.cell"});
}

/// A recipe with a mean slope and a bound on the steepness of rivers, if nothing says how high the terrain is, and the
/// rivers have no heights.
Recipe with_slope(Recipe recipe, bool has_z) {
    if (!in_equilibrium(recipe)) {
        return recipe;
    }
    Heights const heights = recipe.network->heights;
    bool const graded = heights == Heights::graded || (heights == Heights::automatic && !has_z);
    EquilibriumRecipe& wanted = recipe.surface->equilibrium;
    double const usual = usual_slope_deg(recipe.grid.cell_m);
    if (graded && !wanted.mean_slope_deg && wanted.like.empty() && !(recipe.surface->dilate.relief_m > 0.0)) {
        wanted.steepness = wanted.steepness.value_or(usual_steepness);
        if (usual != surface::EquilibriumParams{}.mean_slope_deg) {
            wanted.mean_slope_deg = usual;
        }
    }
    return recipe;
}

/// Adds the lakes of surface.lakes, through which rivers run on.
RiverLines with_lakes_of_surface(RiverLines lines, Recipe const& recipe, Run const& run) {
    if (!recipe.surface || recipe.surface->equilibrium.lakes.empty()) {
        return lines;
    }
    Polygons lakes = io::read_polygons(file_in(recipe, recipe.surface->equilibrium.lakes), lines.crs, run);
    for (Polygon& lake : lakes.polygons) {
        lines.lakes.push_back(std::move(lake));
    }
    lines.lakes = io::united(std::move(lines.lakes), io::gap_between_sheets_m);
    return lines;
}

RiverLines without_placeholders(RiverLines lines) {
    network::WithoutPlaceholders checked = network::without_placeholders(std::move(lines));
    if (checked.vertices > 0) {
        Finding found = placeholder_finding(checked);
        found.key = "network.lines.path";
        checked.lines.findings.push_back(std::move(found));
    }
    return std::move(checked.lines);
}

/// The grid of a recipe, where a DEM settles what it leaves open: its own cells, or as large ones in another coordinate
/// system, from its north-western corner to its south-eastern one.
Grid grid_of_raster(Raster<float> const& dem, GridRecipe const& wanted, char const* where, std::string const& what) {
    Grid const& own = dem.grid();
    bool const is_same = io::same_crs(own.crs, wanted.crs, what, "the grid");
    Grid grid = own;
    grid.crs = wanted.crs;
    grid.cell_m = wanted.cell_m > 0.0 ? wanted.cell_m : is_same ? own.cell_m : io::ground_cell(own).side_m;
    if (!is_same) {
        grid.west = wanted.origin ? (*wanted.origin)[0] : 0.0;
        grid.north = wanted.origin ? (*wanted.origin)[1] : 0.0;
        grid = io::grid_around(dem, grid, what);
    }
    double const east = grid.west + static_cast<double>(grid.width) * (is_same ? own.cell_m : grid.cell_m);
    double const south = grid.north - static_cast<double>(grid.height) * (is_same ? own.cell_m : grid.cell_m);
    if (wanted.origin) {
        grid.west = (*wanted.origin)[0];
        grid.north = (*wanted.origin)[1];
    }
    constexpr double least_cells = 0.01; // as in io::same_lattice
    auto const whole = [&](double m) { return std::floor(m / grid.cell_m + least_cells); };
    double const width = wanted.width > 0 ? static_cast<double>(wanted.width) : whole(east - grid.west);
    double const height = wanted.height > 0 ? static_cast<double>(wanted.height) : whole(grid.north - south);
    refuse_if<BadInput>(!(width >= 1.0 && height >= 1.0), where,
                        "{} holds no cell of {} m from ({}, {}) to the east and south: it reaches to ({}, {})", what,
                        grid.cell_m, grid.west, grid.north, east, south);
    refuse_if<BadInput>(!(width <= 1e6 && height <= 1e6), where,
                        "{} has {:.3g} x {:.3g} cells of {} m: give a larger grid.cell", what, width, height,
                        grid.cell_m);
    grid.width = static_cast<std::int64_t>(width);
    grid.height = static_cast<std::int64_t>(height);
    return grid;
}

/// A recipe's grid with the frame of this one.
GridRecipe on_cells_of(Grid const& grid, GridRecipe wanted) {
    check_memory(grid.width, grid.height);
    wanted.width = grid.width;
    wanted.height = grid.height;
    wanted.cell_m = grid.cell_m;
    wanted.origin = {grid.west, grid.north};
    return wanted;
}

std::string words_for_cells(Grid const& grid) {
    return fmt::format("{}x{} cells of {:.6g} in {:.60}", grid.width, grid.height, grid.cell_m, grid.crs);
}

/// The CRS of a DEM that names none: that of the rivers beside it, if they have one.
std::string crs_of_rivers(Recipe const& recipe, Run const& run) {
    bool const has_lines = from_lines(recipe);
    std::string const crs = has_lines ? read_lines(recipe, run.quiet()).crs : "";
    return crs.empty() ? "EPSG:32631" : crs;
}

} // namespace

Mask read_part(io::Source const& source, Grid const& grid, Run const& run) {
    if (source.path.empty()) {
        return {};
    }
    return io::holds_polygons(source) ? blend::mask_polygons(io::read_polygons(source, grid.crs, run), grid)
                                      : io::read_mask(source, grid, run);
}

Mask cells_under(RiverLines const& lines, Grid const& grid, std::string const& what) {
    Mask under(grid);
    for (RiverLine const& line : lines.lines) {
        for (Cell const c : cells_along(in_plan(line.vertices), grid, what)) {
            under[c] = 1;
        }
    }
    return under;
}

Mask read_mask_of_land(io::Source const& source, Grid const& grid, Run const& run) {
    if (source.path.empty()) {
        return {};
    }
    if (io::holds_polygons(source)) {
        return blend::mask_polygons(io::read_polygons(source, grid.crs, run), grid);
    }
    Raster<float> const given = io::read_dem(source, {.values = io::CellValues::codes});
    refuse_if<BadInput>(given.width() != grid.width || given.height() != grid.height, "recipe.read_mask_of_land",
                        "surface.mask = \"{}\" has {}x{} cells, the grid {}x{}", source.path, given.width(),
                        given.height(), grid.width, grid.height);
    Mask inside(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = !std::isnan(given[i]) && given[i] != 0.0F ? 1 : 0;
    }
    return inside;
}

Raster<float> read_field(io::Source const& source, Grid const& grid, std::string const& what, Run const& run) {
    if (source.path.empty()) {
        return {};
    }
    Raster<float> field;
    if (io::holds_polygons(source)) {
        field = valued_polygons(io::read_polygons(source, grid.crs, "erodibility", run), grid);
    } else {
        Raster<float> const given = io::warp_to_grid(io::read_dem(source, {.values = io::CellValues::numbers}, run),
                                                     grid, fmt::format("{} = \"{}\"", what, source.path), run);
        field = Raster<float>(grid, std::numeric_limits<float>::quiet_NaN());
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const at = given.grid().cell_of(grid.centre(grid.at(i)));
            field[i] = given.grid().contains(at) ? given[at] : field[i];
        }
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (!(field[i] > 0.0F)) {
            Cell const c = grid.at(i);
            throw BadInput("recipe.read_field",
                           fmt::format("{} = \"{}\" has {} in cell ({}, {}) of the grid: every value must be above "
                                       "0",
                                       what, source.path, std::isnan(field[i]) ? "none" : fmt::format("{}", field[i]),
                                       c.col, c.row));
        }
    }
    return field;
}

Raster<float> read_dem_in(io::Source const& source, std::string const& crs, std::string const& what,
                          io::ReadDemParams const& reading, StageLog& stage_log, Run const& run) {
    if (source.path.empty()) {
        return {};
    }
    io::DemFile const read = io::read_dem_file(source, reading, run);
    stage_log.find(read.findings);
    Raster<float> const& dem = read.dem;
    Grid lattice;
    lattice.cell_m = io::ground_cell(dem.grid()).side_m;
    lattice.crs = crs;
    return io::warp_to_grid(dem, lattice, fmt::format("{} = \"{}\"", what, source.path), run);
}

LikeDem measure_like(Recipe const& recipe, double cell_m, StageLog& stage_log, Run const& run) {
    constexpr std::int64_t least_cells = 100;
    constexpr double least_lag_cells = 4.0;
    std::string const& name = recipe.surface->equilibrium.like;
    std::string const what = fmt::format("surface.like = \"{}\"", name);
    io::DemFile const read = io::read_dem_file(file_in(recipe, name), {}, run);
    stage_log.find(read.findings);
    Raster<float> const& dem = read.dem;
    Grid lattice;
    lattice.cell_m = cell_m;
    lattice.crs = dem.grid().crs.empty() ? "" : io::metric_crs(dem.grid(), what);
    double const own_m = io::ground_cell(dem.grid()).side_m;
    if (own_m > 1.5 * cell_m) {
        stage_log.find({.kind = "coarse_like",
                        .amount = own_m,
                        .text = fmt::format("{} has cells of {:.4g} m, the grid of {:.4g} m: its slopes are too gentle "
                                            "and its texture too smooth for these",
                                            what, own_m, cell_m),
                        .remedy = fmt::format("Take a finer DEM, or set grid.cell={:.4g}", own_m),
                        .key = "surface.like",
                        .numbers = {{"grid_cell", cell_m, "m"}}});
    }
    Raster<float> const there = io::warp_to_grid(dem, lattice, what, run);
    measure::Slopes const slopes = measure::slopes(there, run);
    refuse_if<BadInput>(slopes.cells < least_cells || !(slopes.mean_deg > 0.0), "recipe.measure_like",
                        "{} has {} cells of {:.4g} m with a slope: it takes {} and a mean slope above 0", what,
                        slopes.cells, cell_m, least_cells);
    measure::GradientTexture const texture = measure::gradient_texture(there, {}, run);
    LikeDem found{slopes.mean_deg, std::nan(""), 0.0};
    for (std::size_t k = 0; k < measure::texture_lags_m.size() && std::isnan(found.correlation); ++k) {
        if (measure::texture_lags_m[k] >= least_lag_cells * cell_m) {
            found.correlation = texture.correlation[k];
            found.lag_m = measure::texture_lags_m[k];
        }
    }
    stage_log.find({.kind = "like",
                    .amount = found.correlation,
                    .text = fmt::format("{}: mean slope {:.3g} degrees, gradients {:g} m apart are correlated by "
                                        "{:.2f}",
                                        name, found.mean_slope_deg, found.lag_m, found.correlation),
                    .key = "surface.like",
                    .numbers = {{"mean_slope", found.mean_slope_deg, "deg"}, {"lag", found.lag_m, "m"}}});
    return found;
}

Raster<float> read_against(Recipe const& recipe, std::string const& crs, StageLog& stage_log, Run const& run) {
    std::string const& name = recipe.output.against;
    if (name.empty()) {
        return {};
    }
    io::DemFile read = io::read_dem_file(file_in(recipe, name), {}, run);
    stage_log.find(read.findings);
    return read.dem.grid().crs.empty() ? in_crs(read.dem, crs) : std::move(read.dem);
}

AgainstOnGrid against_on_grid(Recipe const& recipe, Grid const& grid, StageLog& stage_log, Run const& run) {
    std::string const what = fmt::format("output.against = \"{}\"", recipe.output.against);
    Raster<float> dem = read_against(recipe, grid.crs, stage_log, run);
    AgainstOnGrid found{io::resample(dem, grid, what, run), {}};
    for (float& z : dem.values()) {
        z = std::isnan(z) ? 0.0F : z;
    }
    Raster<float> const without_gaps = io::resample(dem, grid, what, run);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isnan(found.dem[i]) && !std::isnan(without_gaps[i])) {
            found.land = found.land.cells() > 0 ? std::move(found.land) : Mask(grid, 1);
            found.land[i] = 0;
        }
    }
    return found;
}

double usual_slope_deg(double cell_m) {
    constexpr double finest_m = 30.0;
    constexpr double half_m = 400.0;
    double const fine_deg = surface::EquilibriumParams{}.mean_slope_deg;
    if (cell_m <= finest_m) {
        return fine_deg;
    }
    auto const share = [](double m) { return 1.0 / (1.0 + portable::pow(m / half_m, 0.9)); };
    double const fine = fine_deg / 180.0 * portable::pi;
    double const tangent = portable::sin(fine) / portable::cos(fine) * share(cell_m) / share(finest_m);
    double const degrees = portable::atan2(tangent, 1.0) / portable::pi * 180.0;
    return std::max(0.5, std::round(2.0 * degrees) / 2.0);
}

Finding placeholder_finding(network::WithoutPlaceholders const& found) {
    std::string const heights = found.zeros == found.vertices ? "0"
                                : found.zeros == 0            ? "-9999 m or less"
                                                              : "0, and of -9999 m or less,";
    std::string const why =
        found.zeros > 0 ? "; their lines, or lines that they meet, are higher than 0 there or around" : "";
    return {.kind = "placeholder_heights",
            .feature = found.first,
            .where = found.at,
            .amount = static_cast<double>(found.vertices),
            .text = fmt::format("heights of {} in {} count as missing (vertices: {}; the first is of feature {}{})",
                                heights, found.lines.name, found.vertices, found.first, why),
            .layer = found.lines.name};
}

std::string crs_of_grid(std::string const& crs) {
    return naming_key("[grid] crs", [&] { return io::projected_crs(crs); });
}

RiverLines read_lines(Recipe const& recipe, Run const& run) {
    LinesRecipe const& wanted = recipe.network->lines;
    std::string const crs = recipe.grid.crs.empty() ? "" : crs_of_grid(recipe.grid.crs);
    io::Source const file = file_in(recipe, wanted.path);
    auto const read = [&] {
        return io::read_rivers({.path = file,
                                .layer = wanted.layer,
                                .type_field = wanted.type_field,
                                .rank_field = wanted.rank_field,
                                .crs = crs,
                                .filter = wanted.filter,
                                .id_field = wanted.id_field,
                                .down_field = wanted.down_field,
                                .from_field = wanted.from_field,
                                .to_field = wanted.to_field,
                                .direction_field = wanted.direction_field,
                                .where = wanted.where,
                                .source_crs = wanted.source_crs},
                               run);
    };
    std::error_code ignored;
    RiverLines lines =
        std::filesystem::is_directory(file.path, ignored) ? naming_key("[network.lines] path", read) : read();
    lines = with_lakes_of_surface(std::move(lines), recipe, run);
    lines = without_placeholders(std::move(lines));
    lines = network::keep_connectors(std::move(lines), wanted.snap_m, run);
    auto const count = lines.lines.size();
    network::FilledHeights filled = network::fill_heights(std::move(lines), recipe.network->slope);
    if (filled.filled > 0) {
        std::string const partly = filled.partly > 0 ? fmt::format(" (with some, which stay: {})", filled.partly) : "";
        filled.lines.findings.push_back(
            {.kind = "filled_heights",
             .feature = filled.first,
             .amount = static_cast<double>(filled.filled),
             .text =
                 fmt::format("heights are missing in {} of {} lines of {}{}, the first is feature {}. Lines get them "
                             "from their own vertices and the lines they meet, with at most network.slope beyond "
                             "the last one known",
                             filled.filled, count, filled.lines.name, partly, filled.first),
             .key = "network.lines.path",
             .layer = filled.lines.name,
             .numbers = {{"lines", static_cast<double>(count)}, {"in_part", static_cast<double>(filled.partly)}}});
    }
    return std::move(filled.lines);
}

RiverLines read_ridge_lines(Recipe const& recipe, Run const& run) {
    if (!recipe.skeleton || recipe.skeleton->ridge_lines.empty()) {
        return {};
    }
    RiverLines ridges = io::read_rivers({.path = file_in(recipe, recipe.skeleton->ridge_lines),
                                         .crs = recipe.grid.crs.empty() ? "" : crs_of_grid(recipe.grid.crs),
                                         .height_field = recipe.skeleton->ridge_height_column},
                                        run);
    bool const all_zero = std::ranges::all_of(ridges.lines, [](RiverLine const& ridge) {
        return std::ranges::all_of(ridge.vertices, [](Vec3 const& v) { return !std::isfinite(v.z) || v.z == 0.0; });
    });
    for (RiverLine& ridge : ridges.lines) {
        for (Vec3& v : ridge.vertices) {
            v.z = all_zero ? std::nan("") : v.z;
        }
        ridge.vertices = network::with_heights_between(std::move(ridge.vertices));
    }
    return ridges;
}

OnLines settle_on_lines(Recipe recipe, RiverLines const& lines, StageLog& stage_log, Run const& run) {
    recipe.grid.crs = lines.crs;
    if (recipe.grid.cell_m > 0.0) {
        return {with_slope(std::move(recipe), lines.has_z), ""};
    }
    if (recipe.grid.width == 0) {
        require_no_stray_vertex(lines);
    }
    network::ChosenCell const chosen =
        network::choose_cell(lines, {.width = recipe.grid.width, .height = recipe.grid.height}, run);
    recipe.grid.cell_m = chosen.cell_m;
    warn_of_crowding(chosen, stage_log);
    return {with_slope(std::move(recipe), lines.has_z), reason(chosen)};
}

Recipe on_grid_of_against(Recipe recipe, Run const& run) {
    std::string const what = fmt::format("output.against = \"{}\"", recipe.output.against);
    GridRecipe& wanted = recipe.grid;
    Raster<float> dem = io::read_dem(file_in(recipe, recipe.output.against), run);
    refuse_if<BadInput>(dem.grid().crs.empty() && wanted.crs.empty(), "recipe.on_grid_of_against",
                        "{} has no coordinate system: name that of its cells (--crs EPSG:n)", what);
    dem = dem.grid().crs.empty() ? in_crs(dem, crs_of_grid(wanted.crs)) : std::move(dem);
    wanted.crs = crs_of_grid(wanted.crs.empty() ? io::metric_crs(dem.grid(), what) : wanted.crs);
    Grid const grid = grid_of_raster(dem, wanted, "recipe.on_grid_of_against", what);
    wanted = on_cells_of(grid, std::move(wanted));
    wanted.clip = true;
    return recipe;
}

OnRaster settle_on_raster(Recipe const& recipe, Run const& run) {
    std::string const what = fmt::format("surface.source = \"{}\"", recipe.surface->source);
    io::DemFile read = io::read_dem_file(file_in(recipe, recipe.surface->source), {}, run);
    Raster<float> given = std::move(read.dem);
    std::vector<Finding> findings = std::move(read.findings);
    GridRecipe wanted = recipe.grid;
    bool const is_nowhere = given.grid().crs.empty();
    if (wanted.crs.empty()) {
        wanted.crs = is_nowhere ? crs_of_rivers(recipe, run) : io::metric_crs(given.grid(), what);
    }
    wanted.crs = crs_of_grid(wanted.crs);
    if (is_nowhere) {
        findings.push_back({.kind = "no_crs",
                            .text = fmt::format("{} has no coordinate system: its cells count as metres in {:.60}",
                                                recipe.surface->source, wanted.crs),
                            .key = "surface.source"});
        given = in_crs(given, wanted.crs);
    }
    Grid const own = given.grid();
    Grid const grid = grid_of_raster(given, wanted, "recipe.settle_on_raster", what);
    OnRaster settled{on_cells_of(grid, std::move(wanted)), io::resample(given, grid, what, run), std::move(findings)};
    refuse_if<BadInput>(std::ranges::all_of(settled.dem.values(), [](float z) { return std::isnan(z); }),
                        "recipe.settle_on_raster",
                        "{} has no height within the grid, which reaches from ({}, {}) to ({}, {}) in {:.60}: leave "
                        "grid.origin, width and height out, or move them to the DEM",
                        what, grid.west, grid.south(), grid.east(), grid.north, grid.crs);
    if (!io::same_crs(own.crs, grid.crs, what, "the grid") || !io::same_lattice(own, grid)) {
        settled.findings.push_back({.kind = "resampled",
                                    .text = fmt::format("{} is resampled from {} to {}", recipe.surface->source,
                                                        words_for_cells(own), words_for_cells(grid)),
                                    .key = "surface.source"});
    }
    return settled;
}

void require_metres(Grid const& grid, std::string const& path, char const* where) {
    io::GroundCell const ground = io::ground_cell(grid);
    io::GridUnit const unit = ground.unit;
    if (unit == io::GridUnit::distorted) {
        throw BadInput(where,
                       fmt::format("the coordinates of {} are in {:.60}, whose metres are {:.3g} m on the ground "
                                   "there: reproject it first (gdalwarp -novshift -t_srs {:.60} {} OUT.tif)",
                                   path, grid.crs, ground.side_m / grid.cell_m, ground.crs, path));
    }
    if (unit == io::GridUnit::degrees || unit == io::GridUnit::other) {
        throw BadInput(where, fmt::format("the coordinates of {} are {}: reproject it to a CRS in metres first "
                                          "(gdalwarp -novshift -t_srs)",
                                          path, unit == io::GridUnit::degrees ? "geographic" : "not in metres"));
    }
}

} // namespace thalweg::recipe
