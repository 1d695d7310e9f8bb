// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/stable_covariance.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/elementary.hpp>
#include <thalweg/core/error.hpp>

namespace thalweg::solver {

double StableCovariance::operator()(double dx_cells, double dy_cells) const {
    double const x = dx_cells / lx_cells;
    double const y = dy_cells / ly_cells;
    return exact::exp(-exact::pow(x * x + y * y, 3.0 - dimension));
}

void check(StableCovariance const& covariance, char const* stage) {
    for (double const length : {covariance.lx_cells, covariance.ly_cells}) {
        if (!(length > 0.0 && std::isfinite(length))) {
            throw BadParameter(
                fmt::format("{}: a correlation length of {} cells; it must be greater than 0", stage, length));
        }
    }
    if (!(covariance.dimension > 2.0 && covariance.dimension < 3.0)) {
        throw BadParameter(fmt::format("{}: a fractal dimension of {}; that of a land lies between 2 and 3", stage,
                                       covariance.dimension));
    }
}

} // namespace thalweg::solver
