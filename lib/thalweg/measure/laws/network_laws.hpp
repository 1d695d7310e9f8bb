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

/// The laws of a network: topology, lengths, slopes and angles.
struct NetworkLaws {
    HortonLaws horton;
    std::optional<TokunagaLaw> tokunaga;
    std::optional<PowerLaw> hack;      ///< L = c A^h
    std::optional<PowerLaw> concavity; ///< S = k A^-theta: the exponent is -theta
    double drainage_density_m = 0.0;   ///< [m/m2] length of all rivers / area of the land
    LinkLengths links;
    JunctionAngles junctions;
};

/// Options of network_laws().
struct NetworkLawsParams {
    Required<double> land_m2;               ///< [m2] > 0, area that the rivers drain
    Required<double> junction_reach_m;      ///< [m] > 0, as in junction_angles
    std::vector<double> head_m = {};        ///< [m] by node, as in hack
    std::vector<double> side_branches = {}; ///< T_1, T_2, ..., as in tokunaga
};

/// Computes all laws of a network with the functions of measure/laws.
/// \param network a forest with heights
/// \param orders orders of this network
/// \param areas contributing areas of this network
/// \param params options, each with its default, unit and range
/// \return nothing where a law cannot be fitted
/// \throws BadParameter when the land's area or the chord is not above 0
/// \throws BadInput as those functions
NetworkLaws network_laws(ElevatedNetwork const& network, NetworkOrders const& orders,
                         flow::ContributingAreas const& areas, NetworkLawsParams const& params);

} // namespace thalweg::measure
