// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/noise_along.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/skeleton/internal/perlin.hpp>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t noise_stage = 0x6e6f697365616c31; // "noiseal1"
constexpr double sum_of_gains = 1.875;                    // of four octaves
constexpr double widest_shift = 256.0;                    // [wavelengths] after which libnoise repeats itself

void demand(NoiseAlongParams const& params) {
    require_in("skeleton.noise_along", "amplitude_m", params.amplitude_m, Range::at_least(0.0));
    require_in("skeleton.noise_along", "wavelength_m", params.wavelength_m, Range::above(0.0));
}

/// A place in wavelengths from the origin.
Vec2 scaled(PlaceOnLine const& place, std::size_t number, Vec2 origin, double wavelength_m) {
    constexpr double farthest = 0x1p20; // libnoise folds coordinates beyond 2^30, after three doublings
    Vec2 const at{(place.at.x - origin.x) / wavelength_m, (place.at.y - origin.y) / wavelength_m};
    if (!(std::fabs(at.x) <= farthest && std::fabs(at.y) <= farthest)) {
        throw BadInput(fmt::format("skeleton.noise_along: place {} at ({}, {}) is not within 2^20 wavelengths of {} m "
                                   "from ({}, {}); lengthen the wave",
                                   number, place.at.x, place.at.y, wavelength_m, origin.x, origin.y));
    }
    if (!(place.share >= 0.0 && place.share <= 1.0)) {
        throw BadInput(fmt::format("skeleton.noise_along: place {} at ({}, {}) has a share of {}; give one from 0 to 1",
                                   number, place.at.x, place.at.y, place.share));
    }
    return at;
}

} // namespace

std::vector<double> noise_along(std::vector<PlaceOnLine> const& places, Vec2 origin, NoiseAlongParams const& params,
                                Run const& run) {
    demand(params);
    run.check();
    auto const words = random_block(params.seed, noise_stage);
    // libnoise folds its seed to 16 bits, and its noise is 0 wherever coordinates are whole.
    double const shift_x = widest_shift * unit(words[1]);
    double const shift_y = widest_shift * unit(words[2]);
    double const level = unit(words[3]);
    std::vector<Vec3> shifted(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec2 const at = scaled(places[i], i, origin, params.wavelength_m);
        shifted[i] = {at.x + shift_x, at.y + shift_y, level};
    }
    std::vector<double> noise(places.size(), 0.0);
    if (!(params.amplitude_m > 0.0)) {
        return noise;
    }
    noise = perlin(shifted, static_cast<int>(words[0] >> 33U), run);
    for (std::size_t i = 0; i < places.size(); ++i) {
        // What libnoise calls 1 is passed now and then.
        double const share = places[i].share;
        noise[i] = params.amplitude_m * std::clamp(noise[i] / sum_of_gains, -1.0, 1.0) * (4.0 * share * (1.0 - share));
    }
    return noise;
}

} // namespace thalweg::skeleton
