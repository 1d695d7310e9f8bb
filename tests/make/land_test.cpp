// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <make/made.hpp>

namespace land_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

using test::made;

std::string const rivers = "[grid]\nwidth = 160\nheight = 120\n[network]\nprune = 6\n[network.dla]\nparticles = 3000\n";

/// What make logs of these increments.
std::string said(std::string const& increment) {
    std::string words;
    Run run;
    run.log = [&words](std::string_view line) { words += std::string(line) + "\n"; };
    std::string const surface = "[surface]\nmethod = \"dilate\"\nrelief = 100\nincrement = \"";
    make::make(read_recipe(rivers + surface + increment + "\"\n", "test"), run);
    return words;
}

void expect_valley_kept(MakeResult const& t) {
    ValleyCells const& valley = t.terrain.bed.valley;
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        ASSERT_TRUE(std::isfinite(t.terrain.ground.dem[i]));
    }
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        ASSERT_EQ(valley.z[i], t.terrain.ground.dem[valley.cell[i]]);
    }
    EXPECT_GT(valley.cell.size(), 100U);
    EXPECT_TRUE(t.assessment.passed());
}

/// Greatest step between a cell and its eastern or southern neighbour [m].
double greatest_step(Raster<float> const& dem) {
    double step = 0.0;
    for (std::int64_t r = 0; r + 1 < dem.height(); ++r) {
        for (std::int64_t c = 0; c + 1 < dem.width(); ++c) {
            float const z = dem[Cell{c, r}];
            step = std::max({step, static_cast<double>(std::fabs(z - dem[Cell{c + 1, r}])),
                             static_cast<double>(std::fabs(z - dem[Cell{c, r + 1}]))});
        }
    }
    return step;
}

/// A folder with points of a tilted, bumpy plain on 60 x 40 cells of 30 m.
class PointsFile {
public:
    PointsFile() {
        std::ofstream out(folder_ / std::string("points.csv"));
        out.precision(12);
        out << "x,y,z\n";
        for (std::uint64_t i = 0; i < 150; ++i) {
            auto const words = random_block(5, i);
            // Corners first: the points' hull is the ground.
            double const x = i < 4 ? (i % 2 == 0 ? 0.0 : 1799.0) : 1799.0 * unit(words[0]);
            double const y = i < 4 ? (i < 2 ? 1.0 : 1199.0) : 1.0 + 1198.0 * unit(words[1]);
            out << 500000.0 + x << "," << 4000000.0 + y << "," << 100.0 + 0.05 * x + 20.0 * unit(words[2]) << "\n";
        }
    }
    std::string folder() const { return folder_.path().string(); }

private:
    ScratchFolder folder_;
};

std::string const from_points =
    "[grid]\nwidth = 60\nheight = 40\norigin = [500000, 4001200]\n[skeleton]\npoints = \"points.csv\"\n";

} // namespace

TEST(Land, OverTheTrianglesOfRivers) {
    MakeResult const t = made(rivers + "[surface]\nmethod = \"tin\"\n");
    expect_valley_kept(t);
    ASSERT_TRUE(!t.terrain.ground.tin.vertices.empty());
    double low = t.terrain.rivers.network.node_z[0];
    double high = low;
    for (double const z : t.terrain.rivers.network.node_z) {
        low = std::min(low, z);
        high = std::max(high, z);
    }
    EXPECT_GE(t.assessment.statistics->min.z, low - 1e-3);
    EXPECT_LE(t.assessment.statistics->max.z, high + 1e-3);
    for (ArcId arc = 0; arc < t.terrain.rivers.network.planform.arc_count(); ++arc) {
        for (Vec2 const p : t.terrain.rivers.network.planform.arc(arc).line) {
            EXPECT_TRUE(std::any_of(t.terrain.ground.tin.vertices.begin(), t.terrain.ground.tin.vertices.end(),
                                    [&](Vec3 const& v) { return v.x == p.x && v.y == p.y; }));
        }
    }
}

TEST(Land, ABaseOfTrianglesTakesTheScarpsAway) {
    MakeResult const paper =
        made(rivers + "[surface]\nmethod = \"dilate\"\nmetric = \"euclid\"\nrelief = 300\nbase = \"paper\"\n");
    MakeResult const smooth =
        made(rivers + "[surface]\nmethod = \"dilate\"\nmetric = \"euclid\"\nrelief = 300\nbase = \"tin\"\n");
    expect_valley_kept(paper);
    expect_valley_kept(smooth);
    EXPECT_FALSE(!paper.terrain.ground.tin.vertices.empty());
    EXPECT_LT(greatest_step(smooth.terrain.ground.dem), 0.5 * greatest_step(paper.terrain.ground.dem));
    MakeResult const harmonic =
        made(rivers + "[surface]\nmethod = \"dilate\"\nmetric = \"euclid\"\nrelief = 300\n"); // the default
    expect_valley_kept(harmonic);
    EXPECT_FALSE(!harmonic.terrain.ground.tin.vertices.empty());
    EXPECT_LT(greatest_step(harmonic.terrain.ground.dem), 0.5 * greatest_step(paper.terrain.ground.dem));
    Raster<float> const base = surface::rasterise_tin(smooth.terrain.ground.tin, smooth.terrain.grid);
    for (std::int64_t i = 0; i < smooth.terrain.grid.cells(); ++i) {
        EXPECT_TRUE(std::isnan(base[i]) || has_river(smooth.terrain.bed.valley, i) ||
                    smooth.terrain.ground.dem[i] > base[i] - 1e-3F);
    }
}

