// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/raster.hpp>

namespace thalweg::io {

/// Reads a user's CRS: "EPSG:32633" or WKT; never a URL or file.
/// \param text the text
/// \return "EPSG:n" where it has a code, else WKT; of a CRS with heights its horizontal part.
/// \throws BadInput when it is none, is geographic, or is not in metres
std::string projected_crs(std::string const& text);

/// \pre latitude within [-80, 84]; zones are 6 degrees wide everywhere.
/// \param longitude_deg [degrees] longitude
/// \param latitude_deg [degrees] latitude
/// \return the UTM zone (WGS 84) of a geographic position, as "EPSG:326zz" or "EPSG:327zz".
/// \throws BadInput elsewhere
std::string utm_zone(double longitude_deg, double latitude_deg);

/// \param crs "EPSG:n" or WKT; "": none
/// \return the number of a UTM zone (WGS 84), 1 to 60, of "EPSG:326zz" or "EPSG:327zz"; nothing of another CRS.
std::optional<int> utm_number(std::string const& crs);

/// A box of longitudes and latitudes [degrees], west <= east, south <= north.
struct DegreeBox {
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
};

/// \param crs "EPSG:n" or WKT; "": none
/// \param box [degrees] longitudes and latitudes
/// \return by how much a UTM zone lengthens a line at most, anywhere in a box: 0.01 is 1 %; another CRS by 0.
///
/// Source: \cite snyder1987, Map Projections, eq. 8-4 (of the sphere).
double utm_stretch(std::string const& crs, DegreeBox const& box);

/// \param a a CRS
/// \param b a CRS
/// \param of_a what the first is, for messages
/// \param of_b what the second is, for messages
/// \return whether two CRS ("EPSG:n", WKT, "" for none) have the same horizontal coordinates.
/// \throws BadInput when exactly one of them is "", naming both sides; of_a and of_b name both sides in the message
bool same_crs(std::string const& a, std::string const& b, std::string const& of_a, std::string const& of_b);

/// \param a a grid
/// \param b a grid
/// \return whether the cells of two grids have sides of the same length, to a millionth; their units do not matter.
bool same_size(Grid const& a, Grid const& b);

/// \param a a grid
/// \param b a grid
/// \return whether two grids have cell for cell the same place, to a hundredth of a cell; their CRS do not matter.
bool same_cells(Grid const& a, Grid const& b);

/// What a grid's coordinates count.
enum class GridUnit : std::uint8_t {
    metres,    ///< of a projected CRS
    distorted, ///< metres of a projected CRS whose lengths are off by more than 1 %, as in Web Mercator
    degrees,   ///< of a geographic CRS, in whatever unit of angle
    other,     ///< feet, or metres of a CRS that is not projected
    unknown    ///< there is no CRS
};

/// What ground_cell() returns.
struct GroundCell {
    GridUnit unit = GridUnit::unknown;
    double side_m = 0.0; ///< [m]
    /// As projected_crs gives it: the grid's where the unit is metres, where it is distorted one to warp the grid to,
    /// else "".
    std::string crs;
};

/// How large a grid's cells are on the ground.
/// \param grid any grid with cells above 0
/// \return of a geographic or distorted grid the side of the square as large as a cell in the middle (of a geographic
/// one: in the middle row) on the CRS's ellipsoid; else the cell's own side, in metres where the CRS tells them.
/// \throws BadInput when the CRS is none, the middle of a geographic grid is not between the poles, or a distorted grid
/// spans more than 180 degrees of longitude
GroundCell ground_cell(Grid const& grid);

/// \param grid a grid, its CRS of any kind or ""
/// \return whether its coordinates are metres whose lengths are off by more than 1 % (GridUnit::distorted).
/// \throws BadInput when the CRS is none, or such a grid spans more than 180 degrees of longitude
bool is_distorted(Grid const& grid);

/// \pre grids with a CRS.
/// \param a a grid with a CRS
/// \param b a grid with a CRS
/// \param of_a what the first is, for messages
/// \param of_b what the second is, for messages
/// \return whether the boxes of longitudes and latitudes around two grids overlap.
/// \throws BadInput when one has no longitudes and latitudes; names whose
bool overlap_on_earth(Grid const& a, Grid const& b, std::string const& of_a, std::string const& of_b);

/// \pre a grid with a CRS.
/// \param grid the grid
/// \param what what it is, for messages
/// \return the CRS in which a grid's land is measured in metres: its own where that is projected in metres and lengths
/// are not off by more than 1 % there, else the UTM zone of its middle.
/// \throws BadInput when the middle is in no UTM zone
std::string metric_crs(Grid const& grid, std::string const& what);

/// \param grid the grid
/// \return by how much a grid's UTM zone lengthens lines at most: 0.01 is 1 %. 0 for a grid in another CRS or in none.
double zone_stretch(Grid const& grid);

} // namespace thalweg::io
