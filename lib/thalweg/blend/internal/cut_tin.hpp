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

/// A mesh whose triangles run counterclockwise in plan: as it stands, or every triangle turned over where all run
/// clockwise.
/// Takes: name: of the mesh, for messages.
/// Throws: BadInput: a number that is not finite, a vertex that is not there, a triangle without area in plan, or some
/// that face up and some down: the mesh is folded in plan.
Tin facing_up(Tin mesh, std::string const& name);

/// The boundary of a mesh, counterclockwise, each vertex once.
/// Takes: a mesh as facing_up gives it; name: for messages.
/// Gives: the one ring of edges that belong to a single triangle; in plan it is simple, so the mesh does not cover
/// itself. Throws: BadInput: several boundaries (a hole, several parts), or one that touches or crosses itself in plan;
/// an edge of three triangles; Cancelled.
std::vector<std::uint32_t> outline_of(Tin const& mesh, std::string const& name, Run const& run = {});

/// A mesh without the region inside an outline.
struct CutTin {
    Tin tin;                                       ///< vertices of the outline may belong to no triangle
    std::vector<std::vector<std::uint32_t>> sides; ///< by side of the outline: the vertices on it, both ends included
    std::int64_t removed = 0;                      ///< vertices of the target inside the outline
    std::int64_t added = 0;                        ///< vertices on the outline that the target does not have
};

/// Cuts a region out of a mesh along its outline.
/// Takes: a mesh as facing_up gives it; a simple ring, counterclockwise, each vertex once.
/// Gives: the target's surface outside the outline: its triangles where the outline does not cross them, and the parts
/// of those that it does, with vertices where it crosses their edges, all at the target's heights. The target's
/// vertices come first, in their order and bit for bit.
/// Throws: BadInput naming a place where the outline leaves the target, or when the target covers itself there;
/// Cancelled.
CutTin cut_tin(Tin const& target, std::vector<Vec2> const& outline, Run const& run = {});

} // namespace thalweg::blend
