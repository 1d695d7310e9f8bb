// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pipeline/page_decoder.hpp>
#include <unpacked.hpp>

#include <thalweg/pipeline/report/report.hpp>

namespace page_test {

using namespace thalweg;
using namespace thalweg::pipeline;
using nlohmann::json;

namespace {

enum class Land { with, without };

Made small_terrain(Land land) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 90;
    recipe.grid.height = 70;
    recipe.network->dla.particles = 900;
    recipe.network->prune_cells = 4.0;
    recipe.surface->method = Method::dilate;
    recipe.surface->equilibrium.mean_slope_deg.reset();
    recipe.surface->dilate.relief_m = 900.0;
    if (land == Land::without) {
        recipe.surface.reset();
    }
    return make(recipe);
}

json data_of(std::string const& page) {
    return json::parse(page_decoder::part(page, "@@DATA@@"));
}

json row(json const& data, std::string const& name) {
    for (json const& r : data["statistics"]) {
        if (r["name"] == name) {
            return r;
        }
    }
    ADD_FAILURE() << "no figure " << name;
    return {};
}

} // namespace

TEST(Page, HeightsAndLinesAreThoseOfTheTerrain) {
    Made const terrain = small_terrain(Land::with);
    std::string const html = page(terrain, {.contour_interval_m = 25.0, .recipe = "seed = 7\n"});
    for (char const* marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@"}) {
        EXPECT_EQ(html.find(marker), std::string::npos) << marker;
    }
    json const data = data_of(html);
    json const& h = data["heights"];
    EXPECT_EQ(h["width"], terrain.terrain.grid.width);
    EXPECT_EQ(h["cells"], 1);
    auto const z = page_decoder::heights(unpacked(page_decoder::part(html, "@@HEIGHTS@@")), h["width"], h["height"],
                                         h["min"], h["max"]);
    double const half = (h["max"].get<double>() - h["min"].get<double>()) / 65534.0 / 2.0;
    for (std::int64_t i = 0; i < terrain.terrain.grid.cells(); ++i) {
        EXPECT_NEAR(z[static_cast<std::size_t>(i)], terrain.terrain.surface->dem[i], half + 1e-9);
    }

    json const& arcs = data["rivers"]["arcs"];
    auto const lines = page_decoder::lines(unpacked(page_decoder::part(html, "@@LINES@@")),
                                           arcs["n"].get<std::vector<std::int64_t>>());
    ASSERT_EQ(lines.size(), terrain.terrain.rivers.network.plan.arc_count());
    double const step_m = data["rivers"]["step"].get<double>() * terrain.terrain.grid.cell_m;
    for (auto const& [name, column] : arcs.items()) {
        EXPECT_EQ(column.size(), lines.size()) << name;
    }
    for (std::size_t a = 0; a < lines.size(); ++a) {
        Vec2 const from = terrain.terrain.rivers.network.plan.node(terrain.terrain.rivers.network.plan.from(a)).at;
        Vec2 const to = terrain.terrain.rivers.network.plan.node(terrain.terrain.rivers.network.plan.to(a)).at;
        EXPECT_NEAR(terrain.terrain.grid.west + lines[a].front().x * step_m, from.x, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.north - lines[a].front().y * step_m, from.y, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.west + lines[a].back().x * step_m, to.x, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.north - lines[a].back().y * step_m, to.y, step_m / 2.0);
        EXPECT_EQ(arcs["id"][a], a + 1);
        auto const ds = arcs["ds"][a].get<std::size_t>();
        if (ds > 0) {
            EXPECT_EQ(lines[a].back(), lines[ds - 1].front()) << "rivers are not torn apart";
        }
        EXPECT_NEAR(arcs["length"][a].get<double>(), terrain.terrain.rivers.network.plan.length_m(a), 0.001);
        EXPECT_NEAR(arcs["z_up"][a].get<double>(), terrain.terrain.rivers.network.arc_z[a].front(), 0.001);
        EXPECT_EQ(arcs["ds_area"][a], terrain.terrain.areas.ds_area_m2[a]);
        double const persistence = terrain.terrain.rivers.network.plan.arc(a).persistence;
        EXPECT_EQ(arcs["survives"][a].is_null(), std::isinf(persistence));
    }
}

