// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/pipeline/report/internal/page.hpp>

namespace thalweg::pipeline {

/// The JSON object of the report page (web/README.md).
/// Takes: a terrain, and its heights and lines as they stand on the page; lines are the arcs by number, then the
/// ridges.
/// Gives: one line of JSON without '<'; lengths and heights to the millimetre, what is not a number as null. A figure
/// has "asked" only where the recipe asks for it.
std::string page_data(Made const& made, PageParams const& params, std::optional<PageHeights> const& heights,
                      PageLines const& lines);

} // namespace thalweg::pipeline
