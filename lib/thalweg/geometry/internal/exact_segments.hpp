// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>

/// Two segments, exactly. Private to this module.
namespace thalweg::geometry {

/// How two segments of some length meet.
struct SegmentMeeting {
    enum class Kind {
        none,
        vertex, ///< in a point that is an end of one of them
        proper, ///< in a point inside both
        stretch ///< in more than a point
    };
    Kind kind = Kind::none;
    Vec2 first; ///< the end they meet in; of a stretch the end of lesser x, then y. Not set where proper
    Vec2 last;  ///< the other end of a stretch, else first
};

/// Where the segments ab and cd meet: exact, and without rational arithmetic.
SegmentMeeting meeting_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// The point in which ab and cd, which cross properly, do so, and its place [0,1] on each: exact and rounded once.
struct ProperCrossing {
    Vec2 at;
    double on_ab = 0.0;
    double on_cd = 0.0;
};
ProperCrossing crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d);

/// Place [0,1] on ab of a point that lies on it, exact and rounded once.
double place_on(Vec2 a, Vec2 b, Vec2 p);

} // namespace thalweg::geometry
