// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace test {

using namespace thalweg;

/// Whether Guo and Hall's algorithm A1 deletes a set cell in subiteration 0 or 1. p[2] ... p[9]: the neighbours from
/// the north clockwise, as in their paper.
inline bool guo_hall_deletes(std::array<int, 10> const& p, int subiteration) {
    int const c = ((p[2] == 0) & (p[3] | p[4])) + ((p[4] == 0) & (p[5] | p[6])) + ((p[6] == 0) & (p[7] | p[8])) +
                  ((p[8] == 0) & (p[9] | p[2]));
    int const n1 = (p[9] | p[2]) + (p[3] | p[4]) + (p[5] | p[6]) + (p[7] | p[8]);
    int const n2 = (p[2] | p[3]) + (p[4] | p[5]) + (p[6] | p[7]) + (p[8] | p[9]);
    int const n = std::min(n1, n2);
    int const m = subiteration == 0 ? (p[2] | p[3] | (p[5] == 0)) & p[4] : (p[6] | p[7] | (p[9] == 0)) & p[8];
    return c == 1 && n >= 2 && n <= 3 && m == 0;
}

inline std::array<int, 10> guo_hall_neighbours(Mask const& mask, Cell c) {
    auto const set = [&](std::int64_t dc, std::int64_t dr) {
        Cell const n{c.col + dc, c.row + dr};
        return mask.grid().contains(n) && mask[n] != 0 ? 1 : 0;
    };
    return {0, 1, set(0, -1), set(1, -1), set(1, 0), set(1, 1), set(0, 1), set(-1, 1), set(-1, 0), set(-1, -1)};
}

/// Guo-Hall thinning cell by cell: sweeps over the whole grid until neither subiteration deletes anything.
inline Mask plain_thin(Mask mask) {
    for (auto& v : mask.values()) {
        v = v != 0 ? 1 : 0;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int subiteration = 0; subiteration < 2; ++subiteration) {
            Mask const before = mask;
            for (std::int64_t i = 0; i < mask.cells(); ++i) {
                if (before[i] != 0 &&
                    guo_hall_deletes(guo_hall_neighbours(before, before.grid().at(i)), subiteration)) {
                    mask[i] = 0;
                    changed = true;
                }
            }
        }
    }
    return mask;
}

} // namespace test
