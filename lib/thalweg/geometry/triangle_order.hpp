// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace thalweg::geometry {

/// Numbers triangles without a trace of how they were found: each begins with its lowest vertex, all are sorted.
/// Takes: triangles of vertices [0, vertices). Gives: the same triangles, each still in its direction.
std::vector<std::array<std::uint32_t, 3>> in_order(std::vector<std::array<std::uint32_t, 3>> const& triangles,
                                                   std::size_t vertices);

} // namespace thalweg::geometry
