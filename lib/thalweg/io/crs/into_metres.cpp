// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/internal/into_metres.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {
namespace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

constexpr double most_length_error = 0.01;
constexpr double most_error_without_zone = 0.1; // polar stereographic metres are more accurate

OGRSpatialReference plan_of(OGRSpatialReference const& reference) {
    OGRSpatialReference plan(reference);
    plan.StripVertical();
    plan.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return plan;
}

std::vector<Vec2> places_in(FileBox const& box) {
    constexpr int a_side = 5;
    std::vector<Vec2> places;
    for (int row = 0; row < a_side; ++row) {
        for (int col = 0; col < a_side; ++col) {
            double const east = static_cast<double>(col) / (a_side - 1);
            double const north = static_cast<double>(row) / (a_side - 1);
            places.push_back(
                {box.low.x + (box.high.x - box.low.x) * east, box.low.y + (box.high.y - box.low.y) * north});
        }
    }
    return places;
}

/// Longest and shortest image of a unit vector, and the area of a unit square's.
struct Axes {
    double longest = 1.0;
    double shortest = 1.0;
    double area = 1.0;
};

Axes axes_of(Vec2 x, Vec2 y) {
    double const squares = x.x * x.x + x.y * x.y + y.x * y.x + y.y * y.y;
    double const area = std::fabs(x.x * y.y - x.y * y.x);
    double const sum = std::sqrt(squares + 2.0 * area);
    double const difference = std::sqrt(std::max(squares - 2.0 * area, 0.0));
    return {0.5 * (sum + difference), 0.5 * (sum - difference), area};
}

// Mean error of lengths in a projected CRS over a box whose coordinates are in `own`; positions without longitude and
// latitude in `own` do not count, those without any in the other CRS count as 100 %.
double length_error(OGRSpatialReference const& projected, OGRSpatialReference const& own, FileBox const& box) {
    Driver const driver;
    OGRSpatialReference const from = plan_of(own);
    OGRSpatialReference const to = plan_of(projected);
    GroundScale const own_scale(from);
    GroundScale const scale(to);
    bool const is_own = name_of(from) == name_of(to);
    Transformation const turn(is_own ? nullptr : OGRCreateCoordinateTransformation(&from, &to));
    double sum = 0.0;
    int count = 0;
    for (Vec2 place : places_in(box)) {
        if (!own_scale.at(place)) {
            continue;
        }
        bool const moved = is_own || (turn && turn->Transform(1, &place.x, &place.y) != 0);
        auto const there = moved ? scale.at(place) : std::nullopt;
        sum += there ? there->error : 1.0;
        ++count;
    }
    return count == 0 ? 0.0 : sum / count;
}

// Nothing if a corner is not on the globe.
std::optional<DegreeBox> degrees_of(FileBox const& box, OGRCoordinateTransformation& turn) {
    constexpr int points_a_side = 21;
    Driver const driver; // a missing position is not an error
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

// metric_crs_around the middle of a box whose coordinates are in `from`. Longitudes on both sides of 180 degrees form
// one box if that is narrower. Throws BadInput when the middle has no longitude and latitude or the box spans more than
// 180 degrees of longitude.
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
    refuse_if<BadInput>(!on_earth, "io.into_metres",
                        "the middle of {}, at ({}, {}), has no longitude and latitude in its CRS, {}; check both", name,
                        at.x, at.y, from.GetName());
    auto const degrees = degrees_of(box, *turn);
    bool const has_zone = turned.y >= -80.0 && turned.y <= 84.0;
    if (!has_zone || !degrees) {
        return utm_zone(turned.x, turned.y);
    }
    require_half_a_globe(degrees->west, degrees->east, {"io.into_metres", name});
    return metric_crs_around(from, turned, degrees->east - degrees->west);
}

} // namespace

struct GroundScale::Turn {
    Transformation to_globe;
    double unit_rad = 1.0;
    double major_m = 1.0;
    double eccentricity_2 = 0.0;
};

GroundScale::GroundScale(OGRSpatialReference const& projected) : turn_(std::make_unique<Turn>()) {
    OGRSpatialReference const from = plan_of(projected);
    OGRSpatialReference* const base = from.CloneGeogCS();
    if (base == nullptr) {
        return;
    }
    base->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    turn_->to_globe.reset(OGRCreateCoordinateTransformation(&from, base));
    turn_->unit_rad = base->GetAngularUnits(nullptr);
    base->Release();
    double const inverse = from.GetInvFlattening();
    double const flattening = inverse > 0.0 ? 1.0 / inverse : 0.0;
    turn_->major_m = from.GetSemiMajor();
    turn_->eccentricity_2 = flattening * (2.0 - flattening);
}

GroundScale::~GroundScale() = default;

