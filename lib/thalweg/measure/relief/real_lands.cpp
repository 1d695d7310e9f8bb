// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/real_lands.hpp>

#include <algorithm>

namespace thalweg::measure {

namespace {

#include <thalweg/measure/relief/internal/real_lands.inc>

} // namespace

std::span<RealLand const> real_lands() {
    return lands;
}

std::array<double, form_count> mean_forms() {
    std::array<double, form_count> mean{};
    for (RealLand const& land : lands) {
        for (std::size_t f = 0; f < form_count; ++f) {
            mean[f] += land.forms[f] / static_cast<double>(lands.size());
        }
    }
    return mean;
}

ReliefRange relief_range(std::size_t figure) {
    auto const [least, greatest] =
        std::minmax_element(lands.begin(), lands.end(), [&](RealLand const& a, RealLand const& b) {
            return a.figures[figure] < b.figures[figure];
        });
    return {least->figures[figure] / land_tolerance, greatest->figures[figure] * land_tolerance};
}

} // namespace thalweg::measure
