// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/page.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <network/networks.hpp>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>
#include <report/awkward.hpp>
#include <report/page_decoder.hpp>
#include <support.hpp>
#include <unpacked.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/report/report.hpp>

namespace page_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;
using nlohmann::json;

namespace {

enum class Land { with, without };

MakeResult small_terrain(Land land) {
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
    return make::make(recipe);
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

/// Decodes the page's heights and compares each with the mean of its square.
void expect_means(Raster<float> const& dem) {
    auto const page = page_heights(dem);
    ASSERT_TRUE(page.has_value());
    std::int64_t const k = page->cells;
    ASSERT_EQ(page->width, (dem.width() + k - 1) / k);
    ASSERT_EQ(page->height, (dem.height() + k - 1) / k);
    auto const decoded = page_decoder::heights(page->bytes, page->width, page->height, page->min, page->max);
    double const nearest = (page->max - page->min) / 65534.0 / 2.0;
    double const rounding = 1e-12 * (std::fabs(page->max) + std::fabs(page->min));
    std::int64_t nodata = 0;
    for (std::int64_t v = 0; v < page->width * page->height; ++v) {
        double sum = 0.0;
        int count = 0;
        for (std::int64_t r = v / page->width * k; r < (v / page->width + 1) * k && r < dem.height(); ++r) {
            for (std::int64_t c = v % page->width * k; c < (v % page->width + 1) * k && c < dem.width(); ++c) {
                if (!std::isnan(dem[Cell{c, r}])) {
                    sum += static_cast<double>(dem[Cell{c, r}]);
                    ++count;
                }
            }
        }
        double const z = decoded[static_cast<std::size_t>(v)];
        nodata += count == 0;
        ASSERT_EQ(std::isnan(z), count == 0) << v;
        if (count > 0) {
            ASSERT_LE(std::fabs(z - sum / count), nearest + rounding) << v;
        }
    }
    ASSERT_EQ(page->nodata, nodata);
}

using Line = std::vector<Vec2>;

PageLines page_of(std::vector<Line> const& lines, Grid const& grid) {
    std::vector<std::span<Vec2 const>> const spans(lines.begin(), lines.end());
    return page_lines(spans, grid);
}

Grid const grid{100, 80, 30.0, 500000.0, 4000000.0, ""};

/// The direction of a way between whole steps, as short as it can be written.
std::pair<std::int64_t, std::int64_t> heading(Vec2 from, Vec2 to) {
    auto const dx = static_cast<std::int64_t>(to.x - from.x);
    auto const dy = static_cast<std::int64_t>(to.y - from.y);
    std::int64_t const common = std::gcd(dx, dy);
    return {dx / common, dy / common};
}

/// A line's vertices in whole steps without those that turn nothing.
Line turns_of(Line const& line, PageLines const& page, Grid const& frame) {
    Line distinct;
    for (Vec2 const vertex : line) {
        double const step_m = page.step * frame.cell_m;
        Vec2 const whole{std::floor((vertex.x - frame.west) / step_m + 0.5),
                         std::floor((frame.north - vertex.y) / step_m + 0.5)};
        if (distinct.empty() || !(distinct.back() == whole)) {
            distinct.push_back(whole);
        }
    }
    if (distinct.size() == 1) {
        return {distinct[0], distinct[0]};
    }
    Line turns{distinct.front()};
    for (std::size_t i = 1; i + 1 < distinct.size(); ++i) {
        if (heading(distinct[i - 1], distinct[i]) != heading(distinct[i], distinct[i + 1])) {
            turns.push_back(distinct[i]);
        }
    }
    turns.push_back(distinct.back());
    return turns;
}

std::string const bare = "@@TITLE@@@@DATA@@@@HEIGHTS@@@@LINES@@@@WATER@@@@STUDIO@@";

} // namespace

TEST(Page, HeightsAndLinesAreThoseOfTheTerrain) {
    MakeResult const made = small_terrain(Land::with);
    Grid const& grid = made.terrain.grid;
    ElevatedNetwork const& rivers = made.terrain.rivers.network;
    std::string const html = page(made, {.contour_interval_m = 25.0, .recipe = "seed = 7\n"});
    for (char const* marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@", "@@WATER@@", "@@STUDIO@@"}) {
        EXPECT_FALSE(test::has(html, marker));
    }
    json const data = data_of(html);
    json const& h = data["heights"];
    EXPECT_EQ(h["width"], grid.width);
    EXPECT_EQ(h["cells"], 1);
    auto const z = page_decoder::heights(unpacked(page_decoder::part(html, "@@HEIGHTS@@")), h["width"], h["height"],
                                         h["min"], h["max"]);
    double const half = (h["max"].get<double>() - h["min"].get<double>()) / 65534.0 / 2.0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        EXPECT_NEAR(z[static_cast<std::size_t>(i)], made.terrain.ground.dem[i], half + 1e-9);
    }

