// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/live_page.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>
#include <unpacked.hpp>

#include <thalweg/report/report.hpp>

namespace live_page_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;

namespace {

using nlohmann::json;

std::string const cluster = "[grid]\nwidth = 70\nheight = 60\n[network]\nsource = \"dla\"\nprune = 5\n"
                            "[network.dla]\nparticles = 900\n[surface]\nmethod = \"dilate\"\n";

json scene_of(MakeResult const& made) {
    return json::parse("{" + live_scene(made, "seed = 7\n", "thalweg make x") + "}");
}

} // namespace

TEST(LivePage, IsTheReportsAndMayAskItsOwnServerAlone) {
    LivePage const page = live_page("a <b>", R"({"keys":["</script>"]})");
    EXPECT_TRUE(test::has(page.html, "<title>a &lt;b&gt;</title>", R"({"keys":["\u003c/script>"]})"));
    EXPECT_EQ(page.html.find("@@"), std::string::npos);
    EXPECT_TRUE(test::has(page.html, "connect-src 'self'"));
    EXPECT_EQ(page.html.find("connect-src 'none'"), std::string::npos);
    EXPECT_TRUE(test::has(page.policy, "default-src 'none'", "connect-src 'self'", "script-src 'sha256-",
                          "frame-ancestors 'none'"));
}

TEST(LiveScene, GrowsWithWhatIsKnown) {
    MakeResult const made = make::make(read_recipe(cluster, "r"));
    json const measured = scene_of(made);
    EXPECT_EQ(measured["data"]["recipe"], "seed = 7\n");
    EXPECT_EQ(measured["data"]["command"], "thalweg make x");
    EXPECT_FALSE(measured["data"]["checks"].empty());
    EXPECT_FALSE(measured["lines"].get<std::string>().empty());
    EXPECT_FALSE(measured["water"].get<std::string>().empty());

    MakeResult unmeasured = made;
    unmeasured.assessment = {};
    json const land = scene_of(unmeasured);
    EXPECT_EQ(land["lines"], measured["lines"]);
    EXPECT_EQ(land["water"], measured["water"]);
    EXPECT_EQ(land["data"]["heights"], measured["data"]["heights"]);
    EXPECT_EQ(land["data"]["rivers"], measured["data"]["rivers"]);
    EXPECT_TRUE(land["data"]["checks"].empty());

    json const rivers = scene_of(planform_preview(made.plan.recipe, made.planform));
    EXPECT_TRUE(rivers["data"]["heights"].is_null());
    EXPECT_EQ(rivers["data"]["rivers"]["arcs"]["strahler"], measured["data"]["rivers"]["arcs"]["strahler"]);
    EXPECT_EQ(rivers["lines"], measured["lines"]);
}

TEST(LiveHeights, AreTheDemOrMeansOfIt) {
    Grid const grid = test::frame(40, 30, 5.0);
    Raster<float> dem = test::raster_of(grid, [](Cell c) { return static_cast<float>(c.col * c.row); });
    dem[Cell{3, 3}] = std::numeric_limits<float>::quiet_NaN();
    LiveHeights const exact = *live_heights(dem, grid);
    EXPECT_EQ(exact.cells, 1);
    EXPECT_EQ(exact.nodata, 1);
    EXPECT_EQ(exact.min, 0.0);
    EXPECT_EQ(exact.max, 39.0 * 29.0);
    EXPECT_TRUE(test::same_bits(exact.values, dem));

    Grid wide = test::frame(160, 120, 1.25);
    EXPECT_EQ(live_heights(dem, wide)->cells, 4) << "coarse cells of a larger grid";

    Raster<float> const large =
        test::raster_of(test::frame(2048, 1024), [](Cell c) { return static_cast<float>(c.col); });
    LiveHeights const means = *live_heights(large, large.grid());
    EXPECT_EQ(means.cells, 2);
    EXPECT_EQ(means.values.width(), 1024);
    EXPECT_EQ(means.values[(Cell{3, 0})], 6.5F);

    EXPECT_FALSE(live_heights(test::raster_of(grid, [](Cell) { return std::nanf(""); }), grid));
}

TEST(ClusterArms, AreThoseThatABranchMayBe) {
    Plan const plan = resolve(read_recipe(cluster, "r"));
    ClusterArms const arms = *cluster_arms(plan.recipe, 64);
    EXPECT_EQ(arms.chosen, "largest");
    EXPECT_LE(std::max(arms.width, arms.height), 64);
    auto const places = unpacked(arms.arms);
    ASSERT_EQ(places.size(), static_cast<std::size_t>(arms.width * arms.height));
    std::vector<int> counts(6);
    for (auto const place : places) {
        ASSERT_LE(place, 5);
        ++counts[place];
    }
    EXPECT_GT(counts[0], 0);
    EXPECT_GT(counts[1] + counts[2] + counts[3] + counts[4], counts[5]) << "most of it is in one of the arms";
    EXPECT_FALSE(cluster_arms(resolve(default_recipe_on(64, 64)).recipe, 64)) << "a forest has none";
}

} // namespace live_page_test