TEST(Page, RidgesFollowTheArcs) {
    Made terrain = small_terrain(Land::without);
    Grid const& grid = terrain.terrain.grid;
    Vec2 const a = grid.centre({3, 4});
    Vec2 const b = grid.centre({40, 9});
    Vec2 const c = grid.centre({41, 60});
    terrain.terrain.ridges.lines = {{{{a.x, a.y, 5.0}, {b.x, b.y, 6.0}, {c.x, c.y, 7.0}}, 1, 2},
                                    {{{c.x, c.y, 7.0}, {a.x, a.y, 5.0}}, 2, 3}};
    std::string const html = page(terrain);
    json const data = data_of(html);
    EXPECT_EQ(data["ridges"], json::parse("{\"n\": [3, 2]}"));
    auto counts = data["rivers"]["arcs"]["n"].get<std::vector<std::int64_t>>();
    std::size_t const arcs = counts.size();
    EXPECT_EQ(arcs, data["rivers"]["arcs"]["id"].size());
    counts.insert(counts.end(), {3, 2});
    auto const lines = page_decoder::lines(unpacked(page_decoder::part(html, "@@LINES@@")), counts);
    // The step is a 16th of a cell: centres lie on whole steps.
    EXPECT_EQ(lines[arcs], (std::vector<Vec2>{{56.0, 72.0}, {648.0, 152.0}, {664.0, 968.0}}));
    EXPECT_EQ(lines[arcs + 1], (std::vector<Vec2>{{664.0, 968.0}, {56.0, 72.0}}));

    terrain.terrain.ridges.lines.clear();
    EXPECT_TRUE(data_of(page(terrain))["ridges"].is_null());
}

TEST(Page, FiguresSayWhatWasAskedAndWhatCame) {
    Made const terrain = small_terrain(Land::with);
    json const data = data_of(page(terrain, {.contour_interval_m = 25.0, .recipe = "seed = 7\n"}));
    EXPECT_EQ(data["version"], version());
    EXPECT_EQ(data["title"], "thalweg, seed 7");
    EXPECT_EQ(data["seed"], 7);
    EXPECT_EQ(data["recipe"], "seed = 7\n");
    EXPECT_EQ(data["contour_m"], 25.0);
    EXPECT_EQ(data["grid"]["crs"], "EPSG:32631");
    EXPECT_TRUE(data["ridges"].is_null());
    EXPECT_TRUE(data["notes"].empty());
    EXPECT_EQ(data["checks"].size(), terrain.assessment.checks.size());
    EXPECT_EQ(data["timings"].size(), timings_of(terrain).size());
    EXPECT_EQ(row(data, "greatest rise above the valley")["asked"], 900.0);
    EXPECT_NEAR(row(data, "greatest rise above the valley")["got"].get<double>(), 900.0, 0.001);
    EXPECT_TRUE(row(data, "mean height")["asked"].is_null());
    EXPECT_NEAR(row(data, "mean height")["got"].get<double>(), terrain.assessment.statistics->mean, 0.001);
    EXPECT_EQ(row(data, "particles of the cluster")["asked"], 900);
    EXPECT_TRUE(row(data, "slope of the main stem")["asked"].is_null());
    double length = 0.0;
    for (json const& l : data["rivers"]["arcs"]["length"]) {
        length += l.get<double>();
    }
    EXPECT_NEAR(row(data, "drainage density")["got"].get<double>(), length / 1000.0 / (90 * 70 * 0.0009), 1e-3);
    EXPECT_EQ(data["laws"]["orders"].size(), terrain.assessment.laws.network->horton.orders.size());
    EXPECT_EQ(data["laws"]["dem_orders"].size(), terrain.assessment.laws.dem->laws.horton.orders.size());
    EXPECT_EQ(data["laws"]["support"]["cells"], terrain.assessment.laws.dem->support_cells);
    EXPECT_EQ(data["hypsometry"]["points"].size(), 101U);
    EXPECT_EQ(data["hypsometry"]["integral"], terrain.assessment.hypsometry->integral);

    Made papers = terrain;
    papers.recipe.surface->dilate.relief_m = 0.0;
    EXPECT_TRUE(row(data_of(page(papers)), "greatest rise above the valley")["asked"].is_null());
}

TEST(Page, TheProfileRunsFromTheSourceOfTheLargestBasinToItsOutlet) {
    Made terrain = small_terrain(Land::with);
    json const profile = data_of(page(terrain))["profile"];
    ASSERT_GE(profile.size(), 2U);
    EXPECT_EQ(profile.back()[0], 0.0);
    for (std::size_t i = 1; i < profile.size(); ++i) {
        EXPECT_LT(profile[i][0], profile[i - 1][0]);
        EXPECT_LE(profile[i][1], profile[i - 1][1]);
    }
    auto const& far = terrain.terrain.rivers.orders.node_dist_out_m;
    EXPECT_NEAR(profile.front()[0].get<double>(), *std::max_element(far.begin(), far.end()), 0.001);

    // Two straight rivers: the one that drains more, though shorter; among equals the first.
    Made two = terrain;
    two.terrain.rivers.network = {};
    two.terrain.rivers.orders = {};
    NetworkDraft plan;
    for (double const length : {100.0, 50.0, 70.0}) {
        auto const source = plan.add_node({two.terrain.grid.west + length, two.terrain.grid.north});
        auto const outlet = plan.add_node({two.terrain.grid.west, two.terrain.grid.north});
        plan.add_arc(source, outlet);
        two.terrain.rivers.network.arc_z.push_back({length, 1.0});
        two.terrain.rivers.orders.node_dist_out_m.insert(two.terrain.rivers.orders.node_dist_out_m.end(),
                                                         {length, 0.0});
    }
    two.terrain.rivers.network.plan = std::move(plan);
    two.terrain.rivers.orders.strahler = {1, 1, 1};
    two.terrain.rivers.orders.hack = {1, 1, 1};
    two.terrain.rivers.orders.shreve = {1, 1, 1};
    two.terrain.rivers.orders.arc_basin = {1, 2, 3};
    two.terrain.areas.us_area_m2 = two.terrain.areas.ds_area_m2 = {1.0, 2.0, 2.0};
    two.terrain.areas.node_m2 = {0.0, 1.0, 0.0, 2.0, 0.0, 2.0};
    EXPECT_EQ(data_of(page(two))["profile"], json::parse("[[50.0, 50.0], [0.0, 1.0]]"));
}

