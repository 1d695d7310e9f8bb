// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/medial_lines.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

// CGAL checks the whole diagram at every insertion of a debug build: minutes for a thousand segments.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG
#endif
#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/internal/equidistant.hpp>
#include <thalweg/geometry/internal/finish_diagram.hpp>

namespace thalweg::geometry {
namespace {

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
        if (c.at != drawn[c.line][c.segment] && c.at != drawn[c.line][c.segment + 1]) {
            throw BadInput(
                fmt::format("geometry.medial_lines: line {} meets another at ({:.6f}, {:.6f}), away from its "
                            "vertices; cut the lines where they meet",
                            c.line, c.at.x, c.at.y));
        }
    }
}

/// What can be taken off coordinates between low and high without rounding any of them, and leaves them small.
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

/// The graph, and which site each of its vertices is. The far points follow the sites.
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