    auto const water =
        page_decoder::water(unpacked(page_decoder::part(html, "@@WATER@@")), z, grid.width, h["min"], h["max"]);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        flow::Direction const d = made.terrain.water.drainage.direction[i];
        EXPECT_EQ(water.direction[i], flow::goes_on(d) ? static_cast<int>(flow::index_of(d)) + 1 : 0) << i;
        EXPECT_FALSE(water.lake[i]);
    }

    json const& arcs = data["rivers"]["arcs"];
    auto const lines = page_decoder::lines(unpacked(page_decoder::part(html, "@@LINES@@")),
                                           arcs["n"].get<std::vector<std::int64_t>>());
    ASSERT_EQ(lines.size(), rivers.planform.arc_count());
    double const step_m = data["rivers"]["step"].get<double>() * grid.cell_m;
    auto const expect_at = [&](Vec2 steps, NodeId node) {
        EXPECT_NEAR(grid.west + steps.x * step_m, rivers.planform.node(node).at.x, step_m / 2.0);
        EXPECT_NEAR(grid.north - steps.y * step_m, rivers.planform.node(node).at.y, step_m / 2.0);
    };
    for (auto const& [name, column] : arcs.items()) {
        EXPECT_EQ(column.size(), lines.size()) << name;
    }
    for (std::size_t a = 0; a < lines.size(); ++a) {
        expect_at(lines[a].front(), rivers.planform.from(a));
        expect_at(lines[a].back(), rivers.planform.to(a));
        EXPECT_EQ(arcs["id"][a], a + 1);
        auto const ds = arcs["ds"][a].get<std::size_t>();
        EXPECT_TRUE(ds == 0 || lines[a].back() == lines[ds - 1].front()) << "rivers are not torn apart";
        EXPECT_NEAR(arcs["length"][a].get<double>(), rivers.planform.length_m(a), 0.001);
        EXPECT_NEAR(arcs["z_up"][a].get<double>(), rivers.arc_z[a].front(), 0.001);
        EXPECT_EQ(arcs["ds_area"][a], made.terrain.water.areas.ds_area_m2[a]);
        EXPECT_EQ(arcs["survives"][a].is_null(), std::isinf(rivers.planform.arc(a).persistence));
    }
}

TEST(Page, RidgesFollowTheArcs) {
    MakeResult terrain = small_terrain(Land::without);
    EXPECT_TRUE(data_of(page(terrain))["ridges"].is_null());
    auto const at = [&](Cell c, double z) {
        Vec2 const p = terrain.terrain.grid.centre(c);
        return Vec3{p.x, p.y, z};
    };
    terrain.terrain.ground.ridges.lines = {{{at({3, 4}, 5.0), at({40, 9}, 6.0), at({41, 60}, 7.0)}, 1, 2},
                                           {{at({41, 60}, 7.0), at({3, 4}, 5.0)}, 2, 3}};
    std::string const html = page(terrain);
    json const data = data_of(html);
    EXPECT_EQ(data["ridges"], json::parse("{\"n\": [3, 2]}"));
    auto counts = data["rivers"]["arcs"]["n"].get<std::vector<std::int64_t>>();
    std::size_t const arcs = counts.size();
    counts.insert(counts.end(), {3, 2});
    auto const lines = page_decoder::lines(unpacked(page_decoder::part(html, "@@LINES@@")), counts);
    // The step is a 16th of a cell: centres lie on whole steps.
    EXPECT_EQ(lines[arcs], (std::vector<Vec2>{{56.0, 72.0}, {648.0, 152.0}, {664.0, 968.0}}));
    EXPECT_EQ(lines[arcs + 1], (std::vector<Vec2>{{664.0, 968.0}, {56.0, 72.0}}));
}

