// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: An observer on a cell looks along eight lines of sight. On each the steepest upward and the
// steepest downward slope are compared: the line rises, falls or is level. The numbers of rising
// and falling lines, not their order, give the form from a table: eight falling is a peak, eight
// rising a pit, all level a flat. Because the steepest slope within the whole search distance
// decides, the form adapts to the size of the valley around it, up to that distance; a window of
// fixed size would see one scale alone.
// Source: Jasiewicz and Stepinski 2013, figure 3; the same results as GRASS's r.geomorphon but for
// rounding.
// Cost: O(n search_cells), eight lines of up to search_cells - 1 cells for each cell; one byte a
// cell. Rows run on all cores, and inner loops run along rows, so that compilers vectorise them.
// Not for: a border of search_cells cells, which is not classified; land gentler than flat_deg, all
// of it flat. Large valleys need a larger search distance, and the cost grows with it.
// Example:
//     Geomorphons const forms = geomorphons(dem, {.search_cells = 15, .flat_deg = 1.0});
//     auto const valleys = forms.cells[static_cast<std::size_t>(Form::valley) - 1];
//     bool const on_ridge = forms.form[Cell{40, 30}] == static_cast<std::uint8_t>(Form::ridge);
// More: docs/relief_measures.md, "Methods".

namespace thalweg::measure {

/// The ten landforms, numbered as in GRASS; 0: not classified.
enum class Form : std::uint8_t { none, flat, peak, ridge, shoulder, spur, slope, hollow, footslope, valley, pit };

inline constexpr std::size_t form_count = 10;

/// Options of geomorphons().
struct GeomorphonParams {
    std::int64_t search_cells = 15; ///< [2, 10000] search distance, excluded
    std::int64_t skip_cells = 0;    ///< [0, search_cells) inner distance that is skipped
    double flat_deg = 1.0;          ///< (0, 45) flatness threshold
};

/// What geomorphons() returns.
struct Geomorphons {
    Raster<std::uint8_t> form;                    ///< by cell, a Form
    std::array<std::int64_t, form_count> cells{}; ///< of each form, from flat to pit
    std::array<double, form_count> shares{};      ///< [0, 1] of all classified cells; 0: there are none
};

/// Classifies landforms by geomorphons: how many of eight lines of sight rise and how many fall. A line rises where its
/// steepest upward slope exceeds both its steepest downward slope and flat_deg, and falls in the opposite case;
/// otherwise, and where its first cell has no data, it is level. Distances are true: diagonals reach fewer cells.
/// \param dem [m] by cell; NaN: no data
/// \return as GRASS's r.geomorphon (skip=0, no flat distance, default comparison), but for rounding; cells closer to
/// the border than the search distance are not classified. The same bytes for any number of threads.
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite jasiewicz2013, table of forms, figure 3.
Geomorphons geomorphons(Raster<float> const& dem, GeomorphonParams const& params = {}, Run const& run = {});

/// What local_extremes() returns.
struct LocalExtremes {
    std::int64_t pits = 0;  ///< cells lower than all eight neighbours
    std::int64_t peaks = 0; ///< cells higher than all eight neighbours
    std::int64_t cells = 0; ///< with data and eight neighbours with data
};

/// Counts single-cell pits and peaks. Fluvial terrain has fewer pits than peaks, because water fills pits; noise has as
/// many of each.
/// \param dem [m] by cell; NaN: no data
/// \return the same for any number of threads
LocalExtremes local_extremes(Raster<float> const& dem, Run const& run = {});

} // namespace thalweg::measure
