// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Gives a network the heights of a DEM.
/// \pre a network whose components are trees, and heights in its coordinates.
/// \param network the network
/// \param dem [m] heights by cell; NaN: no data
/// \return at each vertex the height of its cell, or the least of all vertices upstream where that is lower: heights
/// never rise downstream.
/// \throws BadInput naming the place, when a vertex lies where the DEM has no height, or a component is not a tree
ElevatedNetwork drape(StreamNetwork const& network, Raster<float> const& dem);

} // namespace thalweg::network
