// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/box_means.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
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

/// Adds up so many columns of rows in registers.
template <std::size_t columns>
std::array<double, columns> column_sums(float const* from, std::size_t stride, std::size_t rows, double first,
                                        double last) {
    std::array<double, columns> sum{};
    for (std::size_t c = 0; c < columns; ++c) {
        sum[c] += first * static_cast<double>(from[c]);
    }
    for (std::size_t row = 1; row + 1 < rows; ++row) {
        from += stride;
        for (std::size_t c = 0; c < columns; ++c) {
            sum[c] += static_cast<double>(from[c]);
        }
    }
    for (std::size_t c = 0; rows > 1 && c < columns; ++c) {
        sum[c] += last * static_cast<double>(from[stride + c]);
    }
    return sum;
}

/// Adds up rows of which all cells count: what these weigh is the same in every column.
/// \return whether all do, which a sum that is no number denies; otherwise the sums are not to be used
bool sum_whole_rows(Raster<float> const& fine, Stretch const& down, std::span<double> sums) {
    constexpr std::size_t at_once = 8;
    auto const stride = static_cast<std::size_t>(fine.width());
    auto const rows = static_cast<std::size_t>(down.end - down.begin);
    float const* const from = fine.row(down.begin).data();
    double const first = down.weight(down.begin);
    std::size_t col = 0;
    for (; col + at_once <= stride; col += at_once) {
        auto const some = column_sums<at_once>(from + col, stride, rows, first, down.last);
        std::ranges::copy(some, sums.begin() + static_cast<std::ptrdiff_t>(col));
    }
    for (; col < stride; ++col) {
        sums[col] = column_sums<1>(from + col, stride, rows, first, down.last)[0];
    }
    std::uint32_t holes = 0;
    for (double const sum : sums) {
        holes |= std::isnan(sum) ? 1U : 0U;
    }
    return holes == 0;
}

bool is_marked(std::span<std::uint8_t const> row) {
    std::uint8_t marks = 0;
    for (std::uint8_t const mark : row) { // to the end: many marks at once
        marks |= mark;
    }
    return marks != 0;
}

bool sum_whole_rows(Mask const& fine, Stretch const& down, std::span<double> sums) {
    std::ranges::fill(sums, 0.0);
    for (std::int64_t r = down.begin; r < down.end; ++r) {
        auto const row = fine.row(r);
        if (!is_marked(row)) {
            continue;
        }
        double const weight = down.weight(r);
        for (std::size_t c = 0; c < row.size(); ++c) {
            sums[c] += row[c] != 0 ? weight : 0.0;
        }
    }
    return true;
}

void sum_rows_with_holes(Raster<float> const& fine, Stretch const& down, Sums& sums) {
    std::ranges::fill(sums.sum, 0.0);
    std::ranges::fill(sums.weight, 0.0);
    for (std::int64_t r = down.begin; r < down.end; ++r) {
        auto const row = fine.row(r);
        double const weight = down.weight(r);
        for (std::size_t c = 0; c < row.size(); ++c) {
            double const share = std::isnan(row[c]) ? 0.0 : weight;
            double const value = std::isnan(row[c]) ? 0.0 : static_cast<double>(row[c]);
            sums.sum[c] += share * value;
            sums.weight[c] += share;
        }
    }
}

/// Averages a raster over rows of coarse cells.
template <class T> class Means {
public:
    Means(Raster<T> const& fine, Grid const& grid)
        : fine_(fine), width_(grid.width), side_(static_cast<double>(fine.width()) / static_cast<double>(grid.width)) {
        for (std::int64_t col = 0; col < width_; ++col) {
            across_.push_back(stretch_of(col, side_, fine.width()));
            wide_.push_back(across_.back().weighted_sum([](std::int64_t) { return 1.0; }));
        }
    }

    /// The fine rows of a coarse one.
    Stretch down(std::int64_t row) const { return stretch_of(row, side_, fine_.height()); }

    /// Calls put(coarse cell, sum, weight, area) for every cell of a row.
    template <class Put> void row(std::int64_t row, Sums& sums, Put const& put) const {
        sums.sum.resize(static_cast<std::size_t>(fine_.width()));
        Stretch const down = this->down(row);
        bool const is_whole = sum_whole_rows(fine_, down, sums.sum);
        if constexpr (std::is_same_v<T, float>) {
            if (!is_whole) {
                sums.weight.resize(sums.sum.size());
                sum_rows_with_holes(fine_, down, sums);
            }
        }
        double const tall = down.weighted_sum([](std::int64_t) { return 1.0; });
        auto const sum = [from = sums.sum.data()](std::int64_t c) { return from[c]; };
        auto const weight = [from = sums.weight.data()](std::int64_t c) { return from[c]; };
        auto const even = [tall](std::int64_t) { return tall; };
        for (std::int64_t col = 0; col < width_; ++col) {
            Stretch const& cells = across_[static_cast<std::size_t>(col)];
            put(Cell{col, row}, cells.weighted_sum(sum),
                is_whole ? cells.weighted_sum(even) : cells.weighted_sum(weight),
                wide_[static_cast<std::size_t>(col)] * tall);
        }
    }

private:
    Raster<T> const& fine_;
    std::int64_t width_;
    double side_; ///< [fine cells] of a coarse cell
    std::vector<Stretch> across_;
    std::vector<double> wide_;
};

