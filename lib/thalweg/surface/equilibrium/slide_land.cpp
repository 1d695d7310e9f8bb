// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/slide_land.hpp>

#include <algorithm>
#include <vector>

namespace thalweg::surface {

namespace {

constexpr float tolerance = 1.5F; // times the cap

float greatest_height(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float const steepest = tolerance * level.cap[i] * level.side;
    float most = level.z[i];
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        most = std::min(most, level.z[moved(i, offsets[k])] + steepest * step_lengths[k]);
    }
    return most;
}

} // namespace

void slide_land(LandLevel& level) {
    auto const offsets = level.offsets();
    std::vector<std::size_t> open;
    auto const slide = [&](std::size_t i) {
        if (is_land(level.cover[i]) && !is_bank(level.cover[i])) {
            if (float const most = greatest_height(level, i, offsets); most < level.z[i]) {
                level.z[i] = most;
                open.push_back(i);
            }
        }
    };
    each_inner(level, slide);
    for (std::size_t k = 0; k < open.size(); ++k) {
        for (std::int64_t const offset : offsets) {
            slide(moved(open[k], offset));
        }
    }
}

} // namespace thalweg::surface
