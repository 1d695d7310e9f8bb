// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/stable_covariance.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::solver {

namespace {

double stable(double dx, double dy, double exponent) {
    return exact::exp(-exact::pow(dx * dx + dy * dy, exponent));
}

} // namespace

double StableCovariance::operator()(double dx_cells, double dy_cells) const {
    double const coarse = stable(dx_cells / lx_cells, dy_cells / ly_cells, 3.0 - dimension);
    if (fine_share == 0.0) {
        return coarse;
    }
    return (1.0 - fine_share) * coarse +
           fine_share * stable(dx_cells / fine_cells, dy_cells / fine_cells, 3.0 - dimension);
}

void check(StableCovariance const& covariance, char const* stage) {
    for (double const length : {covariance.lx_cells, covariance.ly_cells, covariance.fine_cells}) {
        if (!(length > 0.0 && std::isfinite(length))) {
            throw BadParameter(
                fmt::format("{}: a correlation length of {} cells; it must be greater than 0", stage, length));
        }
    }
    if (!(covariance.dimension > 2.0 && covariance.dimension < 3.0)) {
        throw BadParameter(fmt::format("{}: a fractal dimension of {}; that of a surface lies between 2 and 3", stage,
                                       covariance.dimension));
    }
    if (!(covariance.fine_share >= 0.0 && covariance.fine_share < 1.0)) {
        throw BadParameter(fmt::format("{}: a share of {} of fine forms; it must be at least 0 and less than 1", stage,
                                       covariance.fine_share));
    }
}

} // namespace thalweg::solver
