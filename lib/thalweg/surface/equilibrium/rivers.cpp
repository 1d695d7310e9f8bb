// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <thalweg/surface/equilibrium/internal/river_cells.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

constexpr float creep_brings = 1.15F; // factor of uplift below rivers by creep from their sides, as for other valleys
// Relative to the cap: two diagonal steps must rise by less than one side step on terrain of mean slope.
constexpr float share_of_cap = 0.3F;
constexpr float above_land = 0.02F;  // [cells of the level] allowed height of a river above the terrain two cells away
constexpr float above_river = 0.25F; // [cells of the level] allowed height above another river there
constexpr float kept_share = 0.3F;   // share of its fall that a reach keeps when it is lowered for reaches upstream
constexpr std::uint32_t great = 16;  // ratio of areas above which a river is not lowered for a brook

/// By how much a river falls from cell n to about the second ring of cells: at a waterfall the gorge below it is lower
/// than the river above. 0 where rivers are never so steep.
float own_fall(TerrainLevel const& level, std::size_t n) {
    if (!level.has_falls) {
        return 0.0F;
    }
    constexpr int steps = 3;
    RiverCells const& rivers = level.rivers;
    std::size_t end = n;
    for (int k = 0; k < steps && rivers.receiver[end] >= 0; ++k) {
        end = static_cast<std::size_t>(rivers.receiver[end]);
    }
    return level.z[rivers.cell[n]] - level.z[rivers.cell[end]];
}

/// The largest height of a river cell at which it is not perched, from the second ring of cells around it.
float height_by_ring(TerrainLevel const& level, std::size_t n) {
    float most = std::numeric_limits<float>::infinity();
    each_of_second_ring(level, level.rivers.cell[n], [&](std::size_t i) {
        bool const land = level.type[i] == CellType::land || level.type[i] == CellType::rim;
        most = std::min(most, level.z[i] + (land ? above_land : above_river) * level.side);
    });
    return most + own_fall(level, n);
}

// The largest heights of river cells, by number, at which neither they nor, within one reach, the cells upstream are
// perched above the terrain beside them.
std::vector<float> greatest_heights(TerrainLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> most(rivers.cell.size());
    for (std::size_t n = 0; n < most.size(); ++n) {
        most[n] = height_by_ring(level, n);
    }
    std::vector<std::uint32_t> area(most.size()); // of the cell for which it is lowered
    std::transform(rivers.cell.begin(), rivers.cell.end(), area.begin(),
                   [&](std::uint32_t i) { return level.area[i]; });
    for (std::size_t n = most.size(); n-- > 0;) {
        if (rivers.receiver[n] < 0) {
            continue;
        }
        auto const r = static_cast<std::size_t>(rivers.receiver[n]);
        float const fall = graded_tangent(level, law, n) * level.side * step_lengths[rivers.direction[n]];
        float const below = most[n] - kept_share * fall;
        if (below < most[r] && level.area[rivers.cell[r]] / great <= area[n]) {
            most[r] = below;
            area[r] = area[n];
        }
    }
    return most;
}

/// Long profiles of rivers through prescribed heights: of graded rivers, steeper or gentler where that takes them
/// there.
class Profiles {
public:
    /// \param fall by river cell: of a graded river, to its receiver
    /// \param asked by river cell: the prescribed height, or NaN
    Profiles(RiverCells const& rivers, std::vector<float> const& fall, std::vector<float> asked)
        : rivers_(rivers), asked_(std::move(asked)) {
        std::size_t const count = rivers_.cell.size();
        graded_.resize(count);
        anchor_.resize(count);
        for (std::size_t n = 0; n < count; ++n) {
            if (is_end(n)) {
                anchor_[n] = n;
                continue;
            }
            std::size_t const r = receiver(n);
            graded_[n] = graded_[r] + (rivers_.level[n] != 0 ? 0.0F : fall[n]);
            anchor_[n] = is_asked(r) ? r : anchor_[r];
        }
        aim();
    }

    std::vector<float> heights() const {
        std::vector<float> z(graded_.size());
        for (std::size_t n = 0; n < z.size(); ++n) {
            z[n] = is_asked(n) ? asked_[n] : is_end(n) ? end_height(n) : height_above(n, z[receiver(n)]);
        }
        return z;
    }

private:
    static constexpr std::int32_t nothing = -1;

