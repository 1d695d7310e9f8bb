// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/relax_land.hpp>

#include <thalweg/surface/equilibrium/internal/beside_rivers.hpp>

#include <algorithm>

namespace thalweg::surface {

namespace {

// Weights of the nine-point Laplacian: neighbours by side and by corner.
constexpr float by_side = 4.0F / 6.0F;
constexpr float by_corner = 1.0F / 6.0F;

struct Creep {
    float gain;   ///< weighted heights of the neighbours
    float weight; ///< their weights
};

Creep creep_inside(float const* z, std::int64_t width) {
    float const sides = (z[1] + z[-1]) + (z[width] + z[-width]);
    float const corners = (z[width + 1] + z[width - 1]) + (z[-width + 1] + z[-width - 1]);
    return {by_side * sides + by_corner * corners, 4.0F * (by_side + by_corner)};
}

Creep creep_at_rim(LandLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    Creep creep{0.0F, 0.0F};
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        std::size_t const n = moved(i, offsets[k]);
        if (level.cover[n] != Cover::outside) {
            float const weight = k % 2 == 0 ? by_side : by_corner;
            creep.gain += weight * level.z[n];
            creep.weight += weight;
        }
    }
    return creep;
}

} // namespace

void relax_land(LandLevel& level, EquilibriumLaw const& law) {
    auto const offsets = level.offsets();
    float const creep_rate = law.creep / (level.side * level.side);
    float const cell_area = level.side * level.side;
    for (std::size_t at = level.order.size(); at-- > 0;) {
        std::size_t const i = level.order[at];
        auto const way = static_cast<std::size_t>(level.way[i]);
        float const length = level.side * step_lengths[way];
        float const below = level.z[moved(i, offsets[way])];
        Cover const cover = level.cover[i];
        bool const at_rim = cover == Cover::rim || cover == Cover::rim_bank;
        Creep const creep = at_rim ? creep_at_rim(level, i, offsets) : creep_inside(&level.z[i], level.width);
        float const cutting =
            law.land_power(static_cast<float>(level.area[i]) * cell_area) * level.erodibility[i] / length;
        float const uplift = level.uplift.empty() ? 1.0F : level.uplift[i];
        float z = (uplift + cutting * below + creep_rate * creep.gain) / (cutting + creep_rate * creep.weight);
        z = std::min(z, below + level.cap[i] * length);
        z = std::max(z, below + least_tangent * length);
        if (is_bank(cover)) {
            z = std::max(z, highest_river(level, i, offsets) + bank_step * level.side);
        }
        level.z[i] = z;
    }
}

} // namespace thalweg::surface