TEST(Land, ClustersStopAtTheirRadius) {
    MakeResult const free = made(rivers);
    MakeResult const bound = made(rivers + "radius = 40\n");
    EXPECT_FALSE(free.planform.statistics.wide);
    EXPECT_EQ(free.planform.statistics.particles, 3000);
    EXPECT_TRUE(bound.planform.statistics.wide);
    EXPECT_LT(bound.planform.statistics.particles, 3000);
}

TEST(Land, IncrementsThatJumpAreWarnedOf) {
    EXPECT_TRUE(test::has(said("x<=10 ? 0.1*x : 6-0.1*x"), "jumps from 1 to 5 at x = 10"));
    EXPECT_FALSE(test::has(said("x<=30 ? 0.1*x : 6-0.1*x"), "jumps"));
    EXPECT_FALSE(test::has(said("rise_fall"), "jumps"));
}

TEST(Land, RidgesAskedForAreComparedWithThoseOfTheSurface) {
    std::string const tokunaga = "[grid]\nwidth = 200\nheight = 200\n[network]\nsource = \"tokunaga\"\n"
                                 "[network.tokunaga]\norder = 3\n[surface]\nmethod = \"diffuse\"\n";
    EXPECT_FALSE(made(tokunaga).assessment.surface_ridges);
    MakeResult const t = made(tokunaga + "[skeleton]\nridges = \"segments\"\n");
    ASSERT_TRUE(t.assessment.surface_ridges);
    EXPECT_GT(t.assessment.surface_ridges->ridge_cells, 500);
    measure::Agreements const& found = t.assessment.surface_ridges->extracted;
    EXPECT_GT(found[1].f(), 0.4);
    EXPECT_GE(found[2].f(), found[1].f());
    EXPECT_GE(found[1].f(), found[0].f());
}

TEST(Land, RandomPointsBetweenTheRivers) {
    std::string const skeleton = "[skeleton]\nscatter = 120\nspacing = 3\nridge_gain = 0.4\n";
    std::string const detail = "[detail]\nsigma = 8\nlevels = 3\n";
    for (std::string const& how :
         {std::string("method = \"dilate\"\nrelief = 200\nbase = \"tin\"\n"),
          "method = \"dilate\"\nrelief = 200\nbase = \"tin\"\n" + detail, std::string("method = \"tin\"\n"),
          "method = \"tin\"\n" + detail, std::string("method = \"diffuse\"\n")}) {
        MakeResult const plain = made(rivers + "[surface]\n" + how);
        MakeResult const with = made(rivers + skeleton + "[surface]\n" + how);
        expect_valley_kept(with);
        ASSERT_TRUE(with.assessment.certificate) << how;
        EXPECT_TRUE(test::same_bits(plain.terrain.bed.valley.raster(), with.terrain.bed.valley.raster()))
            << how; // rivers ignore points
        if (!plain.terrain.ground.tin.vertices.empty()) {
            EXPECT_EQ(with.terrain.ground.tin.vertices.size(), plain.terrain.ground.tin.vertices.size() + 120) << how;
        }
        EXPECT_GT(with.assessment.statistics->mean, plain.assessment.statistics->mean + 1.0) << how;
    }
    MakeResult const crowded = made(rivers + "[skeleton]\nscatter = 600\nspacing = 5\n[surface]\nmethod = \"tin\"\n");
    EXPECT_FALSE(crowded.assessment.passed()); // with as many as have room, which is reported
    for (Check const& c : crowded.assessment.checks) {
        EXPECT_EQ(c.ok, c.name != "points_missing") << c.name;
    }
}

TEST(Land, DetailLeavesTheRiversAlone) {
    std::string const surface = "[surface]\nmethod = \"dilate\"\nmetric = \"euclid\"\nrelief = 300\n";
    MakeResult const smooth = made(rivers + surface);
    MakeResult const rough = made(rivers + surface + "[detail]\nsigma = 20\nlevels = 4\n");
    expect_valley_kept(rough);
    double square = 0.0;
    for (std::int64_t i = 0; i < smooth.terrain.grid.cells(); ++i) {
        double const off =
            static_cast<double>(rough.terrain.ground.dem[i]) - static_cast<double>(smooth.terrain.ground.dem[i]);
        square += off * off / static_cast<double>(smooth.terrain.grid.cells());
    }
    EXPECT_GT(square, 1.0);
    EXPECT_LT(square, 400.0);
    EXPECT_THROW(made(rivers + surface + "[detail]\n"), BadParameter);
}

TEST(Land, TheSkeletonsTrianglesAloneChangeNothing) {
    MakeResult const plain = made(rivers + "[surface]\n");
    MakeResult const with = made(rivers + "[skeleton]\ntin = true\n[surface]\n");
    EXPECT_TRUE(!with.terrain.ground.tin.vertices.empty());
    EXPECT_TRUE(test::same_bits(plain.terrain.ground.dem, with.terrain.ground.dem));
}

