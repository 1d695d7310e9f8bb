// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

class GDALDataset;
class OGRLayer;
class OGRSpatialReference;

/// Units of length in files.
namespace thalweg::io {

/// What 1 of a unit is in metres, by any of its usual names ("m", "metre", "ft", "US survey foot", "cm", ...); nothing
/// for a name that is not known.
std::optional<double> unit_named(std::string_view name);

/// "metres", "feet", "US survey feet", or "units of 0.9144 m".
std::string words_for_unit(double metres);

/// What 1 of a raster's heights is in metres: by the unit of its first band, else by the vertical part of its CRS, else
/// 1.
double height_unit_of(GDALDataset& dataset);

/// What 1 of the heights of a layer's lines or points is in metres: by the field z_unit of a network that thalweg
/// wrote, else by the vertical part of its CRS, else 1. source_crs: of a layer without a CRS, "" for none. Throws:
/// BadInput at a z_unit that is not known; IoError when the first feature cannot be read.
double height_unit_of(OGRLayer& layer, std::string const& source_crs = {});

/// Whether a CRS says in what unit heights are.
bool has_vertical_unit(OGRSpatialReference const* reference);

} // namespace thalweg::io
