// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace thalweg {

/// Converts a number to a vector index.
/// \param number >= 0
/// \return the same number
constexpr std::size_t as_index(std::int64_t number) {
    return static_cast<std::size_t>(number);
}

} // namespace thalweg
