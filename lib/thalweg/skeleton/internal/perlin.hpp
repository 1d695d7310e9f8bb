// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::skeleton {

/// Fractal Perlin noise of four octaves, gain 0.5, lacunarity 2, wavelength 1 of the coarsest.
/// \param places within 2^20 of the origin
/// \param seed its lower 16 bits count
/// \return by place: the sum of the octaves, at most about 1.875 in absolute value
/// \throws BadParameter in a build without libnoise
std::vector<double> perlin(std::vector<Vec3> const& places, int seed, Run const& run);

} // namespace thalweg::skeleton
