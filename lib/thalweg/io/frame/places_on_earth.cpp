// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/places_on_earth.hpp>

#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/ground_cell.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {
namespace {

struct Degrees {
    double west = 0.0;
    double south = 0.0;
    double east = 0.0; // may exceed 180, not west + 360
    double north = 0.0;
};

Degrees box_of(Grid const& grid, std::string const& what) {
    Driver const driver;
    OGRSpatialReference const from = read_reference(grid.crs);
    OGRSpatialReference const globe = read_reference("EPSG:4326");
    std::unique_ptr<OGRCoordinateTransformation> const turn(OGRCreateCoordinateTransformation(&from, &globe));
    Degrees box;
    constexpr int points_a_side = 21;
    if (!turn || turn->TransformBounds(grid.west, grid.south(), grid.east(), grid.north, &box.west, &box.south,
                                       &box.east, &box.north, points_a_side) == 0) {
        throw BadInput(fmt::format("{} lies where its CRS has no longitude and latitude; check its position: {}", what,
                                   driver.take()));
    }
    if (box.east < box.west) {
        box.east += 360.0; // across the antimeridian
    }
    return box;
}

} // namespace

bool overlap_on_earth(Grid const& a, Grid const& b, std::string const& of_a, std::string const& of_b) {
    Degrees const p = box_of(a, of_a);
    Degrees const q = box_of(b, of_b);
    bool overlaps = false;
    for (double const turn : {-360.0, 0.0, 360.0}) {
        overlaps = overlaps || (p.west < q.east + turn && q.west + turn < p.east);
    }
    return overlaps && p.south < q.north && q.south < p.north;
}

double zone_stretch(Grid const& grid) {
    if (!utm_number(grid.crs)) {
        return 0.0;
    }
    try {
        Degrees const box = box_of(grid, "the grid");
        return utm_stretch(grid.crs, {box.west, box.south, box.east, box.north});
    } catch (BadInput const&) { // as far away as that
        return std::numeric_limits<double>::infinity();
    }
}

std::string metric_crs(Grid const& grid, std::string const& what) {
    if (is_projected_in_metres(read_reference(grid.crs))) {
        GroundCell const ground = ground_cell(grid);
        return ground.unit == GridUnit::distorted ? ground.crs : grid.crs;
    }
    Degrees const box = box_of(grid, what);
    return utm_zone(0.5 * (box.west + box.east), 0.5 * (box.south + box.north));
}

} // namespace thalweg::io
