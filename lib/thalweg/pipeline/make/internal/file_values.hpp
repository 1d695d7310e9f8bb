// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/pipeline/make/make.hpp>

namespace thalweg::pipeline {

// Heights as stored in files.

/// Converts a DEM from metres to another unit. The result is the nearest float of each height; if two different heights
/// would become equal, the higher becomes the next float above the lower: different heights stay different and in
/// order, so that flow does not change.
Raster<float> in_unit(Raster<float> const& dem, HeightUnit unit);

Tin in_unit(Tin tin, HeightUnit unit);

// The user's columns for a terrain's rivers.

/// The file's attributes of the lines that became these arcs; nothing for grown rivers.
std::optional<io::UserData> user_data(Made const& t, StreamNetwork const& plan);

/// The columns renamed in the shapefiles.
std::vector<io::ShortenedName> shortened_names(Made const& t);

/// Contributing areas of the arcs added by splitting confluences. A piece upstream of where a tributary was moved to
/// loses the tributary's area, one downstream gains it: inflow and outflow of nodes stay equal. Areas: -1: unknown.
void add_pieces(std::vector<network::SplitPiece> const& pieces, std::vector<double>& us_area_m2,
                std::vector<double>& ds_area_m2);

/// Contributing areas of nodes: of the arc that leaves, or at an outlet the sum of those that enter; -1: one of these
/// is unknown.
std::vector<double> node_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                               std::vector<double> const& ds_area_m2);

/// Rows of catchments for a file. basins: by reach.
std::vector<io::CatchmentRow> catchment_rows(std::vector<flow::Reach> const& reaches,
                                             std::vector<std::int64_t> const& basins,
                                             flow::Catchments const& catchments);

/// Contributing areas in m2 for a file; NaN: no data.
Raster<double> areas_m2(flow::FlowField const& drainage);
Raster<double> areas_m2(Raster<double> const& area_cells);

} // namespace thalweg::pipeline
