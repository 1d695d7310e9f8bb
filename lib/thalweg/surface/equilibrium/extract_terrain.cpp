// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <mutex>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/equilibrium/internal/extract_terrain.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

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

    void add(Tangents const& other) {
        std::transform(counts_.begin(), counts_.end(), other.counts_.begin(), counts_.begin(), std::plus<>());
    }

    /// Lists what is counted.
    struct Bin {
        double tangent;
        double count;
    };
    std::vector<Bin> bins() const {
        std::vector<Bin> out;
        for (std::size_t k = 0; k < counts_.size(); ++k) {
            if (counts_[k] != 0) {
                auto const middle =
                    std::bit_cast<float>(static_cast<std::uint32_t>(k << dropped) + (1U << (dropped - 1)));
                out.push_back({k == 0 ? 0.0 : static_cast<double>(middle), static_cast<double>(counts_[k])});
            }
        }
        return out;
    }

private:
    static constexpr std::uint32_t dropped = 15;
    std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(std::size_t{1} << (31 - dropped));
};

/// Slopes of a terrain, of which some are above 0; without bins: it is level.
class Slopes {
public:
    explicit Slopes(Tangents const& tangents) : bins_(tangents.bins()) {
        if (bins_.size() == 1 && bins_[0].tangent == 0.0) {
            bins_.clear();
        }
    }

    bool empty() const { return bins_.empty(); }

    /// [degrees] mean slope when heights are multiplied by this.
    double mean(double rise) const {
        double sum = 0.0;
        double count = 0.0;
        for (Tangents::Bin const& bin : bins_) {
            sum += bin.count * portable::atan2(rise * bin.tangent, 1.0);
            count += bin.count;
        }
        return sum / count * (180.0 / portable::pi);
    }

    /// [degrees] growth of mean() with the rise.
    double growth(double rise) const {
        double sum = 0.0;
        double count = 0.0;
        for (Tangents::Bin const& bin : bins_) {
            double const tangent = rise * bin.tangent;
            sum += bin.count * bin.tangent / (1.0 + tangent * tangent);
            count += bin.count;
        }
        return sum / count * (180.0 / portable::pi);
    }

private:
    std::vector<Tangents::Bin> bins_;
};

/// Rows of heights on a grid; NaN: none.
class HeightRows {
public:
    explicit HeightRows(Raster<float> const& dem)
        : grid_(dem.grid()), first_(dem.cells() > 0 ? &dem[0] : nullptr), stride_(dem.width()) {}
    HeightRows(TerrainLevel const& level, Window const& window)
        : grid_(window.grid), first_(&level.z[(window.margin + 1) * (level.width + 1)]), stride_(level.width),
          land_(window.land.cells() > 0 ? &window.land : nullptr) {}

    Grid const& grid() const { return grid_; }

    void read(std::int64_t row, std::span<float> out) const {
        std::copy_n(first_ + row * stride_, out.size(), out.begin());
        for (std::size_t col = 0; land_ != nullptr && col < out.size(); ++col) {
            out[col] = land_->row(row)[col] != 0 ? out[col] : std::numeric_limits<float>::quiet_NaN();
        }
    }

private:
    Grid const& grid_;
    float const* first_;
    std::int64_t stride_;
    Mask const* land_ = nullptr;
};

Raster<float> raster_of(HeightRows const& land, Run const& run) {
    Raster<float> dem(land.grid());
    parallel_ranges(run, dem.height(), least_rows(dem.width()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            land.read(row, dem.row(row));
        }
    });
    return dem;
}

