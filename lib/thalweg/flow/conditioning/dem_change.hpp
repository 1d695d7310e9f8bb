// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::flow {

/// The difference between two DEMs.
struct DemChange {
    std::int64_t raised_cells = 0;
    std::int64_t cut_cells = 0;
    double max_raise_m = 0.0;
    double max_cut_m = 0.0;
    double raised_m3 = 0.0;
    double cut_m3 = 0.0;

    double volume_m3() const { return raised_m3 + cut_m3; }
};

/// Compares two DEMs of one size. Cells without data in either are not compared.
/// \param before,after [m] by cell; NaN: no data
/// \return the cells that differ, and by how much
DemChange change_between(Raster<float> const& before, Raster<float> const& after);

} // namespace thalweg::flow
