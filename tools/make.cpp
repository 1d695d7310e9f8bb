// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/io/files.hpp>
#include <thalweg/pipeline/recipe.hpp>
#include <thalweg/pipeline/report.hpp>
#include <thalweg/pipeline/terrain.hpp>
#include <thalweg/pipeline/write_terrain.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::tools {

namespace {

struct Options {
    std::string recipe;
    std::string folder = "valley";
    std::vector<std::string> set;
    std::optional<std::uint64_t> seed;
    bool overwrite = false;
};

pipeline::Recipe recipe_of(Options const& options) {
    pipeline::Recipe recipe = pipeline::default_recipe();
    if (!options.recipe.empty()) {
        recipe = pipeline::read_recipe(io::read_text(options.recipe, 2 << 20), options.recipe);
        recipe.folder = std::filesystem::path(options.recipe).parent_path().string();
    }
    for (std::string const& assignment : options.set) {
        pipeline::set_key(recipe, assignment);
    }
    if (options.seed) {
        pipeline::set_key(recipe, fmt::format("seed={}", *options.seed));
    }
    return recipe;
}

int make(Options const& options, Session const& session) {
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::Recipe const recipe = recipe_of(options);
    pipeline::check_folder(options.folder, existing);
    pipeline::Terrain const terrain = pipeline::make_terrain(recipe, session.run);
    pipeline::write_terrain(terrain, options.folder, existing, session.run);
    for (Check const& check : terrain.checks) {
        if (!check.ok) {
            session.run.say(fmt::format("check  {}: {} (at most {})  FAILED", check.name, check.value, check.limit));
        }
    }
    if (terrain.passed()) {
        std::size_t const outlets = NetworkIndex(terrain.network.plan).outlets.size();
        std::string const words =
            fmt::format("{} checks, {} outlet{}{}", terrain.checks.size(), outlets, outlets == 1 ? "" : "s",
                        terrain.surface ? fmt::format(", {} cells in pits", terrain.pits) : "");
        session.run.say(fmt::format("check  {:<60}      ok", words));
    }
    session.run.say(fmt::format("open   {}/report.html   (no internet needed)", options.folder));
    fmt::print("{}", session.json ? io::read_text(options.folder + "/report.json", 1 << 30) : options.folder + "\n");
    return terrain.passed() ? Exit::done : Exit::check_failed;
}

} // namespace

Command add_make(CLI::App& app, Session& session) {
    auto const options = std::make_shared<Options>();
    app.add_option("RECIPE", options->recipe, "a recipe file (TOML); without one, a valley grown on 1024x1024 cells");
    app.add_option("-o,--output", options->folder, "folder for what is made")->capture_default_str();
    app.add_option("--set", options->set, "section.key=value, over the recipe; may be repeated")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--seed", options->seed, "of every chance");
    app.add_flag("--json", session.json, "report.json on stdout");
    app.add_flag("--overwrite", options->overwrite, "replace what an earlier make left in the folder");
    return [options, &session] { return make(*options, session); };
}

} // namespace thalweg::tools
