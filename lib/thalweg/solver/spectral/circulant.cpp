// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/circulant.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <thalweg/core/numbers/normal.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::solver {

namespace {

using Line = std::vector<Complex>;
using Lines = std::vector<Complex, LargePages<Complex>>;

// So many columns are gathered at once that what is read of a row fills cache lines.
constexpr std::size_t columns_at_once = 8;
constexpr std::int64_t rows_a_range = 8; ///< that share the work memory of a transform

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

/// Transforms two even lines at once, given by their halves [0, length/2]: the one is the real, the other the imaginary
/// part, and as the transform of an even line is real they stay apart.
void transform_even(LineTransform& transform, Line& in, Line& out) {
    std::size_t const length = in.size();
    for (std::size_t i = 1; i < length / 2; ++i) {
        in[length - i] = in[i];
    }
    transform(in.data(), out.data());
}

/// Along both axes of a torus, in place.
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

/// The first rows of a random field, transformed along columns; row by row. A real field's spectrum mirrors itself:
/// half of its columns are drawn.
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

/// Packs two real rows into one complex one, from the halves of their spectra: the one is the real, the other the
/// imaginary part.
void pack_rows(Complex const* one, Complex const* other, std::size_t columns, Line& in) {
    constexpr Complex i{0.0, 1.0};
    for (std::size_t u = 0; u < columns; ++u) {
        in[u] = one[u] + i * other[u];
    }
    for (std::size_t u = 1; u + 1 < columns; ++u) {
        in[in.size() - u] = std::conj(one[u]) + i * std::conj(other[u]);
    }
}

/// Transforms two fields along their rows, the one as real, the other as imaginary part.
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

/// Multiplies the rows' transforms by the eigenvalues, there and back along columns.
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

} // namespace

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
            // All but the axes stand for their mirror images too.
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

} // namespace thalweg::solver
