// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace recipe_test {

using namespace thalweg;
using namespace thalweg::recipe;

namespace {

using test::bytes_of;
using test::has;
using test::message_of;

std::string fault_of(std::string const& toml) {
    return message_of<BadParameter>([&] { check_recipe(read_recipe(toml, "r.toml")); });
}

std::string sample(std::string const& name) {
    return bytes_of(THALWEG_SOURCE_DIR "/samples/" + name);
}

/// The least number of levels that is enough.
std::size_t depth_of(std::string const& toml) {
    std::size_t most = 0;
    while (line_deeper_than(toml, most)) {
        ++most;
    }
    return most;
}

/// Names in docs that begin as keys do: files, and places in report.json.
std::set<std::string> const other_names = {"network.gpkg", "network.laws", "network.uphill_before_repair",
                                           "statistics.fine_forms_cells", "statistics.residuals"};

std::set<std::string> keys_and_sections() {
    std::set<std::string> names = other_names;
    for (KeyHelp const& key : recipe_keys()) {
        for (std::size_t dot = key.path.find('.'); dot != std::string::npos; dot = key.path.find('.', dot + 1)) {
            names.insert(key.path.substr(0, dot));
        }
        names.insert(key.path);
    }
    return names;
}

} // namespace

TEST(Recipe, SectionLeftOutIsStageLeftOut) {
    Recipe const recipe = read_recipe("[network]\n", "r.toml");
    EXPECT_TRUE(recipe.network);
    EXPECT_FALSE(recipe.surface);
    EXPECT_FALSE(read_recipe("", "r.toml").network);
    EXPECT_TRUE(has(fault_of(""), "give [network]"));
}

TEST(Recipe, WrittenRecipeReadsBack) {
    Recipe recipe = default_recipe();
    recipe.grid.origin = {1.0 / 3.0, -2.5e6};
    recipe.network->prune_cells = 0.1;
    recipe.output.title = "quotes \" and \\ and 谷";
    Recipe const patches = read_recipe("[network]\n[surface]\n[[patch]]\nsource = \"a.tif\"\nwindow = [0, 1, 20, 30]\n"
                                       "[[patch]]\nsource = \"b.tif\"\nrotate = 30\nat = [1, 2]\n",
                                       "r.toml");
    ASSERT_EQ(patches.patches.size(), 2U);
    EXPECT_EQ((*patches.patches[0].window)[3], 30.0);
    EXPECT_EQ(patches.patches[1].source, "b.tif");
    Recipe const layers = read_recipe(
        "[network]\n[surface]\n[strata]\ndip = 12\n[[layer]]\nstrength = 0.3\n[[layer]]\ncliff = 5\n", "r.toml");
    ASSERT_EQ(layers.layers.size(), 2U);
    EXPECT_EQ(layers.layers[0].strength, 0.3);
    EXPECT_EQ(layers.layers[1].cliff, 5.0);
    for (Recipe const& one : {recipe, patches, layers}) {
        std::string const text = write_recipe(one);
        Recipe const again = read_recipe(text, "again");
        EXPECT_EQ(write_recipe(again), text);
        EXPECT_EQ(again.grid.origin, one.grid.origin);
        EXPECT_EQ(again.patches.size(), one.patches.size());
        EXPECT_EQ(again.layers.size(), one.layers.size());
    }
}

TEST(Recipe, DefaultIsTheSample) {
    EXPECT_EQ(write_recipe(read_recipe(sample("relief.toml"), "relief.toml")), write_recipe(default_recipe()));
    EXPECT_EQ(write_recipe(read_recipe(sample("relief_dla.toml"), "relief_dla.toml")), write_recipe(cluster_recipe()));
}