    bool is_end(std::size_t n) const { return rivers_.receiver[n] < 0; }
    std::size_t receiver(std::size_t n) const { return static_cast<std::size_t>(rivers_.receiver[n]); }

    /// A lake has its outlet's height; a prescribed one is ignored.
    bool is_asked(std::size_t n) const { return !std::isnan(asked_[n]) && (is_end(n) || rivers_.level[n] == 0); }

    /// The least rise per distance from the anchor downstream to the prescribed height upstream.
    float steepness(std::size_t asked) const {
        std::size_t const below = anchor_[asked];
        if (!is_asked(below)) {
            return asked_[asked] - graded_[asked];
        }
        constexpr float least = 1e-6F;
        return (asked_[asked] - asked_[below]) / std::max(graded_[asked] - graded_[below], least);
    }

    /// Finds for each cell the prescribed height upstream that requires the gentlest rise.
    void aim() {
        aim_.assign(graded_.size(), nothing);
        for (std::size_t n = graded_.size(); n-- > 0;) {
            if (is_asked(n)) {
                aim_[n] = static_cast<std::int32_t>(n);
            }
            if (is_end(n) || aim_[n] == nothing || is_asked(receiver(n))) {
                continue;
            }
            std::int32_t& aim = aim_[receiver(n)];
            if (aim == nothing ||
                steepness(static_cast<std::size_t>(aim_[n])) < steepness(static_cast<std::size_t>(aim))) {
                aim = aim_[n];
            }
        }
    }

    float end_height(std::size_t n) const {
        if (aim_[n] == nothing) {
            return 0.0F;
        }
        auto const above = static_cast<std::size_t>(aim_[n]);
        return asked_[above] - graded_[above];
    }

    float height_above(std::size_t n, float below) const {
        float const fall = graded_[n] - graded_[receiver(n)];
        if (aim_[n] == nothing || !(fall > 0.0F)) {
            return below + fall;
        }
        auto const above = static_cast<std::size_t>(aim_[n]);
        return below + (asked_[above] - below) * (fall / (graded_[above] - graded_[receiver(n)]));
    }

    RiverCells const& rivers_;
    std::vector<float> asked_;
    std::vector<float> graded_;       ///< heights of graded rivers above their ends
    std::vector<std::size_t> anchor_; ///< number of the next cell downstream with a prescribed height, or of the end
    std::vector<std::int32_t> aim_;   ///< number of the cell upstream, itself included, towards which the cell rises
};

/// Falls of graded rivers to their receivers.
std::vector<float> graded_falls(TerrainLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> fall(rivers.cell.size(), 0.0F);
    for (std::size_t n = 0; n < fall.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            fall[n] = graded_tangent(level, law, n) * level.side * step_lengths[rivers.direction[n]];
        }
    }
    return fall;
}

float just_above(float z) {
    return std::nextafter(z, std::numeric_limits<float>::infinity());
}

/// Heights of graded rivers through the levels of lakes; ends keep their heights. Empty: no lake has a level.
std::vector<float> heights_by_lakes(TerrainLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    if (rivers.hold.empty()) {
        return {};
    }
    std::vector<float> asked = rivers.asked;
    for (std::size_t n = 0; n < asked.size(); ++n) {
        asked[n] = rivers.receiver[n] < 0 ? level.z[rivers.cell[n]] : asked[n];
    }
    return heights_through(rivers, graded_falls(level, law), std::move(asked));
}

/// The height above which river cell n is perched.
float highest_lawful(TerrainLevel const& level, std::size_t n, float tangent) {
    float low = std::numeric_limits<float>::infinity();
    each_of_second_ring(level, level.rivers.cell[n], [&](std::size_t i) { low = std::min(low, level.z[i]); });
    return low + tangent * level.side + own_fall(level, n);
}

/// Lowers a river cell to a height, and cells downstream of it as far as necessary; does nothing if that would take too
/// long, or reach a lake, the outlet of one with a level or an end.
void lower_reach(TerrainLevel& level, std::size_t from, float z, float step) {
    constexpr int longest = 256; // [cells] on a nearly level floor
    RiverCells const& rivers = level.rivers;
    std::size_t n = from;
    float wanted = z;
    for (int k = 0; level.z[rivers.cell[n]] > wanted; ++k, wanted -= step) {
        if (k == longest || leaves_grid(rivers, n) || rivers.level[n] != 0 || rivers.hold_of(n) == Hold::outlet) {
            return;
        }
        n = static_cast<std::size_t>(rivers.receiver[n]);
    }
    for (std::size_t dug = from; dug != n; dug = static_cast<std::size_t>(rivers.receiver[dug]), z -= step) {
        level.z[rivers.cell[dug]] = z;
    }
}

