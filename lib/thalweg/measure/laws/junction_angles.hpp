// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// What junction_angles() returns.
struct JunctionAngles {
    double reach_m = 0.0;       ///< [m] chord for directions
    std::int64_t junctions = 0; ///< number measured
    std::int64_t left_out = 0;  ///< number with a river shorter than half the chord, or with more than two rivers
    double mean_deg = std::numeric_limits<double>::quiet_NaN();
    double std_deg = std::numeric_limits<double>::quiet_NaN(); ///< population standard deviation
};

/// Measures the angles between two rivers that meet, each along a chord upstream from the confluence. Rivers drawn from
/// cell to cell need a chord of several cells: ten resolve 6 degrees, one or two only multiples of 45. Where D8 keeps
/// one of eight directions for longer, that bias stays.
/// \param network a forest
/// \param reach_m [m] > 0, length of the chord
/// \return [deg] in [0, 180], over confluences of two rivers that both continue for at least half the chord before they
/// begin or meet another
/// \throws BadParameter when reach_m is not above 0
///
/// Source: the angle as in \cite devauchelle2012 and \cite seybold2017, over a fixed reach.
JunctionAngles junction_angles(StreamNetwork const& network, double reach_m);

} // namespace thalweg::measure
