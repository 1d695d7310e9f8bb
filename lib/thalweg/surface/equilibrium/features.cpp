// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/surface/equilibrium/features.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>

// Described in docs/rebuild.md.

namespace thalweg::surface {
namespace {

/// The land cell of a level that a cell of the caller's grid lies in.
std::optional<std::uint32_t> land_cell_at(TerrainLevel const& level, Cell fine) {
    auto const side = static_cast<std::int64_t>(level.side);
    std::int64_t const col = (fine.col - level.corner.col) / side + 1;
    std::int64_t const row = (fine.row - level.corner.row) / side + 1;
    bool const inner =
        fine.col >= level.corner.col && fine.row >= level.corner.row && col + 1 < level.width && row + 1 < level.height;
    auto const i = static_cast<std::size_t>(row * level.width + col);
    return inner && (level.type[i] == CellType::land || level.type[i] == CellType::rim)
               ? std::optional(static_cast<std::uint32_t>(i))
               : std::nullopt;
}

/// The highest land beside a crest cell that does not drain through it.
std::optional<std::size_t> highest_beside(TerrainLevel const& level, std::uint32_t crest,
                                          std::array<std::int64_t, 8> const& offsets) {
    std::optional<std::size_t> highest;
    for (std::int64_t const offset : offsets) {
        std::size_t const n = moved(crest, offset);
        if (is_land(level.type[n]) && level.is_crest[n] == 0 && moved(n, offsets[level.direction[n]]) != crest &&
            (!highest || level.z[n] > level.z[*highest])) {
            highest = n;
        }
    }
    return highest;
}

/// The sum of marks that rise and marks that sink, spread beside their paths.
Cells<float> spread_both(TerrainLevel const& level, Cells<float> rises, Cells<float> sinks, WallParams const& params,
                         Run const& run) {
    rises = spread_along(level, std::move(rises), params, run);
    sinks = spread_along(level, std::move(sinks), params, run);
    rises.resize(std::max(rises.size(), sinks.size()), 0.0F);
    for (std::size_t i = 0; i < sinks.size(); ++i) {
        rises[i] -= sinks[i];
    }
    return rises;
}

} // namespace

void check_features(Grid const& grid, std::vector<FeatureCell> const& features, char const* self) {
    std::int64_t last = -1;
    for (FeatureCell const& feature : features) {
        refuse_if<BadInput>(feature.cell <= last || feature.cell >= grid.cells(), self,
                            "feature cell {} follows {} on a grid of {} cells; list its cells in order, each once",
                            feature.cell, last, grid.cells());
        last = feature.cell;
        refuse_if<BadInput>(std::isinf(feature.z), self, "the height of feature cell {} is infinite", feature.cell);
    }
}

OverRivers over_rivers(Raster<float> const& dem, std::vector<std::int64_t> const& rivers, Run const& run) {
    OverRivers out;
    Grid const& grid = dem.grid();
    out.level.width = grid.width + 2;
    out.level.height = grid.height + 2;
    out.level.type.assign(static_cast<std::size_t>(out.level.cells()), CellType::land);
    out.level.z.assign(out.level.type.size(), std::numeric_limits<float>::quiet_NaN());
    auto const at = [&](std::int64_t cell) {
        Cell const c = grid.at(cell);
        return static_cast<std::uint32_t>((c.row + 1) * out.level.width + c.col + 1);
    };
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        out.level.z[at(i)] = dem[i];
    }
    std::vector<std::uint32_t> cells;
    for (std::int64_t const cell : rivers) {
        cells.push_back(at(cell));
        out.river_z.push_back(dem[cell]);
        out.level.type[cells.back()] = CellType::river;
    }
    out.near = straight_to(out.level, cells, run);
    return out;
}

Raster<float> through_heights(Raster<float> dem, std::vector<std::int64_t> const& rivers,
                              std::vector<FeatureCell> const& features, Run const& run) {
    constexpr char const* self = "surface.through_heights";
    Grid const& grid = dem.grid();
    check_features(grid, features, self);
    refuse_if<BadInput>(rivers.empty(), self, "there are no rivers; give at least one cell");
    for (std::int64_t const cell : rivers) {
        refuse_if<BadInput>(cell < 0 || cell >= grid.cells(), self, "river cell {} is not on the grid of {} cells",
                            cell, grid.cells());
    }
    OverRivers const land = over_rivers(dem, rivers, run);
    std::vector<FeatureCell> on_land;
    std::copy_if(features.begin(), features.end(), std::back_inserter(on_land),
                 [&](FeatureCell const& feature) { return !std::isnan(dem[feature.cell]); });
    KnownHeights const known = known_heights(land.level, on_land, grid);
    Cells<float> const z = through_known(land.level, land.level.z, known, land.near, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = grid.at(i);
        auto const at = static_cast<std::size_t>((c.row + 1) * land.level.width + c.col + 1);
        dem[i] = land.level.type[at] == CellType::land ? z[at] : dem[i];
    }
    for (std::size_t n = 0; n < known.cell.size(); ++n) {
        Cell const c = land.level.at(known.cell[n]);
        dem[{c.col - 1, c.row - 1}] = known.z[n];
    }
    return dem;
}

