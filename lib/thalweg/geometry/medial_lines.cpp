// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

// In debug builds CGAL checks the whole diagram at every insertion: minutes for a thousand segments.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG
#endif

#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/internal/diagram.hpp>
#include <thalweg/geometry/nearby.hpp>

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

/// Distance to a site's point or line (signed for lines), and its gradient.
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

/// Finds the point on the perpendicular through the end of a segment; other: the third site.
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

/// Midpoint of the shortest connection between two sites that do not cross.
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

/// Makes a guess when there is none: the best candidate between two of the sites, in counterclockwise order.
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

using Doubles = CGAL::Simple_cartesian<double>;
using GraphPoint = Doubles::Point_2;
using Graph =
    CGAL::Segment_Delaunay_graph_2<CGAL::Segment_Delaunay_graph_filtered_traits_without_intersections_2<Doubles>>;

void require_vertices_where_lines_meet(std::vector<LabelledLine> const& lines, Run const& run) {
    std::vector<std::vector<Vec2>> drawn;
    for (auto const& line : lines) {
        drawn.push_back(line.line);
    }
    for (auto const& c : crossings(drawn, run)) {
        refuse_if<BadInput>(
            c.at != drawn[c.line][c.segment] && c.at != drawn[c.line][c.segment + 1], "geometry.medial_lines",
            "line {} meets another at ({:.6f}, {:.6f}), away from its vertices; cut the lines where they meet", c.line,
            c.at.x, c.at.y);
    }
}

/// An offset that can be subtracted from coordinates between low and high without rounding, and makes them small.
double origin_of(double low, double high) {
    double const size = high - low;
    return low >= size ? low : high <= -size ? high : 0.0;
}

struct Origin {
    Vec2 at;
    Vec2 to_local(Vec2 p) const { return p - at; }
    Vec2 to_ground(Vec2 p) const { return p + at; }
    Diagram::Site to_local(Diagram::Site site) const {
        site.a = to_local(site.a);
        site.b = to_local(site.b);
        return site;
    }
};

Origin origin_of(LabelledSites const& sites) {
    auto const [west, east] = std::ranges::minmax(sites.sites, {}, [](auto const& s) { return s.a.x; });
    auto const [south, north] = std::ranges::minmax(sites.sites, {}, [](auto const& s) { return s.a.y; });
    return {{origin_of(west.a.x, east.a.x), origin_of(south.a.y, north.a.y)}};
}

/// The graph, and the site of each of its vertices. The far points follow the sites.
struct Built {
    Graph graph;
    std::map<Graph::Vertex_handle, std::size_t> site_of;
};

void build(Built& built, LabelledSites const& sites, Origin const& origin, Run const& run) {
    using Entry = std::pair<GraphPoint, std::size_t>;
    std::vector<Entry> points;
    auto const local = [&](Vec2 p) {
        Vec2 const q = origin.to_local(p);
        return GraphPoint(q.x, q.y);
    };
    for (std::size_t s = 0; s < sites.points; ++s) {
        points.emplace_back(local(sites.sites[s].a), s);
    }
    std::size_t number = sites.sites.size();
    for (Vec2 const p : sites.far) {
        points.emplace_back(local(p), number++);
    }
    std::vector<Entry> segments;
    for (std::size_t k = 0; k < sites.ends.size(); ++k) {
        segments.emplace_back(local(sites.sites[sites.points + k].a), k);
    }
    using Traits = CGAL::Spatial_sort_traits_adapter_2<Doubles, CGAL::First_of_pair_property_map<Entry>>;
    CGAL::spatial_sort(points.begin(), points.end(), Traits());
    CGAL::spatial_sort(segments.begin(), segments.end(), Traits());

    std::size_t done = 0;
    auto const report = [&] {
        if ((done++ & 0x3ff) == 0) {
            run.at(static_cast<double>(done) / static_cast<double>(points.size() + segments.size()), "ridges");
        }
    };
    std::vector<Graph::Vertex_handle> handles(number);
    Graph::Vertex_handle near;
    for (auto const& [point, s] : points) {
        report();
        near = near == Graph::Vertex_handle() ? built.graph.insert(point) : built.graph.insert(point, near);
        handles[s] = near;
        built.site_of[near] = s;
    }
    for (auto const& [point, k] : segments) {
        report();
        auto const [a, b] = sites.ends[k];
        auto const vertex = built.graph.insert(local(sites.sites[a].a), local(sites.sites[b].a), handles[a]);
        built.site_of[vertex] = sites.points + k;
    }
}

