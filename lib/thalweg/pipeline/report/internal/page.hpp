// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/make.hpp>

namespace thalweg::pipeline {

struct PageParams {
    double contour_interval_m = 0.0; ///< [m] of the contours the page draws first; 0 where there is no surface
    std::string recipe;              ///< TOML as it lies beside the page; "" for none
    std::string command = "thalweg make recipe.toml -o again"; ///< that makes it again
    std::vector<std::string> notes = {};                       ///< further ones
};

/// report.html of a terrain: one page that a browser opens without a network.
/// Gives: the page that is built into the library, filled as web/README.md says. Whatever a title or a file name holds,
/// it cannot leave its place in the page; bytes that are no UTF-8 become U+FFFD. Throws: Cancelled; IoError.
std::string page(Made const& made, PageParams const& params = {}, Run const& run = {});

} // namespace thalweg::pipeline
