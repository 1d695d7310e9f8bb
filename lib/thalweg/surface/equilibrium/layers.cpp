// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/layers.hpp>

// Described in docs/algorithms/equilibrium_layers.md.

namespace thalweg::surface {
namespace {

/// Heights of a cell for the creep that other heights of it would bring.
class Heights {
public:
    Heights(std::vector<LevelLayer> const& layers, LandBalance const& balance, double below, double bed_below,
            double bed)
        : layers_(layers), balance_(balance), below_(below), bed_below_(bed_below), bed_(bed) {}

    /// The height above the receiver that follows from the creep of a height; the greater the one, the less the other.
    double at(double z) const {
        double const force = balance_.force - balance_.creep * z;
        return bed_ + climb_through(layers_, below_ - bed_below_, bed_ - bed_below_, [&](std::size_t k) {
                   LevelLayer const& layer = layers_[k];
                   double const tangent = layer.strength * force / balance_.power;
                   return balance_.length * std::max(std::min(tangent, layer.cap * balance_.cap), balance_.least);
               });
    }

    /// The height if all of the way is in a layer.
    double within(LevelLayer const& layer) const {
        double const cutting = balance_.power / (layer.strength * balance_.length);
        double const z = (balance_.force + cutting * below_) / (cutting + balance_.creep);
        return std::max(std::min(z, below_ + layer.cap * balance_.cap * balance_.length), least());
    }

    double least() const { return below_ + balance_.least * balance_.length; }

    /// Whether the way to a height leads through one layer, which is the receiver's.
    bool stays_in(std::size_t k, double z) const {
        double const s = below_ - bed_below_;
        double const low = k > 0 ? layers_[k - 1].top : -std::numeric_limits<double>::infinity();
        double const high = layers_[k].top;
        double const near = 0x1p-19 * (std::fabs(s) + std::fabs(bed_) + 1.0); // more than climb_through() tells apart
        return s - low > near && high - s > near && z - bed_ > low && z - bed_ < high;
    }

private:
    std::vector<LevelLayer> const& layers_;
    LandBalance const& balance_;
    double below_;
    double bed_below_;
    double bed_;
};

} // namespace

double height_in_layers(std::vector<LevelLayer> const& layers, LandBalance const& balance, double below,
                        double bed_below, double bed) {
    Heights const heights(layers, balance, below, bed_below, bed);
    std::size_t const k = layer_of(layers, below - bed_below);
    if (double const z = heights.within(layers[k]); heights.stays_in(k, z)) {
        return z;
    }
    // heights.at(z) - z falls with z: false position, with the weight of an end that stays halved (Illinois)
    constexpr int most_steps = 7;
    constexpr double near = 0x1p-16;
    double low = heights.least();
    double high = heights.at(low);
    if (balance.creep <= 0.0 || !(high > low)) {
        return std::max(high, low);
    }
    double over = high - low;
    double under = heights.at(high) - high;
    int side = 0;
    for (int step = 0; step < most_steps && high - low > near * (1.0 + std::fabs(high)); ++step) {
        double const share = over - under > 0.0 ? over / (over - under) : 0.5;
        double const middle = low + (high - low) * share;
        double const off = heights.at(middle) - middle;
        if (off > 0.0) {
            low = middle;
            over = off;
            under = side == 1 ? 0.5 * under : under;
            side = 1;
        } else {
            high = middle;
            under = off;
            over = side == -1 ? 0.5 * over : over;
            side = -1;
        }
    }
    return std::clamp(heights.at(0.5 * (low + high)), low, high);
}

} // namespace thalweg::surface
