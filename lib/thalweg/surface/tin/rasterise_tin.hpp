// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::surface {

/// Options of rasterise_tin().
struct RasteriseTinParams {
    /// Values of cells outside the TIN: NaN, or the height at the nearest point of its edge.
    enum class Outside : std::uint8_t { no_data, nearest };
    Outside outside = Outside::no_data;
};

/// Interpolates a TIN linearly at cell centres. A centre on an edge belongs to the triangle on its east (of a level
/// edge, its north), decided exactly: no cell is left out or drawn twice.
/// \param tin may be empty
/// \param grid of the result
/// \return [m] by cell: inside the TIN or on its edge computed in double, within the range of the triangle's corners
/// \throws BadInput naming a vertex that is not finite, or a triangle that is not counterclockwise or has an unknown
/// vertex
///
/// Source: scanlines with exact orientation tests where rounding could decide.
Raster<float> rasterise_tin(Tin const& tin, Grid const& grid, RasteriseTinParams const& params = {},
                            Run const& run = {});

} // namespace thalweg::surface
