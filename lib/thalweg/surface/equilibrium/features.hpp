// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::surface {

/// A cell that terrain is drawn through.
struct FeatureCell {
    std::int64_t cell = 0;                             ///< index in the grid
    float z = std::numeric_limits<float>::quiet_NaN(); ///< [m]; NaN: free
    bool crest = false;                                ///< part of a ridge: no water crosses it
};

/// Moves terrain to known heights, and the land around each by less with the distance, as far as to the nearest river
/// at most.
/// \param dem [m]; NaN: no data
/// \param rivers cells that keep their heights; at least one
/// \param features by cell, each once
/// \return the known heights bit for bit, but for cells of rivers and without data
/// \throws BadInput for a cell outside the grid, cells out of order, or no river
Raster<float> through_heights(Raster<float> dem, std::vector<std::int64_t> const& rivers,
                              std::vector<FeatureCell> const& features, Run const& run = {});

} // namespace thalweg::surface
