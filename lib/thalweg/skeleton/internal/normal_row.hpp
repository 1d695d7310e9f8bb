// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

namespace thalweg::skeleton {

/// Fills a row with independent normal deviates of mean 0 and standard deviation 1; seed, stage and row identify the
/// random numbers.
void normal_row(std::uint64_t seed, std::uint64_t stage, std::uint64_t row, std::span<double> values);

} // namespace thalweg::skeleton
