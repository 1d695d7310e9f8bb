// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/equilibrium/internal/steps.hpp>

namespace thalweg::surface {
namespace {

struct Rise {
    double factor;
    double mean_tangent; // mean slope of the terrain after scaling
};

/// Histogram of tangents by their leading nine binary digits.
class Tangents {
public:
    void add(float tangent) { ++counts_[std::bit_cast<std::uint32_t>(tangent) >> dropped]; }

    bool empty() const {
        return std::all_of(counts_.begin() + 1, counts_.end(), [](std::uint64_t n) { return n == 0; });
    }

    /// [degrees] mean slope when heights are multiplied by this.
    double mean_slope(double rise) const {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t k = 0; k < counts_.size(); ++k) {
            if (counts_[k] != 0) {
                auto const middle =
                    std::bit_cast<float>(static_cast<std::uint32_t>(k << dropped) + (1U << (dropped - 1)));
                double const tangent = k == 0 ? 0.0 : rise * static_cast<double>(middle);
                sum += static_cast<double>(counts_[k]) * portable::atan2(tangent, 1.0);
                count += static_cast<double>(counts_[k]);
            }
        }
        return sum / count * (180.0 / portable::pi);
    }

private:
    static constexpr std::uint32_t dropped = 15;
    std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(std::size_t{1} << (31 - dropped));
};

/// Horn's slopes of the cells that have all their neighbours.
Tangents horn_tangents(Raster<float> const& land) {
    Tangents tangents;
    for (std::int64_t row = 1; row + 1 < land.height(); ++row) {
        float const* const n = land.row(row - 1).data();
        float const* const z = land.row(row).data();
        float const* const s = land.row(row + 1).data();
        for (std::int64_t c = 1; c + 1 < land.width(); ++c) {
            float const east = (n[c + 1] - n[c - 1]) + 2.0F * (z[c + 1] - z[c - 1]) + (s[c + 1] - s[c - 1]);
            float const south = (s[c - 1] - n[c - 1]) + 2.0F * (s[c] - n[c]) + (s[c + 1] - n[c + 1]);
            float const tangent = std::sqrt(east * east + south * south) * 0.125F;
            if (!std::isnan(tangent) && !std::isnan(z[c])) {
                tangents.add(tangent);
            }
        }
    }
    return tangents;
}

/// The steepest descents, if no cell has all its neighbours.
Tangents descents(Raster<float> const& land) {
    Tangents tangents;
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        double const steepest = flow::steepest_descent(land, land.grid().at(i)).slope;
        if (steepest > 0.0) { // cells without a lower neighbour do not count
            tangents.add(static_cast<float>(steepest));
        }
    }
    return tangents;
}