TEST(Page, MetricsStandBesideTheirTargets) {
    MakeResult const terrain = small_terrain(Land::with);
    json const data = data_of(page(terrain, {.contour_interval_m = 25.0, .recipe = "seed = 7\n"}));
    EXPECT_EQ(data["title"], "thalweg, seed 7");
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
    auto const lengths = data["rivers"]["arcs"]["length"].get<std::vector<double>>();
    double const length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    EXPECT_NEAR(row(data, "drainage density")["got"].get<double>(), length / 1000.0 / (90 * 70 * 0.0009), 1e-3);
    EXPECT_EQ(data["laws"]["orders"].size(), terrain.assessment.laws.network->horton.orders.size());
    EXPECT_EQ(data["laws"]["dem_orders"].size(), terrain.assessment.laws.dem->laws.horton.orders.size());
    EXPECT_EQ(data["laws"]["support"]["cells"], terrain.assessment.laws.dem->support_cells);
    EXPECT_EQ(data["hypsometry"]["points"].size(), 101U);
    EXPECT_EQ(data["hypsometry"]["integral"], terrain.assessment.hypsometry->integral);

    MakeResult papers = terrain;
    papers.recipe.surface->dilate.relief_m = 0.0;
    EXPECT_TRUE(row(data_of(page(papers)), "greatest rise above the valley")["asked"].is_null());
}

TEST(Page, TheProfileIsThatOfTheLongestFlowPath) {
    MakeResult terrain = small_terrain(Land::with);
    json const profile = data_of(page(terrain))["profiles"][0]["points"];
    ASSERT_GE(profile.size(), 2U);
    EXPECT_EQ(profile.back()[0], 0.0);
    for (std::size_t i = 1; i < profile.size(); ++i) {
        EXPECT_LT(profile[i][0], profile[i - 1][0]);
        EXPECT_LE(profile[i][1], profile[i - 1][1]);
    }
    auto const& far = terrain.terrain.rivers.orders.node_dist_out_m;
    EXPECT_NEAR(profile.front()[0].get<double>(), *std::max_element(far.begin(), far.end()), 0.001);

    // Of straight rivers the longest, as in the sections, though others drain more; of equals the first.
    MakeResult two = terrain;
    std::vector<Vec2> nodes;
    std::vector<test::Reach> reaches;
    std::vector<double> z;
    for (double const length : {50.0, 100.0, 100.0}) {
        nodes.push_back({two.terrain.grid.west + length, two.terrain.grid.north});
        nodes.push_back({two.terrain.grid.west, two.terrain.grid.north});
        z.insert(z.end(), {length + static_cast<double>(nodes.size()), 1.0});
        reaches.push_back({nodes.size() - 2, nodes.size() - 1});
    }
    two.terrain.rivers.network = test::elevated(test::network_of(nodes, reaches), z);
    two.terrain.rivers.orders = network::order(two.terrain.rivers.network.planform);
    two.terrain.water.areas.us_area_m2 = two.terrain.water.areas.ds_area_m2 = {2.0, 1.0, 1.0};
    two.terrain.water.areas.node_m2 = {0.0, 2.0, 0.0, 1.0, 0.0, 1.0};
    double const cells = std::floor(100.0 / two.terrain.grid.cell_m * 100.0 + 0.5) / 100.0;
    json const profiles = data_of(page(two))["profiles"];
    ASSERT_EQ(profiles.size(), 3U) << "of each basin one";
    EXPECT_EQ(profiles[0]["points"], (json{{100.0, 104.0, cells, 0.0}, {0.0, 1.0, 0.0, 0.0}}));
    EXPECT_EQ(profiles[1]["points"].front()[0], 100.0);
    EXPECT_EQ(profiles[2]["points"].front()[0], 50.0);
}

