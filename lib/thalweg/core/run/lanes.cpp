// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/lanes.hpp>

namespace thalweg {

Lanes widest_lanes() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") ? Lanes::avx2 : Lanes::plain;
#else
    return Lanes::plain;
#endif
}

} // namespace thalweg
