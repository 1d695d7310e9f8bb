// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace export_test {

namespace fs = std::filesystem;

namespace {

/// A DEM of 7 x 5 cells that rises to the east.
void write_dem(Workplace const& place, std::string const& corner = "0") {
    std::string rows = corner + " 10 20 30 40 50 60\n";
    for (int row = 1; row < 5; ++row) {
        for (int col = 0; col < 7; ++col) {
            rows += std::to_string(10 * col + row) + " ";
        }
        rows += "\n";
    }
    place.write("dem.asc",
                "ncols 7\nnrows 5\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n" + rows);
}

template <class T> T number_at(std::string const& bytes, std::size_t begin) {
    T number{};
    std::memcpy(&number, bytes.data() + begin, sizeof number);
    return number;
}

/// A GLB, taken apart as the standard says.
struct Glb {
    nlohmann::json json;
    std::string bin;

    explicit Glb(fs::path const& path) {
        std::string const bytes = file_bytes(path);
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 2U);
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
        auto const text = number_at<std::uint32_t>(bytes, 12);
        EXPECT_EQ(text % 4, 0U);
        EXPECT_EQ(bytes.substr(16, 4), "JSON");
        json = nlohmann::json::parse(bytes.substr(20, text));
        auto const size = number_at<std::uint32_t>(bytes, 20 + text);
        EXPECT_EQ(bytes.substr(24 + text, 4), std::string("BIN\0", 4));
        bin = bytes.substr(28 + text);
        EXPECT_EQ(bin.size(), size);
        EXPECT_EQ(json["buffers"][0]["byteLength"], size);
    }

    /// The bytes of a view, inside the buffer.
    std::string view(std::size_t number) const {
        auto const& view = json["bufferViews"][number];
        std::size_t const begin = view["byteOffset"];
        std::size_t const size = view["byteLength"];
        EXPECT_LE(begin + size, bin.size());
        EXPECT_EQ(begin % 4, 0U);
        return bin.substr(begin, size);
    }
    /// The numbers of an accessor.
    template <class T> std::vector<T> numbers(std::size_t number) const {
        auto const& accessor = json["accessors"][number];
        static std::map<std::string, std::size_t> const parts{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}};
        std::string const bytes = view(accessor["bufferView"]);
        std::vector<T> numbers(accessor["count"].get<std::size_t>() * parts.at(accessor["type"]));
        EXPECT_EQ(bytes.size(), numbers.size() * sizeof(T));
        EXPECT_EQ(accessor["componentType"], (std::is_same_v<T, float> ? 5126 : 5125));
        std::memcpy(numbers.data(), bytes.data(), std::min(bytes.size(), numbers.size() * sizeof(T)));
        return numbers;
    }
    std::vector<float> positions(nlohmann::json const& primitive) const {
        std::size_t const number = primitive["attributes"]["POSITION"];
        std::vector<float> found = numbers<float>(number);
        for (std::size_t k = 0; k < 3; ++k) {
            float low = found[k];
            float high = found[k];
            for (std::size_t i = k; i < found.size(); i += 3) {
                low = std::min(low, found[i]);
                high = std::max(high, found[i]);
            }
            EXPECT_EQ(json["accessors"][number]["min"][k].get<float>(), low);
            EXPECT_EQ(json["accessors"][number]["max"][k].get<float>(), high);
        }
        return found;
    }
};

using Place = std::array<float, 3>;

/// The triangles of a binary STL.
std::vector<std::array<Place, 3>> triangles_of(fs::path const& path) {
    std::string const bytes = file_bytes(path);
    std::vector<std::array<Place, 3>> found(number_at<std::uint32_t>(bytes, 80));
    EXPECT_EQ(bytes.size(), 84 + 50 * found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        std::memcpy(&found[i], bytes.data() + 84 + 50 * i + 12, sizeof found[i]);
    }
    return found;
}

} // namespace

