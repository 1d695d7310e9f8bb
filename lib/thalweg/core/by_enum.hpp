// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

namespace thalweg {

/// A table with an entry for each value of an enumeration that counts from 0, in its order.
template <class Enum, class T, std::size_t Size> struct ByEnum {
    std::array<T, Size> entries{};

    /// \param value a value of the enumeration
    /// \return its entry
    /// \throws std::out_of_range for a value that the table does not have
    constexpr T& operator[](Enum value) { return entries.at(static_cast<std::size_t>(value)); }
    constexpr T const& operator[](Enum value) const { return entries.at(static_cast<std::size_t>(value)); }
};

} // namespace thalweg
