// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of set_heights_graded().
struct GradedParams {
    double slope = 0.087;           ///< [m/m] > 0, mean slope of the main stem
    double theta = 0.38;            ///< [0, 1] concavity index; 0: all rivers equally steep
    Required<double> least_area_m2; ///< [m2] > 0, e.g. a cell's: smaller areas count as this
};

/// What set_heights_graded() returns.
struct Graded {
    ElevatedNetwork network;
    double steepness = 0.0; ///< [m^(2 theta)] k_s; 0: no rivers
};

/// Assigns heights above the outlet (z = 0) by the slope-area law of graded rivers, S = k_s A^-theta.
/// \param network a forest
/// \param us_area_m2 [m2] by arc: drainage area at its upper end
/// \param ds_area_m2 [m2] by arc: drainage area at its lower end
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the integral of S, with A linear by length along an arc. One k_s for all, such that the main stem (the
/// longest flow path; ties: lower node) has the mean slope `slope`. Every arc falls strictly.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an arc of length 0, a network that is not a forest, or areas that are not one number >= 0 per
/// arc
///
/// Source: \cite flint1974, stream gradient as a function of order, magnitude and discharge.
Graded set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                          std::vector<double> const& ds_area_m2, GradedParams const& params, Run const& run = {});

} // namespace thalweg::network
