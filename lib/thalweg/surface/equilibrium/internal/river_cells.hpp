// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// Heights of rivers, and shortened rivers. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Tangent of a graded river cell by its contributing area, at most a share of the cap.
float graded_tangent(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n);

/// The height of a graded river cell above its receiver's height, through layers of rock where there are some.
float graded_height(TerrainLevel const& level, EquilibriumLaw const& law, std::size_t n, float below);

/// Long profiles of rivers through prescribed heights: between them as steep as necessary, above the highest graded.
/// \param fall by river cell: of a graded river, to its receiver
/// \param asked by river cell: the prescribed height, or NaN; they do not rise downstream
std::vector<float> heights_through(RiverCells const& rivers, std::vector<float> const& fall, std::vector<float> asked);

/// Sets rivers to their graded heights for their contributing areas: at most a share of the hillslope cap, and not
/// above the terrain two cells away, so that they are not perched. Lakes are level; below those with levels, rivers
/// rise to them whatever the terrain.
void relax_rivers(TerrainLevel& level, EquilibriumLaw const& law);

/// Sets rivers to prescribed heights; between these they are graded as steeply as necessary, above the highest like the
/// other terrain. Fixed: kept, except for a rise of one ulp where necessary. Soft: lowered where the terrain beside is
/// lower, or where water would not run otherwise.
void relax_given_rivers(TerrainLevel& level, EquilibriumLaw const& law, RiverHeights heights);

/// The normalised steepness of the main stems of a level's rivers, for a concavity of 0.45: rise over chi, each stem
/// weighted by the area that its mouth drains. A stem goes up along the largest area.
/// \param cell_m [m] side of the finest cells
/// \return [m^-0.1] per unit of height: times the metres of a unit it is in m^0.9; NaN where no stem rises
double stem_steepness(TerrainLevel const& level, double cell_m);

/// Whether water leaves the caller's grid at river cell n of a level.
bool leaves_grid(RiverCells const& rivers, std::size_t n);

/// Whether a river runs through a cell at its river cell n or within a number of steps downstream.
bool runs_through(RiverCells const& rivers, std::size_t n, std::size_t cell, int steps);

/// Lists river cells, by number in the caller's Channels and in order, that are perched above cells other than their
/// own river's: all, or those in and below lakes with levels.
enum class Walls : std::uint8_t { all, by_lakes, land }; ///< land: above land that lies beside no river
std::vector<std::int64_t> walled_cells(TerrainLevel const& level, float tangent, Walls walls = Walls::all);

/// Lowers such cells as long as they stay a step above their receivers, which are lowered with them over a short
/// distance.
void lower_perched(TerrainLevel& level, float tangent, float step);

/// The steepest rise from a river to a bank, relative to the mean slope: 43 degrees where that is 25.
inline constexpr float steepest_bank = 2.0F;

/// Lowers banks to at most a rise above the river cells to which they drain, and a step above other rivers beside them.
void lower_banks(TerrainLevel& level, float rise, float step);

/// Raises the terrain two to four cells from a perched river cell, as a slope, until it is no longer perched.
void raise_below_perched(TerrainLevel& level, float tangent);

/// Raises land two cells from a river, banks aside, to the river less a tangent times a cell.
void raise_land_beside(TerrainLevel& level, float tangent);

/// Shortens rivers: removes perched cells near heads and everything upstream of them. Removed cells become land; under
/// `stay`, a bank does not become lower than a river beside it. Returns numbers in the caller's Channels.
enum class TipBanks : std::uint8_t { stay, rise };
std::vector<std::int64_t> remove_perched_tips(TerrainLevel& level, float tangent, TipBanks banks);

/// Removes likewise the cells near heads for which lower_perched() would cut a long trench with a nearly level bed,
/// whose sides have no time to come down.
std::vector<std::int64_t> remove_trenched_tips(TerrainLevel& level, float tangent);

/// Removes likewise the cells near heads that lie beside another river's cells, where no terrain fits between them.
std::vector<std::int64_t> remove_touching_tips(TerrainLevel& level);

/// Where rivers lie side by side, adjusts heights so that each river cell's steepest descent leads to its receiver, and
/// a cell at which a river leaves the caller's grid has none in it: lowers the cell or raises its neighbour, in a few
/// passes. Conflicts that cannot be resolved (a receiver's receiver beside the cell) remain. least: the least tangent
/// towards a receiver.
void enforce_receivers(TerrainLevel& level, float least = least_tangent);

} // namespace thalweg::surface
