// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/recipe/presets.hpp>

#include "command.hpp"

namespace presets_command_test {

namespace {

using test::has;

/// A grid of a blink, with rivers as close as they may be, whatever the recipe says.
std::string const on_few_cells = " --set grid.width=96 --set grid.height=96 --set network.prune=16 --set "
                                 "network.forest.spacing=8 --set network.forest.outlet_spacing=128 --only dem";

} // namespace

TEST(PresetCommand, PrintsTheRecipeThatMakesTheSame) {
    Workplace const place;
    for (thalweg::recipe::Preset const& preset : thalweg::recipe::presets()) {
        SCOPED_TRACE(preset.name);
        std::string const toml = expect_run(place, "recipe --preset " + preset.name, 0).out;
        place.write(preset.name + ".toml", toml);
        expect_run(place, "make " + preset.name + ".toml -o printed_" + preset.name + on_few_cells, 0);
        expect_run(place, "make --preset " + preset.name + " -o named_" + preset.name + on_few_cells, 0);
        for (char const* file : {"dem.tif", "recipe.toml"}) {
            EXPECT_EQ(file_bytes(place / ("printed_" + preset.name) / file),
                      file_bytes(place / ("named_" + preset.name) / file))
                << file;
        }
    }
}

TEST(PresetCommand, GoesBehindTheRecipeAndTheRecipeBehindSet) {
    Workplace const place;
    place.write("steep.toml",
                "[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"forest\"\n[network.forest]\nspacing = 8\n"
                "[surface]\nmean_slope = 20\nfloor_width = 0.05\n");
    expect_run(place, "make steep.toml --preset hills --set surface.mean_slope=18 --only dem -o out", 0);
    std::string const made = file_bytes(place / "out/recipe.toml");
    EXPECT_TRUE(has(made, "mean_slope = 18.0\n", "floor_width = 0.05\n", "uplift_pattern = 'domes'\n")) << made;
}

TEST(PresetCommand, ShapesLandAroundGivenRivers) {
    Workplace const place;
    expect_run(place,
               "make " + samples + "walker_nhdplus.gpkg" + " --preset hills --set grid.cell=90 --only dem -o out", 0);
    std::string const made = file_bytes(place / "out/recipe.toml");
    EXPECT_TRUE(has(made, "source = 'lines'\n", "mean_slope = 10.0\n", "uplift_pattern = 'domes'\n")) << made;
    EXPECT_FALSE(has(made, "[network.forest]"));
}

TEST(PresetCommand, NamesThemAll) {
    Workplace const place;
    std::string const help = expect_run(place, "recipe --help", 0).out;
    for (thalweg::recipe::Preset const& preset : thalweg::recipe::presets()) {
        EXPECT_TRUE(has(help, preset.name + ": "));
    }
    for (char const* command : {"make --preset basin", "recipe --preset basin"}) {
        expect_run(place, command, 2, "hills, basin-and-range, dissected-plateau");
    }
    expect_run(place, "make --preset hill", 2, "Did you mean 'hills'?");
    expect_run(place, "recipe --preset hills --dump", 2, "excludes");
    expect_run(place, "make " + samples + "jacksboro_utm16.tif" + " --preset hills", 2, "is of equilibrium terrain");
}

} // namespace presets_command_test
