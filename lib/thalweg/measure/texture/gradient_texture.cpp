// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/gradient_texture.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/measure/texture/internal/smooth_blocks.hpp>

namespace thalweg::measure {

namespace {

constexpr double too_small = std::numeric_limits<double>::quiet_NaN();
constexpr double blocks_a_window = 8.0; // the window's weights change little from one block to the next
constexpr double least_weight = 0.98;   // of the window on cells with data
constexpr double border_windows = 2.0;  // beyond it a window has 2 % of its weight

/// Unit vectors uphill; 0 where the DEM is level, NaN where it has no data.
struct UnitGradients {
    Raster<float> x;
    Raster<float> y;
};

float difference(float before, float here, float after, bool first, bool last) {
    return first ? 2.0F * (after - here) : last ? 2.0F * (here - before) : after - before;
}

UnitGradients unit_gradients(Raster<float> const& dem, Run const& run) {
    UnitGradients found{Raster<float>(dem.grid()), Raster<float>(dem.grid())};
    std::int64_t const bottom = dem.height() - 1;
    std::int64_t const right = dem.width() - 1;
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const north = dem.row(std::max<std::int64_t>(r - 1, 0));
            auto const here = dem.row(r);
            auto const south = dem.row(std::min(r + 1, bottom));
            for (std::int64_t c = 0; c <= right; ++c) {
                auto const at = [](std::span<float const> row, std::int64_t col) {
                    return row[static_cast<std::size_t>(col)];
                };
                float const z = at(here, c);
                float const x = difference(at(here, std::max<std::int64_t>(c - 1, 0)), z,
                                           at(here, std::min(c + 1, right)), c == 0, c == right);
                float const y = difference(at(north, c), z, at(south, c), r == 0, r == bottom);
                float const length = std::sqrt(x * x + y * y);
                bool const known = !std::isnan(z) && !std::isnan(length);
                found.x[Cell{c, r}] = length > 0.0F ? x / length : known ? 0.0F : static_cast<float>(too_small);
                found.y[Cell{c, r}] = length > 0.0F ? y / length : known ? 0.0F : static_cast<float>(too_small);
            }
        }
    });
    return found;
}

struct Products {
    double sum = 0.0;
    std::int64_t pairs = 0;

    Products& operator+=(Products const& more) {
        sum += more.sum;
        pairs += more.pairs;
        return *this;
    }
    double mean() const { return pairs > 0 ? sum / static_cast<double>(pairs) : too_small; }
};

/// Over the pairs of cells that lie `lag` apart.
Products products(UnitGradients const& unit, Cell lag, Run const& run) {
    std::int64_t const offset = lag.row * unit.x.width() + lag.col;
    return sum_rows(run, unit.x.height() - lag.row, [&](std::int64_t r) {
        run.check();
        Products row;
        std::int64_t const first = r * unit.x.width();
        for (std::int64_t i = first; i < first + unit.x.width() - lag.col; ++i) {
            auto const x = static_cast<double>(unit.x[i]);
            auto const y = static_cast<double>(unit.y[i]);
            auto const there_x = static_cast<double>(unit.x[i + offset]);
            auto const there_y = static_cast<double>(unit.y[i + offset]);
            bool const slopes = (x != 0.0 || y != 0.0) && (there_x != 0.0 || there_y != 0.0);
            double const product = x * there_x + y * there_y;
            if (slopes && !std::isnan(product)) {
                row.sum += product;
                ++row.pairs;
            }
        }
        return row;
    });
}

double correlation(UnitGradients const& unit, double lag_m, Run const& run) {
    double const cells = std::round(lag_m / unit.x.grid().cell_m);
    if (cells < 1.0 || cells >= static_cast<double>(std::min(unit.x.width(), unit.x.height()))) {
        return too_small;
    }
    auto const lag = static_cast<std::int64_t>(cells);
    return 0.5 * (products(unit, {lag, 0}, run).mean() + products(unit, {0, lag}, run).mean());
}

Tensor tensor_of(UnitGradients const& unit, std::int64_t cell) {
    auto const x = static_cast<double>(unit.x[cell]);
    auto const y = static_cast<double>(unit.y[cell]);
    return std::isnan(x) ? Tensor{} : Tensor{x * x, y * y, x * y, 1.0};
}

/// Means of the tensor over square blocks of `side` cells.
Raster<Tensor> blocks_of(UnitGradients const& unit, std::int64_t side, Run const& run) {
    Grid grid = unit.x.grid();
    grid.width = (grid.width + side - 1) / side;
    grid.height = (grid.height + side - 1) / side;
    Raster<Tensor> blocks(grid);
    parallel_ranges(run, grid.height, 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin * side; r < std::min(end * side, unit.x.height()); ++r) {
            run.check();
            for (std::int64_t c = 0; c < unit.x.width(); ++c) {
                blocks[Cell{c / side, r / side}] += tensor_of(unit, r * unit.x.width() + c);
            }
        }
    });
    for (std::int64_t i = 0; i < blocks.cells(); ++i) {
        Cell const at = grid.at(i);
        std::int64_t const wide = std::min(side, unit.x.width() - at.col * side);
        std::int64_t const high = std::min(side, unit.x.height() - at.row * side);
        blocks[i] *= 1.0 / static_cast<double>(wide * high);
    }
    return blocks;
}

double anisotropy(UnitGradients const& unit, double window_m, Run const& run) {
    double const window = window_m / unit.x.grid().cell_m; // cells
    if (!(window >= 1.0) ||
        2.0 * border_windows * window >= static_cast<double>(std::min(unit.x.width(), unit.x.height()))) {
        return too_small;
    }
    auto const side = std::max<std::int64_t>(static_cast<std::int64_t>(window / blocks_a_window), 1);
    auto const cells = static_cast<double>(side);
    Raster<Tensor> const smooth = smooth_blocks(blocks_of(unit, side, run), window / cells, run);
    Products sum;
    for (std::int64_t i = 0; i < smooth.cells(); ++i) {
        Cell const at = smooth.grid().at(i);
        auto const inside = [&](std::int64_t place, std::int64_t count) {
            double const centre = (static_cast<double>(place) + 0.5) * cells;
            return centre >= border_windows * window && centre <= static_cast<double>(count) - border_windows * window;
        };
        Tensor const& t = smooth[i];
        if (t.weight > least_weight && t.xx + t.yy > 0.0 && inside(at.col, unit.x.width()) &&
            inside(at.row, unit.x.height())) {
            sum.sum += std::sqrt((t.xx - t.yy) * (t.xx - t.yy) + 4.0 * t.xy * t.xy) / (t.xx + t.yy);
            ++sum.pairs;
        }
    }
    return sum.mean();
}

} // namespace

GradientTexture gradient_texture(Raster<float> const& dem, GradientTextureParams const& params, Run const& run) {
    require_in("measure.gradient_texture", "window_m", params.window_m, Range::above(0.0));
    GradientTexture found;
    found.correlation.fill(too_small);
    if (dem.width() < 2 || dem.height() < 2) {
        return found;
    }
    if (!(dem.grid().cell_m > 0.0)) {
        throw BadInput(
            fmt::format("measure.gradient_texture: the DEM's cells have a side of {} m; it must be greater than 0",
                        dem.grid().cell_m));
    }
    UnitGradients const unit = unit_gradients(dem, run);
    for (std::size_t lag = 0; lag < texture_lags_m.size(); ++lag) {
        found.correlation[lag] = correlation(unit, texture_lags_m[lag], run);
    }
    found.anisotropy = anisotropy(unit, params.window_m, run);
    return found;
}

} // namespace thalweg::measure
