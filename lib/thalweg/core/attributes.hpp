// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace thalweg {

/// What a file says of its features, column by column.
struct AttributeTable {
    enum class Type : std::uint8_t { integer, integer64, real, text, date, time, datetime };
    /// Nothing stands for NULL; dates and times are texts as ISO 8601 has them.
    using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
    /// A column of a table.
    struct Column {
        std::string name;
        Type type = Type::text;
    };
    std::vector<Column> columns;
    std::vector<std::vector<Value>> rows; ///< record r, from 1, is row r - 1: a value for each column
};

/// A part of an arc that came from one feature.
struct Stretch {
    std::int64_t feature = 0; ///< number in its layer's order, from 1
    double from_m = 0.0;      ///< [m] along the arc from its upstream end
    double to_m = 0.0;        ///< likewise
};

} // namespace thalweg
