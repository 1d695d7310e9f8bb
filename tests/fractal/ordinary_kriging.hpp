// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// The slow, obvious oracle: weights of places for another by the whole system of ordinary kriging, solved as Gauss and
/// Jordan did.
template <class Place, class Variogram>
std::vector<double> ordinary_kriging(std::vector<Place> const& places, Place const& here, Variogram const& variogram) {
    std::size_t const n = places.size();
    std::vector<std::vector<double>> m(n + 1, std::vector<double>(n + 2, 1.0));
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
            m[i][k] = variogram(places[i], places[k]);
        }
        m[i][n + 1] = variogram(places[i], here);
    }
    m[n][n] = 0.0;
    for (std::size_t c = 0; c <= n; ++c) {
        std::size_t p = c;
        for (std::size_t r = c; r <= n; ++r) {
            p = std::fabs(m[r][c]) > std::fabs(m[p][c]) ? r : p;
        }
        std::swap(m[c], m[p]);
        for (std::size_t r = 0; r <= n; ++r) {
            double const f = r == c ? 0.0 : m[r][c] / m[c][c];
            for (std::size_t k = c; k <= n + 1; ++k) {
                m[r][k] -= f * m[c][k];
            }
        }
    }
    std::vector<double> weights;
    for (std::size_t i = 0; i < n; ++i) {
        weights.push_back(m[i][n + 1] / m[i][i]);
    }
    return weights;
}
