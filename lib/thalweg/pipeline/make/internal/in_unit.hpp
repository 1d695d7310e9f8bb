// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/tin.hpp>

/// Heights as files have them. Private to this module.
namespace thalweg::pipeline {

/// A DEM in metres in another unit.
/// Gives: the nearest float of each height, or, where two heights that differ would become one, the next float above
/// the lower: heights that differ do so afterwards, in the same order, so that water runs where it ran.
Raster<float> in_unit(Raster<float> const& dem, HeightUnit unit);

Tin in_unit(Tin tin, HeightUnit unit);

} // namespace thalweg::pipeline