TEST(Export, HeightmapsSayWhatTheirNumbersMean) {
    Workplace const place;
    write_dem(place);
    auto const json = expect_run(place, "export dem.asc -o a.r16 --json", 0).json();
    EXPECT_EQ(json["format"], "r16");
    EXPECT_EQ(json["width"], 7);
    EXPECT_EQ(json["height"], 5);
    EXPECT_EQ(json["min_m"], 0.0);
    EXPECT_EQ(json["max_m"], 64.0);
    EXPECT_EQ(json["step_m"], (nlohmann::json{10.0, 10.0}));
    EXPECT_EQ(json["size_m"], (nlohmann::json{60.0, 40.0}));
    EXPECT_EQ(json["north_west"], (nlohmann::json{500005.0, 4000045.0}));
    EXPECT_EQ(json["files"], (nlohmann::json{"a.r16", "a.r16.json"}));
    auto const beside = nlohmann::json::parse(file_bytes(place / "a.r16.json"));
    EXPECT_EQ(beside["metres_per_step"], json["metres_per_step"]);
    EXPECT_EQ(beside["byte_order"], "little-endian");
    std::string const raw = file_bytes(place / "a.r16");
    ASSERT_EQ(raw.size(), 70U);
    for (std::size_t i = 0; i < 35; ++i) {
        double const z = 10.0 * static_cast<double>(i % 7) + static_cast<double>(i / 7);
        EXPECT_NEAR(number_at<std::uint16_t>(raw, 2 * i) * json["metres_per_step"].get<double>(), z, 64.0 / 131070.0);
    }
    expect_run(place, "export dem.asc -o A.RAW", 0);
    EXPECT_EQ(file_bytes(place / "A.RAW"), raw);
    Outcome const named = expect_run(place, "export dem.asc -o heights.bin --format r32", 0);
    EXPECT_EQ(named.out, "heights.bin\nheights.bin.json\n");
    EXPECT_EQ(number_at<float>(file_bytes(place / "heights.bin"), 4 * 34), 64.0F);
}

TEST(Export, SizesKeepTheShapeAndTheCorners) {
    Workplace const place;
    write_dem(place);
    auto const json = expect_run(place, "export dem.asc -o a.r32 --size 13x9 --json", 0).json();
    EXPECT_EQ(json["step_m"], (nlohmann::json{5.0, 5.0}));
    EXPECT_EQ(json["north_west"], (nlohmann::json{500005.0, 4000045.0}));
    std::string const raw = file_bytes(place / "a.r32");
    ASSERT_EQ(raw.size(), 4U * 13 * 9);
    EXPECT_EQ(number_at<float>(raw, 4 * 12), 60.0F);
    EXPECT_EQ(number_at<float>(raw, 4 * 1), 5.0F);
    expect_run(place, "export dem.asc -o b.r32 --size 13", 2, "use --size 13x9");
    expect_refused(place, "export dem.asc -o b.r32 --size",
                   {"1", "0x0", "-5", "16386", "x", "13x", "x9", "13x9x2", "1e2", "12.5", "99999999999999999999"});
    expect_refused(place, "export dem.asc -o b.glb --size", {"1x1", "4099x2733"});
}

TEST(Export, RimsAreCutOrFilledAsAsked) {
    Workplace const place;
    write_dem(place, "-9999");
    auto const json = expect_run(place, "export dem.asc -o a.r32 --json", 0, "1 of 35 cells have no data",
                                 "largest rectangle", "6 x 5 of 7 x 5 cells from column 1, row 0")
                          .json();
    EXPECT_EQ(json["cells_without_data"], 1);
    EXPECT_EQ(json["rim"], (nlohmann::json{{"closed_by", "cut"}, {"cells", 1}}));
    EXPECT_EQ(json["width"], 6);
    EXPECT_EQ(json["north_west"], (nlohmann::json{500015.0, 4000045.0}));
    EXPECT_EQ(number_at<float>(file_bytes(place / "a.r32"), 0), 10.0F);
    expect_run(place, "export dem.asc -o near.r32 --rim nearest", 0, "nearest cell");
    EXPECT_EQ(number_at<float>(file_bytes(place / "near.r32"), 0), 10.0F);
    EXPECT_EQ(file_bytes(place / "near.r32").size(), 4U * 35);
    expect_run(place, "export dem.asc -o low.r32 --rim minimum", 0, "lowest height");
    EXPECT_EQ(number_at<float>(file_bytes(place / "low.r32"), 0), 1.0F);
    auto const sea = expect_run(place, "export dem.asc -o sea.r32 --rim sea --sea-level -2 --json", 0).json();
    EXPECT_EQ(number_at<float>(file_bytes(place / "sea.r32"), 0), -2.0F);
    EXPECT_EQ(sea["sea_level_m"], -2.0);
    auto const mesh = expect_run(place, "export dem.asc -o a.glb --json", 0, "the mesh has holes").json();
    EXPECT_EQ(mesh["vertices"], 34);
    EXPECT_EQ(mesh["triangles"], 47);
    auto const cut = expect_run(place, "export dem.asc -o cut.glb --rim cut --json", 0).json();
    EXPECT_EQ(cut["vertices"], 30);
    EXPECT_EQ(expect_run(place, "export dem.asc -o a.stl --json", 0).json()["width"], 6);
    expect_run(place, "export dem.asc --for print3d -o print", 0, "largest rectangle");
    expect_refused(place, "export dem.asc -o b.r32", {"--rim sea", "--rim neares", "--holes cut", "--sea-level nan"});
}

