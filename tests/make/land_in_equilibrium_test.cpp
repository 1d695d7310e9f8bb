// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes of terrain in equilibrium, from keys to checks.
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/measure/laws/network_laws.hpp>
#include <thalweg/measure/relief/relief.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/recipe/make_input.hpp>

#include <make/ascii_grid.hpp>
#include <make/made.hpp>

namespace land_in_equilibrium_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

using test::count;
using test::geojson;
using test::line;
using test::made;
using test::polygon;

std::string const grid = "[grid]\nwidth = 140\nheight = 120\norigin = [500000, 5003600]\ncrs = \"EPSG:32631\"\n";
std::string const lines = grid + "[network]\nsource = \"lines\"\n";
std::string const path = "[network.lines]\npath = \"rivers.geojson\"\n";
std::string const equilibrium = "[surface]\n";

/// Two rivers that meet and leave in the south of 140 x 120 cells of 30 m.
class Files : public ScratchFolder {
public:
    Files() {
        std::string const trunk = "[501000,5003000],[501700,5002200],[502000,5001500]";
        std::string const other = "[503200,5002800],[502500,5002000],[502000,5001500]";
        write("rivers.geojson",
              geojson(line(trunk) + "," + line(other) + "," + line("[502000,5001500],[502100,5000010]")));
        write("inland.geojson", geojson(line("[501000,5003000],[502000,5001500]")));
        // Beside a deep valley another river runs six hundred metres higher.
        write("high.geojson", geojson(line("[501000,5003000,60],[502100,5000010,0]") + "," +
                                      line("[501500,5003000,900],[502600,5000010,600]")));
        write("falling.geojson", geojson(line("[501000,5003000,90],[502000,5001500,40],[502100,5000010,0]") + "," +
                                         line("[503200,5002800,110],[502500,5002000,70],[502000,5001500,40]")));
        write("noisy.geojson", geojson(line("[501000,5003000,90],[501500,5002200,61],[501700,5001900,64.5],"
                                            "[502000,5001500,40],[502100,5000010,0]")));
        write("uphill.geojson", geojson(line("[501000,5003000,90],[501500,5002200,61],[501700,5001900,99],"
                                             "[502000,5001500,40],[502100,5000010,0]")));
        write("border.geojson", geojson(line("[500010,5003000],[500010,5000010]")));
        write("double.geojson", geojson(line(trunk + ",[502100,5000010]") + "," +
                                        line("[501010,5003000],[501710,5002200],[502010,5001500],[502110,5000010]")));
        std::string fine;
        for (int y = 3000; y >= 10; y -= 46) { // pieces of 46 m
            fine += fmt::format("[501500,{}],", 5000000 + y);
        }
        write("fine.geojson", geojson(line(fine + "[501500,5000010]")));
        write("lakes.geojson",
              geojson(polygon("[501850,5001200],[502250,5001200],[502250,5001700],[501850,5001700],[501850,5001200]")));
        write("dry.geojson",
              geojson(polygon("[503500,5000300],[503800,5000300],[503800,5000600],[503500,5000600],[503500,5000300]")));
        write("ponds.geojson",
              geojson(polygon("[502001,5001301],[502003,5001301],[502003,5001303],[502001,5001301]") + "," +
                      polygon("[400000,5001200],[400100,5001200],[400100,5001300],[400000,5001200]") + "," +
                      polygon("[501850,5001200],[502250,5001200],[502250,5001700],"
                              "[501850,5001700],[501850,5001200]")));
        std::string const east = "[502500,5000000],[504200,5000000],[504200,5003600],[502500,5003600],[502500,5000000]";
        write("rock.geojson", geojson(polygon(east, "\"erodibility\":0.2")));
        write("numb.geojson", geojson(polygon(east, "\"erodibility\":\"hard\"")));
        write("zero.geojson", geojson(polygon(east, "\"erodibility\":0")));
    }
    std::string folder() const { return path().string(); }

    /// An ESRI grid of 140 x 120 cells of 30 m, with value(column, row).
    template <class Value> void raster(std::string const& name, Value value) const {
        write_ascii_grid(*this / name, {140, 120, 30, 500000, 5000000}, value);
    }
};

/// Law: every check holds, the DEM has no depression and needed no breaching, and rivers have its heights.
void expect_lawful(MakeResult const& t) {
    for (Check const& c : t.assessment.checks) {
        EXPECT_TRUE(c.ok) << c.name << " " << c.value;
    }
    EXPECT_EQ(t.assessment.pits, 0);
    ASSERT_TRUE(t.terrain.water.is_conditioned);
    EXPECT_EQ(t.terrain.water.banks.raised_cells, 0);
    EXPECT_EQ(t.terrain.water.depressions.raised_cells + t.terrain.water.depressions.cut_cells, 0);
    ValleyCells const& valley = t.terrain.bed.valley;
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        EXPECT_EQ(valley.z[i], t.terrain.ground.dem[valley.cell[i]]);
    }
}

