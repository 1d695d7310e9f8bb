// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/local_extremes.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>

namespace thalweg::measure {

namespace {

struct RowOfExtremes : LocalExtremes {
    RowOfExtremes& operator+=(RowOfExtremes const& more) {
        pits += more.pits;
        peaks += more.peaks;
        cells += more.cells;
        return *this;
    }
};

} // namespace

LocalExtremes local_extremes(Raster<float> const& dem, Run const& run) {
    auto const offsets = d8_offsets(dem.grid());
    return sum_rows(run, std::max<std::int64_t>(dem.height() - 2, 0), [&](std::int64_t r) {
        run.check();
        RowOfExtremes row;
        std::int64_t const first = (r + 1) * dem.width();
        for (std::int64_t i = first + 1; i < first + dem.width() - 1; ++i) {
            int higher = 0;
            int lower = 0;
            bool whole = !std::isnan(dem[i]);
            for (std::int64_t const step : offsets) {
                float const z = dem[i + step];
                higher += z > dem[i] ? 1 : 0;
                lower += z < dem[i] ? 1 : 0;
                whole = whole && !std::isnan(z);
            }
            if (whole) {
                ++row.cells;
                row.pits += higher == 8 ? 1 : 0;
                row.peaks += lower == 8 ? 1 : 0;
            }
        }
        return row;
    });
}

} // namespace thalweg::measure