double rise_for_slope(Tangents const& tangents, double mean_slope_deg) {
    constexpr double widest = 0x1p20; // slopes of a million to one
    if (tangents.empty()) {
        return 1.0;
    }
    if (tangents.mean_slope(widest) <= mean_slope_deg) {
        throw BadParameter(
            fmt::format("surface.equilibrium: surface.mean_slope = {} degrees cannot be reached: so much "
                        "of the land is level that walls would give it {:.3g}; ask for less",
                        mean_slope_deg, tangents.mean_slope(widest)));
    }
    double low = 0.0;
    double high = 1.0;
    while (tangents.mean_slope(high) < mean_slope_deg) {
        low = high;
        high *= 2.0;
    }
    for (int halving = 0; halving < 40; ++halving) {
        double const middle = 0.5 * (low + high);
        (tangents.mean_slope(middle) < mean_slope_deg ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// [m] difference between the highest and the lowest cell, for heights in cells.
double range_of(Raster<float> const& land) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (float const z : land.values()) {
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    return (static_cast<double>(high) - static_cast<double>(low)) * land.grid().cell_m;
}

double rise_for_relief(Raster<float> const& land, double relief_m) {
    double const range = range_of(land);
    return range > 0.0 ? relief_m / range : 1.0;
}

Tangents tangents_of(Raster<float> const& land) {
    Tangents tangents = horn_tangents(land);
    return tangents.empty() ? descents(land) : tangents;
}

// Computes the factor that scales heights to the target relief or mean slope. land: heights in cells; NaN: none.
// Returns 1 for level terrain. Throws BadParameter naming the steepest mean slope that can be reached when too much of
// the terrain is level.
Rise height_scale_of(Raster<float> const& land, EquilibriumParams const& params) {
    Tangents const tangents = tangents_of(land);
    double const factor =
        params.relief_m ? rise_for_relief(land, *params.relief_m) : rise_for_slope(tangents, params.mean_slope_deg);
    if (tangents.empty()) {
        return {factor, 0.0};
    }
    double const slope = tangents.mean_slope(factor) * (portable::pi / 180.0);
    return {factor, portable::sin(slope) / portable::cos(slope)};
}

} // namespace

double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params) {
    if (params.relief_m) {
        return range_of(land) * factor / *params.relief_m;
    }
    Tangents const tangents = tangents_of(land);
    return tangents.empty() ? 0.0 : tangents.mean_slope(factor) / params.mean_slope_deg;
}

namespace {

// Enforces the law in the floats that will be written: raises heights by the least that puts every cell a step above
// its receiver and banks above the rivers beside them; lakes have the height of their receivers. Prescribed heights of
// rivers are raised by one ulp where necessary.
void settle_terrain(TerrainLevel& level, float step, RiverHeights heights) {
    auto const above = [step](float z) {
        return std::max(z + step, std::nextafter(z, std::numeric_limits<float>::infinity()));
    };
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(rivers.receiver[n]);
        float const below = level.z[rivers.cell[r]];
        float& z = level.z[rivers.cell[n]];
        if (rivers.level[n] != 0) {
            z = below;
        } else if (heights == RiverHeights::graded && !rivers.is_held(n)) {
            z = std::max(z, above(below));
        } else if (rivers.number[r] >= 0) { // cells beyond the caller's grid must not raise prescribed heights
            z = std::max(z, std::nextafter(below, std::numeric_limits<float>::infinity()));
        }
    }
    auto const offsets = level.offsets();
    each_inner(level, [&](std::size_t i) {
        if (level.type[i] == CellType::boundary) {
            level.z[i] = std::max(level.z[i], above(highest_river(level, i, offsets)));
        }
    });
    for (std::size_t at = level.order.size(); at-- > 0;) {
        std::size_t const i = level.order[at];
        float least = above(level.z[moved(i, offsets[level.direction[i]])]);
        if (is_bank(level.type[i])) {
            least = std::max(least, above(highest_river(level, i, offsets)));
        }
        level.z[i] = std::max(level.z[i], least);
    }
}

/// Copies the caller's grid out of the level; NaN at sea.
Raster<float> cropped(TerrainLevel const& level, Window const& window) {
    Raster<float> dem(window.grid);
    Mask const& land = window.land;
    std::int64_t const margin = window.margin;
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            auto const i = static_cast<std::size_t>((row + margin + 1) * level.width + col + margin + 1);
            bool const dry = land.cells() == 0 || land[Cell{col, row}] != 0;
            dem[Cell{col, row}] = dry ? level.z[i] : std::numeric_limits<float>::quiet_NaN();
        }
    }
    return dem;
}

/// The lowest height at which a river ends on the caller's grid.
float lowest_end(Raster<float> const& dem, Channels const& rivers) {
    float low = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            low = std::min(low, dem[rivers.cell[n]]);
        }
    }
    return low;
}

Raster<flow::Direction> directions(Raster<float> const& dem, Channels const& rivers,
                                   std::vector<std::int64_t> const& shortened, Run const& run) {
    Raster<flow::Direction> out(dem.grid(), flow::Direction::no_data);
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < dem.width(); ++col) {
                if (Cell const c{col, row}; !std::isnan(dem[c])) {
                    out[c] = flow::steepest_descent(dem, c).direction;
                }
            }
        }
    });
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (std::binary_search(shortened.begin(), shortened.end(), static_cast<std::int64_t>(n))) {
            continue;
        }
        if (r < 0) {
            out[rivers.cell[n]] = flow::Direction::leaves;
            continue;
        }
        Cell const from = dem.grid().at(rivers.cell[n]);
        Cell const to = dem.grid().at(rivers.cell[r]);
        for (std::size_t k = 0; k < d8_steps.size(); ++k) {
            if (d8_steps[k] == Cell{to.col - from.col, to.row - from.row}) {
                out[rivers.cell[n]] = flow::direction_of(k);
            }
        }
    }
    return out;
}

constexpr double slope_by_cell = 0.17; ///< mean slope ~ cell size ^ -this, of terrain in equilibrium (measured)

float perched_height(HeightConversion const& raise, Grid const& grid) {
    return static_cast<float>(raise.mean_tangent * grid.cell_m);
}

