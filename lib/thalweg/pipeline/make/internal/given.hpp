// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/network/import/import_lines.hpp>

namespace thalweg::pipeline {

// What is said of the directions of lines.

/// A note on the lengths reversed, by evidence, and a warning for each kind of doubt, with what decides.
/// \param by_dem,by_rule options that decide: "--set network.lines.dem=FILE", "--dem FILE"; "" for none
std::vector<Finding> direction_findings(network::Directions const& directions, std::string const& by_dem,
                                        std::string const& by_rule);

} // namespace thalweg::pipeline
