// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <utility>

#include <thalweg/surface/equilibrium/internal/base_levels.hpp>
#include <thalweg/surface/equilibrium/internal/erodibility.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Described in docs/algorithms/equilibrium_levels.md and docs/decisions/0040-no-walls-round-basins.md.

namespace thalweg::surface {
namespace {

constexpr float of_climb = 0.6F; // share of what land climbs on the way from a base to a river: the rest is the divide
constexpr float least_change = 0.7F; // factor of one call
constexpr float recovery = 1.03F;    // factor of one call where a river might be steeper
constexpr float least_grade = 0.1F;
constexpr float great_river = 16.0F; // ratio of areas above which a river is not eased for a brook

/// Where water leaves land, as seen from a cell.
struct Base {
    float z = std::numeric_limits<float>::infinity();
    float far = 0.0F; ///< [finest cells]
};

/// Heights of land above bases. A stream's basin has a third of the square of its length (Montgomery and Dietrich
/// 1992), and its slope is that of the balance of uplift and erosion.
class LandProfile {
public:
    LandProfile(TerrainLevel const& level, EquilibriumLaw const& law) {
        constexpr float longest_way = 1.5F; // steps of 1 and sqrt(2) through a rectangle, of its two sides
        auto const most =
            static_cast<std::size_t>(longest_way * static_cast<float>(level.width + level.height) * level.side);
        height_.resize(most + 1, 0.0F);
        for (std::size_t far = 1; far < height_.size(); ++far) {
            float const area = std::max(1.0F, static_cast<float>(far * far) / 3.0F);
            height_[far] = height_[far - 1] + 1.0F / law.land.power(area);
        }
    }

    /// The height to which land rises over some more cells beyond a place.
    float above(Base const& base, float more = 0.0F) const {
        return base.z + of_climb * height_[static_cast<std::size_t>(base.far + more)];
    }

private:
    std::vector<float> height_; ///< by distance [finest cells]
};

/// Graded heights of rivers, regardless of the terrain, and those of their ends.
struct GradedHeights {
    std::vector<float> z;
    std::vector<float> end;
};

GradedHeights graded_heights(TerrainLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    GradedHeights out{std::vector<float>(rivers.cell.size()), std::vector<float>(rivers.cell.size())};
    for (std::size_t n = 0; n < out.z.size(); ++n) {
        std::int32_t const r = rivers.receiver[n];
        if (r < 0) {
            out.z[n] = level.z[rivers.cell[n]];
            out.end[n] = out.z[n];
            continue;
        }
        out.z[n] = rivers.level[n] != 0 ? out.z[r] : graded_height(level, law, n, out.z[r]);
        out.end[n] = out.end[r];
    }
    return out;
}

/// By cell, of the sea and all rivers the base from which land climbs least to there.
Cells<Base> bases(TerrainLevel const& level, LandProfile const& land, std::vector<float> const& river_z) {
    Cells<Base> base(static_cast<std::size_t>(level.cells()));
    for (std::size_t i = 0; i < base.size(); ++i) {
        base[i].z = level.type[i] == CellType::sea ? 0.0F : base[i].z;
    }
    for (std::size_t n = 0; n < river_z.size(); ++n) {
        base[level.rivers.cell[n]].z = river_z[n];
    }
    spread_out(level, static_cast<std::size_t>(level.height), [&](std::size_t i, std::size_t from, float cells) {
        float const length = cells * level.side;
        if (!std::isinf(base[from].z) &&
            (std::isinf(base[i].z) || land.above(base[from], length) < land.above(base[i]))) {
            base[i] = {base[from].z, base[from].far + length};
        }
    });
    return base;
}

/// By river cell: the factor by which the way from its end must be less steep for it and the rivers upstream, of which
/// it is not the much larger one.
std::vector<float> changes(TerrainLevel const& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    GradedHeights const graded = graded_heights(level, law);
    LandProfile const land(level, law);
    Cells<Base> const base = bases(level, land, graded.z);
    std::vector<float> change(rivers.cell.size(), 1.0F);
    std::vector<float> area(change.size(), 0.0F); // of the cell for which it is eased
    for (std::size_t n = change.size(); n-- > 0;) {
        std::uint32_t const i = rivers.cell[n];
        float const rise = graded.z[n] - graded.end[n];
        if (rise > 0.0F && rivers.number[n] >= 0 && !rivers.is_held(n)) {
            float const wanted = std::max(least_change, (land.above(base[i]) - graded.end[n]) / rise);
            if (wanted < change[n]) {
                change[n] = wanted;
                area[n] = static_cast<float>(level.area[i]);
            }
        }
        std::int32_t const r = rivers.receiver[n];
        if (r >= 0 && change[n] < change[r] &&
            static_cast<float>(level.area[rivers.cell[r]]) <= great_river * area[n]) {
            change[r] = change[n];
            area[r] = area[n];
        }
    }
    return change;
}

constexpr float far_from_rivers = 5.0F; // half distances of rivers
constexpr float large_valley = 0.75F;   // its area, of that distance squared
constexpr float softest = 1.5F;         // [log]
constexpr float softening = 0.5F;       // largest change per call

/// Half the distance between rivers on the land that they drain, in cells of the level.
float half_distance(TerrainLevel const& level) {
    RiverCells const& rivers = level.rivers;
    double length = 0.0;
    double area = 0.0;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            area += static_cast<double>(level.area[rivers.cell[n]]);
        } else {
            length += static_cast<double>(step_lengths[rivers.direction[n]]);
        }
    }
    return static_cast<float>(0.5 * area / std::max(length, 1.0));
}

