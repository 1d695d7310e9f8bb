// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

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
#include <thalweg/make/make.hpp>
#include <thalweg/network/planform/split_confluences.hpp>

namespace thalweg::make {

// Heights as files have them.

/// A DEM in metres in another unit.
/// \return the nearest float of each height, or, where two heights that differ would become one, the next float above
/// the lower: heights that differ do so afterwards, in the same order, so that water runs where it ran.
Raster<float> in_unit(Raster<float> const& dem, HeightUnit unit);

Tin in_unit(Tin tin, HeightUnit unit);

// The user's columns of a terrain's rivers.

/// What the file said of the lines that became these arcs; nothing for grown rivers.
std::optional<io::UserData> user_data(MakeResult const& t, StreamNetwork const& plan);

/// The columns that have other names in the shapefiles.
std::vector<io::ShortenedName> shortened_names(MakeResult const& t);

/// Appends the contributing areas of the arcs that splitting confluences added: a piece upstream of where a tributary
/// was moved to has lost the tributary's area, one downstream has gained it, so that what flows into a node still
/// equals what leaves it.
/// \param us_area_m2,ds_area_m2 of the other arcs; -1: unknown
void add_pieces(std::vector<network::SplitPiece> const& pieces, std::vector<double>& us_area_m2,
                std::vector<double>& ds_area_m2);

/// Contributing areas of nodes: that of the arc that leaves one, or of all that come to an outlet; -1 where one of
/// these is not known.
std::vector<double> node_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                               std::vector<double> const& ds_area_m2);

/// What a file says of catchments. basins: by reach.
std::vector<io::CatchmentRow> catchment_rows(std::vector<flow::Reach> const& reaches,
                                             std::vector<std::int64_t> const& basins,
                                             flow::Catchments const& catchments);

/// Contributing areas in m2 for a file, NaN without data.
Raster<double> areas_m2(flow::FlowField const& drainage);
Raster<double> areas_m2(Raster<double> const& area_cells);

} // namespace thalweg::make