TEST(Page, LongListsAreCut) {
    MakeResult terrain = small_terrain(Land::with);
    terrain.terrain.ground.how = make::ByDilation{.increments = std::vector<double>(5000, 2.0)};
    terrain.assessment.findings.assign(61, {"z_rising", 1, nowhere, 0.0, "arc 1 runs uphill"});
    terrain.plan.findings.clear();
    terrain.planform.findings.clear();
    terrain.terrain.notes.findings.clear();
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

TEST(Page, FindingsOfEveryKindAreShownWithTheirPlaces) {
    MakeResult made = small_terrain(Land::with);
    Grid const& grid = made.terrain.grid;
    made.assessment.findings.assign(60, {"depression", 0, grid.centre({3, 4}), 1.0, "one of many"});
    made.assessment.findings.push_back({"crossing", 7, {}, 0.0, "nowhere"});
    made.assessment.findings.push_back({"crossing", 8, {grid.west - 1.0, grid.north}, 0.0, "beyond the grid"});
    made.assessment.findings.push_back({"crossing", 9, {std::nan(""), grid.north}, 0.0, "no number"});
    json const shown = data_of(page(made))["findings"]["shown"];
    ASSERT_EQ(shown.size(), 50U);
    EXPECT_EQ(shown[0], (json{{"kind", "depression"}, {"text", "one of many"}, {"at", {3.5, 4.5}}}));
    EXPECT_EQ(shown[1], (json{{"kind", "crossing"}, {"text", "nowhere"}, {"at", nullptr}}));
    EXPECT_EQ(shown[3], (json{{"kind", "crossing"}, {"text", "beyond the grid"}, {"at", nullptr}}));
    EXPECT_EQ(shown[5], (json{{"kind", "crossing"}, {"text", "no number"}, {"at", nullptr}}));
    EXPECT_EQ(shown[49]["kind"], "depression");
}

TEST(Page, TheLedgerOfGivenRiversBalances) {
    MakeResult made = small_terrain(Land::with);
    EXPECT_TRUE(data_of(page(made))["given"].empty());
    GivenLength given;
    given.read_m = 10'000.0;
    given.closed_m = 500.0;
    given.kept_m = 8'000.0;
    given.left_out_m[static_cast<std::size_t>(LeftOut::duplicate)] = 1'500.0;
    given.left_out_m[static_cast<std::size_t>(LeftOut::coast)] = 1'000.0;
    given.turned_m = 300.0;
    made.assessment.given = given;
    EXPECT_EQ(data_of(page(made))["given"], (json{{"read", 10.0, "km"},
                                                  {"left out: coastlines", 1.0, "km"},
                                                  {"left out: duplicates", 1.5, "km"},
                                                  {"in the network", 8.0, "km"},
                                                  {"added where ends were joined", 0.5, "km"},
                                                  {"reversed", 0.3, "km"}}));
}

TEST(Page, WithoutASurfaceTheRiversAlone) {
    MakeResult const terrain = small_terrain(Land::without);
    std::string const html = page(terrain, {});
    json const data = data_of(html);
    EXPECT_TRUE(data["heights"].is_null());
    EXPECT_TRUE(data["curve"].is_null());
    EXPECT_TRUE(data["hypsometry"].is_null());
    EXPECT_EQ(page_decoder::part(html, "@@HEIGHTS@@"), "");
    EXPECT_FALSE(data["rivers"]["arcs"]["id"].empty());
    EXPECT_FALSE(data["profiles"].empty());
    EXPECT_EQ(data["notes"].size(), 1U);
    EXPECT_GT(row(data, "drainage density")["got"], 0.0);
}

TEST(Page, NoTextLeavesItsPlace) {
    MakeResult terrain = small_terrain(Land::with);
    std::string const hostile = "</script><script>alert(1)</script> <!-- \"quoted\" 'it' & @@DATA@@ @@LINES@@ 谷\n";
    terrain.recipe.output.title = hostile + "\xff\xc3";
    terrain.assessment.findings.push_back({"z_rising", 1, {}, std::numeric_limits<double>::quiet_NaN(), hostile});
    terrain.assessment.checks.push_back({hostile, std::numeric_limits<double>::quiet_NaN(), 0.0, false});
    std::string const html = page(terrain, {.contour_interval_m = 0.0, .recipe = hostile});
    EXPECT_FALSE(test::has(html, "<script>alert"));
    EXPECT_EQ(page_decoder::part(html, "@@DATA@@").find('<'), std::string::npos);
    EXPECT_EQ(page_decoder::part(html, "@@TITLE@@"),
              "&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt; &lt;!-- &quot;quoted&quot; &#39;it&#39; &amp; "
              "@@DATA@@ @@LINES@@ 谷\n\xEF\xBF\xBD\xEF\xBF\xBD");
    json const data = data_of(html);
    EXPECT_EQ(data["title"], hostile + "\xEF\xBF\xBD\xEF\xBF\xBD");
    EXPECT_EQ(data["recipe"], hostile);
    EXPECT_EQ(data["findings"]["shown"].back()["text"], hostile);
    EXPECT_TRUE(data["checks"].back()["value"].is_null());
}

TEST(Page, LargeGridsAreShownByMeansAndSaySo) {
    MakeResult terrain = small_terrain(Land::with);
    Grid large = terrain.terrain.grid;
    large.width = 3000;
    large.height = 2000;
    terrain.terrain.grid = large;
    terrain.terrain.ground.dem = Raster<float>(large, 5.0F);
    json const data = data_of(page(terrain));
    EXPECT_EQ(data["heights"]["cells"], 2);
    EXPECT_EQ(data["heights"]["width"], 1500);
    EXPECT_EQ(data["rivers"]["step"], 0.125);
    ASSERT_EQ(data["notes"].size(), 1U);
    EXPECT_EQ(data["notes"][0], "heights are shown as means of 2x2 cells");
}

TEST(PageHeights, OfOneHeightAndOfNone) {
    EXPECT_FALSE(page_heights(Raster<float>{}).has_value());
    EXPECT_FALSE(page_heights(dem_of(2, {hole, hole, hole, hole})).has_value());
    Raster<float> dem = dem_of(3, std::vector<float>(12, -0.7F));
    dem[4] = hole;
    auto const page = page_heights(dem);
    ASSERT_TRUE(page.has_value());
    auto const decoded = page_decoder::heights(page->bytes, 3, 4, page->min, page->max);
    EXPECT_EQ(std::ranges::count(decoded, static_cast<double>(-0.7F)), 11) << "exactly";
    dem[5] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(test::refused(
        "report.page_heights", [&] { page_heights(dem); }, "column 2, row 1"));
}

TEST(PageHeights, TheSmallestSquaresThatAreFewEnough) {
    EXPECT_EQ(page_cells(frame(1500, 1000)), 1);
    EXPECT_EQ(page_cells(frame(1500, 1001)), 2);
    EXPECT_EQ(page_cells(frame(4096, 1)), 1);
    EXPECT_EQ(page_cells(frame(4097, 1)), 2);
    EXPECT_EQ(page_cells(frame(1, 9000)), 3);
    EXPECT_EQ(page_cells(frame(10000, 10000)), 9);
}

TEST(PageHeights, AnyDem) {
    ASSERT_TRUE(rc::check("every height within half a step of its cell", [] {
        Raster<float> dem = *gen_dem(20, 70);
        dem[dem.cells() / 2] = 3.0F;
        expect_means(dem);
        RC_ASSERT(!testing::Test::HasFatalFailure());
    }));
}

TEST(PageHeights, RoughAndSmoothAndOneRowWithMeans) {
    expect_means(rough_dem(frame(300, 200), 3));
    expect_means(rough_dem(frame(1, 300), 4));
    auto const slope = [](Cell c) { return 1e4F - static_cast<float>(c.col * c.row) * 0.1F; };
    expect_means(test::raster_of(frame(200, 100), slope));
    for (auto const& grid : {frame(1301, 1277), frame(9001, 2), frame(1, 12300)}) {
        Raster<float> dem = rough_dem(grid, 5);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const c = grid.at(i);
            dem[i] = (c.col / 5 + c.row / 3) % 4 == 0 ? hole : dem[i]; // whole squares and parts of them
        }
        expect_means(dem);
    }
}

