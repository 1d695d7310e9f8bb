// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::pipeline {

Raster<float> in_unit(Raster<float> const& dem, HeightUnit unit) {
    if (unit == HeightUnit::metre) {
        return dem;
    }
    std::vector<float> heights;
    heights.reserve(static_cast<std::size_t>(dem.cells()));
    std::ranges::copy_if(dem.values(), std::back_inserter(heights), [](float z) { return !std::isnan(z); });
    std::ranges::sort(heights);
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());

    std::vector<float> converted;
    converted.reserve(heights.size());
    for (float const z : heights) {
        auto const near = static_cast<float>(static_cast<double>(z) / metres_in(unit));
        float const above =
            converted.empty() ? near : std::nextafterf(converted.back(), std::numeric_limits<float>::infinity());
        converted.push_back(std::max(near, above));
    }
    Raster<float> out(dem.grid(), std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(dem[i])) {
            auto const at = std::ranges::lower_bound(heights, dem[i]) - heights.begin();
            out[i] = converted[static_cast<std::size_t>(at)];
        }
    }
    return out;
}

Tin in_unit(Tin tin, HeightUnit unit) {
    for (Vec3& p : tin.vertices) {
        p.z /= metres_in(unit);
    }
    return tin;
}

} // namespace thalweg::pipeline