TEST(Recipe, BuiltInValuesGiveWayToFiles) {
    Recipe recipe = default_recipe();
    EquilibriumRecipe const& land = recipe.surface->equilibrium;
    EXPECT_EQ(land.uplift_pattern, surface::UpliftPattern::seed);
    EXPECT_GT(land.lake_share, 0.0);
    set_key(recipe, "surface.uplift=uplift.tif");
    EXPECT_EQ(land.uplift_pattern, EquilibriumRecipe{}.uplift_pattern);
    set_key(recipe, "surface.lakes=lakes.gpkg");
    EXPECT_EQ(land.lake_share, 0.0);
    Recipe asked = default_recipe();
    set_key(asked, "surface.uplift_pattern=folds");
    set_key(asked, "surface.uplift=uplift.tif");
    EXPECT_EQ(asked.surface->equilibrium.uplift_pattern, surface::UpliftPattern::folds) << "both were asked for";
}

TEST(Recipe, UnknownKeysAreNamedWithTheNearestOne) {
    for (auto const& [toml, words] : std::vector<std::pair<std::string, std::string>>{
             {"[network]\nprun = 3\n", "line 2: unknown key 'network.prun'"},
             {"[netwrk]\nprune = 3\n", "netwrk"},
             {"particles = 3\n", "Did you mean 'network.dla.particles'?"},
             {"[network]\nsource = \"dlaa\"\n", "Did you mean 'dla'?"},
             {"[network]\n[surface]\nincrement = \"rise_fal\"\n", "Did you mean 'rise_fall'?"},
             {"[network]\n[surface]\n[[patch]]\nrotate = 1\n", "patch 1: source is missing"},
             {"[network]\n[surface]\n[strata]\ndip = 3\n", "there are none: add tables [[layer]]"},
             {"[network]\nheights = \"rosgen\"\n[surface]\n[[layer]]\n", R"(give network.heights = "graded")"},
             {"[network]\n[skeleton]\npoints = \"p.csv\"\n[surface]\n[[layer]]\n",
              "skeleton.points and skeleton.ridge"},
             {"[network]\n[surface]\nmethod = \"dilate\"\n[[layer]]\nstrength = 3\n", "layer.1.strength"},
             {"[network]\n[surface]\n[[layer]]\nstrength = 0\n", "layer.strength"},
             {"[network]\n[surface]\n[[patch]]\nsorce = \"a\"\n", "Did you mean 'patch.source'?"}}) {
        EXPECT_TRUE(has(fault_of(toml), words));
    }
    std::string many = "[network]\n[surface]\n";
    for (int k = 0; k < 256; ++k) {
        many += "[[layer]]\n";
    }
    EXPECT_TRUE(has(fault_of(many), "256 tables [[layer]]: 255 at most"));
    std::string const all = fault_of("[grid]\ncell = 0\nwidth = \"wide\"\n[network.dla]\nsticking = 2\nvisits = 0\n");
    EXPECT_TRUE(has(all, "grid.cell: 0 is", "grid.width: an integer", "sticking: 2 is", "visits: 0 is")) << "at once";
}

TEST(Recipe, RangesAreKept) {
    for (char const* bad : {"[grid]\nwidth = 0\nheight = 4\n",
                            "[grid]\nwidth = -5\n",
                            "[grid]\ncell = -1\n",
                            "[grid]\ncell = nan\n",
                            "[grid]\ncell = inf\n",
                            "[network.dla]\nsticking = 0.0\n",
                            "[network.dla]\nsticking = 1.0000001\n",
                            "[network.dla]\nsticking = nan\n",
                            "[network.dla]\nparticles = 0\n",
                            "[network.dla]\nparticles = 1.5\n",
                            "[network.dla]\nvisits = 1000\n",
                            "[network]\nslope = 0\n",
                            "[network]\nprune = -1\n",
                            "seed = -1\n",
                            "[surface]\nrelief = -1\n",
                            "[grid]\norigin = [1]\n",
                            "[grid]\norigin = [1, nan]\n",
                            "[grid]\nclip = 1\n",
                            "[surface]\nincrement = \"x=5\"\n",
                            "[surface]\nincrement = \"3-\"\n",
                            "[grid]\nwidth = 10\n[network]\n",
                            "[network]\nsource = \"lines\"\n",
                            "[network]\nheights = \"file\"\n",
                            "network = 5\n",
                            "[[network]]\n",
                            "[network]\n[network]\n",
                            "a = [[[[1]]]]\n",
                            "= 3\n",
                            "[network\n"}) {
        EXPECT_NE(fault_of(bad), "") << bad;
    }
}

