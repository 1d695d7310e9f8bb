// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/correlation_length.hpp>

#include <cmath>
#include <cstddef>
#include <optional>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::solver {

namespace {

double one_over_e() {
    return portable::exp(-1.0);
}

/// Index of the first r at or below 1/e.
std::optional<std::size_t> crossing(std::vector<double> const& r) {
    for (std::size_t i = 0; i < r.size(); ++i) {
        if (r[i] <= one_over_e()) {
            return i;
        }
    }
    return std::nullopt;
}

/// The line through u = ln(-ln r) over x = ln k, of the lags with 0 < r < 1.
struct Fit {
    double lags = 0.0;
    double mean_x = 0.0;
    double mean_u = 0.0;
    double spread = 0.0; ///< sum of (x - mean_x)^2
    double alpha = 0.0;

    explicit Fit(std::vector<double> const& r) {
        for_lags(r, [&](std::size_t, double x, double u) {
            lags += 1.0;
            mean_x += x;
            mean_u += u;
        });
        mean_x /= lags;
        mean_u /= lags;
        for_lags(r, [&](std::size_t, double x, double u) {
            spread += (x - mean_x) * (x - mean_x);
            alpha += (x - mean_x) * (u - mean_u);
        });
        alpha /= spread;
    }
    /// A single lag fixes no line, and correlation that does not fall has no length.
    bool holds() const { return lags > 1.0 && alpha > 0.0; }

    template <class Body> static void for_lags(std::vector<double> const& r, Body const& body) {
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (r[i] > 0.0 && r[i] < 1.0) {
                body(i, portable::log(static_cast<double>(i + 1)), portable::log(-portable::log(r[i])));
            }
        }
    }
};

} // namespace

Correlogram correlogram(Raster<float> const& dem, double mean, double std, Axis axis, Run const& run) {
    Correlogram result;
    if (!(std > 0.0)) {
        return result;
    }
    std::int64_t const lags = (axis == Axis::rows ? dem.width() : dem.height()) / 2;
    LagSums const sums = lag_sums(dem, mean, axis, lags, run);
    for (std::size_t k = 1; k < sums.pairs.size(); ++k) {
        result.pairs.push_back(sums.pairs[k]);
        result.r.push_back(sums.pairs[k] > 0.0 ? sums.products[k] / sums.pairs[k] / (std * std)
                                               : std::numeric_limits<double>::quiet_NaN());
    }
    return result;
}

CorrelationLength correlation_length(Correlogram const& correlogram) {
    std::vector<double> const& r = correlogram.r;
    if (auto const i = crossing(r)) {
        double const before = *i > 0 ? r[*i - 1] : 1.0;
        return {static_cast<double>(*i) + (before - one_over_e()) / (before - r[*i]), false};
    }
    Fit const fit(r);
    return fit.holds() ? CorrelationLength{portable::exp(fit.mean_x - fit.mean_u / fit.alpha), true}
                       : CorrelationLength{};
}

std::vector<double> correlation_length_slopes(Correlogram const& correlogram) {
    std::vector<double> const& r = correlogram.r;
    std::vector<double> slopes(r.size(), 0.0);
    if (auto const i = crossing(r)) {
        double const cells = correlation_length(correlogram).cells;
        double const before = *i > 0 ? r[*i - 1] : 1.0;
        double const fall = before - r[*i];
        slopes[*i] = (before - one_over_e()) / (fall * fall) / cells;
        if (*i > 0) {
            slopes[*i - 1] = (one_over_e() - r[*i]) / (fall * fall) / cells;
        }
        return slopes;
    }
    Fit const fit(r);
    if (!fit.holds()) {
        return {};
    }
    Fit::for_lags(r, [&](std::size_t i, double x, double) {
        double const by_u =
            fit.mean_u / (fit.alpha * fit.alpha) * (x - fit.mean_x) / fit.spread - 1.0 / (fit.lags * fit.alpha);
        slopes[i] = by_u / (r[i] * portable::log(r[i]));
    });
    return slopes;
}

} // namespace thalweg::solver
