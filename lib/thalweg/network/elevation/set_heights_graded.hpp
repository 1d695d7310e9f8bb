// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of set_heights_graded().
struct GradedParams {
    double slope = 0.087;           ///< [m/m] > 0, mean of the main stem: fall from its source over its length
    double theta = 0.38;            ///< [0, 1], concavity; 0 makes every river equally steep
    Required<double> least_area_m2; ///< [m2] > 0, such as a cell's: areas below it count as it
};

/// What set_heights_graded() returns.
struct Graded {
    ElevatedNetwork network;
    double steepness = 0.0; ///< [m^(2 theta)] k_s; 0 without rivers
};

/// Gives every node its height above the outlet (z = 0) by a graded river's law: the more water, the flatter.
/// \pre a network whose components are trees; the areas that drain through its arcs' upper and lower ends.
/// \param network the network
/// \param us_area_m2 [m2] by arc, drainage area at its upper end
/// \param ds_area_m2 [m2] by arc, drainage area at its lower end
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return slope = k_s A^-theta at every place, A between an arc's ends linear by length; heights are its integral. One
/// k_s for all, such that the main stem (the longest flow path of all; ties: the lower node) falls by `slope` in the
/// mean. Every arc falls strictly.
/// \throws BadParameter
/// \throws BadInput for an arc of no length, a network that is not a forest, areas that are not one for each arc, below
/// 0 or no number
///
/// Source: \cite flint1974, stream gradient as a function of order, magnitude and discharge.
Graded set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                          std::vector<double> const& ds_area_m2, GradedParams const& params, Run const& run = {});

} // namespace thalweg::network
