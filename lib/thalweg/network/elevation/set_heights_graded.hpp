// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/required.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

struct GradedParams {
    double slope = 0.087;           ///< [m/m] > 0, mean of the main stem: fall from its source over its length
    double theta = 0.38;            ///< [0, 1], concavity; 0 makes every river equally steep
    Required<double> least_area_m2; ///< [m2] > 0, such as a cell's: areas below it count as it
};

struct Graded {
    RaisedNetwork network;
    double steepness = 0.0; ///< [m^(2 theta)] k_s; 0 without rivers
};

/// Gives every node its height above the outlet (z = 0) by a graded river's law: the more water, the flatter.
/// Takes: a network whose components are trees; the areas that drain through its arcs' upper and lower ends.
/// Gives: slope = k_s A^-theta at every place, A between an arc's ends linear by length; heights are its integral. One
/// k_s for all, such that the main stem (the longest flow path of all; ties: the lower node) falls by `slope` in the
/// mean. Every arc falls strictly.
/// Throws: BadParameter; BadInput for an arc of no length, a network that is no forest, areas that are not one for each
/// arc, below 0 or no number.
/// Source: Flint 1974, stream gradient as a function of order, magnitude and discharge.
Graded set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                          std::vector<double> const& ds_area_m2, GradedParams const& params, Run const& run = {});

} // namespace thalweg::network
