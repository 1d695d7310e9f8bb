// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/elementary_rows.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <thalweg/core/numbers/internal/arc_tangent.hpp>

namespace thalweg::portable {
namespace {

#define THALWEG_KERNELS <thalweg/core/numbers/internal/arc_tangent_lanes.inc>
#include <thalweg/core/run/lanes.inc>

} // namespace

void atan2_row(std::span<double const> y, double x, std::span<double> angles, Lanes lanes) {
    (lanes == Lanes::avx2 ? &avx2::angles_of : &plain::angles_of)(y.data(), x, angles.data(), y.size());
}

} // namespace thalweg::portable
