// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/landmarks.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/recipe/condition.hpp>

namespace thalweg::report {

namespace {

constexpr std::int64_t most_cells = 1024; ///< a side: a sixteenth of it, which summits keep apart, is 64 cells

/// [cells] of the blocks whose highest cells are compared.
std::int64_t side_of_blocks(Grid const& grid) {
    return std::max<std::int64_t>(1, (std::max(grid.width, grid.height) + most_cells - 1) / most_cells);
}

Cell highest_in(Raster<float> const& dem, Cell block, std::int64_t side) {
    Cell highest{block.col * side, block.row * side};
    for (std::int64_t row = block.row * side; row < std::min((block.row + 1) * side, dem.height()); ++row) {
        for (std::int64_t col = block.col * side; col < std::min((block.col + 1) * side, dem.width()); ++col) {
            Cell const c{col, row};
            highest = std::isnan(dem[highest]) || dem[c] > dem[highest] ? c : highest;
        }
    }
    return highest;
}

} // namespace

std::optional<std::pair<double, double>> height_range(Raster<float> const& dem) {
    Run one;
    one.threads = 1;
    return overview(dem, std::max<std::int64_t>(1, dem.width()), 1, one).range;
}

Overview overview_of(Raster<float> const& dem, std::int64_t columns, Run const& run) {
    return overview(dem, columns, side_of_blocks(dem.grid()), run);
}

std::vector<Summit> summits(Raster<float> const& dem, std::size_t most, Run const& run) {
    return summits(dem, overview_of(dem, std::max<std::int64_t>(1, dem.width()), run), most, run);
}

std::vector<Summit> summits(Raster<float> const& dem, Overview const& seen, std::size_t most, Run const& run) {
    auto const& range = seen.range;
    if (!range || range->first == range->second) {
        return {};
    }
    Grid const& grid = dem.grid();
    std::int64_t const longest = std::max(grid.width, grid.height);
    std::int64_t const side = side_of_blocks(grid);
    Raster<float> const& land = side > 1 ? seen.maxima : dem;
    std::vector<measure::Peak> peaks = measure::prominent_peaks(land, (range->second - range->first) / 20.0, run);
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](auto const& a, auto const& b) { return a.prominence_m > b.prominence_m; });
    double const apart = static_cast<double>(longest) * grid.cell_m / 16.0;
    std::vector<Summit> chosen;
    for (measure::Peak const& peak : peaks) {
        Vec2 const at = grid.centre(highest_in(dem, land.grid().at(peak.cell), side));
        if (chosen.size() < most &&
            std::ranges::none_of(chosen, [&](Summit const& s) { return distance(s.at, at) < apart; })) {
            chosen.push_back({at, peak.height_m});
        }
    }
    return chosen;
}

namespace {

std::optional<Sea> sea_beside(std::optional<surface::Edge> edge) {
    bool const is_island = edge == surface::Edge::coast;
    return is_island || edge == surface::Edge::mainland ? std::optional(Sea{0.0, is_island}) : std::nullopt;
}

/// The sea around land that reaches the grid's border nowhere goes on beyond it.
std::optional<Sea> around_islands(std::optional<Sea> sea, Mask const& land) {
    if (land.cells() == 0) {
        return sea;
    }
    Grid const& grid = land.grid();
    bool reaches_border = false;
    for (std::int64_t col = 0; col < grid.width; ++col) {
        reaches_border = reaches_border || land[Cell{col, 0}] != 0 || land[Cell{col, grid.height - 1}] != 0;
    }
    for (std::int64_t row = 0; row < grid.height; ++row) {
        reaches_border = reaches_border || land[Cell{0, row}] != 0 || land[Cell{grid.width - 1, row}] != 0;
    }
    Sea result = sea.value_or(Sea{});
    result.is_around = result.is_around || !reaches_border;
    return result;
}

} // namespace

std::optional<Sea> sea_of(make::Terrain const& terrain) {
    return around_islands(terrain.ground.equilibrium() ? sea_beside(terrain.ground.equilibrium()->edge) : std::nullopt,
                          terrain.ground.land);
}

std::optional<Sea> sea_of(recipe::Recipe const& recipe, make::Planform const& planform) {
    bool const is_cut = planform.land.cells() > 0;
    std::optional<surface::Edge> edge;
    if (recipe.surface && recipe.surface->method == recipe::Method::equilibrium) {
        surface::Edge const by_sea = recipe::from_lines(recipe) ? surface::Edge::mainland : surface::Edge::coast;
        edge = is_cut ? recipe.surface->equilibrium.edge.value_or(by_sea) : recipe.surface->equilibrium.edge;
    }
    return around_islands(sea_beside(edge), planform.land);
}

std::optional<Sea> sea_of(recipe::Recipe const& made) {
    bool const balanced = made.surface && made.surface->method == recipe::Method::equilibrium;
    return balanced ? sea_beside(made.surface->equilibrium.edge) : std::nullopt;
}

} // namespace thalweg::report
