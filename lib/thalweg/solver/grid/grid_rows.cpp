// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/internal/grid_rows.hpp>

#include <bit>
#include <cstring>

namespace thalweg::solver {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are taken from words");

namespace plain {
#define THALWEG_TARGET
#include <thalweg/solver/grid/internal/grid_lanes.inc>
#undef THALWEG_TARGET
} // namespace plain

#ifdef __x86_64__
namespace avx2 {
#define THALWEG_TARGET __attribute__((target("avx2")))
#include <thalweg/solver/grid/internal/grid_lanes.inc>
#undef THALWEG_TARGET
} // namespace avx2
#else
namespace avx2 = plain;
#endif

} // namespace

GridLanes widest_grid_lanes() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx2") ? GridLanes::avx2 : GridLanes::plain;
#else
    return GridLanes::plain;
#endif
}

GridRows const& grid_rows(GridLanes lanes) {
    static constexpr GridRows with_plain = plain::all_rows();
    static constexpr GridRows with_avx2 = avx2::all_rows();
    return lanes == GridLanes::avx2 ? with_avx2 : with_plain;
}

} // namespace thalweg::solver
