// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/fractional_surface.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/normal.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::solver {

namespace {

/// Stein's covariance of a distance r in diagonals: with reach 1 its slope, with reach 2 its curvature too is
/// continuous where the branches meet.
struct SteinCovariance {
    explicit SteinCovariance(double hurst_exponent) : hurst(hurst_exponent) {
        double const a = 2.0 * hurst;
        if (a <= 1.5) {
            square = 0.5 * a;
            constant = 1.0 - square;
            return;
        }
        reach = 2.0;
        tail = a * (2.0 - a) / 18.0;
        square = 0.5 * (a - 4.0 * tail);
        constant = 1.0 + tail - square;
    }

    double operator()(double r_squared) const {
        if (r_squared <= 1.0) {
            return constant - portable::pow(r_squared, hurst) + square * r_squared;
        }
        if (r_squared >= reach * reach) {
            return 0.0;
        }
        double const r = std::sqrt(r_squared);
        double const left = reach - r;
        return tail * left * left * left / r;
    }

    double hurst;
    double reach = 1.0;
    double tail = 0.0;
    double constant = 0.0;
    double square = 0.0;
};

/// Cells around the torus along a side of the lattice; what is farther than the lattice's extent may lie within reach
/// both ways round.
std::int64_t around(std::int64_t cells, double reach_cells) {
    return good_size(cells - 1 + static_cast<std::int64_t>(std::ceil(reach_cells)));
}

void check(std::int64_t width, std::int64_t height, double hurst) {
    require_in("solver.fractional_surface", "H", hurst, Range::inside(0.0, 1.0));
    if (width < 1 || height < 1) {
        throw BadParameter(fmt::format("solver.fractional_surface: a lattice of {} x {} cells; give one cell at least",
                                       width, height));
    }
}

[[noreturn]] void refuse_size(std::int64_t width, std::int64_t height) {
    throw BadParameter(fmt::format("solver.fractional_surface: {} x {} cells are too many for an exact fractional "
                                   "Brownian surface: the torus around their diagonal has more than 2^31 cells; choose "
                                   "fewer cells, or midpoint displacement with a stencil of 16",
                                   width, height));
}

struct TorusFrame {
    std::int64_t width = 0;  ///< [cells]
    std::int64_t height = 0; ///< [cells]
    double diagonal_cells = 1.0;
};

TorusFrame torus_around(std::int64_t width, std::int64_t height, double hurst) {
    check(width, height, hurst);
    constexpr std::int64_t longest = std::int64_t{1} << 16; // the torus of a longer side is too large in any case
    if (width > longest || height > longest) {
        refuse_size(width, height);
    }
    auto const extent_x = static_cast<double>(width - 1);
    auto const extent_y = static_cast<double>(height - 1);
    TorusFrame frame;
    frame.diagonal_cells = std::max(1.0, std::sqrt(extent_x * extent_x + extent_y * extent_y));
    double const reach_cells = SteinCovariance(hurst).reach * frame.diagonal_cells;
    frame.width = around(width, reach_cells);
    frame.height = around(height, reach_cells);
    if (frame.width > most_torus_cells / frame.height) {
        refuse_size(width, height);
    }
    return frame;
}

struct Moments {
    double sum = 0.0;
    double east = 0.0;
    double south = 0.0;
    double squares = 0.0;
    Moments& operator+=(Moments const& other) {
        sum += other.sum;
        east += other.east;
        south += other.south;
        squares += other.squares;
        return *this;
    }
};

Moments moments(Raster<double> const& weights, Run const& run) {
    return sum_rows(run, weights.height(), [&](std::int64_t r) {
        Moments part;
        auto const y = static_cast<double>(r);
        double x = 0.0;
        for (double const w : weights.row(r)) {
            part.sum += w;
            part.east += w * x;
            part.south += w * y;
            part.squares += w * (x * x + y * y);
            x += 1.0;
        }
        return part;
    });
}

Grid lattice_of(FractionalSurface const& surface) {
    return {surface.width, surface.height, 1.0, 0.0, 0.0, ""};
}

} // namespace

void check_fractional_surface(std::int64_t width, std::int64_t height, double hurst) {
    torus_around(width, height, hurst);
}

FractionalSurface fractional_surface(std::int64_t width, std::int64_t height, double hurst, Run const& run) {
    TorusFrame const frame = torus_around(width, height, hurst);
    SteinCovariance const covariance(hurst);
    double const scale = 1.0 / frame.diagonal_cells;
    auto const both_ways_round = [&](double dx, double dy) {
        double const far_x = static_cast<double>(frame.width) - dx;
        double const far_y = static_cast<double>(frame.height) - dy;
        auto const at = [&](double x, double y) { return covariance(x * scale * x * scale + y * scale * y * scale); };
        return at(dx, dy) + at(far_x, dy) + at(dx, far_y) + at(far_x, far_y);
    };
    return {width,
            height,
            hurst,
            frame.diagonal_cells,
            covariance.constant,
            covariance.square,
            circulant(TorusCovariance(both_ways_round), frame.width, frame.height, run)};
}

Raster<double> sample(FractionalSurface const& surface, std::uint64_t seed, std::uint64_t stage, Run const& run) {
    Raster<double> field = sample(surface.torus, lattice_of(surface), seed, stage, run);
    auto const words = random_block(seed, stage, static_cast<std::uint64_t>(surface.torus.width), 1);
    auto const tilt = normal_pair(words[0], words[1]);
    // The field and the plane differ by 2 (r/d)^(2H) in the mean square.
    double const amplitude = std::sqrt(0.5) * portable::pow(surface.diagonal_cells, surface.hurst);
    double const slope = std::sqrt(2.0 * surface.square) / surface.diagonal_cells;
    double const origin = field[0];
    parallel_ranges(run, field.height(), 32, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t r = first; r < last; ++r) {
            run.check();
            double x = 0.0;
            for (double& z : field.row(r)) {
                z = amplitude * (z - origin + slope * (tilt[0] * x + tilt[1] * static_cast<double>(r)));
                x += 1.0;
            }
        }
    });
    return field;
}

void superpose_variograms(FractionalSurface const& surface, Raster<double>& weights, Run const& run) {
    Moments const m = moments(weights, run);
    Raster<double> nothing(weights.grid());
    multiply(surface.torus, weights, nothing, run);
    // (r/d)^(2H) is c0 + c2 (r/d)^2 less the covariance, and the first two follow from the weights' moments.
    double const d = surface.diagonal_cells;
    double const amplitude = portable::pow(d, 2.0 * surface.hurst);
    double const square = surface.square / (d * d);
    parallel_ranges(run, weights.height(), 32, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t r = first; r < last; ++r) {
            run.check();
            auto const y = static_cast<double>(r);
            double x = 0.0;
            for (double& z : weights.row(r)) {
                double const parabola = m.sum * (x * x + y * y) - 2.0 * (m.east * x + m.south * y) + m.squares;
                z = amplitude * (surface.constant * m.sum + square * parabola - z);
                x += 1.0;
            }
        }
    });
}

} // namespace thalweg::solver
