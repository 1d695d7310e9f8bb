// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/internal/make.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/make_input.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::commands {

namespace {

/// The recipe if no file is given: if keys of the cluster are set, a cluster; else rivers that suit the grid.
recipe::Recipe recipe_without_file(std::vector<std::string> const& assignments) {
    bool const of_cluster = std::ranges::any_of(assignments, [](std::string const& assignment) {
        return assignment.starts_with("network.dla.") || assignment.starts_with("network.source=dla") ||
               assignment.starts_with("network.source=\"dla");
    });
    if (of_cluster) {
        return recipe::cluster_recipe();
    }
    recipe::Recipe asked = recipe::default_recipe();
    for (std::string const& assignment : assignments) {
        recipe::set_key(asked, assignment);
    }
    recipe::Recipe recipe = recipe::default_recipe_on(asked.grid.width, asked.grid.height);
    if (asked.network && (asked.network->forest.seeds > 0 || !asked.network->forest.outlets.empty())) {
        recipe.network->forest.outlet_spacing_cells = 0; // outlets are chosen otherwise
    }
    return recipe;
}

/// A recipe with the keys that the options set.
recipe::Recipe with_options(recipe::Recipe recipe, MakeParams const& params) {
    static std::map<std::string, char const*> const keys{{"arc_id", "network.lines.id_field"},
                                                         {"ds_arc", "network.lines.down_field"},
                                                         {"from_node", "network.lines.from_field"},
                                                         {"to_node", "network.lines.to_field"},
                                                         {"direction", "network.lines.direction_field"},
                                                         {"key", "network.lines.rank_field"},
                                                         {"type", "network.lines.type_field"}};
    for (std::string const& assignment : params.set) {
        recipe::set_key(recipe, assignment);
    }
    for (auto const& [quantity, name] : params.fields) {
        auto const key = keys.find(quantity);
        refuse_if<BadParameter>(
            key == keys.end(), "commands.run_make",
            "--field {}={}: make reads arc_id, ds_arc, from_node, to_node, direction, key (a rank that "
            "falls downstream) and type from fields that are named",
            quantity, name);
        recipe::set_key(recipe, fmt::format("{}={}", key->second, name));
    }
    return recipe;
}

recipe::Recipe recipe_to_rebuild(RebuildFromParams const& params) {
    refuse_if<BadParameter>(
        params.input.empty(), "commands.run_rebuild",
        "name the rivers: any file of lines with heights that GDAL reads, or a folder written by make or convert");
    recipe::Recipe recipe = recipe::recipe_from(params.input);
    for (auto const& [key, file] : {std::pair{"surface.like", &params.like}, {"output.against", &params.against}}) {
        if (!file->empty()) {
            recipe::set_key(recipe, key, *file);
        }
    }
    return with_options(std::move(recipe), params);
}

} // namespace

recipe::Recipe recipe_asked(MakeParams const& params) {
    recipe::Recipe recipe = with_options(
        params.input.empty() ? recipe_without_file(params.set) : recipe::recipe_from(params.input), params);
    return params.preset.empty() ? recipe : recipe::with_preset(std::move(recipe), params.preset);
}

make::MakeResult run_make(MakeParams const& params, Run const& run) {
    recipe::Recipe recipe = recipe_asked(params);
    recipe::UserFiles const files(recipe, run);
    return report::make_folder(recipe, params.output, params.existing, run);
}

recipe::Forecast forecast_make(MakeParams const& params, Run const& run) {
    recipe::Recipe recipe = recipe_asked(params);
    recipe::UserFiles const files(recipe, run);
    return recipe::forecast(recipe, run);
}

make::MakeResult run_rebuild(RebuildFromParams const& params, Run const& run) {
    recipe::Recipe recipe = recipe_to_rebuild(params);
    recipe::UserFiles const files(recipe, run);
    return report::make_folder(recipe::rebuild_recipe(recipe, run), params.output, params.existing, run);
}

recipe::Forecast forecast_rebuild(RebuildFromParams const& params, Run const& run) {
    recipe::Recipe recipe = recipe_to_rebuild(params);
    recipe::UserFiles const files(recipe, run);
    return recipe::forecast(recipe::rebuild_recipe(recipe, run), run);
}

recipe::Recipe recipe_for(std::string const& rivers, std::string const& source_crs, Run const& run) {
    refuse_if<BadInput>(!is_utf8(std::filesystem::absolute(rivers).string()), "commands.recipe_for",
                        "the path of {} is not UTF-8, and recipes are: rename it", rivers);
    recipe::Recipe recipe = recipe::data_recipe(rivers);
    if (!source_crs.empty()) {
        recipe::set_key(recipe, "network.lines.source_crs=" + source_crs);
    }
    return recipe::settled_recipe(recipe, run);
}

} // namespace thalweg::commands
