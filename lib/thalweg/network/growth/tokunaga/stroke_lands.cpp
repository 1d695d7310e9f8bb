// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/grow_strokes.hpp>

#include <thalweg/geometry/nearby.hpp>

#include <algorithm>
#include <limits>

namespace thalweg::network {

namespace {

constexpr double coarse = 1.0 / 24.0; // of the reach: the lattice that tells areas

/// Whether a place lies to the left of the part of a stroke nearest to it.
bool left_of(Stroke const& stroke, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    bool left = false;
    for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
        Vec2 const a = stroke.line[i];
        Vec2 const b = stroke.line[i + 1];
        if (double const off = distance(p, geometry::foot_on(a, b, p).at); off < least) {
            least = off;
            left = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0.0;
        }
    }
    return left;
}

} // namespace

std::vector<Vec2> StrokeLands::sample(std::size_t stroke, double width_m) const {
    double const far = reach_m(stroke);
    Vec2 low = strokes_[stroke].line.front();
    Vec2 high = low;
    for (Vec2 const p : strokes_[stroke].line) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    low = {std::max(low.x - far, grid_.west), std::max(low.y - far, grid_.south())};
    high = {std::min(high.x + far, grid_.east()), std::min(high.y + far, grid_.north)};
    std::vector<Vec2> places;
    for (double y = low.y + 0.5 * width_m; y < high.y; y += width_m) {
        for (double x = low.x + 0.5 * width_m; x < high.x; x += width_m) {
            if (belongs(stroke, {x, y})) {
                places.push_back({x, y});
            }
        }
    }
    return places;
}

double StrokeLands::area_m2(std::size_t stroke) const {
    double const width = coarse * reach_m(stroke);
    return std::max(1.0, static_cast<double>(sample(stroke, width).size())) * width * width;
}

double StrokeLands::share_left(std::size_t stroke) const {
    std::vector<Vec2> const places = sample(stroke, coarse * reach_m(stroke));
    auto const left =
        std::count_if(places.begin(), places.end(), [&](Vec2 const p) { return left_of(strokes_[stroke], p); });
    return places.empty() ? 0.5 : static_cast<double>(left) / static_cast<double>(places.size());
}

bool StrokeLands::belongs(std::size_t stroke, Vec2 p) const {
    double const own = distance_to(strokes_[stroke], p) / reach_m(stroke);
    if (!(own < 1.0)) {
        return false;
    }
    for (std::size_t k = 0; k < strokes_.size(); ++k) {
        if (k == stroke) {
            continue;
        }
        double const other = distance_to(strokes_[k], p) / reach_m(k);
        if (other < own || (other == own && k < stroke)) {
            return false;
        }
    }
    return true;
}

} // namespace thalweg::network
