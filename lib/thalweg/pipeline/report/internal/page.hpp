// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/make.hpp>
#include <thalweg/pipeline/report/pictures.hpp>

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

/// Heights as the report page reads them (web/README.md).
struct PageHeights {
    std::int64_t width = 0;          ///< [values]
    std::int64_t height = 0;         ///< [values]
    std::int64_t cells = 1;          ///< [cells] a value is the mean of a square of cells x cells
    double min = 0.0;                ///< [m] of the values
    double max = 0.0;                ///< [m] likewise
    std::int64_t nodata = 0;         ///< values without a height
    std::vector<std::uint8_t> bytes; ///< predictors, low bytes, high bytes
};

/// Side [cells] of the squares that the page shows by one value each.
/// Gives: the smallest with which no side of the grid has more than 4096 values, and the whole not more than 1 500 000.
std::int64_t page_cells(Grid const& grid);

/// The means of a DEM's squares in 16 bits, each row against the predictor that leaves the shortest residuals.
/// Takes: heights, NaN for none: these are left out of means, and a square of them has no value. Gives: nothing when no
/// cell has a height; otherwise values within (max - min) / 131068 of the means, exactly min where all are alike.
/// Throws: BadInput: an infinite height; Cancelled.
std::optional<PageHeights> page_heights(Raster<float> const& dem, Run const& run = {});

/// Lines as the report page reads them (web/README.md).
struct PageLines {
    double step = 0.0625;               ///< [cells] unit of positions
    std::vector<std::int64_t> vertices; ///< by line
    std::vector<std::uint8_t> bytes;    ///< differences as zigzagged varints
};

/// Lines in plan as differences of whole steps, a 16th of the side of the page's squares (page_cells).
/// Takes: lines of two vertices or more. Gives: every vertex within half a step of its place along either axis; left
/// out are vertices that fall on the one before, and those on the straight way between their neighbours; the first and
/// last of a line stay. Throws: BadInput, naming the line: fewer than two vertices, no number, or 2^29 steps from the
/// grid's corner.
PageLines page_lines(std::span<std::span<Vec2 const> const> lines, Grid const& grid);

/// What takes the place of a page's markers, byte for byte: it must be safe where it comes to stand.
struct PageParts {
    std::string title;   ///< for @@TITLE@@
    std::string data;    ///< for @@DATA@@
    std::string heights; ///< for @@HEIGHTS@@
    std::string lines;   ///< for @@LINES@@
};

/// A page with its markers replaced.
/// Gives: each marker's part where the page holds it; what looks like a marker in a part stays as it is.
/// Throws: std::logic_error when the page does not hold each of the four markers exactly once: it was built wrongly.
std::string fill_page(std::string_view page, PageParts const& parts);

/// The JSON object of the report page (web/README.md).
/// Takes: a terrain, and its heights and lines as they stand on the page; lines are the arcs by number, then the
/// ridges.
/// Gives: one line of JSON without '<'; lengths and heights to the millimetre, what is not a number as null. A figure
/// has "asked" only where the recipe asks for it.
std::string page_data(Made const& made, PageParams const& params, std::optional<PageHeights> const& heights,
                      PageLines const& lines);

/// The report page of a scene: any DEM, with or without rivers, measured and drained for it.
/// Takes: a scene with a DEM; notes: what was changed in reading it; command: what makes the page again.
/// Throws: BadInput when the scene has no DEM or the DEM no height; Cancelled; IoError.
std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run = {});

} // namespace thalweg::pipeline
