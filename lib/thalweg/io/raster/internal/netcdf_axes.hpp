// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {

// What a NetCDF file says of its axes and GDAL does not tell.

/// The frame of cells by the coordinate variables x and y, which GDAL leaves out where they have no standard_name.
/// \param data the variable of heights
/// \return nothing: no NetCDF file, no such variables, or they are not evenly spaced
std::optional<std::array<double, 6>> frame_of_variables(Dataset const& data);

/// The unit of the coordinate variable along an axis.
/// \param axis "x" or "y"
/// \return as the file names it; "": not at all
std::string unit_of_axis(GDALDataset& data, std::string_view axis);

} // namespace thalweg::io