// Whether river cell n is above the lowest cell of its second ring by more than a tangent times a cell.
bool is_perched(TerrainLevel const& level, std::size_t n, float tangent) {
    return level.z[level.rivers.cell[n]] > highest_lawful(level, n, tangent);
}

/// Whether lower_perched() would lower many cells in a row from river cell n on by half of what may be perched.
bool cuts_trench(TerrainLevel const& level, std::size_t n, float tangent) {
    constexpr float deep = 0.5F;  // relative to the tangent times a cell
    constexpr int most_deep = 24; // [cells] shorter ones become the heads of hollows
    RiverCells const& rivers = level.rivers;
    float most = highest_lawful(level, n, tangent) + deep * tangent * level.side;
    for (int k = 0; level.z[rivers.cell[n]] > most; ++k, most -= least_tangent) {
        if (k == most_deep || leaves_grid(rivers, n)) {
            return true;
        }
        n = static_cast<std::size_t>(rivers.receiver[n]);
    }
    return false;
}

constexpr std::int32_t longest_tip = 200;     // [cells] more is not a tip
constexpr std::int32_t longest_touching = 32; // [cells] the same beside another river

/// By river cell: number of river cells upstream, itself included.
std::vector<std::int32_t> upstream_of(RiverCells const& rivers) {
    std::vector<std::int32_t> upstream(rivers.cell.size(), 1);
    for (std::size_t n = upstream.size(); n-- > 0;) {
        if (rivers.receiver[n] >= 0) {
            upstream[rivers.receiver[n]] += upstream[n];
        }
    }
    return upstream;
}

/// Marks river cells that satisfy a predicate and have few cells upstream, with everything upstream.
template <class Is>
std::vector<std::uint8_t> marked_tips(RiverCells const& rivers, std::vector<std::int32_t> const& upstream,
                                      std::int32_t longest, Is is) {
    std::vector<std::uint8_t> marked(upstream.size());
    for (std::size_t n = 0; n < marked.size(); ++n) {
        if (leaves_grid(rivers, n)) {
            continue;
        }
        bool const below = marked[rivers.receiver[n]] != 0;
        bool const tip = rivers.level[n] == 0 && upstream[n] <= longest && !rivers.is_held(n);
        marked[n] = below || (tip && is(n)) ? 1 : 0;
    }
    return marked;
}

/// Whether two river cells join within so few steps that their heights are nearly equal.
bool meet_soon(RiverCells const& rivers, std::int32_t a, std::int32_t b) {
    constexpr int most = 400;
    for (int step = 0; a != b; ++step) { // receivers have lower numbers
        std::int32_t& upper = a > b ? a : b;
        upper = rivers.receiver[upper];
        if (upper < 0 || step == most) {
            return false;
        }
    }
    return true;
}

/// Marks the cells near heads that lie beside another river with more cells upstream, with everything upstream.
std::vector<std::uint8_t> touching_heads(TerrainLevel const& level) {
    RiverCells const& rivers = level.rivers;
    constexpr std::int32_t nothing = -1;
    std::vector<std::int32_t> number_at(static_cast<std::size_t>(level.cells()), nothing);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        number_at[rivers.cell[n]] = static_cast<std::int32_t>(n);
    }
    auto const offsets = level.offsets();
    std::vector<std::int32_t> const upstream = upstream_of(rivers);
    return marked_tips(rivers, upstream, longest_touching, [&](std::size_t n) {
        return std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
            std::int32_t const other = number_at[moved(rivers.cell[n], offset)];
            auto const i = static_cast<std::int32_t>(n);
            return other != nothing && std::pair(upstream[n], -i) < std::pair(upstream[other], -other) &&
                   !meet_soon(rivers, i, other);
        });
    });
}

bool is_rim(TerrainLevel const& level, std::size_t i) {
    auto const offsets = level.offsets();
    return std::any_of(offsets.begin(), offsets.end(),
                       [&](std::int64_t offset) { return level.type[moved(i, offset)] == CellType::outside; });
}

