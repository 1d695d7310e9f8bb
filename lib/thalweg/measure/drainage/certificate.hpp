// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments/reaches.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::measure {

/// How far cells found agree with a river's, within this many cells.
struct Agreement {
    double precision = 0.0; ///< share of the cells found that have a river cell within the distance
    double recall = 0.0;    ///< share of the river cells that have a found one within it
    double f() const { return precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0; }
};

/// At 0, 1 and 2 cells: the cell itself, its 3 x 3 and its 5 x 5 cells.
using Agreements = std::array<Agreement, 3>;

/// Whether a DEM drains, and drains by a network.
struct Certificate {
    std::int64_t depressions = 0;
    std::int64_t pit_cells = 0;
    double max_depth_m = 0.0;
    double pit_volume_m3 = 0.0;

    std::int64_t river_cells = 0;     ///< cells under the network, where the DEM has heights
    std::int64_t following_cells = 0; ///< of these, whose water goes on in the network, downstream, or leaves with it
    std::int64_t border_cells = 0;    ///< of these, on the DEM's border though no river ends or begins there
    std::int64_t lake_cells = 0;      ///< of these, in lakes; what water does there is not traced
    std::int64_t waived_cells = 0;    ///< under the network, but not to be honoured; the rest is said of the others
    std::int64_t sources = 0;
    std::int64_t arriving_sources = 0; ///< whose water comes within a cell of where the network lets it out
    Agreements traced;                 ///< the ways of the sources' water, each to its outlet
    std::int64_t threshold_cells = 0;  ///< of contributing area, at which extraction agrees best within a cell
    Agreements extracted;              ///< the cells with that area or more

    std::int64_t compared_areas = 0;  ///< reaches whose file names an area at the lower end
    std::int64_t close_areas = 0;     ///< of these, that differ from the DEM's by 5 % or less
    double max_area_difference = 0.0; ///< greatest relative difference of it from that of the DEM
    std::vector<Finding> findings;    ///< feature: the reach's id

    /// \return what holds for a network that the DEM drains; the rest is reported.
    std::vector<Check> checks() const;
};

/// What is said of rivers besides their lines.
struct Claims {
    std::vector<double> ds_area_m2 = {}; ///< by reach the contributing area at its lower end, NaN where none is given;
                                         ///< empty: of none
    Mask still = {}; ///< 1: rivers stand here where the DEM is level, as in lakes, and so does the level water around,
                     ///< side by side or by corners; without cells: nowhere
    Mask drawn = {}; ///< 1: the cells into which rivers were drawn; without cells: those the reaches pass. Agreement
                     ///< in the same cell is that with them
    Mask honoured = {}; ///< 1: the DEM honours the river here, and from here to its end; without cells: everywhere
};

/// Kinds of finding (amount): depression (depth [m]), water_leaves: a river cell whose water leaves its river (drop to
/// where it goes [m]), source_astray (straight distance from its water's end to its outlet [m]), border_cell (0),
/// outside_dem: a reach that leaves the DEM's data (its cells without). Lists of each kind end with the thousandth.
/// \pre reaches with their parts in the DEM's grid; drainage of that DEM, to its sinks where there are any.
/// \param dem [m] heights by cell; NaN: no data
/// \param drainage the flow field of the DEM
/// \param reaches the reaches
/// \param claims what the network claims
/// \param run progress, log, stop token and number of threads
/// \return the certificate, of the DEM's own steepest descent (flow::route) and the reaches' own cells (cells_along),
/// without corners, which a diagonal step of the reach passes.
/// \throws BadInput drainage or claims are not of this DEM or these reaches; as river_cells
/// \throws Cancelled
Certificate certify(Raster<float> const& dem, flow::FlowField const& drainage, flow::Reaches const& reaches,
                    Claims const& claims = {}, Run const& run = {});

} // namespace thalweg::measure
