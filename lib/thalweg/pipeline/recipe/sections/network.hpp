// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/network/elevation/river_types.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/network/growth/forest/grow_forest.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/network/import/import_lines.hpp>

namespace thalweg::pipeline {

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
    network::ForestParams growth;          ///< its step and seed follow from the recipe
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
    double snap_m = 0.0;    ///< [m] 0 takes 1e-6 of the box's diagonal
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
    network::SideRule rule = network::SideRule::tokunaga;
    Side mouth = Side::south;   ///< of the grid, in the middle of which the river leaves
    std::string region;         ///< polygon the network fills; "": the grid
    std::string strokes;        ///< directed lines, each of which grows a network; "" grows one in the region
    std::string layer;          ///< of the strokes' file; "" takes the only line layer
    double spacing_cells = 3.0; ///< [cells] >= 0: links closer than this to others are left out
};

enum class Source : std::uint8_t { dla, tokunaga, forest, lines };

enum class Heights : std::uint8_t {
    automatic,
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
    double slope = 0.087;                  ///< [m/m] > 0
    double heights_tolerance_m = 1.0;      ///< [m] >= 0 by which a DEM may miss heights of a file without a warning
    double concavity = 0.38;               ///< [0, 1] theta of graded heights
    std::optional<network::Rosgen> rosgen; ///< type of arcs without one; none: by Strahler order
    network::SlopeDraw rosgen_slope = network::SlopeDraw::middle;
    std::optional<double> rotate_deg; ///< [degrees] counterclockwise; none: at random where rivers are grown for a land
                                      ///< in equilibrium, else 0
    std::optional<double> meander;    ///< [0, 2] of nature's amplitude; none: 1 where rivers are grown likewise, else 0
    InlandEnds inland = InlandEnds::carry;
    bool fill_space = false;          ///< the land's own side valleys become arcs
    std::int64_t support_cells = 200; ///< [cells] that drain through where a side valley begins
    double coast_m = 0.0;             ///< [m] >= 0: nearer to the outlet along the stream rivers are braided
    network::DlaParams dla;
    network::BranchChoice branch = network::BranchChoice::largest;
    LinesRecipe lines;
    TokunagaRecipe tokunaga;
    ForestRecipe forest;
};

} // namespace thalweg::pipeline
