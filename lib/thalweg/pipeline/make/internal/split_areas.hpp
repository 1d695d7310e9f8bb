// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/planform/split_confluences.hpp>

namespace thalweg::pipeline {

/// Contributing areas of the arcs that splitting confluences added. Takes: those of the arcs that were there, -1 where
/// they are not known. Gives: a piece that lies upstream of where a tributary was moved to has lost the tributary's
/// area, one downstream has gained it: what flows into a node is what leaves it, as before.
void add_pieces(std::vector<network::SplitPiece> const& pieces, std::vector<double>& us_area_m2,
                std::vector<double>& ds_area_m2);

/// Contributing areas of nodes: that of the arc that leaves one, or of all that come to an outlet; -1 where one of
/// these is not known.
std::vector<double> node_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                               std::vector<double> const& ds_area_m2);

} // namespace thalweg::pipeline
