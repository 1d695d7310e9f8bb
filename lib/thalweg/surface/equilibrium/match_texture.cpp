// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/match_texture.hpp>

#include <algorithm>
#include <cmath>

// Described in docs/rebuild.md.

namespace thalweg::surface {

TextureMatch match_texture(TextureMatch const& first, double wanted,
                           std::function<double(double roughness)> const& correlation_with) {
    constexpr double close = 0.01;
    constexpr int most_rounds = 4;
    constexpr double most_roughness = 0.88;
    double change = -0.22; // of the correlation by roughness: measured in Big Tujunga and Jacksboro
    TextureMatch here = first;
    for (int round = 1; round < most_rounds && std::fabs(here.correlation - wanted) > close; ++round) {
        double const roughness = std::clamp(here.roughness + (wanted - here.correlation) / change, 0.0, most_roughness);
        if (roughness == here.roughness) {
            break;
        }
        double const there = correlation_with(roughness);
        change = std::min((there - here.correlation) / (roughness - here.roughness), -0.05);
        here = {roughness, there};
    }
    return here;
}

} // namespace thalweg::surface
