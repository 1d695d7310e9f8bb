// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::skeleton {

/// Options of ridges().
struct RidgesParams {
    /// What ridges lie midway between: points set along the rivers, or the rivers themselves.
    enum class Method : std::uint8_t { voronoi, segments };
    Method method = Method::voronoi;
    double gain = 0.3;        ///< [m/m] >= 0, lambda: height of a ridge above its rivers by distance from them
    double farthest_m = 0.0;  ///< [m] >= 0, no ridge rises more than one so far away; 0: no bound
    double spacing_m = 0.0;   ///< [m] >= 0, of the points along rivers (voronoi); 0: a cell
    double tolerance_m = 0.0; ///< [m] >= 0, how far chords may leave a ridge's curve (segments); 0: a tenth of a cell
    double clear_m = 0.0;     ///< [m] >= 0, what comes nearer to its rivers is left out; 0: half a cell
};

/// Ridges midway between streams, as high as the rivers beside them and more with distance.
/// \pre a label for every arc, the stream it belongs to; the grid whose ground bounds the ridges.
/// \param network the network
/// \param stream_of_arc by arc, the stream it belongs to
/// \param grid the grid
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return lines inside the grid between streams whose labels differ; none meets a river; they meet only in their ends,
/// where three streams are equally far or the ground ends. Each vertex stands at max z + gain d over the places of
/// rivers nearest to it, d away. left < right; sorted by left, right and place. None for fewer than two labels.
/// \throws BadParameter
/// \throws BadInput when labels or heights are not the network's, or (segments) arcs meet away from their vertices
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 3.1 and equation 10; specification 3.4.
RidgeLines ridges(ElevatedNetwork const& network, std::vector<std::int64_t> const& stream_of_arc, Grid const& grid,
                  RidgesParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