void reset_cell_types(TerrainLevel& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    bool const beside = highest_river(level, i, offsets) > -std::numeric_limits<float>::infinity();
    level.type[i] =
        is_rim(level, i) ? (beside ? CellType::rim_bank : CellType::rim) : (beside ? CellType::bank : CellType::land);
}

/// Removes the marked cells; receivers of the others are never marked.
void compact(RiverCells& rivers, std::vector<std::uint8_t> const& gone) {
    std::vector<std::int32_t> place(gone.size(), -1);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < gone.size(); ++n) {
        if (gone[n] != 0) {
            continue;
        }
        rivers.cell[kept] = rivers.cell[n];
        rivers.receiver[kept] = rivers.receiver[n] < 0 ? -1 : place[rivers.receiver[n]];
        rivers.direction[kept] = rivers.direction[n];
        rivers.level[kept] = rivers.level[n];
        rivers.number[kept] = rivers.number[n];
        if (!rivers.hold.empty()) {
            rivers.hold[kept] = rivers.hold[n];
        }
        if (!rivers.asked.empty()) {
            rivers.asked[kept] = rivers.asked[n];
        }
        if (!rivers.grade.empty()) {
            rivers.grade[kept] = rivers.grade[n];
        }
        place[n] = static_cast<std::int32_t>(kept++);
    }
    rivers.cell.resize(kept);
    rivers.receiver.resize(kept);
    rivers.direction.resize(kept);
    rivers.level.resize(kept);
    rivers.number.resize(kept);
    rivers.hold.resize(rivers.hold.empty() ? 0 : kept);
    rivers.asked.resize(rivers.asked.empty() ? 0 : kept);
    rivers.grade.resize(rivers.grade.empty() ? 0 : kept);
}

std::vector<std::int64_t> remove_tips(TerrainLevel& level, std::vector<std::uint8_t> const& marked, TipBanks banks) {
    RiverCells& rivers = level.rivers;
    std::vector<std::uint8_t> gone(marked.size());
    std::vector<std::uint8_t> holds(marked.size()); // an unmarked cell lies upstream
    std::vector<std::int64_t> numbers;
    auto const offsets = level.offsets();
    for (std::size_t n = marked.size(); n-- > 0;) {
        std::size_t const i = rivers.cell[n];
        if (marked[n] != 0 && holds[n] == 0) {
            gone[n] = banks == TipBanks::rise || highest_river(level, i, offsets) < level.z[i]
                          ? 1
                          : 0; // everything it drained has been removed
        }
        if (gone[n] == 0) {
            if (rivers.receiver[n] >= 0) {
                holds[rivers.receiver[n]] = 1;
            }
            continue;
        }
        numbers.push_back(rivers.number[n]);
        reset_cell_types(level, i, offsets);
        for (std::int64_t const offset : offsets) {
            if (std::size_t const near = moved(i, offset); is_land(level.type[near])) {
                reset_cell_types(level, near, offsets);
            }
        }
    }
    compact(rivers, gone);
    return numbers;
}

constexpr int passes = 4;
constexpr float margin = 0.02F; // relative to a fall, above float rounding

class Keeper {
public:
    Keeper(TerrainLevel& level, float least)
        : level_(level), rivers_(level.rivers), offsets_(level.offsets()), least_(least) {
        for (std::size_t n = 0; n < rivers_.cell.size(); ++n) {
            if (rivers_.number[n] < 0) {
                beyond_.push_back(rivers_.cell[n]);
            }
        }
        std::sort(beyond_.begin(), beyond_.end());
    }

    void pass() {
        for (std::size_t n = 0; n < rivers_.cell.size(); ++n) {
            if (rivers_.number[n] < 0) {
                continue;
            }
            keep_above(n);
            bool const leaves = rivers_.receiver[n] < 0 || number(receiver(n)) < 0;
            for (std::size_t k = 0; k < offsets_.size(); ++k) {
                std::size_t const q = moved(rivers_.cell[n], offsets_[k]);
                if (level_.type[q] != CellType::river || std::binary_search(beyond_.begin(), beyond_.end(), q)) {
                    continue;
                }
                if (leaves) {
                    level_.z[q] = std::max(level_.z[q], level_.z[rivers_.cell[n]]);
                } else if (rivers_.level[n] == 0 && static_cast<std::int8_t>(k) != rivers_.direction[n]) {
                    keep_off(n, q, step_lengths[k]);
                }
            }
        }
    }