TEST(PageHeights, APlaneCostsNextToNothing) {
    auto const page = page_heights(test::raster_of(frame(256, 256), [](Cell c) { return c.col + 2 * c.row; }));
    auto const small = std::count_if(page->bytes.begin() + 256, page->bytes.end(), [](auto byte) { return byte <= 4; });
    EXPECT_GT(small, std::ssize(page->bytes) * 98 / 100) << "residuals of a plane are its roundings";
}

TEST(PageLines, RefusesWhatIsNoLineHere) {
    EXPECT_TRUE(page_of({}, grid).vertices.empty());
    EXPECT_EQ(page_of({}, grid).step, 0.0625);
    Vec2 const corner{500000.0, 4000000.0};
    Line const good{corner, {500001.0, 4000000.0}};
    for (auto const& [lines, words] : std::vector<std::pair<std::vector<Line>, std::string>>{
             {{{}}, ""},
             {{{corner}}, ""},
             {{{corner, {NAN, 4000000.0}}}, ""},
             {{good, {corner, {corner.x + 0x1p29 * 0.0625 * grid.cell_m, corner.y}}}, "vertex 1 of line 2"},
             {{good, {corner, {1e300, 0.0}}}, "vertex 1 of line 2"}}) {
        EXPECT_TRUE(test::refused(
            "report.page_lines", [&] { page_of(lines, grid); }, words));
    }
}

