// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slope_area_ratio.hpp>

#include <cmath>
#include <limits>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

namespace thalweg::measure {

namespace {

struct Tangents {
    CompensatedSum sum;
    std::int64_t cells = 0;

    void add(double tangent) {
        sum.add(tangent);
        ++cells;
    }
    double mean() const {
        return cells > 0 ? sum.value() / static_cast<double>(cells) : std::numeric_limits<double>::quiet_NaN();
    }
};

void check(SlopeAreaRatioParams const& params, Raster<float> const& dem, flow::FlowField const& drainage) {
    constexpr char const* self = "measure.slope_area_ratio";
    require_in(self, "hillslope_from", params.hillslope_from, Range::at_least(1));
    require_in(self, "hillslope_to", params.hillslope_to, Range::above(static_cast<double>(params.hillslope_from)));
    require_in(self, "channel_from", params.channel_from, Range::at_least(1));
    require_in(self, "channel_to", params.channel_to, Range::above(static_cast<double>(params.channel_from)));
    if (!(dem.grid() == drainage.direction.grid())) {
        throw BadInput("measure.slope_area_ratio: the DEM and its drainage have different grids; drain this DEM");
    }
}

} // namespace

double slope_area_ratio(Raster<float> const& dem, flow::FlowField const& drainage, SlopeAreaRatioParams const& params,
                        Run const& run) {
    check(params, dem, drainage);
    auto const offsets = d8_offsets(dem.grid());
    Tangents hillslopes;
    Tangents channels;
    for (RowIndex r = 1; r + 1 < dem.height(); ++r) {
        run.check();
        for (ColumnIndex c = 1; c + 1 < dem.width(); ++c) {
            std::int64_t const i = dem.grid().index({c, r});
            std::int64_t const area = drainage.area_cells[i];
            bool const hillslope = area >= params.hillslope_from && area < params.hillslope_to;
            bool const channel = area >= params.channel_from && area < params.channel_to;
            if (!hillslope && !channel) {
                continue;
            }
            double const tangent = std::sqrt(horn_squared(dem, i, offsets));
            if (hillslope && !std::isnan(tangent)) {
                hillslopes.add(tangent);
            }
            if (channel && !std::isnan(tangent)) {
                channels.add(tangent);
            }
        }
    }
    double const hillslope = hillslopes.mean();
    return hillslope > 0.0 ? channels.mean() / hillslope : std::numeric_limits<double>::quiet_NaN();
}

} // namespace thalweg::measure
