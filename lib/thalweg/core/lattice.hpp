// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Heights at the vertices of a rectangular mesh, as game engines, viewers and printers take them.
struct Lattice {
    /// [m] by vertex, row by row from the north-west; NaN: no data. The vertices of a row are the centres of the grid's
    /// cells; rows are row_step_m apart, the first at the grid's first row.
    Raster<float> z;
    double row_step_m = 1.0;

    /// \return [m] position of the first vertex
    Vec2 north_west() const { return z.grid().centre({0, 0}); }
    /// \return [m] from the first vertex to the last: eastwards and southwards
    Vec2 extent_m() const {
        return {static_cast<double>(z.width() - 1) * z.grid().cell_m, static_cast<double>(z.height() - 1) * row_step_m};
    }
};

/// Resamples a DEM to a lattice whose corners are the centres of the DEM's corner cells. Along an axis that becomes
/// finer, a vertex gets the cubic convolution of four cells, not beyond the lowest and highest of those beside it;
/// along one that becomes coarser, the mean of the linear interpolant over one step, at the edge over none. Planes and
/// the corners keep their heights. A vertex nearest to a cell without data has none; cells without data beside others
/// do not count.
/// \param dem [m] by cell, at least 2 x 2; NaN: no data
/// \param width,height [2, 16385] vertices
/// \return bit for bit the DEM if it has as many cells
/// \throws BadParameter for other numbers of vertices
/// \throws BadInput when the DEM has a single row or column
///
/// Source: \cite keys1981.
Lattice lattice(Raster<float> const& dem, std::int64_t width, std::int64_t height, Run const& run = {});

/// A mesh in a frame of its own: x eastwards, y northwards from the middle of the lattice, z upwards from its lowest
/// height. Triangles are counterclockwise from outside.
struct LatticeMesh {
    std::vector<Vec3> vertices; ///< [m]
    /// by vertex: [0, 1] place in a picture of the lattice, x from the west, y from the north; empty for a solid
    std::vector<Vec2> places;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Vec3 origin; ///< [m] of its frame, in the lattice's CRS
};

/// Makes a mesh of a lattice: two triangles between four vertices with heights, cut along the diagonal whose ends
/// differ less in height, one between three.
/// \param lattice at least one triangle
/// \param exaggeration > 0, factor of heights
/// \return vertices that belong to a triangle, in the lattice's order
/// \throws BadInput when there is no triangle
LatticeMesh surface_mesh(Lattice const& lattice, double exaggeration = 1.0, Run const& run = {});

/// Finds the height of a lattice's surface_mesh, without exaggeration.
/// \param lattice at least 2 x 2 vertices
/// \param position [m] in the lattice's CRS
/// \return [m] NaN: there is no triangle
double height_on_mesh(Lattice const& lattice, Vec2 position);

/// Makes a solid of a lattice: its surface, four walls and a flat base. Every edge belongs to two triangles, which run
/// through it in opposite directions.
/// \param lattice a height at every vertex
/// \param base_m [m] > 0, thickness below the lowest height, before exaggeration
/// \param exaggeration > 0, factor of heights
/// \return the surface's vertices first
/// \throws BadInput naming a vertex without height
LatticeMesh solid_mesh(Lattice const& lattice, double base_m, double exaggeration = 1.0, Run const& run = {});

} // namespace thalweg
