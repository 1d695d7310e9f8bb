// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/internal/some_slopes.hpp>

#include <cmath>
#include <limits>

#include <thalweg/core/numbers/elementary_rows.hpp>

namespace thalweg::measure {

void SomeSlopes::compute(Raster<float> const& dem, std::int64_t row, std::size_t first, std::size_t count) {
    // From the western neighbour of the first cell to the eastern one of the last: of cell i it is number i + 1.
    float const* const from_north = dem.row(row - 1).data() + first - 1;
    float const* const from_here = dem.row(row).data() + first - 1;
    float const* const from_south = dem.row(row + 1).data() + first - 1;
    std::array<double, at_once + 2> north;
    std::array<double, at_once + 2> here;
    std::array<double, at_once + 2> south;
    std::array<double, at_once + 2> column; // the three of a column
    for (std::size_t c = 0; c < count + 2; ++c) {
        north[c] = static_cast<double>(from_north[c]);
        here[c] = static_cast<double>(from_here[c]);
        south[c] = static_cast<double>(from_south[c]);
        column[c] = north[c] + 2.0 * here[c] + south[c];
    }
    double const per_metre = 1.0 / (8.0 * dem.grid().cell_m);
    for (std::size_t i = 0; i < count; ++i) {
        double const up = north[i] + 2.0 * north[i + 1] + north[i + 2];
        double const down = south[i] + 2.0 * south[i + 1] + south[i + 2];
        double const across = std::fabs(column[i + 2] - column[i]) * per_metre;
        double const along = std::fabs(down - up) * per_metre;
        double const steep = std::sqrt(across * across + along * along);
        dx[i] = across;
        dy[i] = along;
        tangent[i] = std::isnan(here[i + 1]) ? std::numeric_limits<double>::quiet_NaN() : steep;
    }
    portable::atan2_row({tangent.data(), count}, 1.0, angle);
}

} // namespace thalweg::measure
