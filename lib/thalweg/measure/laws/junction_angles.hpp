// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// What junction_angles() returns.
struct JunctionAngles {
    double reach_m = 0.0;       ///< over which directions were taken
    std::int64_t junctions = 0; ///< measured
    std::int64_t left_out = 0;  ///< a river too short to have a direction, or more than two
    double mean_deg = std::numeric_limits<double>::quiet_NaN();
    double std_deg = std::numeric_limits<double>::quiet_NaN(); ///< population
};

/// The angle between the two rivers that meet at a confluence.
/// \pre a network of trees; reach_m, above 0: how far up each river its direction is taken, on the chord from the
/// confluence.
/// \param network the network
/// \param reach_m [m] > 0, length of the chord
/// \return angles in [0, 180] degrees, of all confluences of two rivers both of which go on for half the reach before
/// they part again or begin; a shorter one is left out. On rivers drawn from cell to cell every angle over a step or
/// two is a multiple of 45 degrees: a reach of ten cells tells directions 6 degrees apart. Where a DEM's D8 holds to
/// one of eight directions for longer, that stays in the angles.
/// \throws BadParameter
///
/// Source: the angle as in \cite devauchelle2012 and \cite seybold2017, over a fixed reach.
JunctionAngles junction_angles(StreamNetwork const& network, double reach_m);

} // namespace thalweg::measure
