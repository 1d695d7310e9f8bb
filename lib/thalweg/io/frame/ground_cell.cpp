// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/ground_cell.hpp>

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/ground_scale.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {

namespace {

double side_of_geographic(Grid const& grid, OGRSpatialReference const& reference) {
    double const unit = reference.GetAngularUnits(nullptr);
    double const latitude = 0.5 * (grid.north + grid.south()) * unit;
    if (!(std::fabs(latitude) < portable::pi / 2.0)) {
        throw BadInput(
            fmt::format("io.ground_cell: the middle of the grid lies at latitude {:.3f} degrees, not between "
                        "the poles; give the grid its true place",
                        latitude * 180.0 / portable::pi));
    }
    double const flattening = reference.GetInvFlattening() > 0.0 ? 1.0 / reference.GetInvFlattening() : 0.0;
    double const eccentricity_2 = flattening * (2.0 - flattening);
    double const sine = portable::sin(latitude);
    // The root of the radii of curvature's product along the meridian and across it.
    double const radius =
        reference.GetSemiMajor() * std::sqrt(1.0 - eccentricity_2) / (1.0 - eccentricity_2 * sine * sine);
    return grid.cell_m * unit * radius * std::sqrt(portable::cos(latitude));
}

std::optional<std::string> crs_instead_of(OGRSpatialReference const& reference, Grid const& grid) {
    Driver const driver;
    return less_distorted(reference, {{grid.west, grid.south()}, {grid.east(), grid.north}}, "the grid");
}

} // namespace

GroundCell ground_cell(Grid const& grid) {
    if (grid.crs.empty()) {
        return {GridUnit::unknown, grid.cell_m, ""};
    }
    OGRSpatialReference reference = read_reference(grid.crs);
    reference.StripVertical();
    if (reference.IsGeographic() != 0) {
        return {GridUnit::degrees, side_of_geographic(grid, reference), ""};
    }
    if (is_projected_in_metres(reference)) {
        if (auto other = crs_instead_of(reference, grid)) {
            Driver const driver;
            auto const middle =
                GroundScale(reference).at({0.5 * (grid.west + grid.east()), 0.5 * (grid.south() + grid.north)});
            return {GridUnit::distorted, grid.cell_m * (middle ? middle->side_m : 1.0), std::move(*other)};
        }
        return {GridUnit::metres, grid.cell_m, name_of(reference)};
    }
    return {GridUnit::other, grid.cell_m * reference.GetLinearUnits(), ""};
}

bool is_distorted(Grid const& grid) {
    if (grid.crs.empty()) {
        return false;
    }
    OGRSpatialReference reference = read_reference(grid.crs);
    reference.StripVertical();
    return is_projected_in_metres(reference) && crs_instead_of(reference, grid).has_value();
}

} // namespace thalweg::io
