// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/internal/gradient_row.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::measure {

void GradientRow::compute(Raster<float> const& dem, std::int64_t row) {
    std::int64_t const bottom = dem.height() - 1;
    std::int64_t const right = dem.width() - 1;
    float const* const north = dem.row(std::max<std::int64_t>(row - 1, 0)).data();
    float const* const here = dem.row(row).data();
    float const* const south = dem.row(std::min(row + 1, bottom)).data();
    float const one_sided = row == 0 || row == bottom ? 2.0F : 1.0F;
    float* const to_x = x.data();
    float* const to_y = y.data();
    std::uint8_t* const to_known = known.data();
    std::uint8_t* const to_slopes = slopes.data();
    auto const set = [=](std::int64_t c, float dx) {
        float const dy = one_sided * (south[c] - north[c]);
        float const length = std::sqrt(dx * dx + dy * dy);
        bool const slope = length > 0.0F; // false for NaN
        float const divisor = slope ? length : 1.0F;
        to_x[c] = slope ? dx / divisor : 0.0F;
        to_y[c] = slope ? dy / divisor : 0.0F;
        to_slopes[c] = slope ? 1 : 0;
        to_known[c] = slope || length == here[c] - here[c] ? 1 : 0; // level, and with data
    };
    set(0, 2.0F * (here[1] - here[0]));
    for (std::int64_t c = 1; c < right; ++c) {
        set(c, here[c + 1] - here[c - 1]);
    }
    set(right, 2.0F * (here[right] - here[right - 1]));
}

} // namespace thalweg::measure
