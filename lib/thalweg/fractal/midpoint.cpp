// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/internal/refine.hpp>
#include <thalweg/solver/linear/linear.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::fractal {
namespace {

/// E (z(a) - z(b))^2 in units of sigma^2 r^(2H), the nearest neighbours being r away.
class Variogram {
public:
    explicit Variogram(double hurst) {
        for (int col = 0; col <= longest; ++col) {
            for (int row = col % 2; row <= col;
                 // only offsets of one parity: as the neighbours lie relative to one another and to the point
                 row += 2) {
                int const square = col * col + row * row;
                of_square_[square] = portable::pow(0.5 * static_cast<double>(square), hurst);
            }
        }
    }
    double operator()(Offset const& a, Offset const& b) const {
        int const col = a.col - b.col;
        int const row = a.row - b.row;
        return of_square_[col * col + row * row];
    }

private:
    static constexpr int longest = 6;
    std::array<double, 2 * longest * longest + 1> of_square_{};
};

/// Solves a square system, whose rows end with their right-hand side, by elimination with partial pivoting.
std::vector<double> solve(std::vector<std::vector<double>> rows) {
    std::size_t const n = rows.size();
    for (std::size_t step = 0; step < n; ++step) {
        std::size_t pivot = step;
        for (std::size_t i = step + 1; i < n; ++i) {
            pivot = std::fabs(rows[i][step]) > std::fabs(rows[pivot][step]) ? i : pivot;
        }
        std::swap(rows[step], rows[pivot]);
        for (std::size_t i = step + 1; i < n; ++i) {
            double const factor = rows[i][step] / rows[step][step];
            for (std::size_t k = step; k <= n; ++k) {
                rows[i][k] -= factor * rows[step][k];
            }
        }
    }
    std::vector<double> x(n);
    for (std::size_t i = n; i-- > 0;) {
        double sum = rows[i][n];
        for (std::size_t k = i + 1; k < n; ++k) {
            sum -= rows[i][k] * x[k];
        }
        x[i] = sum / rows[i][i];
    }
    return x;
}

std::vector<double> kriged(std::vector<Offset> const& points, Variogram const& variogram) {
    std::size_t const n = points.size();
    std::vector<std::vector<double>> rows(n + 1, std::vector<double>(n + 2, 1.0));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            rows[i][k] = variogram(points[i], points[k]);
        }
        rows[i][n + 1] = variogram(points[i], {});
    }
    rows[n][n] = 0.0;
    std::vector<double> weights = solve(std::move(rows));
    weights.pop_back();
    return weights;
}

/// Conditional deviation of the new point for any weights with sum 1.
double exact_deviation(std::vector<Offset> const& points, std::vector<double> const& weights,
                       Variogram const& variogram) {
    double variance = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double inner = 0.0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            inner += weights[k] * variogram(points[i], points[k]);
        }
        variance += weights[i] * (variogram(points[i], {}) - 0.5 * inner);
    }
    return std::sqrt(variance > 0.0 ? variance : 0.0);
}

/// Averages the weights of symmetric neighbours, for which elimination gives slightly different numbers.
void even_out(std::array<double, 16>& weight) {
    using Places = std::pair<std::size_t, std::size_t>;
    for (auto const& [first, last] : {Places{0, 4}, Places{4, 12}, Places{12, 16}}) {
        double sum = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            sum += weight[i];
        }
        for (std::size_t i = first; i < last; ++i) {
            weight[i] = sum / static_cast<double>(last - first);
        }
    }
}

// Parameters of a fractional Brownian surface through coarse heights.
struct Conditioning {
    Raster<float> const* coarse = nullptr; // finite heights and NaN
    int levels = 1;                        // [1, ...] number of halvings of a cell
    double hurst = 0.5;                    // H
    double sigma = 0.0;                    // [m] one coarse cell apart
    std::uint64_t seed = 0;
};

constexpr std::uint64_t surface_stage = 0x737465696e; // "stein"

