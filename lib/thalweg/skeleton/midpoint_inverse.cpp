// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/midpoint_inverse.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>

namespace thalweg::skeleton {

namespace {

constexpr std::int64_t cells_a_range = 65536;

void require(Skeleton const& skeleton, MidpointInverseParams const& params) {
    require_in("skeleton.midpoint_inverse", "longest_cells", params.longest_cells, Range::at_least(0.0).or_infinite());
    for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
        if (std::isinf(skeleton.z[i])) {
            Cell const c = skeleton.z.grid().at(i);
            throw BadInput(
                "skeleton.midpoint_inverse",
                fmt::format("infinite height at column {}, row {}; every cell of a skeleton needs a finite one", c.col,
                            c.row));
        }
    }
}

/// Fills an empty cell from its known children; steps: their offsets, in units of h.
void fill(Raster<float>& z, Cell parent, std::array<Cell, 4> const& steps, std::int64_t h) {
    if (!std::isnan(z[parent])) {
        return;
    }
    double sum = 0.0;
    int known = 0;
    for (Cell const step : steps) {
        Cell const child{parent.col + step.col * h, parent.row + step.row * h};
        if (z.grid().contains(child) && !std::isnan(z[child])) {
            sum += z[child];
            ++known;
        }
    }
    if (known > 0) {
        z[parent] = static_cast<float>(sum / known);
    }
}

/// Parents are corners and centres, where columns and rows make an even number of steps; children lie between them.
void fill_from_edges(Raster<float>& z, std::int64_t h, Run const& run) {
    std::int64_t const rows = (z.height() - 1) / h + 1;
    parallel_ranges(run, rows, cells_a_range * h / z.width() + 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            for (std::int64_t col = r % 2 * h; col < z.width(); col += 2 * h) {
                fill(z, {col, r * h}, {{{0, -1}, {-1, 0}, {1, 0}, {0, 1}}}, h);
            }
        }
    });
}

/// Parents are corners only, children centres.
void fill_from_centres(Raster<float>& z, std::int64_t h, Run const& run) {
    std::int64_t const rows = (z.height() - 1) / (2 * h) + 1;
    parallel_ranges(run, rows, cells_a_range * h / z.width() + 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            for (std::int64_t col = 0; col < z.width(); col += 2 * h) {
                fill(z, {col, r * 2 * h}, {{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}}, h);
            }
        }
    });
}

/// Copies the common north-western part of two rasters.
void copy_shared(Raster<float> const& from, Raster<float>& to) {
    std::int64_t const width = std::min(from.width(), to.width());
    for (std::int64_t r = 0; r < std::min(from.height(), to.height()); ++r) {
        std::copy_n(from.row(r).begin(), width, to.row(r).begin());
    }
}

} // namespace

Skeleton midpoint_inverse(Skeleton const& skeleton, MidpointInverseParams const& params, Run const& run) {
    require(skeleton, params);
    Grid const& grid = skeleton.z.grid();
    std::int64_t whole = 1; // side of the square minus one
    while (whole < std::max(grid.width, grid.height) - 1) {
        whole *= 2;
    }
    std::int64_t longest = 0; // half-step
    for (std::int64_t h = 1; h <= whole / 2 && static_cast<double>(h) <= params.longest_cells; h *= 2) {
        longest = h;
    }
    Skeleton out = skeleton;
    if (longest == 0) {
        return out;
    }
    // A height spreads by less than 4 longest along an axis, and by half of it outside the grid and back.
    Grid frame = grid;
    frame.width = std::min(whole + 1, grid.width + 2 * longest);
    frame.height = std::min(whole + 1, grid.height + 2 * longest);
    Raster<float> z(frame, std::numeric_limits<float>::quiet_NaN());
    copy_shared(skeleton.z, z);
    for (std::int64_t h = 1; h <= longest; h *= 2) {
        fill_from_edges(z, h, run);
        if (static_cast<double>(h) * std::sqrt(2.0) <= params.longest_cells) {
            fill_from_centres(z, h, run);
        }
    }
    copy_shared(z, out.z);
    return out;
}

} // namespace thalweg::skeleton
