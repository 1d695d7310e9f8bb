// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// Structure tensor of unit gradients, and the share of cells with data that it comes from.
struct Tensor {
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
    double weight = 0.0;

    Tensor& operator+=(Tensor const& more) {
        xx += more.xx;
        yy += more.yy;
        xy += more.xy;
        weight += more.weight;
        return *this;
    }
    Tensor& operator*=(double factor) {
        xx *= factor;
        yy *= factor;
        xy *= factor;
        weight *= factor;
        return *this;
    }
};

/// Averages tensors in a Gaussian window, cut at four deviations; the grid is mirrored at its edges.
/// \param blocks means over blocks of cells
/// \param window [blocks] > 0, standard deviation
/// \param run progress, log, stop token and number of threads
/// \return by block; the same bits for any number of threads
/// \throws Cancelled
Raster<Tensor> smooth_blocks(Raster<Tensor> const& blocks, double window, Run const& run);

} // namespace thalweg::measure
