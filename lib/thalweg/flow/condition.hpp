// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: A DEM whose rivers drain it, changed as little as possible. Rivers leave their channel not
// by pits but over their banks: the bank diagonally ahead is often lower than the next cell. So
// banks are raised first, by the least that keeps steepest descent in the river. Then depressions:
// `fill` floods them from where water leaves, rising by the least steps; `carve` finds for each the
// way on which a cut from its lowest cell moves the least volume (Dijkstra, cost: depth of the
// cut), compares it with filling, and among rivers also fills part of the way first. Lower pits
// come first, and what a cut leaves is treated in turn. Only lakes around undrained cells are
// flooded, so a DEM that drains costs one look.
// Source: Barnes et al. 2014; least-cost breaching as Soille 2004 and Lindsay 2016; banks first is
// ours: docs/decisions/0013-water.md.
// Cost: docs/performance.md, 2048 x 2048: 1.8 ns a cell where all drains; filling relief 83 ns and
// 20 bytes, carving it 202 ns and 28 bytes, carving noise 1.5 us. The look for undrained cells runs
// on all cores, the rest on one.
// Not for: routing alone (route.hpp leaves the DEM as it is); real lakes and sinkholes, which
// disappear. Noise as high as the relief makes carving slow: fill.
// Example:
//     ConditionedDem const drained = condition(dem, valley, {.method = Conditioning::carve});
//     double const moved_m3 = drained.banks.volume_m3() + drained.depressions.volume_m3();
//     Raster<float> const flat = fill_depressions(dem, {.level = true});
// More: docs/certificate.md, "How a surface is made to pass".

namespace thalweg::flow {

/// The difference between two DEMs.
struct DemChange {
    std::int64_t raised_cells = 0;
    std::int64_t cut_cells = 0;
    double max_raise_m = 0.0;
    double max_cut_m = 0.0;
    double raised_m3 = 0.0;
    double cut_m3 = 0.0;

    double volume_m3() const { return raised_m3 + cut_m3; }
};

/// Compares two DEMs of one grid. Cells without data in either are not compared.
/// \param before,after [m] by cell; NaN: no data
/// \return the cells that differ, and by how much
/// \throws BadInput when they differ in grid
DemChange change_between(Raster<float> const& before, Raster<float> const& after);

enum class Conditioning : std::uint8_t { none, fill, carve };

/// Options of condition().
struct ConditionParams {
    Conditioning method = Conditioning::carve;
};

/// What condition() returns.
struct ConditionedDem {
    Raster<float> dem;
    DemChange banks;       ///< raised to keep rivers in their channels (confine_channels)
    DemChange depressions; ///< then filled or carved
};

/// Conditions a DEM hydrologically with the least change, so that its rivers drain it: confine_channels, then fill or
/// carve. Method none changes nothing.
/// \param dem [m] by cell; NaN: no data; river cells have the valley's heights
/// \param valley [m] heights of river cells; all NaN: no rivers
/// \return river cells keep their heights bit for bit; as float32, each cell drains
/// \throws Error as confine_channels, fill and carve
ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params = {},
                         Run const& run = {});

/// Options of fill_depressions().
struct FillDepressionsParams {
    bool level = false; ///< fill to the spill level exactly, so that lakes are flat; else they slope to their outlets
};

/// Fills the depressions of a DEM.
/// \param dem [m] by cell; NaN: no data; not changed
/// \return [m] by cell, raised where water cannot run off the grid or into no data; sloping lakes rise from their
/// outlets by the least steps that float32 heights show (about 0.02 mm), so that each cell drains
/// \throws BadInput when the DEM has no cells or an infinite height
///
/// Source: \cite barnes2014.
Raster<float> fill_depressions(Raster<float> const& dem, FillDepressionsParams const& params = {}, Run const& run = {});

/// Drains the depressions of a DEM by moving the least volume: each is filled, cut open from its lowest cell, or both.
/// \param dem [m] by cell; NaN: no data; not changed
/// \return [m] by cell; each cell drains off the grid or into no data
/// \throws BadInput when the DEM has no cells or an infinite height
///
/// Source: least-cost breaching as \cite lindsay2016.
Raster<float> breach_depressions(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::flow
