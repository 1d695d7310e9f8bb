// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace thalweg {

/// Two independent normal deviates of mean 0 and deviation 1 from two random words.
/// \param first first random word
/// \param second second random word
/// \return sqrt(-2 ln u) cos(2 pi v) and the same with sin, u in (0, 1], v in [0, 1); both are at most 8.6.
///
/// Source: \cite box1958; \cite zhang, equation 3.
std::array<double, 2> normal_pair(std::uint64_t first, std::uint64_t second);

} // namespace thalweg