/// Horn's slopes of the cells that have all their neighbours.
Tangents horn_tangents(HeightRows const& land, Run const& run) {
    Tangents tangents;
    std::mutex adding;
    std::int64_t const width = land.grid().width;
    parallel_ranges(run, land.grid().height - 2, 256, [&](std::int64_t begin, std::int64_t end) {
        Tangents some;
        std::vector<float> row_tangents(static_cast<std::size_t>(width));
        std::array<std::vector<float>, 3> rows;
        rows.fill(row_tangents);
        land.read(begin, rows[1]);
        land.read(begin + 1, rows[2]);
        for (std::int64_t row = begin + 1; row < end + 1; ++row) {
            std::rotate(rows.begin(), rows.begin() + 1, rows.end());
            land.read(row + 1, rows[2]);
            float const* const n = rows[0].data();
            float const* const z = rows[1].data();
            float const* const s = rows[2].data();
            float* const out = row_tangents.data();
            for (std::int64_t c = 1; c + 1 < width; ++c) {
                float const east = (n[c + 1] - n[c - 1]) + 2.0F * (z[c + 1] - z[c - 1]) + (s[c + 1] - s[c - 1]);
                float const south = (s[c - 1] - n[c - 1]) + 2.0F * (s[c] - n[c]) + (s[c + 1] - n[c + 1]);
                // the cell itself has no part in it, but may have no data
                out[c] = std::sqrt(east * east + south * south) * 0.125F + 0.0F * z[c];
            }
            for (std::int64_t c = 1; c + 1 < width; ++c) {
                if (!std::isnan(out[c])) {
                    some.add(out[c]);
                }
            }
        }
        std::lock_guard const lock(adding);
        tangents.add(some);
    });
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

double rise_for_slope(Slopes const& slopes, double mean_slope_deg) {
    constexpr double widest = 0x1p20; // slopes of a million to one
    if (slopes.empty()) {
        return 1.0;
    }
    if (slopes.mean(widest) <= mean_slope_deg) {
        throw BadParameter("surface.equilibrium",
                           fmt::format("surface.mean_slope = {} degrees cannot be reached: so much of the land is "
                                       "level that walls would give it {:.3g}; ask for less",
                                       mean_slope_deg, slopes.mean(widest)));
    }
    // The mean grows ever more slowly, so that Newton's steps from below never go too far.
    double rise = 0.0;
    for (int step = 0; step < 100; ++step) {
        double const next = rise + (mean_slope_deg - slopes.mean(rise)) / slopes.growth(rise);
        if (!(next > rise * (1.0 + 1e-12))) {
            break;
        }
        rise = next;
    }
    return rise;
}

/// [m] difference between the highest and the lowest cell, for heights in cells.
double range_of(HeightRows const& land) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    std::vector<float> heights(static_cast<std::size_t>(land.grid().width));
    for (std::int64_t row = 0; row < land.grid().height; ++row) {
        land.read(row, heights);
        for (float const z : heights) {
            low = z < low ? z : low;
            high = z > high ? z : high;
        }
    }
    return (static_cast<double>(high) - static_cast<double>(low)) * land.grid().cell_m;
}

double rise_for_relief(HeightRows const& land, double relief_m) {
    double const range = range_of(land);
    return range > 0.0 ? relief_m / range : 1.0;
}

Slopes slopes_of(HeightRows const& land, Run const& run) {
    Slopes const slopes(horn_tangents(land, run));
    return slopes.empty() ? Slopes(descents(raster_of(land, run))) : slopes;
}

// Computes the factor that scales heights to the target relief or mean slope. land: heights in cells; NaN: none.
// Returns 1 for level terrain. Throws BadParameter naming the steepest mean slope that can be reached when too much of
// the terrain is level.
Rise height_scale_of(HeightRows const& land, EquilibriumParams const& params, Run const& run) {
    Slopes const slopes = slopes_of(land, run);
    double const factor =
        params.relief_m ? rise_for_relief(land, *params.relief_m) : rise_for_slope(slopes, params.mean_slope_deg);
    if (slopes.empty()) {
        return {factor, 0.0};
    }
    double const slope = slopes.mean(factor) * (portable::pi / 180.0);
    return {factor, portable::sin(slope) / portable::cos(slope)};
}

// Enforces the law in the floats that will be written: raises heights by the least that puts every cell a step above
// its receiver and banks above the rivers beside them; lakes have the height of their receivers. Prescribed heights of
// rivers are raised by one ulp where necessary.
void settle_terrain(TerrainLevel& level, float step, RiverHeights heights, Run const& run) {
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
    each_upstream(level, CellType::rim_bank, run, [&](std::size_t i) {
        float least = above(level.z[moved(i, offsets[level.direction[i]])]);
        if (is_bank(level.type[i])) {
            least = std::max(least, above(highest_river(level, i, offsets)));
        }
        level.z[i] = std::max(level.z[i], least);
    });
}

/// The lowest height at which a river ends on the caller's grid.
float lowest_end(TerrainLevel const& level, Window const& window, Channels const& rivers) {
    float low = std::numeric_limits<float>::infinity();
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            Cell const c = window.grid.at(rivers.cell[n]);
            low = std::min(low, level.z[(c.row + window.margin + 1) * level.width + c.col + window.margin + 1]);
        }
    }
    return low;
}

