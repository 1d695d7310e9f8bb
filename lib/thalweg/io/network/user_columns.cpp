// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/user_columns.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>
#include <variant>

#include <fmt/format.h>

namespace thalweg::io {

namespace {

constexpr std::size_t dbf_name = 10;
constexpr std::size_t dbf_text = 254;

std::string without_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

/// As many bytes as fit, whole letters of UTF-8.
std::string cut_to(std::string const& text, std::size_t most) {
    if (text.size() <= most) {
        return text;
    }
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return text.substr(0, end);
}

std::set<std::string> in_lower(std::vector<std::string> const& names) {
    std::set<std::string> result;
    for (std::string const& name : names) {
        result.insert(without_case(name));
    }
    return result;
}

Column::Kind user_kind(AttributeTable::Type type, bool in_shapefile) {
    using Type = AttributeTable::Type;
    switch (type) {
    case Type::integer: return Column::Kind::integer;
    case Type::integer64: return Column::Kind::wide_integer;
    case Type::real: return Column::Kind::real;
    case Type::date: return Column::Kind::date;
    case Type::time: return in_shapefile ? Column::Kind::text : Column::Kind::time; // dBase has dates alone
    case Type::datetime: return in_shapefile ? Column::Kind::text : Column::Kind::datetime;
    case Type::text: break;
    }
    return Column::Kind::text;
}

/// Decimals that leave room for the digits of the greatest value of a column of 24 characters.
int user_decimals(AttributeTable const& attributes, std::size_t column) {
    double greatest = 0.0;
    for (auto const& row : attributes.rows) {
        if (auto const* real = std::get_if<double>(&row[column])) {
            greatest = std::max(greatest, std::fabs(*real));
        }
    }
    int digits = 1;
    for (double power = 10.0; digits < 20 && power <= greatest; power *= 10.0) {
        ++digits;
    }
    constexpr int room = 20;
    constexpr int most = 15;
    return std::clamp(room - digits, 0, most);
}

/// Whether one of the names, a blank between them, is there.
bool has_one_of(std::set<std::string> const& there, std::string_view names) {
    std::istringstream words{std::string(names)};
    return std::any_of(std::istream_iterator<std::string>(words), {},
                       [&](std::string const& word) { return there.contains(word); });
}

/// The names, in small letters, by which a layer with these columns would be recognised as another schema's. The
/// network schema has none: whoever reads it looks for no other.
std::set<std::string> misleading_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                       Schema schema) {
    std::set<std::string> result;
    if (schema == Schema::native) {
        return result;
    }
    std::set<std::string> there = in_lower(taken);
    for (auto const& column : attributes.columns) {
        there.insert(without_case(column.name));
    }
    for (SchemaTable const& other : all_schemas()) {
        bool const is_recognised =
            std::ranges::all_of(other.told_by, [&](std::string_view names) { return has_one_of(there, names); });
        if (other.schema == schema || !is_recognised) {
            continue;
        }
        for (std::string_view const names : other.told_by) {
            std::istringstream words{std::string(names)};
            result.insert(std::istream_iterator<std::string>(words), {});
        }
    }
    return result;
}

} // namespace

std::vector<std::string> user_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                    Schema schema) {
    std::set<std::string> used = in_lower(taken);
    std::set<std::string> const misleading = misleading_names(attributes, taken, schema);
    for (char const* const reserved : {"fid", "geom", "geometry", "ogc_fid"}) {
        used.insert(reserved);
    }
    std::vector<std::string> names;
    for (auto const& column : attributes.columns) {
        std::string const own = column.name.empty() ? "column" : column.name;
        bool const is_free = !used.contains(without_case(own)) && !misleading.contains(without_case(own));
        std::string name = is_free ? own : "u_" + own;
        for (int k = 2; !used.insert(without_case(name)).second; ++k) {
            name = fmt::format("{}_{}", own, k);
        }
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> short_user_names(std::vector<std::string> const& names,
                                          std::vector<std::string> const& taken) {
    std::set<std::string> used = in_lower(taken);
    for (std::string const& name : names) { // those that fit keep their names
        if (name.size() <= dbf_name) {
            used.insert(without_case(name));
        }
    }
    std::vector<std::string> result;
    for (std::string const& name : names) {
        std::string shorter = cut_to(name, dbf_name);
        for (int k = 2; name.size() > dbf_name && !used.insert(without_case(shorter)).second; ++k) {
            std::string const number = fmt::format("_{}", k);
            shorter = cut_to(name, dbf_name - number.size()) + number;
        }
        result.push_back(shorter);
    }
    return result;
}

void add_user_columns(Table& table, AttributeTable const& attributes,
                      std::function<std::int64_t(std::size_t row)> const& record, bool short_names, Schema schema) {
    std::vector<std::string> taken;
    for (Column const& column : table.columns) {
        taken.push_back(column.name);
    }
    std::vector<std::string> names = user_names(attributes, taken, schema);
    if (short_names) {
        names = short_user_names(names, taken);
    }
    for (std::size_t c = 0; c < names.size(); ++c) {
        Column column;
        column.name = names[c];
        column.kind = user_kind(attributes.columns[c].type, short_names);
        column.is_users = true;
        column.decimals = short_names && column.kind == Column::Kind::real ? user_decimals(attributes, c) : 0;
        column.at = [&attributes, record, c, short_names](std::size_t row) -> Column::Value {
            std::int64_t const r = record(row);
            if (r <= 0 || r > static_cast<std::int64_t>(attributes.rows.size())) {
                return {};
            }
            AttributeTable::Value value = attributes.rows[static_cast<std::size_t>(r - 1)][c];
            if (auto* const text = std::get_if<std::string>(&value); text != nullptr && short_names) {
                *text = cut_to(*text, dbf_text);
            }
            return value;
        };
        table.columns.push_back(std::move(column));
    }
}

} // namespace thalweg::io
