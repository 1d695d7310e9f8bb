// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/relax_given_rivers.hpp>

#include <thalweg/surface/equilibrium/internal/graded_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::surface {

namespace {

/// Long profiles of rivers through the heights that are asked.
class Profiles {
public:
    Profiles(LandLevel const& level, EquilibriumLaw const& law) : level_(level), rivers_(level.rivers) {
        std::size_t const count = rivers_.cell.size();
        graded_.resize(count);
        anchor_.resize(count);
        for (std::size_t n = 0; n < count; ++n) {
            if (is_end(n)) {
                anchor_[n] = n;
                continue;
            }
            std::size_t const r = receiver(n);
            bool const lake = rivers_.level[n] != 0;
            graded_[n] = graded_[r] + (lake ? 0.0F : graded_tangent(level, law, rivers_.cell[n]) * length(n));
            anchor_[n] = is_asked(r) ? r : anchor_[r];
        }
        aim();
    }

    std::vector<float> heights() const {
        std::vector<float> z(graded_.size());
        for (std::size_t n = 0; n < z.size(); ++n) {
            z[n] = is_asked(n) ? rivers_.asked[n] : is_end(n) ? end_height(n) : height_above(n, z[receiver(n)]);
        }
        return z;
    }

    bool is_end(std::size_t n) const { return rivers_.receiver[n] < 0; }
    std::size_t receiver(std::size_t n) const { return static_cast<std::size_t>(rivers_.receiver[n]); }
    float length(std::size_t n) const { return level_.side * step_lengths[static_cast<std::size_t>(rivers_.way[n])]; }

private:
    static constexpr std::int32_t nothing = -1;

    /// A lake has its outlet's height, whatever is asked.
    bool is_asked(std::size_t n) const { return !std::isnan(rivers_.asked[n]) && (is_end(n) || rivers_.level[n] == 0); }

    /// How little a river may rise on its way from the anchor below to what is asked above.
    float steepness(std::size_t asked) const {
        std::size_t const below = anchor_[asked];
        if (!is_asked(below)) {
            return rivers_.asked[asked] - graded_[asked];
        }
        constexpr float least = 1e-6F;
        return (rivers_.asked[asked] - rivers_.asked[below]) / std::max(graded_[asked] - graded_[below], least);
    }

    /// Finds for each cell the height asked upstream that lets it rise the least.
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
        return rivers_.asked[above] - graded_[above];
    }

    float height_above(std::size_t n, float below) const {
        float const fall = graded_[n] - graded_[receiver(n)];
        if (aim_[n] == nothing || !(fall > 0.0F)) {
            return below + fall;
        }
        auto const above = static_cast<std::size_t>(aim_[n]);
        return below + (rivers_.asked[above] - below) * (fall / (graded_[above] - graded_[receiver(n)]));
    }

    LandLevel const& level_;
    RiverCells const& rivers_;
    std::vector<float> graded_;       ///< heights of graded rivers above their ends
    std::vector<std::size_t> anchor_; ///< number of the next cell downstream whose height is asked, or of the end
    std::vector<std::int32_t> aim_;   ///< number of the cell upstream, itself included, towards which a cell rises
};

} // namespace

void relax_given_rivers(LandLevel& level, EquilibriumLaw const& law, RiverHeights heights) {
    Profiles const profiles(level, law);
    RiverCells const& rivers = level.rivers;
    std::vector<float> z = profiles.heights();
    bool const soft = heights == RiverHeights::soft;
    if (soft) {
        for (std::size_t n = z.size(); n-- > 0;) {
            if (!profiles.is_end(n)) {
                float& below = z[profiles.receiver(n)];
                float const rise = rivers.level[n] != 0 ? 0.0F : least_tangent * profiles.length(n);
                below = std::min(below, z[n] - rise);
            }
        }
    }
    std::vector<float> const most = soft ? greatest_heights(level, law) : std::vector<float>{};
    for (std::size_t n = 0; n < z.size(); ++n) {
        if (!profiles.is_end(n)) {
            float const below = z[profiles.receiver(n)];
            if (rivers.level[n] != 0) {
                z[n] = below;
            } else if (soft) {
                z[n] = std::max(std::min(z[n], most[n]), below + least_tangent * profiles.length(n));
            } else {
                z[n] = std::max(z[n], std::nextafter(below, std::numeric_limits<float>::infinity()));
            }
        }
        level.z[rivers.cell[n]] = z[n];
    }
}

} // namespace thalweg::surface
