// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/polylines.hpp>

#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/strategies/strategies.hpp>

namespace thalweg::geometry {

std::vector<Vec2> simplify(std::vector<Vec2> const& line, double tolerance_m) {
    using Place = boost::geometry::model::d2::point_xy<double>;
    boost::geometry::model::linestring<Place> all;
    boost::geometry::model::linestring<Place> few;
    for (Vec2 const p : line) {
        all.emplace_back(p.x, p.y);
    }
    boost::geometry::simplify(all, few, tolerance_m);
    std::vector<Vec2> result;
    for (Place const& p : few) {
        result.push_back({p.x(), p.y()});
    }
    return result;
}

double signed_area(std::vector<Vec2> const& ring) {
    double doubled = 0.0;
    for (std::size_t i = 2; i < ring.size(); ++i) {
        doubled += cross(ring[0], ring[i - 1], ring[i]);
    }
    return 0.5 * doubled;
}

bool contains(std::vector<Vec2> const& ring, Vec2 p) {
    bool inside = false;
    for (std::size_t i = 0, k = ring.size() - 1; i < ring.size(); k = i++) {
        if ((ring[i].y > p.y) != (ring[k].y > p.y) &&
            p.x < ring[i].x + (p.y - ring[i].y) / (ring[k].y - ring[i].y) * (ring[k].x - ring[i].x)) {
            inside = !inside;
        }
    }
    return inside;
}

} // namespace thalweg::geometry
