// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/network/import/import_lines.hpp>

namespace thalweg::pipeline {

// What is said of the directions of lines.

/// "12.3 km reversed: 10.1 km by angles at confluences, 2.2 km by the file's links"; "" where nothing was.
std::string turned_in_words(network::Directions const& directions);

/// A sentence for each kind of doubt, with numbers and what decides.
/// \param by_dem,by_rule options that decide: "--set network.lines.dem=FILE", "--dem FILE"; "" for none
std::vector<std::string> direction_doubts(network::Directions const& directions, std::string const& by_dem,
                                          std::string const& by_rule);

} // namespace thalweg::pipeline
