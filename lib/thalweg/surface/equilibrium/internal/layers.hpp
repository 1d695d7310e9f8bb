// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <thalweg/core/run/memory.hpp>

// Layers of rock in a level. See docs/algorithms/equilibrium_layers.md.

namespace thalweg::surface {

/// A layer in the solver's units.
struct LevelLayer {
    double top = 0.0;            ///< above the bed; of the topmost one infinite
    double strength = 1.0;       ///< of slopes of land
    double river_strength = 1.0; ///< of given rivers: less than the layer's where it is firm, so that they cut gorges
    double cap = 1.0;            ///< greatest tangent of land
};

/// The layers of a level; empty: rock without layers.
struct LevelLayers {
    std::vector<LevelLayer> layers;                        ///< from the lowest up
    std::vector<float, LargePages<float>> bed;             ///< by cell of the level: height of the bed
    double most = std::numeric_limits<double>::infinity(); ///< greatest height of land
    float river_cap = 1.0F;                                ///< greatest tangent of given rivers

    bool empty() const { return layers.empty(); }

    /// Makes everything but the greatest height of land so many times as high.
    void scale(double factor) {
        auto const small = static_cast<float>(factor);
        for (LevelLayer& layer : layers) {
            layer.top *= factor;
            layer.cap *= factor;
        }
        for (float& height : bed) {
            height *= small;
        }
        river_cap *= small;
    }
};

/// The layer of a place above the bed; at a contact the upper one.
inline std::size_t layer_of(std::vector<LevelLayer> const& layers, double s) {
    auto const above = std::upper_bound(layers.begin(), layers.end(), s,
                                        [](double place, LevelLayer const& layer) { return place < layer.top; });
    return static_cast<std::size_t>(above - layers.begin());
}

/// Where on the way from a cell to the next one a place in the stack of layers ends up. In each layer the surface rises
/// at that layer's slope, less the rise of the bed. Where it would leave a contact on neither side it follows the
/// contact: a dip slope.
/// \param s place above the bed at the lower cell
/// \param bed_rise of the bed from it to the upper cell
/// \param rise_in rise(layer): of the surface, were all of the way in that layer
template <class Rise>
double climb_through(std::vector<LevelLayer> const& layers, double s, double bed_rise, Rise rise_in) {
    auto const gain = [&](std::size_t k) { return rise_in(k) - bed_rise; };
    std::size_t k = layer_of(layers, s);
    // Heights are floats: what has followed a contact is near it.
    double const near = 0x1p-20 * (std::fabs(s) + std::fabs(bed_rise) + 1.0);
    if (layers[k].top - s <= near) {
        ++k;
    }
    double part = gain(k);
    if (k > 0 && s - layers[k - 1].top <= near) {
        s = layers[k - 1].top;
        if (part <= 0.0) {
            double const lower = gain(k - 1);
            if (lower >= 0.0) {
                return s;
            }
            --k;
            part = lower;
        }
    }
    double left = 1.0; // of the way
    if (part >= 0.0) {
        while (s + part * left > layers[k].top) {
            left -= (layers[k].top - s) / part;
            s = layers[k].top;
            part = gain(++k);
            if (part <= 0.0) {
                return s;
            }
        }
        return s + part * left;
    }
    while (k > 0 && s + part * left < layers[k - 1].top) {
        left -= (layers[k - 1].top - s) / part;
        s = layers[k - 1].top;
        part = gain(--k);
        if (part >= 0.0) {
            return s;
        }
    }
    return s + part * left;
}

/// What sets a land cell's height, besides layers.
struct LandBalance {
    double force = 0.0;  ///< uplift, and creep from the neighbours
    double creep = 0.0;  ///< rate at which creep grows with the cell's own height
    double power = 1.0;  ///< K A^theta in rock of strength 1
    double length = 1.0; ///< of the step to the receiver
    double least = 0.0;  ///< tangent
    double cap = 1.0;    ///< factor of the layers' caps
};

/// The height at which uplift balances incision and creep above a receiver, through layers.
double height_in_layers(std::vector<LevelLayer> const& layers, LandBalance const& balance, double below,
                        double bed_below, double bed);

} // namespace thalweg::surface
