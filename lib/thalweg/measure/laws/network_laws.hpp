// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/required.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/measure/laws/horton.hpp>
#include <thalweg/measure/laws/junction_angles.hpp>
#include <thalweg/measure/laws/link_lengths.hpp>
#include <thalweg/measure/laws/power_law.hpp>
#include <thalweg/measure/laws/tokunaga.hpp>

namespace thalweg::measure {

/// The laws of a network: of its tree, its lengths, its slopes and its angles.
struct NetworkLaws {
    HortonLaws horton;
    std::optional<TokunagaLaw> tokunaga;
    std::optional<PowerLaw> hack;      ///< L = c A^h
    std::optional<PowerLaw> concavity; ///< S = k A^-theta: its exponent is -theta
    double drainage_density_m = 0.0;   ///< [m/m2] length of all rivers over the land's area
    LinkLengths links;
    JunctionAngles junctions;
};

/// Options of network_laws().
struct NetworkLawsParams {
    Required<double> land_m2;               ///< [m2] above 0: the land that the rivers drain
    Required<double> junction_reach_m;      ///< [m] above 0, as junction_angles
    std::vector<double> head_m = {};        ///< [m] by node, as hack
    std::vector<double> side_branches = {}; ///< T_1, T_2, ..., as tokunaga
};

/// \param network the network
/// \param orders the network's orders
/// \param areas contributing areas
/// \param params options, each with its default, unit and range
/// \return every law of a network, drawn or drained, by the verbs beside this one.
/// \throws BadParameter when the land or the reach is not above 0
/// \throws BadInput as the verbs do
NetworkLaws network_laws(ElevatedNetwork const& network, NetworkOrders const& orders,
                         flow::ContributingAreas const& areas, NetworkLawsParams const& params);

} // namespace thalweg::measure
