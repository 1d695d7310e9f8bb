// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/voronoi.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <thalweg/geometry/internal/finish_diagram.hpp>

namespace thalweg::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using LabelMesh = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>,
                                                 CGAL::Triangulation_face_base_with_info_2<std::size_t, Kernel>>>;

LabelMesh mesh_of(LabelledSites const& sites, Run const& run) {
    using Entry = std::pair<Point, std::size_t>;
    std::vector<Entry> entries;
    for (auto const& site : sites.sites) {
        entries.emplace_back(Point(site.a.x, site.a.y), entries.size());
    }
    for (Vec2 const p : sites.far) {
        entries.emplace_back(Point(p.x, p.y), entries.size());
    }
    CGAL::spatial_sort(entries.begin(), entries.end(),
                       CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<Entry>>());
    LabelMesh mesh;
    LabelMesh::Face_handle hint;
    std::size_t done = 0;
    for (auto const& [point, site] : entries) {
        if ((done++ & 0x3fff) == 0) {
            run.at(static_cast<double>(done) / static_cast<double>(entries.size()), "ridges");
        }
        auto const vertex = mesh.insert(point, hint);
        vertex->info() = site;
        hint = vertex->face();
    }
    return mesh;
}

/// The finite faces, sorted by the sites around them.
std::vector<std::pair<Around, LabelMesh::Face_handle>> faces_of(LabelMesh const& mesh) {
    std::vector<std::pair<Around, LabelMesh::Face_handle>> faces;
    for (auto const face : mesh.finite_face_handles()) {
        auto const site = [&](int i) { return face->vertex(i)->info(); };
        faces.emplace_back(least_first({site(0), site(1), site(2)}), face);
    }
    std::ranges::sort(faces, {}, [](auto const& f) { return f.first.sites; });
    return faces;
}

} // namespace

Diagram voronoi(std::vector<LabelledLine> const& lines, Bounds const& bounds, Run const& run) {
    LabelledSites const sites = sites_of(lines, bounds, Parts::vertices, "geometry.voronoi");
    if (sites.points < 2) {
        return {};
    }
    LabelMesh const mesh = mesh_of(sites, run);
    RawDiagram raw;
    for (auto const& [around, face] : faces_of(mesh)) {
        face->info() = raw.at.size();
        int const next = LabelMesh::ccw(around.first);
        Point const at = CGAL::circumcenter(face->vertex(around.first)->point(), face->vertex(next)->point(),
                                            face->vertex(LabelMesh::ccw(next))->point());
        raw.at.push_back({at.x(), at.y()});
        raw.sites.push_back(around.sites);
    }
    for (auto const& [face, i] : mesh.finite_edges()) {
        auto const beyond = face->neighbor(i);
        if (!mesh.is_infinite(face) && !mesh.is_infinite(beyond)) {
            raw.links.push_back({face->info(), beyond->info(), face->vertex(LabelMesh::cw(i))->info(),
                                 face->vertex(LabelMesh::ccw(i))->info()});
        }
    }
    return finish(
        sites, std::move(raw), bounds, [](auto const&, auto const&, Vec2, Vec2) { return std::vector<Vec2>{}; }, run);
}

} // namespace thalweg::geometry
