// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::skeleton {

/// Options of ridges().
struct RidgesParams {
    /// The sites of the Voronoi diagram: points along rivers, or the rivers' segments.
    enum class Method : std::uint8_t { voronoi, segments };
    Method method = Method::voronoi;
    double gain = 0.3;       ///< [m/m] >= 0, lambda: rise of a ridge above its rivers per distance
    double farthest_m = 0.0; ///< [m] >= 0, distance beyond which ridges do not rise; 0: none
    double spacing_m = 0.0;  ///< [m] >= 0, of points along rivers (voronoi); 0: one cell
    /// [m] >= 0, largest distance of chords from a ridge's curve (segments); 0: a tenth of a cell
    double tolerance_m = 0.0;
    double clear_m = 0.0; ///< [m] >= 0, parts closer to their rivers are left out; 0: half a cell
};

/// Builds ridges midway between streams, which rise with distance from them.
/// \param network the rivers, with heights
/// \param stream_of_arc by arc: label of its stream
/// \param grid bounds the ridges
/// \return lines inside the grid between streams of different labels. No ridge meets a river; ridges meet only at their
/// ends, where three streams are equally far or the grid ends. A vertex has the height max z + gain d over the nearest
/// river points, at distance d. left < right; sorted by left, right and position; empty for fewer than two labels.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when labels or heights are not the network's, or (segments) arcs meet away from their vertices
///
/// Source: \cite nenu2015, section 3.1 and equation 10; specification 3.4.
RidgeLines ridges(ElevatedNetwork const& network, std::vector<std::int64_t> const& stream_of_arc, Grid const& grid,
                  RidgesParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