Check const& check_of(MakeResult const& t, char const* name) {
    auto const found = std::ranges::find(t.assessment.checks, std::string_view(name), &Check::name);
    if (found == t.assessment.checks.end()) {
        throw BadInput("test.check_of", std::string("no check ") + name);
    }
    return *found;
}

double mean_of(MakeResult const& t, std::int64_t from_column, std::int64_t to_column) {
    double sum = 0.0;
    std::int64_t cells = 0;
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        std::int64_t const column = t.terrain.grid.at(i).col;
        if (column >= from_column && column < to_column) {
            sum += static_cast<double>(t.terrain.ground.dem[i]);
            ++cells;
        }
    }
    return sum / static_cast<double>(cells);
}

} // namespace

TEST(LandInEquilibrium, KeysThatDoNotGoTogetherAreNamed) {
    Files const files;
    std::string const dilate = path + "[surface]\nmethod = \"dilate\"\n";
    test::expect_faults({{lines + path + "[surface]\nmean_slope = 20\nrelief = 300\n", "do not go together"},
                         {lines + "heights = \"soft\"\n" + dilate, "\"soft\" needs surface.method"},
                         {lines + "fill_space = true\n" + dilate, "network.fill_space needs"},
                         {lines + "rotate = 20\n" + path + equilibrium, "network.rotate"},
                         {lines + "concavity = 0.95\n" + path + equilibrium, "0.1 to 0.9"},
                         {lines + path + "[surface]\nlakes = \"lakes.geojson\"\nlake_share = 0.5\n", "lakes"},
                         {lines + path + "[surface]\nmean_slope = 0\n", "surface.mean_slope"},
                         {lines + path + "[surface]\nrelief = -1\n", "surface.relief"},
                         {"[grid]\nwidth = 60\nheight = 60\n[surface]\n", "needs [network]"}},
                        files.folder());
}

TEST(LandInEquilibrium, ReliefOrMeanSlopeIsWhatWasAsked) {
    Files const files;
    MakeResult const sloped = made(lines + path + "[surface]\nmean_slope = 15\n", files.folder());
    expect_lawful(sloped);
    EXPECT_NEAR(sloped.assessment.relief->land.slopes.mean_deg, 15.0, 0.2);
    MakeResult const high = made(lines + path + "[surface]\nrelief = 400\n", files.folder());
    expect_lawful(high);
    EXPECT_NEAR(high.assessment.statistics->max.z - high.assessment.statistics->min.z, 400.0, 0.1);
}

TEST(LandInEquilibrium, HeightsOfRiversAreKeptOrUpperBounds) {
    Files const files;
    MakeResult const fixed = made(lines + "heights = \"fixed\"\nslope = 0.08\n" + path + equilibrium, files.folder());
    MakeResult const soft = made(lines + "heights = \"soft\"\nslope = 0.08\n" + path + equilibrium, files.folder());
    MakeResult const ends = made(lines + "heights = \"ends\"\nslope = 0.08\n" + path + equilibrium, files.folder());
    expect_lawful(soft);
    for (MakeResult const* t : {&fixed, &ends}) {
        EXPECT_LE(check_of(*t, "walled_cells").value, 4.0); // heads: even slopes are not natural
        EXPECT_EQ(check_of(*t, "sources_astray").value, 0.0);
    }
    // The sources lie some 2000 m from the outlet.
    double const source = fixed.terrain.rivers.network.node_z[0];
    EXPECT_GT(source, 100.0);
    EXPECT_NEAR(ends.terrain.rivers.network.node_z[0], source, 0.1);
    EXPECT_LE(soft.terrain.rivers.network.node_z[0], source + 0.1);
    EXPECT_EQ(fixed.terrain.ground.equilibrium()->max_lowered_m, 0.0);
}

TEST(LandInEquilibrium, GeneralisedRiversAreNoted) {
    Files const files;
    auto const notes = [&](std::string const& network, std::string const& file) {
        MakeResult const t =
            made(lines + network + "[network.lines]\npath = \"" + file + "\"\n" + equilibrium, files.folder());
        return count(findings_of(t), "few_vertices");
    };
    EXPECT_EQ(notes("", "rivers.geojson"), 1);
    EXPECT_EQ(notes("meander = 0\n", "rivers.geojson"), 0) << "who said so knows";
    EXPECT_EQ(notes("meander = 1\n", "rivers.geojson"), 0);
    EXPECT_EQ(notes("", "fine.geojson"), 0);
}

