// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/rise_of.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/steepest_descent.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::surface {

namespace {

/// Counts of tangents by their leading nine binary digits.
class Tangents {
public:
    void add(float tangent) { ++counts_[std::bit_cast<std::uint32_t>(tangent) >> dropped]; }

    bool empty() const {
        return std::all_of(counts_.begin() + 1, counts_.end(), [](std::uint64_t n) { return n == 0; });
    }

    /// [degrees] mean slope when heights are multiplied.
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

/// Horn's slope of the cells that have all their neighbours.
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

/// Where no cell has all its neighbours: the steepest descents.
Tangents descents(Raster<float> const& land) {
    Tangents tangents;
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        double const steepest = flow::steepest_descent(land, land.grid().at(i)).slope;
        if (steepest > 0.0) { // what has nowhere to go says nothing
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

/// [m] from the lowest to the highest cell, of heights in cells.
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

} // namespace

Rise rise_of(Raster<float> const& land, EquilibriumParams const& params) {
    Tangents const tangents = tangents_of(land);
    double const factor =
        params.relief_m ? rise_for_relief(land, *params.relief_m) : rise_for_slope(tangents, params.mean_slope_deg);
    if (tangents.empty()) {
        return {factor, 0.0};
    }
    double const slope = tangents.mean_slope(factor) * (portable::pi / 180.0);
    return {factor, portable::sin(slope) / portable::cos(slope)};
}

double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params) {
    if (params.relief_m) {
        return range_of(land) * factor / *params.relief_m;
    }
    Tangents const tangents = tangents_of(land);
    return tangents.empty() ? 0.0 : tangents.mean_slope(factor) / params.mean_slope_deg;
}

} // namespace thalweg::surface
