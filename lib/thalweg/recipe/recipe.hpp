// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/rosgen.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/strata/strata.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

namespace thalweg::recipe {

/// Where the land lies. What is left out is chosen from the network, or is as in the raster of the surface.
struct GridRecipe {
    std::int64_t width = 0;  ///< [cells] 0: the network's box and 5 % around it
    std::int64_t height = 0; ///< [cells] likewise
    double cell_m = 30.0;    ///< [m] > 0; 0 chooses it from the lines of a file, or the raster of the surface
    std::string crs;         ///< projected, metres; "": the line file's own or its UTM zone, else EPSG:32631
    std::optional<std::array<double, 2>> origin; ///< [m] west and north edge
    bool clip = false;                           ///< cut rivers at the grid's edge instead of refusing them
};

/// The land of a forest that no region is given for.
enum class LandShape : std::uint8_t { grid, island };

/// Rivers that grow inland from a coast or border until the land is full of them.
struct ForestRecipe {
    LandShape shape = LandShape::grid;
    double ruggedness = 0.5; ///< [0, 1] of an island's coast
    std::string region;      ///< polygons that are land; "": the shape
    std::string outlets;     ///< points; or lines or polygons along whose coast outlets lie; "": all of it
    std::int64_t seeds = 0;  ///< [0, ...] outlets; 0: by their spacing
    std::int64_t outlet_spacing_cells = 0; ///< [0, ...] along the coast or border; 0: six times that of rivers
    std::int64_t spacing_cells = 10;       ///< [8, 200] between rivers that do not meet
    growth::ForestParams growth;           ///< its step and seed follow from the recipe
};

/// What coastlines among the lines of a file are to the land.
enum class Coastlines : std::uint8_t {
    sea, ///< its coast
    none ///< nothing
};

/// The keys of section [network] for drawn lines.
struct LinesRecipe {
    std::string path;
    std::string layer;
    std::string source_crs; ///< of a file that has none
    std::string type_field = "rosgen";
    std::string rank_field;
    std::string id_field;   ///< of a line, and
    std::string down_field; ///< of the line downstream; both or none
    std::string from_field; ///< node from which a line's water comes, and
    std::string to_field;   ///< to which it goes; both or none
    std::string direction_field;
    std::string where;   ///< condition on fields; "" for all lines
    double snap_m = 0.0; ///< [m] 0 takes 1e-6 of the box's diagonal
    network::Orientation orientation = network::Orientation::automatic;
    std::string dem; ///< heights that lines are oriented by; "" for none
    network::Divergences divergences = network::Divergences::main;
    io::LineFilter filter = io::LineFilter::natural;
    Coastlines coastlines = Coastlines::sea;
    double keep = 0.99; ///< [0, 1] least share of the given length that must be in the network
};

enum class Side : std::uint8_t { north, east, south, west };

/// The keys of section [tokunaga] of a recipe.
struct TokunagaRecipe {
    int generator = 2; ///< [1, 50] lambda, also of strokes without their own
    int order = 6;     ///< [1, 12] Strahler order at the mouth; strokes: MaxDepth, that of one as long as the grid
    growth::SideRule rule = growth::SideRule::tokunaga;
    Side mouth = Side::south;   ///< of the grid, in the middle of which the river leaves
    std::string region;         ///< polygon the network fills; "": the grid
    std::string strokes;        ///< directed lines, each of which grows a network; "" grows one in the region
    std::string layer;          ///< of the strokes' file; "" takes the only line layer
    double spacing_cells = 3.0; ///< [cells] >= 0: links closer than this to others are left out
};

enum class Source : std::uint8_t { dla, tokunaga, forest, lines };

enum class Heights : std::uint8_t {
    automatic, ///< on a raster: those of its cells, made to fall downstream
    straight,
    straight_repaired,
    along_stream,
    rosgen,
    graded,
    file,
    soft,  ///< those of the file, or straight_repaired, as upper bounds of a land in equilibrium
    fixed, ///< likewise, kept
    ends   ///< likewise those of sources and outlets, kept; graded between
};

/// What becomes of rivers that end inside the grid.
enum class InlandEnds : std::uint8_t { carry, sink, coast };

/// The keys of section [network] of a recipe.
struct NetworkRecipe {
    Source source = Source::dla;
    std::optional<double> prune_cells; ///< [cells] default 20 for dla and forest, else 0
    Heights heights = Heights::automatic;
    double slope = 0.087;             ///< [m/m] > 0
    double heights_tolerance_m = 1.0; ///< [m] >= 0 by which a DEM may miss heights of a file without a warning
    double concavity = 0.38;          ///< [0, 1] theta of graded heights
    std::optional<Rosgen> rosgen;     ///< type of arcs without one; none: by Strahler order
    network::SlopeDraw rosgen_slope = network::SlopeDraw::middle;
    std::optional<double> rotate_deg; ///< [degrees] counterclockwise; none: at random where rivers are grown for a land
                                      ///< in equilibrium, else 0
    std::optional<double> meander;    ///< [0, 2] of nature's amplitude; none: 1 where rivers are grown likewise, else 0
    InlandEnds inland = InlandEnds::carry;
    bool fill_space = false;          ///< the land's own side valleys become arcs
    std::int64_t support_cells = 200; ///< [cells] that drain through where a side valley begins
    double coast_m = 0.0;             ///< [m] >= 0: nearer to the outlet along the stream rivers are braided
    growth::DlaParams dla;
    growth::BranchChoice branch = growth::BranchChoice::largest;
    LinesRecipe lines;
    TokunagaRecipe tokunaga;
    ForestRecipe forest;
};

/// What a land in equilibrium is like, beside surface.relief and network.concavity.
struct EquilibriumRecipe {
    std::optional<double> mean_slope_deg; ///< none: 25, where no relief is asked
    std::optional<double> steepness;      ///< [m^0.9] none: 45 around rivers of a file without heights, slope or relief
    double hillslope_m = 15.0;            ///< [m] this and what follows as surface::EquilibriumParams
    double debris_area_km2 = 0.045;
    double floor_width = 0.04; ///< [0, 1] 0.04: floors 17 m wide where 1 km² drains, in proportion
    double roughness = 0.22;
    double longest_wave_m = 10'800.0;
    double grain = 5.0;
    std::optional<double> strike_deg;
    std::optional<surface::Edge> edge; ///< none: mainland by coastlines, coast by other sea, else open
    std::optional<double> region;      ///< none: 3 for grown rivers, 1 for those of a file
    std::string uplift;                ///< raster on the grid; "" for none
    std::optional<surface::UpliftPattern> uplift_pattern; ///< none: uplift is the same everywhere, but for the raster
    double uplift_contrast = 4.0;
    double uplift_wave_m = 12'000.0;
    std::string erodibility; ///< raster on the grid, or polygons with a field of that name; "" for none
    std::string lakes;       ///< polygons, with levels or without; "" for none
    std::string like;        ///< DEM whose mean slope and texture the terrain gets; "" for none
    double lake_share = 0.0; ///< [0, 1] of the reaches with enough water, that run through a lake
};

enum class Method : std::uint8_t { equilibrium, dilate, diffuse, tin, regress, raster };

enum class Base : std::uint8_t { harmonic, paper, tin };

enum class Interpolation : std::uint8_t { linear, natural };

/// The keys of section [surface] of a recipe.
struct SurfaceRecipe {
    Method method = Method::equilibrium;
    std::string source; ///< DEM that is the surface; "" for none
    EquilibriumRecipe equilibrium;
    Base base = Base::harmonic;
    surface::DilateParams dilate;
    surface::DiffuseParams diffuse;
    /// polygons: what lies outside is left out; or a raster on the grid: cells with 0 or no data are; "" for none
    std::string mask;
    Interpolation interpolation = Interpolation::linear; ///< of a TIN
    std::optional<double> tolerance;                     ///< (0, 0.1] of a solution; none: that of each method
    skeleton::RegressParams regress;
    std::optional<flow::Conditioning> drain; ///< none: carve where there are rivers, else flow::Conditioning::none
    double max_cut_m = 10.0;                 ///< [m] >= 0 by which rivers may be cut into a DEM without a warning
};

/// The keys of section [strata] of a recipe: how layers of rock lie.
struct StrataRecipe {
    bool repeat = false; ///< layers lie above and below each other again and again
    double base_m = 0.0;
    std::optional<double>
        cap_share; ///< (0, 1) of land that reaches the cap rock; none: heights follow the surface's keys
    double dip_deg = 0.0;
    std::optional<double> strike_deg; ///< none: that of the surface
    double fold_m = 0.0;              ///< amplitude
    double fold_wave_m = 4000.0;
    std::optional<double> fold_axis_deg; ///< none: along the strike of the layers
    double plunge_deg = 0.0;
    double dome_m = 0.0;
    double dome_radius_m = 2500.0;
    std::optional<std::array<double, 2>> dome_at;  ///< [m] none: the middle of the grid
    double fault_m = 0.0;                          ///< throw
    std::optional<double> fault_strike_deg;        ///< none: along the strike of the layers
    std::optional<std::array<double, 2>> fault_at; ///< [m] none: the middle of the grid
    double undulation_m = 0.0;
    double undulation_wave_m = 3000.0;
};

/// What ridges lie midway between: points along the rivers, or the rivers themselves.
enum class Ridges : std::uint8_t { none, voronoi, segments };

/// What else the surface must honour.
struct SkeletonRecipe {
    Ridges ridges = Ridges::none;
    double ridge_gain = 0.3;             ///< [m/m] >= 0, lambda: rise above the rivers by distance from them
    double ridge_farthest_m = 0.0;       ///< [m] >= 0, d_max: distance beyond which they rise no more; 0: none
    double ridge_noise_m = 0.0;          ///< [m] >= 0, amplitude of noise along them
    double ridge_wavelength_m = 1000.0;  ///< [m] > 0, of its longest waves
    double midpoint_inverse_cells = 0.0; ///< [cells] >= 0, L: cells beside the skeleton that follow from it; 0: none
    std::string points;                  ///< file of points with heights; "" for none
    std::string height_column;           ///< of points: their heights; "": their own
    std::optional<double> nodata;        ///< [m] that stands for no data: such points are left out; NaN: none does
    std::string ridge_lines;             ///< file of ridges, with or without heights; "" for none
    std::string ridge_height_column;     ///< of ridge_lines: the height of all of a line; "": those of its vertices
    std::int64_t scatter = 0;            ///< points at random; 0 for none
    double spacing_cells = 0.0;          ///< [cells] least distance of points at random
    skeleton::HeightLaw law = skeleton::HeightLaw::uniform;
    skeleton::Deviation deviation = skeleton::Deviation::exact; ///< of points at random
    skeleton::Falloff falloff = skeleton::Falloff::literal;     ///< of their pull to the extremes
    bool tin = false;                                           ///< write the skeleton's TIN
};

/// The land that the statistics are brought to.
enum class Prior : std::uint8_t { grf, separable, markov3, points };

/// Targets for the terrain as a whole; others stay free.
struct StatisticsRecipe {
    std::optional<double> mean;                  ///< [m]
    std::optional<double> std;                   ///< [m] > 0
    std::optional<std::array<double, 3>> max;    ///< height [m], column, row
    std::optional<std::array<double, 3>> min;    ///< height [m], column, row
    std::optional<std::array<double, 2>> length; ///< [cells] > 0, along rows and along columns
    std::optional<double> slope;                 ///< [rad] (0, pi/2) arctan of metres a cell
    std::optional<double> dimension;             ///< (2, 3)
    Prior skeleton = Prior::grf;
    double reach_cells = 6.0; ///< [cells] >= 0, R of equations 4 and 10; 0 pulls nothing
    skeleton::Falloff falloff = skeleton::Falloff::continuous;
};

enum class DetailMethod : std::uint8_t { none, midpoint };

/// The keys of section [detail] of a recipe.
struct DetailRecipe {
    DetailMethod method = DetailMethod::midpoint;
    fractal::MidpointParams midpoint;
};

/// What becomes of rivers under a patch.
enum class PatchRivers : std::uint8_t { keep, replace };

/// Real relief pasted into the land.
struct PatchRecipe {
    std::string source = {}; ///< DEM
    std::optional<std::array<double, 2>> at =
        {}; ///< [m] where its centre comes to lie; none: where it is, or the middle
    std::optional<std::array<double, 4>> window = {}; ///< [cells] of the source: column, row, width, height
    std::string mask = {};      ///< polygons, or a raster on the grid: what is pasted; "": all that is covered
    double rotate_deg = 0.0;    ///< [degrees] counterclockwise
    double scale = 1.0;         ///< > 0, in plan
    double gain = 1.0;          ///< of its heights
    double feather_cells = 0.0; ///< [cells] over which its slopes take over from the land's
    PatchRivers rivers = PatchRivers::keep;
};

/// Files of a terrain that are chosen together; recipe.toml and report.json are always written.
enum class OutputFiles : std::uint8_t {
    dem,
    network, ///< network.*, network_arcs.shp, network_nodes.shp, lakes.tif
    contours,
    catchments,
    areas, ///< area_d8.tif, area_dinf.tif
    tin,
    pictures, ///< map.png, profile.svg, curve.svg, wireframe.svg, sections.svg
    page,     ///< report.html
    qgis      ///< project.qgz, *.qml
};

/// The keys of section [output] of a recipe.
struct OutputRecipe {
    std::string title;                                  ///< of the pictures and the page; "" names the seed
    double contour_interval = 0.0;                      ///< [units] 0 chooses a round number
    bool catchments = true;                             ///< of the arcs, where there are rivers and a surface
    bool accumulation = false;                          ///< contributing areas by cell, where there is a surface
    bool uplift = false;                                ///< relative uplift by cell, of terrain in equilibrium
    io::Schema schema = io::Schema::native;             ///< another one: a network file more, in its words
    HeightUnit units = HeightUnit::metre;               ///< of heights in dem.tif, networks, contours and TINs
    std::optional<std::vector<OutputFiles>> files = {}; ///< in the order of the enumeration; nothing: all
    std::string against;                                ///< DEM that the terrain is compared with; "" for none

