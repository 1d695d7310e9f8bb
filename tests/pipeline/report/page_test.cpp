// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

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
#include <nlohmann/json.hpp>
#include <pipeline/awkward.hpp>
#include <pipeline/page_decoder.hpp>
#include <rapidcheck.h>
#include <support.hpp>
#include <unpacked.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/report/internal/page_template.hpp>
#include <thalweg/pipeline/report/report.hpp>

namespace page_test {

using namespace thalweg;
using namespace thalweg::pipeline;
using nlohmann::json;
using pipeline::page_cells;
using pipeline::page_heights;
using pipeline::page_lines;
using pipeline::PageHeights;
using pipeline::PageLines;

namespace {

using test::has;
using test::message_of;

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

/// Decodes the page's heights and holds each to the mean of its square.
void hold_to_means(Raster<float> const& dem) {
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

Vec2 in_steps(Vec2 at, PageLines const& page, Grid const& frame) {
    double const step_m = page.step * frame.cell_m;
    return {(at.x - frame.west) / step_m, (frame.north - at.y) / step_m};
}

bool near(Vec2 a, Vec2 b) {
    constexpr double half = 0.5 + 1e-9;
    return std::fabs(a.x - b.x) <= half && std::fabs(a.y - b.y) <= half;
}

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
        Vec2 const at = in_steps(vertex, page, frame);
        Vec2 const whole{std::floor(at.x + 0.5), std::floor(at.y + 0.5)};
        RC_ASSERT(near(whole, at));
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

std::string const bare = "@@TITLE@@@@DATA@@@@HEIGHTS@@@@LINES@@";

} // namespace

TEST(Page, HeightsAndLinesAreThoseOfTheTerrain) {
    Made const terrain = small_terrain(Land::with);
    std::string const html = page(terrain, {.contour_interval_m = 25.0, .recipe = "seed = 7\n"});
    for (char const* marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@"}) {
        EXPECT_FALSE(test::has(html, marker));
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
    ASSERT_EQ(lines.size(), terrain.terrain.network.plan.arc_count());
    double const step_m = data["rivers"]["step"].get<double>() * terrain.terrain.grid.cell_m;
    for (auto const& [name, column] : arcs.items()) {
        EXPECT_EQ(column.size(), lines.size()) << name;
    }
    for (std::size_t a = 0; a < lines.size(); ++a) {
        Vec2 const from = terrain.terrain.network.plan.node(terrain.terrain.network.plan.from(a)).at;
        Vec2 const to = terrain.terrain.network.plan.node(terrain.terrain.network.plan.to(a)).at;
        EXPECT_NEAR(terrain.terrain.grid.west + lines[a].front().x * step_m, from.x, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.north - lines[a].front().y * step_m, from.y, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.west + lines[a].back().x * step_m, to.x, step_m / 2.0);
        EXPECT_NEAR(terrain.terrain.grid.north - lines[a].back().y * step_m, to.y, step_m / 2.0);
        EXPECT_EQ(arcs["id"][a], a + 1);
        auto const ds = arcs["ds"][a].get<std::size_t>();
        if (ds > 0) {
            EXPECT_EQ(lines[a].back(), lines[ds - 1].front()) << "rivers are not torn apart";
        }
        EXPECT_NEAR(arcs["length"][a].get<double>(), terrain.terrain.network.plan.length_m(a), 0.001);
        EXPECT_NEAR(arcs["z_up"][a].get<double>(), terrain.terrain.network.arc_z[a].front(), 0.001);
        EXPECT_EQ(arcs["ds_area"][a], terrain.assessment.areas.ds_area_m2[a]);
        double const persistence = terrain.terrain.network.plan.arc(a).persistence;
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
    auto const& far = terrain.terrain.orders.node_dist_out_m;
    EXPECT_NEAR(profile.front()[0].get<double>(), *std::max_element(far.begin(), far.end()), 0.001);

    // Two straight rivers: the one that drains more, though shorter; among equals the first.
    Made two = terrain;
    two.terrain.network = {};
    two.terrain.orders = {};
    NetworkDraft plan;
    for (double const length : {100.0, 50.0, 70.0}) {
        auto const source = plan.add_node({two.terrain.grid.west + length, two.terrain.grid.north});
        auto const outlet = plan.add_node({two.terrain.grid.west, two.terrain.grid.north});
        plan.add_arc(source, outlet);
        two.terrain.network.arc_z.push_back({length, 1.0});
        two.terrain.orders.node_dist_out_m.insert(two.terrain.orders.node_dist_out_m.end(), {length, 0.0});
    }
    two.terrain.network.plan = std::move(plan);
    two.terrain.orders.strahler = {1, 1, 1};
    two.terrain.orders.hack = {1, 1, 1};
    two.terrain.orders.shreve = {1, 1, 1};
    two.terrain.orders.arc_basin = {1, 2, 3};
    two.assessment.areas.us_area_m2 = two.assessment.areas.ds_area_m2 = {1.0, 2.0, 2.0};
    two.assessment.areas.node_m2 = {0.0, 1.0, 0.0, 2.0, 0.0, 2.0};
    EXPECT_EQ(data_of(page(two))["profile"], json::parse("[[50.0, 50.0], [0.0, 1.0]]"));
}

TEST(Page, LongListsAreCut) {
    Made terrain = small_terrain(Land::with);
    terrain.terrain.surface->increments.assign(5000, 2.0);
    terrain.assessment.findings.assign(61, {"uphill", 1, {}, 0.0, "arc 1 runs uphill"});
    terrain.rivers.story.repairs.clear();
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
    EXPECT_FALSE(test::has(html, "<script>alert"));
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

TEST(PageHeights, WithoutAHeightThereIsNoBlob) {
    EXPECT_FALSE(page_heights(Raster<float>{}).has_value());
    EXPECT_FALSE(page_heights(dem_of(2, {hole, hole, hole, hole})).has_value());
}

TEST(PageHeights, OneHeightIsExact) {
    Raster<float> dem = dem_of(3, std::vector<float>(12, -0.7F));
    dem[4] = hole;
    auto const page = page_heights(dem);
    ASSERT_TRUE(page.has_value());
    EXPECT_EQ(page->nodata, 1);
    auto const decoded = page_decoder::heights(page->bytes, 3, 4, page->min, page->max);
    for (std::size_t i = 0; i < decoded.size(); ++i) {
        EXPECT_TRUE(i == 4 ? std::isnan(decoded[i]) : decoded[i] == static_cast<double>(-0.7F)) << i;
    }
}

TEST(PageHeights, AnInfiniteHeightIsRefusedByItsPlace) {
    Raster<float> dem = dem_of(2, {1.0F, 2.0F, 3.0F, 4.0F});
    dem[3] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(has(message_of<BadInput>([&] { page_heights(dem); }), "column 1, row 1"));
}

TEST(PageHeights, TheSmallestSquaresThatAreFewEnough) {
    EXPECT_EQ(page_cells(frame(1, 1)), 1);
    EXPECT_EQ(page_cells(frame(1024, 1024)), 1);
    EXPECT_EQ(page_cells(frame(1500, 1000)), 1);
    EXPECT_EQ(page_cells(frame(1500, 1001)), 2);
    EXPECT_EQ(page_cells(frame(4096, 1)), 1);
    EXPECT_EQ(page_cells(frame(4097, 1)), 2);
    EXPECT_EQ(page_cells(frame(1, 9000)), 3);
    EXPECT_EQ(page_cells(frame(10000, 10000)), 9);
}

TEST(PageHeights, AnyDem) {
    ASSERT_TRUE(rc::check("every height within half a step of its cell", [] {
        hold_to_means([] {
            Raster<float> dem = *gen_dem(20, 70);
            dem[dem.cells() / 2] = 3.0F;
            return dem;
        }());
        RC_ASSERT(!testing::Test::HasFatalFailure());
    }));
}

TEST(PageHeights, RoughAndSmoothAndOneRowWithMeans) {
    hold_to_means(rough_dem(frame(300, 200), 3));
    hold_to_means(rough_dem(frame(1, 300), 4));
    Raster<float> smooth =
        test::raster_of(frame(200, 100), [&](Cell c) { return 1e4F - static_cast<float>(c.col * c.row) * 0.1F; });
    hold_to_means(smooth);
    for (auto const& grid : {frame(1301, 1277), frame(9001, 2), frame(1, 12300)}) {
        Raster<float> dem = rough_dem(grid, 5);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const c = grid.at(i);
            if ((c.col / 5 + c.row / 3) % 4 == 0) { // whole squares and parts of them
                dem[i] = hole;
            }
        }
        hold_to_means(dem);
    }
}

TEST(PageHeights, APlaneCostsNextToNothing) {
    Raster<float> plane = test::raster_of(frame(256, 256), [&](Cell c) { return c.col + 2 * c.row; });
    auto const page = page_heights(plane);
    std::size_t small = 0;
    for (std::size_t i = 256; i < page->bytes.size(); ++i) {
        small += page->bytes[i] <= 4;
    }
    EXPECT_GT(small, page->bytes.size() * 98 / 100) << "residuals of a plane are its roundings";
}

TEST(PageLines, NoLines) {
    PageLines const page = page_of({}, grid);
    EXPECT_TRUE(page.vertices.empty());
    EXPECT_TRUE(page.bytes.empty());
    EXPECT_EQ(page.step, 0.0625);
}

TEST(PageLines, RefusesWhatIsNoLineHere) {
    EXPECT_THROW(page_of({{}}, grid), BadInput);
    EXPECT_THROW(page_of({{{500000.0, 4000000.0}}}, grid), BadInput);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(page_of({{{500000.0, 4000000.0}, {nan, 4000000.0}}}, grid), BadInput);
    EXPECT_TRUE(
        has(message_of<BadInput>([&] {
                page_of({{{500000.0, 4000000.0}, {500001.0, 4000000.0}}, {{500000.0, 4000000.0}, {1e300, 0.0}}}, grid);
            }),
            "vertex 1 of line 2"));
}

TEST(PageLines, BytesOfASmallOne) {
    PageLines const page =
        page_of({{{500000.0, 4000000.0}, {500007.5, 3999700.0}}, {{500000.0, 4000007.5}, {500000.0, 3999700.0}}}, grid);
    EXPECT_EQ(page.vertices, (std::vector<std::int64_t>{2, 2}));
    // 0 0, 4 160, -4 -164, 0 164
    EXPECT_EQ(page.bytes, (std::vector<std::uint8_t>{0, 0, 8, 0xC0, 2, 7, 0xC7, 2, 0, 0xC8, 2}));
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
        RC_ASSERT(page.step == static_cast<double>(pipeline::page_cells(frame)) / 16.0);
        auto const decoded = page_decoder::lines(page.bytes, page.vertices);
        RC_ASSERT(decoded.size() == lines.size());
        for (std::size_t l = 0; l < lines.size(); ++l) {
            RC_ASSERT(decoded[l] == turns_of(lines[l], page, frame));
        }
    }));
}

TEST(FillPage, EachPartWhereItsMarkerStands) {
    PageParts const parts{"t", "d", "h", "l"};
    EXPECT_EQ(fill_page(bare, parts), "tdhl");
    EXPECT_EQ(fill_page("0@@LINES@@1@@HEIGHTS@@2@@DATA@@3@@TITLE@@4", parts), "0l1h2d3t4");
    EXPECT_EQ(fill_page(bare, {}), "");
}

TEST(FillPage, WhatLooksLikeAMarkerInAPartStays) {
    EXPECT_EQ(fill_page(bare, {"@@DATA@@", "@@TITLE@@$1\\1", "@@LINES@@", "@@"}), "@@DATA@@@@TITLE@@$1\\1@@LINES@@@@");
}

TEST(FillPage, AMissingOrSecondMarkerIsAnErrorOfTheBuild) {
    for (std::string const marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@"}) {
        std::string missing = bare;
        missing.erase(missing.find(marker), marker.size());
        EXPECT_THROW(fill_page(missing, {}), std::logic_error) << marker;
        EXPECT_THROW(fill_page(bare + marker, {}), std::logic_error) << marker;
    }
}

TEST(FillPage, TheBuiltInPageIsTheFileAndHoldsEachMarkerOnce) {
    std::ifstream file(THALWEG_SOURCE_DIR "/web/dist/report.html", std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(bytes.empty());
    EXPECT_TRUE(page_template() == bytes);
    EXPECT_NO_THROW(fill_page(page_template(), {}));
}

TEST(Embed, AnyByteSurvives) {
    std::string_view const bytes = thalweg::pipeline::awkward_bytes();
    std::ifstream file(THALWEG_SOURCE_DIR "/tests/data/awkward.bin", std::ios::binary);
    EXPECT_TRUE(bytes == std::string(std::istreambuf_iterator<char>(file), {}));
    ASSERT_GT(bytes.size(), 256U);
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(bytes[static_cast<std::size_t>(i)], static_cast<char>(i));
    }
    EXPECT_TRUE(test::has(bytes, "@@DATA@@)\"R\"(;[=[${x}@y@\\\\;]]"));
}

} // namespace page_test
