// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <vector>

namespace thalweg {

using CellIndex = std::int64_t;   ///< place of a cell in a grid, row by row from the north-west; -1 for none
using RowIndex = std::int64_t;    ///< row of a grid, from the north
using ColumnIndex = std::int64_t; ///< column of a grid, from the west

/// A std::vector indexed by numbers of type Id. Ids may be -1 (none), or negative during arithmetic. Law: contiguous,
/// and as fast as std::vector; an index out of range is a programming error, which debug builds find.
template <std::integral Id, class T> class Indexed : public std::vector<T> {
    using Values = std::vector<T>;

public:
    Indexed() = default;
    Indexed(std::initializer_list<T> values) : Values(values) {}
    Indexed(Values values) : Values(std::move(values)) {}
    template <std::input_iterator At> Indexed(At first, At last) : Values(first, last) {}
    template <std::integral Size>
    explicit Indexed(Size size, T const& fill = T{}) : Values(static_cast<std::size_t>(size), fill) {}

    template <std::integral Place> T& operator[](Place i) { return Values::operator[](static_cast<std::size_t>(i)); }
    template <std::integral Place> T const& operator[](Place i) const {
        return Values::operator[](static_cast<std::size_t>(i));
    }

    /// \return number of elements, which is the id of the next one.
    Id count() const { return static_cast<Id>(Values::size()); }
};

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