TEST(Recipe, HostileSizesAreRefusedBeforeParsing) {
    std::string deep;
    for (int i = 0; i < 200000; ++i) {
        deep += "a.";
    }
    EXPECT_TRUE(has(fault_of(deep + "a = 1\n"), "longer than"));
    EXPECT_TRUE(has(fault_of(std::string(5 << 20, '\n')), "at most"));
    std::string many;
    for (int i = 0; i < 20000; ++i) {
        many += "k" + std::to_string(i) + " = 1\n";
    }
    EXPECT_LT(fault_of(many).size(), 10000U);
}

TEST(Recipe, SetTakesBareWordsAndNumbers) {
    Recipe recipe = cluster_recipe();
    set_key(recipe, "surface.increment=3-0.01*x");
    set_key(recipe, "network.dla.branch=west");
    set_key(recipe, "network.prune=35");
    set_key(recipe, "grid.origin=[1000, 2000]");
    set_key(recipe, "grid.clip=true");
    EXPECT_EQ(recipe.surface->dilate.increment.increment, "3-0.01*x");
    EXPECT_EQ(recipe.network->branch, growth::BranchChoice::west);
    EXPECT_EQ(recipe.network->prune_cells, 35.0);
    EXPECT_EQ((*recipe.grid.origin)[1], 2000.0);
    EXPECT_TRUE(recipe.grid.clip);
    for (char const* bad : {"", "=", "surface", "surface.increment=rise_fal", "network.prune=x", "grid.width=1.5",
                            "nothing.here=1", "grid.cell=1; rm", "grid.cell=\n[a]\nb=1"}) {
        EXPECT_THROW(set_key(recipe, bad), BadParameter) << bad;
    }
}

TEST(Recipe, KeysAndSectionsAreTakenBack) {
    Recipe recipe = cluster_recipe();
    set_key(recipe, "patch.1.source", "a.tif");
    set_key(recipe, "patch.2.source", "b.tif");
    set_key(recipe, "detail.levels", "3");
    for (char const* path : {"network.prune", "network.dla.branch", "seed", "patch.2.source", "patch.1", "detail"}) {
        unset_key(recipe, path);
    }
    EXPECT_FALSE(recipe.network->prune_cells);
    EXPECT_EQ(recipe.network->branch, growth::BranchChoice::largest);
    EXPECT_EQ(recipe.patches.size(), 1U);
    EXPECT_EQ(recipe.patches[0].source, "");
    EXPECT_FALSE(recipe.detail);
    for (char const* bad :
         {"", ".", "detail", "detail.levels", "patch.2", "patch.7.source", "grid", "network.prunes"}) {
        EXPECT_THROW(unset_key(recipe, bad), BadParameter) << bad;
    }
    EXPECT_TRUE(has(message_of([&] { require_effect(recipe, "surface.base"); }), "surface.base has no effect"));
    require_effect(recipe, "network.dla.branch");
}

TEST(Recipe, PatchesAreSetByNumber) {
    Recipe recipe = cluster_recipe();
    set_key(recipe, "patch.source=a.tif");
    recipe.patches.push_back({.source = "b.tif"});
    set_key(recipe, "patch.1.rotate=45");
    set_key(recipe, "patch.2.scale=2");
    EXPECT_EQ(recipe.patches[0].rotate_deg, 45.0);
    EXPECT_EQ(recipe.patches[1].scale, 2.0);
    Recipe with_a_third = recipe;
    set_key(with_a_third, "patch.3.source=c.tif");
    EXPECT_EQ(with_a_third.patches.at(2).source, "c.tif");
    for (char const* bad : {"patch.4.scale=2", "patch.0.scale=2", "patch.x.scale=2", "patch.2.scale=0", "patch=3",
                            "patch.window=[1,2,3]", "patch.window=[0,0,0,1]"}) {
        EXPECT_THROW(set_key(recipe, bad), BadParameter) << bad;
    }
}

