// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Takes a network's heights from a DEM.
/// \param network a forest, in the DEM's coordinates
/// \param dem [m] by cell; NaN: no data
/// \return at each vertex the height of its cell or the minimum upstream, if lower: heights do not rise downstream
/// \throws BadInput naming the position of a vertex without data; for a network that is not a forest
ElevatedNetwork drape(StreamNetwork const& network, Raster<float> const& dem);

} // namespace thalweg::network
