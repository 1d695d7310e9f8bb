// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/midpoint.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/internal/condition_surface.hpp>
#include <thalweg/fractal/refine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace thalweg::fractal {
namespace {

constexpr int most_levels = 30;
constexpr double greatest_height_m = 1e30; // sums of sixteen such heights are floats still
constexpr std::int64_t longest_side = std::int64_t{1} << 40;

void check_params(MidpointParams const& params) {
    require_in("fractal.midpoint", "levels", params.levels, Range::between(0, most_levels));
    if (params.width < 0 || params.height < 0) {
        throw BadParameter(fmt::format("fractal.midpoint: a result of {} x {} cells; give a width and "
                                       "height above 0, or 0 for all the coarse raster covers",
                                       params.width, params.height));
    }
    if (params.hurst) {
        require_in("fractal.midpoint", "H", *params.hurst, Range::between(least_hurst, greatest_hurst));
    }
    if (params.sigma) {
        require_in("fractal.midpoint", "sigma", *params.sigma, Range::between(0.0, greatest_height_m), "m");
    }
    if (params.stencil == Stencil::exact && params.noise != Noise::normal) {
        throw BadParameter("fractal.midpoint: the exact surface has normal increments only; choose normal noise, or a "
                           "stencil of 16");
    }
    if (params.stencil == Stencil::exact && params.adaptation != Adaptation::global) {
        throw BadParameter(
            "fractal.midpoint: the exact surface has one H and one sigma; choose global adaptation, or a "
            "stencil of 16");
    }
}

/// Throws where there is no height to use. Gives whether there are holes.
bool check_heights(Raster<float> const& coarse) {
    if (coarse.cells() == 0) {
        throw BadInput("fractal.midpoint: the coarse raster has no cells; give one at least");
    }
    bool holes = false;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        double const z = static_cast<double>(coarse[i]);
        holes = holes || std::isnan(z);
        if (std::fabs(z) > greatest_height_m) {
            Cell const c = coarse.grid().at(i);
            throw BadInput(fmt::format("fractal.midpoint: the height of column {}, row {} is {} m; give heights up to "
                                       "{} m, or NaN where nothing is known",
                                       c.col, c.row, z, greatest_height_m));
        }
    }
    return holes;
}

std::int64_t coarse_cells(std::int64_t cells, int levels) {
    return ((cells - 1 + (std::int64_t{1} << levels) - 1) >> levels) + 1;
}

Grid result_grid(Grid const& coarse, MidpointParams const& params) {
    std::int64_t const longest = std::max(coarse.width, coarse.height) - 1;
    if (longest > longest_side >> params.levels) {
        throw BadParameter(fmt::format("fractal.midpoint: {} x {} coarse cells halved {} times are more than 2^40 in a "
                                       "row; choose fewer levels",
                                       coarse.width, coarse.height, params.levels));
    }
    std::int64_t const all_cols = ((coarse.width - 1) << params.levels) + 1;
    std::int64_t const all_rows = ((coarse.height - 1) << params.levels) + 1;
    Grid grid = coarse;
    grid.width = params.width > 0 ? params.width : all_cols;
    grid.height = params.height > 0 ? params.height : all_rows;
    if (grid.width > all_cols || grid.height > all_rows) {
        throw BadParameter(fmt::format("fractal.midpoint: {} x {} coarse cells cover {} x {} cells at {} levels, and "
                                       "{} x {} are asked for; give a "
                                       "coarse raster of at least {} columns and {} rows",
                                       coarse.width, coarse.height, all_cols, all_rows, params.levels, grid.width,
                                       grid.height, coarse_cells(grid.width, params.levels),
                                       coarse_cells(grid.height, params.levels)));
    }
    grid.cell_m = coarse.cell_m / static_cast<double>(std::int64_t{1} << params.levels);
    grid.west = coarse.west + 0.5 * (coarse.cell_m - grid.cell_m); // so that centres stay where they are
    grid.north = coarse.north - 0.5 * (coarse.cell_m - grid.cell_m);
    return grid;
}

Character global_character(Raster<float> const& coarse, MidpointParams const& params, Run const& run) {
    Character character;
    if (params.hurst && params.sigma) {
        character.hurst = *params.hurst;
        character.sigma = *params.sigma;
        return character;
    }
    Fractal const estimated = estimate_fractal(coarse, {Differences::squares, params.hurst}, run);
    character.hurst = estimated.hurst;
    character.sigma = params.sigma.value_or(estimated.sigma);
    return character;
}

/// Gives every coarse cell its own H and sigma where they are others than those of all. Gives how many those are.
std::int64_t adapt(Character& character, Raster<float> const& coarse, Run const& run) {
    constexpr std::int64_t half = 3; // of 7 x 7 cells
    Indexed<CellIndex, float> steps(coarse.cells());
    Indexed<CellIndex, float> sigmas(steps.size());
    std::atomic<std::int64_t> adapted = 0;
    parallel_ranges(run, coarse.height(), 8, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            for (std::int64_t col = 0; col < coarse.width(); ++col) {
                std::int64_t const west = std::max<std::int64_t>(0, col - half);
                std::int64_t const north = std::max<std::int64_t>(0, row - half);
                CellWindow const window{west, north, std::min(coarse.width(), col + half + 1) - west,
                                        std::min(coarse.height(), row + half + 1) - north};
                Fractal const here = estimate_fractal(coarse, window);
                double hurst = character.hurst;
                double sigma = character.sigma;
                bool const rougher = here.lags > 1 && std::fabs(here.hurst - hurst) > 0.1;
                bool const higher = here.sigma > 1.5 * sigma || here.sigma < 0.67 * sigma;
                if (here.pairs > 0 && (rougher || higher)) {
                    hurst = here.lags > 1 ? here.hurst : hurst;
                    sigma = here.sigma;
                    ++adapted;
                }
                CellIndex const i = coarse.grid().index({col, row});
                steps[i] = static_cast<float>(std::floor(hurst * Character::steps_of_hurst + 0.5));
                sigmas[i] = static_cast<float>(sigma);
            }
        }
    });
    if (adapted > 0) {
        character.steps = std::move(steps);
        character.sigmas = std::move(sigmas);
    }
    return adapted;
}

} // namespace

Displaced midpoint(Raster<float> const& coarse, MidpointParams const& params, Run const& run) {
    check_params(params);
    Refinement refinement;
    refinement.coarse = &coarse;
    refinement.holes = check_heights(coarse);
    refinement.levels = params.levels;
    refinement.stencil = params.stencil;
    refinement.noise = params.noise;
    refinement.seed = params.seed;
    refinement.lanes = widest_lanes();
    Displaced displaced;
    Grid const grid = result_grid(coarse.grid(), params);
    run.at(0.0, "midpoint");
    refinement.character = global_character(coarse, params, run);
    displaced.hurst = refinement.character.hurst;
    displaced.sigma = refinement.character.sigma;
    if (params.adaptation == Adaptation::local) {
        displaced.adapted = adapt(refinement.character, coarse, run);
    }
    displaced.dem = Raster<float>(grid);
    if (params.levels == 0) {
        for (std::int64_t row = 0; row < grid.height; ++row) {
            std::copy_n(coarse.row(row).begin(), grid.width, displaced.dem.row(row).begin());
        }
    } else if (params.stencil == Stencil::exact) {
        condition_surface({&coarse, params.levels, displaced.hurst, displaced.sigma, params.seed}, displaced.dem, run);
    } else {
        Floors floors;
        refine(refinement, displaced.dem, floors, run);
    }
    run.at(1.0, "midpoint");
    return displaced;
}

} // namespace thalweg::fractal
