// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

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

/// The land of every stroke: what lies nearer to it than to others, measured by their lengths, and within its reach.
class StrokeLands {
public:
    /// reach: how far the land lies beside a stroke, as a share of its length.
    StrokeLands(std::vector<Stroke> const& strokes, Grid const& grid, double reach)
        : strokes_(strokes), grid_(grid), reach_(reach) {}

    /// Places of a lattice of this width [m] in the land of a stroke.
    std::vector<Vec2> sample(std::size_t stroke, double width_m) const;

    /// [m2] > 0
    double area_m2(std::size_t stroke) const;

    /// [0, 1] share of a stroke's land that lies on its left, looking upstream; a half where there is none.
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

/// Chooses the banks of the trunk's side branches so that the links on either side are in proportion to the land there:
/// the largest branch first, each to the side that lacks the more.
/// Takes: a tree and the share of the land on the left of its trunk, looking upstream, in [0, 1].
/// Gives: the same tree but for the turns of those branches; the links on the left differ from their share of all
/// beside the trunk by at most those of the largest branch or of a branch of its fork. Throws: BadParameter when
/// share_left lies outside.
void balance_banks(TokunagaTree& tree, double share_left);

} // namespace thalweg::network
