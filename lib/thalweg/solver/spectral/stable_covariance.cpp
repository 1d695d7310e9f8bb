// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/stable_covariance.hpp>

#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::solver {

namespace {

double stable(double dx, double dy, double exponent) {
    return portable::exp(-portable::pow(dx * dx + dy * dy, exponent));
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
        require_in(stage, "correlation length", length, Range::above(0.0), "cells");
    }
    require_in(stage, "fractal dimension", covariance.dimension, Range::inside(2.0, 3.0));
    require_in(stage, "share of fine forms", covariance.fine_share, {0.0, 1.0, true, false});
}

} // namespace thalweg::solver
