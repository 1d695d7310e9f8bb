// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/replay.hpp>

#include <filesystem>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::commands {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_file = std::int64_t{1} << 40;

} // namespace

ReplayResult run_replay(ReplayParams const& params, Run const& run) {
    std::string const& folder = params.folder;
    std::string const recipe_file = folder + "/recipe.toml";
    recipe::Recipe recipe = recipe::read_recipe(io::read_text(recipe_file, 2 << 20), recipe_file);
    recipe.folder = folder;
    io::TemporaryFolder const aside("thalweg-replay");
    std::string const again = (aside.path() / "again").string();
    ReplayResult out;
    for (std::string const& name : report::write_terrain(make::make(recipe, run), again, io::Existing::refuse, run)) {
        if (name.rfind("report.", 0) == 0) {
            continue; // times differ
        }
        std::string const old = (fs::path(folder) / name).string();
        if (!fs::exists(old)) {
            out.missing.push_back(name);
        } else {
            bool const same =
                io::read_text(old, largest_file) == io::read_text((fs::path(again) / name).string(), largest_file);
            (same ? out.same : out.differ).push_back(name);
        }
    }
    return out;
}

} // namespace thalweg::commands