/// Coarse cells with heights, in the order of the raster.
std::vector<Cell> cells_with_heights(Raster<float> const& coarse) {
    std::vector<Cell> cells;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        if (!std::isnan(coarse[i])) {
            cells.push_back(coarse.grid().at(i));
        }
    }
    refuse_if<BadParameter>(static_cast<std::int64_t>(cells.size()) > most_conditioning_cells, "fractal.midpoint",
                            "{} coarse cells have heights (detail.stencil = \"exact\" takes up to {}); choose more "
                            "levels (detail.levels) from fewer coarse cells, or detail.stencil = 16",
                            cells.size(), most_conditioning_cells);
    return cells;
}

/// E (z(p) - z(q))^2 of coarse cells at a distance in columns and rows, in units of sigma^2.
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
    std::vector<double> of_distance_;
};

/// An interpolation: level minus the sum of weights times variograms around the cells with heights.
struct KrigingWeights {
    double level = 0.0;          ///< [m]
    std::vector<double> weights; ///< sum 0, one per cell
};

/// Ordinary kriging of values at cells. Heights relative to the first cell have a covariance, which eliminates the
/// unknown mean from the system.
KrigingWeights krige(std::vector<Cell> const& cells, std::vector<double> const& values,
                     CoarseVariogram const& variogram, Run const& run) {
    std::size_t const n = cells.size() - 1;
    KrigingWeights kriged{values[0], std::vector<double>(cells.size(), 0.0)};
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

/// Whether all coarse cells nearest to a lattice position (one, two or four) are holes.
bool is_hole(Raster<float> const& coarse, std::int64_t col, std::int64_t row, int levels) {
    std::int64_t const half = (std::int64_t{1} << levels) / 2;
    std::int64_t const west = (col + half - 1) >> levels;
    std::int64_t const east = (col + half) >> levels;
    std::int64_t const north = (row + half - 1) >> levels;
    std::int64_t const south = (row + half) >> levels;
    return std::isnan(coarse[Cell{west, north}]) && std::isnan(coarse[Cell{east, north}]) &&
           std::isnan(coarse[Cell{west, south}]) && std::isnan(coarse[Cell{east, south}]);
}

/// A conditioned surface as two terms, on the whole lattice.
struct Terms {
    Raster<double> random;     ///< [-] of variance 1 one lattice cell apart; empty: sigma is 0
    double scale = 0.0;        ///< [m] of the random term
    Raster<double> variograms; ///< [m] empty: the kriged term is constant
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
    KrigingWeights const kriged = krige(cells, residuals, CoarseVariogram(coarse.grid(), c.hurst), run);
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

// Writes a lattice 2^levels finer than the coarse raster, from its north-western corner: a random fractional Brownian
// surface plus the kriged differences to the coarse heights (ordinary kriging with its variogram). dem: at most (coarse
// columns - 1) 2^levels + 1 columns, rows likewise; every cell is written: the coarse heights bit for bit at their
// positions, NaN where all nearest coarse cells are holes, elsewhere the surface conditioned on the heights. A smaller
// dem is part of a larger one bit for bit; the same bytes for any number of threads. Throws BadParameter for more than
// most_conditioning_cells heights, or a lattice too large for the solver. Source: Stein 2002 (the surface);
// conditioning by kriging as in Journel and Huijbregts 1978.
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

constexpr int most_levels = 30;
constexpr double greatest_height_m = 1e30; // sums of sixteen such heights still fit float
constexpr std::int64_t longest_side = std::int64_t{1} << 40;

void check_params(MidpointParams const& params) {
    require_in("fractal.midpoint", "levels", params.levels, Range::between(0, most_levels));
    refuse_if<BadParameter>(
        params.width < 0 || params.height < 0, "fractal.midpoint",
        "a result of {} x {} cells; give a width and height above 0, or 0 for all the coarse raster covers",
        params.width, params.height);
    if (params.hurst) {
        require_in("fractal.midpoint", "H", *params.hurst, Range::between(least_hurst, greatest_hurst));
    }
    if (params.sigma) {
        require_in("fractal.midpoint", "sigma", *params.sigma, Range::between(0.0, greatest_height_m), "m");
    }
    refuse_if<BadParameter>(params.stencil == Stencil::exact && params.noise != Noise::normal, "fractal.midpoint",
                            "the exact surface has normal increments only; choose normal noise, or a stencil of 16");
    refuse_if<BadParameter>(params.stencil == Stencil::exact && params.adaptation != Adaptation::global,
                            "fractal.midpoint",
                            "the exact surface has one H and one sigma; choose global adaptation, or a stencil of 16");
}

/// Throws if there is no height; returns whether there are holes.
bool check_heights(Raster<float> const& coarse) {
    refuse_if<BadInput>(coarse.cells() == 0, "fractal.midpoint", "the coarse raster has no cells; give one at least");
    bool holes = false;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        double const z = static_cast<double>(coarse[i]);
        holes = holes || std::isnan(z);
        if (std::fabs(z) > greatest_height_m) {
            Cell const c = coarse.grid().at(i);
            throw BadInput(
                "fractal.midpoint",
                fmt::format(
                    "the height of column {}, row {} is {} m; give heights up to {} m, or NaN where nothing is known",
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
    refuse_if<BadParameter>(longest > longest_side >> params.levels, "fractal.midpoint",
                            "{} x {} coarse cells halved {} times are more than 2^40 in a row; choose fewer levels",
                            coarse.width, coarse.height, params.levels);
    std::int64_t const all_cols = ((coarse.width - 1) << params.levels) + 1;
    std::int64_t const all_rows = ((coarse.height - 1) << params.levels) + 1;
    Grid grid = coarse;
    grid.width = params.width > 0 ? params.width : all_cols;
    grid.height = params.height > 0 ? params.height : all_rows;
    if (grid.width > all_cols || grid.height > all_rows) {
        throw BadParameter("fractal.midpoint",
                           fmt::format("{} x {} coarse cells cover {} x {} cells at {} levels, and {} x {} are asked "
                                       "for; give a coarse raster of at least {} columns and {} rows",
                                       coarse.width, coarse.height, all_cols, all_rows, params.levels, grid.width,
                                       grid.height, coarse_cells(grid.width, params.levels),
                                       coarse_cells(grid.height, params.levels)));
    }
    grid.cell_m = coarse.cell_m / static_cast<double>(std::int64_t{1} << params.levels);
    grid.west = coarse.west + 0.5 * (coarse.cell_m - grid.cell_m); // so that cell centres keep their positions
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

/// Sets local H and sigma of coarse cells where they differ from the global ones.
/// \return number of these cells
std::int64_t adapt(Character& character, Raster<float> const& coarse, Run const& run) {
    constexpr std::int64_t half = 3; // of 7 x 7 cells
    std::vector<float> steps(coarse.cells());
    std::vector<float> sigmas(steps.size());
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

StencilWeights stencil_weights(Stencil stencil, std::uint32_t known, double hurst) {
    std::vector<Offset> points;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < around_centre.size(); ++i) {
        if ((known >> i & 1U) != 0) {
            points.push_back(around_centre[i]);
            places.push_back(i);
        }
    }
    Variogram const variogram(hurst);
    bool const means = stencil == Stencil::four || stencil == Stencil::four_exact;
    std::vector<double> const weights =
        means ? std::vector<double>(points.size(), 1.0 / static_cast<double>(points.size()))
              : kriged(points, variogram);
    StencilWeights out;
    for (std::size_t i = 0; i < places.size(); ++i) {
        out.weight[places[i]] = weights[i];
    }
    if (known == used_neighbours(stencil)) {
        even_out(out.weight);
    }
    out.deviation = stencil == Stencil::four ? std::sqrt(1.0 - portable::pow(2.0, 2.0 * hurst - 2.0))
                                             : exact_deviation(points, weights, variogram);
    return out;
}

DisplacedDem midpoint(Raster<float> const& coarse, MidpointParams const& params, Run const& run) {
    check_params(params);
    Refinement refinement;
    refinement.coarse = &coarse;
    refinement.holes = check_heights(coarse);
    refinement.levels = params.levels;
    refinement.stencil = params.stencil;
    refinement.noise = params.noise;
    refinement.seed = params.seed;
    refinement.lanes = widest_lanes();
    DisplacedDem displaced;
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
