// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: Rivers, ridges and points become one raster of cells that a surface has to pass through.
// Rivers come first and keep their bits, then the highest point of a cell, then its highest ridge.
// Ridges are roughened by fractal noise: the sum of four octaves of Perlin noise, each half as long
// and half as high. It is a field in the plane, so that neighbouring ridges resemble each other,
// times 4 t (1 - t) along the ridge, so that ridges still meet at their ends.
// Source: Northeast Normal University 2015, section 3.1 and equation 11, begun at the height of the
// ridge's start; Perlin 1985 by libnoise.
// Cost: O(cells of the grid + cells of ridges). One thread.
// Not for: builds without libnoise, where an amplitude above 0 is refused. Noise does not keep
// ridges above rivers beside them: below_river counts these cells.
// Example:
//     DrawnSkeleton const drawn = draw_skeleton(valley, ridge_lines, {});
//     Skeleton const& heights = drawn.skeleton; // for surface::diffuse
// More: docs/rivers.md, "Ridges".

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
/// \return [m] one value per place, within the amplitude
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput naming the place: a share outside [0, 1], or farther than 2^20 wavelengths from the origin
///
/// Source: \cite nenu2015, equation 11; \cite perlin1985 by libnoise.
std::vector<double> noise_along(std::vector<PlaceOnLine> const& places, Vec2 origin,
                                NoiseAlongParams const& params = {}, Run const& run = {});

/// Options of draw_skeleton().
struct DrawSkeletonParams {
    NoiseAlongParams noise; ///< of ridges; its origin is the grid's north-western corner
};

/// A skeleton and the origin of its cells.
struct DrawnSkeleton {
    Skeleton skeleton;
    std::int64_t river_cells = 0;
    std::int64_t ridge_cells = 0;
    std::int64_t point_cells = 0;
    std::int64_t under_rivers = 0; ///< cells of ridges or points that are river cells
    std::int64_t below_river = 0;  ///< ridge cells lower than a river in their 8 neighbours
};

/// Draws ridges and points into the cells that rivers leave free. Ridges run by Bresenham between vertices, with
/// heights linear between vertices, plus noise by the share of the ridge's length.
/// \param valley [m] heights of river cells
/// \param ridges in the grid's coordinates
/// \param points in the grid's coordinates
/// \return river cells bit for bit; else the highest point of a cell; else its highest ridge. Independent of the order
/// of ridges and points.
/// \throws BadInput naming feature and position: outside the grid, without a finite height, in another coordinate
/// system
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite nenu2015, section 3.1 and equation 11 (begun at the height of the ridge's start).
DrawnSkeleton draw_skeleton(Valley const& valley, RidgeLines const& ridges, FeaturePoints const& points,
                            DrawSkeletonParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
