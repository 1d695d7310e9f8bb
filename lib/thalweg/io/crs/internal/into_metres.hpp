// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

class OGRSpatialReference;

namespace thalweg::io {

// What a file's coordinates are in, and the way from there to metres.

/// Whether a layer has no CRS, or one that says so (a GeoPackage without CRS has one that is named "Undefined").
bool is_missing(OGRSpatialReference const* reference);

/// The CRS that a layer's coordinates are in: its own, or where it has none the one that a user names ("" for none).
/// Gives: an empty one where there is neither. Throws: BadInput where the user's is not a CRS, also where it is not
/// needed.
OGRSpatialReference crs_of_layer(OGRSpatialReference const* own, std::string const& source_crs);

/// What is read of a file, in its coordinates.
struct FileBox {
    Vec2 low;
    Vec2 high;
    std::optional<Vec2> across_180 = {}; ///< [degrees] low.x and high.x if these are longitudes, from 0 to 360
};

/// The box of places, as they are added.
class FilePlaces {
public:
    void add(double x, double y);
    /// Whether there are any.
    bool any() const { return low_.x <= high_.x; }
    FileBox box() const;

private:
    static constexpr double far = std::numeric_limits<double>::infinity();
    Vec2 low_{far, far};
    Vec2 high_{-far, -far};
    Vec2 turned_{far, -far};
};

/// What becomes of a file's own CRS that is projected in metres.
enum class OwnMetres : std::uint8_t {
    judged, ///< it is left where lengths are off by more than 1 % and another CRS is better: Web Mercator
    kept
};

/// A projection from a file's CRS into one in metres. Needs a Driver that outlives it.
class IntoMetres {
public:
    /// Takes: the file's CRS; the one wanted, "" for the file's own when it is projected in metres and these are metres
    /// on the ground (OwnMetres), else the UTM zone of the middle of what is read, in the file's coordinates; where
    /// that lengthens lines by more than 4 %, Lambert's azimuthal equal-area projection around the middle. Throws:
    /// BadInput when there is none, or more than 180 degrees of longitude are read: "io.into_metres: name ...".
    IntoMetres(OGRSpatialReference const& own, std::string const& wanted, FileBox const& box, std::string const& name,
               OwnMetres metres = OwnMetres::judged);
    ~IntoMetres();
    IntoMetres(IntoMetres const&) = delete;
    IntoMetres& operator=(IntoMetres const&) = delete;

    std::string const& crs() const { return crs_; }
    /// Whether apply() changes anything in plan.
    bool moves() const;
    /// What 1 in the file's heights is.
    double height_unit_m() const { return height_unit_m_; }
    /// Projects positions in plan, to 1e-6 m; heights stay. Gives: by point 1 where it could be projected, else 0, and
    /// the point keeps its place.
    std::vector<int> apply(std::span<Vec3> points) const;

private:
    struct Turn;
    std::unique_ptr<Turn> turn_;
    std::string crs_;
    double height_unit_m_ = 1.0;
};

// How long metres of a projected CRS are on the ground.

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

/// Whether lengths in a CRS that is projected in metres are off by more than 1 % on average over a box.
bool is_distorted(OGRSpatialReference const& own, FileBox const& box);

/// Whether lengths in the other CRS are at most half as much off as in the own one.
bool is_better(OGRSpatialReference const& other, OGRSpatialReference const& own, FileBox const& box);

/// The CRS into which what fills a box is brought because lengths in its own, projected in metres, are off by more than
/// 1 %; nothing where they are not, or no other is better. Throws: BadInput like zone_of, where they are off by more
/// than 10 %.
std::optional<std::string> less_distorted(OGRSpatialReference const& own, FileBox const& box, std::string const& name);

} // namespace thalweg::io