void set_crests(TerrainLevel& level, std::vector<FeatureCell> const& features, Grid const& grid) {
    for (FeatureCell const& feature : features) {
        auto const cell = feature.crest ? land_cell_at(level, grid.at(feature.cell)) : std::nullopt;
        if (cell) {
            level.is_crest.resize(level.type.size());
            if (std::exchange(level.is_crest[*cell], 1) == 0) {
                level.crests.push_back(*cell);
            }
        }
    }
    if (level.crests.empty()) {
        return;
    }
    constexpr double most = 0.1; // of the land: on coarser levels hardly any is left between crests
    double const land = static_cast<double>(std::count_if(level.type.begin(), level.type.end(), is_land));
    if (static_cast<double>(level.crests.size()) > most * land) {
        open_crests(level);
    }
    std::sort(level.crests.begin(), level.crests.end());
}

KnownHeights known_heights(TerrainLevel const& level, std::vector<FeatureCell> const& features, Grid const& grid) {
    std::map<std::uint32_t, std::pair<double, double>> sums; // of heights, and their number
    for (FeatureCell const& feature : features) {
        auto const cell = std::isnan(feature.z) ? std::nullopt : land_cell_at(level, grid.at(feature.cell));
        if (cell) {
            sums[*cell].first += static_cast<double>(feature.z);
            sums[*cell].second += 1.0;
        }
    }
    KnownHeights known;
    for (auto const& [cell, sum] : sums) {
        known.cell.push_back(cell);
        known.z.push_back(static_cast<float>(sum.first / sum.second));
    }
    return known;
}

Cells<float> spread(TerrainLevel const& level, std::vector<std::uint32_t> const& cells,
                    std::vector<float> const& values, std::vector<float> const& reach, Run const& run) {
    constexpr float least_weight = 1e-7F;
    Cells<float> out(level.type.size(), 0.0F);
    Rows const inner{level.width - 2, level.height - 2, level.width};
    auto const first = static_cast<std::size_t>(level.width + 1);
    float const longest = reach.empty() ? 0.0F : *std::max_element(reach.begin(), reach.end());
    for (auto radius = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(std::max(longest, 1.0F))));
         radius >= 1; radius /= 2) {
        auto const width = static_cast<float>(radius);
        std::vector<std::uint32_t> these;
        Cells<float> sum(level.type.size(), 0.0F);
        Cells<float> weight(level.type.size(), 0.0F);
        float most = 0.0F;
        for (std::size_t n = 0; n < cells.size(); ++n) {
            if (radius == 1 || reach[n] >= width) {
                these.push_back(cells[n]);
                sum[cells[n]] = values[n] - out[cells[n]];
                weight[cells[n]] = 1.0F;
                most = std::max(most, std::fabs(sum[cells[n]]));
            }
        }
        if (these.empty()) {
            continue;
        }
        if (radius > 1) {
            blur(&sum[first], inner, {radius / 2, 2}, run);
            blur(&weight[first], inner, {radius / 2, 2}, run);
        }
        NearestRiver const near = straight_to(level, these, run);
        for (std::size_t i = 0; i < out.size(); ++i) {
            if (float const t = near.distance[i] / width; t < 1.0F && weight[i] > least_weight) {
                float const fading = (1.0F - t * t) * (1.0F - t * t);
                out[i] += fading * std::clamp(sum[i] / weight[i], -most, most);
            }
        }
    }
    return out;
}

Cells<float> through_known(TerrainLevel const& level, Cells<float> z, KnownHeights const& known,
                           NearestRiver const& near, Run const& run) {
    if (known.cell.empty()) {
        return z;
    }
    std::vector<float> lift;
    std::vector<float> reach;
    for (std::size_t n = 0; n < known.cell.size(); ++n) {
        lift.push_back(known.z[n] - z[known.cell[n]]);
        reach.push_back(near.distance[known.cell[n]]);
    }
    Cells<float> const lifts = spread(level, known.cell, lift, reach, run);
    each_inner(level, [&](std::size_t i) {
        if (is_land(level.type[i])) {
            z[i] += lifts[i];
        }
    });
    return z;
}