TEST(Export, HolesAreLevelAtTheirLowestShore) {
    Workplace const place;
    std::string rows;
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 7; ++col) {
            rows += row > 0 && row < 4 && col > 2 && col < 5 ? "-9999 " : std::to_string(100 + 10 * col + row) + " ";
        }
        rows += "\n";
    }
    place.write("dem.asc",
                "ncols 7\nnrows 5\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n" + rows);
    auto const height = [&](std::string const& file) { return number_at<float>(file_bytes(place / file), 4 * 17); };
    auto const json = expect_run(place, "export dem.asc -o a.r32 --json", 0, "6 of 35 cells", "in 1 gap that").json();
    EXPECT_EQ(json["holes"]["levels_m"], (nlohmann::json{120.0, 120.0}));
    EXPECT_EQ(height("a.r32"), 120.0F);
    expect_run(place, "export dem.asc -o near.r32 --holes nearest", 0);
    EXPECT_EQ(height("near.r32"), 122.0F);
    expect_run(place, "export dem.asc -o low.r32 --holes minimum", 0);
    EXPECT_EQ(height("low.r32"), 100.0F);
    EXPECT_EQ(expect_run(place, "export dem.asc -o open.obj --json", 0).json()["cells_without_data"], 6);
    EXPECT_EQ(expect_run(place, "export dem.asc -o shut.obj --holes shore --json", 0).json()["vertices"], 35);
}

TEST(Export, GlbHasTerrainTextureAndRivers) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    auto const json = expect_run(place, "export land -o land.glb --exaggeration 2 --json --threads 1", 0).json();
    Glb const file(place / "land.glb");
    EXPECT_EQ(file.json["asset"]["version"], "2.0");
    EXPECT_EQ(file.json["scenes"][0]["extras"]["crs"], "EPSG:32631");
    EXPECT_EQ(json["river_lines"].get<int>() > 0, true);
    auto const& terrain = file.json["meshes"][0]["primitives"][0];
    auto const positions = file.positions(terrain);
    ASSERT_EQ(positions.size(), 3U * 64 * 48);
    auto const [low, high] = std::pair{json["min_m"].get<double>(), json["max_m"].get<double>()};
    auto const& limits = file.json["accessors"][terrain["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(limits["min"][1], 0.0);
    EXPECT_NEAR(limits["max"][1].get<double>(), 2.0 * (high - low), 1e-3);
    EXPECT_EQ(limits["min"][0].get<double>(), -limits["max"][0].get<double>());
    EXPECT_LT(positions[2], 0.0F); // north is -z
    auto const normals = file.numbers<float>(terrain["attributes"]["NORMAL"]);
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        EXPECT_NEAR(
            std::sqrt(normals[i] * normals[i] + normals[i + 1] * normals[i + 1] + normals[i + 2] * normals[i + 2]), 1.0,
            1e-5);
        EXPECT_GT(normals[i + 1], 0.0F);
    }
    auto const places = file.numbers<float>(terrain["attributes"]["TEXCOORD_0"]);
    EXPECT_EQ((std::vector<float>{places[0], places[1], places[places.size() - 2], places.back()}),
              (std::vector<float>{0.0F, 0.0F, 1.0F, 1.0F}));
    auto const indices = file.numbers<std::uint32_t>(terrain["indices"]);
    EXPECT_EQ(indices.size(), 6U * 63 * 47);
    EXPECT_LT(*std::max_element(indices.begin(), indices.end()), 64U * 48);
    auto const& rivers = file.json["meshes"][1]["primitives"][0];
    EXPECT_EQ(rivers["mode"], 1);
    auto const on_rivers = file.positions(rivers);
    auto const ends = file.numbers<std::uint32_t>(rivers["indices"]);
    EXPECT_EQ(ends.size() % 2, 0U);
    EXPECT_LT(*std::max_element(ends.begin(), ends.end()), on_rivers.size() / 3);
    std::string const texture = file.view(file.json["images"][0]["bufferView"]);
    EXPECT_EQ(texture.substr(1, 3), "PNG");
    EXPECT_EQ(static_cast<unsigned char>(texture[18]), 2048 / 256); // its width, big-endian

    expect_run(place, "export land -o again.glb --exaggeration 2 --threads 3", 0);
    EXPECT_EQ(file_bytes(place / "again.glb"), file_bytes(place / "land.glb"));
}

