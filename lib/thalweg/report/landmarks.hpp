// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::report {

/// \return [m] the lowest and the highest of the heights that are numbers; nothing: there is none
std::optional<std::pair<double, double>> height_range(Raster<float> const& dem);

/// A summit to name on a map.
struct Summit {
    Vec2 at; ///< centre of its cell
    double z = 0.0;
};

inline constexpr std::size_t summits_named = 24; ///< by maps and the page

/// Chooses the summits that a map names: those whose prominence is a twentieth of the relief or more, none nearer than
/// a sixteenth of the longer side to a more prominent one. Of a DEM of more than 1024 cells a side the highest cells of
/// blocks are compared: saddles between them are less deep than on the DEM itself.
/// \param dem [m] NaN: no data
/// \param most number of summits at most
/// \return the most prominent first, the highest of all at the front
std::vector<Summit> summits(Raster<float> const& dem, std::size_t most, Run const& run = {});

/// \internal
/// Finds what a map takes from all cells of a DEM, in one pass.
/// \param columns of pixels that the map has for it, >= 1
/// \return means over pixels, highest cells of the blocks that summits() compares, and the range of heights
Overview overview_of(Raster<float> const& dem, std::int64_t columns, Run const& run = {});

/// \internal
/// \param seen overview_of() the DEM, of any number of columns
/// \return the same as without it
std::vector<Summit> summits(Raster<float> const& dem, Overview const& seen, std::size_t most, Run const& run = {});

/// The sea: cells of a terrain without data.
struct Sea {
    double level_m = 0.0;
    bool is_around = false; ///< it reaches beyond the grid
};

/// \internal
/// \return the sea of a terrain; nothing: cells without data are not the sea
std::optional<Sea> sea_of(make::Terrain const& terrain);

/// \internal
/// \param planform rivers of the recipe
/// \return the sea of the terrain that will be made of them, as far as these tell
std::optional<Sea> sea_of(recipe::Recipe const& recipe, make::Planform const& planform);

/// \internal
/// \param made recipe as make writes it: it names the edge of terrain in equilibrium
/// \return the sea of such a terrain; nothing for other ones
std::optional<Sea> sea_of(recipe::Recipe const& made);

} // namespace thalweg::report