/// Calls put(coarse cell, sum, weight, area) for every cell.
template <class T, class Put> void each_mean(Raster<T> const& fine, Grid const& grid, Run const& run, Put const& put) {
    Means<T> const means(fine, grid);
    constexpr std::int64_t grain = 16;
    parallel_ranges(run, grid.height, grain, [&](std::int64_t first, std::int64_t last) {
        Sums sums;
        for (std::int64_t row = first; row < last; ++row) {
            means.row(row, sums, put);
        }
    });
}

constexpr double half = 0.5 - 1e-9;

/// The mean of a coarse cell; NaN: less than half of it has values.
float mean_of(double sum, double weight, double area) {
    return weight > 0.0 && weight >= half * area ? static_cast<float>(sum / weight)
                                                 : std::numeric_limits<float>::quiet_NaN();
}

constexpr float infinite = std::numeric_limits<float>::infinity();

/// The higher and the lower of two values; of those that are not a number, the other one.
float higher(float most, float z) {
    return z > most ? z : most;
}

float lower(float least, float z) {
    return z < least ? z : least;
}

/// The highest and the lowest value by column of some rows; infinite: none.
struct Extremes {
    std::vector<float> most;
    std::vector<float> least;

    explicit Extremes(std::int64_t columns)
        : most(static_cast<std::size_t>(columns), -infinite), least(static_cast<std::size_t>(columns), infinite) {}

    /// Adds rows, four at a time: what they are added to is read and written once for these.
    /// \param with_least or the highest alone
    template <bool with_least> void add_rows(Raster<float> const& fine, std::int64_t first, std::int64_t last) {
        std::int64_t row = first;
        for (; row + 4 <= last; row += 4) {
            add<with_least>(std::array{fine.row(row).data(), fine.row(row + 1).data(), fine.row(row + 2).data(),
                                       fine.row(row + 3).data()});
        }
        for (; row < last; ++row) {
            add<with_least>(std::array{fine.row(row).data()});
        }
    }

private:
    template <bool with_least, std::size_t rows> void add(std::array<float const*, rows> const& from) {
        for (std::size_t c = 0; c < most.size(); ++c) {
            float high = most[c];
            float low = least[c];
            for (float const* const row : from) {
                high = higher(high, row[c]);
                low = lower(low, row[c]);
            }
            most[c] = high;
            if constexpr (with_least) {
                least[c] = low;
            }
        }
    }
};

Grid grid_of_blocks(Grid grid, std::int64_t side) {
    grid.width = (grid.width + side - 1) / side;
    grid.height = (grid.height + side - 1) / side;
    grid.cell_m *= static_cast<double>(side);
    return grid;
}

bool has_values(Raster<float> const& fine, Cell block, std::int64_t side) {
    for (std::int64_t row = block.row * side; row < std::min((block.row + 1) * side, fine.height()); ++row) {
        for (std::int64_t col = block.col * side; col < std::min((block.col + 1) * side, fine.width()); ++col) {
            if (!std::isnan(fine[Cell{col, row}])) {
                return true;
            }
        }
    }
    return false;
}

/// Sets a row of blocks to their highest values.
/// \param seen takes the cells; its highest values are those of this row alone
/// \return the highest of all; infinite: none
template <bool with_least>
float find_maxima(Raster<float> const& fine, std::int64_t side, std::int64_t row, Extremes& seen,
                  Raster<float>& maxima) {
    std::ranges::fill(seen.most, -infinite);
    seen.add_rows<with_least>(fine, row * side, std::min((row + 1) * side, fine.height()));
    float of_all = -infinite;
    for (std::int64_t col = 0; col < maxima.width(); ++col) {
        auto const end = seen.most.begin() + std::min((col + 1) * side, fine.width());
        float const highest = std::accumulate(seen.most.begin() + col * side, end, -infinite, higher);
        bool const has = highest > -infinite || has_values(fine, {col, row}, side);
        maxima[Cell{col, row}] = has ? highest : std::numeric_limits<float>::quiet_NaN();
        of_all = higher(of_all, highest);
    }
    return of_all;
}

