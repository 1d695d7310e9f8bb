// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangulate.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>
#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/triangles.hpp>

namespace thalweg::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Vertices = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Free = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertices>>;
// crossings() has already cut the lines: CGAL need not construct points, and throws if one were missing.
using Bound = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<Vertices, CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();
constexpr double farthest_m = 1e15;

// All candidate vertices (points, line vertices, then those added at crossings), and the lines by index into them.
struct Places {
    std::vector<Vec3> at;
    std::size_t points = 0;
    std::size_t given = 0; // number before the added ones
    std::vector<std::vector<std::uint32_t>> lines;
};

// name: called only for the message.
template <class Name> void require_finite(Vec3 const& p, Name name) {
    if (!is_finite(p)) {
        throw BadInput("geometry.triangulate",
                       fmt::format("{} is not finite: ({}, {}, {}); remove it", name(), p.x, p.y, p.z));
    }
    if (std::fabs(p.x) > farthest_m || std::fabs(p.y) > farthest_m) {
        throw BadInput("geometry.triangulate",
                       fmt::format("{} lies at ({}, {}), farther than {} m", name(), p.x, p.y, farthest_m));
    }
}

Places collect(std::vector<Vec3> const& points, std::vector<std::vector<Vec3>> const& breaklines) {
    Places places;
    places.points = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        require_finite(points[i], [&] { return fmt::format("point {}", i + 1); });
    }
    places.at = points;
    for (std::size_t l = 0; l < breaklines.size(); ++l) {
        auto& line = places.lines.emplace_back();
        for (std::size_t i = 0; i < breaklines[l].size(); ++i) {
            require_finite(breaklines[l][i], [&] { return fmt::format("vertex {} of breakline {}", i + 1, l + 1); });
            line.push_back(static_cast<std::uint32_t>(places.at.size()));
            places.at.push_back(breaklines[l][i]);
        }
    }
    refuse_if<BadInput>(places.at.size() >= unnumbered / 2, "geometry.triangulate",
                        "{} points are more than a TIN can number", places.at.size());
    places.given = places.at.size();
    return places;
}

std::vector<std::vector<Vec2>> plans(Places const& places) {
    std::vector<std::vector<Vec2>> lines;
    for (auto const& line : places.lines) {
        auto& drawn = lines.emplace_back();
        for (std::uint32_t const p : line) {
            drawn.push_back(in_plan(places.at[p]));
        }
    }
    return lines;
}

// Cuts the lines where they meet away from their vertices.
// \return true: any line was cut
bool cut(Places& places, double& greatest_dz_m, Run const& run) {
    auto const drawn = plans(places);
    auto const found = crossings(drawn, run);
    std::map<std::pair<double, double>, std::uint32_t> added;
    std::vector<std::vector<std::uint32_t>> lines(places.lines.size());
    bool any = false;
    auto next = found.begin();
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& line = places.lines[l];
        for (std::size_t i = 0; i < line.size(); ++i) {
            lines[l].push_back(line[i]);
            for (; next != found.end() && next->line == l && next->segment == i; ++next) {
                Vec2 const at = next->at;
                if (at == drawn[l][i] || at == drawn[l][i + 1] || at == in_plan(places.at[lines[l].back()])) {
                    continue;
                }
                Vec3 const a = places.at[line[i]];
                Vec3 const b = places.at[line[i + 1]];
                double const z = a.z + next->along * (b.z - a.z);
                auto const [place, is_new] =
                    added.try_emplace({at.x, at.y}, static_cast<std::uint32_t>(places.at.size()));
                if (is_new) {
                    places.at.push_back({at.x, at.y, z});
                } else {
                    greatest_dz_m = std::max(greatest_dz_m, std::fabs(z - places.at[place->second].z));
                }
                lines[l].push_back(place->second);
                any = true;
            }
        }
    }
    places.lines = std::move(lines);
    return any;
}

// Rounding a crossing bends its lines by less than an ulp, now and then across another line: repeat.
void cut_all(Places& places, double& greatest_dz_m, Run const& run) {
    constexpr int most_rounds = 50;
    for (int round = 0; cut(places, greatest_dz_m, run); ++round) {
        refuse_if<BadInput>(round == most_rounds, "geometry.triangulate",
                            "breaklines still cross after being cut 50 times: they lie closer than their coordinates "
                            "can tell; snap them");
    }
}

template <class Mesh>
std::vector<typename Mesh::Vertex_handle> insert(Mesh& mesh, Places const& places, Run const& run) {
    using Entry = std::pair<Point, std::uint32_t>;
    std::vector<Entry> entries;
    entries.reserve(places.at.size());
    for (Vec3 const& p : places.at) {
        entries.emplace_back(Point(p.x, p.y), static_cast<std::uint32_t>(entries.size()));
    }
    CGAL::spatial_sort(entries.begin(), entries.end(),
                       CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<Entry>>());
    std::vector<typename Mesh::Vertex_handle> handles(entries.size());
    typename Mesh::Face_handle hint;
    std::int64_t done = 0;
    for (auto const& [point, place] : entries) {
        if ((done++ & 0x3fff) == 0) {
            run.at(static_cast<double>(done) / static_cast<double>(entries.size()), "tin");
        }
        auto const vertex = mesh.insert(point, hint);
        vertex->info() = unnumbered;
        handles[place] = vertex;
        hint = vertex->face();
    }
    return handles;
}

