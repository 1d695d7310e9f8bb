// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace thalweg {

/// The attributes of a file's features as a table.
struct AttributeTable {
    enum class Type : std::uint8_t { integer, integer64, real, text, date, time, datetime };
    /// std::monostate is NULL; dates and times are ISO 8601 text.
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