TEST(LandInEquilibrium, LakesKeepFromTheSea) {
    for (int const seed : {1, 4, 6}) { // 4: a lake reached the shore, and its water the sea beside the outlet
        MakeResult const island =
            made(fmt::format("seed = {}\n[grid]\nwidth = 400\nheight = 400\n"
                             "[network]\nsource = \"forest\"\nprune = 40\n"
                             "[network.forest]\nshape = \"island\"\nruggedness = 0.8\nspacing = 20\n"
                             "[surface]\nmethod = \"equilibrium\"\nedge = \"coast\"\nlake_share = 0.5\n",
                             seed));
        expect_lawful(island);
        EXPECT_EQ(check_of(island, "sources_astray").value, 0.0) << seed;
    }
}

TEST(LandInEquilibrium, LakesAreLevelAndReported) {
    Files const files;
    MakeResult const t = made(lines + path + "[surface]\nlakes = \"lakes.geojson\"\n", files.folder());
    expect_lawful(t);
    EXPECT_EQ(t.terrain.bed.lakes, 1);
    EXPECT_GT(t.assessment.certificate->lake_cells, 5);
    Cell const middle = t.terrain.grid.cell_of({502050, 5001400});
    std::int64_t level = 0;
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        level += t.terrain.ground.dem[i] == t.terrain.ground.dem[middle] ? 1 : 0;
    }
    EXPECT_GT(level, 100); // of 13 x 16 cells
    MakeResult const dry = made(lines + path + "[surface]\nlakes = \"dry.geojson\"\n", files.folder());
    expect_lawful(dry);
    EXPECT_EQ(dry.terrain.bed.lakes, 0);
    EXPECT_EQ(count(findings_of(dry), "lake_left_out"), 1);
    MakeResult const ponds = made(lines + path + "[surface]\nlakes = \"ponds.geojson\"\n", files.folder());
    EXPECT_EQ(ponds.terrain.bed.lakes, 1);
    EXPECT_EQ(count(findings_of(ponds), "lake_left_out"), 1); // a pond between cells' centres and one off the grid
    EXPECT_TRUE(std::ranges::equal(ponds.terrain.ground.dem.values(), t.terrain.ground.dem.values()));
}

namespace {

/// The levels at which the cells of a polygon's inner part stand, and whether they are lake.
std::set<float> levels_within(MakeResult const& t, Vec2 from, Vec2 to) {
    std::set<float> levels;
    Mask const lakes = lake_cells(t.terrain.bed.channels);
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        Vec2 const at = t.terrain.grid.centre(t.terrain.grid.at(i));
        if (at.x > from.x && at.x < to.x && at.y > from.y && at.y < to.y) {
            EXPECT_EQ(lakes[i], 1) << at.x << " " << at.y;
            levels.insert(t.terrain.ground.dem[i]);
        }
    }
    return levels;
}

std::string lake(std::string const& west, std::string const& south, std::string const& east, std::string const& north,
                 std::string const& properties = "") {
    return polygon("[" + west + "," + south + "],[" + east + "," + south + "],[" + east + "," + north + "],[" + west +
                       "," + north + "],[" + west + "," + south + "]",
                   properties);
}

std::vector<std::string> texts(std::vector<Finding> const& findings, std::string_view kind) {
    std::vector<std::string> out;
    for (Finding const& one : findings) {
        if (one.kind == kind) {
            out.push_back(one.text);
        }
    }
    return out;
}

} // namespace

