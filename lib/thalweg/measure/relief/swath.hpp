// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::measure {

/// Options of swath().
struct SwathParams {
    double width_m = 1000.0; ///< [m] > 0, of the whole swath
    double step_m = 0.0;     ///< [m] >= 0 along the line; 0: one cell
};

/// A swath profile: heights beside a line, by the distance along it.
struct Swath {
    std::vector<double> distance_m;  ///< [m] along the line, middle of the step
    std::vector<double> mean;        ///< [m] NaN: no cell
    std::vector<double> min;         ///< [m] NaN: no cell
    std::vector<double> max;         ///< [m] NaN: no cell
    std::vector<std::int64_t> cells; ///< number of cells with data
};

/// Computes a swath profile.
/// \param dem [m] by cell; NaN: no data, left out
/// \param line [m] two vertices or more
/// \return of the cells whose centre is at most half the width from the line; a cell counts where the line is nearest
/// to its centre (ties: the first place). Beyond the ends of the line there is no swath.
/// \throws BadInput for a line of fewer than two vertices, or without length, or one that is not finite
/// \throws BadParameter for a width or step out of range
Swath swath(Raster<float> const& dem, std::vector<Vec2> const& line, SwathParams const& params = {},
            Run const& run = {});

} // namespace thalweg::measure
