// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <thalweg/core/vec.hpp>
#include <thalweg/io/frame/internal/into_metres.hpp>

class OGRSpatialReference;

/// How long metres of a projected CRS are on the ground. Private to this module.
namespace thalweg::io {

/// Metres of a projected CRS at one place.
struct PointScale {
    double side_m = 1.0; ///< [m] of a square on the ground as large as a square metre of the CRS
    double error = 0.0; ///< by how much the length of a line is off, in the direction where it is off most: 0.01 is 1 %
};

/// The point scale of a projected CRS, on its ellipsoid (Tissot's indicatrix).
/// Source: \cite snyder1987, Map Projections, ch. 4. Needs a Driver that outlives it.
class GroundScale {
public:
    explicit GroundScale(OGRSpatialReference const& projected);
    ~GroundScale();
    GroundScale(GroundScale const&) = delete;
    GroundScale& operator=(GroundScale const&) = delete;

    /// Nothing where a place has no longitude and latitude.
    std::optional<PointScale> at(Vec2 place) const;

private:
    struct Turn;
    std::unique_ptr<Turn> turn_;
};

/// By how much lengths in a projected CRS are off, on average over a box whose coordinates are in `own`; places without
/// longitude and latitude in `own` do not count, those without any in the other CRS count as off by 100 %.
double length_error(OGRSpatialReference const& projected, OGRSpatialReference const& own, FileBox const& box);

/// Whether lengths in a CRS that is projected in metres are off by more than 1 % on average over a box.
bool is_distorted(OGRSpatialReference const& own, FileBox const& box);

/// Whether lengths in the other CRS are at most half as much off as in the own one.
bool is_better(OGRSpatialReference const& other, OGRSpatialReference const& own, FileBox const& box);

/// The UTM zone of the middle of a box whose coordinates are in `from`; where that lengthens lines by more than 4 %,
/// Lambert's azimuthal equal-area projection around the middle. Longitudes on both sides of 180 degrees are one box
/// where that is narrower. Throws: BadInput where the middle has no longitude and latitude or the box spans more than
/// 180 degrees of longitude: "io.into_metres: name ...".
std::string zone_of(FileBox const& box, OGRSpatialReference const& from, std::string const& name);

/// The CRS into which what fills a box is brought because lengths in its own, projected in metres, are off by more than
/// 1 %; nothing where they are not, or no other is better. Throws: BadInput like zone_of, where they are off by more
/// than 10 %.
std::optional<std::string> less_distorted(OGRSpatialReference const& own, FileBox const& box, std::string const& name);

} // namespace thalweg::io
