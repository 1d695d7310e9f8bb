// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/circulant.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::solver {
namespace {

double stable(double dx, double dy, double exponent) {
    return portable::exp(-portable::pow(dx * dx + dy * dy, exponent));
}

using Line = std::vector<Complex>;
using Lines = std::vector<Complex, LargePages<Complex>>;

// Columns gathered at a time: the part read of a row fills cache lines.
constexpr std::size_t columns_at_once = 8;
constexpr std::int64_t rows_a_range = 8; ///< rows that share the work memory of a transform

std::size_t size(std::int64_t n) {
    return static_cast<std::size_t>(n);
}

/// Calls body(first, count, transform) on bundles of columns that tile [0, columns).
template <class Body>
void for_columns(Run const& run, std::size_t columns, LineTransform const& prepared, Body const& body) {
    auto const bundles = static_cast<std::int64_t>((columns + columns_at_once - 1) / columns_at_once);
    parallel_ranges(run, bundles, 1, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = prepared;
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            std::size_t const first = size(b) * columns_at_once;
            body(first, std::min(columns_at_once, columns - first), transform);
        }
    });
}

/// Transforms two even lines at once, given by their halves [0, length/2]: one is the real, the other the imaginary
/// part. The transform of an even line is real, so that they stay separate.
void transform_even(LineTransform& transform, Line& in, Line& out) {
    std::size_t const length = in.size();
    for (std::size_t i = 1; i < length / 2; ++i) {
        in[length - i] = in[i];
    }
    transform(in.data(), out.data());
}

/// Transforms along both axes of a torus, in place.
void transform_even(Quarter& quarter, std::int64_t width, std::int64_t height, Run const& run) {
    std::size_t const columns = size(width / 2 + 1);
    std::size_t const rows = size(height / 2 + 1);
    LineTransform const along_row(width, Direction::forward);
    parallel_ranges(run, static_cast<std::int64_t>((rows + 1) / 2), 4, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = along_row;
        Line in(size(width));
        Line out(size(width));
        for (std::int64_t pair = begin; pair < end; ++pair) {
            run.check();
            double* const one = &quarter[2 * size(pair) * columns];
            double* const other = 2 * size(pair) + 1 < rows ? one + columns : one;
            for (std::size_t c = 0; c < columns; ++c) {
                in[c] = {one[c], other[c]};
            }
            transform_even(transform, in, out);
            for (std::size_t c = 0; c < columns; ++c) {
                one[c] = out[c].real();
                other[c] = other == one ? one[c] : out[c].imag();
            }
        }
    });
    for_columns(run, columns, LineTransform(height, Direction::forward),
                [&](std::size_t first, std::size_t count, LineTransform& transform) {
                    std::array<Line, columns_at_once / 2> in;
                    Line out(size(height));
                    in.fill(out);
                    for (std::size_t r = 0; r < rows; ++r) {
                        double const* const row = &quarter[r * columns + first];
                        for (std::size_t c = 0; c < count; c += 2) {
                            in[c / 2][r] = {row[c], c + 1 < count ? row[c + 1] : 0.0};
                        }
                    }
                    for (std::size_t c = 0; c < count; c += 2) {
                        transform_even(transform, in[c / 2], out);
                        in[c / 2].swap(out);
                    }
                    for (std::size_t r = 0; r < rows; ++r) {
                        double* const row = &quarter[r * columns + first];
                        for (std::size_t c = 0; c < count; ++c) {
                            row[c] = c % 2 == 0 ? in[c / 2][r].real() : in[c / 2][r].imag();
                        }
                    }
                });
}

struct SignedSums {
    double all = 0.0;
    double negative = 0.0;
    SignedSums& operator+=(SignedSums const& other) {
        all += other.all;
        negative += other.negative;
        return *this;
    }
};

/// Fills column u of a random field's spectrum, weighted by the roots of the eigenvalues.
void draw_spectrum(Circulant const& torus, std::uint64_t seed, std::uint64_t stage, std::size_t u, Line& spectrum) {
    std::size_t const columns = size(torus.width / 2 + 1);
    std::size_t const length = spectrum.size();
    for (std::size_t v = 0; v < length; v += 2) {
        auto const words = random_block(seed, stage, u, v / 2);
        for (std::size_t i = 0; i < 2; ++i) {
            std::size_t const mirrored = std::min(v + i, length - v - i);
            double const weight = std::sqrt(torus.eigenvalues[mirrored * columns + u]);
            auto const normal = normal_pair(words[2 * i], words[2 * i + 1]);
            spectrum[v + i] = {weight * normal[0], weight * normal[1]};
        }
    }
}

