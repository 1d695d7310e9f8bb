// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Nodes lie up to a quarter of a cell from the centres of their cells, at one of eight places each way, so that ways
/// of water do not cling to the lattice. A code is eastward * jitter_stride + southward: the difference of two codes
/// names the vector between two places.
inline constexpr int jitter_places = 8;
inline constexpr int jitter_stride = 2 * jitter_places - 1;
inline constexpr int jitter_codes = (jitter_places - 1) * (jitter_stride + 1);

/// Reciprocal distance of two neighbouring nodes [1/cell] in directions 0..3 of d8_steps, by the code of the one there
/// minus that of the one here, plus jitter_codes.
using JitteredPerLength = std::array<std::array<float, 2 * jitter_codes + 1>, 4>;
JitteredPerLength jittered_per_length();

/// Gives every node of a level its place, at random.
void jitter(LandLevel& level, std::uint64_t seed, Run const& run);

} // namespace thalweg::surface