TEST(Recipe, HoldsNoFunction) {
    Recipe recipe = cluster_recipe();
    EXPECT_NO_THROW(check_recipe(recipe));
    recipe.surface->dilate.increment.function = [](double x) { return x; };
    EXPECT_TRUE(has(message_of<BadParameter>([&] { check_recipe(recipe); }), "surface.increment is a function"));
}

TEST(RecipeKeys, EachHasAPathOfItsOwnAMeaningAndARange) {
    std::set<std::string> paths;
    for (Key const& key : all_keys()) {
        SCOPED_TRACE(key.help.path);
        EXPECT_TRUE(paths.insert(key.help.path).second);
        EXPECT_EQ(find_key(key.help.path), &key);
        EXPECT_FALSE(key.help.meaning.empty() || key.help.type.empty() || key.help.range.empty());
        bool const is_number = key.help.type == "number" || key.help.type == "integer";
        EXPECT_EQ(key.range.has_value(), is_number);
    }
}

TEST(RecipeKeys, DefaultsGoThroughTheirOwnChecks) {
    Recipe const standard = with_all_sections();
    for (Key const& key : all_keys()) {
        if (auto const value = key.take(standard)) {
            Recipe recipe = standard;
            EXPECT_NO_THROW(key.put(recipe, *value)) << key.help.path;
            EXPECT_EQ(key.take(recipe), value) << key.help.path;
        }
    }
}

