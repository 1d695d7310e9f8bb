// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace thalweg::pipeline {

namespace {

constexpr std::int64_t most_values = 1'500'000;
constexpr std::int64_t longest_side = 4096;
constexpr double steps = 65534.0; // values 1 .. 65535, 0 is no data
constexpr std::size_t predictors = 4;

std::int64_t parts(std::int64_t cells, std::int64_t of) {
    return (cells + of - 1) / of;
}

/// Means of the squares, row-major; NaN for none.
std::vector<double> means(Raster<float> const& dem, PageHeights const& page, Run const& run) {
    auto const width = static_cast<std::size_t>(page.width);
    auto const side = static_cast<std::size_t>(page.cells);
    std::vector<double> mean(width * static_cast<std::size_t>(page.height));
    std::vector<double> sum(width);
    std::vector<std::int64_t> count(width);
    for (std::int64_t value_row = 0; value_row < page.height; ++value_row) {
        run.check();
        std::fill(sum.begin(), sum.end(), 0.0);
        std::fill(count.begin(), count.end(), 0);
        std::int64_t const end = std::min((value_row + 1) * page.cells, dem.height());
        for (std::int64_t r = value_row * page.cells; r < end; ++r) {
            auto const row = dem.row(r);
            for (std::size_t c = 0; c < row.size(); ++c) {
                if (std::isinf(row[c])) {
                    throw BadInput(fmt::format("pipeline.page_heights: the height at column {}, row {} is infinite; "
                                               "mark cells without data as NaN",
                                               c, r));
                }
                if (!std::isnan(row[c])) {
                    sum[c / side] += static_cast<double>(row[c]);
                    ++count[c / side];
                }
            }
        }
        for (std::size_t v = 0; v < width; ++v) {
            mean[static_cast<std::size_t>(value_row) * width + v] =
                count[v] > 0 ? sum[v] / static_cast<double>(count[v]) : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return mean;
}

std::vector<std::uint16_t> quantised(std::vector<double> const& mean, PageHeights const& page) {
    std::vector<std::uint16_t> values(mean.size(), 0);
    double const range = page.max - page.min;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        if (!std::isnan(mean[i])) {
            double const share = range > 0.0 ? (mean[i] - page.min) / range : 0.0;
            values[i] = static_cast<std::uint16_t>(1.0 + std::floor(share * steps + 0.5));
        }
    }
    return values;
}

/// Predictions for a value with its neighbours in the west, north and north-west, before they are taken modulo 2^16.
std::array<std::uint32_t, predictors> predictions(std::uint32_t west, std::uint32_t north, std::uint32_t corner) {
    return {north, west, west + north - corner, (west + north) / 2};
}

std::uint16_t zigzag(std::uint32_t difference) {
    auto const wrapped = static_cast<std::uint16_t>(difference);
    auto const doubled = static_cast<std::uint16_t>(wrapped << 1U);
    return wrapped < 0x8000U ? doubled : static_cast<std::uint16_t>(~doubled);
}

/// Residuals of one row under each predictor.
using Residuals = std::array<std::vector<std::uint16_t>, predictors>;

/// Fills in the residuals of a row and gives the predictor that leaves the fewest binary digits in them.
std::size_t predict(std::span<std::uint16_t const> row, std::span<std::uint16_t const> above, Residuals& residuals) {
    std::array<std::int64_t, predictors> cost{};
    std::uint32_t west = 0;
    std::uint32_t corner = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
        std::uint32_t const north = above.empty() ? 0 : above[c];
        auto const predicted = predictions(west, north, corner);
        for (std::size_t p = 0; p < predictors; ++p) {
            residuals[p][c] = zigzag(row[c] - predicted[p]);
            cost[p] += std::bit_width(residuals[p][c]);
        }
        west = row[c];
        corner = north;
    }
    return static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
}

std::vector<std::uint8_t> coded(std::vector<std::uint16_t> const& values, PageHeights const& page) {
    auto const width = static_cast<std::size_t>(page.width);
    auto const height = static_cast<std::size_t>(page.height);
    std::vector<std::uint8_t> bytes(height + 2 * values.size());
    std::span<std::uint16_t const> const all(values);
    Residuals residuals;
    residuals.fill(std::vector<std::uint16_t>(width));
    for (std::size_t r = 0; r < height; ++r) {
        auto const above = r > 0 ? all.subspan((r - 1) * width, width) : std::span<std::uint16_t const>{};
        std::size_t const best = predict(all.subspan(r * width, width), above, residuals);
        bytes[r] = static_cast<std::uint8_t>(best);
        for (std::size_t c = 0; c < width; ++c) {
            bytes[height + r * width + c] = static_cast<std::uint8_t>(residuals[best][c] & 0xFFU);
            bytes[height + values.size() + r * width + c] = static_cast<std::uint8_t>(residuals[best][c] >> 8U);
        }
    }
    return bytes;
}

} // namespace

std::int64_t page_cells(Grid const& grid) {
    std::int64_t cells = 1;
    auto const too_many = [&] {
        std::int64_t const width = parts(grid.width, cells);
        std::int64_t const height = parts(grid.height, cells);
        return width > longest_side || height > longest_side || width * height > most_values;
    };
    while (too_many()) {
        ++cells;
    }
    return cells;
}

std::optional<PageHeights> page_heights(Raster<float> const& dem, Run const& run) {
    PageHeights page;
    page.cells = page_cells(dem.grid());
    page.width = parts(dem.width(), page.cells);
    page.height = parts(dem.height(), page.cells);
    std::vector<double> const mean = means(dem, page, run);
    bool first = true;
    for (double const z : mean) {
        if (std::isnan(z)) {
            ++page.nodata;
            continue;
        }
        page.min = first ? z : std::min(page.min, z);
        page.max = first ? z : std::max(page.max, z);
        first = false;
    }
    if (first) {
        return std::nullopt;
    }
    page.bytes = coded(quantised(mean, page), page);
    return page;
}

} // namespace thalweg::pipeline