/// Large valleys far from rivers.
class ValleysBeyond {
public:
    explicit ValleysBeyond(TerrainLevel const& level)
        : level_(level), offsets_(level.offsets()), near_(nearest_river(level)), lowest_(lowest_valleys(level)),
          gap_(far_from_rivers * half_distance(level)), large_(large_valley * gap_ * gap_) {}

    /// By cell: by how much rock there is too hard [log, at most 1].
    Cells<float> excess() const {
        Cells<float> excess(static_cast<std::size_t>(level_.cells()), 0.0F);
        each_inner(level_, [&](std::size_t i) {
            if (is_large(i) && std::none_of(offsets_.begin(), offsets_.end(), [&](std::int64_t offset) {
                    std::size_t const n = moved(i, offset);
                    return is_large(n) && below(n) == i;
                })) {
                follow(i, excess);
            }
        });
        return excess;
    }

private:
    /// Land that drains somewhere: `below` is defined.
    bool is_stream(std::size_t i) const { return is_land(level_.type[i]) && level_.direction[i] >= 0; }
    bool is_large(std::size_t i) const {
        return is_stream(i) && near_.distance[i] >= gap_ && static_cast<float>(level_.area[i]) >= large_;
    }
    std::size_t below(std::size_t i) const { return moved(i, offsets_[level_.direction[i]]); }

    /// Marks a valley from its upper end on, unless it leads to a river.
    void follow(std::size_t head, Cells<float>& excess) const {
        std::size_t end = head;
        while (is_stream(end)) {
            end = below(end);
        }
        if (level_.type[end] != CellType::boundary && level_.type[end] != CellType::sea) {
            return;
        }
        constexpr float least = 0.1F; // [cells of the level] above the end
        float most = 0.0F;
        for (std::size_t i = head; i != end; i = below(i)) {
            if (near_.distance[i] >= gap_) {
                float const river = level_.z[level_.rivers.cell[near_.number[i]]];
                float const wanted = valley_beyond(river, near_.distance[i] * level_.side, lowest_[i]) - level_.z[end];
                float const ratio = (level_.z[i] - level_.z[end]) / std::max(wanted, least * level_.side);
                most = std::max(most, static_cast<float>(portable::log(static_cast<double>(std::max(ratio, 1.0F)))));
            }
            excess[i] = std::max(excess[i], std::min(1.0F, most));
        }
    }

    TerrainLevel const& level_;
    std::array<std::int64_t, 8> offsets_;
    NearestRiver near_;
    Cells<float> lowest_;
    float gap_;   ///< [cells of the level]
    float large_; ///< [cells of the level]
};

} // namespace

void ease_rivers(TerrainLevel& level, EquilibriumLaw const& law) {
    RiverCells& rivers = level.rivers;
    std::vector<float> const change = changes(level, law);
    if (rivers.grade.empty() && std::all_of(change.begin(), change.end(), [](float by) { return by == 1.0F; })) {
        return;
    }
    rivers.grade.resize(change.size(), 1.0F);
    for (std::size_t n = 0; n < change.size(); ++n) {
        float const grade = rivers.grade[n];
        rivers.grade[n] =
            change[n] < 1.0F ? std::max(least_grade, grade * change[n]) : std::min(1.0F, grade * recovery);
    }
}

void copy_grade(TerrainLevel& level, TerrainLevel const& coarser) {
    if (coarser.rivers.grade.empty()) {
        return;
    }
    constexpr float none = -1.0F;
    Cells<float> at(static_cast<std::size_t>(coarser.cells()), none);
    for (std::size_t n = 0; n < coarser.rivers.cell.size(); ++n) {
        at[coarser.rivers.cell[n]] = coarser.rivers.grade[n];
    }
    RiverCells& rivers = level.rivers;
    rivers.grade.resize(rivers.cell.size(), 1.0F);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        Cell const c = level.at(rivers.cell[n]);
        LevelPlace const place = place_in(coarser, level, c.col, c.row);
        auto const col = std::clamp<std::int64_t>(std::llround(place.col), 0, coarser.width - 1);
        auto const row = std::clamp<std::int64_t>(std::llround(place.row), 0, coarser.height - 1);
        float const coarse = at[row * coarser.width + col];
        std::int32_t const r = rivers.receiver[n];
        rivers.grade[n] = coarse != none ? coarse : r >= 0 ? rivers.grade[r] : 1.0F;
    }
}

void soften_valleys_beyond(TerrainLevel& level) {
    Cells<float> const excess = ValleysBeyond(level).excess();
    if (std::all_of(excess.begin(), excess.end(), [](float by) { return by == 0.0F; })) {
        return;
    }
    for (std::size_t i = 0; i < excess.size(); ++i) {
        add_firmness(level, i, -std::max(0.0F, std::min(softening * excess[i], softest + level.firmness.or_zero(i))));
    }
}

} // namespace thalweg::surface
