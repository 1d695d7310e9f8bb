// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg {

/// Instruction sets that a kernel is compiled for (lanes.inc); results have the same bytes on each.
/// \cpponly
enum class Lanes : std::uint8_t {
    plain, ///< the architecture's baseline
    avx2
};

/// Detects the widest instruction set.
/// \return what this processor supports
inline Lanes widest_lanes() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") ? Lanes::avx2 : Lanes::plain;
#else
    return Lanes::plain;
#endif
}

} // namespace thalweg