void to_metres(TerrainLevel& level, HeightConversion const& raise) {
    for (float& z : level.z) {
        z = static_cast<float>(raise.base_m + static_cast<double>(z) * raise.metres);
    }
}

/// Less than the solver's own step, so that only float rounding is corrected.
float settled_step(HeightConversion const& raise) {
    return static_cast<float>(0.25 * static_cast<double>(least_tangent) * raise.metres);
}

/// Lowers free cells to at most the prescribed height upstream: the solver's floats of cells beyond the caller's grid,
/// each a step higher, may have raised them.
void keep_below_asked(TerrainLevel& level, Channels const& rivers) {
    RiverCells const& cells = level.rivers;
    for (std::size_t n = cells.cell.size(); n-- > 0;) {
        if (cells.receiver[n] < 0 || cells.level[n] != 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(cells.receiver[n]);
        std::int64_t const number = cells.number[r];
        if (number >= 0 && std::isnan(rivers.z[number])) {
            level.z[cells.cell[r]] = std::min(level.z[cells.cell[r]], level.z[cells.cell[n]]);
        }
    }
}

/// Sets the outlets of lakes to their levels, and lowers what is below them as far as their water needs to fall.
void hold_levels(TerrainLevel& level, Channels const& rivers) {
    RiverCells const& cells = level.rivers;
    std::vector<float> most(cells.hold.size(), std::numeric_limits<float>::infinity());
    for (std::size_t n = most.size(); n-- > 0;) {
        float& z = level.z[cells.cell[n]];
        bool const is_outlet = cells.hold[n] == Hold::outlet;
        most[n] = is_outlet ? rivers.lake_z[cells.number[n]] : most[n];
        z = is_outlet ? most[n] : std::min(z, most[n]);
        std::int32_t const r = cells.receiver[n];
        if (r >= 0 && cells.number[r] >= 0) {
            most[r] = std::min(most[r], cells.level[n] != 0 ? most[n] : least_below(most[n]));
        }
    }
}

/// Shifts heights so that the lowest river end is at 0, if all ends have risen.
void lower_to_ends(TerrainLevel& level, Channels const& rivers) {
    RiverCells const& cells = level.rivers;
    float low = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < cells.cell.size(); ++n) {
        if (cells.number[n] >= 0 && rivers.receiver[cells.number[n]] < 0) {
            low = std::min(low, level.z[cells.cell[n]]);
        }
    }
    if (low > 0.0F && std::isfinite(low)) {
        for (float& z : level.z) {
            z -= low;
        }
    }
}

void report_lowered(Raster<float> const& dem, Channels const& rivers, EquilibriumTerrain& out) {
    std::vector<double> lowered;
    for (std::size_t n = 0; n < rivers.z.size(); ++n) {
        if (!std::isnan(rivers.z[n])) {
            double const depth = static_cast<double>(rivers.z[n]) - static_cast<double>(dem[rivers.cell[n]]);
            lowered.push_back(std::max(0.0, depth));
        }
    }
    std::sort(lowered.begin(), lowered.end());
    out.max_lowered_m = lowered.back();
    out.p95_lowered_m = lowered[(lowered.size() - 1) * 95 / 100];
}

} // namespace

HeightConversion height_conversion_for(TerrainLevel const& level, Channels const& rivers, Window const& window,
                                       EquilibriumParams const& params) {
    Raster<float> const dem = cropped(level, window);
    Rise const rise = height_scale_of(dem, params);
    double const metres = rise.factor * window.grid.cell_m;
    return {metres, -static_cast<double>(lowest_end(dem, rivers)) * metres, rise.mean_tangent};
}

double share_of_target(TerrainLevel const& level, Window const& window, double metres,
                       EquilibriumParams const& params) {
    return share_of_target(cropped(level, window), metres / window.grid.cell_m, params);
}

