// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/internal/equidistant.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <thalweg/geometry/segments_near.hpp>

namespace thalweg::geometry {
namespace {

using Site = Diagram::Site;

constexpr int most_steps = 40;

bool is_point(Site const& s) {
    return s.a == s.b;
}

bool is_end_of(Site const& point, Site const& segment) {
    return is_point(point) && !is_point(segment) && (point.a == segment.a || point.a == segment.b);
}

Vec2 normal_of(Site const& segment) {
    Vec2 const d = segment.b - segment.a;
    double const l = norm(d);
    return {-d.y / l, d.x / l};
}

/// Distance to a site's point or line, on the side given for lines, and its gradient.
struct Slope {
    double distance = 0.0;
    Vec2 up;
};

Slope slope_at(Site const& s, double side, Vec2 p) {
    Vec2 const from = p - s.a;
    if (is_point(s)) {
        double const d = norm(from);
        return {d, d > 0.0 ? (1.0 / d) * from : Vec2{}};
    }
    Vec2 const up = side * normal_of(s);
    return {dot(up, from), up};
}

double side_of(Site const& s, Vec2 p) {
    return !is_point(s) && dot(normal_of(s), p - s.a) < 0.0 ? -1.0 : 1.0;
}

double spread(std::array<Site, 3> const& sites, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (Site const& s : sites) {
        double const d = distance_to(s, p);
        least = std::min(least, d);
        most = std::max(most, d);
    }
    return most - least;
}

/// On the perpendicular through the end of a segment; other: the third site.
Vec2 on_perpendicular(Vec2 end, Site const& segment, Site const& other, Vec2 guess) {
    if (is_end_of({0, 0, end, end}, other)) {
        return end;
    }
    Vec2 n = normal_of(segment);
    if (dot(n, guess - end) < 0.0) {
        n = -1.0 * n;
    }
    if (is_point(other)) {
        Vec2 const there = other.a - end;
        return end + (dot(there, there) / (2.0 * dot(n, there))) * n;
    }
    Vec2 const up = side_of(other, end) * normal_of(other);
    return end + (dot(up, end - other.a) / (1.0 - dot(up, n))) * n;
}

Vec2 by_newton(std::array<Site, 3> const& sites, Vec2 p) {
    std::array<double, 3> sides{};
    std::transform(sites.begin(), sites.end(), sides.begin(), [&](Site const& s) { return side_of(s, p); });
    Vec2 best = p;
    double least = spread(sites, p);
    for (int step = 0; step < most_steps && least > 0.0; ++step) {
        Slope const a = slope_at(sites[0], sides[0], p);
        Slope const b = slope_at(sites[1], sides[1], p);
        Slope const c = slope_at(sites[2], sides[2], p);
        Vec2 const j = a.up - b.up;
        Vec2 const k = a.up - c.up;
        double const f = a.distance - b.distance;
        double const g = a.distance - c.distance;
        double const area = j.x * k.y - j.y * k.x;
        if (area == 0.0) {
            break;
        }
        p = p - Vec2{(f * k.y - g * j.y) / area, (g * j.x - f * k.x) / area};
        double const now = spread(sites, p);
        if (!(now < least)) {
            break;
        }
        least = now;
        best = p;
    }
    return best;
}

/// The middle of the shortest way between two sites that do not cross.
Vec2 middle_between(Site const& s, Site const& t) {
    Vec2 middle;
    double least = std::numeric_limits<double>::infinity();
    auto const look = [&](Vec2 p, Site const& other) {
        Vec2 const foot = foot_on(other.a, other.b, p).at;
        if (double const d = distance(p, foot); d < least) {
            least = d;
            middle = 0.5 * (p + foot);
        }
    };
    for (auto const& [from, to] : {std::pair(&s, &t), std::pair(&t, &s)}) {
        look(from->a, *to);
        look(from->b, *to);
    }
    return middle;
}

/// A guess where there is none: the best that is found from between two of the sites, seen counterclockwise.
Vec2 guessed(std::array<Site, 3> const& sites) {
    Vec2 best = middle_between(sites[0], sites[1]);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        Vec2 const p = by_newton(sites, middle_between(sites[i], sites[(i + 1) % 3]));
        std::array<Vec2, 3> feet;
        std::ranges::transform(sites, feet.begin(), [&](Site const& s) { return foot_on(s.a, s.b, p).at; });
        Vec2 const u = feet[1] - feet[0];
        Vec2 const v = feet[2] - feet[0];
        bool const clockwise = u.x * v.y - u.y * v.x < -1e-9 * (dot(u, u) + dot(v, v));
        if (double const off = spread(sites, p); !clockwise && off < least) {
            least = off;
            best = p;
        }
    }
    return best;
}

} // namespace

Vec2 equidistant(std::array<Site, 3> const& sites, Vec2 guess) {
    if (!std::isfinite(guess.x) || !std::isfinite(guess.y)) {
        guess = guessed(sites);
    }
    Vec2 p = guess;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (is_end_of(sites[i], sites[j])) {
                p = on_perpendicular(sites[i].a, sites[j], sites[3 - i - j], guess);
                bool const better = std::isfinite(p.x) && std::isfinite(p.y) && spread(sites, p) < spread(sites, guess);
                return better ? p : guess;
            }
        }
    }
    return by_newton(sites, guess);
}

std::vector<Vec2> curve_between(Site const& s, Site const& t, Vec2 p, Vec2 q, double tolerance_m, double farthest_m) {
    if (is_point(s) == is_point(t)) {
        return {};
    }
    Site const& point = is_point(s) ? s : t;
    Site const& line = is_point(s) ? t : s;
    Vec2 up = normal_of(line);
    double height = dot(up, point.a - line.a);
    if (height < 0.0) {
        up = -1.0 * up;
        height = -height;
    }
    if (!(height > 0.0)) {
        return {};
    }
    // With the vertex of the parabola over the origin: v = (u^2 + h^2) / 2h.
    Vec2 const along{up.y, -up.x};
    double const reach = std::sqrt(2.0 * height * farthest_m);
    double const first = std::clamp(dot(along, p - point.a), -reach, reach);
    double const last = std::clamp(dot(along, q - point.a), -reach, reach);
    auto const parts =
        static_cast<std::int64_t>(std::ceil(std::fabs(last - first) / std::sqrt(8.0 * height * tolerance_m)));
    std::vector<Vec2> curve;
    for (std::int64_t k = 1; k < parts; ++k) {
        double const u = first + (last - first) * (static_cast<double>(k) / static_cast<double>(parts));
        // From the point, not from the line: the sum of u^2 and h^2 would round what lies close to the point.
        double const v = (u * u - height * height) / (2.0 * height);
        curve.push_back(point.a + u * along + v * up);
    }
    return curve;
}

} // namespace thalweg::geometry
