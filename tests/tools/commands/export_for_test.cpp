// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace export_for_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Numbers of a raw file.
template <class T> std::vector<T> raw_numbers(fs::path const& path) {
    std::string const bytes = file_bytes(path);
    std::vector<T> out(bytes.size() / sizeof(T));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
    return out;
}

/// Samples of a picture, as GDAL's program reads them.
std::vector<std::uint16_t> samples_in(Workplace const& place, std::string const& picture) {
    place.shell("gdal_translate -q -of ENVI -ot UInt16 " + picture + " picture.raw");
    return raw_numbers<std::uint16_t>(place / "picture.raw");
}

/// A plane of 65 x 65 cells that rises to the east by half a metre a metre.
void write_plane(Workplace const& place) {
    std::string rows;
    for (int row = 0; row < 65; ++row) {
        for (int col = 0; col < 65; ++col) {
            rows += std::to_string(5 * col) + " ";
        }
        rows += "\n";
    }
    place.write("plane.asc", "ncols 65\nnrows 65\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\n" + rows);
}

json const& mask_in(json const& description, std::string const& name) {
    for (json const& mask : description["masks"]) {
        if (mask["name"] == name) {
            return mask;
        }
    }
    static json const none;
    ADD_FAILURE() << "no mask " << name;
    return none;
}

} // namespace

TEST(ExportFor, SizesAreThoseThatTheProgramTakes) {
    Workplace const place;
    write_plane(place);
    for (auto const& [preset, side] : {std::pair{"unreal", 127}, {"unity", 65}, {"godot", 513}, {"blender", 65}}) {
        auto const made =
            expect_run(place, std::string("export plane.asc --masks none --json -o ") + preset + " --for " + preset, 0)
                .json();
        EXPECT_EQ(made["width"], side) << preset;
        EXPECT_EQ(made["height"], side) << preset;
        EXPECT_EQ(json::parse(file_bytes(place / preset / "export.json"))["files"].size(), made["files"].size());
        for (std::string const file : made["files"]) {
            EXPECT_TRUE(fs::exists(place / file)) << file;
        }
    }
    auto const wide =
        expect_run(place, "export plane.asc --for unreal --size 253x505 --masks none -o w --json", 0).json();
    EXPECT_EQ(wide["step_m"], (json{640.0 / 252.0, 640.0 / 504.0}));
    EXPECT_NEAR(wide["import"]["scale"][0].get<double>(), 64000.0 / 252.0, 1e-9);
}

TEST(ExportFor, HeightsAreWithinHalfAStepAndRowsAsTheProgramReadsThem) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    expect_run(place, "export land -o exact.r32 --size 505x379", 0);
    auto const exact = raw_numbers<float>(place / "exact.r32");
    auto const unreal = expect_run(place, "export land --for unreal --size 505x379 -o u --masks none --json", 0).json();
    auto const numbers = samples_in(place, "u/height.png");
    ASSERT_EQ(numbers.size(), exact.size());
    double const step = unreal["metres_per_step"];
    double const lowest = unreal["min_m"];
    for (std::size_t i = 0; i < exact.size(); ++i) {
        ASSERT_NEAR(lowest + numbers[i] * step, exact[i], 0.5001 * step) << i;
    }
    // In an engine the middle number lies at the location, and 128 numbers are a metre at a scale of 100.
    double const top = unreal["import"]["location_cm"][2].get<double>() / 100.0 +
                       (65535.0 - 32768.0) / 128.0 * unreal["import"]["scale"][2].get<double>() / 100.0;
    EXPECT_NEAR(top, unreal["max_m"].get<double>(), 1e-6);

    expect_run(place, "export land -o square.r32 --size 65x49", 0);
    auto const unity = expect_run(place, "export land --for unity --size 65 -o y --masks none --json", 0).json();
    auto const rows = raw_numbers<std::uint16_t>(place / "y/height.raw");
    auto const square = raw_numbers<float>(place / "square.r32");
    ASSERT_EQ(rows.size(), 65U * 65);
    for (std::size_t col = 0; col < 65; ++col) { // the first row is the last of the map
        EXPECT_NEAR(unity["min_m"].get<double>() + rows[col] * unity["metres_per_step"].get<double>(),
                    square[48 * 65 + col], 0.5001 * unity["metres_per_step"].get<double>());
    }
}