TEST(Land, ATurnedClusterIsFramedWhole) {
    std::set<std::size_t> arcs;
    for (char const* rotate : {"0", "33", "100", "-170", "-80"}) {
        std::string const grown =
            std::string("[network]\nprune = 6\nrotate = ") + rotate + "\n[network.dla]\nparticles = 3000\n";
        Planform const turned = make_planform(resolve(read_recipe(grown, "test")));
        arcs.insert(turned.network.arc_count());
    }
    EXPECT_EQ(arcs.size(), 1U);
}

TEST(Land, ThroughPoints) {
    PointsFile const file;
    for (char const* how : {"", "[surface]\nmethod = \"tin\"\ninterpolation = \"natural\"\n",
                            "[surface]\nmethod = \"regress\"\n", "[detail]\nlevels = 2\n"}) {
        MakeResult const t = made(from_points + how, file.folder());
        EXPECT_TRUE(t.assessment.passed());
        EXPECT_EQ(t.assessment.statistics->nodata, 0);
        EXPECT_NEAR(t.assessment.statistics->mean, 155.0, 8.0) << how;
        EXPECT_EQ(t.recipe.grid.crs, "EPSG:32631");
    }
    MakeResult const framed = made("[skeleton]\npoints = \"points.csv\"\n", file.folder());
    EXPECT_GE(framed.terrain.grid.width, 60);
    EXPECT_GE(framed.terrain.grid.height, 40);
}

TEST(Land, StatisticsWithGivenPointsKept) {
    PointsFile const file;
    MakeResult const t =
        made(from_points + "[statistics]\nskeleton = \"points\"\nstd = 30\ndimension = 2.3\n", file.folder());
    EXPECT_TRUE(t.assessment.passed());
    EXPECT_NEAR(t.assessment.statistics->std, 30.0, 0.3);
    EXPECT_NEAR(t.assessment.statistics->dimension, 2.3, 0.02);
    std::ifstream in(file.folder() + "/points.csv");
    std::string line;
    std::getline(in, line);
    std::vector<bool> seen(static_cast<std::size_t>(t.terrain.grid.cells()), false);
    while (std::getline(in, line)) {
        double x = 0.0;
        double y = 0.0;
        double z = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &x, &y, &z), 3);
        auto const i = t.terrain.grid.index(t.terrain.grid.cell_of({x, y}));
        if (!seen[static_cast<std::size_t>(i)]) { // the first of a cell counts
            EXPECT_NEAR(static_cast<double>(t.terrain.ground.dem[i]), z, 1e-3);
        }
        seen[static_cast<std::size_t>(i)] = true;
    }
}

TEST(Land, EveryPriorMeetsTable4) {
    std::string const table =
        "[grid]\nwidth = 130\nheight = 40\ncell = 300\n[statistics]\nmean = 536\nstd = 131.6\nmax = [1038, 91, 1]\n"
        "min = [276, 129, 26]\nlength = [20.68, 39.74]\nslope = 1.499\ndimension = 2.39\n";
    for (char const* how : {"skeleton = \"grf\"\n", "skeleton = \"separable\"\n", "skeleton = \"markov3\"\n",
                            "skeleton = \"markov3\"\n[detail]\nlevels = 3\nstencil = 4\n",
                            "skeleton = \"points\"\n[skeleton]\nscatter = 180\nspacing = 3\n[detail]\nlevels = 2\n",
                            "skeleton = \"points\"\n[skeleton]\nscatter = 180\n[surface]\nmethod = \"regress\"\n"
                            "[detail]\nlevels = 3\n"}) {
        MakeResult const t = made(table + how);
        EXPECT_TRUE(t.assessment.passed()) << how;
        EXPECT_LE(t.terrain.ground.matched->fine_forms_cells, 1.0) << how;
        EXPECT_EQ(t.assessment.statistics->max.z, 1038.0);
        EXPECT_EQ(t.assessment.statistics->max.cell, (Cell{91, 1}));
        EXPECT_EQ(t.assessment.statistics->min.z, 276.0);
        EXPECT_EQ(t.assessment.statistics->min.cell, (Cell{129, 26}));
        EXPECT_EQ(std::count(t.terrain.ground.dem.values().begin(), t.terrain.ground.dem.values().end(), 1038.0F), 1);
        EXPECT_EQ(std::count(t.terrain.ground.dem.values().begin(), t.terrain.ground.dem.values().end(), 276.0F), 1);
        EXPECT_NEAR(t.assessment.statistics->std, 131.6, 1.3);
        EXPECT_NEAR(t.assessment.statistics->lx.cells, 20.68, 0.2);
        EXPECT_NEAR(t.assessment.statistics->ly.cells, 39.74, 0.4);
        EXPECT_NEAR(t.assessment.statistics->slope_rad, 1.499, 0.015);
        EXPECT_NEAR(t.assessment.statistics->dimension, 2.39, 0.02);
    }
}

} // namespace land_test