TEST(PageLines, EveryVertexWithinHalfAStepAndNoDrift) {
    ASSERT_TRUE(rc::check("the decoded lines are the nearest whole steps, without what turns nothing", [] {
        Grid frame = grid;
        frame.width = *rc::gen::element(100, 3000, 20000);
        frame.height = *rc::gen::element(80, 4000);
        double const pace = *rc::gen::element(0.4, 7.0, 300.0, 20000.0);
        std::vector<Line> lines(*rc::gen::inRange<std::size_t>(1, 6));
        for (Line& line : lines) {
            auto const n = *rc::gen::inRange(2, 60);
            Vec2 at{500000.0 + *rc::gen::inRange(0, 3000), 4000000.0 - *rc::gen::inRange(0, 2400)};
            for (int i = 0; i < n; ++i) {
                line.push_back(at);
                at.x += pace * *rc::gen::inRange(-4, 9) / 4.0;
                at.y -= pace * *rc::gen::inRange(-4, 9) / 4.0;
            }
        }
        PageLines const page = page_of(lines, frame);
        RC_ASSERT(page.step == static_cast<double>(report::page_cells(frame)) / 16.0);
        auto const decoded = page_decoder::lines(page.bytes, page.vertices);
        RC_ASSERT(decoded.size() == lines.size());
        for (std::size_t l = 0; l < lines.size(); ++l) {
            RC_ASSERT(decoded[l] == turns_of(lines[l], page, frame));
        }
    }));
}

TEST(FillPage, EachPartWhereItsMarkerStands) {
    PageParts const parts{"t", "d", "h", "l", "w", "s"};
    EXPECT_EQ(fill_page(bare, parts), "tdhlws");
    EXPECT_EQ(fill_page("0@@LINES@@1@@HEIGHTS@@2@@DATA@@3@@TITLE@@4@@WATER@@5@@STUDIO@@6", parts), "0l1h2d3t4w5s6");
    EXPECT_EQ(fill_page(bare, {"@@DATA@@", "@@TITLE@@$1\\1", "@@LINES@@", "@@", "w", "@@WATER@@"}),
              "@@DATA@@@@TITLE@@$1\\1@@LINES@@@@w@@WATER@@");
}

TEST(FillPage, AMissingOrSecondMarkerIsAnErrorOfTheBuild) {
    for (std::string const marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@", "@@WATER@@", "@@STUDIO@@"}) {
        std::string missing = bare;
        missing.erase(missing.find(marker), marker.size());
        EXPECT_THROW(fill_page(missing, {}), std::logic_error) << marker;
        EXPECT_THROW(fill_page(bare + marker, {}), std::logic_error) << marker;
    }
}

TEST(Embed, AnyByteSurvives) {
    std::string_view const bytes = thalweg::report::awkward_bytes();
    std::ifstream file(THALWEG_SOURCE_DIR "/tests/data/awkward.bin", std::ios::binary);
    EXPECT_TRUE(bytes == std::string(std::istreambuf_iterator<char>(file), {}));
    ASSERT_GT(bytes.size(), 256U);
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(bytes[static_cast<std::size_t>(i)], static_cast<char>(i));
    }
    EXPECT_TRUE(test::has(bytes, "@@DATA@@)\"R\"(;[=[${x}@y@\\\\;]]"));
}

} // namespace page_test
