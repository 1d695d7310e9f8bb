// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/flow/conditioning/dem_change.hpp>

namespace thalweg::flow {

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
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return river cells keep their heights bit for bit; as float32, each cell drains
/// \throws Error as confine_channels, fill and carve
ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params = {},
                         Run const& run = {});

} // namespace thalweg::flow
