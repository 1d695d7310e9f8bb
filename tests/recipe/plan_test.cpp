// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/plan.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/frame.hpp>

#include <recipe/old_recipes.hpp>

namespace plan_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

using test::has;
using test::message_of;
using test::on_threads;

void expect_same_lines(RiverLines const& a, RiverLines const& b) {
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) {
        EXPECT_EQ(a.lines[i].feature, b.lines[i].feature);
        EXPECT_TRUE(std::equal(a.lines[i].vertices.begin(), a.lines[i].vertices.end(), b.lines[i].vertices.begin(),
                               b.lines[i].vertices.end(),
                               [](Vec3 p, Vec3 q) { return p.x == q.x && p.y == q.y && !(p.z < q.z || p.z > q.z); }));
    }
}

void expect_as_forecast(Recipe const& recipe, std::string const& name) {
    Forecast const said = forecast(recipe);
    MakeResult const made = make::make(recipe);
    std::vector<std::string> stages;
    for (StageTime const& time : timings_of(made)) {
        stages.push_back(time.stage);
    }
    EXPECT_EQ(said.stages, stages) << name;
    if (said.grid) {
        EXPECT_EQ(*said.grid, made.terrain.grid) << name;
        EXPECT_EQ(said.cells, made.terrain.grid.cells()) << name;
    }
    EXPECT_GT(said.cells, 0) << name;
    EXPECT_GT(said.memory_bytes, 10 * said.cells) << name;
    EXPECT_GT(said.seconds, 0.0) << name;
}

RiverLines one_river(std::vector<Vec3> vertices) {
    RiverLines lines;
    lines.lines.push_back({3, std::move(vertices), "", 0});
    lines.crs = "EPSG:32631";
    lines.name = "rivers.gpkg";
    return lines;
}

/// Two rivers of 40 vertices each, a few kilometres long.
RiverLines two_rivers() {
    RiverLines rivers;
    rivers.name = "rivers.gpkg";
    for (int r = 0; r < 2; ++r) {
        RiverLine& line = rivers.lines.emplace_back();
        line.feature = r + 1;
        for (int i = 0; i < 40; ++i) {
            line.vertices.push_back({500000.0 + 90.0 * i + 20.0 * (i % 3), 4500000.0 + 2000.0 * r + 60.0 * i, 0.0});
        }
    }
    return rivers;
}

} // namespace

TEST(Resolve, RefusesAnEmptyRecipeAndAMissingFile) {
    EXPECT_THROW(resolve(Recipe{}), BadParameter);
    Recipe recipe = cluster_recipe();
    set_key(recipe, "surface.mask=nowhere.tif");
    EXPECT_THROW(resolve(recipe), BadInput);
}

// Law: the same recipe and files give the same plan.
TEST(Resolve, TwiceGivesTheSamePlan) {
    for (std::string const& name : old_recipe_names()) {
        SCOPED_TRACE(name);
        Recipe const recipe = old_recipe(name);
        Plan const one = resolve(recipe);
        Plan const two = resolve(recipe, on_threads(1));
        EXPECT_EQ(write_recipe(one.recipe), write_recipe(two.recipe));
        EXPECT_EQ(one.grid, two.grid);
        EXPECT_EQ(one.heights_of_file, two.heights_of_file);
        expect_same_lines(one.lines, two.lines);
        EXPECT_EQ(one.tree ? one.tree->links.size() : 0U, two.tree ? two.tree->links.size() : 0U);
        EXPECT_EQ(one.forest ? one.forest->outlets : std::vector<Cell>{},
                  two.forest ? two.forest->outlets : std::vector<Cell>{});
        EXPECT_EQ(one.points.points, two.points.points);
        EXPECT_EQ(forecast(one).stages, forecast(two).stages);
        EXPECT_EQ(forecast(one).memory_bytes, forecast(two).memory_bytes);
        // A plan's recipe is a recipe of its own, with the same plan.
        Recipe planned = one.recipe;
        planned.set_at.clear(); // what follows from others need not have an effect of its own
        EXPECT_EQ(write_recipe(resolve(planned).recipe), write_recipe(planned));
    }
}

