// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::flow {

/// Refuses grids whose cells CellCount cannot count.
/// \throws BadInput naming the function
void require_countable(Grid const& grid, char const* where);

} // namespace thalweg::flow
