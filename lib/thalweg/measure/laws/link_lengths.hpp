// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// Lengths of links of one kind; NaN: there are none.
struct LengthSpread {
    std::int64_t links = 0;
    double mean_m = std::numeric_limits<double>::quiet_NaN();
    double median_m = std::numeric_limits<double>::quiet_NaN(); ///< the mean of the middle two of an even number
    double cv = std::numeric_limits<double>::quiet_NaN();       ///< [-] coefficient of variation (population)
};

/// What link_lengths() returns.
struct LinkLengths {
    LengthSpread exterior;       ///< from a source to the first confluence
    LengthSpread interior;       ///< from a confluence to the next, or to the outlet
    std::optional<double> ratio; ///< mean exterior / mean interior length
};

/// Measures links between sources, confluences and outlets. Arcs joined at a node of degree two are one link.
/// \param network a forest
/// \return by kind of link
///
/// Source: \cite shreve1967 (links); \cite smart1972 (their lengths).
LinkLengths link_lengths(StreamNetwork const& network);

} // namespace thalweg::measure