// What the terrain gives the lake of lakes.geojson is 19 m.
TEST(LandInEquilibrium, LakesHaveTheLevelsOfTheirPolygons) {
    Files const files;
    std::string const keys = lines + path + "[surface]\nlakes = \"levels.geojson\"\n";
    for (double const level : {0.25, 5.0, 19.0, 30.0, 60.0}) {
        files.write("levels.geojson",
                    geojson(lake("501850", "5001200", "502250", "5001700", "\"Level\":" + std::to_string(level))));
        MakeResult const t = made(keys, files.folder());
        expect_lawful(t);
        EXPECT_EQ(levels_within(t, {501910, 5001260}, {502190, 5001640}), std::set{static_cast<float>(level)});
        EXPECT_EQ(count(findings_of(t), "lake_level"), 0);
        EXPECT_EQ(t.terrain.ground.dem[t.terrain.bed.channels.cell[0]], 0.0F) << "the outlet";
        for (std::size_t n = 0; n < t.terrain.bed.channels.cell.size(); ++n) {
            std::int64_t const r = t.terrain.bed.channels.receiver[n];
            EXPECT_TRUE(r < 0 || t.terrain.bed.channels.level[n] != 0 ||
                        t.terrain.ground.dem[t.terrain.bed.channels.cell[n]] >
                            t.terrain.ground.dem[t.terrain.bed.channels.cell[static_cast<std::size_t>(r)]]);
        }
    }
    files.write("levels.geojson", geojson(lake("501850", "5001200", "502250", "5001700", "\"level\":null")));
    MakeResult const free = made(keys, files.folder());
    MakeResult const without = made(lines + path + "[surface]\nlakes = \"lakes.geojson\"\n", files.folder());
    EXPECT_TRUE(std::ranges::equal(free.terrain.ground.dem.values(), without.terrain.ground.dem.values()));
    files.write("levels.geojson", geojson(lake("501850", "5001200", "502250", "5001700", "\"level\":1e9")));
    test::expect_faults({{keys, "levels.geojson\": feature 0 has the level 1000000000 m"}}, files.folder());
}

TEST(LandInEquilibrium, LevelsThatWaterCannotKeepAreTold) {
    Files const files;
    std::string const keys = lines + path + "[surface]\nlakes = \"levels.geojson\"\n";
    files.write("levels.geojson", geojson(lake("501850", "5001200", "502250", "5001700", "\"level\":20") + "," +
                                          lake("501900", "5000400", "502300", "5000800", "\"level\":35.5") + "," +
                                          lake("503500", "5000300", "503800", "5000600", "\"level\":7") + "," +
                                          lake("400000", "5000300", "400800", "5000600", "\"level\":8")));
    std::string said;
    thalweg::Run run;
    run.log = [&said](std::string_view text) { said += std::string(text) + "\n"; };
    MakeResult const t = made(keys, files.folder(), run);
    expect_lawful(t);
    std::set<float> const above = levels_within(t, {501910, 5001260}, {502190, 5001640});
    EXPECT_EQ(levels_within(t, {501960, 5000460}, {502240, 5000740}), std::set{35.5F});
    ASSERT_EQ(above.size(), 1U);
    EXPECT_GT(*above.begin(), 35.5F);
    EXPECT_LT(*above.begin(), 35.52F);
    auto const notes = findings_of(t);
    std::vector<std::string> const missed = texts(notes, "lake_level");
    ASSERT_EQ(missed.size(), 1U);
    EXPECT_TRUE(test::has(missed[0], "lake 1 at (")) << missed[0];
    EXPECT_TRUE(test::has(missed[0], "m, not 20 m: lake 2 stands at 35.5 m, cells downstream: ")) << missed[0];
    EXPECT_TRUE(test::has(said, "warning: " + missed[0]));
    std::vector<std::string> const left_out = texts(notes, "lake_left_out");
    ASSERT_EQ(left_out.size(), 1U);
    EXPECT_TRUE(test::has(left_out[0], "no river runs through it; level asked for: 7 m"));
    std::vector<std::string> const unseen = texts(notes, "lakes_unseen");
    ASSERT_EQ(unseen.size(), 1U);
    EXPECT_TRUE(test::has(unseen[0], "1 of them have levels, the first is feature 3 with 8 m"));
    EXPECT_TRUE(test::has(said, "level asked for: 7 m"));
    EXPECT_TRUE(test::has(said, "with 8 m"));
    files.write("levels.geojson", geojson(lake("501850", "5001200", "502250", "5001700", "\"level\":-12")));
    MakeResult const low = made(keys, files.folder());
    expect_lawful(low);
    ASSERT_EQ(count(findings_of(low), "lake_level"), 1);
    EXPECT_TRUE(
        test::has(texts(findings_of(low), "lake_level")[0], "m, not -12 m: its river ends at 0 m, cells downstream: "));
    EXPECT_LT(*levels_within(low, {501910, 5001260}, {502190, 5001640}).begin(), 0.02F);
}

