// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

// Idea: Points are sorted into square buckets, stored one after another. A query looks at rings of
// buckets around its own and stops as soon as the next ring lies farther than the best point.
// segments_near compares boxes around points with boxes of segments by streamed segment trees, then
// measures.
// Source: ours; CGAL's box intersection (segments_near).
// Cost: O(n) to build; a query O(1) where points lie as densely as buckets are wide, more where
// they cluster. segments_near is O(n + k) for k pairs, but for logarithms. Queries change nothing
// and may run on many threads.
// Not for: points of very uneven density (a tree would do better); distances between segments
// (segment_grid.hpp).
// Example:
//     PointGrid const index(places, 25.0); // about the distance between places
//     std::size_t const nearest = index.nearest({120.0, 80.0});

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
    std::vector<std::size_t> first_; ///< by bucket: position in in_
    std::vector<std::size_t> in_;    ///< numbers of points, bucket by bucket
};

/// A segment of a polyline close to a point.
struct NearSegment {
    std::size_t line = 0;    ///< index of the polyline
    std::size_t segment = 0; ///< between vertices segment and segment + 1

    friend bool operator==(NearSegment const&, NearSegment const&) = default;
};

/// The point of segment ab nearest to p, and its position [0, 1] on the segment.
struct Foot {
    double along = 0.0;
    Vec2 at;
};
Foot foot_on(Vec2 a, Vec2 b, Vec2 p);

/// An index of segments that stay where they are, for many searches.
class SegmentIndex {
public:
    /// \param segments ends [m], finite; they may be points
    explicit SegmentIndex(std::vector<std::pair<Vec2, Vec2>> const& segments);

    /// Finds segments close to one.
    /// \param a,b [m] its ends
    /// \param margin_m [m] >= 0
    /// \return the numbers of all segments within the margin, and of some others, ascending
    std::vector<std::size_t> near(Vec2 a, Vec2 b, double margin_m) const;

private:
    struct Tree;
    std::shared_ptr<Tree const> tree_;
};

/// Tests three successive vertices of a line for a spike.
/// \param before,tip,after positions [m]
/// \param near_m [m] >= 0
/// \return the line turns back at the tip by more than near_m and runs within near_m of itself
bool is_spike(Vec2 before, Vec2 tip, Vec2 after, double near_m);

/// Finds the segments within a distance of every point.
/// \param points [m]
/// \param lines [m]
/// \param distance_m [m] >= 0
/// \return by point, sorted by line and segment
///
/// Source: CGAL, streamed segment trees.
std::vector<std::vector<NearSegment>> segments_near(std::vector<Vec2> const& points,
                                                    std::vector<std::vector<Vec2>> const& lines, double distance_m,
                                                    Run const& run = {});

} // namespace thalweg::geometry
