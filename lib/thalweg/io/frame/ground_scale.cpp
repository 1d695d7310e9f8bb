// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/internal/ground_scale.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {

namespace {

using Turning = std::unique_ptr<OGRCoordinateTransformation>;

constexpr double most_length_error = 0.01;
constexpr double most_error_without_zone = 0.1; // polar stereographic metres are better

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

} // namespace

struct GroundScale::Turn {
    Turning to_globe;
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
    if (!turn_->to_globe || !std::isfinite(place.x) || !std::isfinite(place.y)) {
        return std::nullopt;
    }
    constexpr double step_m = 50.0; // long beside PROJ's last bits, short beside any curvature
    std::array<double, 5> x{place.x, place.x + step_m, place.x - step_m, place.x, place.x};
    std::array<double, 5> y{place.y, place.y, place.y, place.y + step_m, place.y - step_m};
    std::array<int, 5> done{};
    Driver const driver; // that a place has no longitude is no error
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

double length_error(OGRSpatialReference const& projected, OGRSpatialReference const& own, FileBox const& box) {
    Driver const driver;
    OGRSpatialReference const from = plan_of(own);
    OGRSpatialReference const to = plan_of(projected);
    GroundScale const own_scale(from);
    GroundScale const scale(to);
    bool const is_own = name_of(from) == name_of(to);
    Turning const turn(is_own ? nullptr : OGRCreateCoordinateTransformation(&from, &to));
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

bool is_distorted(OGRSpatialReference const& own, FileBox const& box) {
    return is_projected_in_metres(own) && length_error(own, own, box) > most_length_error;
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
    } catch (BadInput const&) { // round a pole or the globe
        if (length_error(own, own, box) > most_error_without_zone) {
            throw;
        }
        return std::nullopt;
    }
    return is_better(read_reference(zone), own, box) ? std::optional(std::move(zone)) : std::nullopt;
}

} // namespace thalweg::io