    /// Keeps a cell above cells that may have been raised downstream.
    void keep_above(std::size_t n) {
        if (rivers_.receiver[n] < 0) {
            return;
        }
        float& z = level_.z[rivers_.cell[n]];
        float const below = level_.z[rivers_.cell[receiver(n)]];
        float const length = level_.side * step_lengths[rivers_.direction[n]];
        z = rivers_.level[n] != 0 ? below : std::max(z, below + least_ * length);
    }

private:
    std::size_t receiver(std::size_t n) const { return static_cast<std::size_t>(rivers_.receiver[n]); }
    std::int64_t number(std::size_t n) const { return rivers_.number[n]; }

    bool lies_downstream(std::size_t n, std::size_t cell) const {
        constexpr int steps = 8;
        for (int step = 0; step < steps && rivers_.receiver[n] >= 0; ++step) {
            n = receiver(n);
            if (rivers_.cell[n] == cell) {
                return true;
            }
        }
        return false;
    }

    /// Keeps the water of cell n from flowing to its neighbour q.
    void keep_off(std::size_t n, std::size_t q, float length) {
        float& z = level_.z[rivers_.cell[n]];
        float const below = level_.z[rivers_.cell[receiver(n)]];
        float const own = step_lengths[rivers_.direction[n]];
        float const ratio = length / own;
        float const least = z - ratio * (z - below) * (1.0F - margin);
        if (level_.z[q] >= least || lies_downstream(n, q)) {
            return;
        }
        float const most = below + (1.0F - margin) * (level_.z[q] - below) / (1.0F - ratio);
        if (ratio < 1.0F && most >= below + least_ * level_.side * own) {
            z = most;
        } else {
            level_.z[q] = least;
        }
    }

    TerrainLevel& level_;
    RiverCells const& rivers_;
    std::array<std::int64_t, 8> offsets_;
    float least_;                     ///< tangent towards a receiver
    std::vector<std::size_t> beyond_; ///< river cells outside the caller's grid
};

} // namespace

float graded_tangent(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n) {
    std::uint32_t const i = level.rivers.cell[n];
    float const area = static_cast<float>(level.area[i]) * level.side * level.side + law.source_area;
    float const uplift = level.uplift.empty() ? 1.0F : level.uplift[i];
    float const graded = creep_brings * uplift / (level.rock.erodibility(i) * law.power(area));
    return std::min(level.rivers.grade_of(n) * graded, share_of_cap * std::min(level.rock.cap(i), steepest_tangent));
}

float graded_height(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n, float below) {
    float const length = level.side * step_lengths[level.rivers.direction[n]];
    float const tangent = graded_tangent(level, law, n);
    LevelLayers const& strata = level.strata;
    if (strata.empty()) {
        return below + tangent * length;
    }
    std::size_t const i = level.rivers.cell[n];
    auto const bed = static_cast<double>(strata.bed[i]);
    auto const bed_below = static_cast<double>(strata.bed[level.rivers.cell[level.rivers.receiver[n]]]);
    double const s =
        climb_through(strata.layers, static_cast<double>(below) - bed_below, bed - bed_below, [&](std::size_t k) {
            float const by = static_cast<float>(strata.layers[k].river_strength);
            return static_cast<double>(std::max(least_tangent, std::min(tangent * by, strata.river_cap)) * length);
        });
    return std::max(static_cast<float>(s + bed), below + least_tangent * length);
}

std::vector<float> heights_through(RiverCells const& rivers, std::vector<float> const& fall, std::vector<float> asked) {
    return Profiles(rivers, fall, std::move(asked)).heights();
}

void relax_rivers(TerrainLevel& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> const most = greatest_heights(level, law);
    std::vector<float> const by_lakes = heights_by_lakes(level, law);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            continue; // an end keeps its height
        }
        std::uint32_t const i = rivers.cell[n];
        float const below = level.z[rivers.cell[rivers.receiver[n]]];
        if (rivers.level[n] != 0) {
            level.z[i] = below;
            continue;
        }
        if (!by_lakes.empty() && (rivers.is_held(n) || !std::isnan(rivers.asked[n]))) {
            level.z[i] = std::max(by_lakes[n], just_above(below));
            continue;
        }
        float const length = level.side * step_lengths[rivers.direction[n]];
        float const z = std::min(graded_height(level, law, n, below), most[n]);
        level.z[i] = std::max(z, below + least_tangent * length);
    }
}

