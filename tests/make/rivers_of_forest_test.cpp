// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

#include <make/made.hpp>

namespace rivers_of_forest_test {

using namespace thalweg;
using namespace thalweg::make;

namespace {

using test::count;
using test::fault_of;
using test::geojson;
using test::has;
using test::made;

std::string const forest = "[network]\nsource = \"forest\"\n";
std::string const small_grid = "[grid]\nwidth = 200\nheight = 160\n";
std::string const dilated = "[surface]\nmethod = \"dilate\"\n";

/// A folder with regions and outlets near (500000, 5000000) in EPSG:32631.
class Files : public ScratchFolder {
public:
    Files() {
        // Two islands, 150 x 120 cells of 30 m with a lagoon, and 20 x 20.
        write("region.geojson",
              polygons("[[[500000,5000000],[504500,5000000],[504500,5003600],[500000,5003600],[500000,5000000]],"
                       "[[502000,5001500],[503000,5001500],[503000,5002500],[502000,5002500],[502000,5001500]]],"
                       "[[[505000,5000000],[505600,5000000],[505600,5000600],[505000,5000600],[505000,5000000]]]"));
        write("sliver.geojson", polygons("[[[500000,5000000],[509000,5000000],[509000,5000060],[500000,5000000]]]"));
        write("lake.geojson",
              polygons("[[[500900,5000900],[501500,5000900],[501500,5001500],[500900,5001500],[500900,5000900]]]"));
        write("points.csv", "x,y\n500000,5001000\n503000,5003700\n");
        write("west.geojson", geojson(test::line("[500010,4999000],[500010,5004000]")));
        write("inland.geojson", geojson(test::line("[501000,5001000],[501200,5001000]")));
    }
    std::string folder() const { return path().string(); }

private:
    static std::string polygons(std::string const& parts) {
        return geojson(test::feature("MultiPolygon", "[" + parts + "]"));
    }
};

/// Law: land has heights and the sea has none; every outlet lies on the coast or the grid's border; every check holds.
void expect_lawful(MakeResult const& t) {
    EXPECT_TRUE(t.assessment.passed());
    auto const is_land = [&](Cell c) {
        return t.terrain.grid.contains(c) && (t.terrain.ground.land.values().empty() || t.terrain.ground.land[c] != 0);
    };
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        ASSERT_EQ(std::isfinite(t.terrain.ground.dem[i]), is_land(t.terrain.grid.at(i))) << i;
    }
    EXPECT_FALSE(t.terrain.rivers.network.planform.outlets().empty());
    for (NodeId const n : t.terrain.rivers.network.planform.outlets()) {
        Cell const c = t.terrain.grid.cell_of(t.terrain.rivers.network.planform.node(n).at);
        EXPECT_TRUE(is_land(c));
        EXPECT_FALSE(is_land({c.col - 1, c.row}) && is_land({c.col + 1, c.row}) && is_land({c.col, c.row - 1}) &&
                     is_land({c.col, c.row + 1}));
    }
}

} // namespace

TEST(PlanForest, KeysThatDoNotGoTogetherAreNamed) {
    Files const files;
    std::string const region = forest + "[network.forest]\nregion = \"region.geojson\"\n";
    test::expect_faults(
        {{forest, "grid.width and grid.height"},
         {small_grid + forest + "rotate = 3\n", "network.rotate"},
         {forest + "[network.forest]\nshape = \"island\"\nregion = \"a.gpkg\"\n", "network.forest.shape and region"},
         {"[network]\n[network.forest]\nregion = \"a.gpkg\"\n", "source is not \"forest\""},
         {small_grid + forest + "[network.forest]\nspacing = 7\n", "spacing: 7 is outside"},
         {small_grid + forest + "[network.forest]\nregion = \"none.gpkg\"\n", "none.gpkg"},
         {"[grid]\nwidth = 7\nheight = 200\n" + forest, "there is no room for a river"},
         {forest + "[network.forest]\nregion = \"sliver.geojson\"\n" + dilated, "there is no room for a river"},
         {small_grid + forest + "prune = 9000\n", "removes every arc"},
         {region + "outlets = \"points.csv\"\nseeds = 4\n" + dilated, "network.forest.seeds"},
         {region + "seeds = 4\noutlets = \"inland.geojson\"\n" + dilated, "no coast of the land lies within"}},
        files.folder());
}

TEST(PlanForest, TheWholeGridDrainsOverItsBorder) {
    MakeResult const t = made(small_grid + forest + dilated);
    expect_lawful(t);
    EXPECT_TRUE(t.terrain.ground.land.values().empty());
    EXPECT_TRUE(t.planform.statistics.full);
    EXPECT_GT(t.terrain.rivers.network.planform.outlets().size(), 5U);
}

