// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/reference_dems.hpp>

#include <algorithm>

namespace thalweg::measure {

namespace {

#include <thalweg/measure/relief/internal/reference_dems.inc>

} // namespace

std::span<ReferenceDem const> reference_dems() {
    return lands;
}

std::array<double, form_count> mean_forms() {
    std::array<double, form_count> mean{};
    for (ReferenceDem const& land : lands) {
        for (std::size_t f = 0; f < form_count; ++f) {
            mean[f] += land.forms[f] / static_cast<double>(lands.size());
        }
    }
    return mean;
}

ReliefRange relief_range(std::size_t figure) {
    auto const [least, greatest] =
        std::minmax_element(lands.begin(), lands.end(), [&](ReferenceDem const& a, ReferenceDem const& b) {
            return a.figures[figure] < b.figures[figure];
        });
    ReliefMetric const& metric = relief_metrics()[figure];
    return {metric.judges == Judges::large_values ? 0.0 : least->figures[figure] / metric.tolerance,
            greatest->figures[figure] * metric.tolerance};
}

} // namespace thalweg::measure
