// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/internal/condition_surface.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/solver/linear/cholesky.hpp>
#include <thalweg/solver/spectral/fractional_surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace thalweg::fractal {
namespace {

constexpr std::uint64_t surface_stage = 0x737465696e; // "stein"

/// Coarse cells with heights, in the order of the raster.
std::vector<Cell> cells_with_heights(Raster<float> const& coarse) {
    std::vector<Cell> cells;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        if (!std::isnan(coarse[i])) {
            cells.push_back(coarse.grid().at(i));
        }
    }
    if (static_cast<std::int64_t>(cells.size()) > most_conditioning_cells) {
        throw BadParameter(fmt::format(
            "fractal.midpoint: {} coarse cells have heights (detail.stencil = \"exact\" takes up to {}); choose more "
            "levels (detail.levels) from fewer coarse cells, or detail.stencil = 16",
            cells.size(), most_conditioning_cells));
    }
    return cells;
}

/// E (z(p) - z(q))^2 of coarse cells a column and a row distance apart, in units of sigma^2.
class CoarseVariogram {
public:
    CoarseVariogram(Grid const& grid, double hurst) : width_(grid.width) {
        for (std::int64_t row = 0; row < grid.height; ++row) {
            for (std::int64_t col = 0; col < grid.width; ++col) {
                of_distance_.push_back(portable::pow(static_cast<double>(col * col + row * row), hurst));
            }
        }
    }
    double operator()(Cell const& a, Cell const& b) const {
        return of_distance_[std::abs(a.row - b.row) * width_ + std::abs(a.col - b.col)];
    }

private:
    std::int64_t width_;
    Indexed<CellIndex, double> of_distance_;
};

/// An interpolation: level less the sum of weights times variograms around the cells with heights.
struct Kriged {
    double level = 0.0;          ///< [m]
    std::vector<double> weights; ///< sum 0, one a cell
};

/// Ordinary kriging of values at cells. Heights relative to the first cell have a covariance, with which the unknown
/// mean leaves the system.
Kriged krige(std::vector<Cell> const& cells, std::vector<double> const& values, CoarseVariogram const& variogram,
             Run const& run) {
    std::size_t const n = cells.size() - 1;
    Kriged kriged{values[0], std::vector<double>(cells.size(), 0.0)};
    std::vector<double> rise(n);
    for (std::size_t i = 0; i < n; ++i) {
        rise[i] = values[i + 1] - values[0];
    }
    if (std::all_of(rise.begin(), rise.end(), [](double r) { return r == 0.0; })) {
        return kriged;
    }
    std::vector<double> matrix(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            matrix[i * n + k] = variogram(cells[i + 1], cells[0]) + variogram(cells[k + 1], cells[0]) -
                                variogram(cells[i + 1], cells[k + 1]);
        }
    }
    std::vector<double> const solution = solver::solve(solver::factor(std::move(matrix), n, 0.0, run), rise);
    for (std::size_t i = 0; i < n; ++i) {
        kriged.weights[i + 1] = solution[i];
        kriged.weights[0] -= solution[i];
        kriged.level += solution[i] * variogram(cells[i + 1], cells[0]);
    }
    return kriged;
}

/// Whether the coarse cells nearest to a place of the lattice (one, two or four) are all holes.
bool is_hole(Raster<float> const& coarse, std::int64_t col, std::int64_t row, int levels) {
    std::int64_t const half = (std::int64_t{1} << levels) / 2;
    std::int64_t const west = (col + half - 1) >> levels;
    std::int64_t const east = (col + half) >> levels;
    std::int64_t const north = (row + half - 1) >> levels;
    std::int64_t const south = (row + half) >> levels;
    return std::isnan(coarse[Cell{west, north}]) && std::isnan(coarse[Cell{east, north}]) &&
           std::isnan(coarse[Cell{west, south}]) && std::isnan(coarse[Cell{east, south}]);
}

/// A conditioned surface in two terms, on the whole lattice.
struct Terms {
    Raster<double> random;     ///< [] of variance 1 a lattice cell apart; empty where sigma is 0
    double scale = 0.0;        ///< [m] of the random one
    Raster<double> variograms; ///< [m] empty where the kriged term is level
    double level = 0.0;        ///< [m]
    double at(std::int64_t i) const {
        return level + (random.cells() > 0 ? scale * random[i] : 0.0) - (variograms.cells() > 0 ? variograms[i] : 0.0);
    }
};

Terms terms_of(Conditioning const& c, std::vector<Cell> const& cells, Run const& run) {
    Raster<float> const& coarse = *c.coarse;
    auto const fine = [&](Cell const& cell) { return Cell{cell.col << c.levels, cell.row << c.levels}; };
    solver::FractionalSurface const surface = solver::fractional_surface(
        ((coarse.width() - 1) << c.levels) + 1, ((coarse.height() - 1) << c.levels) + 1, c.hurst, run);
    run.at(0.3, "midpoint");
    Terms terms;
    terms.scale = c.sigma * portable::pow(std::ldexp(1.0, -c.levels), c.hurst);
    if (c.sigma > 0.0) {
        terms.random = solver::sample(surface, c.seed, surface_stage, run);
    }
    run.at(0.6, "midpoint");
    std::vector<double> residuals;
    for (Cell const& cell : cells) {
        residuals.push_back(static_cast<double>(coarse[cell]) -
                            (c.sigma > 0.0 ? terms.scale * terms.random[fine(cell)] : 0.0));
    }
    Kriged const kriged = krige(cells, residuals, CoarseVariogram(coarse.grid(), c.hurst), run);
    run.at(0.7, "midpoint");
    terms.level = kriged.level;
    if (std::any_of(kriged.weights.begin(), kriged.weights.end(), [](double w) { return w != 0.0; })) {
        double const fine_cells = portable::pow(std::ldexp(1.0, -c.levels), 2.0 * c.hurst);
        terms.variograms = Raster<double>(Grid{surface.width, surface.height, 1.0, 0.0, 0.0, ""});
        for (std::size_t i = 0; i < cells.size(); ++i) {
            terms.variograms[fine(cells[i])] = kriged.weights[i] * fine_cells;
        }
        solver::superpose_variograms(surface, terms.variograms, run);
    }
    return terms;
}

} // namespace

void condition_surface(Conditioning const& conditioning, Raster<float>& dem, Run const& run) {
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    Raster<float> const& coarse = *conditioning.coarse;
    std::vector<Cell> const cells = cells_with_heights(coarse);
    if (cells.empty()) {
        std::fill(dem.values().begin(), dem.values().end(), hole);
        return;
    }
    Terms const terms = terms_of(conditioning, cells, run);
    std::int64_t const lattice_width = ((coarse.width() - 1) << conditioning.levels) + 1;
    std::int64_t const step = std::int64_t{1} << conditioning.levels;
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            for (std::int64_t col = 0; col < dem.width(); ++col) {
                dem[Cell{col, row}] = is_hole(coarse, col, row, conditioning.levels)
                                          ? hole
                                          : static_cast<float>(terms.at(row * lattice_width + col));
            }
            for (std::int64_t col = 0; row % step == 0 && col < dem.width(); col += step) {
                dem[Cell{col, row}] = coarse[Cell{col / step, row / step}];
            }
        }
    });
}

} // namespace thalweg::fractal