std::optional<PointScale> GroundScale::at(Vec2 place) const {
    if (!turn_->to_globe || !is_finite(place)) {
        return std::nullopt;
    }
    constexpr double step_m = 50.0; // large compared with PROJ's rounding, small compared with any curvature
    std::array<double, 5> x{place.x, place.x + step_m, place.x - step_m, place.x, place.x};
    std::array<double, 5> y{place.y, place.y, place.y, place.y + step_m, place.y - step_m};
    std::array<int, 5> done{};
    Driver const driver; // a position without longitude is not an error
    turn_->to_globe->Transform(5, x.data(), y.data(), nullptr, done.data());
    for (std::size_t i = 0; i < done.size(); ++i) {
        x[i] *= turn_->unit_rad;
        y[i] *= turn_->unit_rad;
        if (done[i] == 0 || !(std::fabs(x[i]) <= 4.0 * portable::pi) || !(std::fabs(y[i]) < 0.5 * portable::pi)) {
            return std::nullopt;
        }
    }
    double const sine = portable::sin(y[0]);
    double const w2 = 1.0 - turn_->eccentricity_2 * sine * sine;
    double const across_m = turn_->major_m / std::sqrt(w2) * portable::cos(y[0]);
    double const along_m = turn_->major_m * (1.0 - turn_->eccentricity_2) / (w2 * std::sqrt(w2));
    auto const on_ground = [&](std::size_t from, std::size_t to) {
        double const east = std::remainder(x[to] - x[from], 2.0 * portable::pi) * across_m;
        double const north = (y[to] - y[from]) * along_m;
        return Vec2{east / (2.0 * step_m), north / (2.0 * step_m)};
    };
    Axes const axes = axes_of(on_ground(2, 1), on_ground(4, 3));
    if (!(axes.shortest > 0.0)) {
        return std::nullopt;
    }
    return PointScale{std::sqrt(axes.area),
                      std::max(std::fabs(1.0 / axes.longest - 1.0), std::fabs(1.0 / axes.shortest - 1.0))};
}

bool is_distorted(OGRSpatialReference const& own, FileBox const& box) {
    return is_on_earth(own) && is_projected_in_metres(own) && length_error(own, own, box) > most_length_error;
}

bool is_better(OGRSpatialReference const& other, OGRSpatialReference const& own, FileBox const& box) {
    return length_error(other, own, box) <= 0.5 * length_error(own, own, box);
}

std::optional<std::string> less_distorted(OGRSpatialReference const& own, FileBox const& box, std::string const& name) {
    if (!is_distorted(own, box)) {
        return std::nullopt;
    }
    std::string zone;
    try {
        zone = zone_of(box, own, name);
    } catch (BadInput const&) { // around a pole or the globe
        if (length_error(own, own, box) > most_error_without_zone) {
            throw;
        }
        return std::nullopt;
    }
    return is_better(read_reference(zone), own, box) ? std::optional(std::move(zone)) : std::nullopt;
}

void FilePlaces::add(double x, double y) {
    low_ = {std::min(low_.x, x), std::min(low_.y, y)};
    high_ = {std::max(high_.x, x), std::max(high_.y, y)};
    double const turned = x < 0.0 ? x + 360.0 : x;
    turned_ = {std::min(turned_.x, turned), std::max(turned_.y, turned)};
    ++places_;
    whole_ += x == std::floor(x) && y == std::floor(y) ? 1 : 0;
}

FileBox FilePlaces::box() const {
    return {low_, high_, turned_, 2 * whole_ >= places_};
}

bool is_missing(OGRSpatialReference const* reference) {
    return reference == nullptr || reference->IsEmpty() ||
           (reference->GetName() != nullptr && std::string_view(reference->GetName()).starts_with("Undefined"));
}

OGRSpatialReference crs_of_layer(OGRSpatialReference const* own, std::string const& source_crs) {
    OGRSpatialReference const named = source_crs.empty() ? OGRSpatialReference() : read_reference(source_crs);
    return is_missing(own) ? named : *own;
}

std::optional<Finding> degrees_as_metres(OGRSpatialReference const& own, FileBox const& box, std::string const& name) {
    auto const within = [](Vec2 p) { return std::fabs(p.x) <= 360.0 && std::fabs(p.y) <= 90.0; };
    if (own.IsProjected() == 0 || box.is_whole || !within(box.low) || !within(box.high)) {
        return std::nullopt;
    }
    return Finding{.kind = "degrees_as_metres",
                   .where = box.low,
                   .amount = distance(box.low, box.high),
                   .text = fmt::format("the coordinates of {}, from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}), look like "
                                       "degrees but count as those of {}; if they are degrees, assign EPSG:4326 "
                                       "(--source-crs EPSG:4326, ogr2ogr -a_srs EPSG:4326)",
                                       name, box.low.x, box.low.y, box.high.x, box.high.y, own.GetName())};
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
    refuse_if<BadInput>(!turn_->into, "io.into_metres", "{} cannot be reprojected to {}", name, crs_);
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
