// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/normal.hpp>

#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>

namespace thalweg {

std::array<double, 2> normal_pair(std::uint64_t first, std::uint64_t second) {
    double const radius = std::sqrt(-2.0 * portable::log(1.0 - unit(first)));
    double const angle = 2.0 * portable::pi * unit(second);
    return {radius * portable::cos(angle), radius * portable::sin(angle)};
}

} // namespace thalweg
