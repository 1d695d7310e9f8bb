// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/level_layers.hpp>

// Described in docs/algorithms/equilibrium_layers.md.

namespace thalweg::surface {

LevelLayers level_layers(TerrainLevel const& level, Strata const& strata, Grid const& grid,
                         HeightConversion const& conversion, double most, Run const& run) {
    constexpr double steepest_river = 0.7; // tangent
    LevelLayers out;
    double const by_unit = grid.cell_m / conversion.metres; // of a tangent
    out.river_cap = static_cast<float>(steepest_river * by_unit);
    out.most = (most - conversion.base_m) / conversion.metres;
    out.bed.resize(static_cast<std::size_t>(level.cells()));
    Bed const bed(strata);
    auto const side = static_cast<double>(level.side);
    parallel_ranges(run, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            double const south = static_cast<double>(level.corner.row) + (static_cast<double>(row) - 0.5) * side;
            double const north_m = (0.5 * static_cast<double>(grid.height) - south) * grid.cell_m;
            for (std::int64_t col = 0; col < level.width; ++col) {
                double const east = static_cast<double>(level.corner.col) + (static_cast<double>(col) - 0.5) * side;
                double const east_m = (east - 0.5 * static_cast<double>(grid.width)) * grid.cell_m;
                out.bed[row * level.width + col] =
                    static_cast<float>((bed.height_m(east_m, north_m) - conversion.base_m) / conversion.metres);
            }
        }
    });
    // Land lies between 0 and its greatest height.
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    for (float const z : out.bed) {
        lowest = std::min(lowest, z);
        highest = std::max(highest, z);
    }
    double const low_m = (0.0 - static_cast<double>(highest)) * conversion.metres;
    double const high_m = (out.most - static_cast<double>(lowest)) * conversion.metres;
    for (StackedLayer const& stacked : stack_of(strata, low_m, high_m)) {
        RockLayer const& rock = strata.layers[stacked.layer];
        double const cap = rock.cliff * by_unit;
        out.layers.push_back(
            {stacked.top_m / conversion.metres, rock.strength, std::min(rock.strength, std::sqrt(rock.strength)), cap});
    }
    return out;
}

} // namespace thalweg::surface