TEST(LandInEquilibrium, LakesHaveTheirLevelsAmongGivenHeightsAndTargets) {
    Files const files;
    files.write("levels.geojson", geojson(lake("501850", "5001200", "502250", "5001700", "\"level\":45.75")));
    std::string const surface = "[surface]\nlakes = \"levels.geojson\"\n";
    std::string const falling = "[network.lines]\npath = \"falling.geojson\"\n";
    for (std::string const& recipe :
         {lines + "heights = \"fixed\"\n" + falling + surface, lines + "heights = \"soft\"\n" + falling + surface,
          lines + "heights = \"ends\"\n" + falling + surface, lines + falling + surface,
          lines + path + surface + "mean_slope = 15\n", lines + path + surface + "relief = 400\n",
          lines + path + surface + "edge = \"closed\"\n",
          lines + "fill_space = true\nsupport = 200\n" + path + surface}) {
        MakeResult const t = made(recipe, files.folder());
        EXPECT_EQ(levels_within(t, {501910, 5001260}, {502190, 5001640}), std::set{45.75F}) << recipe;
        EXPECT_EQ(t.assessment.pits, 0) << recipe;
        for (Check const& c : t.assessment.checks) {
            EXPECT_TRUE(c.ok) << c.name << " " << c.value << " " << recipe;
        }
    }
}

TEST(LandInEquilibrium, PolygonsMaskLand) {
    Files const files;
    // The western five sixths, in another CRS than the grid, which reaches from 3.000 to 3.053 degrees east.
    files.write("west.geojson", R"({"type":"FeatureCollection","features":[)" +
                                    polygon("[2.9,45],[3.045,45],[3.045,45.3],[2.9,45.3],[2.9,45]") + "]}");
    files.write("east.geojson", geojson(lake("501200", "4990000", "510000", "5010000")));
    MakeResult const t = made(lines + path + "[surface]\nmask = \"west.geojson\"\n", files.folder());
    EXPECT_EQ(t.terrain.ground.equilibrium()->edge, surface::Edge::coast);
    Raster<float> const& dem = t.terrain.ground.dem;
    MakeResult const dilated =
        made(lines + path + "[surface]\nmethod = \"dilate\"\nmask = \"west.geojson\"\n", files.folder());
    // 0.045 degrees of longitude are 3536 m there.
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const x = dem.grid().centre(dem.grid().at(i)).x;
        if (std::fabs(x - 503536.0) > 10.0) {
            EXPECT_EQ(std::isnan(dem[i]), x > 503536.0 && !has_river(t.terrain.bed.valley, i));
            EXPECT_EQ(std::isnan(dilated.terrain.ground.dem[i]), x > 503536.0);
        }
    }
    // Rivers outside are land in equilibrium; dilation refuses them, as with rasters.
    MakeResult const kept = made(lines + path + "[surface]\nmask = \"east.geojson\"\n", files.folder());
    Cell const source = kept.terrain.grid.cell_of({501000, 5003000});
    EXPECT_FALSE(std::isnan(kept.terrain.ground.dem[source]));
    test::expect_faults(
        {{lines + path + "[surface]\nmethod = \"dilate\"\nmask = \"east.geojson\"\n",
          "surface.mask = \"east.geojson\" leaves out cell ("},
         {lines + path + "[surface]\nmask = \"dry.geojson\"\nmethod = \"dilate\"\n", "where a river runs"},
         {lines + path + "[surface]\nmask = \"rivers.geojson\"\n", "rivers.geojson"}},
        files.folder());
}

TEST(LandInEquilibrium, HardRockAndUpliftMakeHighLand) {
    Files const files;
    MakeResult const even = made(lines + path + equilibrium, files.folder());
    MakeResult const rock = made(lines + path + "[surface]\nerodibility = \"rock.geojson\"\n", files.folder());
    files.raster("uplift.asc", [](int c, int) { return c < 84 ? 1 : 4; });
    MakeResult const lifted = made(lines + path + "[surface]\nuplift = \"uplift.asc\"\n", files.folder());
    auto const contrast = [](MakeResult const& t) { return mean_of(t, 95, 140) / mean_of(t, 0, 75); };
    for (MakeResult const* t : {&even, &rock, &lifted}) {
        expect_lawful(*t);
    }
    EXPECT_GT(contrast(rock), 1.3 * contrast(even));
    EXPECT_GT(contrast(lifted), 1.3 * contrast(even));
}

TEST(LandInEquilibrium, FieldsThatMakeNoSenseAreRefusedByPlace) {
    Files const files;
    files.raster("holes.asc", [](int c, int r) { return c == 30 && r == 20 ? -9999 : 1; });
    files.raster("below.asc", [](int c, int r) { return c == 31 && r == 21 ? -2 : 1; });
    std::string const surface = lines + path + "[surface]\n";
    test::expect_faults({{surface + "uplift = \"holes.asc\"\n", "none in cell (30, 20)"},
                         {surface + "uplift = \"below.asc\"\n", "-2 in cell (31, 21)"},
                         {surface + "erodibility = \"zero.geojson\"\n", "above 0"},
                         {surface + "erodibility = \"numb.geojson\"\n", "no field erodibility"},
                         {surface + "erodibility = \"lakes.geojson\"\n", "no field"}},
                        files.folder());
}

