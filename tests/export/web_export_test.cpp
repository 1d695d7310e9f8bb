// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/web_export.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/network/order/order.hpp>

namespace web_export_test {

using namespace thalweg;
using namespace thalweg::report;
using namespace thalweg::exports;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

Scene valley(std::string const& crs) {
    Grid grid = test::frame(80, 60, 30.0);
    grid.west = 500000.0;
    grid.north = 4400000.0;
    grid.crs = crs;
    Scene scene;
    scene.title = "A </script> valley";
    scene.dem = Raster<float>(grid);
    for (std::int64_t i = 0; i < scene.dem->cells(); ++i) {
        (*scene.dem)[i] = 100.0F + static_cast<float>(grid.at(i).row);
    }
    NetworkDraft draft;
    NodeId const upper = draft.add_node(grid.centre({40, 50}));
    NodeId const lower = draft.add_node(grid.centre({40, 5}));
    draft.add_arc(upper, lower);
    StreamNetwork net(draft);
    scene.network = ElevatedNetwork{net, {150.0, 105.0}, {{150.0, 105.0}}};
    scene.orders = network::order(net);
    return scene;
}

WebExport exported(Scene const& scene, std::string const& folder, WebExportParams const& params = {}) {
    io::OutputFolder out(folder);
    WebExport made = write_web(scene, params, out, {});
    EXPECT_EQ(out.files(), made.files);
    out.commit();
    return made;
}

nlohmann::json data_of(std::string const& page) {
    std::string const begin = R"(id="data">)";
    std::size_t const from = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

} // namespace

TEST(WebExport, PagesAndRiversSayWhatTheTilesAre) {
    ScratchFolder const folder;
    WebExport const made = exported(valley("EPSG:32616"), folder / "web", {.exaggeration = 2.0});
    EXPECT_TRUE(made.findings.empty());
    EXPECT_EQ(made.min_m, 100.0);
    EXPECT_EQ(made.max_m, 159.0);
    EXPECT_EQ(static_cast<std::int64_t>(made.files.size()), made.tiles + 3);
    nlohmann::json const index = data_of(test::bytes_of(folder / "web/index.html"));
    EXPECT_EQ(index["title"], "A </script> valley");
    EXPECT_EQ(index["rivers"], "rivers.geojson");
    EXPECT_TRUE(index["tiles"].is_null());
    EXPECT_EQ(index["max_zoom"], made.max_zoom);
    EXPECT_EQ(index["exaggeration"], 2.0);
    nlohmann::json const inside = data_of(test::bytes_of(folder / "web/terrain.html"));
    EXPECT_EQ(static_cast<std::int64_t>(inside["tiles"].size()), made.tiles);
    nlohmann::json const rivers = nlohmann::json::parse(test::bytes_of(folder / "web/rivers.geojson"));
    EXPECT_EQ(inside["rivers"], rivers);
    ASSERT_EQ(rivers["features"].size(), 1U);
    EXPECT_EQ(rivers["features"][0]["properties"]["strahler"], 1);
    auto const& mouth = rivers["features"][0]["geometry"]["coordinates"][1];
    EXPECT_NEAR(mouth[0].get<double>(), -86.9858, 1e-3);
    EXPECT_NEAR(mouth[1].get<double>(), 39.7475, 1e-3);
    EXPECT_LT(made.bounds.west, mouth[0].get<double>());
    EXPECT_GT(made.bounds.north, mouth[1].get<double>());
}

TEST(WebExport, HolesAndAMissingCrsAreSaid) {
    ScratchFolder const folder;
    Scene scene = valley("");
    (*scene.dem)[17] = none;
    scene.network.reset();
    scene.orders = {};
    WebExport const made = exported(scene, folder / "web");
    ASSERT_EQ(made.findings.size(), 2U);
    EXPECT_TRUE(test::has(made.findings[0].text, "1 of 4800 cells have no data"));
    EXPECT_TRUE(test::has(made.findings[1].text, "no CRS"));
    EXPECT_EQ(made.holes, 1);
    EXPECT_NEAR(made.bounds.west, -made.bounds.east, 1e-6);
    EXPECT_TRUE(data_of(test::bytes_of(folder / "web/index.html"))["rivers"].is_null());
    EXPECT_EQ(std::ranges::count(made.files, "rivers.geojson"), 0);
    scene.sea = Sea{-3.0, true};
    WebExport const sea = exported(scene, folder / "sea");
    EXPECT_EQ(sea.min_m, -3.0);
    EXPECT_TRUE(test::has(sea.findings[0].text, "the sea, 1 of 4800 cells, lies level at -3 m"));
}

TEST(WebExport, APageThatBecomesTooLargeLosesItsDeepestLevels) {
    ScratchFolder const folder;
    WebExport const made = exported(valley("EPSG:32616"), folder / "web", {.most_bytes = 1});
    EXPECT_EQ(made.page_max_zoom, made.min_zoom);
    EXPECT_LT(made.page_max_zoom, made.max_zoom);
    EXPECT_TRUE(test::has(made.findings.back().text, "terrain.html ends at zoom level"));
}

TEST(WebExport, WithoutHeightsThereIsNone) {
    ScratchFolder const folder;
    io::OutputFolder const out(folder / "web");
    EXPECT_THROW(write_web({}, {}, out, {}), BadInput);
    Scene scene = valley("");
    EXPECT_THROW(write_web(scene, {.exaggeration = 0.0}, out, {}), BadParameter);
    std::ranges::fill(scene.dem->values(), none);
    EXPECT_THROW(write_web(scene, {}, out, {}), BadInput);
}

} // namespace web_export_test
