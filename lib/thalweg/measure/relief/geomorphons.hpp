// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::measure {

/// The ten forms, numbered as GRASS numbers them; 0: a cell that was not looked at.
enum class Form : std::uint8_t { none, flat, peak, ridge, shoulder, spur, slope, hollow, footslope, valley, pit };

inline constexpr std::size_t form_count = 10;

/// Options of geomorphons().
struct GeomorphonParams {
    std::int64_t search_cells = 15; ///< [2, 10000] how far a cell looks; what stands there is no longer seen
    std::int64_t skip_cells = 0;    ///< [0, search) that it looks over
    double flat_deg = 1.0;          ///< (0, 45) what is less steep is level
};

/// What geomorphons() returns.
struct Geomorphons {
    Raster<std::uint8_t> form;                    ///< by cell, a Form
    std::array<std::int64_t, form_count> cells{}; ///< of each form, from flat to pit
    std::array<double, form_count> shares{};      ///< [0,1] of all cells with a form; 0 where there are none
};

/// Which form each cell of a DEM has to somebody who stands there and looks in eight directions: how many rise, how
/// many fall.
/// \param dem NaN for no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return in each direction the steepest sight upwards and downwards of the cells nearer than the search distance
/// (true distance: diagonals reach less far); it rises where the way up is steeper, falls where the way down is, both
/// beyond the flatness; a direction whose first cell has no data, or with both as steep, is level. Cells nearer to the
/// border than the search distance have no form, nor have cells without data. What GRASS's r.geomorphon (skip=0, no
/// flat distance, its default comparison) writes, but for rounding. The same bytes for any number of threads.
/// \throws BadParameter
/// \throws Cancelled
///
/// Source: \cite jasiewicz2013, table of forms, figure 3.
Geomorphons geomorphons(Raster<float> const& dem, GeomorphonParams const& params = {}, Run const& run = {});

} // namespace thalweg::measure
