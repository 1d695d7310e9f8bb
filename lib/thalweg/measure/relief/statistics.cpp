// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/statistics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/elementary_rows.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::measure {

namespace {

constexpr std::int64_t rows_a_sum = 8;

/// Sums over one row. Rows are combined in order, regardless of the thread that computed them.
struct RowSums {
    std::int64_t cells = 0;
    Extreme min;
    Extreme max;
    CompensatedSum above_datum;
    CompensatedSum squares;
    CompensatedSum slope_cells;
    CompensatedSum slope_metres;
    CompensatedSum cubes;
    CompensatedSum fourths;
    CompensatedSum rises_along_row;
    CompensatedSum rises_along_column;
    std::int64_t pairs_along_row = 0;
    std::int64_t pairs_along_column = 0;
};

void add_heights(Raster<float> const& dem, std::int64_t row, double datum, RowSums& sums) {
    auto const here = dem.row(row);
    for (std::size_t c = 0; c < here.size(); ++c) {
        if (std::isnan(here[c])) {
            continue;
        }
        double const z = here[c];
        Cell const cell{static_cast<std::int64_t>(c), row};
        if (sums.cells == 0 || z < sums.min.z) {
            sums.min = {z, cell};
        }
        if (sums.cells == 0 || z > sums.max.z) {
            sums.max = {z, cell};
        }
        ++sums.cells;
        sums.above_datum.add(z - datum);
    }
}

/// How much some cells of a row rise a cell [m], from this one on.
/// \param north,south rows beside it, or of holes
void gradients(float const* north, std::span<float const> row, float const* south, std::size_t first,
               std::span<double> out) {
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    auto const set = [&](std::size_t c, float west, float east) {
        double const dx = solver::central_difference(west, row[c], east);
        double const dy = solver::central_difference(north[c], row[c], south[c]);
        out[c - first] = std::sqrt(dx * dx + dy * dy);
    };
    std::size_t const beyond = first + out.size();
    for (std::size_t c = std::max<std::size_t>(first, 1); c < std::min(beyond, row.size() - 1); ++c) {
        set(c, row[c - 1], row[c + 1]);
    }
    if (first == 0) {
        set(0, hole, row.size() > 1 ? row[1] : hole);
    }
    if (beyond == row.size()) {
        set(beyond - 1, beyond > 1 ? row[beyond - 2] : hole, hole);
    }
}

void add_slopes(Raster<float> const& dem, std::int64_t row, RowSums& sums) {
    constexpr std::size_t at_once = 256;
    auto const here = dem.row(row);
    bool const is_inside = row > 0 && row + 1 < dem.height();
    std::vector<float> const holes(is_inside ? 0 : here.size(), std::numeric_limits<float>::quiet_NaN());
    float const* const north = row > 0 ? dem.row(row - 1).data() : holes.data();
    float const* const south = row + 1 < dem.height() ? dem.row(row + 1).data() : holes.data();
    std::array<double, at_once> gradient{};
    std::array<double, at_once> by_cell{};
    std::array<double, at_once> by_metre{};
    for (std::size_t first = 0; first < here.size(); first += at_once) {
        std::span const some(gradient.data(), std::min(at_once, here.size() - first));
        gradients(north, here, south, first, some);
        portable::atan2_row(some, 1.0, by_cell);
        portable::atan2_row(some, dem.grid().cell_m, by_metre);
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (!std::isnan(here[first + i])) {
                sums.slope_cells.add(by_cell[i]);
                sums.slope_metres.add(by_metre[i]);
            }
        }
    }
}

void add_rises(Raster<float> const& dem, std::int64_t row, RowSums& sums) {
    auto const here = dem.row(row);
    auto const north = row > 0 ? dem.row(row - 1) : std::span<float const>{};
    auto const add = [](float a, float b, CompensatedSum& rises, std::int64_t& pairs) {
        if (!std::isnan(a) && !std::isnan(b)) {
            rises.add(std::fabs(static_cast<double>(b) - a));
            ++pairs;
        }
    };
    for (std::size_t c = 0; c < here.size(); ++c) {
        if (c > 0) {
            add(here[c - 1], here[c], sums.rises_along_row, sums.pairs_along_row);
        }
        if (!north.empty()) {
            add(north[c], here[c], sums.rises_along_column, sums.pairs_along_column);
        }
    }
}

void add_powers(Raster<float> const& dem, std::int64_t row, double mean, RowSums& sums) {
    for (float const z : dem.row(row)) {
        if (!std::isnan(z)) {
            double const above = z - mean;
            sums.squares.add(above * above);
            sums.cubes.add(above * above * above);
            sums.fourths.add(above * above * above * above);
        }
    }
}

