// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// Instruction sets that a kernel is compiled for (lanes.inc); results have the same bytes on each.
enum class Lanes : std::uint8_t {
    plain, ///< the architecture's baseline
    avx2
};

/// Detects the widest instruction set.
/// \return what this processor supports
Lanes widest_lanes();

} // namespace thalweg
