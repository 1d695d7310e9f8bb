// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>

namespace thalweg::io {

/// Reads a user's CRS: "EPSG:32633" or WKT; never a URL or file.
/// \param text as typed
/// \return "EPSG:n" if it has a code, else WKT; of a CRS with heights its horizontal part
/// \throws BadInput when it is not a CRS, is geographic, or is not in metres
std::string projected_crs(std::string const& text);

/// Names a CRS in words.
/// \param crs "EPSG:n" or WKT; "": none
/// \return such as "WGS 84 / UTM zone 31N"; "" for none, or one without a name
std::string crs_in_words(std::string const& crs);

/// Finds the UTM zone (WGS 84) of a position; zones are 6 degrees wide everywhere.
/// \param longitude_deg [degrees] longitude
/// \param latitude_deg [degrees] latitude in [-80, 84]
/// \return "EPSG:326zz" or "EPSG:327zz"
/// \throws BadInput elsewhere
std::string utm_zone(double longitude_deg, double latitude_deg);

/// Recognises UTM zones (WGS 84).
/// \param crs "EPSG:n" or WKT; "": none
/// \return 1 to 60 for "EPSG:326zz" or "EPSG:327zz"; nothing for another CRS
std::optional<int> utm_number(std::string const& crs);

/// A box of longitudes and latitudes [degrees], west <= east, south <= north.
struct DegreeBox {
    double west = 0.0;  ///< [deg]
    double south = 0.0; ///< [deg]
    double east = 0.0;  ///< [deg]
    double north = 0.0; ///< [deg]
};

/// Computes the largest relative error of lengths in a UTM zone, anywhere in a box.
/// \param crs "EPSG:n" or WKT; "": none
/// \param box [degrees] longitudes and latitudes
/// \return 0.01: lines are up to 1 % too long; 0: another CRS
///
/// Source: \cite snyder1987, Map Projections, eq. 8-4 (of the sphere).
double utm_stretch(std::string const& crs, DegreeBox const& box);

/// Compares the horizontal coordinates of two CRS.
/// \param a,b "EPSG:n" or WKT; "": none
/// \param of_a,of_b what they belong to, for messages
/// \return whether they are the same
/// \throws BadInput naming both sides when exactly one of them is ""
bool same_crs(std::string const& a, std::string const& b, std::string const& of_a, std::string const& of_b);

/// Compares the cell sizes of two grids.
/// \param a,b grids in any units
/// \return whether cells have the same side, to a millionth
bool same_size(Grid const& a, Grid const& b);

/// Compares the lattices of two grids.
/// \param a,b grids; their CRS do not matter
/// \return whether cells of one are cells of the other where both lie, to a hundredth of a cell
bool same_lattice(Grid const& a, Grid const& b);

/// Compares the cells of two grids.
/// \param a,b grids; their CRS do not matter
/// \return whether all cells have the same positions, to a hundredth of a cell
bool same_cells(Grid const& a, Grid const& b);

/// The unit of a grid's coordinates.
enum class GridUnit : std::uint8_t {
    metres,    ///< of a projected CRS
    distorted, ///< metres of a projected CRS whose lengths are wrong by more than 1 %, as in Web Mercator
    degrees,   ///< of a geographic CRS, in any unit of angle
    other,     ///< feet, or metres of a CRS that is not projected
    unknown    ///< no CRS
};

/// What ground_cell() returns.
struct GroundCell {
    GridUnit unit = GridUnit::unknown;
    double side_m = 0.0; ///< [m]
    /// as from projected_crs: the grid's own for metres; for distorted the one to warp the grid to; else ""
    std::string crs;
};

/// Computes the size of a grid's cells on the ground.
/// \param grid any grid with cells above 0
/// \return of a geographic or distorted grid the side of the square with the area of a central cell (geographic: in the
/// middle row) on the CRS's ellipsoid; else the cell's own side, in metres if the CRS specifies them
/// \throws BadInput when the CRS is invalid, the middle of a geographic grid is not between the poles, or a distorted
/// grid spans more than 180 degrees of longitude
GroundCell ground_cell(Grid const& grid);

/// Tells whether a grid's coordinates are metres whose lengths are wrong by more than 1 % (GridUnit::distorted).
/// \param grid with any CRS, or none
/// \return true: distorted
/// \throws BadInput when the CRS is invalid, or such a grid spans more than 180 degrees of longitude
bool is_distorted(Grid const& grid);

/// Tells whether the bounding boxes of two grids in longitude and latitude overlap.
/// \param a,b grids with a CRS
/// \param of_a,of_b what they are, for messages
/// \return true: they overlap
/// \throws BadInput naming the grid that has no longitudes and latitudes
bool overlap_on_earth(Grid const& a, Grid const& b, std::string const& of_a, std::string const& of_b);

/// Chooses the CRS for measurements in metres.
/// \param grid with a CRS
/// \param what its name in messages
/// \return the grid's own CRS if it is projected in metres and lengths are not wrong by more than 1 %, else the UTM
/// zone of its middle; where that does not serve (more than 12 degrees wide, near a pole, not on the Earth) an
/// equal-area projection around the middle
/// \throws BadInput when the grid has no longitude and latitude, or reaches over more than 180 degrees of longitude
std::string metric_crs(Grid const& grid, std::string const& what);

/// Computes the largest relative error of lengths in a grid's UTM zone.
/// \param grid any grid
/// \return 0.01: lines are up to 1 % too long; 0: another CRS or none
double zone_stretch(Grid const& grid);

} // namespace thalweg::io
