// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <thalweg/core/numbers/random.hpp>

namespace thalweg::network {

/// A place on the lattice, counted from the seed of the cluster: x to the east, y to the south.
struct Site {
    std::int32_t x = 0;
    std::int32_t y = 0;
    friend bool operator==(Site const&, Site const&) = default;
};

/// Distance to the seed, squared.
inline std::int64_t squared(Site s) {
    return std::int64_t{s.x} * s.x + std::int64_t{s.y} * s.y;
}

/// Distance to the seed in the greater of the two directions.
inline std::int32_t chebyshev(Site s) {
    return std::max(std::abs(s.x), std::abs(s.y));
}

/// Where walkers start around a cluster, and from where they are taken back. The line of no return is a square, so that
/// the squares a walker leaves can share a side with it.
struct LaunchCircle {
    double birth = 0.0;   ///< [cells] radius of the cluster + 4
    std::int32_t far = 0; ///< [cells] the larger of 1.5 birth and birth + 24: walkers with max(|x|,|y|) = far are lost

    bool lost(Site s) const { return chebyshev(s) >= far; }
};

/// The circle around a cluster of this radius [cells].
LaunchCircle launch_circle(double cluster_radius);

/// A uniform site of the birth circle, rounded to the lattice.
Site born(LaunchCircle const& circle, RandomStream& random);

/// Where a walk from `from`, outside, first meets the birth circle, rounded to the lattice. In the plane the hitting
/// law is the exterior Poisson kernel (exact for Brownian motion, on the lattice up to terms of order 1/gap^2); it is
/// drawn as the image of a uniform point w under the Moebius map (w + a) / (1 + conj(a) w), a = birth/conj(from).
Site back_from_afar(LaunchCircle const& circle, Site from, RandomStream& random);

} // namespace thalweg::network