/// The mean of two axes' means, or of the only one with pairs.
double mean_of_axes(double row_sum, std::int64_t row_pairs, double column_sum, std::int64_t column_pairs) {
    double const along_row = row_sum / static_cast<double>(row_pairs);
    double const along_column = column_sum / static_cast<double>(column_pairs);
    if (row_pairs == 0) {
        return along_column;
    }
    return column_pairs == 0 ? along_row : (along_row + along_column) / 2.0;
}

/// First cell with a height; checks that no height is infinite.
double first_height(Raster<float> const& dem) {
    auto const values = dem.values();
    auto const infinite = std::find_if(values.begin(), values.end(), [](float z) { return std::isinf(z); });
    if (infinite != values.end()) {
        Cell const cell = dem.grid().at(infinite - values.begin());
        throw BadInput("measure.statistics",
                       fmt::format("the height at column {}, row {} is infinite; mark cells without data as NaN",
                                   cell.col, cell.row));
    }
    auto const first = std::find_if(values.begin(), values.end(), [](float z) { return !std::isnan(z); });
    refuse_if<BadInput>(first == values.end(), "measure.statistics",
                        "none of the {} cells of the DEM has a height; is the no-data value right?", dem.cells());
    return *first;
}

double total(std::vector<RowSums> const& rows, CompensatedSum RowSums::*member) {
    CompensatedSum sum;
    for (RowSums const& row : rows) {
        sum.add((row.*member).value());
    }
    return sum.value();
}

/// Extremes, counts, mean, slopes and roughness from one pass over the cells.
Statistics first_statistics(std::vector<RowSums> const& rows, std::int64_t cells, double datum) {
    Statistics result;
    std::int64_t row_pairs = 0;
    std::int64_t column_pairs = 0;
    for (RowSums const& row : rows) {
        row_pairs += row.pairs_along_row;
        column_pairs += row.pairs_along_column;
        if (row.cells > 0) {
            result.min = result.cells == 0 || row.min.z < result.min.z ? row.min : result.min;
            result.max = result.cells == 0 || row.max.z > result.max.z ? row.max : result.max;
            result.cells += row.cells;
        }
    }
    result.nodata = cells - result.cells;
    auto const n = static_cast<double>(result.cells);
    result.mean = datum + total(rows, &RowSums::above_datum) / n;
    result.slope_rad = total(rows, &RowSums::slope_cells) / n;
    result.slope_true_deg = total(rows, &RowSums::slope_metres) / n * (180.0 / portable::pi);
    result.roughness_m = mean_of_axes(total(rows, &RowSums::rises_along_row), row_pairs,
                                      total(rows, &RowSums::rises_along_column), column_pairs);
    return result;
}

void add_moments(Statistics& result, std::vector<RowSums> const& rows) {
    auto const n = static_cast<double>(result.cells);
    result.std = std::sqrt(total(rows, &RowSums::squares) / n);
    double const variance = result.std * result.std;
    result.skew = total(rows, &RowSums::cubes) / n / (variance * result.std);
    result.kurtosis = total(rows, &RowSums::fourths) / n / (variance * variance) - 3.0;
}

} // namespace

Statistics statistics(Raster<float> const& dem, Run const& run) {
    // Sums are relative to a height of the DEM: no digits are lost to an offset, and a plain has a deviation of exactly
    // 0.
    double const datum = first_height(dem);
    refuse_if<BadInput>(!(dem.grid().cell_m > 0.0), "measure.statistics",
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    std::vector<RowSums> rows(dem.height());
    auto const for_rows = [&](auto const& add) {
        parallel_ranges(run, dem.height(), rows_a_sum, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t r = begin; r < end; ++r) {
                run.check();
                add(r, rows[r]);
            }
        });
    };
    for_rows([&](std::int64_t r, RowSums& sums) {
        add_heights(dem, r, datum, sums);
        add_slopes(dem, r, sums);
        add_rises(dem, r, sums);
    });
    Statistics result = first_statistics(rows, dem.cells(), datum);
    for_rows([&](std::int64_t r, RowSums& sums) { add_powers(dem, r, result.mean, sums); });
    add_moments(result, rows);
    using solver::Axis;
    result.lx = solver::correlation_length(solver::correlogram(dem, result.mean, result.std, Axis::rows, run));
    result.ly = solver::correlation_length(solver::correlogram(dem, result.mean, result.std, Axis::columns, run));
    result.dimension = solver::fractal_dimension(solver::differences(dem, solver::near_lags, run));
    result.dimension_dyadic = solver::fractal_dimension(solver::differences(dem, solver::dyadic_lags, run));
    return result;
}

} // namespace thalweg::measure