    /// \return whether files are written where the recipe makes them
    bool has(OutputFiles wanted) const;
};

/// Everything that decides a result, as one plain value.
struct Recipe {
    std::uint64_t seed = 7;
    GridRecipe grid;
    std::optional<NetworkRecipe> network;
    std::optional<SkeletonRecipe> skeleton;
    std::optional<SurfaceRecipe> surface;
    std::optional<StrataRecipe> strata;
    std::vector<surface::RockLayer> layers; ///< from the lowest up
    std::optional<StatisticsRecipe> statistics;
    std::optional<DetailRecipe> detail;
    std::vector<PatchRecipe> patches; ///< in their order
    OutputRecipe output;
    std::string folder;                              ///< file names are relative to it; "" is the working folder
    std::map<std::string, std::string> set_at = {};  ///< where keys were set, for messages: "r.toml, line 3" or "--set"
    std::map<std::string, std::string> copy_of = {}; ///< by a copy of a file (see UserFiles): what the user named
};

/// \return what `thalweg make` makes without a recipe; the same as samples/relief.toml.
Recipe default_recipe();

/// \param width,height [cells] of the grid
/// \return the same on another grid: on small ones rivers lie closer.
Recipe default_recipe_on(std::int64_t width, std::int64_t height);

/// \return what it makes where keys of a cluster are set; the same as samples/relief_dla.toml.
Recipe cluster_recipe();

/// What a key of a recipe file means.
struct KeyHelp {
    std::string path;     ///< section.key
    std::string type;     ///< integer | number | text | yes/no | two numbers | list of words
    std::string range;    ///< in words or the choices
    std::string unit;     ///< "" for none
    std::string standard; ///< default as TOML, or in words
    std::string meaning;
    std::vector<std::string> choices = {}; ///< words it may be; of an expression, those with a name; {} for none
    std::string used_by = {};              ///< what a recipe must hold for the key to have an effect; "": any recipe
    bool is_file = false;                  ///< its value names a file, relative to the recipe's folder
    std::optional<double> least = {};      ///< [unit] of a number; with most: none where the range has no such end
    std::optional<double> most = {};       ///< [unit]
};

/// \return every key in the order of recipe files.
std::vector<KeyHelp> recipe_keys();

/// \param section "network", "patch"
/// \return whether it is an array of tables, [[patch]], each of which is one more.
bool is_array_section(std::string const& section);

/// A key that has an effect in a recipe.
struct KeyValue {
    std::string path;                ///< "network.prune", "patch.2.rotate"
    std::optional<std::string> text; ///< as set_key() takes it; nothing: left out
};

/// \return every key that has an effect, in the order of recipe files.
std::vector<KeyValue> key_values(Recipe const& recipe);

/// Reads a recipe from TOML text.
/// \param toml the text of a recipe
/// \param name its name
/// \return the recipe
/// \throws BadParameter with all faults at once: unknown sections and keys (did you mean), wrong types, values out of
/// range. name: for messages
Recipe read_recipe(std::string const& toml, std::string const& name);

/// Sets one key from "section.key=value"; "patch.2.key=value" of the second patch, or a new one after the last. A file
/// is found from the working folder, wherever the recipe lies.
/// \param assignment "section.key=value"
void set_key(Recipe& recipe, std::string const& assignment);

/// Sets one key, as set_key() does.
/// \param path "section.key", "patch.2.key"
/// \param text the value as it stands after "="
void set_key(Recipe& recipe, std::string const& path, std::string const& text);

/// Takes a key back to its default, or a section ("detail") or patch ("patch.2") out of a recipe.
/// \param path of a key or section
/// \throws BadParameter when there is no such key or section, or a recipe cannot be without it
void unset_key(Recipe& recipe, std::string const& path);

/// Checks that a key decides something.
/// \param path "section.key", "patch.2.key"
/// \throws BadParameter when it has no effect in this recipe, with what it needs
void require_effect(Recipe const& recipe, std::string const& path);

/// \return the recipe as TOML: every key that has an effect, defaults too. read_recipe gives it back.
std::string write_recipe(Recipe const& recipe);

/// \return the title of what a recipe makes: output.title, or "thalweg, seed 7" where that is "".
std::string title_of(Recipe const& recipe);

/// \throws BadParameter naming all that does not fit together (a source without its file, ...), and every key that is
/// set away from its default and has no effect
void check_recipe(Recipe const& recipe);

} // namespace thalweg::recipe
