// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

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

} // namespace thalweg::blend
