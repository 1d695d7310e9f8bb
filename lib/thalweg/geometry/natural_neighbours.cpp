// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/natural_neighbours.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/natural_neighbor_coordinates_2.h>

#include <thalweg/geometry/triangulate.hpp>

namespace thalweg::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using HeightVertices = CGAL::Triangulation_vertex_base_with_info_2<double, Kernel>;
using HeightMesh = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<HeightVertices>>;
using Share = std::pair<HeightMesh::Vertex_handle, double>;

struct Itself {
    using argument_type = Share;
    using result_type = Share;
    Share operator()(Share const& share) const { return share; }
};

// triangulate() has checked the points and removed duplicates; this rebuilds its triangles in CGAL.
HeightMesh mesh_of(Tin const& tin) {
    std::vector<std::pair<Point, double>> entries;
    entries.reserve(tin.vertices.size());
    for (Vec3 const& v : tin.vertices) {
        entries.emplace_back(Point(v.x, v.y), v.z);
    }
    HeightMesh mesh;
    mesh.insert(entries.begin(), entries.end());
    return mesh;
}

} // namespace

Raster<float> natural_neighbours(std::vector<Vec3> const& points, Grid const& grid,
                                 NaturalNeighboursParams const& params, Run const& run) {
    HeightMesh const mesh = mesh_of(triangulate(points, {}, run).tin);
    bool const extend = params.outside == NaturalNeighboursParams::Outside::nearest;
    Raster<float> dem(grid, std::numeric_limits<float>::quiet_NaN());
    parallel_ranges(run, grid.height, 1, [&](std::int64_t begin, std::int64_t end) {
        std::vector<Share> shares;
        for (std::int64_t row = begin; row < end; ++row) {
            run.check();
            // Every row starts its walk at the same face, so that results do not depend on which thread computed the
            // row before.
            HeightMesh::Face_handle near = mesh.infinite_face();
            for (std::int64_t col = 0; col < grid.width; ++col) {
                Vec2 const at = grid.centre({col, row});
                Point const p(at.x, at.y);
                near = mesh.locate(p, near);
                shares.clear();
                auto const [out, sum, found] =
                    CGAL::natural_neighbor_coordinates_2(mesh, p, std::back_inserter(shares), Itself{}, near);
                if (!found || !(sum > 0.0)) {
                    if (extend || found) {
                        dem[Cell{col, row}] = static_cast<float>(mesh.nearest_vertex(p, near)->info());
                    }
                    continue;
                }
                double z = 0.0;
                double lowest = std::numeric_limits<double>::infinity();
                double highest = -lowest;
                for (auto const& [vertex, area] : shares) {
                    z += area / sum * vertex->info();
                    lowest = std::min(lowest, vertex->info());
                    highest = std::max(highest, vertex->info());
                }
                dem[Cell{col, row}] = static_cast<float>(std::clamp(z, lowest, highest));
            }
        }
    });
    return dem;
}

} // namespace thalweg::geometry