/// Computes the first rows of a random field, transformed along columns; row by row. A real field's spectrum is
/// symmetric: only half of its columns are drawn.
Lines sample_columns(Circulant const& torus, std::size_t rows, std::uint64_t seed, std::uint64_t stage,
                     Run const& run) {
    std::size_t const columns = size(torus.width / 2 + 1);
    std::size_t const length = size(torus.height);
    Lines half(columns * rows);
    for_columns(run, columns, LineTransform(torus.height, Direction::inverse),
                [&](std::size_t first, std::size_t count, LineTransform& transform) {
                    std::array<Line, columns_at_once> drawn;
                    Line spectrum(length);
                    for (std::size_t c = 0; c < count; ++c) {
                        std::size_t const u = first + c;
                        drawn[c].resize(length);
                        draw_spectrum(torus, seed, stage, u, spectrum);
                        transform(spectrum.data(), drawn[c].data());
                        if (u == 0 || u + 1 == columns) { // its own mirror image: real
                            for (Complex& value : drawn[c]) {
                                value = {value.real() * std::sqrt(2.0), 0.0};
                            }
                        }
                    }
                    for (std::size_t y = 0; y < rows; ++y) {
                        for (std::size_t c = 0; c < count; ++c) {
                            half[y * columns + first + c] = drawn[c][y];
                        }
                    }
                });
    return half;
}

/// Packs two real rows into one complex row, from the halves of their spectra: one is the real, the other the imaginary
/// part.
void pack_rows(Complex const* one, Complex const* other, std::size_t columns, Line& in) {
    constexpr Complex i{0.0, 1.0};
    for (std::size_t u = 0; u < columns; ++u) {
        in[u] = one[u] + i * other[u];
    }
    for (std::size_t u = 1; u + 1 < columns; ++u) {
        in[in.size() - u] = std::conj(one[u]) + i * std::conj(other[u]);
    }
}

/// Transforms two fields along their rows, one as the real, the other as the imaginary part.
Lines transform_rows(Circulant const& torus, Raster<double> const& first, Raster<double> const& second,
                     Run const& run) {
    std::size_t const width = size(torus.width);
    Lines lines(width * size(first.height()));
    LineTransform const row_there(torus.width, Direction::forward);
    parallel_ranges(run, first.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = row_there;
        Line in(width);
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const one = first.row(r);
            auto const other = second.row(r);
            for (std::size_t x = 0; x < one.size(); ++x) {
                in[x] = {one[x], other[x]};
            }
            transform(in.data(), &lines[size(r) * width]);
        }
    });
    return lines;
}

/// Multiplies the rows' transforms by the eigenvalues, with transforms along columns forwards and backwards.
void multiply_columns(Circulant const& torus, std::size_t rows, Lines& lines, Run const& run) {
    std::size_t const width = size(torus.width);
    std::size_t const length = size(torus.height);
    std::size_t const eigen_columns = width / 2 + 1;
    LineTransform const column_back(torus.height, Direction::inverse);
    for_columns(run, width, LineTransform(torus.height, Direction::forward),
                [&](std::size_t from, std::size_t count, LineTransform& there) {
                    LineTransform back = column_back;
                    std::array<Line, columns_at_once> columns;
                    Line line(length);
                    columns.fill(line);
                    for (std::size_t r = 0; r < rows; ++r) {
                        for (std::size_t c = 0; c < count; ++c) {
                            columns[c][r] = lines[r * width + from + c];
                        }
                    }
                    for (std::size_t c = 0; c < count; ++c) {
                        there(columns[c].data(), line.data());
                        std::size_t const u = std::min(from + c, width - from - c);
                        for (std::size_t v = 0; v < length; ++v) {
                            line[v] *= torus.eigenvalues[std::min(v, length - v) * eigen_columns + u];
                        }
                        back(line.data(), columns[c].data());
                    }
                    for (std::size_t r = 0; r < rows; ++r) {
                        for (std::size_t c = 0; c < count; ++c) {
                            lines[r * width + from + c] = columns[c][r];
                        }
                    }
                });
}

/// The inverse of transform_rows, scaled.
void transform_rows_back(Circulant const& torus, Lines const& lines, Raster<double>& first, Raster<double>& second,
                         Run const& run) {
    std::size_t const width = size(torus.width);
    double const scale = 1.0 / (static_cast<double>(width) * static_cast<double>(size(torus.height)));
    LineTransform const row_back(torus.width, Direction::inverse);
    parallel_ranges(run, first.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = row_back;
        Line out(width);
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            transform(&lines[size(r) * width], out.data());
            auto const one = first.row(r);
            auto const other = second.row(r);
            for (std::size_t x = 0; x < one.size(); ++x) {
                one[x] = scale * out[x].real();
                other[x] = scale * out[x].imag();
            }
        }
    });
}

/// Stein's covariance at a distance r in diagonals: with reach 1 its slope, with reach 2 also its curvature is
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

/// Size of the torus along a side of the lattice: distances beyond the lattice's extent may wrap around.
std::int64_t around(std::int64_t cells, double reach_cells) {
    return good_size(cells - 1 + static_cast<std::int64_t>(std::ceil(reach_cells)));
}

void check(std::int64_t width, std::int64_t height, double hurst) {
    require_in("solver.fractional_surface", "H", hurst, Range::inside(0.0, 1.0));
    refuse_if<BadParameter>(width < 1 || height < 1, "solver.fractional_surface",
                            "a lattice of {} x {} cells; give one cell at least", width, height);
}

