// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>

// Idea: A DEM drains along a network if the water of its own steepest descent keeps to the network,
// so three questions are asked of the DEM's flow field. Does any cell lie in a depression? Does the
// water of each river cell go on to a cell of its own reach or of one downstream? Does the flow
// path from each source come to its outlet? The cells of these paths are then compared with the
// cells under the network at 0, 1 and 2 cells, as precision (paths that lie on rivers) and recall
// (rivers that are found). The usual test, cells above an area threshold, is only reported, at the
// threshold that agrees best: a DEM may have more valleys than rivers were drawn. extract_ridges
// asks the same of ridges, as streams of the DEM turned upside down.
// Source: ours, with its limits in docs/certificate.md; D8 by O'Callaghan and Mark 1984; ridges as
// in Nenu 2015, figure 8.
// Cost: O(n) and the lengths of all flow paths from sources, beside the flow field that it is
// given; all thresholds (16, 24, 32, 48 ...) are counted in one pass. One thread.
// Not for: rivers wider than a cell, which have no trace of their own; a river file without a DEM
// (topology.hpp). Rivers of one survey rarely pass on a DEM of another: read the findings, not the
// verdict.
// Example:
//     Certificate const found = certify(dem, flow::route(dem), flow::reaches_of(network));
//     double const share_at_one_cell = found.traced[1].recall;
//     ExtractedRidges const ridges = extract_ridges(dem, ridge_lines);
// More: docs/certificate.md.

namespace thalweg::measure {

/// Agreement of extracted cells with river cells within a distance.
struct Agreement {
    double precision = 0.0; ///< share of extracted cells with a river cell within the distance
    double recall = 0.0;    ///< share of river cells with an extracted cell within the distance
    double f() const { return precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0; }
};

/// By distance 0, 1 and 2 cells: the cell itself, its 3 x 3 and its 5 x 5 neighbourhood.
using Agreements = std::array<Agreement, 3>;

/// A certificate that a DEM drains, and along a network.
struct Certificate {
    std::int64_t depressions = 0;
    std::int64_t pit_cells = 0;
    double max_depth_m = 0.0;
    double pit_volume_m3 = 0.0;

    std::int64_t river_cells = 0;     ///< cells under the network with data
    std::int64_t following_cells = 0; ///< of these: water continues downstream in the network, or leaves with it
    std::int64_t border_cells = 0;    ///< of these: on the DEM's border, without a source or outlet
    std::int64_t lake_cells = 0;      ///< of these: in lakes, where flow is not traced
    std::int64_t waived_cells = 0;    ///< under the network, but not honoured; the other counts exclude them
    std::int64_t sources = 0;
    std::int64_t arriving_sources = 0; ///< whose flow path ends within a cell of their outlet
    Agreements traced;                 ///< flow paths from sources, each to its outlet
    std::int64_t threshold_cells = 0;  ///< contributing area at which extraction agrees best within a cell
    Agreements extracted;              ///< cells with at least that area

    std::int64_t compared_areas = 0;  ///< reaches with a claimed area at the lower end
    std::int64_t close_areas = 0;     ///< of these: within 5 % of the DEM's
    double max_area_difference = 0.0; ///< largest difference, relative to the DEM's
    std::vector<Finding> findings;    ///< feature: the reach's id

    /// The checks that hold for a network that the DEM drains; everything else is only reported.
    /// \return entries for report.json
    std::vector<Check> checks() const;
};

/// What is claimed of rivers besides their lines.
struct Claims {
    std::vector<double> ds_area_m2 = {}; ///< by reach: contributing area at its lower end; NaN: no claim; empty: none
    /// 1: rivers stand where the DEM is level, as in lakes, with all 8-connected level water; empty: nowhere
    Mask still = {};
    /// 1: cells into which rivers were drawn, which agreement at distance 0 counts; empty: the reaches' cells
    Mask drawn = {};
    Mask honoured = {}; ///< 1: the DEM honours the river from here to its end; empty: everywhere
};

/// Certifies that a DEM drains along a network. Kinds of finding (amount): depression (depth [m]), water_leaves: a
/// river cell whose water leaves its river (drop to its receiver [m]), source_astray (distance from the end of the flow
/// path to the outlet [m]), border_cell (0), outside_dem: a reach that leaves the DEM's data (its cells without). At
/// most a thousand findings of each kind are listed.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM, with its sinks, if any
/// \param reaches with their parts inside the DEM's grid
/// \param claims of the network's file
/// \return from the DEM's steepest descent (flow::route) and the reaches' cells (cells_along), without corners that a
/// diagonal step of a reach passes
/// \throws BadInput for drainage or claims of another DEM or other reaches; as river_cells
Certificate certify(Raster<float> const& dem, flow::FlowField const& drainage, flow::Reaches const& reaches,
                    Claims const& claims = {}, Run const& run = {});

/// The ridges of a DEM compared with prescribed ridges.
struct ExtractedRidges {
    std::int64_t ridge_cells = 0; ///< cells under prescribed ridges with data
    /// contributing area of the inverted DEM at which extraction agrees best within a cell
    std::int64_t threshold_cells = 0;
    Agreements extracted; ///< cells with at least that area, against those under ridges
};

/// Extracts ridges as the streams of the inverted DEM and compares them with prescribed ridges, as certify compares
/// streams.
/// \param dem [m] by cell; NaN: no data
/// \param ridges on the DEM's grid
/// \return the agreement at the best threshold that certify tries; all 0 without ridges
/// \throws BadInput as flow::route and cells_along
///
/// Source: \cite nenu2015, figure 8, whose ridges a GIS extracts so; \cite ocallaghan1984.
ExtractedRidges extract_ridges(Raster<float> const& dem, RidgeLines const& ridges, Run const& run = {});

} // namespace thalweg::measure