TEST(Resolve, SettlesWhatTheRecipeLeavesOpen) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 0;
    recipe.grid.height = 0;
    Plan const grown = resolve(recipe);
    EXPECT_FALSE(grown.grid); // it follows from a cluster
    EXPECT_EQ(grown.recipe.network->heights, Heights::graded);
    EXPECT_EQ(grown.recipe.network->meander, 1.0);
    EXPECT_TRUE(grown.recipe.network->rotate_deg);
    EXPECT_EQ(grown.recipe.surface->equilibrium.mean_slope_deg, 25.0);
    EXPECT_EQ(grown.recipe.surface->drain, flow::Conditioning::carve);
    EXPECT_FALSE(grown.recipe.grid.crs.empty());
    EXPECT_EQ(grown.recipe.network->dla.seed, recipe.seed);

    Recipe lines = old_recipe("equilibrium_lines");
    lines.grid.cell_m = 0.0;
    Plan const drawn = resolve(lines);
    ASSERT_TRUE(drawn.grid);
    EXPECT_GT(drawn.recipe.grid.cell_m, 0.0);
    EXPECT_EQ(drawn.grid->cell_m, drawn.recipe.grid.cell_m);
    EXPECT_EQ(drawn.grid->crs, drawn.recipe.grid.crs);
    EXPECT_FALSE(drawn.lines.lines.empty());
    EXPECT_EQ(drawn.timings_s.front().stage, "read");
}

TEST(Resolve, AnIslandHasItsCoastBeforeItsRivers) {
    Plan const plan = resolve(read_recipe("[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"forest\"\n"
                                          "[network.forest]\nshape = \"island\"\n[surface]\n",
                                          "r.toml"));
    ASSERT_TRUE(plan.forest);
    EXPECT_TRUE(plan.forest->has_sea);
    EXPECT_FALSE(plan.forest->outlets.empty());
    EXPECT_EQ(plan.recipe.network->meander, 0.3); // short rivers bend less
}

TEST(Forecast, RefusesWhatMakeRefuses) {
    EXPECT_THROW(forecast(Recipe{}), BadParameter); // no terrain
    auto const refused = [](std::vector<std::string> const& settings) {
        Recipe recipe = cluster_recipe();
        for (std::string const& setting : settings) {
            set_key(recipe, setting);
        }
        return message_of([&] { forecast(recipe); });
    };
    EXPECT_NE(refused({"network.source=lines"}), ""); // no file
    EXPECT_TRUE(has(refused({"surface.erodibility=nowhere.tif"}), "surface.erodibility = \"nowhere.tif\""));
    EXPECT_TRUE(has(refused({"patch.1.source=nowhere.tif",
                             "patch.2.source=" + (old_recipes / "statistics_grf/recipe.toml").string()}),
                    "patch.1.source = \"nowhere.tif\""));
    EXPECT_NE(refused({"grid.width=1000000", "grid.height=1000000"}), ""); // more memory than any machine has
}

// Law: a run times these stages in this order, on this grid.
TEST(Forecast, IsWhatARunDoes) {
    EXPECT_EQ(old_recipe_names().size(), 5U);
    for (std::string const& name : old_recipe_names()) {
        expect_as_forecast(old_recipe(name), name);
    }
}

TEST(Forecast, NamesTheStagesOfEverySample) {
    std::filesystem::path const samples = std::filesystem::path(THALWEG_SOURCE_DIR) / "samples";
    int count = 0;
    for (auto const& file : std::filesystem::directory_iterator(samples)) {
        if (file.path().extension() == ".toml") {
            Recipe recipe = read_recipe(test::bytes_of(file.path().string()), file.path().string());
            recipe.folder = samples.string();
            expect_as_forecast(recipe, file.path().filename().string());
            ++count;
        }
    }
    EXPECT_GE(count, 15);
}

TEST(Forecast, NamesTheComparisonWithADem) {
    std::string const samples = THALWEG_SOURCE_DIR "/samples/";
    Recipe const recipe = read_recipe("[grid]\ncell = 240\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"" +
                                          samples + "bigtujunga_rivers.fgb\"\n[surface]\n[output]\nagainst = \"" +
                                          samples + "bigtujunga_srtm1.tif\"\n",
                                      "r.toml");
    EXPECT_EQ(forecast(recipe).stages.back(), "compare");
    expect_as_forecast(recipe, "against");
}

