// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/blend/paste.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::make {

/// Options of blend_into().
struct BlendIntoParams {
    std::string target = {};     ///< a DEM
    io::Source source = {};      ///< a DEM, in any CRS and of any cell size
    std::optional<Vec2> at = {}; ///< [m] of the target: where the patch's middle comes to lie
    double rotate_deg = 0.0;     ///< [deg] as in blend::PlacePatchParams
    double scale = 1.0;          ///< > 0, in plan
    double gain = 1.0;           ///< of heights
    io::Source mask = {};        ///< a raster on the target's grid, or polygons; "" for all the source covers
    std::string keep = {};       ///< a raster on the target's grid, or lines; "" for none
    std::optional<blend::SourceWindow> window = {}; ///< of the source file; all of it without
    double feather_cells = 0.0;                     ///< [cells] as in blend::PasteParams
    blend::Relief relief = blend::Relief::source;
    blend::Holes holes = blend::Holes::leave;
    io::ReadDemParams reading = {}; ///< how both DEMs are read
};

/// How the position of a patch was chosen.
enum class PatchPlace : std::uint8_t {
    given, ///< by the parameters
    own,   ///< by the source's coordinates
    middle ///< the source lies elsewhere: at the centre of the target
};

/// A blended DEM and its placement.
struct BlendedDem {
    blend::PastedDem pasted;
    PatchPlace place = PatchPlace::given;
    Vec2 at;                            ///< [m] the patch's centre
    std::int64_t outside = 0;           ///< cells of the mask off the source
    bool is_warped = false;             ///< the source had another CRS or cell size
    std::vector<Finding> findings = {}; ///< how the DEMs were read
};

/// Reads a DEM and pastes a patch of it into another: place_patch, then paste. A source in another CRS or with other
/// cells is warped first, after its window is cut out: to the target's CRS if both lie in the same part of the earth;
/// otherwise it is measured in its own CRS or, if that is not in metres, in its UTM zone.
/// \param target [m] the DEM to change; NaN: no data
/// \param keep cells of it that stay
/// \param params target is its name in messages, keep is not read
/// \return as the stages
/// \throws BadInput as the stages and readers, and when a rotated patch is pasted into a target in degrees
BlendedDem blend_into(Raster<float> const& target, Mask keep, BlendIntoParams const& params, Run const& run = {});

} // namespace thalweg::make
