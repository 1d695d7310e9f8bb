// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::skeleton {

/// Options of noise_along().
struct NoiseAlongParams {
    std::uint64_t seed = 7;
    double amplitude_m = 0.0;     ///< [m] >= 0, bound of the noise
    double wavelength_m = 1000.0; ///< [m] > 0, of the coarsest octave
};

/// A position on a line.
struct PlaceOnLine {
    Vec2 at;            ///< [m]
    double share = 0.0; ///< [0, 1] share of the line's length up to it
};

/// Evaluates noise on a line that is 0 at its ends: F(at) 4 share (1 - share), F fractal Perlin noise of four octaves
/// (gain 0.5, lacunarity 2). F is a field in the plane: lines close to each other get similar noise.
/// \param places positions on lines
/// \param origin [m] near the lines; noise is evaluated relative to it
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return [m] one value per place, within the amplitude
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming the place: a share outside [0, 1], or farther than 2^20 wavelengths from the origin
///
/// Source: \cite nenu2015, equation 11; specification 3.5; \cite perlin1985 by libnoise.
std::vector<double> noise_along(std::vector<PlaceOnLine> const& places, Vec2 origin,
                                NoiseAlongParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
