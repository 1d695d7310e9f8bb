// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/box_means.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg {
namespace {

/// The cells from begin to end, of which the first and the last count in part.
struct Stretch {
    std::int64_t begin = 0;
    std::int64_t end = 0;
    double first = 1.0;
    double last = 1.0; ///< of a single cell: 1, and first is its whole share

    double weight(std::int64_t i) const { return (i == begin ? first : 1.0) * (i + 1 == end ? last : 1.0); }
    /// \param of number by cell
    double weighted_sum(auto const& of) const {
        double sum = 0.0 + weight(begin) * of(begin);
        for (std::int64_t i = begin + 1; i + 1 < end; ++i) {
            sum += of(i);
        }
        return begin + 1 < end ? sum + last * of(end - 1) : sum;
    }
};

/// \param side [fine cells] of a coarse cell, >= 1
/// \param count of fine cells
Stretch stretch_of(std::int64_t coarse, double side, std::int64_t count) {
    constexpr double rounding = 1e-9;
    double const from = static_cast<double>(coarse) * side;
    double const to = std::min(from + side, static_cast<double>(count));
    Stretch out;
    out.begin = std::min(static_cast<std::int64_t>(from + rounding), count - 1);
    out.end = std::clamp(static_cast<std::int64_t>(std::ceil(to - rounding)), out.begin + 1, count);
    bool const is_one = out.end == out.begin + 1;
    out.first = std::max(rounding, std::min(to, static_cast<double>(out.begin + 1)) - from);
    out.last = is_one ? 1.0 : to - static_cast<double>(out.end - 1);
    return out;
}

/// Sums along columns of fine cells, and what they weigh.
struct Sums {
    std::vector<double> sum;
    std::vector<double> weight;
};

void add_row(std::span<float const> row, double weight, Sums& sums) {
    for (std::size_t c = 0; c < row.size(); ++c) {
        double const share = std::isnan(row[c]) ? 0.0 : weight;
        double const value = std::isnan(row[c]) ? 0.0 : static_cast<double>(row[c]);
        sums.sum[c] += share * value;
        sums.weight[c] += share;
    }
}

/// As add_row() where all cells count: what these weigh is the same in every column.
/// \return whether all do; otherwise the sums are not to be used
bool add_whole_row(std::span<float const> row, double weight, std::span<double> sums) {
    std::uint32_t holes = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
        holes |= std::isnan(row[c]) ? 1U : 0U;
        sums[c] += weight * static_cast<double>(row[c]);
    }
    return holes == 0;
}

bool add_whole_row(std::span<std::uint8_t const> row, double weight, std::span<double> sums) {
    for (std::size_t c = 0; c < row.size(); ++c) {
        sums[c] += row[c] != 0 ? weight : 0.0;
    }
    return true;
}

/// \return whether all cells of the rows count; otherwise the sums are not to be used
template <class T> bool sum_whole_rows(Raster<T> const& fine, Stretch const& down, std::span<double> sums) {
    std::ranges::fill(sums, 0.0);
    for (std::int64_t r = down.begin; r < down.end; ++r) {
        if (!add_whole_row(fine.row(r), down.weight(r), sums)) {
            return false;
        }
    }
    return true;
}

void sum_rows_with_holes(Raster<float> const& fine, Stretch const& down, Sums& sums) {
    std::ranges::fill(sums.sum, 0.0);
    std::ranges::fill(sums.weight, 0.0);
    for (std::int64_t r = down.begin; r < down.end; ++r) {
        add_row(fine.row(r), down.weight(r), sums);
    }
}