/// The finite faces, sorted by the sites around them.
std::vector<std::pair<Around, Graph::Face_handle>> faces_of(Built const& built) {
    std::vector<std::pair<Around, Graph::Face_handle>> faces;
    for (auto face = built.graph.finite_faces_begin(); face != built.graph.finite_faces_end(); ++face) {
        auto const site = [&](int i) { return built.site_of.at(face->vertex(i)); };
        faces.emplace_back(least_first({site(0), site(1), site(2)}), face);
    }
    std::ranges::sort(faces, {}, [](auto const& f) { return f.first.sites; });
    return faces;
}

RawDiagram raw_of(Built const& built, LabelledSites const& sites, Origin const& origin, Run const& run) {
    Graph const& graph = built.graph;
    auto const site = [&](std::size_t s) {
        bool const far = s >= sites.sites.size();
        Vec2 const p = far ? sites.far[s - sites.sites.size()] : Vec2{};
        return origin.to_local(far ? Diagram::Site{0, 0, p, p} : sites.sites[s]);
    };
    RawDiagram raw;
    std::map<Graph::Face_handle, std::size_t> number_of;
    auto const vertex = graph.geom_traits().construct_svd_vertex_2_object();
    for (auto const& [of, face] : faces_of(built)) {
        if ((raw.at.size() & 0xfff) == 0) {
            run.check();
        }
        int const next = Graph::ccw(of.first);
        GraphPoint const guess =
            vertex(face->vertex(of.first)->site(), face->vertex(next)->site(), face->vertex(Graph::ccw(next))->site());
        Vec2 const at = equidistant({site(of.sites[0]), site(of.sites[1]), site(of.sites[2])}, {guess.x(), guess.y()});
        number_of[face] = raw.at.size();
        raw.at.push_back(origin.to_ground(at));
        raw.sites.push_back(of.sites);
    }
    for (auto edge = graph.finite_edges_begin(); edge != graph.finite_edges_end(); ++edge) {
        auto const [face, i] = *edge;
        auto const here = number_of.find(face);
        auto const beyond = number_of.find(face->neighbor(i));
        if (here != number_of.end() && beyond != number_of.end()) {
            raw.links.push_back({here->second, beyond->second, built.site_of.at(face->vertex(Graph::cw(i))),
                                 built.site_of.at(face->vertex(Graph::ccw(i)))});
        }
    }
    return raw;
}

} // namespace

Vec2 equidistant(std::array<Site, 3> const& sites, Vec2 guess) {
    if (!is_finite(guess)) {
        guess = guessed(sites);
    }
    Vec2 p = guess;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (is_end_of(sites[i], sites[j])) {
                p = on_perpendicular(sites[i].a, sites[j], sites[3 - i - j], guess);
                bool const better = is_finite(p) && spread(sites, p) < spread(sites, guess);
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
    // With the vertex of the parabola above the origin: v = (u^2 + h^2) / 2h.
    Vec2 const along{up.y, -up.x};
    double const reach = std::sqrt(2.0 * height * farthest_m);
    double const first = std::clamp(dot(along, p - point.a), -reach, reach);
    double const last = std::clamp(dot(along, q - point.a), -reach, reach);
    auto const parts =
        static_cast<std::int64_t>(std::ceil(std::fabs(last - first) / std::sqrt(8.0 * height * tolerance_m)));
    std::vector<Vec2> curve;
    for (std::int64_t k = 1; k < parts; ++k) {
        double const u = first + (last - first) * (static_cast<double>(k) / static_cast<double>(parts));
        // Measured from the point, not from the line: rounding u^2 + h^2 would lose detail close to the point.
        double const v = (u * u - height * height) / (2.0 * height);
        curve.push_back(point.a + u * along + v * up);
    }
    return curve;
}

Diagram medial_lines(std::vector<LabelledLine> const& lines, Bounds const& bounds, MedialLinesParams const& params,
                     Run const& run) {
    require_in("geometry.medial_lines", "tolerance_m", params.tolerance_m, Range::above(0.0).or_infinite());
    LabelledSites const sites = sites_of(lines, bounds, Parts::segments, "geometry.medial_lines");
    if (sites.points < 2) {
        return {};
    }
    require_vertices_where_lines_meet(lines, run);
    Origin const origin = origin_of(sites);
    Built built;
    build(built, sites, origin, run);
    RawDiagram raw = raw_of(built, sites, origin, run);
    auto const curve = [&](Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 q) {
        return curve_between(s, t, p, q, params.tolerance_m, 2.0 * sites.size_m);
    };
    return finish(sites, std::move(raw), bounds, curve, run);
}

} // namespace thalweg::geometry