/// The lowest and the highest of two ranges.
std::pair<float, float> joined(std::pair<float, float> a, std::pair<float, float> b) {
    return {lower(a.first, b.first), higher(a.second, b.second)};
}

constexpr std::pair<float, float> no_range{infinite, -infinite};

/// Finds the parts of an overview in bands of fine rows: what lies or begins in one, while its cells are in a
/// processor's own cache.
class Survey {
public:
    Survey(Raster<float> const& fine, std::int64_t columns, std::int64_t side, Overview& found)
        : fine_(fine), side_(side), found_(found) {
        if (columns < fine.width()) {
            found.means = Raster<float>(coarser(fine.grid(), columns));
            means_.emplace(fine, found.means.grid());
            for (std::int64_t row = 0; row < found.means.height(); ++row) {
                begins_.push_back(means_->down(row).begin);
            }
        }
        if (side > 1) {
            found.maxima = Raster<float>(grid_of_blocks(fine.grid(), side));
        }
        constexpr std::int64_t cells_at_once = 1 << 17;
        tall_ = side * std::max<std::int64_t>(1, cells_at_once / std::max<std::int64_t>(1, fine.width() * side));
    }

    std::int64_t bands() const { return (fine_.height() + tall_ - 1) / tall_; }

    /// \return the range of the values in some bands
    std::pair<float, float> take(std::int64_t first, std::int64_t last) const {
        Extremes seen(fine_.width());
        Sums sums;
        float highest = -infinite;
        for (std::int64_t band = first; band < last; ++band) {
            std::int64_t const begin = band * tall_;
            std::int64_t const end = std::min(begin + tall_, fine_.height());
            if (side_ == 1) {
                seen.add_rows<true>(fine_, begin, end);
            }
            for (std::int64_t row = begin / side_; side_ > 1 && row * side_ < end; ++row) {
                highest = higher(highest, find_maxima<true>(fine_, side_, row, seen, found_.maxima));
            }
            for (std::int64_t row = coarse_row(begin), beyond = coarse_row(end); row < beyond; ++row) {
                means_->row(row, sums, [&](Cell c, double sum, double weight, double area) {
                    found_.means[c] = mean_of(sum, weight, area);
                });
            }
        }
        return {std::accumulate(seen.least.begin(), seen.least.end(), infinite, lower),
                std::accumulate(seen.most.begin(), seen.most.end(), highest, higher)};
    }

private:
    /// The first row of means that begins in this fine row or beyond.
    std::int64_t coarse_row(std::int64_t fine_row) const {
        return std::ranges::lower_bound(begins_, fine_row) - begins_.begin();
    }

    Raster<float> const& fine_;
    std::int64_t side_;
    Overview& found_;
    std::optional<Means<float>> means_; ///< nothing: none are wanted
    std::vector<std::int64_t> begins_;  ///< by row of means: its first fine row
    std::int64_t tall_ = 1;             ///< [fine rows] of a band
};

/// The range of the values that are finite.
std::pair<float, float> finite_range(Raster<float> const& fine) {
    std::pair<float, float> range = no_range;
    for (float const z : fine.values()) {
        range = std::isfinite(z) ? joined(range, {z, z}) : range;
    }
    return range;
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
    each_mean(fine, out.grid(), run,
              [&](Cell c, double sum, double weight, double area) { out[c] = mean_of(sum, weight, area); });
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
    Raster<float> out(grid_of_blocks(fine.grid(), side));
    constexpr std::int64_t grain = 16;
    parallel_ranges(run, out.height(), grain, [&](std::int64_t first, std::int64_t last) {
        Extremes seen(fine.width());
        for (std::int64_t row = first; row < last; ++row) {
            find_maxima<false>(fine, side, row, seen, out);
        }
    });
    return out;
}

Overview overview(Raster<float> const& fine, std::int64_t columns, std::int64_t side, Run const& run) {
    Overview found;
    Survey const survey(fine, columns, side, found);
    std::pair<float, float> range = no_range;
    std::mutex guard;
    parallel_ranges(run, survey.bands(), 1, [&](std::int64_t first, std::int64_t last) {
        auto const here = survey.take(first, last);
        std::scoped_lock const lock(guard);
        range = joined(range, here);
    });
    if (range.first == -infinite || range.second == infinite) { // some heights are none, or there are no heights
        range = finite_range(fine);
    }
    if (range.first <= range.second) {
        // No zero has a sign: which of two comes first depends on the threads.
        found.range = std::pair(static_cast<double>(range.first) + 0.0, static_cast<double>(range.second) + 0.0);
    }
    return found;
}

} // namespace thalweg
