// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::surface {

/// Heights [m] of a problem's values: fixed cells take the bits of z, free ones are rounded once, cells outside are
/// NaN. Takes: kind: a solver::CellKind a cell; all three of one frame.
Raster<float> heights_of(Raster<double> const& value, Raster<std::uint8_t> const& kind, Raster<float> const& z);

} // namespace thalweg::surface
