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
    DemChange banks;       ///< raised so that rivers stay in their channels (confine_channels)
    DemChange depressions; ///< filled or cut after that
};

/// Conditions a DEM hydrologically: its rivers drain it, in the very floats that are written, after the least change.
/// \pre a DEM whose river cells stand at the valley's heights; a valley without any where there are no rivers, or none
/// to be honoured.
/// \param dem [m] heights by cell; NaN: no data
/// \param valley [m] heights of the river cells
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return river cells keep their heights bit for bit; otherwise as confine_channels, then fill or carve. Method none
/// changes nothing.
/// \throws Error as those
ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params = {},
                         Run const& run = {});

} // namespace thalweg::flow
