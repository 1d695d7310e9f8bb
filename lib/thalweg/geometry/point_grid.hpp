// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// A bucket grid of points for nearest-neighbour queries.
class PointGrid {
public:
    /// Sorts points into buckets; these are enlarged if there were more than 2000 along a side.
    /// \param points at least one, finite
    /// \param cell_m [m] > 0, side of a bucket, ideally the distance between points
    PointGrid(std::vector<Vec2> points, double cell_m);

    /// Finds the nearest point.
    /// \param p [m] any position
    /// \return its number, the lowest of several
    std::size_t nearest(Vec2 p) const;

private:
    std::int64_t slot(double along, std::int64_t count) const;
    CellIndex cell(Vec2 p) const;

    std::vector<Vec2> points_;
    Vec2 low_;
    double cell_m_ = 1.0;
    std::int64_t width_ = 1;
    std::int64_t height_ = 1;
    Indexed<CellIndex, std::size_t> first_; ///< by bucket: position in in_
    std::vector<std::size_t> in_;           ///< numbers of points, bucket by bucket
};

} // namespace thalweg::geometry
