// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/measure/laws/fits.hpp>

// Idea: River networks of all regions obey the same statistical laws, and these laws tell whether a
// network is like a natural one without any place being compared. Streams are counted by Strahler
// order, and number, length and area change by a constant factor from order to order (Horton); mean
// numbers of side branches k orders below their stream grow by a constant factor with k (Tokunaga).
// Lengths of main streams and slopes follow powers of area (Hack, Flint). Each law is one straight
// line through logarithms, so that its exponent, r2 and number of points come from one
// least-squares fit.
// Source: Horton 1945; Schumm 1956; Strahler 1957; Tokunaga 1978; Peckham 1995; Shreve 1967; Smart
// 1972; angles as Devauchelle et al. 2012. Natural ranges, with their sources: natural_ranges() in
// measure/relief/relief.hpp.
// Cost: O(vertices + arcs log arcs). One thread.
// Not for: networks of two or three orders, whose ratios come from as many points; a proof that a
// network is natural: Horton's ratios alone tell little, Tokunaga's a and c and the angles tell
// more.
// Example:
//     HortonLaws const laws = horton(network, network::order(network), ds_area_m2);
//     double const bifurcation = laws.bifurcation ? laws.bifurcation->ratio : 0.0;
//     JunctionAngles const angles = junction_angles(network, 10.0 * grid.cell_m);
// More: docs/relief_measures.md.

namespace thalweg::measure {

/// The streams of one Strahler order: maximal chains of arcs of equal order.
struct StreamOrder {
    int order = 1;
    std::int64_t streams = 0;
    double length_m = 0.0; ///< [m] mean
    double area_m2 = 0.0;  ///< [m2] mean drainage area at downstream ends, of those that are known; 0: of none
};

/// A ratio of consecutive orders.
struct HortonRatio {
    double ratio = 0.0;
    double r2 = 0.0;         ///< of the regression of logarithms; NaN: two orders, or all equal
    std::int64_t orders = 0; ///< number of orders in the regression
};

/// Horton's laws of drainage composition.
struct HortonLaws {
    std::vector<StreamOrder> orders;        ///< 1, 2, ... to the highest
    std::optional<HortonRatio> bifurcation; ///< R_B: number of streams, order to the next
    std::optional<HortonRatio> length;      ///< R_L: mean length, order to the one below
    std::optional<HortonRatio> area;        ///< R_A: mean drainage area, order to the one below
};

/// Computes number, length and area of streams by Strahler order, and Horton's ratios: exp of the slope (R_B: of its
/// negative) of the least-squares line of natural logarithms over order, all orders with equal weight.
/// \param network a forest
/// \param orders orders of this network
/// \param ds_area_m2 [m2] by arc: area at its downstream end; not above 0, or NaN: unknown
/// \return an order of mean 0 is left out; with fewer than two orders there is no ratio
/// \throws BadInput when there is not one order and area per arc, or an order is below 1
///
/// Source: \cite horton1945 (laws of stream numbers and lengths); \cite schumm1956 (areas); \cite strahler1957 (streams
/// as chains of equal order; the regression).
HortonLaws horton(StreamNetwork const& network, NetworkOrders const& orders, std::vector<double> const& ds_area_m2);

/// Tokunaga's law T_k = a c^(k-1), the mean number of side branches k orders below their stream.
struct TokunagaLaw {
    double a = 0.0;
    double c = 0.0;
    double r2 = 0.0;          ///< of the regression of ln T_k; NaN: two terms, or all equal
    double log_c_error = 0.0; ///< standard error of ln c; NaN: two terms
    std::int64_t terms = 0;   ///< number of T_k in the regression
};

/// Fits Tokunaga's law by least squares of ln T_k over k - 1.
/// \param side_branches T_1, T_2, ..., means over the streams of all orders; a T_k of 0 is left out
/// \return nothing with fewer than two terms
///
/// Source: \cite tokunaga1978; \cite peckham1995; the regression: \cite zanardo2013.
std::optional<TokunagaLaw> tokunaga(std::vector<double> const& side_branches);

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

/// The laws of a network: topology, lengths, slopes and angles.
struct NetworkLaws {
    HortonLaws horton;
    std::optional<TokunagaLaw> tokunaga;
    std::optional<PowerLaw> hack;      ///< L = c A^h
    std::optional<PowerLaw> concavity; ///< S = k A^-theta: the exponent is -theta
    double drainage_density_m = 0.0;   ///< [m/m2] length of all rivers / area that they drain
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
/// \return nothing where a law cannot be fitted
/// \throws BadParameter when the land's area or the chord is not above 0
/// \throws BadInput as those functions
NetworkLaws network_laws(ElevatedNetwork const& network, NetworkOrders const& orders,
                         flow::ContributingAreas const& areas, NetworkLawsParams const& params);

} // namespace thalweg::measure
