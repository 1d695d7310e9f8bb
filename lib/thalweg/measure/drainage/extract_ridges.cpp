// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage/extract_ridges.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/measure/drainage/internal/agreement.hpp>

namespace thalweg::measure {

namespace {

/// The cells under ridges where the DEM has heights, ascending, none twice.
std::vector<std::int64_t> cells_under(RidgeLines const& ridges, Raster<float> const& dem) {
    std::vector<std::int64_t> cells;
    for (RidgeLine const& ridge : ridges.lines) {
        std::vector<Vec2> plan;
        for (Vec3 const& p : ridge.line) {
            plan.push_back({p.x, p.y});
        }
        for (Cell const c : cells_along(plan, dem.grid(), "a ridge")) {
            if (!std::isnan(dem[c])) {
                cells.push_back(dem.grid().index(c));
            }
        }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

} // namespace

ExtractedRidges extract_ridges(Raster<float> const& dem, RidgeLines const& ridges, Run const& run) {
    ExtractedRidges found;
    std::vector<std::int64_t> const asked = cells_under(ridges, dem);
    found.ridge_cells = static_cast<std::int64_t>(asked.size());
    if (asked.empty()) {
        return found;
    }
    Raster<float> upside_down = dem;
    for (float& z : upside_down.values()) {
        z = -z;
    }
    auto const [threshold, agreements] = best_threshold(flow::route(upside_down, run).area_cells, asked, run);
    found.threshold_cells = threshold;
    found.extracted = agreements;
    return found;
}

} // namespace thalweg::measure
