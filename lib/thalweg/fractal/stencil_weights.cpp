// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/stencil_weights.hpp>

#include <thalweg/core/numbers/elementary.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace thalweg::fractal {
namespace {

/// E (z(a) - z(b))^2 in units of sigma^2 r^(2H), the nearest neighbours being r away.
class Variogram {
public:
    explicit Variogram(double hurst) {
        for (int col = 0; col <= longest; ++col) {
            for (int row = col % 2; row <= col;
                 row += 2) { // of one parity: so the neighbours lie to one another and to the point
                int const square = col * col + row * row;
                of_square_[static_cast<std::size_t>(square)] = portable::pow(0.5 * static_cast<double>(square), hurst);
            }
        }
    }
    double operator()(Offset const& a, Offset const& b) const {
        int const col = a.col - b.col;
        int const row = a.row - b.row;
        return of_square_[static_cast<std::size_t>(col * col + row * row)];
    }

private:
    static constexpr int longest = 6;
    std::array<double, 2 * longest * longest + 1> of_square_{};
};

/// Solves the square system whose rows end in their right side, by elimination with the greatest pivots.
std::vector<double> solve(std::vector<std::vector<double>> rows) {
    std::size_t const n = rows.size();
    for (std::size_t step = 0; step < n; ++step) {
        std::size_t pivot = step;
        for (std::size_t i = step + 1; i < n; ++i) {
            pivot = std::fabs(rows[i][step]) > std::fabs(rows[pivot][step]) ? i : pivot;
        }
        std::swap(rows[step], rows[pivot]);
        for (std::size_t i = step + 1; i < n; ++i) {
            double const factor = rows[i][step] / rows[step][step];
            for (std::size_t k = step; k <= n; ++k) {
                rows[i][k] -= factor * rows[step][k];
            }
        }
    }
    std::vector<double> x(n);
    for (std::size_t i = n; i-- > 0;) {
        double sum = rows[i][n];
        for (std::size_t k = i + 1; k < n; ++k) {
            sum -= rows[i][k] * x[k];
        }
        x[i] = sum / rows[i][i];
    }
    return x;
}

std::vector<double> kriged(std::vector<Offset> const& points, Variogram const& variogram) {
    std::size_t const n = points.size();
    std::vector<std::vector<double>> rows(n + 1, std::vector<double>(n + 2, 1.0));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            rows[i][k] = variogram(points[i], points[k]);
        }
        rows[i][n + 1] = variogram(points[i], {});
    }
    rows[n][n] = 0.0;
    std::vector<double> weights = solve(std::move(rows));
    weights.pop_back();
    return weights;
}

/// Conditional deviation of the new point under any weights whose sum is 1.
double exact_deviation(std::vector<Offset> const& points, std::vector<double> const& weights,
                       Variogram const& variogram) {
    double variance = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double inner = 0.0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            inner += weights[k] * variogram(points[i], points[k]);
        }
        variance += weights[i] * (variogram(points[i], {}) - 0.5 * inner);
    }
    return std::sqrt(variance > 0.0 ? variance : 0.0);
}

/// Means over neighbours that lie alike, of which elimination makes slightly different numbers.
void even_out(std::array<double, 16>& weight) {
    using Places = std::pair<std::size_t, std::size_t>;
    for (auto const& [first, last] : {Places{0, 4}, Places{4, 12}, Places{12, 16}}) {
        double sum = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            sum += weight[i];
        }
        for (std::size_t i = first; i < last; ++i) {
            weight[i] = sum / static_cast<double>(last - first);
        }
    }
}

} // namespace

StencilWeights stencil_weights(Stencil stencil, std::uint32_t known, double hurst) {
    std::vector<Offset> points;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < around_centre.size(); ++i) {
        if ((known >> i & 1U) != 0) {
            points.push_back(around_centre[i]);
            places.push_back(i);
        }
    }
    Variogram const variogram(hurst);
    bool const means = stencil == Stencil::four || stencil == Stencil::four_exact;
    std::vector<double> const weights =
        means ? std::vector<double>(points.size(), 1.0 / static_cast<double>(points.size()))
              : kriged(points, variogram);
    StencilWeights out;
    for (std::size_t i = 0; i < places.size(); ++i) {
        out.weight[places[i]] = weights[i];
    }
    if (known == used_neighbours(stencil)) {
        even_out(out.weight);
    }
    out.deviation = stencil == Stencil::four ? std::sqrt(1.0 - portable::pow(2.0, 2.0 * hurst - 2.0))
                                             : exact_deviation(points, weights, variogram);
    return out;
}

} // namespace thalweg::fractal
