// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/separable_ar.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/skeleton/internal/normal_row.hpp>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t ar_stage = 32;

} // namespace

Raster<float> separable_ar(Grid const& grid, FieldParams const& params, Run const& run) {
    check(params, "skeleton.separable_ar");
    Raster<double> field(grid);
    double const a = portable::exp(-1.0 / params.lx_cells);
    double const along = std::sqrt(1.0 - a * a);
    parallel_ranges(run, grid.height, 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const row = field.row(r);
            normal_row(params.seed, ar_stage, static_cast<std::uint64_t>(r), row);
            for (std::size_t c = 1; c < row.size(); ++c) {
                row[c] = a * row[c - 1] + along * row[c];
            }
        }
    });
    Raster<float> dem(grid);
    double const b = portable::exp(-1.0 / params.ly_cells);
    double const across = std::sqrt(1.0 - b * b);
    parallel_ranges(run, grid.width, 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = 0; r < grid.height; ++r) {
            for (std::int64_t c = begin; c < end; ++c) {
                double& here = field[Cell{c, r}];
                here = r == 0 ? here : b * field[Cell{c, r - 1}] + across * here;
                dem[Cell{c, r}] = static_cast<float>(params.mean + params.std * here);
            }
        }
    });
    return dem;
}

} // namespace thalweg::skeleton
