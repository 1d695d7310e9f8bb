// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/level_patch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {

namespace {

enum class Ground : std::uint8_t { none, steep, gentle };

Ground ground_of(Raster<float> const& dem, std::int64_t i, std::array<std::int64_t, 8> const& to, double tangent) {
    bool const lake = std::all_of(to.begin(), to.end(), [&](std::int64_t step) { return dem[i + step] == dem[i]; });
    double const squared = horn_squared(dem, i, to);
    if (lake || std::isnan(squared) || std::isnan(dem[i])) {
        return Ground::none;
    }
    return squared < tangent * tangent ? Ground::gentle : Ground::steep;
}

Raster<Ground> grounds(Raster<float> const& dem, double below_deg, Run const& run) {
    Raster<Ground> found(dem.grid(), Ground::none);
    auto const offsets = d8_offsets(dem.grid());
    double const angle = below_deg * (portable::pi / 180.0);
    double const tangent = portable::sin(angle) / portable::cos(angle);
    parallel_ranges(run, std::max<std::int64_t>(dem.height() - 2, 0), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin + 1; r < end + 1; ++r) {
            run.check();
            for (std::int64_t c = 1; c + 1 < dem.width(); ++c) {
                found[Cell{c, r}] = ground_of(dem, dem.grid().index({c, r}), offsets, tangent);
            }
        }
    });
    return found;
}

/// Counts the patch of a cell and leaves it steep. The outermost cells are none: no neighbour is off the grid.
std::int64_t take_patch(Raster<Ground>& ground, std::int64_t start, std::array<std::int64_t, 8> const& offsets,
                        std::vector<std::int64_t>& open) {
    std::int64_t cells = 0;
    open.assign(1, start);
    ground[start] = Ground::steep;
    while (!open.empty()) {
        std::int64_t const cell = open.back();
        open.pop_back();
        ++cells;
        for (std::int64_t const step : offsets) {
            if (ground[cell + step] == Ground::gentle) {
                ground[cell + step] = Ground::steep;
                open.push_back(cell + step);
            }
        }
    }
    return cells;
}

} // namespace

LevelPatch level_patch(Raster<float> const& dem, LevelPatchParams const& params, Run const& run) {
    require_in("measure.level_patch", "below_deg", params.below_deg, Range::inside(0.0, 90.0));
    if (dem.cells() > 0 && !(dem.grid().cell_m > 0.0)) {
        throw BadInput(fmt::format(
            "measure.level_patch: the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m));
    }
    Raster<Ground> ground = grounds(dem, params.below_deg, run);
    auto const offsets = d8_offsets(dem.grid());
    LevelPatch found;
    std::vector<std::int64_t> open;
    for (std::int64_t i = 0; i < ground.cells(); ++i) {
        found.land += ground[i] == Ground::none ? 0 : 1;
    }
    for (std::int64_t i = 0; i < ground.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (ground[i] == Ground::gentle) {
            found.cells = std::max(found.cells, take_patch(ground, i, offsets, open));
        }
    }
    return found;
}

} // namespace thalweg::measure
