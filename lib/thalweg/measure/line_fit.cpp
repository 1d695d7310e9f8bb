// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/line_fit.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/measure/compensated_sum.hpp>

namespace thalweg::measure {

std::optional<LineFit> fit_line(std::vector<Vec2> const& points) {
    auto const n = static_cast<double>(points.size());
    CompensatedSum x;
    CompensatedSum y;
    for (Vec2 const p : points) {
        x.add(p.x);
        y.add(p.y);
    }
    Vec2 const mean{x.value() / n, y.value() / n};
    CompensatedSum xx;
    CompensatedSum xy;
    CompensatedSum yy;
    for (Vec2 const p : points) {
        xx.add((p.x - mean.x) * (p.x - mean.x));
        xy.add((p.x - mean.x) * (p.y - mean.y));
        yy.add((p.y - mean.y) * (p.y - mean.y));
    }
    if (points.size() < 2 || !(xx.value() > 0.0)) {
        return std::nullopt;
    }
    LineFit fit;
    fit.slope = xy.value() / xx.value();
    fit.intercept = mean.y - fit.slope * mean.x;
    fit.points = static_cast<std::int64_t>(points.size());
    CompensatedSum missed;
    for (Vec2 const p : points) {
        double const by = (p.y - mean.y) - fit.slope * (p.x - mean.x);
        missed.add(by * by);
    }
    if (points.size() > 2) { // two say nothing of how well a line fits
        if (yy.value() > 0.0) {
            fit.r2 = std::max(0.0, 1.0 - missed.value() / yy.value());
        }
        fit.slope_error = std::sqrt(missed.value() / (n - 2.0) / xx.value());
    }
    return fit;
}

} // namespace thalweg::measure
