// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

enum class HeightMode : std::uint8_t {
    straight,          ///< slope times the straight distance to the outlet, as published; may run uphill
    straight_repaired, ///< the least majorant of `straight` that falls by at least 0.01 slope along every arc
    along_stream       ///< slope times the distance along the stream
};

/// Options of set_heights().
struct HeightParams {
    HeightMode mode = HeightMode::straight_repaired;
    double slope = 0.087; ///< [m/m] > 0, s: tan 5 degrees in Cao, Long and Lü 2009
};

/// What set_heights() changed.
struct HeightReport {
    std::int64_t uphill_arcs = 0; ///< arcs that do not fall under `straight`, before the repair
    double uphill_length_m = 0.0; ///< their length
    double max_rise_m = 0.0;      ///< largest rise along such an arc
    std::int64_t lifted = 0;      ///< nodes that the repair raised
    double max_lift_m = 0.0;
    double rms_lift_m = 0.0; ///< over the lifted nodes
};

/// What set_heights() returns.
struct Elevated {
    ElevatedNetwork network;
    HeightReport report;
};

/// Assigns heights above the outlet (z = 0) from one slope; vertices are interpolated by length.
/// \param network a forest
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return with straight_repaired and along_stream every arc falls strictly; no node is lower than with `straight`
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an arc of length 0 or a network that is not a forest
///
/// Source: \cite cao2009, section 3.3, figure 5; specification 0.3 (majorant with least slope 0.01 s).
Elevated set_heights(StreamNetwork const& network, HeightParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
