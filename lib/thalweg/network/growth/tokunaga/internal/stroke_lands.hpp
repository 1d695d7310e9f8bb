// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/growth/tokunaga/internal/grow_strokes.hpp>

/// Private to this module.
namespace thalweg::network {

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

} // namespace thalweg::network