TEST(ExportFor, TilesShareTheirEdges) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const made =
        expect_run(place, "export land --for unity --tiles 2x3 --size 33 -o t --masks slope --json", 0).json();
    EXPECT_EQ(made["width"], 65);
    EXPECT_EQ(made["height"], 97);
    EXPECT_EQ(made["heights"]["files"].size(), 6U);
    expect_run(place, "export land --for unity --tiles 2x3 --size 33 -o again --masks slope --threads 3", 0);
    for (int y = 0; y < 3; ++y) {
        auto const tile = [&](int x, int row) {
            return raw_numbers<std::uint16_t>(place /
                                              ("t/height_x" + std::to_string(x) + "_y" + std::to_string(row) + ".raw"));
        };
        auto const west = tile(0, y);
        auto const east = tile(1, y);
        ASSERT_EQ(west.size(), 33U * 33);
        for (std::size_t row = 0; row < 33; ++row) {
            EXPECT_EQ(west[33 * row + 32], east[33 * row]);
        }
        if (y > 0) { // rows from the south: the last is the northern edge
            auto const north = tile(0, y - 1);
            EXPECT_TRUE(std::equal(north.begin(), north.begin() + 33, west.end() - 33));
        }
    }
    auto const slope_west = samples_in(place, "t/masks/slope_x0_y0.png");
    auto const slope_east = samples_in(place, "t/masks/slope_x1_y0.png");
    for (std::size_t row = 0; row < 33; ++row) {
        EXPECT_EQ(slope_west[33 * row + 32], slope_east[33 * row]);
    }
    for (std::string const file : made["files"]) {
        EXPECT_EQ(file_bytes(place / file), file_bytes(place / ("again" + file.substr(1)))) << file;
    }
}

TEST(ExportFor, MasksSayWhatTheyMean) {
    Workplace const place;
    write_plane(place);
    auto const plane = expect_run(place, "export plane.asc --for blender --mask-bits 16 -o p --json", 0,
                                  "there are no rivers: no mask river_width")
                           .json();
    double const slope = std::atan(0.5) * 180.0 / std::acos(-1.0);
    auto const slopes = samples_in(place, "p/masks/slope.png");
    EXPECT_NEAR(slopes[65 * 30 + 30] / 65535.0 * mask_in(plane, "slope")["white"].get<double>(), slope, 0.002);
    auto const bends = samples_in(place, "p/masks/curvature.png");
    for (std::size_t const place_in : {65 * 30 + 30, 0, 64, 65 * 64 + 7}) { // the rim too
        EXPECT_LE(std::abs(bends[place_in] - 32768), 1) << "a plane is in the middle";
        EXPECT_EQ(slopes[place_in], slopes[65 * 30 + 30]);
    }
    auto const flow = samples_in(place, "p/masks/flow.png");
    EXPECT_EQ(flow[65 * 30 + 64], 0) << "nothing flows to the highest column";
    double const black = mask_in(plane, "flow")["black"];
    double const white = mask_in(plane, "flow")["white"];
    EXPECT_NEAR(black * std::pow(white / black, flow[65 * 30 + 25] / 65535.0), 40 * 100.0, 1.0);
    auto const ridge = samples_in(place, "p/masks/ridge.png");
    EXPECT_EQ(ridge[65 * 30 + 0], 0);
    EXPECT_EQ(ridge[65 * 30 + 64], 65535);
    EXPECT_EQ(mask_in(plane, "land_cover")["kinds"][0]["name"], "forest");

    expect_run(place, small + "land", 0);
    auto const land = expect_run(place, "export land --for unreal --size 253x190 -o l --json", 0).json();
    auto const away = samples_in(place, "l/masks/river_distance.png");
    auto const width = samples_in(place, "l/masks/river_width.png");
    EXPECT_EQ(*std::ranges::max_element(away), 255);
    EXPECT_EQ(*std::ranges::max_element(width), 255);
    std::vector<int> sum(away.size(), 0);
    auto const numbers = samples_in(place, "l/masks/land_cover.png");
    for (json const& kind : mask_in(land, "land_cover")["kinds"]) {
        auto const weights = samples_in(place, "l/" + kind["weights"][0].get<std::string>());
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += weights[i];
            if (weights[i] > 140) {
                EXPECT_EQ(numbers[i], kind["number"]);
            }
        }
    }
    EXPECT_GE(*std::ranges::min_element(sum), 250);
    EXPECT_LE(*std::ranges::max_element(sum), 260);
}

