// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::surface {

/// Throws: BadInput: a grid without cells, or with cells whose side is not above 0.
void check_frame(Grid const& grid);

/// Throws: BadInput: a valley in which no cell has a height, or one has an infinite height.
void check_heights(Raster<float> const& valley);

/// Throws: BadInput: the mask has another frame than the valley.
void check_mask(Grid const& valley, Grid const& mask);

} // namespace thalweg::surface
