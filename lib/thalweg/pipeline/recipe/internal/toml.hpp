// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace thalweg::pipeline {

/// The first line of a TOML text, counted from 1, where values lie deeper than this many levels: sections, parts of
/// dotted keys, inline tables and arrays count one each. Strings and comments are left out; a text that is no TOML
/// gives some number. It is found without recursion, for parsers that recurse a level, and destructors that do.
std::optional<std::size_t> line_deeper_than(std::string_view toml, std::size_t most_levels);

} // namespace thalweg::pipeline