TEST(LandInEquilibrium, RiversThatEndInsideAreCarriedOrSinks) {
    Files const files;
    std::string const inland = "[network.lines]\npath = \"inland.geojson\"\n";
    MakeResult const carried = made(lines + inland + equilibrium, files.folder());
    expect_lawful(carried);
    EXPECT_EQ(count(findings_of(carried), "carried_outlet"), 1);
    MakeResult const sink =
        made(lines + "inland = \"sink\"\n" + inland + "[surface]\ndrain = \"none\"\n", files.folder());
    EXPECT_EQ(count(findings_of(sink), "carried_outlet"), 0);
    flow::FlowField const drainage = flow::route(sink.terrain.ground.dem);
    EXPECT_EQ(drainage.depressions.size(), 1U);
    MakeResult const drained = made(lines + "inland = \"sink\"\n" + inland + "[surface]\n", files.folder());
    for (Check const& c : drained.assessment.checks) {
        EXPECT_TRUE(c.ok) << c.name << " " << c.value;
    }
    ASSERT_EQ(drained.assessment.sinks.size(), 1U);
    EXPECT_EQ(drained.terrain.rivers.network.planform.node(drained.assessment.sinks.front()).at,
              (Vec2{502000.0, 5001500.0}));
}

TEST(LandInEquilibrium, GivenHeightsGetTheSlopeThatIsAsked) {
    Files const files;
    for (std::string const heights : {"fixed", "soft"}) {
        for (double const slope : {8.0, 15.0, 30.0}) {
            MakeResult const t = made(lines + "heights = \"" + heights + "\"\nslope = 0.03\n" + path + "[surface]\n" +
                                          "mean_slope = " + std::to_string(slope) + "\n",
                                      files.folder());
            Check const& error = check_of(t, "mean_slope_error");
            EXPECT_TRUE(error.ok) << heights << " " << slope << ": " << error.value;
            EXPECT_NEAR(t.assessment.statistics->slope_true_deg, slope, 0.06 * slope) << heights;
        }
    }
}

TEST(LandInEquilibrium, ATargetThatRiversRuleOutFailsItsCheck) {
    Files const files;
    MakeResult const t =
        made(lines + "heights = \"fixed\"\nslope = 0.2\n" + path + "[surface]\nrelief = 100\n", files.folder());
    Check const& error = check_of(t, "relief_error");
    EXPECT_FALSE(error.ok);
    EXPECT_GT(error.value, 3.0); // rivers alone span more than 600 m
    EXPECT_TRUE(count(findings_of(t), "target_missed") == 1);
    MakeResult const met = made(lines + path + "[surface]\nrelief = 700\n", files.folder());
    EXPECT_TRUE(check_of(met, "relief_error").ok);
}

TEST(LandInEquilibrium, HeightsOfAFileAreKeptAndTheLandRisesToThem) {
    Files const files;
    std::string const high = "[network.lines]\npath = \"high.geojson\"\n";
    for (std::string const heights : {"heights = \"file\"\n", ""}) { // the default, where lines carry heights
        MakeResult const t = made(lines + heights + high + "[surface]\n", files.folder());
        EXPECT_EQ(t.recipe.network->heights, Heights::file);
        EXPECT_TRUE(check_of(t, "walled_cells").ok) << check_of(t, "walled_cells").value;
        EXPECT_LT(t.assessment.given_heights->most_off_m, 20.0); // the river falls by so much within a cell
        EXPECT_EQ(t.assessment.given_heights->missed, 0);
        auto const* const rebuilt = std::get_if<Rebuilt>(&t.terrain.ground.how);
        ASSERT_NE(rebuilt, nullptr);
        EXPECT_GT(rebuilt->river_spacing_m, 300.0);
        EXPECT_EQ(t.terrain.ground.equilibrium()->edge, surface::Edge::closed);
    }
    std::string said;
    thalweg::Run run;
    run.log = [&said](std::string_view line) { said += line; };
    MakeResult const gentle =
        made(lines + "[network.lines]\npath = \"falling.geojson\"\n[surface]\n", files.folder(), run);
    EXPECT_FALSE(test::has(said, "warning"));
    EXPECT_TRUE(test::has(said, "given at vertices"));
    EXPECT_EQ(gentle.recipe.network->heights, Heights::file);
    EXPECT_TRUE(check_of(gentle, "walled_cells").ok) << check_of(gentle, "walled_cells").value;
    EXPECT_FALSE(gentle.recipe.surface->equilibrium.mean_slope_deg) << "nobody asked for one";
    ASSERT_TRUE(gentle.assessment.given_heights);
    GivenHeights const& given = *gentle.assessment.given_heights;
    EXPECT_EQ(given.missed, 0);
    ASSERT_EQ(given.rivers.size(), 2U);
    EXPECT_EQ(given.rivers[0].vertices + given.rivers[1].vertices, given.vertices);
    EXPECT_EQ(given.rivers[0].most_off_m, given.most_off_m);
    EXPECT_GE(given.rivers[0].most_off_m, given.rivers[1].most_off_m);
    EXPECT_LE(given.median_off_m, given.p99_off_m);
    std::string const falling = "[network.lines]\npath = \"falling.geojson\"\n[surface]\n";
    EXPECT_FALSE(made(lines + "heights = \"graded\"\n" + falling, files.folder()).assessment.given_heights);
    EXPECT_FALSE(made(lines + "heights = \"ends\"\n" + falling, files.folder()).assessment.given_heights);
    EXPECT_FALSE(std::holds_alternative<Rebuilt>(
        made(lines + "heights = \"fixed\"\n" + falling, files.folder()).terrain.ground.how));
}

