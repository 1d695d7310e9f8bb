// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/table.hpp>

/// A user's columns beside those of a schema. Private to this module.
namespace thalweg::io {

/// The names that columns get beside others that are taken, in a layer of a schema: u_NAME where the name is taken, or
/// is that of a feature's id or geometry, or the layer would be recognised as another schema's by it; else as they are;
/// with a number where two are one in any case of letters.
std::vector<std::string> user_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                    Schema schema = Schema::native);

/// The same in a shapefile: of at most 10 bytes, cut before a letter and made unique by a number at their end.
std::vector<std::string> short_user_names(std::vector<std::string> const& names, std::vector<std::string> const& taken);

/// Adds the columns to a table. Takes: by row of the table the record of its values, 0 for none, where all are NULL.
/// The attributes must outlive the table.
void add_user_columns(Table& table, AttributeTable const& attributes,
                      std::function<std::int64_t(std::size_t row)> const& record, bool short_names,
                      Schema schema = Schema::native);

} // namespace thalweg::io