TEST(Page, LongListsAreCut) {
    Made terrain = small_terrain(Land::with);
    terrain.terrain.surface->increments.assign(5000, 2.0);
    terrain.assessment.findings.assign(61, {"uphill", 1, {}, 0.0, "arc 1 runs uphill"});
    terrain.planform.statistics.repairs.clear();
    terrain.terrain.notes.clear();
    json const data = data_of(page(terrain));
    json const& points = data["curve"]["points"];
    EXPECT_EQ(points.size(), 600U);
    EXPECT_EQ(points.front(), json::parse("[1, 2.0, 2.0]"));
    EXPECT_EQ(points.back(), json::parse("[5000, 2.0, 10000.0]"));
    EXPECT_EQ(points[300][2].get<double>(), 2.0 * points[300][0].get<double>()) << "sums count what is left out";
    EXPECT_EQ(data["findings"]["count"], 61);
    EXPECT_EQ(data["findings"]["shown"].size(), 50U);
    EXPECT_EQ(data["repairs"]["count"], 0);
}

TEST(Page, WithoutASurfaceTheRiversAlone) {
    Made const terrain = small_terrain(Land::without);
    std::string const html = page(terrain, {});
    json const data = data_of(html);
    EXPECT_TRUE(data["heights"].is_null());
    EXPECT_TRUE(data["curve"].is_null());
    EXPECT_TRUE(data["hypsometry"].is_null());
    EXPECT_EQ(page_decoder::part(html, "@@HEIGHTS@@"), "");
    EXPECT_FALSE(data["rivers"]["arcs"]["id"].empty());
    EXPECT_FALSE(data["profile"].empty());
    EXPECT_EQ(data["notes"].size(), 1U);
    EXPECT_GT(row(data, "drainage density")["got"], 0.0);
}

TEST(Page, NoTextLeavesItsPlace) {
    Made terrain = small_terrain(Land::with);
    std::string const hostile = "</script><script>alert(1)</script> <!-- \"quoted\" 'it' & @@DATA@@ @@LINES@@ 谷\n";
    terrain.recipe.output.title = hostile + "\xff\xc3";
    terrain.assessment.findings.push_back({"uphill", 1, {}, std::numeric_limits<double>::quiet_NaN(), hostile});
    terrain.assessment.checks.push_back({hostile, std::numeric_limits<double>::quiet_NaN(), 0.0, false});
    std::string const html = page(terrain, {.contour_interval_m = 0.0, .recipe = hostile});
    EXPECT_EQ(html.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page_decoder::part(html, "@@DATA@@").find('<'), std::string::npos);
    EXPECT_EQ(page_decoder::part(html, "@@TITLE@@"),
              "&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &lt;!-- &quot;quoted&quot; &#39;it&#39; &amp; "
              "@@DATA@@ @@LINES@@ 谷\n\xEF\xBF\xBD\xEF\xBF\xBD");
    json const data = data_of(html);
    EXPECT_EQ(data["title"], hostile + "\xEF\xBF\xBD\xEF\xBF\xBD");
    EXPECT_EQ(data["recipe"], hostile);
    EXPECT_EQ(data["findings"]["shown"].back(), hostile);
    EXPECT_TRUE(data["checks"].back()["value"].is_null());
}

TEST(Page, LargeGridsAreShownByMeansAndSaySo) {
    Made terrain = small_terrain(Land::with);
    Grid large = terrain.terrain.grid;
    large.width = 3000;
    large.height = 2000;
    terrain.terrain.grid = large;
    terrain.terrain.surface->dem = Raster<float>(large, 5.0F);
    json const data = data_of(page(terrain));
    EXPECT_EQ(data["heights"]["cells"], 2);
    EXPECT_EQ(data["heights"]["width"], 1500);
    EXPECT_EQ(data["rivers"]["step"], 0.125);
    ASSERT_EQ(data["notes"].size(), 1U);
    EXPECT_EQ(data["notes"][0], "heights are shown as means of 2x2 cells");
}

} // namespace page_test
