// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/dem_change.hpp>

#include <algorithm>

namespace thalweg::flow {

DemChange change_between(Raster<float> const& before, Raster<float> const& after) {
    DemChange change;
    double const cell_m2 = before.grid().cell_m * before.grid().cell_m;
    for (std::int64_t r = 0; r < before.height(); ++r) {
        auto const was = before.row(r);
        auto const is = after.row(r);
        double raised_m = 0.0; // by rows, so that small changes are not lost in a large sum
        double cut_m = 0.0;
        for (std::size_t c = 0; c < was.size(); ++c) {
            double const rise = static_cast<double>(is[c]) - static_cast<double>(was[c]);
            if (rise > 0.0) {
                ++change.raised_cells;
                change.max_raise_m = std::max(change.max_raise_m, rise);
                raised_m += rise;
            } else if (rise < 0.0) {
                ++change.cut_cells;
                change.max_cut_m = std::max(change.max_cut_m, -rise);
                cut_m -= rise;
            }
        }
        change.raised_m3 += raised_m * cell_m2;
        change.cut_m3 += cut_m * cell_m2;
    }
    return change;
}

} // namespace thalweg::flow
