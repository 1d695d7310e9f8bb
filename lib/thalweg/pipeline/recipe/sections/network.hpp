// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/network/elevation/rosgen.hpp>
#include <thalweg/network/elevation/set_heights_by_type.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/network/growth/dla/pick_branch.hpp>
#include <thalweg/pipeline/recipe/sections/forest.hpp>
#include <thalweg/pipeline/recipe/sections/lines.hpp>
#include <thalweg/pipeline/recipe/sections/tokunaga.hpp>

namespace thalweg::pipeline {

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