PullToHeights::PullToHeights(TerrainLevel& level, LandLaw const& law, KnownHeights known, Pull& pull, Run const& run) {
    constexpr float around = 3.0F;
    constexpr float close = 30.0F;
    constexpr float here = 3000.0F;
    constexpr float close_cells = 2.0F;
    auto const first = std::find(level.rivers.number.begin(), level.rivers.number.end(), 0);
    end_ = level.rivers.cell[first - level.rivers.number.begin()];
    from_ = level.z[end_];
    for (float& z : known.z) {
        z += from_;
    }
    NearestRiver const near = straight_to(level, level.rivers.cell, run);
    Cells<float> const wanted = through_known(level, level.z, known, near, run);
    NearestRiver const to_known = straight_to(level, known.cell, run);
    float const stiff = 0.1F * law.power(level.side * level.side) / level.side;
    level.uplift.resize(level.z.size(), 1.0F);
    pull.stiffness.assign(level.z.size(), 0.0F);
    each_inner(level, [&](std::size_t i) {
        if (is_land(level.type[i]) && wanted[i] != level.z[i]) {
            float const far = to_known.distance[i];
            pull.stiffness[i] = stiff * (far == 0.0F ? here : far <= close_cells ? close : around);
            level.uplift[i] += pull.stiffness[i] * wanted[i];
        }
    });
}

void PullToHeights::follow_rivers(TerrainLevel& level, Pull const& pull) {
    float const rise = level.z[end_] - std::exchange(from_, level.z[end_]);
    for (std::size_t i = 0; i < pull.stiffness.size(); ++i) {
        level.uplift[i] += pull.stiffness[i] * rise;
    }
}

void raise_crests(TerrainLevel const& level, Cells<float>& floor) {
    auto const offsets = level.offsets();
    for (std::uint32_t const i : level.crests) {
        auto const way = static_cast<std::size_t>(level.direction[i]);
        float const length = level.side * step_lengths[way];
        float const most = level.z[moved(i, offsets[way])] + level.rock.cap(i) * length;
        auto const beside = highest_beside(level, i, offsets);
        floor[i] = beside ? std::min(most, level.z[*beside] + level.least * level.side)
                          : -std::numeric_limits<float>::infinity();
    }
}

Cells<float> land_off_crests(TerrainLevel const& level, WallParams const& params, Run const& run) {
    constexpr float even = 0.3F; // of the cap: how much higher land may lie on one side
    auto const offsets = level.offsets();
    Cells<float> rises;
    Cells<float> sinks;
    for (std::uint32_t const crest : level.crests) {
        std::size_t const below = moved(crest, offsets[level.direction[crest]]);
        auto const beside = highest_beside(level, crest, offsets);
        if (beside && is_land(level.type[below]) &&
            level.z[below] + even * level.rock.cap(crest) * level.side < level.z[*beside]) {
            float const middle = 0.5F * (level.z[below] + level.z[*beside]);
            mark_to_move(level, below, middle, params, rises);
            mark_to_move(level, *beside, middle, params, sinks);
        }
    }
    return spread_both(level, std::move(rises), std::move(sinks), params, run);
}

Cells<float> land_off_known(TerrainLevel const& level, KnownHeights const& known, WallParams const& params,
                            Run const& run) {
    float const tolerance = params.tolerance * level.side;
    Cells<float> rises;
    Cells<float> sinks;
    for (std::size_t n = 0; n < known.cell.size(); ++n) {
        float const off = level.z[known.cell[n]] - known.z[n];
        if (std::fabs(off) > tolerance) {
            mark_to_move(level, known.cell[n], known.z[n], params, off < 0.0F ? rises : sinks);
        }
    }
    return spread_both(level, std::move(rises), std::move(sinks), params, run);
}

void keep_off_crests(TerrainLevel& level, std::vector<std::int8_t> const& before) {
    auto const offsets = level.offsets();
    std::size_t at = 0;
    each_beside_crest(level, offsets, [&](std::size_t i) {
        std::int8_t const former = before[at++];
        if (level.is_crest[moved(i, offsets[level.direction[i]])] == 0) {
            return;
        }
        float best = 0.0F;
        bool const still_falls = former >= 0 && level.z[moved(i, offsets[former])] <= level.z[i];
        std::int8_t way = still_falls ? former : level.direction[i];
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            std::size_t const n = moved(i, offsets[k]);
            float const slope = (level.z[i] - level.z[n]) * static_cast<float>(d8_per_length[k]);
            if (level.is_crest[n] == 0 && slope > best) {
                best = slope;
                way = static_cast<std::int8_t>(k);
            }
        }
        level.direction[i] = way;
    });
}

std::vector<std::int8_t> directions_beside_crests(TerrainLevel const& level) {
    std::vector<std::int8_t> out;
    each_beside_crest(level, level.offsets(), [&](std::size_t i) { out.push_back(level.direction[i]); });
    return out;
}

} // namespace thalweg::surface
