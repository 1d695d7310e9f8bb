// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

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
