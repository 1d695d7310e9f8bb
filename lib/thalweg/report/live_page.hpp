// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/report/landmarks.hpp>

// The page while a terrain is edited: what report.html has packed in it comes in parts (web/README.md).
namespace thalweg::report {

/// A page, and what it may do.
struct LivePage {
    std::string html;
    std::string policy; ///< Content-Security-Policy: that of report.html, and a socket to where the page came from
};

/// \internal
/// \param title of the page
/// \param studio what the page asks its server with, one JSON object
/// \return the page without a terrain
LivePage live_page(std::string const& title, std::string const& studio);

/// \internal
/// \return a grid as JSON, as "grid" of the page's data
std::string grid_json(Grid const& grid);

/// \internal
/// \return the sea as JSON, as "sea" of the page's data
std::string sea_json(std::optional<Sea> const& sea);

/// A DEM as the page shows it.
struct LiveHeights {
    Raster<float> values;   ///< [m] means of squares of cells; NaN: no data
    std::int64_t cells = 1; ///< [cells] side of a square
    double min = 0.0;       ///< [m] of the values
    double max = 0.0;       ///< [m] of the values
    std::int64_t nodata = 0;
};

/// \internal
/// \param dem any
/// \param grid of the terrain that it becomes: the same, or one of smaller cells
/// \return a DEM of that grid as means of squares that page() chooses; a coarser one as it is; nothing: no heights
std::optional<LiveHeights> live_heights(Raster<float> const& dem, Grid const& grid);

/// \internal
/// The members of JSON that describe a terrain and its rivers: "data", "lines" and "water".
/// \param made a terrain; what is not yet measured or drawn may be missing
/// \param recipe its text
/// \param command that makes it again
/// \return without braces
std::string live_scene(make::MakeResult const& made, std::string const& recipe, std::string const& command,
                       Run const& run = {});

/// \internal
/// Rivers whose terrain is yet to be made, at height 0.
/// \return for live_scene()
make::MakeResult planform_preview(recipe::Recipe const& recipe, make::Planform const& planform);

/// The arms of a cluster in the four directions, of which one can become the rivers.
struct ClusterArms {
    std::int64_t width = 0;
    std::int64_t height = 0;
    /// base64 of a zlib stream of a byte a place, row-major from the north-west: 0 none, 1 north, 2 east, 3 south, 4
    /// west, 5 no arm
    std::string arms;
    std::string chosen; ///< as network.branch says it
};

/// \internal
/// \param side [places] of the longer side of the picture
/// \return nothing where the rivers are no branch of a cluster
std::optional<ClusterArms> cluster_arms(recipe::Recipe const& recipe, std::int64_t side, Run const& run = {});

} // namespace thalweg::report
