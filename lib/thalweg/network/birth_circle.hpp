// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/chance.hpp>

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

/// The circles around a cluster: walkers start on the first and are taken back to it from outside the second.
struct BirthCircle {
    double birth = 0.0;    ///< [cells] radius of the cluster + 4
    double far = 0.0;      ///< [cells] the larger of 1.1 birth and birth + 24
    std::int64_t far2 = 0; ///< far squared, rounded down: a site is outside if squared(site) > far2
};

/// The circles around a cluster of this radius [cells].
BirthCircle birth_circle(double cluster_radius);

/// A uniform site of the birth circle, rounded to the lattice.
Site born(BirthCircle const& circle, ChanceStream& chance);

/// Where a walk from `from`, outside, first meets the birth circle, rounded to the lattice. In the plane the hitting
/// law is the exterior Poisson kernel (exact for Brownian motion, on the lattice up to terms of order 1/gap^2); it is
/// drawn as the image of a uniform point w under the Moebius map (w + a) / (1 + conj(a) w), a = birth/conj(from).
Site back_from_afar(BirthCircle const& circle, Site from, ChanceStream& chance);

} // namespace thalweg::network