Raster<flow::Direction> directions(Raster<float> const& dem, Channels const& rivers,
                                   std::vector<std::int64_t> const& shortened, Run const& run) {
    Raster<flow::Direction> out(dem.grid(), flow::Direction::no_data);
    parallel_ranges(run, dem.height(), least_rows(dem.width()), [&](std::int64_t begin, std::int64_t end) {
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

/// Gives river cells their prescribed heights: at most, or exactly.
void set_asked(TerrainLevel& level, Channels const& rivers, bool at_most) {
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        std::int64_t const number = level.rivers.number[n];
        float const asked = number < 0 ? std::nanf("") : rivers.z[number];
        if (!std::isnan(asked)) {
            float& z = level.z[level.rivers.cell[n]];
            z = at_most ? std::min(z, asked) : asked;
        }
    }
}

double part_of_target(HeightRows const& land, double factor, EquilibriumParams const& params, Run const& run) {
    if (params.relief_m) {
        return range_of(land) * factor / *params.relief_m;
    }
    Slopes const slopes = slopes_of(land, run);
    return slopes.empty() ? 0.0 : slopes.mean(factor) / params.mean_slope_deg;
}

} // namespace

double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params, Run const& run) {
    return part_of_target(HeightRows(land), factor, params, run);
}

HeightConversion height_conversion_for(TerrainLevel const& level, Channels const& rivers, Window const& window,
                                       EquilibriumParams const& params, Run const& run) {
    Rise const rise = height_scale_of(HeightRows(level, window), params, run);
    double const metres = rise.factor * window.grid.cell_m;
    return {metres, -static_cast<double>(lowest_end(level, window, rivers)) * metres, rise.mean_tangent};
}

double share_of_target(TerrainLevel const& level, Window const& window, double metres, EquilibriumParams const& params,
                       Run const& run) {
    return part_of_target(HeightRows(level, window), metres / window.grid.cell_m, params, run);
}

double lowest_end_of(TerrainLevel const& level, Channels const& rivers, Window const& window) {
    return static_cast<double>(lowest_end(level, window, rivers));
}

double mean_tangent(TerrainLevel const& level, Window const& window, double metres, Run const& run) {
    Slopes const slopes = slopes_of(HeightRows(level, window), run);
    double const slope = slopes.empty() ? 0.0 : slopes.mean(metres / window.grid.cell_m) * (portable::pi / 180.0);
    return portable::sin(slope) / portable::cos(slope);
}

double coarse_share_of_target(TerrainLevel const& level, Window const& window, double metres,
                              EquilibriumParams const& params, Run const& run) {
    HeightConversion const conversion{metres, 0.0, 0.0};
    Raster<float> const dem = coarse_terrain(level, window, &conversion, params, run);
    EquilibriumParams target = params;
    target.mean_slope_deg *= portable::pow(level.side, -slope_by_cell);
    return share_of_target(dem, 1.0 / dem.grid().cell_m, target, run);
}

Raster<float> coarse_terrain(TerrainLevel const& level, Window const& window, HeightConversion const* conversion,
                             EquilibriumParams const& params, Run const& run) {
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
        double const metres = height_scale_of(HeightRows(in_cells), target, run).factor * window.grid.cell_m;
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
    lower_banks(level, steepest_bank * perched_height(raise, window.grid), settled_step(raise));
    raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    run.check();
    settle_terrain(level, settled_step(raise), RiverHeights::graded, run);
    run.check();
    out.dem = raster_of(HeightRows(level, window), run);
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
    set_asked(level, rivers, heights == RiverHeights::soft);
    keep_below_asked(level, rivers);
    hold_levels(level, rivers);
    if (heights != RiverHeights::fixed) { // as for graded rivers
        lower_perched(level, 0.99F * perched_height(raise, window.grid), 4.0F * settled_step(raise));
        hold_levels(level, rivers);
        raise_below_perched(level, 0.99F * perched_height(raise, window.grid));
    }
    run.check();
    settle_terrain(level, settled_step(raise), heights, run);
    run.check();
    out.dem = raster_of(HeightRows(level, window), run);
    out.walled = walled_cells(level, perched_height(raise, window.grid));
    level = {};
    out.direction = directions(out.dem, rivers, {}, run);
    report_lowered(out.dem, rivers, out);
    return out;
}

EquilibriumTerrain extract_rebuilt(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, Run const& run) {
    EquilibriumTerrain out;
    out.rise = raise.metres / window.grid.cell_m;
    to_metres(level, raise);
    set_asked(level, rivers, false);
    hold_levels(level, rivers);
    raise_land_beside(level, 0.99F * perched_height(raise, window.grid));
    run.check();
    settle_terrain(level, settled_step(raise), RiverHeights::fixed, run);
    run.check();
    out.dem = raster_of(HeightRows(level, window), run);
    out.walled = walled_cells(level, perched_height(raise, window.grid), Walls::land);
    level = {};
    out.direction = directions(out.dem, rivers, {}, run);
    report_lowered(out.dem, rivers, out);
    return out;
}

} // namespace thalweg::surface