[[noreturn]] void refuse_size(std::int64_t width, std::int64_t height) {
    throw BadParameter(
        "solver.fractional_surface",
        fmt::format(
            "{} x {} cells are too many for an exact fractional Brownian surface: the torus around their diagonal has "
            "more than 2^31 cells; choose fewer cells, or midpoint displacement with a stencil of 16",
            width, height));
}

struct TorusFrame {
    std::int64_t width = 0;  ///< [cells]
    std::int64_t height = 0; ///< [cells]
    double diagonal_cells = 1.0;
};

TorusFrame torus_around(std::int64_t width, std::int64_t height, double hurst) {
    check(width, height, hurst);
    constexpr std::int64_t longest = std::int64_t{1} << 16; // a longer side always makes the torus too large
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

double StableCovariance::operator()(double dx_cells, double dy_cells) const {
    double const coarse = stable(dx_cells / lx_cells, dy_cells / ly_cells, 3.0 - dimension);
    if (fine_share == 0.0) {
        return coarse;
    }
    return (1.0 - fine_share) * coarse +
           fine_share * stable(dx_cells / fine_cells, dy_cells / fine_cells, 3.0 - dimension);
}

void check(StableCovariance const& covariance, char const* stage) {
    for (double const length : {covariance.lx_cells, covariance.ly_cells, covariance.fine_cells}) {
        require_in(stage, "correlation length", length, Range::above(0.0), "cells");
    }
    require_in(stage, "fractal dimension", covariance.dimension, Range::inside(2.0, 3.0));
    require_in(stage, "share of fine forms", covariance.fine_share, {0.0, 1.0, true, false});
}

Circulant circulant(StableCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run) {
    return circulant(TorusCovariance(covariance), width, height, run);
}

Circulant circulant(TorusCovariance const& covariance, std::int64_t width, std::int64_t height, Run const& run) {
    std::size_t const columns = size(width / 2 + 1);
    std::int64_t const rows = height / 2 + 1;
    Circulant torus{width, height, Quarter(columns * size(rows)), 0.0};
    parallel_ranges(run, rows, 4, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            double* const row = &torus.eigenvalues[size(r) * columns];
            for (std::size_t c = 0; c < columns; ++c) {
                row[c] = covariance(static_cast<double>(c), static_cast<double>(r));
            }
        }
    });
    transform_even(torus.eigenvalues, width, height, run);
    SignedSums const sums = sum_rows(run, rows, [&](std::int64_t r) {
        double* const row = &torus.eigenvalues[size(r) * columns];
        SignedSums part;
        for (std::size_t c = 0; c < columns; ++c) {
            // Coefficients off the axes also stand for their mirror images.
            double const times = (c == 0 || c + 1 == columns ? 1.0 : 2.0) * (r == 0 || r + 1 == rows ? 1.0 : 2.0);
            part.all += times * std::max(row[c], 0.0);
            part.negative -= times * std::min(row[c], 0.0);
            row[c] = std::max(row[c], 0.0);
        }
        return part;
    });
    torus.negative_share = sums.negative / sums.all;
    return torus;
}

Quarter covariances(Circulant const& torus, Run const& run) {
    Quarter quarter = torus.eigenvalues;
    transform_even(quarter, torus.width, torus.height, run);
    double const scale = 1.0 / (static_cast<double>(torus.width) * static_cast<double>(torus.height));
    for (double& value : quarter) {
        value *= scale;
    }
    return quarter;
}

Raster<double> sample(Circulant const& torus, Grid const& grid, std::uint64_t seed, std::uint64_t stage,
                      Run const& run) {
    std::size_t const columns = size(torus.width / 2 + 1);
    Lines const half = sample_columns(torus, size(grid.height), seed, stage, run);
    Raster<double> field(grid);
    double const scale = std::sqrt(0.5 / (static_cast<double>(torus.width) * static_cast<double>(torus.height)));
    LineTransform const along_row(torus.width, Direction::inverse);
    parallel_ranges(run, (grid.height + 1) / 2, 4, [&](std::int64_t begin, std::int64_t end) {
        LineTransform transform = along_row;
        Line in(size(torus.width));
        Line out(size(torus.width));
        for (std::int64_t pair = begin; pair < end; ++pair) {
            run.check();
            std::int64_t const second = std::min(2 * pair + 1, grid.height - 1);
            pack_rows(&half[size(2 * pair) * columns], &half[size(second) * columns], columns, in);
            transform(in.data(), out.data());
            auto const upper = field.row(2 * pair);
            auto const lower = field.row(second);
            for (std::size_t x = 0; x < upper.size(); ++x) {
                lower[x] = scale * out[x].imag();
                upper[x] = scale * out[x].real();
            }
        }
    });
    return field;
}

void multiply(Circulant const& torus, Raster<double>& first, Raster<double>& second, Run const& run) {
    Lines lines = transform_rows(torus, first, second, run);
    multiply_columns(torus, size(first.height()), lines, run);
    transform_rows_back(torus, lines, first, second, run);
}

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
    // (r/d)^(2H) is c0 + c2 (r/d)^2 minus the covariance; the first two follow from the moments of the weights.
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
