// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

namespace thalweg::flow {

/// Drains depressions with the least volume moved: of each, the cheapest of filling it, of cutting its lowest cell a
/// way out, and, among rivers, of filling it part of the way (in eighths of its depth) and cutting from there. A cut
/// leaves the smaller depressions in it to be treated in turn.
/// Takes: as fill; least: what cells must not be cut below (confine_channels), NaN where any depth will do.
/// Gives: drained as after fill, which does the rest; no more volume than fill would move; river cells as they were,
/// no cell cut below its least. A cut follows the way on which it moves the least, and falls by small steps to a cell
/// that drains: lower land, a river, the border or no data.
/// Throws: as fill.
/// Source: Soille 2004; Lindsay 2016 (least-cost breaching); Barnes, Lehman and Mulla 2014.
Raster<float> carve(Raster<float> const& dem, Valley const& valley, Raster<float> const& least, Run const& run = {});

} // namespace thalweg::flow