TEST(Forecast, OfSettingsThatAddStages) {
    for (std::vector<std::string> const& settings : std::vector<std::vector<std::string>>{
             {"network.fill_space=true", "output.accumulation=true"},
             {"network.heights=soft", "network.slope=0.01", "output.catchments=false"},
             {"surface.drain=none"},
             {"network.meander=0.5"}}) {
        Recipe recipe = old_recipe("equilibrium_lines");
        for (std::string const& setting : settings) {
            set_key(recipe, setting);
        }
        expect_as_forecast(recipe, settings.front());
    }
    Recipe recipe = old_recipe("equilibrium_lines");
    recipe.grid.cell_m = 0.0;
    expect_as_forecast(recipe, "a cell chosen from the rivers");
    std::string const points = "[skeleton]\nscatter = 40\nspacing = 3\n[surface]\nmethod = ";
    for (std::string const& toml :
         {points + "\"tin\"\n", points + "\"diffuse\"\n", points + "\"regress\"\n",
          std::string("[network]\nsource = \"forest\"\nprune = 6\n[surface]\n"),
          std::string(
              "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 3\n[surface]\nmethod = \"diffuse\"\n"),
          std::string("[network]\nprune = 5\n[network.dla]\nparticles = 1500\n[surface]\n[detail]\nsigma = 20\n")}) {
        expect_as_forecast(read_recipe("[grid]\nwidth = 64\nheight = 64\ncell = 30\n" + toml, "r.toml"), toml);
    }
}

// A cluster's grid is known where it is given, and guessed within a factor of three elsewhere.
TEST(Forecast, OfAGridThatIsStillUnknown) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 0;
    recipe.grid.height = 0;
    set_key(recipe, "network.dla.particles=20000");
    recipe.surface.reset();
    Forecast const said = forecast(recipe);
    EXPECT_FALSE(said.grid);
    auto const ratio = static_cast<double>(said.cells) / static_cast<double>(make::make(recipe).terrain.grid.cells());
    EXPECT_GT(ratio, 1.0 / 3.0);
    EXPECT_LT(ratio, 3.0);
}

TEST(Frame, MemoryIsAskedBeforeTheWork) {
    EXPECT_NO_THROW(check_memory(10, 10));
    EXPECT_THROW(check_memory(1000000, 1000000), BadInput);
    EXPECT_NO_THROW(check_memory_of_cluster(10));
    EXPECT_THROW(check_memory_of_cluster(std::int64_t{1} << 50), BadInput);
}

TEST(Frame, OneCell) {
    FramedBranch const framed = frame_branch({{{5, -7}}, false}, {});
    EXPECT_EQ(framed.mask.width(), 5);
    EXPECT_EQ(framed.mask.height(), 5);
    EXPECT_EQ(framed.mouth, framed.mask.grid().centre({-3, 9}));
}

TEST(Frame, ABranchIsKeptWholeAndItsFrameGivesItselfAgain) {
    ASSERT_TRUE(rc::check("box and at least 5 % around it; the same grid when it is asked for", [] {
        growth::Branch branch;
        auto const cells = *rc::gen::inRange(1, 60);
        for (int i = 0; i < cells; ++i) {
            branch.cells.push_back(
                {*rc::gen::inRange<std::int64_t>(-90, 90), *rc::gen::inRange<std::int64_t>(-90, 90)});
        }
        FramedBranch const framed = frame_branch(branch, {});
        Grid const& grid = framed.mask.grid();
        Cell const seed = grid.cell_of(framed.mouth);
        std::int64_t set = 0;
        for (std::uint8_t const v : framed.mask.values()) {
            set += v;
        }
        auto const less = [](Cell a, Cell b) { return a.row != b.row ? a.row < b.row : a.col < b.col; };
        std::sort(branch.cells.begin(), branch.cells.end(), less);
        auto const distinct = std::unique(branch.cells.begin(), branch.cells.end()) - branch.cells.begin();
        RC_ASSERT(set == distinct);
        for (Cell const& c : branch.cells) {
            RC_ASSERT((framed.mask[Cell{c.col + seed.col, c.row + seed.row}]) == 1);
            RC_ASSERT(!grid.on_border({c.col + seed.col, c.row + seed.row}));
        }
        GridRecipe asked;
        asked.width = grid.width;
        asked.height = grid.height;
        asked.origin = {grid.west, grid.north};
        FramedBranch const again = frame_branch(branch, asked);
        RC_ASSERT(again.mask.grid() == grid);
        RC_ASSERT(again.mouth == framed.mouth);
        auto const [low, high] =
            std::minmax_element(branch.cells.begin(), branch.cells.end(), [](Cell a, Cell b) { return a.col < b.col; });
        RC_ASSERT(high->col - low->col + 1 <= room_for_network(grid.width));
    }));
}

