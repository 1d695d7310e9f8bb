// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

// Described in docs/algorithms/forest_spreading.md.

namespace thalweg::growth {

using StrokeId = std::int64_t; ///< index of a stroke in its file; -1: none

/// A stroke in plan, and its beginning.
struct Stroke {
    std::vector<Vec2> line;   ///< [m] from the mouth upstream
    std::vector<double> way;  ///< [m] along the line to each vertex
    StrokeId onto = -1;       ///< number of the stroke on which it begins; -1: none
    double onto_way_m = 0.0;  ///< [m] along that stroke
    std::int64_t feature = 0; ///< as numbered by the file
};

using Strokes = std::vector<Stroke>;

/// Reads strokes and finds which begins on which: a stroke whose first vertex is within half a cell of another begins
/// on it and is moved onto it.
/// \param strokes lines inside the grid
/// \param grid any
/// \return by stroke
/// \throws BadInput as grow_strokes, for faults of the strokes themselves
Strokes join_strokes(RiverLines const& strokes, Grid const& grid, Run const& run = {});

/// Strokes by number, each after the one on which it begins; there is no cycle.
std::vector<std::size_t> downstream_first(Strokes const& strokes);

/// Distance [m] of a position from a line.
double distance_to(Stroke const& stroke, Vec2 p);

/// The position at a distance [m] along a line.
Vec2 place_at(Stroke const& stroke, double way_m);

/// The area of every stroke: the cells nearer to it than to others, relative to their lengths, and within its reach.
class StrokeLands {
public:
    /// reach: width of the area beside a stroke, relative to its length.
    StrokeLands(std::vector<Stroke> const& strokes, Grid const& grid, double reach)
        : strokes_(strokes), grid_(grid), reach_(reach) {}

    /// Nodes of a lattice of this spacing [m] in the area of a stroke.
    std::vector<Vec2> sample(std::size_t stroke, double width_m) const;

    /// [m2] > 0
    double area_m2(std::size_t stroke) const;

    /// [0, 1] share of a stroke's area on its left, looking upstream; 0.5: no area.
    double share_left(std::size_t stroke) const;

private:
    double reach_m(std::size_t stroke) const { return reach_ * strokes_[stroke].way.back(); }
    bool belongs(std::size_t stroke, Vec2 p) const;

    std::vector<Stroke> const& strokes_;
    Grid const& grid_;
    double reach_;
};

/// Links of the stream that runs from the outlet to its fork or source, by number, upstream.
std::vector<std::size_t> trunk_of(TokunagaTree const& tree);

/// Chooses the banks of the trunk's side branches so that the numbers of links on either side are proportional to the
/// areas there: the largest branch first, each to the side with the larger deficit.
/// \param tree only the turns of those branches change; the links on the left differ from their share of all beside the
/// trunk by at most those of the largest branch or of a branch of its fork
/// \param share_left [0, 1] share of the area on the left of the trunk, looking upstream
/// \throws BadParameter when share_left is outside its range
void balance_banks(TokunagaTree& tree, double share_left);

} // namespace thalweg::growth
