// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::io {

/// Options of web_pyramid().
struct WebPyramidParams {
    std::int64_t most_zoom = 22;     ///< [0, 22]
    std::int64_t most_tiles = 20000; ///< [1, ...] of heights and colours together; one level there is always
};

/// The square tiles of a grid in Web Mercator (EPSG:3857) as web maps number them: at zoom z, 2^z columns from the west
/// at longitude -180 and as many rows from the north.
struct WebPyramid {
    Grid grid;                  ///< the given one; without CRS, in EPSG:3857 with its middle at (0, 0)
    Vec2 shift;                 ///< [m] from the given grid to this one
    DegreeBox box;              ///< around its cells
    Vec2 low;                   ///< [m] EPSG:3857: south-west corner of box
    Vec2 high;                  ///< [m] EPSG:3857: north-east corner of box
    std::int64_t min_zoom = 0;  ///< two above the last at which the box is no wider and higher than a tile
    std::int64_t max_zoom = 0;  ///< the deepest written
    std::int64_t full_zoom = 0; ///< the first at which a 256th of a tile is no larger than a cell
    std::int64_t tiles = 0;     ///< heights and colours of all levels
};

/// The tiles of a level that meet the box: columns from west to east and rows from north to south, ends included.
struct WebTileRange {
    std::int64_t west = 0;
    std::int64_t east = 0;
    std::int64_t north = 0;
    std::int64_t south = 0;
};

/// \internal
/// Lays out the tiles of a grid.
/// \param grid at least one cell
/// \return max_zoom is full_zoom or what the limits leave, and no less than min_zoom
/// \throws BadInput when the grid is beyond 85 degrees of latitude, crosses the meridian of 180 degrees, or its CRS is
/// invalid
WebPyramid web_pyramid(Grid const& grid, WebPyramidParams const& params = {});

/// \internal
/// \param pyramid any
/// \param zoom [0, 30]
/// \return the tiles of the level
WebTileRange web_tiles_at(WebPyramid const& pyramid, std::int64_t zoom);

/// What the tiles show.
struct WebGround {
    Raster<float> const& heights; ///< [m] on the pyramid's grid, all are numbers
    Mask const& shown;            ///< on the same cells; 0: colours are transparent
    std::string const& picture;   ///< PNG whose corners are the centres of the grid's corner cells
};

/// \internal
/// Writes heights/ZOOM/COLUMN/ROW.png (256 x 256 samples, RGB: -10000 m + 0.1 m x (65536 R + 256 G + B)) and
/// colour/ZOOM/COLUMN/ROW.png (512 x 512, RGBA). Samples are bilinear at the level full_zoom and means of four above
/// it; all tiles of a level belong to one lattice of samples. Beyond the outermost centres of cells heights are those
/// of the nearest place on the rim; beyond the cells colours are transparent. The same samples everywhere, and the same
/// bytes on one machine, for any number of threads.
/// \param ground what they show
/// \param pyramid web_pyramid() of its grid
/// \param out receives the files
/// \return the files' names, sorted
/// \throws BadInput when a height is not a number or beyond what the encoding has, the rasters differ in size or the
/// picture is none
/// \throws IoError when a file cannot be written
///
/// Source: Mapbox, Terrain-RGB v1 (the encoding); OGC 17-083r4, WebMercatorQuad (the numbers of tiles).
std::vector<std::string> write_web_tiles(WebGround const& ground, WebPyramid const& pyramid, OutputFolder const& out,
                                         Run const& run = {});

/// \internal
/// Turns lines into longitudes and latitudes (WGS 84).
/// \param lines [m] in the CRS of the grid that the pyramid was made of
/// \param pyramid of the grid
/// \return [degrees] x longitude, y latitude, rounded to 1e-7
/// \throws BadInput when a vertex has no longitude and latitude
std::vector<std::vector<Vec2>> lines_in_degrees(std::vector<std::vector<Vec2>> lines, WebPyramid const& pyramid);

} // namespace thalweg::io
