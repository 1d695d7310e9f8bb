// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/internal/into_metres.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/frame/internal/ground_scale.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {

namespace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

constexpr double most_stretch = 0.04;

// Nothing where a corner has no place on the globe.
std::optional<DegreeBox> degrees_of(FileBox const& box, OGRCoordinateTransformation& turn) {
    constexpr int points_a_side = 21;
    Driver const driver; // that there is none is no error
    DegreeBox degrees;
    bool const done = turn.TransformBounds(box.low.x, box.low.y, box.high.x, box.high.y, &degrees.west, &degrees.south,
                                           &degrees.east, &degrees.north, points_a_side) != 0;
    bool const on_earth = done && std::fabs(degrees.west) <= 360.0 && std::fabs(degrees.east) <= 360.0 &&
                          std::fabs(degrees.south) <= 90.0 && std::fabs(degrees.north) <= 90.0;
    if (!on_earth) {
        return std::nullopt;
    }
    degrees.east += degrees.east < degrees.west ? 360.0 : 0.0; // across the antimeridian
    return degrees;
}

} // namespace

void FilePlaces::add(double x, double y) {
    low_ = {std::min(low_.x, x), std::min(low_.y, y)};
    high_ = {std::max(high_.x, x), std::max(high_.y, y)};
    double const turned = x < 0.0 ? x + 360.0 : x;
    turned_ = {std::min(turned_.x, turned), std::max(turned_.y, turned)};
}

FileBox FilePlaces::box() const {
    return {low_, high_, turned_};
}

bool is_missing(OGRSpatialReference const* reference) {
    return reference == nullptr || reference->IsEmpty() ||
           (reference->GetName() != nullptr && std::string_view(reference->GetName()).starts_with("Undefined"));
}

std::string zone_of(FileBox const& given, OGRSpatialReference const& from, std::string const& name) {
    FileBox box = given;
    if (from.IsGeographic() != 0 && box.across_180 && box.high.x - box.low.x > 180.0 &&
        box.across_180->y - box.across_180->x < box.high.x - box.low.x) {
        box.low.x = box.across_180->x;
        box.high.x = box.across_180->y;
    }
    Vec2 const at{0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y)};
    OGRSpatialReference const geographic = read_reference("EPSG:4326");
    Transformation const turn(OGRCreateCoordinateTransformation(&from, &geographic));
    Vec2 turned = at;
    bool const on_earth = turn && turn->Transform(1, &turned.x, &turned.y) != 0 && std::fabs(turned.x) <= 360.0 &&
                          std::fabs(turned.y) <= 90.0;
    if (!on_earth) {
        throw BadInput(
            fmt::format("io.into_metres: the middle of {}, at ({}, {}), has no longitude and latitude in its "
                        "CRS, {}; check both",
                        name, at.x, at.y, from.GetName()));
    }
    auto const degrees = degrees_of(box, *turn);
    bool const has_zone = turned.y >= -80.0 && turned.y <= 84.0;
    if (!has_zone || !degrees || utm_stretch(utm_zone(turned.x, turned.y), *degrees) <= most_stretch) {
        return utm_zone(turned.x, turned.y);
    }
    if (degrees->east - degrees->west > 180.0) {
        throw BadInput(
            fmt::format("io.into_metres: {} reaches over {:.0f} degrees of longitude, from {:.4g} to {:.4g}: "
                        "no projection in metres serves all of it. Cut a part out (ogr2ogr -clipsrc), or "
                        "name a CRS (--crs)",
                        name, degrees->east - degrees->west, degrees->west, degrees->east));
    }
    return name_of(equal_area_around(std::round(turned.x), std::round(turned.y)));
}

OGRSpatialReference crs_of_layer(OGRSpatialReference const* own, std::string const& source_crs) {
    OGRSpatialReference const named = source_crs.empty() ? OGRSpatialReference() : read_reference(source_crs);
    return is_missing(own) ? named : *own;
}

struct IntoMetres::Turn {
    Transformation into;
};

IntoMetres::IntoMetres(OGRSpatialReference const& own, std::string const& wanted, FileBox const& box,
                       std::string const& name, OwnMetres metres)
    : turn_(std::make_unique<Turn>()) {
    OGRSpatialReference from(own);
    height_unit_m_ = from.IsCompound() != 0 ? from.GetTargetLinearUnits("VERT_CS") : 1.0;
    from.StripVertical();
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!wanted.empty()) {
        crs_ = projected_crs(wanted);
    } else if (!is_projected_in_metres(from)) {
        crs_ = zone_of(box, from, name);
    } else {
        auto const other = metres == OwnMetres::judged ? less_distorted(from, box, name) : std::nullopt;
        crs_ = other.value_or(name_of(from));
    }
    if (crs_ == name_of(from)) {
        return;
    }
    OGRSpatialReference const to = read_reference(crs_);
    turn_->into.reset(OGRCreateCoordinateTransformation(&from, &to));
    if (!turn_->into) {
        throw BadInput(fmt::format("io.into_metres: {} cannot be reprojected to {}", name, crs_));
    }
}

IntoMetres::~IntoMetres() = default;

bool IntoMetres::moves() const {
    return turn_->into != nullptr;
}

std::vector<int> IntoMetres::apply(std::span<Vec3> points) const {
    std::vector<int> done(points.size(), 1);
    if (!moves()) {
        return done;
    }
    std::vector<double> x;
    std::vector<double> y;
    for (Vec3 const& p : points) {
        x.push_back(p.x);
        y.push_back(p.y);
    }
    turn_->into->Transform(static_cast<int>(points.size()), x.data(), y.data(), nullptr, done.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
        done[i] = done[i] != 0 && std::isfinite(x[i]) && std::isfinite(y[i]) ? 1 : 0;
        if (done[i] != 0) {
            points[i] = {rounded(x[i]), rounded(y[i]), points[i].z};
        }
    }
    return done;
}

} // namespace thalweg::io
