// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/swath.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::measure {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// The place on a line that is nearest to a cell's centre.
struct Nearest {
    double away_m = std::numeric_limits<double>::infinity();
    double along_m = 0.0;
};

/// A span of cells around an interval of coordinates, clipped to [0, count).
std::pair<std::int64_t, std::int64_t> cells_between(double low, double high, std::int64_t count) {
    auto const clipped = [&](double cell) {
        return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(count)));
    };
    return {clipped(std::floor(low)), clipped(std::floor(high) + 1.0)};
}

} // namespace

Swath swath(Raster<float> const& dem, std::vector<Vec2> const& line, SwathParams const& params, Run const& run) {
    require_in("measure.swath", "width_m", params.width_m, Range::above(0.0), "m");
    require_in("measure.swath", "step_m", params.step_m, Range::at_least(0.0), "m");
    refuse_if<BadInput>(line.size() < 2 || !std::ranges::all_of(line, [](Vec2 p) { return is_finite(p); }),
                        "measure.swath", "a line of {} vertices; it has two or more, all finite", line.size());
    Grid const& grid = dem.grid();
    double const step_m = params.step_m > 0.0 ? params.step_m : grid.cell_m;
    double const half_m = 0.5 * params.width_m;
    double length_m = 0.0;
    Raster<Nearest> nearest(grid);
    for (std::size_t v = 0; v + 1 < line.size(); ++v) {
        run.check();
        Vec2 const a = line[v];
        Vec2 const b = line[v + 1];
        double const segment_m = distance(a, b);
        auto const [west, east] = cells_between((std::min(a.x, b.x) - half_m - grid.west) / grid.cell_m,
                                                (std::max(a.x, b.x) + half_m - grid.west) / grid.cell_m, grid.width);
        auto const [north, south] =
            cells_between((grid.north - std::max(a.y, b.y) - half_m) / grid.cell_m,
                          (grid.north - std::min(a.y, b.y) + half_m) / grid.cell_m, grid.height);
        bool const is_first = v == 0;
        bool const is_last = v + 2 == line.size();
        for (std::int64_t row = north; row < south; ++row) {
            for (std::int64_t col = west; col < east; ++col) {
                Vec2 const centre = grid.centre({col, row});
                bool const is_before = is_first && dot(centre - a, b - a) < 0.0;
                bool const is_beyond = is_last && dot(centre - b, b - a) > 0.0;
                geometry::Foot const foot = geometry::foot_on(a, b, centre);
                double const away_m = distance(foot.at, centre);
                Nearest& best = nearest[Cell{col, row}];
                if (!is_before && !is_beyond && away_m <= half_m && away_m < best.away_m) {
                    best = {away_m, length_m + foot.along * segment_m};
                }
            }
        }
        length_m += segment_m;
    }
    refuse_if<BadInput>(!(length_m > 0.0), "measure.swath", "the line has no length");
    double const wanted = std::ceil(length_m / step_m);
    refuse_if<BadParameter>(!(wanted <= 1e8), "measure.swath", "{} steps of {} m; make them longer", wanted, step_m);
    auto const steps = static_cast<std::size_t>(std::max(wanted, 1.0));
    Swath found{std::vector<double>(steps), std::vector<double>(steps, not_known),
                std::vector<double>(steps, not_known), std::vector<double>(steps, not_known),
                std::vector<std::int64_t>(steps)};
    std::vector<CompensatedSum> sums(steps);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isinf(nearest[i].away_m) || std::isnan(dem[i])) {
            continue;
        }
        auto const at = std::min(static_cast<std::size_t>(nearest[i].along_m / step_m), steps - 1);
        double const z = dem[i];
        sums[at].add(z);
        found.min[at] = found.cells[at] == 0 ? z : std::min(found.min[at], z);
        found.max[at] = found.cells[at] == 0 ? z : std::max(found.max[at], z);
        ++found.cells[at];
    }
    for (std::size_t at = 0; at < steps; ++at) {
        double const begin = static_cast<double>(at) * step_m;
        found.distance_m[at] = 0.5 * (begin + std::min(begin + step_m, length_m));
        if (found.cells[at] > 0) {
            found.mean[at] = sums[at].value() / static_cast<double>(found.cells[at]);
        }
    }
    return found;
}

} // namespace thalweg::measure