void relax_given_rivers(TerrainLevel& level, EquilibriumLaw const& law, RiverHeights heights) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> z = heights_through(rivers, graded_falls(level, law), rivers.asked);
    auto const is_end = [&](std::size_t n) { return rivers.receiver[n] < 0; };
    auto const receiver = [&](std::size_t n) { return static_cast<std::size_t>(rivers.receiver[n]); };
    auto const length = [&](std::size_t n) { return level.side * step_lengths[rivers.direction[n]]; };
    bool const soft = heights == RiverHeights::soft;
    if (soft) {
        for (std::size_t n = z.size(); n-- > 0;) {
            if (!is_end(n) && rivers.hold_of(receiver(n)) < Hold::lake) {
                float& below = z[receiver(n)];
                float const rise = rivers.level[n] != 0 ? 0.0F : least_tangent * length(n);
                below = std::min(below, z[n] - rise);
            }
        }
    }
    std::vector<float> const most = soft ? greatest_heights(level, law) : std::vector<float>{};
    for (std::size_t n = 0; n < z.size(); ++n) {
        if (!is_end(n)) {
            float const below = z[receiver(n)];
            if (rivers.level[n] != 0) {
                z[n] = below;
            } else if (soft && !rivers.is_held(n)) {
                z[n] = std::max(std::min(z[n], most[n]), below + least_tangent * length(n));
            } else {
                z[n] = std::max(z[n], just_above(below));
            }
        }
        level.z[rivers.cell[n]] = z[n];
    }
}

double stem_steepness(TerrainLevel const& level, double cell_m) {
    constexpr double concavity = 0.45;
    RiverCells const& rivers = level.rivers;
    double const side_m = static_cast<double>(level.side) * cell_m;
    auto const area = [&](std::size_t n) { return level.area[rivers.cell[n]]; };
    std::vector<std::int32_t> donor(rivers.cell.size(), -1); // that of the largest area
    for (std::size_t n = 0; n < donor.size(); ++n) {
        if (std::int32_t const r = rivers.receiver[n]; r >= 0 && (donor[r] < 0 || area(n) > area(donor[r]))) {
            donor[r] = static_cast<std::int32_t>(n);
        }
    }
    double rises = 0.0;
    double chis = 0.0;
    for (std::size_t mouth = 0; mouth < donor.size(); ++mouth) {
        if (rivers.receiver[mouth] >= 0) {
            continue;
        }
        double chi = 0.0; // [m^0.1]
        std::size_t source = mouth;
        for (std::int32_t n = donor[mouth]; n >= 0; n = donor[n]) {
            double const step_m = side_m / d8_per_length[static_cast<std::size_t>(rivers.direction[n])];
            chi += step_m * portable::pow(static_cast<double>(area(n)) * side_m * side_m, -concavity);
            source = static_cast<std::size_t>(n);
        }
        auto const rise = static_cast<double>(level.z[rivers.cell[source]] - level.z[rivers.cell[mouth]]);
        auto const weight = static_cast<double>(area(mouth));
        if (std::isfinite(rise) && rise > 0.0) {
            rises += weight * rise;
            chis += weight * chi;
        }
    }
    return chis > 0.0 ? rises / chis : std::numeric_limits<double>::quiet_NaN();
}

bool leaves_grid(RiverCells const& rivers, std::size_t n) {
    std::int32_t const r = rivers.receiver[n];
    return r < 0 || rivers.number[r] < 0;
}

bool runs_through(RiverCells const& rivers, std::size_t n, std::size_t cell, int steps) {
    for (; rivers.cell[n] != cell; --steps) {
        if (steps == 0 || rivers.receiver[n] < 0) {
            return false;
        }
        n = static_cast<std::size_t>(rivers.receiver[n]);
    }
    return true;
}

