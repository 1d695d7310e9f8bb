// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/river_files.hpp>

namespace thalweg::pipeline {

/// Refuses to take a grid from lines of which one vertex, or at most 1 %, lies more than twenty times as far away as
/// all others reach: a coordinate that was lost. Fewer than 20 vertices tell nothing. Throws: BadInput naming the line,
/// the vertex and what to do.
void require_no_stray_vertex(RiverLines const& lines);

} // namespace thalweg::pipeline