TEST(LandInEquilibrium, HeightsThatRiseByNoiseAreLoweredAndTold) {
    Files const files;
    std::string said;
    thalweg::Run run;
    run.log = [&said](std::string_view line) { said += line; };
    MakeResult const t = made(lines + "[network.lines]\npath = \"noisy.geojson\"\n[surface]\n", files.folder(), run);
    EXPECT_TRUE(test::has(said, "warning: heights in noisy.geojson rise downstream in 1 of 1 arcs", "by 3.5 m"));
    auto const& repairs = t.planform.findings;
    auto const lowered = std::ranges::find(repairs, std::string_view("lowered"), &Finding::kind);
    ASSERT_NE(lowered, repairs.end());
    EXPECT_EQ(lowered->amount, 3.5);
    EXPECT_EQ(lowered->feature, 1);
    EXPECT_TRUE(test::has(test::message_of([&] {
                              made(lines + "[network.lines]\npath = \"uphill.geojson\"\n[surface]\n", files.folder());
                          }),
                          "runs uphill between vertex 2 (61 m) and 3 (99 m)"));
}

TEST(LandInEquilibrium, HeightsOfAFileGetTheSlopeThatIsAsked) {
    Files const files;
    for (double const slope : {18.0, 25.0}) {
        MakeResult const t = made(lines + "[network.lines]\npath = \"falling.geojson\"\n[surface]\nmean_slope = " +
                                      std::to_string(slope) + "\n",
                                  files.folder());
        EXPECT_TRUE(check_of(t, "mean_slope_error").ok) << slope << ": " << check_of(t, "mean_slope_error").value;
    }
}

TEST(LandInEquilibrium, SideValleysAreCheckedLikeTheRest) {
    Files const files;
    MakeResult const t = made(lines + "fill_space = true\nsupport = 60\n" + path + equilibrium, files.folder());
    expect_lawful(t);
    EXPECT_GT(t.terrain.bed.grown, 30);
    std::int64_t grown = 0;
    for (ArcId arc = 0; arc < t.terrain.rivers.network.planform.arc_count(); ++arc) {
        grown += t.terrain.rivers.network.planform.arc(arc).is_input ? 0 : 1;
    }
    EXPECT_EQ(grown, t.terrain.bed.grown);
    EXPECT_EQ(t.assessment.relief->perched, 0);
}

TEST(LandInEquilibrium, RiversOfAFileStayUnlessAskedToMeander) {
    Files const files;
    MakeResult const still = made(lines + path + equilibrium, files.folder());
    MakeResult const bent = made(lines + "meander = 1\n" + path + equilibrium, files.folder());
    expect_lawful(bent);
    EXPECT_EQ(still.recipe.network->meander, 0.0);
    auto const length = [](MakeResult const& t) {
        auto const of_arcs = t.terrain.rivers.network.planform.length_m();
        return std::accumulate(of_arcs.begin(), of_arcs.end(), 0.0);
    };
    EXPECT_GT(length(bent), 1.005 * length(still));
}

