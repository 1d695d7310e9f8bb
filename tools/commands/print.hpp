// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <thalweg/core/finding.hpp>

#include "commands/commands.hpp"

namespace thalweg::tools {

/// Prints what a command that writes files says on stdout: one JSON object, or the names of the files.
void print_result(Session const& session, nlohmann::ordered_json const& json, std::vector<std::string> const& files,
                  int indent = 2);

/// The limit of a check: "at least 0.95".
std::string limit_in_words(Check const& check);

/// A check with its value and limit: "trace_recall 0.43 (at least 0.95)".
std::string in_words(Check const& check);

/// The result of all checks in one line, shown last: "walker.gpkg: ok, 30 checks" or "walker.gpkg: FAILED, 2 of 30
/// checks".
std::string verdict(std::string const& of, std::vector<Check> const& checks);

} // namespace thalweg::tools
