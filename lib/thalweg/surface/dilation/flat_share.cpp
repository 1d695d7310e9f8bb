// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/internal/flat_share.hpp>

#include <thalweg/core/run/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace thalweg::surface {

double flat_share(Valley const& valley, Raster<float> const& dem, Run const& run) {
    std::int64_t const width = dem.width();
    std::int64_t const height = dem.height();
    std::atomic<std::int64_t> dry = 0;
    std::atomic<std::int64_t> flat = 0;
    parallel_ranges(run, height, 64, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            float const* const here = dem.row(row).data();
            float const* const north = dem.row(std::max<std::int64_t>(row - 1, 0)).data();
            float const* const south = dem.row(std::min(row + 1, height - 1)).data();
            float const* const river = valley.z.row(row).data();
            std::int64_t dry_here = 0;
            std::int64_t flat_here = 0;
            for (std::int64_t col = 0; col < width; ++col) {
                float const z = here[col];
                float const west = here[std::max<std::int64_t>(col - 1, 0)];
                float const east = here[std::min(col + 1, width - 1)];
                int const off = static_cast<int>(std::isnan(river[col])) & static_cast<int>(!std::isnan(z));
                int const drained = static_cast<int>(west < z) | static_cast<int>(east < z) |
                                    static_cast<int>(north[col] < z) | static_cast<int>(south[col] < z);
                dry_here += off;
                flat_here += off & (drained ^ 1);
            }
            dry += dry_here;
            flat += flat_here;
        }
    });
    return dry == 0 ? 0.0 : static_cast<double>(flat) / static_cast<double>(dry);
}

} // namespace thalweg::surface