TEST(Export, StlIsClosedAndObjHasItsCompanions) {
    Workplace const place;
    write_dem(place);
    auto const json = expect_run(place, "export dem.asc -o a.stl --base 5 --json", 0).json();
    EXPECT_EQ(json["base_m"], 5.0);
    EXPECT_EQ(expect_run(place, "export dem.asc -o coarse.stl --size 4x3 --json", 0).json()["base_m"], 10.0);
    std::map<std::pair<Place, Place>, int> edges;
    double volume = 0.0;
    for (auto const& t : triangles_of(place / "a.stl")) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{t[k], t[(k + 1) % 3]}];
        }
        auto const& [a, b, c] = t;
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6.0;
    }
    for (auto const& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
    EXPECT_NEAR(volume, 60.0 * 40.0 * (32.0 + 5.0), 1.0); // a plane, 32 m high in the middle

    Outcome const obj = expect_run(place, "export dem.asc -o out/a.obj", 0);
    EXPECT_EQ(obj.out, "out/a.obj\nout/a.mtl\nout/a_texture.png\nout/a.obj.json\n");
    EXPECT_TRUE(test::has(file_bytes(place / "out/a.mtl"), "newmtl ground", "map_Kd a_texture.png"));
    EXPECT_TRUE(test::has(file_bytes(place / "out/a.obj"), "mtllib a.mtl", "\nvt 0 1\n"));
}

TEST(Export, TheSeaIsLevel) {
    Workplace const place;
    expect_run(place,
               "make " + samples +
                   "island.toml --set grid.width=96 --set grid.height=96 --set network.prune=8 "
                   "--set network.forest.spacing=8 -q -o island",
               0);
    auto const json = expect_run(place, "export island -o island.stl --json", 0, "the sea").json();
    EXPECT_GT(json["cells_without_data"], 0);
    EXPECT_EQ(json["without_data_m"], 0.0);
    EXPECT_EQ(json["width"], 96);
}

TEST(Export, NothingIsOverwrittenUnasked) {
    Workplace const place;
    write_dem(place);
    place.write("a.mtl", "mine");
    expect_run(place, "export dem.asc -o a.obj", 2, "a.mtl already exists");
    EXPECT_FALSE(fs::exists(place / "a.obj"));
    expect_run(place, "export dem.asc -o a.obj --overwrite", 0);
    EXPECT_TRUE(test::has(file_bytes(place / "a.mtl"), "newmtl"));
}

TEST(Export, BadInputIsRefused) {
    Workplace const place;
    write_dem(place);
    place.write("row.asc", "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
    fs::create_directory(place / "empty");
    expect_run(place, "export dem.asc -o a.png --format png17", 2, "unknown format 'png17'", "Did you mean 'png16'?");
    expect_run(place, "export dem.asc -o a.tif", 2, "does not tell the format");
    expect_refused(place, "export", {"", "dem.asc", "-o a.png", "dem.asc -o empty --format glb", "dem.asc -o ''"});
    expect_refused(place, "export -o a.stl",
                   {"nowhere.tif", "row.asc", "empty", "dem.asc --base 0", "dem.asc --base -3", "dem.asc --base nan",
                    "dem.asc --base thick", "dem.asc --exaggeration 0", "dem.asc --exaggeration -1",
                    "dem.asc --exaggeration inf"});
    expect_refused(place, "export dem.asc -o a.png", {"--exaggeration 2", "--base 5"});
    expect_refused(place, "export dem.asc -o a.glb", {"--base 5"});
}

} // namespace export_test
