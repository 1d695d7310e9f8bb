// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::commands {

/// Options of run_make().
struct MakeParams {
    std::string input = {}; ///< a recipe, rivers or a DEM, as for recipe_from(); "": a recipe that suits the keys
    std::string output = "valley"; ///< a folder
    io::Existing existing = io::Existing::refuse;
    std::vector<std::string> set = {}; ///< KEY=VALUE: keys of the recipe, in order
    std::string preset = {};           ///< of recipe::presets(): for keys that neither input nor set gives; "": none
    /// names of the fields of rivers that hold arc_id, ds_arc, from_node, to_node, direction, key (a rank that falls
    /// downstream) and type
    std::map<std::string, std::string> fields = {};
};

/// Runs `thalweg make`: makes the terrain of a recipe or around rivers and writes the folder, completely or not at all.
/// \param params recipe or rivers, and options
/// \return the terrain
/// \throws BadParameter for a key or field that is unknown, and as recipe::with_preset()
/// \throws Error as recipe_from(), UserFiles, make() and write_terrain()
make::MakeResult run_make(MakeParams const& params, Run const& run = {});

/// \internal
/// Runs `thalweg make --dry-run`: plans the same work, and writes nothing.
/// \return the forecast
/// \throws Error as run_make()
recipe::Forecast forecast_make(MakeParams const& params, Run const& run = {});

/// Options of run_rebuild().
struct RebuildFromParams : MakeParams {
    std::string like = {};    ///< DEM whose mean slope and texture the terrain gets; "": they follow from the rivers
    std::string against = {}; ///< DEM on whose cells the terrain is made, and which it is compared with; "": none
};

/// Runs `thalweg rebuild`: makes the terrain between rivers with heights, as `make` with network.heights = "file", and
/// compares it with a DEM that decides nothing of it but its grid.
/// \param params rivers, and options
/// \return the terrain
/// \throws BadParameter without rivers; BadInput when the input has none
/// \throws Error as run_make()
make::MakeResult run_rebuild(RebuildFromParams const& params, Run const& run = {});

/// \internal
/// Runs `thalweg rebuild --dry-run`: plans the same work, and writes nothing.
/// \return the forecast
/// \throws Error as run_rebuild()
recipe::Forecast forecast_rebuild(RebuildFromParams const& params, Run const& run = {});

/// Runs `thalweg recipe --for`: settles the recipe that make uses for rivers or a DEM.
/// \param rivers as for data_recipe()
/// \param source_crs of rivers whose file has no CRS; "": none
/// \return as settled_recipe()
/// \throws BadInput as settled_recipe(), and for a path that is not UTF-8
recipe::Recipe recipe_for(std::string const& rivers, std::string const& source_crs = {}, Run const& run = {});

} // namespace thalweg::commands
