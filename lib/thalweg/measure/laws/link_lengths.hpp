// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

/// Lengths of the links of one kind; NaN where there are none.
struct LengthSpread {
    std::int64_t links = 0;
    double mean_m = std::numeric_limits<double>::quiet_NaN();
    double median_m = std::numeric_limits<double>::quiet_NaN(); ///< the mean of the middle two of an even number
    double cv = std::numeric_limits<double>::quiet_NaN();       ///< [-] population deviation over mean
};

/// What link_lengths() returns.
struct LinkLengths {
    LengthSpread exterior;       ///< from a source to the first confluence
    LengthSpread interior;       ///< from a confluence to the next, or to the outlet
    std::optional<double> ratio; ///< mean of exterior over mean of interior links
};

/// \param network a network of trees
/// \return lengths of the links between sources, confluences and outlets; arcs that meet one to one are one link.
///
/// Source: \cite shreve1967 (links); \cite smart1972 (their lengths).
LinkLengths link_lengths(StreamNetwork const& network);

} // namespace thalweg::measure
