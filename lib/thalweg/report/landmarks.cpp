// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/landmarks.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include <thalweg/core/box_means.hpp>
#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/recipe/condition.hpp>

namespace thalweg::report {

std::optional<std::pair<double, double>> height_range(Raster<float> const& dem) {
    // Sixteen ranges side by side, of the width of registers that each processor has: one would wait for itself at each
    // cell, and wider vectors are stored and loaded again.
    using Floats [[gnu::vector_size(16)]] = float;
    constexpr std::size_t lanes = 4;
    constexpr std::size_t sets = 4;
    constexpr float none = std::numeric_limits<float>::infinity();
    std::array<Floats, sets> low{};
    std::array<Floats, sets> high{};
    low.fill(Floats{} + none);
    high.fill(Floats{} - none);
    auto const take = [&](float const* from) {
#pragma GCC unroll 4
        for (std::size_t set = 0; set < sets; ++set) {
            Floats z{};
            std::memcpy(&z, from + set * lanes, sizeof z);
            auto const is_number = z - z == 0.0F;
            low[set] = (is_number & (z < low[set])) ? z : low[set];
            high[set] = (is_number & (z > high[set])) ? z : high[set];
        }
    };
    auto const values = dem.values();
    std::size_t i = 0;
    for (; i + sets * lanes <= values.size(); i += sets * lanes) {
        take(values.data() + i);
    }
    if (i < values.size()) {
        std::array<float, sets * lanes> rest{};
        rest.fill(none);
        std::copy(values.begin() + static_cast<std::ptrdiff_t>(i), values.end(), rest.begin());
        take(rest.data());
    }
    float lowest = none;
    float highest = -none;
    for (std::size_t lane = 0; lane < sets * lanes; ++lane) {
        lowest = std::min(lowest, low[lane / lanes][lane % lanes]);
        highest = std::max(highest, high[lane / lanes][lane % lanes]);
    }
    return highest >= lowest ? std::optional(std::pair<double, double>(lowest, highest)) : std::nullopt;
}

namespace {

constexpr std::int64_t most_cells = 1024; ///< a side: a sixteenth of it, which summits keep apart, is 64 cells

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

std::vector<Summit> summits(Raster<float> const& dem, std::size_t most, Run const& run) {
    auto const range = height_range(dem);
    if (!range || range->first == range->second) {
        return {};
    }
    Grid const& grid = dem.grid();
    std::int64_t const longest = std::max(grid.width, grid.height);
    std::int64_t const side = (longest + most_cells - 1) / most_cells;
    Raster<float> const maxima = side > 1 ? block_maxima(dem, side, run) : Raster<float>{};
    Raster<float> const& land = side > 1 ? maxima : dem;
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