TEST(PlanForest, AnIslandIsDiffusedAndTriangulatedToo) {
    for (char const* method : {"dilate", "diffuse", "tin"}) {
        MakeResult const t = made(small_grid + forest + "[network.forest]\nshape = \"island\"\n[surface]\nmethod = \"" +
                                  std::string(method) + "\"\n");
        expect_lawful(t);
        EXPECT_EQ(t.terrain.ground.land[0], 0) << method;
    }
}

TEST(PlanForest, AnIslandComesIntoEquilibrium) {
    MakeResult const t =
        made(small_grid + forest + "[network.forest]\nshape = \"island\"\n[surface]\nedge = \"coast\"\n");
    expect_lawful(t);
    EXPECT_EQ(t.assessment.pits, 0);
    EXPECT_EQ(t.recipe.network->meander, 0.3);
    expect_lawful(
        made(small_grid + forest + "meander = 1\n[network.forest]\nshape = \"island\"\n[surface]\nedge = \"coast\"\n"));
}

TEST(PlanForest, ARegionsPolygonsAreTheLandAndFrameTheGrid) {
    Files const files;
    MakeResult const t =
        made(forest + "prune = 0\n[network.forest]\nregion = \"region.geojson\"\n" + dilated, files.folder());
    expect_lawful(t);
    EXPECT_EQ(t.terrain.grid.crs, "EPSG:32631");
    // The lagoon is sea, the islet is land.
    EXPECT_EQ(t.terrain.ground.land[t.terrain.grid.cell_of({502500, 5002000})], 0);
    EXPECT_EQ(t.terrain.ground.land[t.terrain.grid.cell_of({505300, 5000300})], 1);
    auto const land = static_cast<double>(std::ranges::count(t.terrain.ground.land.values(), std::uint8_t{1}));
    EXPECT_NEAR(land * 900.0, 4500.0 * 3600.0 - 1000.0 * 1000.0 + 600.0 * 600.0, 40.0 * 900.0);
    EXPECT_EQ(t.terrain.grid.width, 206); // 5600 m and 5 % on both sides
}

TEST(PlanForest, ARegionThatLeavesTheGridIsRefusedOrCut) {
    Files const files;
    std::string const recipe = "[grid]\nwidth = 100\nheight = 100\norigin = [500000, 5003600]\nclip = false\n" +
                               forest + "[network.forest]\nregion = \"region.geojson\"\n" + dilated;
    EXPECT_TRUE(has(fault_of(recipe, files.folder()), "runs outside the grid"));
    std::string cut = recipe;
    cut.replace(cut.find("false"), 5, "true");
    expect_lawful(made(cut, files.folder()));
}

TEST(PlanForest, PointsMoveToTheCoast) {
    Files const files;
    std::string const recipe =
        forest + "prune = 0\n[network.forest]\nregion = \"region.geojson\"\noutlets = \"points.csv\"\n";
    MakeResult const t = made(recipe + dilated, files.folder());
    expect_lawful(t);
    EXPECT_EQ(count(findings_of(t), "moved_outlet"), 1);
    EXPECT_EQ(count(findings_of(t), "added_outlet"), 1); // the islet's
    EXPECT_EQ(t.terrain.rivers.network.planform.outlets().size(), 3U);
}

TEST(PlanForest, LinesAndPolygonsMarkTheCoastWithOutlets) {
    Files const files;
    std::string const region = forest + "prune = 0\n[network.forest]\nregion = \"region.geojson\"\nseeds = 4\n";
    MakeResult const west = made(region + "outlets = \"west.geojson\"\n" + dilated, files.folder());
    expect_lawful(west);
    std::int64_t on_line = 0;
    for (NodeId const n : west.terrain.rivers.network.planform.outlets()) {
        on_line += west.terrain.rivers.network.planform.node(n).at.x < 500400 ? 1 : 0;
    }
    EXPECT_EQ(on_line, 4);
    MakeResult const lake = made(region + "outlets = \"lake.geojson\"\n" + dilated, files.folder());
    expect_lawful(lake);
    EXPECT_EQ(lake.terrain.ground.land[lake.terrain.grid.cell_of({501200, 5001200})], 0);
}

TEST(PlanForest, OutletsThatArePrunedAwayAreReported) {
    MakeResult const all = made(small_grid + forest + "prune = 0\n" + dilated);
    MakeResult const some = made(small_grid + forest + "prune = 40\n" + dilated);
    std::size_t const before = all.terrain.rivers.network.planform.outlets().size();
    std::size_t const after = some.terrain.rivers.network.planform.outlets().size();
    EXPECT_LT(after, before);
    EXPECT_EQ(count(findings_of(some), "pruned_outlet"), static_cast<std::int64_t>(before - after));
}

} // namespace rivers_of_forest_test