TEST(ExportFor, RiversGrowDownstreamAndLieOnTheHeightmap) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const made =
        expect_run(place, "export land --for unreal --size 253x190 --runoff 600 -o u --masks none --json", 0).json();
    auto const rivers = json::parse(file_bytes(place / "u/rivers.json"));
    auto const numbers = samples_in(place, "u/height.png");
    ASSERT_EQ(rivers["rivers"].size(), made["rivers"]["rivers"]);
    EXPECT_EQ(rivers["runoff_mm"], 600.0);
    double worst = 0.0;
    for (json const& river : rivers["rivers"]) {
        double before = 0.0;
        for (json const& point : river["points"]) {
            EXPECT_GE(point[4].get<double>(), before);
            before = point[4];
            EXPECT_NEAR(point[3].get<double>(), 7.2 * std::sqrt(before), 0.01);
            double const col = point[0].get<double>() / made["import"]["scale"][0].get<double>();
            double const row = point[1].get<double>() / made["import"]["scale"][1].get<double>();
            if (col >= 0 && row >= 0 && col <= 252 && row <= 189) {
                auto const i = static_cast<std::size_t>(std::lround(row) * 253 + std::lround(col));
                double const z = made["min_m"].get<double>() + numbers[i] * made["metres_per_step"].get<double>();
                worst = std::max(worst, std::abs(z - point[2].get<double>() / 100.0));
            }
        }
        if (river["downstream"] != 0) {
            json const& below = rivers["rivers"][river["downstream"].get<std::size_t>() - 1];
            EXPECT_LE(before, below["points"][0][4].get<double>() + 1e-6);
            EXPECT_EQ(river["points"].back()[0], below["points"][0][0]);
        }
    }
    EXPECT_LT(worst, 0.05 * (made["max_m"].get<double>() - made["min_m"].get<double>()));
}

TEST(ExportFor, MeshAndRiversShareTheirFrame) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const made = expect_run(place, "export land --for godot -o g --masks none --exaggeration 2 --json", 0).json();
    EXPECT_EQ(made["mesh"]["origin"][2], made["min_m"]);
    EXPECT_NEAR(made["import"]["highest"].get<double>(),
                2.0 * (made["max_m"].get<double>() - made["min_m"].get<double>()), 1e-6);
    EXPECT_EQ(made["mesh"]["vertices"], 64 * 48);
    auto const rivers = json::parse(file_bytes(place / "g/rivers.json"));
    for (json const& river : rivers["rivers"]) {
        for (json const& point : river["points"]) {
            EXPECT_LE(std::abs(point[0].get<double>()), 0.51 * made["size_m"][0].get<double>() + 100.0);
            EXPECT_GE(point[1].get<double>(), -0.02 * made["max_m"].get<double>());
        }
    }
    EXPECT_TRUE(file_bytes(place / "g/terrain.glb").starts_with("glTF"));
}

TEST(ExportFor, ThinLinesKeepTheirValueAtAnySize) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    for (std::string const side : {"22x17", "64x48", "127x95"}) {
        expect_run(place,
                   "export land --for blender --size " + side + " --masks flow,river_width,ridge -o x --overwrite", 0);
        for (char const* const mask : {"flow", "river_width", "ridge"}) {
            auto const seen = samples_in(place, std::string("x/masks/") + mask + ".png");
            EXPECT_EQ(*std::ranges::max_element(seen), 255) << mask << " " << side;
        }
    }
}

TEST(ExportFor, FlatTerrainHasARange) {
    Workplace const place;
    place.write("flat.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n7 7 7\n7 7 7\n7 7 7\n");
    auto const made =
        expect_run(place, "export flat.asc --for unity -o f --masks none --json", 0, "the terrain is flat").json();
    EXPECT_EQ(made["import"]["terrain_height"], 1.0);
    EXPECT_EQ(made["import"]["position_of_south_west_tile"][1], 7.0);
}

TEST(ExportFor, PrintersGetMillimetres) {
    Workplace const place;
    write_plane(place);
    auto const made = expect_run(place, "export plane.asc --for print3d --print-size 80 --base 2 -o p --json", 0,
                                 "printed at 1 : 8000, 80.0 x 80.0 x 42.0 mm")
                          .json();
    EXPECT_EQ(made["size_mm"], (json{80.0, 80.0, 42.0}));
    EXPECT_EQ(made["files"], (json{"p/terrain.stl", "p/export.json"}));
    EXPECT_EQ(file_bytes(place / "p/terrain.stl").size(), 84 + 50 * made["triangles"].get<std::size_t>());
    place.write("holes.asc",
                "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n1 2 3\n-9 2 1\n");
    expect_run(place, "export holes.asc --for print3d -o cut", 0, "1 of 6 cells have no data", "largest rectangle");
    expect_refused(place, "export plane.asc --for print3d -o q",
                   {"--print-size 1", "--print-size nan", "--base 0", "--size 65", "--tiles 2", "--masks slope"});
}