TEST(Frame, LinesGetTheirBoxAndAMarginOnWholeCells) {
    RiverLines const lines = one_river({{1005.0, 2003.0, 0.0}, {1995.0, 2503.0, 0.0}});
    GridRecipe wanted;
    wanted.cell_m = 10.0;
    Grid const grid = frame_lines(lines, wanted);
    EXPECT_EQ(grid.west, 950.0);
    EXPECT_GE(grid.east(), 1995.0 + 49.5);
    EXPECT_GE(grid.north, 2503.0 + 49.5);
    EXPECT_LE(grid.south(), 2003.0 - 49.5);
    EXPECT_EQ(grid.crs, "EPSG:32631");
    wanted.width = grid.width;
    wanted.height = grid.height;
    wanted.origin = {grid.west, grid.north};
    EXPECT_EQ(frame_lines(lines, wanted), grid);
}

TEST(Frame, LinesOutsideAreRefusedByNameUnlessClipped) {
    RiverLines const lines = one_river({{1005.0, 2003.0, 0.0}, {1995.0, 2503.0, 0.0}});
    GridRecipe wanted;
    wanted.cell_m = 10.0;
    wanted.width = 20;
    wanted.height = 20;
    EXPECT_TRUE(has(message_of<BadInput>([&] { frame_lines(lines, wanted); }), "river 3 in rivers.gpkg"));
    wanted.clip = true;
    EXPECT_EQ(frame_lines(lines, wanted).width, 20);
    wanted = {};
    wanted.cell_m = 1e-6;
    EXPECT_THROW(frame_lines(lines, wanted), BadInput) << "a billion columns";
    wanted.cell_m = 10.0;
    wanted.origin = {5000.0, 5000.0};
    EXPECT_THROW(frame_lines(lines, wanted), BadInput);
}

TEST(StrayVertex, FewVerticesAndLinesThatReachFarInStepsStay) {
    EXPECT_NO_THROW(require_no_stray_vertex({}));
    EXPECT_NO_THROW(require_no_stray_vertex(one_river({{0.0, 0.0, 0.0}, {500000.0, 0.0, 0.0}, {500010.0, 0.0, 0.0}})));
    EXPECT_NO_THROW(require_no_stray_vertex(two_rivers()));
    RiverLines far = two_rivers();
    for (int i = 0; i < 10; ++i) {
        far.lines[0].vertices.push_back({504000.0 + 20000.0 * i, 4503000.0, 0.0});
    }
    EXPECT_NO_THROW(require_no_stray_vertex(far));
}

TEST(StrayVertex, ALostCoordinateIsNamed) {
    for (Vec3 const lost : {Vec3{0.0, 4500100.0, 0.0}, Vec3{500100.0, 0.3, 0.0}, Vec3{0.0, 0.0, 0.0},
                            Vec3{5.0e6, 4500100.0, 0.0}, Vec3{500100.0, 4.5e7, 0.0}}) {
        RiverLines rivers = two_rivers();
        rivers.lines[1].vertices[17] = lost;
        EXPECT_TRUE(has(message_of<BadInput>([&] { require_no_stray_vertex(rivers); }),
                        "river 2 in rivers.gpkg has a vertex at"))
            << lost.x << " " << lost.y;
    }
}

} // namespace plan_test