TEST(LandInEquilibrium, TwoRiversInOneCellBecomeOne) {
    Files const files;
    MakeResult const t =
        made(lines + "[network.lines]\npath = \"double.geojson\"\nsnap = 0.001\n" + equilibrium, files.folder());
    EXPECT_GE(count(findings_of(t), "captured"), 1);
    for (Check const& c : t.assessment.checks) { // two rivers in one cell cannot both be followed cell for cell
        bool const beside_another = c.name == "walled_cells"; // cells of one stand a step above those of the other
        EXPECT_TRUE(c.ok == (c.name != "trace_f_same_cell") || beside_another) << c.name << " " << c.value;
    }
}

TEST(LandInEquilibrium, ARiverAlongTheBorderIsReported) {
    Files const files;
    MakeResult const t = made(lines + "[network.lines]\npath = \"border.geojson\"\n" + equilibrium, files.folder());
    auto const found = std::ranges::find(t.assessment.findings, std::string_view("border_cell"), &Finding::kind);
    ASSERT_NE(found, t.assessment.findings.end());
    EXPECT_LT(found->where.x, 500030.0);
    EXPECT_FALSE(t.assessment.passed());
}

TEST(LandInEquilibrium, HeightsThatRiseAreLowered) {
    Files const files;
    MakeResult const t = made(lines + "heights = \"straight\"\nslope = 0.08\n" + path + equilibrium, files.folder());
    for (std::vector<double> const& z : t.terrain.rivers.network.arc_z) {
        EXPECT_TRUE(std::is_sorted(z.rbegin(), z.rend()));
    }
}

// Scales are in metres: smaller cells show the same terrain in more detail.
TEST(LandInEquilibrium, OtherCellsAreTheSameLand) {
    Recipe recipe = recipe_from(THALWEG_SOURCE_DIR "/samples/relief_lines.toml");
    struct Figures {
        double theta;
        double density_per_m;
        double mean_slope_deg;
    };
    std::vector<Figures> of_cells;
    for (double const cell_m : {60.0, 30.0, 15.0}) {
        constexpr double support_m2 = 180'000.0;
        recipe.grid.cell_m = cell_m;
        MakeResult const land = make::make(recipe);
        Raster<float> const& dem = land.terrain.ground.dem;
        measure::Relief const relief =
            measure::relief(dem, land.terrain.water.drainage, measure::statistics(dem),
                            {.support_cells = static_cast<std::int64_t>(support_m2 / (cell_m * cell_m))});
        of_cells.push_back({-relief.slope_area->exponent, relief.drainage_density, relief.slopes.mean_deg});
    }
    Figures const& middle = of_cells[1];
    for (Figures const& at : of_cells) {
        EXPECT_NEAR(at.theta, middle.theta, 0.1 * middle.theta);
        EXPECT_NEAR(at.density_per_m, middle.density_per_m, 0.1 * middle.density_per_m);
        EXPECT_NEAR(at.mean_slope_deg, middle.mean_slope_deg, 0.1 * middle.mean_slope_deg);
    }
}

TEST(LandInEquilibrium, RiversOfAnIslandMeetAtAcuteAngles) {
    MakeResult const land = make::make(recipe_from(THALWEG_SOURCE_DIR "/samples/island.toml"));
    measure::JunctionAngles const angles = measure::junction_angles(land.terrain.rivers.network.planform, 300.0);
    EXPECT_GT(angles.junctions, 20);
    EXPECT_GT(angles.mean_deg, 45.0);
    EXPECT_LT(angles.mean_deg, 90.0);
}

/// Law: with closed edges a forest's basins tile the map: water leaves it at the outlets alone, from every cell.
TEST(LandInEquilibrium, AForestTilesALargeMap) {
    Files const files;
    MakeResult const t = made("[grid]\nwidth = 2048\nheight = 2048\n[network]\nsource = \"forest\"\nprune = 20\n"
                              "[surface]\nedge = \"closed\"\n",
                              files.folder());
    expect_lawful(t);
    std::vector<std::int64_t> outlets;
    for (NodeId const n : t.terrain.rivers.network.planform.outlets()) {
        outlets.push_back(t.terrain.grid.index(t.terrain.grid.cell_of(t.terrain.rivers.network.planform.node(n).at)));
    }
    EXPECT_GT(outlets.size(), 50U);
    flow::FlowField const drainage = flow::route(t.terrain.ground.dem);
    std::int64_t drained = 0;
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        if (!goes_on(drainage.direction[i])) {
            EXPECT_EQ(std::ranges::count(outlets, i), 1) << t.terrain.grid.at(i).col << " " << t.terrain.grid.at(i).row;
            drained += drainage.area_cells[i];
        }
    }
    EXPECT_EQ(drained, t.terrain.grid.cells());
}

} // namespace land_in_equilibrium_test
