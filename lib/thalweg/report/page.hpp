// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/report/landmarks.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::report {

struct PageParams {
    double contour_interval_m = 0.0;                           ///< [m] of the page's first contours; 0: no surface
    std::string recipe;                                        ///< TOML as in the file beside the page; "": none
    std::string command = "thalweg make recipe.toml -o again"; ///< command that reproduces the terrain
    std::vector<std::string> notes = {};                       ///< additional ones
    std::optional<Sea> sea = {};                               ///< cells without a height are the sea
    Mask lakes = {};                                           ///< on the grid; without cells: none
    std::vector<Summit> summits = {};                          ///< that it names
};

/// What the page of a terrain shows beside it, without summits.
/// \param recipe its text
PageParams page_params_of(make::MakeResult const& made, std::string recipe);

/// Makes report.html of a terrain: one page that a browser opens without a network connection. It is the page built
/// into the library, filled as web/README.md describes. Titles and file names are escaped; invalid UTF-8 becomes
/// U+FFFD.
/// \throws IoError when GDAL fails to compress
std::string page(make::MakeResult const& made, PageParams const& params = {}, Run const& run = {});

/// Heights in the format of the report page (web/README.md).
struct PageHeights {
    std::int64_t width = 0;            ///< [values]
    std::int64_t height = 0;           ///< [values]
    std::int64_t cells = 1;            ///< [cells] a value is the mean of a square of cells x cells
    double min = 0.0;                  ///< [m] of the values
    double max = 0.0;                  ///< [m] of the values
    std::int64_t nodata = 0;           ///< values without a height
    std::vector<std::uint16_t> values; ///< row-major from the north-west, 0: no data
    std::vector<std::uint8_t> bytes;   ///< predictors, low bytes, high bytes
};

/// Chooses the side [cells] of the squares that the page shows as one value each: the smallest with which no side of
/// the grid has more than 4096 values, and the whole at most 1 500 000.
std::int64_t page_cells(Grid const& grid);

/// The means of a DEM's squares in 16 bits.
/// \return as page_heights(), without bytes
std::optional<PageHeights> page_values(Raster<float> const& dem, Run const& run = {});

/// Encodes the means of a DEM's squares in 16 bits, each row with the predictor that leaves the shortest residuals.
/// \param dem [m] NaN: no data, left out of means; a square of no data has no value
/// \return values within (max - min) / 131068 of the means, exactly min if all are equal; nothing: no cell has a height
/// \throws BadInput for an infinite height
std::optional<PageHeights> page_heights(Raster<float> const& dem, Run const& run = {});

/// Encodes D8 directions and lakes for the report page (web/README.md): most values are 0, where water takes the
/// steepest way down the page's heights.
/// \param drainage of the DEM
/// \param lakes cells of lakes, without cells: none
/// \param heights of the same DEM
/// \return one value a cell; empty: the page shows means of squares
std::vector<std::uint8_t> page_water(flow::FlowField const& drainage, Mask const& lakes, PageHeights const& heights);

/// Lines in the format of the report page (web/README.md).
struct PageLines {
    double step = 0.0625;               ///< [cells] unit of positions
    std::vector<std::int64_t> vertices; ///< by line
    std::vector<std::uint8_t> bytes;    ///< differences as zigzag varints
};

/// Encodes lines in plan as differences of whole steps, a 16th of the side of the page's squares (page_cells).
/// \param lines of two vertices or more
/// \param grid frame of the page
/// \return every vertex within half a step of its position along either axis; without vertices that coincide with the
/// previous one or lie on the straight line between their neighbours; the first and last of a line stay
/// \throws BadInput naming the line: fewer than two vertices, a coordinate that is not a number, or 2^29 steps from the
/// grid's corner
PageLines page_lines(std::span<std::span<Vec2 const> const> lines, Grid const& grid);

/// The lines of a page: the arcs by number, then the ridges.
PageLines lines_of_page(make::MakeResult const& made);

/// The means of squares of cells x cells; NaN: none of its cells has a height.
Raster<float> mean_of_squares(Raster<float> const& dem, std::int64_t cells);

/// Escapes a text for HTML; invalid UTF-8 becomes U+FFFD.
std::string html_text(std::string const& text);

/// Escapes '<' in JSON, so that it may stand in a script element.
std::string without_tags(std::string const& json);

/// Replacements of a page's markers, byte for byte: they must be safe in their places.
struct PageParts {
    std::string title;   ///< for @@TITLE@@
    std::string data;    ///< for @@DATA@@
    std::string heights; ///< for @@HEIGHTS@@
    std::string lines;   ///< for @@LINES@@
    std::string water;   ///< for @@WATER@@
    std::string studio;  ///< for @@STUDIO@@
};

/// A marker of a page and what replaces it.
using PageMarker = std::pair<std::string_view, std::string const*>;

/// Replaces markers of a page. Text in a part that looks like a marker stays.
/// \throws std::logic_error when the page does not have each of the markers exactly once: it was built wrongly
std::string fill_markers(std::string_view page, std::vector<PageMarker> const& markers);

/// Replaces the markers of the report page. Text in a part that looks like a marker stays.
/// \throws std::logic_error when the page does not have each of its markers exactly once: it was built wrongly
std::string fill_page(std::string_view page, PageParts const& parts);

/// Makes the JSON object of the report page (web/README.md): lengths and heights to the millimetre, null for values
/// that are not numbers. A metric has "asked" only if the recipe sets it.
/// \param heights,lines as on the page; lines are the arcs by number, then the ridges
/// \return one line of JSON without '<'
std::string page_data(make::MakeResult const& made, PageParams const& params, std::optional<PageHeights> const& heights,
                      PageLines const& lines);

/// Makes the report page of a scene: any DEM, with or without rivers, measured and routed.
/// \param scene with a DEM
/// \param notes changes made while reading it
/// \param command that makes the page again
/// \throws BadInput when the scene has no DEM or the DEM no height
/// \throws IoError when GDAL fails to compress
std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run = {});

} // namespace thalweg::report