Raster<float> coarse_terrain(TerrainLevel const& level, Window const& window, HeightConversion const* conversion,
                             EquilibriumParams const& params) {
    auto const side = static_cast<std::int64_t>(level.side);
    Grid grid = window.grid;
    grid.width = (grid.width + side - 1) / side;
    grid.height = (grid.height + side - 1) / side;
    grid.cell_m *= static_cast<double>(side);
    auto const nearest = [side](std::int64_t cell, std::int64_t corner, std::int64_t size) {
        return std::min((cell * side + side / 2 - corner) / side + 1, size - 2);
    };
    Raster<float> dem(grid);
    float low = std::numeric_limits<float>::infinity();
    for (std::int64_t row = 0; row < grid.height; ++row) {
        for (std::int64_t col = 0; col < grid.width; ++col) {
            Cell const fine{std::min(col * side + side / 2, window.grid.width - 1),
                            std::min(row * side + side / 2, window.grid.height - 1)};
            bool const dry = window.land.cells() == 0 || window.land[fine] != 0;
            auto const i = static_cast<std::size_t>(nearest(row, level.corner.row, level.height) * level.width +
                                                    nearest(col, level.corner.col, level.width));
            bool const known = dry && std::isfinite(level.z[i]);
            float const z = known ? level.z[i] : std::numeric_limits<float>::quiet_NaN();
            dem[Cell{col, row}] = z;
            low = z < low ? z : low;
        }
    }
    HeightConversion raise{1.0, 0.0, 0.0};
    if (conversion != nullptr) {
        raise = *conversion;
    } else {
        // Slopes of larger cells are gentler.
        double const gentler = portable::pow(level.side, -slope_by_cell);
        EquilibriumParams target = params;
        target.mean_slope_deg *= gentler;
        Raster<float> in_cells = dem;
        for (float& z : in_cells.values()) {
            z /= level.side;
        }
        double const metres = height_scale_of(in_cells, target).factor * window.grid.cell_m;
        raise = {metres, -static_cast<double>(low) * metres, 0.0};
    }
    for (float& z : dem.values()) {
        z = static_cast<float>(raise.base_m + static_cast<double>(z) * raise.metres);
    }
    return dem;
}

EquilibriumTerrain extract_terrain(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, std::vector<std::int64_t> shortened, Heads heads,
                                   Run const& run) {
    EquilibriumTerrain out;
    out.rise = raise.metres / window.grid.cell_m;
    to_metres(level, raise);
    hold_levels(level, rivers);
    // Slightly lower than what counts as perched, as a margin for the settling that follows.
    lower_perched(level, 0.99F * perched_height(raise, window.grid), 4.0F * settled_step(raise));
    if (heads == Heads::kept) {
        enforce_receivers(level, settled_step(raise));
        if (level.rivers.hold.empty()) {
            lower_to_ends(level, rivers);
        }
    }
    hold_levels(level, rivers);
    raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    run.check();
    settle_terrain(level, settled_step(raise), RiverHeights::graded);
    run.check();
    out.dem = cropped(level, window);
    float const perched_m = perched_height(raise, window.grid);
    if (heads == Heads::kept) {
        out.walled = walled_cells(level, perched_m);
    }
    auto const perched =
        heads == Heads::kept ? std::vector<std::int64_t>{} : remove_perched_tips(level, perched_m, TipBanks::stay);
    if (heads == Heads::cut && !level.rivers.hold.empty()) {
        out.walled = walled_cells(level, perched_m, Walls::by_lakes);
    }
    shortened.insert(shortened.end(), perched.begin(), perched.end());
    std::sort(shortened.begin(), shortened.end());
    out.shortened = std::move(shortened);
    level = {};
    out.direction = directions(out.dem, rivers, out.shortened, run);
    return out;
}

EquilibriumTerrain extract_terrain_with_heights(TerrainLevel level, Channels const& rivers, Window const& window,
                                                HeightConversion const& raise, RiverHeights heights, Run const& run) {
    EquilibriumTerrain out;
    out.rise = raise.metres / window.grid.cell_m;
    to_metres(level, raise);
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        std::int64_t const number = level.rivers.number[n];
        float const asked = number < 0 ? std::nanf("") : rivers.z[number];
        if (!std::isnan(asked)) {
            float& z = level.z[level.rivers.cell[n]];
            z = heights == RiverHeights::soft ? std::min(z, asked) : asked;
        }
    }
    keep_below_asked(level, rivers);
    hold_levels(level, rivers);
    if (heights != RiverHeights::fixed) { // as for graded rivers
        lower_perched(level, 0.99F * perched_height(raise, window.grid), 4.0F * settled_step(raise));
        hold_levels(level, rivers);
        raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    }
    run.check();
    settle_terrain(level, settled_step(raise), heights);
    run.check();
    out.dem = cropped(level, window);
    out.walled = walled_cells(level, perched_height(raise, window.grid));
    level = {};
    out.direction = directions(out.dem, rivers, {}, run);
    report_lowered(out.dem, rivers, out);
    return out;
}

} // namespace thalweg::surface
