// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace thalweg {

/// Makes two independent standard normal deviates from two random words.
/// \param first,second independent uniform words
/// \return sqrt(-2 ln u) times cos(2 pi v) and sin(2 pi v), u in (0, 1], v in [0, 1); absolute values are at most 8.6
///
/// Source: \cite box1958; \cite zhang, equation 3.
std::array<double, 2> normal_pair(std::uint64_t first, std::uint64_t second);

} // namespace thalweg
