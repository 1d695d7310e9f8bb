// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/import/river_heights.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

// Values of files by cell of a grid.

/// Cells of a raster on the grid that are neither 0 nor no-data, or whose centres lie in polygons; empty for "".
/// \throws Error as io::read_mask, io::read_polygons and blend::mask_polygons
Mask read_part(io::Source const& source, Grid const& grid, Run const& run);

/// The cells of a grid under lines. what: the lines' name, for messages. Throws as cells_along, for lines that leave
/// the grid.
Mask cells_under(RiverLines const& lines, Grid const& grid, std::string const& what);

/// The cells of a raster for surface.mask that are neither 0 nor no-data, or whose centres lie in polygons; without
/// cells for "".
/// \throws Error as io::read_dem, io::read_polygons and blend::mask_polygons; BadInput when a raster has not as many
/// cells as the grid
Mask read_mask_of_land(io::Source const& source, Grid const& grid, Run const& run);

/// The CRS of grid.crs, projected and in metres.
/// \throws BadInput naming the key, as io::projected_crs
std::string crs_of_grid(std::string const& crs);

/// A field that varies over the land, above 0: a raster, brought to the grid's cells, or polygons with a real field
/// erodibility, 1 between them (of several the last counts); empty for "". what: the key, for messages.
/// \throws Error as these readers; BadInput naming the cell where a raster has no value or one that is not above 0
Raster<float> read_field(io::Source const& source, Grid const& grid, std::string const& what, Run const& run);

/// [m] A DEM in a CRS, on cells as large as its own; without cells for "". what: the key or option, for messages.
/// \throws Error as io::read_dem and io::warp_to_grid
Raster<float> read_dem_in(io::Source const& source, std::string const& crs, std::string const& what,
                          io::ReadDemParams const& reading, StageLog& stage_log, Run const& run);

/// Measures the DEM of surface.like at a cell size.
/// \throws BadInput when it has too few cells with slopes
LikeDem measure_like(Recipe const& recipe, double cell_m, StageLog& stage_log, Run const& run);

/// A recipe on the cells of the DEM of output.against, as far as its [grid] leaves them open; rivers are clipped there.
/// \throws BadInput when the DEM has no CRS and the recipe none either; as io::read_dem
Recipe on_grid_of_against(Recipe recipe, Run const& run);

/// [m] The DEM of output.against; without cells for "". crs: of a DEM that has none.
Raster<float> read_against(Recipe const& recipe, std::string const& crs, StageLog& stage_log, Run const& run);

/// The DEM of output.against on a grid, and its gaps there.
struct AgainstOnGrid {
    Raster<float> dem;
    Mask land; ///< 0: a gap; without cells: there is none
};
AgainstOnGrid against_on_grid(Recipe const& recipe, Grid const& grid, StageLog& stage_log, Run const& run);

// The lines of a recipe, and settings derived from them.

/// What network::without_placeholders removed: "placeholder_heights".
Finding placeholder_finding(network::WithoutPlaceholders const& found);

/// The lines of network.lines.path, with findings on their heights.
RiverLines read_lines(Recipe const& recipe, Run const& run);

/// The lines of skeleton.ridge_lines, in the grid's CRS. Where some vertices of a line have heights, the others get
/// them by its length; where a file's heights are all 0, there are none: NaN.
RiverLines read_ridge_lines(Recipe const& recipe, Run const& run);

/// A recipe with the CRS and, if it was 0, the cell size of its grid chosen from its lines; and a mean slope chosen by
/// the cell size.
struct OnLines {
    Recipe recipe;
    std::string why; ///< reason for the cell size, as the end of a sentence; "": it was given
};
OnLines settle_on_lines(Recipe recipe, RiverLines const& lines, StageLog& stage_log, Run const& run);

/// A recipe's [grid], settled by the DEM of surface.source as far as it leaves that open, and the DEM on that grid.
struct OnRaster {
    GridRecipe grid;
    Raster<float> dem = {};
    std::vector<Finding> findings = {};
};

/// Heights of a file without a coordinate system are taken to be in that of the grid.
/// \throws Error as io::read_dem and io::resample; BadInput when no cell of the grid has a height
OnRaster settle_on_raster(Recipe const& recipe, Run const& run);

/// The usual mean slope [degrees] of terrain with cells of this size: gentler for coarser cells. Within 6 % of the mean
/// slopes of Big Tujunga averaged to cells of 75 to 1200 m.
double usual_slope_deg(double cell_m);

/// The greatest steepness of the main stems of a file's rivers without heights, where nothing else says how high the
/// terrain is: about the median of the DEMs of docs/relief_measures.md.
inline constexpr double usual_steepness = 45.0; ///< [m^0.9] for a concavity of 0.45

/// Throws BadInput if a file's coordinates are known not to be metres. grid: read from the file at path;
/// where: "commands.run_points", the function that asks.
void require_metres(Grid const& grid, std::string const& path, char const* where);

} // namespace thalweg::recipe
