// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cstring>

#include <thalweg/solver/grid/internal/poisson.hpp>

namespace thalweg::solver {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are taken from words");

#define THALWEG_KERNELS <thalweg/solver/grid/internal/grid_lanes.inc>
#include <thalweg/core/run/lanes.inc>

} // namespace

GridRows const& grid_rows(Lanes lanes) {
    static constexpr GridRows with_plain = plain::all_rows();
    static constexpr GridRows with_avx2 = avx2::all_rows();
    return lanes == Lanes::avx2 ? with_avx2 : with_plain;
}

} // namespace thalweg::solver
