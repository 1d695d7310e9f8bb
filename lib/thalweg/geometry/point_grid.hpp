// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Points by the cells of a grid they lie in, to find the one nearest to a place.
class PointGrid {
public:
    /// \pre one finite point at least; the side of a cell, > 0, best about the distance between points. Cells are made
    /// larger where there would be more than 2000 along a side.
    /// \param points the points
    /// \param cell_m [m] > 0, side of a cell
    PointGrid(std::vector<Vec2> points, double cell_m);

    /// \param p [m] a position
    /// \return the number of the point nearest to a place anywhere, the lowest among equals.
    std::size_t nearest(Vec2 p) const;

private:
    std::int64_t slot(double along, std::int64_t count) const;
    CellIndex cell(Vec2 p) const;

    std::vector<Vec2> points_;
    Vec2 low_;
    double cell_m_ = 1.0;
    std::int64_t width_ = 1;
    std::int64_t height_ = 1;
    Indexed<CellIndex, std::size_t> first_; ///< of each cell, in in_
    std::vector<std::size_t> in_;           ///< numbers of points, cell by cell
};

} // namespace thalweg::geometry
