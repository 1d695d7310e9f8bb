// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/into_metres.hpp>

#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/projection.hpp>
#include <thalweg/io/spatial_reference.hpp>

namespace thalweg::io {

namespace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

// The UTM zone of a position.
std::string zone_of(Vec2 at, OGRSpatialReference const& from, std::string const& name) {
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
    return utm_zone(turned.x, turned.y);
}

// PROJ's last bits differ between machines: a millionth of a metre does not.
} // namespace

bool is_missing(OGRSpatialReference const* reference) {
    return reference == nullptr || reference->IsEmpty() != 0 ||
           (reference->GetName() != nullptr && std::string_view(reference->GetName()).starts_with("Undefined"));
}

struct IntoMetres::Turn {
    Transformation into;
};

IntoMetres::IntoMetres(OGRSpatialReference const& own, std::string const& wanted, Vec2 middle, std::string const& name)
    : turn_(std::make_unique<Turn>()) {
    OGRSpatialReference from(own);
    height_unit_m_ = from.IsCompound() != 0 ? from.GetTargetLinearUnits("VERT_CS") : 1.0;
    from.StripVertical();
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    crs_ = !wanted.empty()                ? projected_crs(wanted)
           : is_projected_in_metres(from) ? name_of(from)
                                          : zone_of(middle, from, name);
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
