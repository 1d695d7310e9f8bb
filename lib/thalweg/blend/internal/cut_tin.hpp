// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::blend {

/// Makes the triangles of a mesh counterclockwise in plan, by turning all of them over if all are clockwise.
/// \param name of the mesh, for messages
/// \throws BadInput when a number is not finite, a vertex does not exist, a triangle has no area in plan, or the mesh
/// is folded in plan (some triangles face up, some down)
Tin facing_up(Tin mesh, std::string const& name);

/// Finds the boundary of a mesh: the ring of edges that belong to a single triangle.
/// \param mesh as facing_up returns it
/// \param name of the mesh, for messages
/// \return counterclockwise, each vertex once; simple in plan, so that the mesh does not cover itself
/// \throws BadInput when there are several boundaries (a hole, several parts), when the boundary touches or crosses
/// itself in plan, or when an edge belongs to three triangles
std::vector<std::uint32_t> outline_of(Tin const& mesh, std::string const& name, Run const& run = {});

/// A mesh without the region inside an outline.
struct CutTin {
    Tin tin;                                       ///< vertices of the outline may belong to no triangle
    std::vector<std::vector<std::uint32_t>> sides; ///< by side of the outline: the vertices on it, both ends included
    std::int64_t removed = 0;                      ///< vertices of the target inside the outline
    std::int64_t added = 0;                        ///< vertices on the outline that are new
};

/// Cuts a region out of a mesh along its outline.
/// \param target as facing_up returns it
/// \param outline a simple ring, counterclockwise, each vertex once
/// \return the target's surface outside the outline: the triangles that the outline does not cross, and the outer parts
/// of the others, with vertices where it crosses their edges, all at the target's heights. The target's vertices come
/// first, in their order and bit for bit.
/// \throws BadInput naming a place where the outline leaves the target or the target covers itself
CutTin cut_tin(Tin const& target, std::vector<Vec2> const& outline, Run const& run = {});

} // namespace thalweg::blend
