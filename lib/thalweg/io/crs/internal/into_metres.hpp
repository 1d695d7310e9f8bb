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

#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

class OGRSpatialReference;

namespace thalweg::io {

// The CRS of a file's coordinates, and the transformation to metres.

/// Whether a layer has no CRS, or an undefined one (a GeoPackage without a CRS has one named "Undefined").
bool is_missing(OGRSpatialReference const* reference);

/// Returns the CRS of a layer's coordinates: its own, or the user's if it has none.
/// \param own null: none
/// \param source_crs the user's; "": none
/// \return empty: neither
/// \throws BadInput when the user's is not a CRS, even if it is not needed
OGRSpatialReference crs_of_layer(OGRSpatialReference const* own, std::string const& source_crs);

/// Bounding box of the data read from a file, in its coordinates.
struct FileBox {
    Vec2 low;
    Vec2 high;
    std::optional<Vec2> across_180 = {}; ///< [degrees] low.x and high.x as longitudes from 0 to 360
    bool is_whole = false;               ///< most coordinates are whole numbers
};

/// Accumulates the bounding box of positions.
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
    std::int64_t places_ = 0;
    std::int64_t whole_ = 0; ///< places of whole numbers
};

/// Finds coordinates that are degrees, though their CRS is projected: a wrong CRS was assigned or named. Whole numbers
/// are taken for metres.
/// \param own the file's CRS
/// \param box of the data
/// \param name of the file, for messages
/// \return a warning, degrees_as_metres [m]: the length of the box's diagonal; nothing for others
std::optional<Finding> degrees_as_metres(OGRSpatialReference const& own, FileBox const& box, std::string const& name);

/// Treatment of a file's own CRS that is projected in metres.
enum class OwnMetres : std::uint8_t {
    judged, ///< not used if lengths are wrong by more than 1 % and another CRS is better: Web Mercator
    kept
};

/// A transformation from a file's CRS to one in metres. Needs a Driver that outlives it.
class IntoMetres {
public:
    /// Chooses the target CRS.
    /// \param own the file's CRS
    /// \param wanted the target; "": the file's own if it is projected in metres that are metres on the ground
    /// (OwnMetres), else metric_crs_around() the middle of the box
    /// \param box of the data, in the file's coordinates
    /// \param name of the file, for messages
    /// \throws BadInput when there is no CRS, or the data span more than 180 degrees of longitude: "io.into_metres:
    /// name ..."
    IntoMetres(OGRSpatialReference const& own, std::string const& wanted, FileBox const& box, std::string const& name,
               OwnMetres metres = OwnMetres::judged);
    ~IntoMetres();
    IntoMetres(IntoMetres const&) = delete;
    IntoMetres& operator=(IntoMetres const&) = delete;

    std::string const& crs() const { return crs_; }
    /// Whether apply() changes positions in plan.
    bool moves() const;
    /// \return [m] the unit of the file's heights.
    double height_unit_m() const { return height_unit_m_; }
    /// Projects positions in plan, to 1e-6 m; heights stay.
    /// \return by point: 1: projected, 0: impossible, the point keeps its position
    std::vector<int> apply(std::span<Vec3> points) const;

private:
    struct Turn;
    std::unique_ptr<Turn> turn_;
    std::string crs_;
    double height_unit_m_ = 1.0;
};

// Lengths on the ground of metres of a projected CRS.

/// The scale of a projected CRS at one position.
struct PointScale {
    double side_m = 1.0; ///< [m] side of the square on the ground with the area of a square metre of the CRS
    double error = 0.0;  ///< largest relative error of lengths in any direction: 0.01 is 1 %
};

/// The point scale of a projected CRS, on its ellipsoid (Tissot's indicatrix). Source: \cite snyder1987, Map
/// Projections, ch. 4. Needs a Driver that outlives it.
class GroundScale {
public:
    explicit GroundScale(OGRSpatialReference const& projected);
    ~GroundScale();
    GroundScale(GroundScale const&) = delete;
    GroundScale& operator=(GroundScale const&) = delete;

    /// \return nothing if a position has no longitude and latitude.
    std::optional<PointScale> at(Vec2 place) const;

private:
    struct Turn;
    std::unique_ptr<Turn> turn_;
};

/// Whether lengths in a CRS of the Earth projected in metres are wrong by more than 1 % on average over a box.
bool is_distorted(OGRSpatialReference const& own, FileBox const& box);

/// Whether lengths in the other CRS have at most half the error of the own one.
bool is_better(OGRSpatialReference const& other, OGRSpatialReference const& own, FileBox const& box);

/// Finds a better CRS for data whose own, projected in metres, has lengths wrong by more than 1 %; nothing: they are
/// not, or no other is better. Throws BadInput as zone_of when they are wrong by more than 10 %.
std::optional<std::string> less_distorted(OGRSpatialReference const& own, FileBox const& box, std::string const& name);

} // namespace thalweg::io
