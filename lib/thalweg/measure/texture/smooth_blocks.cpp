// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/internal/smooth_blocks.hpp>

#include <cmath>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parallel.hpp>

namespace thalweg::measure {

namespace {

constexpr double deviations = 4.0;

/// Weights at 0, 1, 2 ... blocks from the middle; both sides together weigh 1.
std::vector<double> half_of_window(double window) {
    auto const reach = static_cast<std::size_t>(deviations * window + 0.5);
    std::vector<double> half(reach + 1);
    double sum = 0.0;
    for (std::size_t k = 0; k <= reach; ++k) {
        double const far = static_cast<double>(k) / window;
        half[k] = portable::exp(-0.5 * far * far);
        sum += k == 0 ? half[k] : 2.0 * half[k];
    }
    for (double& weight : half) {
        weight /= sum;
    }
    return half;
}

/// The place that a mirror at both ends of [0, count) shows at `place`.
std::int64_t mirrored(std::int64_t place, std::int64_t count) {
    std::int64_t const turn = ((place % (2 * count)) + 2 * count) % (2 * count);
    return turn < count ? turn : 2 * count - 1 - turn;
}

/// Along columns of a grid, into one with rows and columns exchanged.
Raster<Tensor> smooth_and_turn(Raster<Tensor> const& blocks, std::vector<double> const& half, Run const& run) {
    Grid turned = blocks.grid();
    std::swap(turned.width, turned.height);
    Raster<Tensor> out(turned);
    auto const reach = static_cast<std::int64_t>(half.size()) - 1;
    parallel_ranges(run, blocks.width(), 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t c = begin; c < end; ++c) {
            run.check();
            for (std::int64_t r = 0; r < blocks.height(); ++r) {
                Tensor& sum = out[Cell{r, c}];
                for (std::int64_t k = -reach; k <= reach; ++k) {
                    Tensor part = blocks[Cell{c, mirrored(r + k, blocks.height())}];
                    part *= half[static_cast<std::size_t>(k < 0 ? -k : k)];
                    sum += part;
                }
            }
        }
    });
    return out;
}

} // namespace

Raster<Tensor> smooth_blocks(Raster<Tensor> const& blocks, double window, Run const& run) {
    std::vector<double> const half = half_of_window(window);
    return smooth_and_turn(smooth_and_turn(blocks, half, run), half, run);
}

} // namespace thalweg::measure
