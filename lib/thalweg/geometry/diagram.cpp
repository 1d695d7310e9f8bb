// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/diagram.hpp>

#include <cmath>
#include <limits>

#include <thalweg/geometry/segments_near.hpp>

namespace thalweg::geometry {

double distance_to(Diagram::Site const& site, Vec2 p) {
    return distance(p, foot_on(site.a, site.b, p).at);
}

Vec2 midway(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 direction) {
    constexpr int most_steps = 20;
    Vec2 best = p;
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
        Vec2 const a = foot_on(s.a, s.b, p).at;
        Vec2 const b = foot_on(t.a, t.b, p).at;
        double const d = distance(p, a);
        double const e = distance(p, b);
        if (!(std::fabs(d - e) < least)) {
            break;
        }
        least = std::fabs(d - e);
        best = p;
        if (!(d > 0.0 && e > 0.0)) {
            break;
        }
        Vec2 const up{(p.x - a.x) / d - (p.x - b.x) / e, (p.y - a.y) / d - (p.y - b.y) / e};
        Vec2 const way = direction == Vec2{} ? up : direction;
        double const share = (e - d) / (up.x * way.x + up.y * way.y);
        p = {p.x + share * way.x, p.y + share * way.y};
    }
    return best;
}

} // namespace thalweg::geometry
