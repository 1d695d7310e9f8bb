// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/line_fit.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/numbers/compensated_sum.hpp>

namespace thalweg::measure {

std::optional<LineFit> fit_line(std::vector<Vec2> const& points, std::vector<double> const& weights) {
    auto const n = static_cast<double>(points.size());
    auto const weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    CompensatedSum all;
    CompensatedSum x;
    CompensatedSum y;
    for (std::size_t i = 0; i < points.size(); ++i) {
        all.add(weight(i));
        x.add(weight(i) * points[i].x);
        y.add(weight(i) * points[i].y);
    }
    Vec2 const mean{x.value() / all.value(), y.value() / all.value()};
    CompensatedSum xx;
    CompensatedSum xy;
    CompensatedSum yy;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec2 const p = points[i];
        xx.add(weight(i) * (p.x - mean.x) * (p.x - mean.x));
        xy.add(weight(i) * (p.x - mean.x) * (p.y - mean.y));
        yy.add(weight(i) * (p.y - mean.y) * (p.y - mean.y));
    }
    if (points.size() < 2 || !(xx.value() > 0.0)) {
        return std::nullopt;
    }
    LineFit fit;
    fit.slope = xy.value() / xx.value();
    fit.intercept = mean.y - fit.slope * mean.x;
    fit.points = static_cast<std::int64_t>(points.size());
    CompensatedSum missed;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double const by = (points[i].y - mean.y) - fit.slope * (points[i].x - mean.x);
        missed.add(weight(i) * by * by);
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
