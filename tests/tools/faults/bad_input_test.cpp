// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace bad_input_test {

namespace fs = std::filesystem;

namespace {

using test::geojson;

std::string lines_recipe(std::string const& path, std::string const& more = "") {
    return "[grid]\ncell = 10\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"" + path + "\"\n" + more +
           "[surface]\n";
}

} // namespace

TEST(BadInput, CommandLine) {
    Workplace const place;
    expect_refused(place, "",
                   {"mak",
                    "wombat",
                    "make --overwrit",
                    "make --theads=3",
                    "make -seed 3",
                    "make -Q",
                    "--seed 3 make",
                    "--sed 3 make",
                    "make -o make --overwrit",
                    "make --seed",
                    "completion bsh",
                    "help maek",
                    "recipe all",
                    "make --threads -1",
                    "make --device nonsense",
                    "make nowhere.toml",
                    "make .",
                    "check nowhere.gpkg",
                    "stats nowhere.tif",
                    "replay nowhere",
                    "make --set nothing"});
    // A likely name is offered.
    expect_run(place, "make --theads=3", 2, "'--threads'");
    expect_run(place, "help maek", 2, "'make'");
    expect_run(place, "recipe network.prun", 2, "'network.prune'");
}

TEST(BadInput, SeedsAreWholeNumbersOfARecipe) {
    Workplace const place;
    for (std::string const seed : {"-1", "9223372036854775808", "1.5", "x"}) {
        expect_refused(place, "", {"make -o out --seed " + seed, "grow --seed " + seed});
    }
    place.write("r.toml", "seed = 9223372036854775808\n[network]\n");
    expect_refused(place, "make -o out", {"r.toml", "--set seed=9223372036854775808"});
    expect_run(place, "grow --order 3 --seed 9223372036854775807", 0);
}

TEST(BadInput, OpenClDevices) {
    Workplace const place;
    setenv("THALWEG_OPENCL_DEVICE", "9:9", 1);
    expect_refused(place, small + "out", {"--device opencl"});
    unsetenv("THALWEG_OPENCL_DEVICE");
    setenv("OCL_ICD_VENDORS", "/nonexistent", 1); // where the loader looks for platforms
    expect_refused(place, small + "out", {"--device opencl"});
    expect_run(place, small + "out --device cpu", 0); // which needs no platform
    unsetenv("OCL_ICD_VENDORS");
}

TEST(BadInput, RecipeKeys) {
    Workplace const place;
    place.write("bad.toml", "[grid]\ncell = \"wide\"\n[network]\nprun = 3\n");
    place.write("faulty.txt", "sed = 7\n");
    place.write("broken.toml", "\x01\x02");
    expect_refused(place, "make -o out", {"bad.toml", "faulty.txt", "broken.toml"});
    expect_run(place, "make bad.toml", 2, "line 2: grid.cell", "line 4: unknown key 'network.prun'");
    expect_refused(place, small + "out --set",
                   {"network.prun=3", "surface.increment=rise_fal", "network.dla.sticking=0",
                    "network.dla.sticking=1.5", "network.dla.visits=0", "network.dla.particles=0",
                    "network.dla.particles=many", "grid.width=0", "grid.cell=0", "grid.cell=-3", "grid.crs=EPSG:4326",
                    "grid.crs=nonsense", "grid.width=900000 --set grid.height=900000", "network.prune=5000",
                    "surface.smoothing=101 --set surface.method=diffuse"});
}

TEST(BadInput, ValuesThatAreFoundWrongLateNameTheirKey) {
    Workplace const place;
    fs::create_directory(place / "empty");
    std::string const tiny = "make --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 "
                             "--set network.prune=0 ";
    std::string const folder = "[network.lines] path: empty is a folder";
    expect_run(place, tiny + "--set network.source=lines --set network.lines.path=empty -o out", 2, folder,
               "name a file in it");
    place.write("r.toml", lines_recipe("empty"));
    expect_run(place, "make r.toml -o out", 2, folder);
    expect_run(place, tiny + "--set grid.crs=missing.prj -o out", 2,
               "[grid] crs: 'missing.prj' is not a coordinate system");
    expect_run(place, tiny + "--set surface.method=dilate --set 'surface.increment=(x-3)^-1' -o out", 2,
               "[surface] increment: '(x-3)^-1' is not finite at x = 3");
}

TEST(BadInput, FolderThatIsTaken) {
    Workplace const place;
    fs::create_directory(place / "out");
    place.write("out/precious.txt", "mine");
    place.write("file", "mine");
    expect_refused(place, "make -o", {"out", "file"});
}

TEST(BadInput, LineFiles) {
    Workplace const place;
    struct Case {
        std::string file;      ///< rivers.geojson
        std::string more = ""; ///< of the section network.lines
        std::string set = "";
    };
    std::string const river = geojson(test::line("[500000,5000000],[500300,5000000]"));
    for (auto const& [file, more, set] : {
             Case{""},
             Case{geojson("")},
             Case{"{not json"},
             Case{geojson(test::feature("Point", "[500000,5000000]"))},
             Case{river, "layer = \"streams\"\n"},
             Case{geojson(test::line("[500000,5000000,9],[500050,5000000,12],[500100,5000000,60],[500200,5000000,1]")),
                  "orientation = \"as_drawn\"\n"},
             Case{geojson(test::line("[500000,5000000],[500100,5000000]") + "," +
                          test::line("[500100,5000000],[500100,5000100]") + "," +
                          test::line("[500100,5000100],[500000,5000000]"))},
             Case{river, "", " --set grid.width=10 --set grid.height=10"},
             Case{river, "", " --set network.heights=file"},
             Case{river, "", " --set grid.crs=EPSG:4258"},
         }) {
        place.write("rivers.geojson", file);
        place.write("r.toml", lines_recipe("rivers.geojson", more));
        expect_refused(place, "make r.toml -o out", {set});
    }
    place.write("r.toml", lines_recipe("missing.gpkg"));
    expect_refused(place, "make r.toml -o out", {""});
}

} // namespace bad_input_test
