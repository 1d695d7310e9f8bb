// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/peaks/orometry.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/measure/peaks/isolation.hpp>
#include <thalweg/measure/peaks/prominence.hpp>

namespace thalweg::measure {

namespace {

constexpr double square_metres_a_km2 = 1e6;

/// The middle one, or the mean of the middle two; NaN of nothing.
double median(std::vector<double> values) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    std::size_t const half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<double> isolations(Raster<float> const& dem, std::vector<Peak> const& peaks, Run const& run) {
    std::vector<double> found(peaks.size());
    parallel_ranges(run, static_cast<std::int64_t>(peaks.size()), 1, [&](std::int64_t begin, std::int64_t end) {
        for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
            run.check();
            found[p] = isolation(dem, peaks[p].cell);
        }
    });
    std::erase_if(found, [](double far) { return std::isnan(far); });
    return found;
}

} // namespace

Orometry orometry(Raster<float> const& dem, OrometryParams const& params, Run const& run) {
    std::vector<Peak> const peaks = prominent_peaks(dem, params.least_prominence_m, run);
    auto const cells = std::count_if(dem.values().begin(), dem.values().end(), [](float z) { return !std::isnan(z); });
    double const cell_km2 = dem.grid().cell_m * dem.grid().cell_m / square_metres_a_km2;
    Orometry found;
    found.peaks = static_cast<std::int64_t>(peaks.size());
    if (cells > 0) {
        found.peaks_per_km2 = static_cast<double>(found.peaks) / (static_cast<double>(cells) * cell_km2);
    }
    std::vector<double> prominences;
    prominences.reserve(peaks.size());
    for (Peak const& peak : peaks) {
        prominences.push_back(peak.prominence_m);
    }
    found.median_prominence_m = median(std::move(prominences));
    found.median_isolation_m = median(isolations(dem, peaks, run));
    return found;
}

} // namespace thalweg::measure