/// Calls put(coarse cell, sum, weight, area) for every cell.
template <class T, class Put> void each_mean(Raster<T> const& fine, Grid const& grid, Run const& run, Put const& put) {
    double const side = static_cast<double>(fine.width()) / static_cast<double>(grid.width);
    auto const one = [](std::int64_t) { return 1.0; };
    std::vector<Stretch> across;
    std::vector<double> wide;
    for (std::int64_t col = 0; col < grid.width; ++col) {
        across.push_back(stretch_of(col, side, fine.width()));
        wide.push_back(across.back().weighted_sum(one));
    }
    constexpr std::int64_t grain = 16;
    parallel_ranges(run, grid.height, grain, [&](std::int64_t first, std::int64_t last) {
        Sums sums{std::vector<double>(fine.width()), std::vector<double>(fine.width())};
        for (std::int64_t row = first; row < last; ++row) {
            Stretch const down = stretch_of(row, side, fine.height());
            bool const is_whole = sum_whole_rows(fine, down, sums.sum);
            if constexpr (std::is_same_v<T, float>) {
                if (!is_whole) {
                    sum_rows_with_holes(fine, down, sums);
                }
            }
            double const tall = down.weighted_sum(one);
            auto const sum = [from = sums.sum.data()](std::int64_t c) { return from[c]; };
            auto const weight = [from = sums.weight.data()](std::int64_t c) { return from[c]; };
            auto const even = [tall](std::int64_t) { return tall; };
            for (std::int64_t col = 0; col < grid.width; ++col) {
                Stretch const& cells = across[static_cast<std::size_t>(col)];
                put(Cell{col, row}, cells.weighted_sum(sum),
                    is_whole ? cells.weighted_sum(even) : cells.weighted_sum(weight),
                    wide[static_cast<std::size_t>(col)] * tall);
            }
        }
    });
}

constexpr double half = 0.5 - 1e-9;

/// The higher of two values; NaN: both are.
float higher(float a, float b) {
    return a >= b || std::isnan(b) ? a : b;
}

} // namespace

Grid coarser(Grid const& grid, std::int64_t columns) {
    Grid out = grid;
    double const side = static_cast<double>(grid.width) / static_cast<double>(columns);
    out.width = columns;
    out.height =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(static_cast<double>(grid.height) / side - 1e-6)));
    out.cell_m = grid.cell_m * side;
    return out;
}

Raster<float> box_means(Raster<float> const& fine, std::int64_t columns, Run const& run) {
    Raster<float> out(coarser(fine.grid(), columns));
    each_mean(fine, out.grid(), run, [&](Cell c, double sum, double weight, double area) {
        out[c] = weight > 0.0 && weight >= half * area ? static_cast<float>(sum / weight)
                                                       : std::numeric_limits<float>::quiet_NaN();
    });
    return out;
}

Mask box_means(Mask const& fine, std::int64_t columns, Run const& run) {
    Mask out(coarser(fine.grid(), columns));
    each_mean(fine, out.grid(), run, [&](Cell c, double sum, double weight, double /*area*/) {
        out[c] = sum > 0.0 && sum >= half * weight ? 1 : 0;
    });
    return out;
}

Mask box_marks(Mask const& fine, std::int64_t columns) {
    Mask out(coarser(fine.grid(), columns));
    for (std::int64_t i = 0; i < fine.cells(); ++i) {
        if (fine[i] != 0) {
            // The centre of a cell is half a cell farther: twice as many halves are whole numbers.
            Cell const c = fine.grid().at(i);
            std::int64_t const halves = 2 * fine.width();
            out[Cell{(2 * c.col + 1) * columns / halves, (2 * c.row + 1) * columns / halves}] = 1;
        }
    }
    return out;
}

Raster<float> block_maxima(Raster<float> const& fine, std::int64_t side, Run const& run) {
    Grid grid = fine.grid();
    grid.width = (grid.width + side - 1) / side;
    grid.height = (grid.height + side - 1) / side;
    grid.cell_m *= static_cast<double>(side);
    Raster<float> out(grid, std::numeric_limits<float>::quiet_NaN());
    constexpr std::int64_t grain = 16;
    parallel_ranges(run, grid.height, grain, [&](std::int64_t first, std::int64_t last) {
        std::vector<float> most(static_cast<std::size_t>(fine.width())); // of each column of cells, in a row of blocks
        for (std::int64_t row = first; row < last; ++row) {
            std::ranges::copy(fine.row(row * side), most.begin());
            for (std::int64_t r = row * side + 1; r < std::min((row + 1) * side, fine.height()); ++r) {
                auto const from = fine.row(r);
                for (std::size_t c = 0; c < most.size(); ++c) {
                    most[c] = higher(most[c], from[c]);
                }
            }
            for (std::int64_t col = 0; col < grid.width; ++col) {
                float highest = std::numeric_limits<float>::quiet_NaN();
                for (std::int64_t c = col * side; c < std::min((col + 1) * side, fine.width()); ++c) {
                    highest = higher(highest, most[static_cast<std::size_t>(c)]);
                }
                out[Cell{col, row}] = highest;
            }
        }
    });
    return out;
}

} // namespace thalweg
