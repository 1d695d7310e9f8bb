// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of the table in a small recipe of every method: where the table says that it has an effect, another value
// changes the terrain or a file, also where stages of other recipes were kept; where it says that it has none, the
// recipe is refused.
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <house/fnv.hpp>
#include <make/walk_files.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/result_cache.hpp>
#include <thalweg/recipe/recipe_keys.hpp>
#include <thalweg/report/report.hpp>

namespace keys_walk_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;

namespace {

using Words = std::vector<std::string>;
using test::has;
using test::message_of;

/// A small recipe of a method.
struct BaseRecipe {
    char const* name;
    std::string toml;
    Words walked; ///< keys, or sections with a dot at their end, whose effect is tried here; "-KEY" leaves one out
};

std::string const grid = "[grid]\nwidth = 64\nheight = 64\n";
std::string const wide_grid = "[grid]\nwidth = 96\nheight = 96\n";
std::string const dla = grid + "[network]\nprune = 5\n[network.dla]\nparticles = 1500\n";
std::string const tokunaga = "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\n";
std::string const forest = grid + "[network]\nsource = \"forest\"\nprune = 6\n";
std::string const lines = grid + "[network]\nsource = \"lines\"\n[network.lines]\npath = ";
std::string const points = grid + "[skeleton]\npoints = \"points.csv\"\n";
std::string const equilibrium = "[surface]\n";
std::string const statistics =
    "[statistics]\nmean = 500\nstd = 100\nmax = [800, 50, 10]\nmin = [250, 5, 60]\nlength = [9, 11]\n";

std::string surface(std::string const& method, std::string const& more = "") {
    return "[surface]\nmethod = \"" + method + "\"\n" + more;
}

Words const diffusion = {"surface.diffusion", "surface.tolerance", "surface.sweeps", "surface.start",
                         "surface.alpha",     "surface.smoothing", "surface.noise",  "surface.mask"};

std::vector<BaseRecipe> const bases = {
    {"EquilibriumDla", dla + equilibrium, {"seed", "grid.", "network.", "-network.source", "surface.", "output."}},
    {"EquilibriumTokunaga", wide_grid + tokunaga + "order = 4\n" + equilibrium, {"network.tokunaga.", "network.prune"}},
    {"EquilibriumStrokes",
     wide_grid + tokunaga + "strokes = \"strokes.geojson\"\norder = 3\n" + equilibrium,
     {"network.tokunaga.layer", "network.tokunaga.strokes", "network.coast"}},
    {"EquilibriumRegion",
     grid + tokunaga + "region = \"region.geojson\"\norder = 3\n" + equilibrium,
     {"network.tokunaga.mouth", "network.tokunaga.region"}},
    {"EquilibriumForest", forest + equilibrium, {"network.forest.", "network.meander"}},
    {"EquilibriumIsland",
     forest + "[network.forest]\nshape = \"island\"\n" + equilibrium,
     {"network.forest.ruggedness"}},
    {"EquilibriumForestRegion",
     forest + "[network.forest]\nregion = \"region.geojson\"\n" + equilibrium,
     {"network.forest.region", "grid.clip"}},
    {"EquilibriumLines",
     lines + "\"rivers.geojson\"\n" + equilibrium,
     {"network.lines.", "network.slope", "network.heights", "grid.clip"}},
    {"EquilibriumLinesWithHeights",
     lines + "\"heights.geojson\"\n" + equilibrium,
     {"network.slope", "network.heights_tolerance"}},
    {"EquilibriumLayers",
     dla + equilibrium +
         "relief = 300\n[strata]\nrepeat = true\nfold = 40\nfold_wave = 900\nplunge = 3\ndome = 60\ndome_radius = "
         "400\nfault = 50\n"
         "undulation = 20\nundulation_wave = 600\ndip = 8\n"
         "[[layer]]\nthickness = 60\nstrength = 0.5\ncliff = 0.5\n[[layer]]\nthickness = 40\nstrength = 8\ncliff = 5\n"
         "[[layer]]\nthickness = 90\nstrength = 0.4\ncliff = 0.6\n",
     {"strata.", "layer.", "-strata.cap_share"}},
    {"EquilibriumCapRock",
     dla + equilibrium +
         "[strata]\nbase = -10\n[[layer]]\nthickness = 40\nstrength = 0.5\ncliff = 0.5\n[[layer]]\nthickness = 30\n"
         "strength = 8\ncliff = 5\n[[layer]]\nstrength = 0.2\ncliff = 0.4\n",
     {"strata.cap_share"}},
    {"EquilibriumDetail", dla + equilibrium + "[detail]\nsigma = 20\n", {"detail.", "-detail.method"}},
    {"DilateHarmonic",
     dla + surface("dilate"),
     {"surface.", "network.slope", "network.concavity", "network.heights", "network.rosgen_slope", "network.rotate"}},
    {"DilatePaper",
     lines + "\"rivers.geojson\"\n" + surface("dilate", "base = \"paper\"\n"),
     {"surface.increment", "surface.metric", "surface.mask"}},
    {"DilateTin",
     grid + tokunaga + "order = 3\n[skeleton]\n" + surface("dilate", "base = \"tin\"\n"),
     {"skeleton.", "surface.relief"}},
    {"DilateTinScattered",
     grid + tokunaga + "order = 3\n[skeleton]\nscatter = 30\n" + surface("dilate", "base = \"tin\"\n"),
     {"seed", "skeleton.ridge_gain", "skeleton.ridge_farthest", "skeleton.scatter", "skeleton.spacing",
      "skeleton.law"}},
    {"DilateIsland", forest + "[network.forest]\nshape = \"island\"\n" + surface("dilate"), {"surface.increment"}},
    {"DilatePatch",
     dla + surface("dilate") + "[[patch]]\nsource = \"patch.asc\"\nat = [501000, 4999000]\n",
     {"patch."}},
    {"Diffuse", grid + tokunaga + "order = 3\n[skeleton]\nridges = \"voronoi\"\n" + surface("diffuse"), {"skeleton."}},
    {"DiffuseBetweenRivers", grid + tokunaga + "order = 3\n" + surface("diffuse"), diffusion},
    {"TinOfRivers", lines + "\"rivers.geojson\"\n[skeleton]\n" + surface("tin"), {"surface.mask", "skeleton.ridges"}},
    {"NetworkAlone", grid + "[network]\nprune = 5\n", {"network.source"}},
    {"TinOfPoints", points + surface("tin"), {"skeleton.", "surface.", "grid.", "-grid.crs"}},
    {"PointsAlone", points, {"skeleton."}},
    {"DiffusePoints",
     points + surface("diffuse"),
     {"surface.smoothing", "surface.noise", "surface.start", "surface.mask"}},
    {"RegressPoints", points + surface("regress"), {"surface."}},
    {"Raster",
     surface("raster", "source = \"hills.asc\"\n"),
     {"grid.cell", "grid.crs", "grid.origin", "surface.", "-surface.method"}},
    {"RasterDetail", surface("raster", "source = \"hills.asc\"\n") + "[detail]\n", {"detail.", "-detail.method"}},
    {"RiversOnRaster",
     "[network]\nsource = \"lines\"\n[network.lines]\npath = \"heights.geojson\"\n" +
         surface("raster", "source = \"valley.asc\"\n"),
     {"network.heights", "network.coast", "network.meander", "network.inland", "surface.drain", "grid.clip"}},
    {"RiversThroughHills",
     "[network]\nsource = \"lines\"\n[network.lines]\npath = \"crests.geojson\"\n" +
         surface("raster", "source = \"hills.asc\"\n"),
     {"surface.max_cut"}},
    {"Scatter",
     grid + "[skeleton]\nscatter = 50\n" + surface("tin") + statistics + "skeleton = \"points\"\n",
     {"skeleton.", "statistics.", "-statistics.skeleton"}},
    {"Grf", grid + statistics, {"statistics."}},
    {"Separable", grid + statistics + "skeleton = \"separable\"\n", {"statistics.reach", "statistics.falloff"}},
    {"Markov3",
     grid + statistics + "skeleton = \"markov3\"\n" + "[surface]\n",
     {"statistics.falloff", "surface.drain"}},
    {"DetailOfPoints", points + "[detail]\n", {"detail."}},
    {"ExactDetail", points + "[detail]\nstencil = \"exact\"\n", {"detail.", "-detail.method"}},
};

/// Values away from the default, of keys for which the table gives none: numbers of which double and half are not
/// allowed, take too long or change too little on so small a terrain, and what is no number.
std::map<std::string, Words> const values = {
    {"grid.width", {"72"}},
    {"grid.height", {"72"}},
    {"grid.crs", {"EPSG:32632"}},
    {"grid.origin", {"[499980, 5000010]", "[499980, 5001950]"}},
    {"network.prune", {"12", "3"}},
    {"network.rotate", {"33"}},
    {"network.meander", {"0.5"}},
    {"network.coast", {"600"}},
    {"network.dla.particles", {"300"}},
    {"network.dla.radius", {"20"}},
    {"network.tokunaga.order", {"3"}},
    {"network.tokunaga.region", {"second_region.geojson"}},
    {"network.tokunaga.strokes", {"one_stroke.geojson"}},
    {"network.tokunaga.layer", {"one_stroke"}},
    {"network.forest.region", {"second_region.geojson"}},
    {"network.forest.outlets", {"outlets.csv"}},
    {"network.forest.seeds", {"3"}},
    {"network.forest.particles", {"60"}},
    {"network.lines.path", {"second.geojson"}},
    {"network.lines.layer", {"second", "rivers, second"}},
    {"network.lines.source_crs", {"EPSG:32632"}},
    {"network.lines.type_field", {"kind"}},
    {"network.lines.rank_field", {"up"}},
    {"network.lines.id_field", {"alias"}},
    {"network.lines.down_field", {"back"}},
    {"network.lines.from_field", {"blank"}},
    {"network.lines.to_field", {"blank"}},
    {"network.lines.direction_field", {"way"}},
    {"network.lines.where", {"part = 1"}},
    {"network.lines.snap", {"0.001"}},
    {"network.lines.dem", {"north.asc"}},
    {"network.lines.keep", {"0.5"}},
    {"skeleton.ridge_farthest", {"60"}},
    {"skeleton.ridge_noise", {"15"}},
    {"skeleton.midpoint_inverse", {"3"}},
    {"skeleton.points", {"higher.csv"}},
    {"skeleton.height_column", {"top"}},
    {"skeleton.nodata", {"100.3"}},
    {"skeleton.ridge_lines", {"crests.geojson"}},
    {"skeleton.ridge_height_column", {"crest"}},
    {"skeleton.scatter", {"40"}},
    {"skeleton.spacing", {"4"}},
    {"surface.relief", {"300"}},
    {"surface.mask", {"mask.asc"}},
    {"surface.max_cut", {"200"}},
    {"surface.source", {"other_hills.asc"}},
    {"surface.mean_slope", {"12"}},
    {"surface.steepness", {"5"}},
    {"network.forest.outlet_spacing", {"25"}},
    {"surface.hillslope", {"120"}},
    {"surface.debris_area", {"0.5"}},
    {"surface.longest_wave", {"500"}},
    {"surface.grain", {"2"}},
    {"surface.strike", {"70"}},
    {"surface.region", {"1"}},
    {"surface.uplift_contrast", {"9"}},
    {"surface.uplift_wave", {"700"}},
    {"surface.uplift", {"uplift.asc"}},
    {"surface.erodibility", {"erodibility.asc"}},
    {"surface.lakes", {"lakes.geojson"}},
    {"surface.lake_share", {"1"}},
    {"surface.like", {"hills.asc"}},
    {"surface.tolerance", {"0.01"}},
    {"surface.sweeps", {"50"}},
    {"surface.noise", {"20"}},
    {"strata.base", {"-30"}},
    {"strata.cap_share", {"0.2"}},
    {"strata.dip", {"20"}},
    {"strata.strike", {"70"}},
    {"strata.fold", {"90"}},
    {"strata.fold_axis", {"10"}},
    {"strata.plunge", {"-9"}},
    {"strata.dome", {"-80"}},
    {"strata.dome_at", {"[500300, 4999700]"}},
    {"strata.fault", {"-70"}},
    {"strata.fault_strike", {"20"}},
    {"strata.fault_at", {"[500500, 4999500]"}},
    {"strata.undulation", {"45"}},
    {"layer.thickness", {"150"}},
    {"layer.cliff", {"0.05"}},
    {"statistics.mean", {"450"}},
    {"statistics.std", {"80"}},
    {"statistics.max", {"[900, 40, 20]"}},
    {"statistics.min", {"[200, 10, 50]"}},
    {"statistics.length", {"[6, 8]"}},
    {"statistics.slope", {"1.3"}},
    {"statistics.dimension", {"2.5"}},
    {"detail.levels", {"1"}},
    {"detail.hurst", {"0.3"}},
    {"detail.sigma", {"15"}},
    {"patch.source", {"other_patch.asc"}},
    {"patch.at", {"[500900, 4999040]"}},
    {"patch.window", {"[2, 2, 16, 16]"}},
    {"patch.mask", {"patch_mask.geojson"}},
    {"patch.rotate", {"30"}},
    {"patch.feather", {"4"}},
    {"output.title", {"A walk"}},
    {"output.contour_interval", {"7.5"}},
    {"output.files", {"dem,network"}},
    {"output.against", {"hills.asc"}},
};

/// What a key needs beside it to have an effect, or for the effect to be seen on so small a terrain.
std::map<std::string, std::vector<Words>> const beside = {
    {"grid.clip", {{"grid.width=40", "grid.height=40"}}},
    {"network.slope", {{"network.heights=straight_repaired"}, {"network.heights=rosgen"}}},
    {"network.concavity", {{"network.heights=graded"}}},
    {"network.rosgen", {{"network.heights=rosgen"}, {"network.coast=300"}}},
    {"network.rosgen_slope", {{"network.heights=rosgen"}}},
    {"network.support", {{"network.fill_space=true"}}},
    {"network.dla.rule", {{"network.dla.visits=3", "network.dla.sticking=0.5"}, {"network.dla.visits=3"}}},
    {"network.tokunaga.generator", {{"network.tokunaga.order=3"}}},
    {"network.tokunaga.rule", // alike where lambda is 2, and below order 4
     {{"network.tokunaga.generator=3", "network.tokunaga.order=4", "network.tokunaga.spacing=0", "grid.width=160",
       "grid.height=160"}}},
    {"network.tokunaga.layer", {{"network.tokunaga.strokes=strokes.gpkg", "network.tokunaga.layer=strokes"}}},
    {"network.lines.layer", {{"network.lines.path=rivers.gpkg", "network.lines.layer=rivers"}}},
    {"network.lines.source_crs", {{"network.lines.path=no_crs.gpkg", "network.lines.source_crs=EPSG:32631"}}},
    {"network.lines.rank_field",
     {{"network.lines.orientation=topology"},
      {"network.lines.orientation=as_drawn", "network.lines.divergences=error"}}},
    {"network.lines.id_field",
     {{"network.lines.path=links.geojson", "network.lines.id_field=own", "network.lines.down_field=back"}}},
    {"network.lines.down_field",
     {{"network.lines.path=links.geojson", "network.lines.id_field=own", "network.lines.down_field=to"}}},
    {"network.lines.from_field",
     {{"network.lines.path=nodes.geojson", "network.lines.from_field=begin", "network.lines.to_field=end"}}},
    {"network.lines.to_field",
     {{"network.lines.path=nodes.geojson", "network.lines.from_field=begin", "network.lines.to_field=end"}}},
    {"network.lines.direction_field", {{"network.lines.path=nodes.geojson"}}},
    {"network.lines.where", {{"network.lines.path=nodes.geojson"}}},
    {"network.lines.divergences", {{"network.lines.path=loop.geojson"}}},
    {"network.lines.filter", {{"network.lines.path=canal.geojson"}}},
    {"network.lines.coastlines", {{"network.lines.path=coast.geojson"}}},
    {"network.inland", {{"network.lines.path=inland.geojson"}}},
    {"skeleton.height_column", {{"skeleton.points=points.csv"}}},
    {"skeleton.nodata", {{"skeleton.points=points.csv"}}},
    {"skeleton.ridge_height_column", {{"skeleton.ridge_lines=crests.geojson"}}},
    {"skeleton.ridge_gain", {{"skeleton.ridges=segments"}}},
    {"skeleton.ridge_farthest", {{"skeleton.ridges=segments"}}},
    {"skeleton.ridge_noise", {{"skeleton.ridges=segments"}}},
    {"skeleton.ridge_wavelength",
     {{"skeleton.ridges=segments", "skeleton.ridge_noise=15"}, {"skeleton.ridges=voronoi"}}},
    {"skeleton.falloff", {{"statistics.reach=20"}}},
    {"surface.mean_slope", {{"surface.relief=300"}}},
    {"surface.uplift_contrast", {{"surface.uplift_pattern=folds"}}},
    {"surface.uplift_wave", {{"surface.uplift_pattern=domes"}}},
    {"surface.drain", {{"detail.sigma=40", "detail.levels=3"}}},
    {"surface.allow_negative", {{"surface.increment=3-x"}}},
    {"surface.sweeps", {{"surface.diffusion=explicit", "surface.sweeps=30"}}},
    {"surface.start", {{"surface.diffusion=explicit", "surface.sweeps=30"}}},
    {"surface.alpha", {{"surface.diffusion=explicit", "surface.sweeps=30"}}},
    {"surface.slope_mode", {{"statistics.skeleton=points", "statistics.slope=1.2"}}},
    {"statistics.falloff", {{"statistics.reach=0"}}},
};

/// Keys whose effect lies in files beside dem.tif and the network.
bool is_seen_in_files(std::string const& path) {
    return path == "seed" || path == "skeleton.tin" || path.rfind("output.", 0) == 0;
}

WalkFiles const& files() {
    static WalkFiles const made;
    return made;
}

Recipe recipe_of(BaseRecipe const& base, Words const& assignments) {
    Recipe recipe = read_recipe(base.toml, "base");
    recipe.folder = files().folder();
    for (std::string const& assignment : assignments) {
        auto const equals = assignment.find('=');
        Key const* const key = find_key(assignment.substr(0, equals));
        set_key(recipe, key != nullptr && key->help.is_file // else found from the current folder
                            ? key->help.path + "=" + files() / assignment.substr(equals + 1)
                            : assignment);
    }
    return recipe;
}

void add_text(Fnv& hash, std::string const& text) {
    hash.add_all(std::vector<std::uint8_t>(text.begin(), text.end()));
}

/// dem.tif, the network and what it is held to, as values.
std::string digest(MakeResult const& t) {
    Fnv hash;
    hash.add(t.terrain.grid.width);
    hash.add(t.terrain.grid.height);
    for (double const x : {t.terrain.grid.cell_m, t.terrain.grid.west, t.terrain.grid.north}) {
        hash.add(x);
    }
    add_text(hash, t.terrain.grid.crs);
    for (std::size_t a = 0; a < t.terrain.rivers.network.planform.arc_count(); ++a) {
        Arc const& arc = t.terrain.rivers.network.planform.arc(a);
        for (Vec2 const p : arc.line) {
            hash.add(p.x);
            hash.add(p.y);
        }
        add_text(hash, arc.type);
        hash.add_all(t.terrain.rivers.network.arc_z[a]);
    }
    hash.add_all(t.terrain.rivers.types.braided);
    if (t.terrain.has_surface()) {
        hash.add_all(t.terrain.ground.dem.values());
    }
    for (Check const& check : t.assessment.checks) {
        hash.add(check.limit);
    }
    if (t.assessment.given_heights) {
        hash.add(t.assessment.given_heights->tolerance_m);
    }
    for (Finding const& finding : findings_of(t)) {
        if (finding.kind == FindingKind("deep_cut")) { // surface.max_cut changes nothing else
            add_text(hash, finding.text);
        }
    }
    return std::to_string(hash.hash());
}

/// All files but those that hold the recipe itself.
std::string digest_of_files(MakeResult const& t) {
    ScratchFolder const folder;
    Fnv hash;
    for (std::string const& name : write_terrain(t, folder / "out", io::Existing::refuse)) {
        if (name.rfind("report.", 0) != 0 && name != "recipe.toml") {
            add_text(hash, name);
            add_text(hash, bytes_of(folder / ("out/" + name)));
        }
    }
    return std::to_string(hash.hash());
}

struct Outcome {
    std::string digest;
    std::string fault; ///< "" where a terrain was made
};

Outcome outcome(Recipe const& recipe, bool in_files) {
    static ResultCache kept(256'000'000);
    Run run;
    run.cache = &kept; // a stage that is not made again for a key that it reads changes nothing
    try {
        MakeResult const t = make::make(recipe, run);
        return {in_files ? digest_of_files(t) : digest(t), ""};
    } catch (Error const& fault) {
        return {"", fault.what()};
    }
}

Outcome const& outcome_of_base(BaseRecipe const& base, Words const& context, bool in_files) {
    static std::map<std::string, Outcome> made;
    std::string name = base.name + std::string(in_files ? " files" : "");
    for (std::string const& word : context) {
        name += " " + word;
    }
    auto const at = made.find(name);
    return at != made.end() ? at->second
                            : made.emplace(name, outcome(recipe_of(base, context), in_files)).first->second;
}

/// Double and half the default of a number, within its range.
Words numbers_of(Key const& key) {
    static Recipe const standard = with_all_sections();
    auto const value = key.take(standard);
    auto const* const whole = value ? std::get_if<std::int64_t>(&*value) : nullptr;
    auto const* const real = value ? std::get_if<double>(&*value) : nullptr;
    double const usual = whole != nullptr ? static_cast<double>(*whole) : real != nullptr ? *real : 0.0;
    Words words;
    for (double const x : {2.0 * usual, whole != nullptr ? std::floor(0.5 * usual) : 0.5 * usual}) {
        if (usual != 0.0 && key.range->holds(x)) {
            words.push_back(fmt::format("{}", x));
        }
    }
    return words;
}

/// What a key is tried with: its words, a row of values, or what its range and default give.
Words values_of(Key const& key) {
    if (!key.help.choices.empty()) {
        return key.help.choices;
    }
    auto const at = values.find(key.help.path);
    if (at != values.end()) {
        return at->second;
    }
    return key.range ? numbers_of(key) : Words{};
}

std::string section_of(std::string const& path) {
    return path.substr(0, path.find('.'));
}

/// Whether a base has the stage of this key.
bool has_stage(BaseRecipe const& base, std::string const& path) {
    std::string const section = section_of(path);
    return path == "seed" || section == "grid" || section == "output" ||
           base.toml.find("[" + section) != std::string::npos;
}

std::string checked(Recipe const& recipe) {
    return message_of<BadParameter>([&] { check_recipe(recipe); });
}

/// Whether the effect of a key is tried in a base.
bool is_walked(BaseRecipe const& base, std::string const& path) {
    bool const left_out = std::find(base.walked.begin(), base.walked.end(), "-" + path) != base.walked.end();
    return !left_out && std::any_of(base.walked.begin(), base.walked.end(), [&](std::string const& word) {
        return word == path || (word.back() == '.' && path.rfind(word, 0) == 0);
    });
}

/// What a key is tried with: the base alone, and what it needs beside it.
std::vector<Words> contexts_of(BaseRecipe const& base, std::string const& path) {
    std::vector<Words> contexts{{}};
    if (auto const more = beside.find(path); more != beside.end()) {
        std::copy_if(more->second.begin(), more->second.end(), std::back_inserter(contexts),
                     [&](Words const& context) { return checked(recipe_of(base, context)).empty(); });
    }
    return contexts;
}

/// Whether another value is noticed: a terrain is made that differs, or one is made where none was (clip), or a file is
/// refused that was not (divergences).
bool is_noticed(std::string const& path, Outcome const& without, Outcome const& with) {
    return with.fault.empty() ? with.digest != without.digest
                              : path == "network.lines.divergences" && without.fault.empty();
}

/// What became of a key in a base.
struct Walked {
    bool used = false;    ///< by the table, in one context at least
    bool changed = false; ///< something, in one of them
    std::string story;    ///< of values that changed nothing
};

Walked walk(BaseRecipe const& base, Key const& key) {
    std::string const& path = key.help.path;
    bool const in_files = is_seen_in_files(path);
    Walked walked;
    for (Words const& context : contexts_of(base, path)) {
        auto const before = key.take(recipe_of(base, context));
        for (std::string const& value : values_of(key)) {
            Words all = context;
            all.push_back(path + "=" + value);
            Recipe const recipe = recipe_of(base, all);
            if (key.take(recipe) == before) {
                continue;
            }
            if (!key.use(recipe)) {
                std::string const fault = checked(recipe);
                EXPECT_TRUE(has(fault, path) || has(fault, key.place(0)) || has(fault, key.place(2)) ||
                            has(fault, "[" + section_of(path) + "]"))
                    << base.name << ": " << path << " = " << value << " is accepted and ignored: " << fault;
            } else if (is_walked(base, path)) {
                walked.used = true;
                if (!walked.changed) {
                    Outcome const with = outcome(recipe, in_files);
                    walked.changed = is_noticed(path, outcome_of_base(base, context, in_files), with);
                    walked.story += value + ": " + with.fault + "; ";
                }
            }
        }
    }
    return walked;
}

class KeysWalk : public testing::TestWithParam<BaseRecipe> {};

} // namespace