TEST(RecipeKeys, WordsStandInTheOrderOfTheirEnumeration) {
    struct Case {
        char const* path;
        char const* last;
        bool (*holds)(Recipe const&);
    };
    Case const cases[] = {
        {"network.source", "lines", [](Recipe const& r) { return r.network->source == Source::lines; }},
        {"network.heights", "ends", [](Recipe const& r) { return r.network->heights == Heights::ends; }},
        {"network.inland", "coast", [](Recipe const& r) { return r.network->inland == InlandEnds::coast; }},
        {"network.rosgen", "G", [](Recipe const& r) { return r.network->rosgen == Rosgen::g; }},
        {"network.rosgen", "by_order", [](Recipe const& r) { return !r.network->rosgen; }},
        {"network.rosgen_slope", "uniform",
         [](Recipe const& r) { return r.network->rosgen_slope == network::SlopeDraw::uniform; }},
        {"network.dla.rule", "stick_then_count",
         [](Recipe const& r) { return r.network->dla.rule == growth::VisitRule::stick_then_count; }},
        {"network.dla.branch", "all", [](Recipe const& r) { return r.network->branch == growth::BranchChoice::all; }},
        {"network.tokunaga.rule", "plane",
         [](Recipe const& r) { return r.network->tokunaga.rule == growth::SideRule::plane; }},
        {"network.tokunaga.mouth", "west", [](Recipe const& r) { return r.network->tokunaga.mouth == Side::west; }},
        {"network.forest.shape", "island",
         [](Recipe const& r) { return r.network->forest.shape == LandShape::island; }},
        {"network.lines.orientation", "topology",
         [](Recipe const& r) { return r.network->lines.orientation == network::Orientation::topology; }},
        {"network.lines.divergences", "error",
         [](Recipe const& r) { return r.network->lines.divergences == network::Divergences::error; }},
        {"network.lines.filter", "none",
         [](Recipe const& r) { return r.network->lines.filter == io::LineFilter::none; }},
        {"network.lines.coastlines", "none",
         [](Recipe const& r) { return r.network->lines.coastlines == Coastlines::none; }},
        {"skeleton.ridges", "segments", [](Recipe const& r) { return r.skeleton->ridges == Ridges::segments; }},
        {"skeleton.law", "normal", [](Recipe const& r) { return r.skeleton->law == skeleton::HeightLaw::normal; }},
        {"skeleton.deviation", "printed",
         [](Recipe const& r) { return r.skeleton->deviation == skeleton::Deviation::printed; }},
        {"skeleton.falloff", "literal",
         [](Recipe const& r) { return r.skeleton->falloff == skeleton::Falloff::literal; }},
        {"surface.method", "raster", [](Recipe const& r) { return r.surface->method == Method::raster; }},
        {"surface.base", "tin", [](Recipe const& r) { return r.surface->base == Base::tin; }},
        {"surface.metric", "euclid",
         [](Recipe const& r) { return r.surface->dilate.metric == surface::Metric::euclid; }},
        {"surface.edge", "mainland",
         [](Recipe const& r) { return r.surface->equilibrium.edge == surface::Edge::mainland; }},
        {"surface.uplift_pattern", "folds",
         [](Recipe const& r) { return r.surface->equilibrium.uplift_pattern == surface::UpliftPattern::folds; }},
        {"surface.drain", "fill", [](Recipe const& r) { return r.surface->drain == flow::Conditioning::fill; }},
        {"surface.drain", "auto", [](Recipe const& r) { return !r.surface->drain; }},
        {"surface.diffusion", "explicit",
         [](Recipe const& r) { return r.surface->diffuse.mode == surface::Diffusion::explicit_sweeps; }},
        {"surface.start", "zero",
         [](Recipe const& r) { return r.surface->diffuse.start == surface::DiffusionStart::zero; }},
        {"surface.interpolation", "natural",
         [](Recipe const& r) { return r.surface->interpolation == Interpolation::natural; }},
        {"surface.slope_mode", "mean",
         [](Recipe const& r) { return r.surface->regress.slope == skeleton::SlopeMode::mean; }},
        {"surface.eighth_term", "x3y",
         [](Recipe const& r) { return r.surface->regress.eighth == skeleton::EighthTerm::x3y; }},
        {"statistics.skeleton", "points", [](Recipe const& r) { return r.statistics->skeleton == Prior::points; }},
        {"statistics.falloff", "literal",
         [](Recipe const& r) { return r.statistics->falloff == skeleton::Falloff::literal; }},
        {"detail.method", "none", [](Recipe const& r) { return r.detail->method == DetailMethod::none; }},
        {"detail.stencil", "exact",
         [](Recipe const& r) { return r.detail->midpoint.stencil == fractal::Stencil::exact; }},
        {"detail.noise", "uniform",
         [](Recipe const& r) { return r.detail->midpoint.noise == fractal::Noise::uniform; }},
        {"detail.adaptation", "local",
         [](Recipe const& r) { return r.detail->midpoint.adaptation == fractal::Adaptation::local; }},
        {"patch.rivers", "replace", [](Recipe const& r) { return r.patches[0].rivers == PatchRivers::replace; }},
        {"output.units", "ft", [](Recipe const& r) { return r.output.units == HeightUnit::foot; }},
        {"output.schema", "grass", [](Recipe const& r) { return r.output.schema == io::Schema::grass; }},
    };
    Recipe recipe = with_all_sections();
    for (Case const& one : cases) {
        find_key(one.path)->put(recipe, std::string(one.last));
        EXPECT_TRUE(one.holds(recipe)) << one.path;
    }
}

TEST(RecipeKeys, ThoseOfAnArrayReachEachItem) {
    Recipe recipe;
    Key const& gain = *find_key("patch.gain");
    EXPECT_THROW(gain.put(recipe, std::string("much")), BadParameter);
    EXPECT_EQ(gain.take(recipe), std::nullopt) << "a value that is refused changes nothing";
    gain.put(recipe, 2.0);
    gain.put(recipe, 3.0, 1);
    gain.put(recipe, 4.0); // the last
    EXPECT_EQ(gain.take(recipe, 0), Value(2.0));
    EXPECT_EQ(gain.take(recipe, 1), Value(4.0));
    EXPECT_EQ(gain.place(1), "patch.2.gain");
    EXPECT_EQ(find_key("network.slope")->place(0), "network.slope");
}

