// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/raster/polygons.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// What a file says of catchments. basins: by reach.
std::vector<io::CatchmentRow> catchment_rows(std::vector<flow::Reach> const& reaches,
                                             std::vector<std::int64_t> const& basins,
                                             flow::Catchments const& catchments);

/// Contributing areas in m2 for a file, NaN without data.
Raster<double> areas_m2(flow::FlowField const& drainage);
Raster<double> areas_m2(Raster<double> const& area_cells);

} // namespace thalweg::pipeline
