// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/fits.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>

namespace thalweg::measure {
namespace {

struct Logarithms {
    CompensatedSum area;
    CompensatedSum value;
    std::int64_t places = 0;
};

} // namespace

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
    if (points.size() > 2) { // a line through two points fits exactly
        if (yy.value() > 0.0) {
            fit.r2 = std::max(0.0, 1.0 - missed.value() / yy.value());
        }
        fit.slope_error = std::sqrt(missed.value() / (n - 2.0) / xx.value());
    }
    return fit;
}

std::optional<PowerLaw> with_line(PowerLaw law, std::optional<LineFit> const& fit, std::int64_t least_bins) {
    if (!fit || fit->points < least_bins) {
        return std::nullopt;
    }
    law.exponent = fit->slope;
    law.coefficient = portable::exp(fit->intercept);
    law.r2 = fit->r2;
    law.exponent_error = fit->slope_error;
    return law;
}

std::optional<PowerLaw> fit_power_law(std::vector<AtArea> const& places, PowerLawParams const& params) {
    constexpr char const* self = "measure.fit_power_law";
    require_in(self, "bins_per_decade", params.bins_per_decade, Range::between(1, 100));
    require_in(self, "least_places", params.least_places, Range::at_least(1));
    require_in(self, "least_bins", params.least_bins, Range::at_least(2));
    double const per_e_fold = params.bins_per_decade / portable::log(10.0);
    std::map<std::int64_t, Logarithms> bins;
    for (AtArea const& p : places) {
        if (p.area_m2 > 0.0 && p.value > 0.0 && std::isfinite(p.area_m2) && std::isfinite(p.value)) {
            double const area = portable::log(p.area_m2);
            Logarithms& bin = bins[static_cast<std::int64_t>(std::floor(area * per_e_fold))];
            bin.area.add(area);
            bin.value.add(portable::log(p.value));
            ++bin.places;
        }
    }
    PowerLaw law;
    std::vector<Vec2> line;
    for (auto const& [number, bin] : bins) {
        if (bin.places >= params.least_places) {
            auto const n = static_cast<double>(bin.places);
            line.push_back({bin.area.value() / n, bin.value.value() / n});
            law.bins.push_back({portable::exp(line.back().x), portable::exp(line.back().y), bin.places});
            law.places += bin.places;
        }
    }
    law.left_out = static_cast<std::int64_t>(places.size()) - law.places;
    return with_line(std::move(law), fit_line(line), params.least_bins);
}

} // namespace thalweg::measure
