// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

class OGRLayer;
class OGRSpatialReference;

/// Units of length in files.
namespace thalweg::io {

/// The length of a unit [m] by any of its usual names ("m", "metres", "ft", "US survey foot", "fathom", ...); nothing:
/// unknown.
std::optional<double> unit_named(std::string_view name);

/// "metres", "kilometres", "feet", "US survey feet", "fathoms", or "units of 0.9144 m".
std::string words_for_unit(double metres);

/// The unit of heights of a layer's lines or points [m]: from the field z_unit of a network that thalweg wrote, else
/// from the vertical part of its CRS, else 1.
/// \param layer lines or points
/// \param source_crs of a layer without a CRS; "": none
/// \throws BadInput when z_unit is unknown
/// \throws IoError when the first feature cannot be read
double height_unit_of(OGRLayer& layer, std::string const& source_crs = {});

/// Whether a CRS specifies the unit of heights.
bool has_vertical_unit(OGRSpatialReference const* reference);

} // namespace thalweg::io
