// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/simplify.hpp>

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

} // namespace thalweg::geometry
