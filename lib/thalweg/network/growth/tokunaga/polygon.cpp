// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::network {

namespace {

/// Twice the signed area, about the first vertex, so that far-off coordinates lose no digits.
double doubled_area(Vec2 o, Vec2 a, Vec2 b) {
    return (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
}

} // namespace

double area_of(std::vector<Vec2> const& ring) {
    double sum = 0.0;
    for (std::size_t i = 2; i < ring.size(); ++i) {
        sum += doubled_area(ring[0], ring[i - 1], ring[i]);
    }
    return std::fabs(0.5 * sum);
}

Vec2 centroid_of(std::vector<Vec2> const& ring) {
    double sum = 0.0;
    double x = 0.0;
    double y = 0.0;
    for (std::size_t i = 2; i < ring.size(); ++i) {
        double const area = doubled_area(ring[0], ring[i - 1], ring[i]);
        sum += area;
        x += area * (ring[i - 1].x + ring[i].x - 2.0 * ring[0].x);
        y += area * (ring[i - 1].y + ring[i].y - 2.0 * ring[0].y);
    }
    return {ring[0].x + x / (3.0 * sum), ring[0].y + y / (3.0 * sum)};
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

std::vector<Segment> sides_of(std::vector<Vec2> const& ring) {
    std::vector<Segment> sides;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        sides.push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
    return sides;
}

std::vector<Vec2> lattice_in(std::vector<Vec2> const& ring, double width_m) {
    std::vector<Vec2> places;
    auto const [low, high] = std::minmax_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
    double const west = std::min_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; })->x;
    std::vector<double> cuts;
    for (double k = 0.5; low->y + k * width_m < high->y; k += 1.0) {
        double const y = low->y + k * width_m;
        cuts.clear();
        for (Segment const& s : sides_of(ring)) {
            if ((s.a.y > y) != (s.b.y > y)) {
                cuts.push_back(s.a.x + (y - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x));
            }
        }
        std::sort(cuts.begin(), cuts.end());
        for (std::size_t c = 1; c < cuts.size(); c += 2) {
            for (double m = std::ceil((cuts[c - 1] - west) / width_m - 0.5) + 0.5; west + m * width_m < cuts[c];
                 m += 1.0) {
                places.push_back({west + m * width_m, y});
            }
        }
    }
    return places;
}

} // namespace thalweg::network
