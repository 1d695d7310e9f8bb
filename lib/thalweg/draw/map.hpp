// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/draw/picture.hpp>

// Idea: A topographic map of a DEM. Numbers are placed greedily, the most important first, and none
// is moved again: each summit tries eight places around its mark, and takes the free one where its
// number covers least of rivers and shores. Then every stretch of every index contour that is long
// enough is judged: by how much it bends, how many contours cross it, how far it is tilted and
// whether its digits look uphill; the best comes first, and others keep a distance from it. Rooms
// of numbers are turned rectangles; two are apart exactly if a normal of one of their sides
// separates them. Shores are contours of the share of water around a cell, so that they do not
// follow the cells' corners.
// Source: ours. Contours are not computed here: the sheet has them (io/raster/dem_derivatives.hpp
// lets GDAL trace them).
// Cost: O(n) for the ground, of means over coarser cells (whole) where n is more than the pixels;
// numbers O(length of index contours on the sheet), times the numbers placed. One thread.
// Not for: comparing bytes between machines: text uses the fonts that each has. The ground alone,
// as a texture for 3D programs: ground(). Net and hidden lines: wireframe.hpp.
// Example:
//     MapSheet sheet{.dem = dem, .hillshade = shade_of_dem};
//     sheet.spot_heights = {{{500.0, 500.0}, 812.0}};
//     Picture const picture = map(sheet, {.title = "Valley", .format = Format::svg});
// More: docs/commands.md, "Pictures".

namespace thalweg::draw {

/// Options of lines().
struct LinesParams {
    std::string title;    ///< UTF-8; "" for none
    int width_px = 1000;  ///< [200, 8000]
    int height_px = 1000; ///< [200, 8000]
    Format format = Format::svg;
};

/// Draws polylines in plan, north up, as large as the sheet allows.
/// \param lines empty: an empty sheet
/// \return the picture
/// \throws BadInput when a coordinate is not finite
Picture lines(std::vector<std::vector<Vec2>> const& lines, LinesParams const& params = {});

/// The hypsometric tints of maps.
/// \return codes such as "#7ea688", the lowest first, for equal steps of height
std::vector<std::string> tint_colours();

/// Options of map().
struct MapParams {
    std::string title;               ///< UTF-8; "" for none
    std::string crs;                 ///< UTF-8: the coordinate system in words; "": as the grid's
    int width_px = 1400;             ///< [200, 8000] of the whole sheet; its height follows
    double contour_interval_m = 0.0; ///< for the legend, every fifth is drawn heavier; 0: no contours
    Format format = Format::png;
    std::string remark = {}; ///< UTF-8: written after the grid's facts; "": none
};

/// The sea of a map: its cells without a height.
struct Sea {
    bool is_around = false; ///< it reaches beyond the grid
};

/// A height that a map may write beside its place.
struct SpotHeight {
    Vec2 at;
    double z = 0.0; ///< [m]
};

/// The DEM of which a sheet shows means over coarser cells.
struct WholeDem {
    Grid grid;
    double low_m = 0.0; ///< lowest height; low > high: none
    double high_m = 0.0;
};

/// The content of a map. hillshade has the DEM's grid, 0: no data.
struct MapSheet {
    Raster<float> const& dem;
    Raster<std::uint8_t> const& hillshade;
    ElevatedNetwork const* network = nullptr;
    NetworkOrders const* orders = nullptr;                      ///< of the network; required with one
    std::vector<std::pair<double, std::vector<Vec2>>> contours; ///< height [m] and line
    RidgeLines const* ridges = nullptr;                         ///< null or empty: none
    /// [m²] by arc: contributing area at its downstream end; not above 0: unknown; empty: all unknown
    std::vector<double> areas_m2 = {};
    std::optional<Sea> sea = {};               ///< none: cells without a height are light grey
    Mask const* lakes = nullptr;               ///< on the DEM's grid; null or without cells: none
    std::vector<SpotHeight> spot_heights = {}; ///< the most important first: those without room are left out
    /// what dem is an average of (box_means()), whose cells and heights the map states; none: of nothing
    std::optional<WholeDem> whole = {};
};

/// \param grid of a DEM
/// \param params width and format of a map
/// \return columns of pixels that the map has for the DEM, of half pixels in a format that can be scaled: more cells in
/// a row are not seen
std::int64_t columns_of_map(Grid const& grid, MapParams const& params = {});

/// Draws a map: hillshade under a hypsometric tint, contours with heights on index contours, ridges as thin brown
/// lines, rivers whose width and colour follow their contributing area (Strahler order if no area is known), sea and
/// lakes, spot heights, scale bar, legend, title with the grid's facts, and a frame with coordinates.
/// \param sheet a DEM of at least one cell; cells without a shade are drawn as level
/// \return the picture
/// \throws BadInput when hillshade, lakes, orders or areas belong to another grid or network, or a coordinate of a line
/// or spot height is not finite
Picture map(MapSheet const& sheet, MapParams const& params = {});

/// Options of ground().
struct GroundParams {
    int width_px = 2048;   ///< [200, 8000]; the height follows
    double shading = 0.45; ///< [0, 1] share of a map's light and shade: 3D programs add their own
};

/// \param grid of a DEM
/// \param params width of its picture
/// \return columns of pixels as columns_of_map()
std::int64_t columns_of_ground(Grid const& grid, GroundParams const& params = {});

/// Draws what a map shows of the ground, alone, as a texture: tinted and shaded relief, rivers, sea and lakes, without
/// contours, ridges, heights or a frame. Its corners are the centres of the DEM's corner cells.
/// \param sheet a DEM of at least 2 x 2 cells
/// \return PNG
/// \throws BadInput as map(), and for a DEM of a single row or column, or one more than 16 times as long as wide
Picture ground(MapSheet const& sheet, GroundParams const& params = {});

} // namespace thalweg::draw