TEST_P(KeysWalk, EachKeyChangesSomethingOrIsRefused) {
    BaseRecipe const& base = GetParam();
    EXPECT_EQ(outcome_of_base(base, {}, false).fault, "");
    for (Key const& key : all_keys()) {
        if (has_stage(base, key.help.path)) {
            Walked const walked = walk(base, key);
            EXPECT_EQ(walked.used, walked.changed)
                << base.name << ": " << key.help.path << " changes nothing: " << walked.story;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, KeysWalk, testing::ValuesIn(bases),
                         [](testing::TestParamInfo<BaseRecipe> const& one) { return std::string(one.param.name); });

TEST(Keys, EachIsTriedInARecipeOfTheWalk) {
    for (Key const& key : all_keys()) {
        std::string const& path = key.help.path;
        ASSERT_FALSE(values_of(key).empty()) << "give a value of " << path << " away from its default";
        bool used = false;
        for (BaseRecipe const& base : bases) {
            for (Words context : is_walked(base, path) ? contexts_of(base, path) : std::vector<Words>{}) {
                context.push_back(path + "=" + values_of(key).back());
                used = used || (has_stage(base, path) && key.use(recipe_of(base, context)));
            }
        }
        EXPECT_TRUE(used) << "no recipe of the walk uses " << path;
    }
}

} // namespace keys_walk_test