TEST(RecipeKeys, FilesAreThoseOfEverySectionAndItem) {
    Recipe recipe;
    recipe.network.emplace().lines.path = "a.gpkg";
    recipe.network->lines.layer = "rivers";
    recipe.patches = {{.source = "b.tif"}, {.source = "c.tif", .mask = "d.gpkg"}};
    std::vector<std::string> found;
    for (NamedFile const& file : files_of(recipe)) {
        found.push_back(file.key->place(file.item) + " " + file.name + " " + file.layer);
    }
    EXPECT_EQ(found, (std::vector<std::string>{"network.lines.path a.gpkg rivers", "patch.1.source b.tif ",
                                               "patch.2.source c.tif ", "patch.2.mask d.gpkg "}));
}

TEST(TomlDepth, EachWayToNestCountsOne) {
    EXPECT_EQ(depth_of(""), 0U);
    EXPECT_EQ(depth_of("a = 1\n"), 1U);
    EXPECT_EQ(depth_of("a.b.c = 1\nd = 2\n"), 3U);
    EXPECT_EQ(depth_of("[a.b]\nc = 1\n"), 3U);
    EXPECT_EQ(depth_of("[[a]]\nb = 1\n[c]\nd.e = 1\n"), 3U);
    EXPECT_EQ(depth_of("a = [[1, 2], [3]]\n"), 3U);
    EXPECT_EQ(line_deeper_than("a = '''\n\n'''\n[b.c]\nd = [[1]]\n", 4), 5U) << "the line";
    EXPECT_EQ(depth_of("a.b = {c.d = [1]}\n"), 5U);
    EXPECT_EQ(depth_of("a = [1, 2,\n 3]\nb = [4]\n"), 2U) << "a line does not add to the next";
}

TEST(TomlDepth, StringsAndCommentsHaveNoneAndWhatIsNoTomlEnds) {
    for (char const* const toml : {"a = '[[[[...'\n", "a = \"[[[[\\\"...\"\n", "a = '''[[[\n...''' # [[[...\n",
                                   "# [[[[....\na = 1\n", "a = \"\"\"[[[\n\\\"\"\"...\"\"\"\n", "'a.b.c.d' = 1\n"}) {
        EXPECT_LE(depth_of(toml), 2U) << toml;
    }
    for (char const* const toml : {"]]]]", "}}}\n[", "'", "\"", "\"\"\"", "'''\n", "\"\\", "[", "a = \"\n", "#"}) {
        EXPECT_LE(depth_of(toml), 3U) << toml;
    }
}

// 120 inline tables in arrays, each under a key of 3500 parts: toml++ reads them and gives 420 000 frames back at once.
TEST(TomlDepth, ARecipeOfNestedTablesIsRefusedWithItsLine) {
    std::string part = "{a";
    for (int i = 1; i < 3500; ++i) {
        part += ".a";
    }
    std::string text = "seed = 1\na = [";
    std::string end;
    for (int i = 0; i < 120; ++i) {
        text += part + "=[\n";
        end += "]}";
    }
    text += end + "]\n";
    ASSERT_LT(text.size(), std::size_t{1} << 20U);
    EXPECT_TRUE(has(message_of<BadParameter>([&] { read_recipe(text, "deep.toml"); }), "deep.toml: line 2: "));
}

// A key that docs name is one that a recipe may have.
TEST(DocumentedKeys, Exist) {
    std::set<std::string> const known = keys_and_sections();
    std::regex const named("`((?:grid|network|skeleton|surface|strata|layer|statistics|detail|patch|output)(?:\\.(?!"
                           "hpp)[a-z_]+)+)"); // and no header
    std::filesystem::path const root(THALWEG_SOURCE_DIR);
    int found = 0;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(root / "docs")) {
        std::string const folder = entry.path().parent_path().filename().string();
        if (entry.path().extension() != ".md" || folder == "decisions") { // which are history
            continue;
        }
        std::string const text = bytes_of(entry.path());
        for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at, ++found) {
            EXPECT_TRUE(known.contains((*at)[1])) << entry.path() << " names the key " << (*at)[1];
        }
    }
    EXPECT_GT(found, 30);
}

} // namespace recipe_test