std::vector<std::int64_t> walled_cells(TerrainLevel const& level, float tangent, Walls walls) {
    constexpr int steps = 4; // reaches the second ring, with a bend
    RiverCells const& rivers = level.rivers;
    std::vector<std::int64_t> numbers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        bool const counts = walls != Walls::by_lakes || rivers.hold_of(n) != Hold::none;
        if (rivers.number[n] < 0 || !counts || !is_perched(level, n, tangent)) {
            continue;
        }
        bool walled = false;
        each_of_second_ring(level, rivers.cell[n], [&](std::size_t i) {
            bool const lower = level.z[rivers.cell[n]] > level.z[i] + tangent * level.side;
            bool const counted = walls == Walls::land ? is_land(level.type[i]) && !is_bank(level.type[i])
                                                      : !runs_through(rivers, n, i, steps);
            walled = walled || (lower && counted);
        });
        if (walled) {
            numbers.push_back(rivers.number[n]);
        }
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

void lower_perched(TerrainLevel& level, float tangent, float step) {
    constexpr std::size_t passes = 2; // digging lowers the surroundings of other cells
    RiverCells const& rivers = level.rivers;
    std::size_t const count = rivers.cell.size();
    for (std::size_t k = 0; k < passes * count; ++k) {
        std::size_t const n = k % count;
        if (!leaves_grid(rivers, n) && rivers.level[n] == 0 && rivers.hold_of(n) != Hold::outlet) {
            float& z = level.z[rivers.cell[n]];
            float const least = level.z[rivers.cell[rivers.receiver[n]]] + step;
            float const lawful = highest_lawful(level, n, tangent);
            z = std::max(std::min(z, lawful), std::min(z, least));
            if (z > lawful) {
                lower_reach(level, n, lawful, step);
            }
        }
    }
}

void lower_banks(TerrainLevel& level, float rise, float step) {
    auto const offsets = level.offsets();
    for (std::uint32_t const river : level.rivers.cell) {
        float const most = level.z[river] + rise;
        for (std::int64_t const offset : offsets) {
            std::size_t const i = moved(river, offset);
            if (is_bank(level.type[i]) && level.z[i] > most && moved(i, offsets[level.direction[i]]) == river) {
                level.z[i] = std::min(level.z[i], std::max(most, highest_river(level, i, offsets) + step));
            }
        }
    }
}

void raise_below_perched(TerrainLevel& level, float tangent) {
    constexpr std::int64_t reach = 4; // [cells]
    Grid frame;
    frame.width = level.width;
    frame.height = level.height;
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.number[n] < 0 || !is_perched(level, n, tangent)) {
            continue;
        }
        Cell const at{rivers.cell[n] % level.width, rivers.cell[n] / level.width};
        float const z = level.z[rivers.cell[n]];
        cells_around(frame, at, reach, [&](Cell c) {
            std::int64_t const far = std::max(std::abs(c.col - at.col), std::abs(c.row - at.row));
            auto const i = static_cast<std::size_t>(c.row * level.width + c.col);
            if (far > 1 && is_land(level.type[i])) {
                level.z[i] = std::max(level.z[i], z - tangent * level.side * static_cast<float>(far - 1));
            }
        });
    }
}

void raise_land_beside(TerrainLevel& level, float tangent) {
    for (std::uint32_t const river : level.rivers.cell) {
        float const least = level.z[river] - tangent * level.side;
        each_of_second_ring(level, river, [&](std::size_t i) {
            if (is_land(level.type[i]) && !is_bank(level.type[i])) {
                level.z[i] = std::max(level.z[i], least);
            }
        });
    }
}

std::vector<std::int64_t> remove_perched_tips(TerrainLevel& level, float tangent, TipBanks banks) {
    auto const perched = [&](std::size_t n) { return is_perched(level, n, tangent); };
    return remove_tips(level, marked_tips(level.rivers, upstream_of(level.rivers), longest_tip, perched), banks);
}

std::vector<std::int64_t> remove_trenched_tips(TerrainLevel& level, float tangent) {
    auto const trenched = [&](std::size_t n) { return cuts_trench(level, n, tangent); };
    return remove_tips(level, marked_tips(level.rivers, upstream_of(level.rivers), longest_tip, trenched),
                       TipBanks::rise);
}

std::vector<std::int64_t> remove_touching_tips(TerrainLevel& level) {
    return remove_tips(level, touching_heads(level), TipBanks::rise);
}

void enforce_receivers(TerrainLevel& level, float least) {
    Keeper keeper(level, least);
    for (int pass = 0; pass < passes; ++pass) {
        keeper.pass();
    }
    // The law takes precedence: above the receiver, lakes level with it.
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        keeper.keep_above(n);
    }
}

} // namespace thalweg::surface