template <class Mesh> void require_area(Mesh const& mesh, Places const& places) {
    if (mesh.dimension() == 2) {
        return;
    }
    auto const differ = mesh.number_of_vertices();
    refuse_if<BadInput>(differ < 3, "geometry.triangulate", "{} points in {} different places: a triangulation takes 3",
                        places.at.size(), differ);
    auto const [first, last] =
        std::ranges::minmax_element(places.at, {}, [](Vec3 const& p) { return std::pair(p.x, p.y); });
    throw BadInput("geometry.triangulate",
                   fmt::format("{} points lie on one line, from ({}, {}) to ({}, {}): there are no triangles", differ,
                               first->x, first->y, last->x, last->y));
}

template <class Mesh>
void number(Places const& places, std::vector<typename Mesh::Vertex_handle> const& handles, Triangulation& result) {
    for (std::size_t i = 0; i < places.at.size(); ++i) {
        auto& vertex = handles[i]->info();
        if (vertex == unnumbered) {
            vertex = static_cast<std::uint32_t>(result.tin.vertices.size());
            result.tin.vertices.push_back(places.at[i]);
            result.crossings += i >= places.given ? 1 : 0;
        } else if (i < places.given) {
            ++result.merged;
            result.merged_dz_m =
                std::max(result.merged_dz_m, std::fabs(places.at[i].z - result.tin.vertices[vertex].z));
        }
        if (i < places.points) {
            result.vertex_of_point.push_back(vertex);
        }
    }
}

template <class Mesh> void take_triangles(Mesh const& mesh, Tin& tin) {
    tin.triangles.reserve(mesh.number_of_faces());
    for (auto const face : mesh.finite_face_handles()) {
        tin.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    put_in_order(tin);
}

bool is_between(Point const& a, Point const& b, Point const& p) {
    return CGAL::collinear_are_strictly_ordered_along_line(a, p, b);
}

// The vertices along the constraint between two vertices, including others that lie on it.
std::vector<std::uint32_t> chain_of(Bound const& mesh, Bound::Vertex_handle from, Bound::Vertex_handle to) {
    std::vector<std::uint32_t> chain;
    while (!mesh.is_edge(from, to)) {
        auto next = mesh.incident_vertices(from);
        auto const first = next;
        bool found = false;
        do {
            found = !mesh.is_infinite(next) &&
                    CGAL::orientation(from->point(), to->point(), next->point()) == CGAL::COLLINEAR &&
                    is_between(from->point(), to->point(), next->point());
        } while (!found && ++next != first);
        if (!found) {
            throw BadInput("geometry.triangulate",
                           fmt::format("no edges from ({}, {}) to ({}, {}): breaklines lie closer than their "
                                       "coordinates can tell; snap them",
                                       from->point().x(), from->point().y(), to->point().x(), to->point().y()));
        }
        from = next;
        chain.push_back(from->info());
    }
    chain.push_back(to->info());
    return chain;
}

void take_chains(Bound const& mesh, Places const& places, std::vector<Bound::Vertex_handle> const& handles,
                 Triangulation& result) {
    for (auto const& line : places.lines) {
        auto& chain = result.chains.emplace_back();
        for (std::size_t i = 0; i < line.size(); ++i) {
            auto const vertex = handles[line[i]];
            if (chain.empty()) {
                chain.push_back(vertex->info());
            } else if (auto const before = handles[line[i - 1]]; before != vertex) {
                auto const more = chain_of(mesh, before, vertex);
                chain.insert(chain.end(), more.begin(), more.end());
            }
        }
    }
}

} // namespace

Triangulation triangulate(std::vector<Vec3> const& points, std::vector<std::vector<Vec3>> const& breaklines,
                          Run const& run) {
    Triangulation result;
    Places places = collect(points, breaklines);
    if (breaklines.empty()) {
        Free mesh;
        auto const handles = insert(mesh, places, run);
        require_area(mesh, places);
        number<Free>(places, handles, result);
        take_triangles(mesh, result.tin);
        return result;
    }
    cut_all(places, result.crossings_dz_m, run);
    Bound mesh;
    auto const handles = insert(mesh, places, run);
    require_area(mesh, places);
    for (auto const& line : places.lines) {
        run.check();
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (handles[line[i - 1]] != handles[line[i]]) {
                mesh.insert_constraint(handles[line[i - 1]], handles[line[i]]);
            }
        }
    }
    number<Bound>(places, handles, result);
    take_triangles(mesh, result.tin);
    take_chains(mesh, places, handles, result);
    return result;
}

} // namespace thalweg::geometry
