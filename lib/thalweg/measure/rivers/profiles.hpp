// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/laws/fits.hpp>

// Idea: Rivers that erode at the rate of uplift have slopes S = k A^-theta. Chi, the integral of (1
// m2 / A)^theta up from the outlet, straightens their profiles: height against chi is a line of
// slope k_sn, for stems and tributaries alike. This gives three measures. theta is the value for
// which all rivers of a basin fall best on one line, found in two passes over a grid of values.
// k_sn of a cell is the slope of the line through a window of river. Where the river was disturbed,
// the profile stands above a concave one: the place highest above the lower convex hull is a
// knickpoint, then likewise on both sides of it. A cell's receiver always stands before it, so that
// sums run without recursion.
// Source: Perron and Royden 2013; Wobus et al. 2006; Schwanghart and Scherler 2017, here against
// chi.
// Cost: O(n) once for areas, then O(cells of rivers), times 38 at most for theta, times the window
// for k_sn, times the number of knickpoints for these. k_sn runs on all cores, the rest on one.
// Not for: the DEM's own heights: profiles are carved, so that noise becomes steps. Rivers whose
// catchment the edge cuts (is_cut): chi and k_sn are wrong there. Lithology or uplift that vary
// show as knickpoints, too.
// Example:
//     RiverProfiles const rivers = river_profiles(flow::reaches_of(network), dem, flow_field);
//     auto const fitted = fit_theta(rivers);
//     std::vector<double> const chi = chi_along(rivers, fitted ? fitted->theta : 0.45);
//     std::vector<double> const k_sn = steepness_along(rivers, chi);
//     std::vector<Knickpoint> const steps = knickpoints(rivers, chi, {.drop_m = 30.0});
// More: docs/measures.md.

namespace thalweg::measure {

/// The long profiles of rivers on a DEM: a tree of river cells. Law: a cell's receiver stands before it.
struct RiverProfiles {
    std::vector<std::int64_t> cell;     ///< index in the grid
    std::vector<std::int64_t> receiver; ///< place of the cell downstream in these vectors; -1: none
    std::vector<std::size_t> reach;     ///< that owns the cell
    std::vector<double> step_m;         ///< [m] to the receiver along the river; 0 without one
    std::vector<double> area_m2;        ///< [m2] contributing area
    std::vector<double> z_m;            ///< [m] at most the height of the DEM: heights do not rise downstream
    std::vector<std::int64_t> main_in;  ///< place of the donor with the largest area (ties: the first); -1: a source
    std::vector<std::uint8_t> is_cut;   ///< 1: the contributing area may reach beyond the data
    std::vector<flow::ReachId> ds;      ///< by reach: the one downstream; -1: none

    std::size_t size() const { return cell.size(); }
};

/// Takes the long profiles of rivers from a DEM. A cell under several reaches belongs to one, as in river_cells; what
/// drains to it by D8 flows on along the river. Lengths are those of the lines; heights are carved: water that would
/// rise keeps the lowest height upstream.
/// \param reaches lines inside the grid
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \return cells with data
/// \throws BadInput when DEM and flow field differ in grid; as river_cells
RiverProfiles river_profiles(flow::Reaches const& reaches, Raster<float> const& dem, flow::FlowField const& drainage,
                             Run const& run = {});

/// Computes chi, the integral of (1 m2 / A)^theta along the river from its outlet.
/// \param rivers profiles
/// \param theta [0, 2] concavity index
/// \return [m] by cell of the profiles; 0 at outlets; each step counts with the area at its upper end
/// \throws BadParameter when theta is outside its range
/// \throws BadInput when the profiles are not as river_profiles returns them; likewise the functions below
///
/// Source: \cite perron2013.
std::vector<double> chi_along(RiverProfiles const& rivers, double theta);

/// A concavity index and how well it fits.
struct FittedTheta {
    double theta = 0.0; ///< [0.1, 0.9]
    double r2 = 0.0;    ///< share of the variance of heights that chi explains, each basin with its own line
};

/// Finds the concavity index for which main stems and tributaries of a basin fall best on one line of height against
/// chi.
/// \param rivers profiles
/// \return to 0.005; nothing where no basin has three cells and falls
///
/// Source: \cite perron2013 (collinearity of tributaries).
std::optional<FittedTheta> fit_theta(RiverProfiles const& rivers, Run const& run = {});

/// Options of steepness_along().
struct SteepnessParams {
    double window_m = 1000.0; ///< [m] > 0, of river: half of it upstream along the main stem, half downstream
};

/// Computes the channel steepness index k_sn = S A^theta by cell: the slope of height against chi, by least squares
/// over a window.
/// \param rivers profiles
/// \param chi of these profiles
/// \return [m^(2 theta)] by cell of the profiles; NaN: a window without extent
/// \throws BadParameter when the window is not above 0
/// \throws BadInput when there is not one chi per cell
///
/// Source: \cite wobus2006; \cite perron2013.
std::vector<double> steepness_along(RiverProfiles const& rivers, std::vector<double> const& chi,
                                    SteepnessParams const& params = {}, Run const& run = {});

/// What the profile of one reach tells.
struct ReachProfile {
    std::int64_t cells = 0; ///< that it owns
    double area_m2 = 0.0;   ///< [m2] at its last cell, without what other rivers bring to a shared outlet
    double z_up_m = 0.0; ///< [m] of its first cell, without cells that of its inflow; NaN: neither; likewise the others
    double z_down_m = 0.0;         ///< [m] of the cell into which it flows, or of its last
    double chi_up = 0.0;           ///< [m] at its first cell
    double chi_down = 0.0;         ///< [m] where it ends
    std::optional<LineFit> k_sn{}; ///< height against chi: the slope is the channel steepness index
    bool is_cut = false;           ///< its contributing area may reach beyond the data
};

/// Summarises profiles by reach.
/// \param rivers profiles
/// \param chi of these profiles
/// \return by reach
/// \throws BadInput when there is not one chi per cell
std::vector<ReachProfile> reach_profiles(RiverProfiles const& rivers, std::vector<double> const& chi);

/// Options of knickpoints().
struct KnickpointParams {
    double drop_m = 30.0; ///< [m] > 0, minimum height above the concave profile
};

/// A place where a river is steeper downstream than upstream.
struct Knickpoint {
    std::size_t place = 0; ///< in the profiles
    double drop_m = 0.0;   ///< [m] height above the concave profile without it
    double k_above = 0.0;  ///< [m^(2 theta)] mean slope of height against chi up to the next knickpoint or source
    double k_below = 0.0;  ///< [m^(2 theta)] the same, down to the next knickpoint, a larger river or the outlet
    double outlet_m = 0.0; ///< [m] along the river
};

/// Finds knickpoints along every stem, from its source to a larger river or the outlet: the place highest above the
/// lower convex hull of height against chi is one if it stands drop_m or higher, then likewise on both sides of it.
/// \param rivers profiles
/// \param chi of these profiles
/// \return ascending by place
/// \throws BadParameter when drop_m is not above 0
/// \throws BadInput when there is not one chi per cell
///
/// Source: \cite schwanghart2017 (knickpoints by a concave envelope), here against chi.
std::vector<Knickpoint> knickpoints(RiverProfiles const& rivers, std::vector<double> const& chi,
                                    KnickpointParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
