// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

/// Which segments of polylines can meet at all. Private to this module.
namespace thalweg::geometry {

/// A segment of a polyline: between vertices segment and segment + 1.
struct LineSegment {
    std::uint32_t line = 0;
    std::uint32_t segment = 0;
};

/// Calls visit once for every two segments whose boxes meet, in no order that means something.
/// Takes: polylines of finite coordinates, fewer than 2^32, of fewer than 2^32 vertices. A segment without length is
/// passed over, but for the first of a polyline that is one repeated point.
/// Throws: BadInput when a coordinate is not finite; Cancelled. Source: Zomorodian and Edelsbrunner 2000 (CGAL).
void each_close_pair(std::vector<std::vector<Vec2>> const& lines,
                     std::function<void(LineSegment, LineSegment)> const& visit, Run const& run = {});

} // namespace thalweg::geometry
