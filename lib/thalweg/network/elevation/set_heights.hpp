// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/elevation/river_types.hpp>

// Idea: Three ways to give heights to rivers that have none. set_heights: slope times the straight
// distance from the outlet, the paper's rule, by which a stream that bends back runs uphill; its
// repair takes the least heights above these that fall everywhere, in one walk up the tree.
// set_heights_graded: S = k A^-theta, the profile of a river in balance with uniform uplift. The
// integral along the arc is exact (area linear along it, Gauss quadrature), and one factor k makes
// the main stem as steep as asked. set_heights_by_type: a slope for each arc by its river type.
// Source: Cao, Long and Lü 2009, section 3.3 (docs/decisions/0004-heights.md); Flint 1974;
// Northeast Normal University 2015, section 3 and table 2.
// Cost: O(vertices), graded with some evaluations of a power for each. One thread.
// Not for: rivers with known heights (known_heights.hpp; import_lines' take_file_heights).
// `straight` is for comparison with the paper: its rivers run uphill. Graded heights need drainage
// areas.
// Example:
//     double const cell_m2 = grid.cell_m * grid.cell_m;
//     Graded const graded = set_heights_graded(network, us_area_m2, ds_area_m2,
//                                              {.theta = 0.45, .least_area_m2 = cell_m2});
//     ElevatedNetwork const& rivers = graded.network; // outlets are at 0
// More: docs/rivers.md, "Heights of rivers".

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
struct NetworkWithHeights {
    ElevatedNetwork network;
    HeightReport report;
};

/// Assigns heights above the outlet (z = 0) from one slope; vertices are interpolated by length.
/// \param network a forest
/// \return with straight_repaired and along_stream every arc falls strictly; no node is lower than with `straight`
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an arc of length 0 or a network that is not a forest
///
/// Source: \cite cao2009, section 3.3, figure 5; straight_repaired: docs/decisions/0004-heights.md.
NetworkWithHeights set_heights(StreamNetwork const& network, HeightParams const& params = {}, Run const& run = {});

/// Options of set_heights_graded().
struct GradedParams {
    double slope = 0.087;           ///< [m/m] > 0, mean slope of the main stem
    double theta = 0.38;            ///< [0, 1] concavity index; 0: all rivers equally steep
    Required<double> least_area_m2; ///< [m2] > 0, e.g. a cell's: smaller areas count as this
};

/// What set_heights_graded() returns.
struct GradedNetwork {
    ElevatedNetwork network;
    double steepness = 0.0; ///< [m^(2 theta)] k_s; 0: no rivers
};

/// Assigns heights above the outlet (z = 0) by the slope-area law of graded rivers, S = k_s A^-theta.
/// \param network a forest
/// \param us_area_m2 [m2] by arc: drainage area at its upper end
/// \param ds_area_m2 [m2] by arc: drainage area at its lower end
/// \return the integral of S, with A linear by length along an arc. One k_s for all, such that the main stem (the
/// longest flow path; ties: lower node) has the mean slope `slope`. Every arc falls strictly.
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for an arc of length 0, a network that is not a forest, or areas that are not one number >= 0 per
/// arc
///
/// Source: \cite flint1974, stream gradient as a function of order, magnitude and discharge.
GradedNetwork set_heights_graded(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                                 std::vector<double> const& ds_area_m2, GradedParams const& params,
                                 Run const& run = {});

/// How an arc's slope is chosen from its type's range.
enum class SlopeDraw : std::uint8_t {
    middle, ///< the class's typical slope (SlopeRange::usual)
    uniform ///< random, uniform over the range
};

/// Options of set_heights_by_type().
struct HeightsByTypeParams {
    SlopeDraw draw = SlopeDraw::middle;
    std::uint64_t seed = 0; ///< random seed, for SlopeDraw::uniform
};

/// Assigns heights above the outlet (z = 0) from the slopes of river types; vertices are interpolated by length.
/// \param network a forest
/// \param types by arc
/// \return an arc falls by a slope from its type's range times its length. Random slopes are a hash of the seed and the
/// position of the arc's upper end.
/// \throws BadInput for an arc of length 0, a network that is not a forest, or types of another network
///
/// Source: \cite nenu2015, section 3 and table 2.
ElevatedNetwork set_heights_by_type(StreamNetwork const& network, RiverTypes const& types,
                                    HeightsByTypeParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
