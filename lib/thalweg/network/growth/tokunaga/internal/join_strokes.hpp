// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>

/// Private to this module.
namespace thalweg::network {

using StrokeId = std::int64_t; ///< place of a stroke in its file; -1 for none

/// A stroke in plan, and where it begins.
struct Stroke {
    std::vector<Vec2> line;   ///< [m] from the mouth upstream
    std::vector<double> way;  ///< [m] along the line to each vertex
    StrokeId onto = -1;       ///< stroke on which it begins, by number; -1 for none
    double onto_way_m = 0.0;  ///< [m] along that stroke
    std::int64_t feature = 0; ///< as the file counts
};

using Strokes = Indexed<StrokeId, Stroke>;

/// Reads strokes as drawn and finds which begins on which.
/// Takes: lines inside the grid. A stroke begins on another when its first vertex lies within half a cell of it: it is
/// moved onto it.
/// Throws: as grow_strokes, for what concerns the strokes alone; Cancelled.
Strokes join_strokes(RiverLines const& strokes, Grid const& grid, Run const& run = {});

/// Strokes by number, each after the one on which it begins; no ring of them.
std::vector<std::size_t> downstream_first(Strokes const& strokes);

/// Distance [m] of a place from a line.
double distance_to(Stroke const& stroke, Vec2 p);

/// The place at a way [m] along a line.
Vec2 place_at(Stroke const& stroke, double way_m);

} // namespace thalweg::network
