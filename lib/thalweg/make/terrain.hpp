// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/make/ground.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/rivers.hpp>
#include <thalweg/make/valley_cells.hpp>

namespace thalweg::make {

/// The cells in which rivers run, and how they got their heights.
struct RiverBed {
    ValleyCells valley = {};
    Channels channels = {};         ///< of rivers with which the surface is in equilibrium, and of lakes
    std::int64_t lakes = 0;         ///< in them
    HeightsStatistics heights = {}; ///< of rivers whose heights do not follow from the surface
    std::int64_t grown = 0;         ///< arcs made of valleys that the terrain has beside its rivers
    std::int64_t left_out = 0;      ///< of these valleys
};

/// How water runs over a surface.
struct Water {
    flow::FlowField drainage = {};      ///< of the surface; without cells where there is none
    flow::ContributingAreas areas = {}; ///< of the arcs: by the drainage, or by the nearest river
    bool is_conditioned = false;        ///< the surface was conditioned hydrologically
    flow::DemChange banks = {};         ///< by conditioning, like the following
    flow::DemChange depressions = {};
};

/// What was checked and found while a terrain was made, and how long it took.
struct Notes {
    std::vector<Check> checks = {}; ///< of what the recipe asks of the surface
    std::vector<Finding> findings = {};
    Timings timings_s = {};
};

/// A surface, the rivers with the heights that they have in it, and the water that drains over it.
struct Terrain {
    Grid grid = {};
    Ground ground = {};
    Rivers rivers = {}; ///< without perched tips, with side valleys where they are asked for; without arcs where the
                        ///< recipe has no [network]
    RiverBed bed = {};
    Water water = {};
    Notes notes = {};

    /// \return whether it has a surface; else the recipe asks for rivers alone
    bool has_surface() const { return ground.dem.cells() > 0; }
};

} // namespace thalweg::make