TEST(ExportFor, TheWebGetsTilesAndPages) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const made = expect_run(place, "export land --for web -o w --json", 0).json();
    EXPECT_TRUE(file_bytes(place / "w/index.html").starts_with("<!"));
    EXPECT_TRUE(file_bytes(place / "w/terrain.html").starts_with("<!"));
    EXPECT_FALSE(json::parse(file_bytes(place / "w/rivers.geojson"))["features"].empty());
    EXPECT_EQ(made["files"].size(), 4 + made["tiles"].get<std::size_t>());
    expect_run(place, "export land --for web -o w --overwrite", 0);
    expect_run(place, "export land --for print3d -o w --overwrite", 0);
    EXPECT_FALSE(fs::exists(place / "w/heights")) << "empty folders do not stay";
    place.write("trench.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 9\n1 2 3\n-10785 2 1\n");
    expect_run(place, "export trench.asc --for web -o x", 2, "column 0, row 1 is -10785 m", "Terrain-RGB");
    expect_refused(place, "export land --for web -o x", {"--size 65", "--tiles 2", "--masks slope", "--base 3"});
}

TEST(ExportFor, OnlyFilesOfAnEarlierExportAreReplaced) {
    Workplace const place;
    write_plane(place);
    expect_run(place, "export plane.asc --for unreal -o u", 0);
    place.write("u/mine.txt", "mine");
    expect_run(place, "export plane.asc --for unreal -o u --masks none", 2, "u ");
    expect_run(place, "export plane.asc --for unity -o u --masks none --overwrite", 0);
    EXPECT_TRUE(fs::exists(place / "u/mine.txt"));
    EXPECT_FALSE(fs::exists(place / "u/height.png"));
    EXPECT_TRUE(fs::exists(place / "u/height.raw"));
    fs::create_directory(place / "other");
    place.write("other/mine.txt", "mine");
    expect_run(place, "export plane.asc --for unity -o other --overwrite", 2);
}

TEST(ExportFor, NonsenseIsRefusedInWords) {
    Workplace const place;
    write_plane(place);
    std::string const begin = "export plane.asc -o x ";
    expect_run(place, begin + "--for unrael", 2, "no preset is called 'unrael'", "Did you mean 'unreal'?");
    expect_run(place, begin + "--for unreal --size 1000", 2, "1000 samples a side are no size of unreal", "use 1009");
    expect_run(place, begin + "--for unreal --size 128x64", 2, "both of 127 and one");
    expect_run(place, begin + "--for unity --size 1000", 2, "a power of two and one, 33 to 4097", "use 1025");
    expect_run(place, begin + "--for unity --size 513x257", 2, "square tiles: --size 513");
    expect_run(place, begin + "--for godot --size 257", 2, "use 513");
    expect_run(place, begin + "--for unreal --mask-bits 17", 2, "8 or 16 bits, not 17");
    expect_run(place, begin + "--for unreal --format png16", 2, "--format excludes --for");
    expect_run(place, begin + "--for blender --tiles 2", 2, "blender has no option --tiles");
    expect_run(place, begin + "--for unreal --masks slop", 2, "no mask is called 'slop'", "Did you mean 'slope'?");
    expect_run(place, begin + "--for unreal --masks none,slope", 2, "'none' stands alone");
    expect_run(place, begin + "--for unity --tiles 64 --size 4097", 2, "more than 16385 a side");
    expect_run(place, begin + "--for unreal --masks river_width", 2, "there are no rivers");
    expect_refused(place, begin + "--for unreal",
                   {"--tiles 0", "--tiles 65", "--tiles 2x", "--runoff 0", "--runoff nan", "--runoff 1e308",
                    "--tree-line inf", "--base 3", "--exaggeration 2"});
    expect_refused(place, "export plane.asc -o x.png", {"--tiles 2", "--masks slope", "--runoff 300"});
    EXPECT_FALSE(fs::exists(place / "x"));
}

} // namespace export_for_test
