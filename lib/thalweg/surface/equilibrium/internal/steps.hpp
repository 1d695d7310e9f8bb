// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

/// The steps of equilibrium(), by the sources that hold them.
namespace thalweg::surface {

// rock.cpp: what uplift and erodibility a level's cells have

struct RockNoise {
    double longest_wave = 360.0; ///< [finest cells]
    double stretch = 1.0;        ///< along the strike over across it
    double strike = 0.0;         ///< [radians] anticlockwise from east
    std::uint64_t seed = 0;
};

/// Fields on the caller's grid, each divided by its mean over the land; without cells for none. Beyond the grid they
/// are as at its border.
struct RockFields {
    Raster<float> uplift;
    Raster<float> erodibility;
};

struct RockParams {
    double roughness = 0.0; ///< standard deviation of log erodibility
    RockNoise noise;        ///< in finest cells
};

/// Sets erodibility, the cap on slopes and uplift of a level's cells: the given fields' means over each cell, and noise
/// on land (rivers go their even way). The less erodible, the steeper rock may stand.
void set_rock(LandLevel& level, RockFields const& fields, RockParams const& params, Run const& run);

/// Makes rock firmer along the flow paths from beside rivers whose heights the land there lacks, so that the land comes
/// up to them and they need no walls: the divide between a long river and a short one lies beside the long one's head.
void firm_rock(LandLevel& level, EquilibriumLaw const& law);

/// Rock as firm as on the coarser level, before the first round.
void take_firmness(LandLevel& level, LandLevel const& coarser);

// level.cpp: a level before its first round

/// Whether the land goes on beyond the grid.
inline bool goes_on(Edge edge) {
    return edge == Edge::open || edge == Edge::mainland;
}

/// What the solver works on: the caller's grid with a margin around it, in which land may go on.
struct WidenedLand {
    Grid grid;           ///< without the frame
    std::int64_t margin; ///< [cells] on each side
    RiverCells rivers; ///< in the frame of that grid; those that leave by the border go straight on through the margin
    Mask land;         ///< without cells: all
    RockFields fields;
};
WidenedLand widened(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// Land of a level inside its frame, 1 where at least half of the cells it stands for are land; without cells: all.
Mask coarsened(Mask const& land);

/// Says what each cell of a level is, from its rivers, the land (inside the frame; without cells: all) and the edge.
/// With banks: cells beside rivers are banks.
enum class RiverBanks : std::uint8_t { none, kept };
void cover_cells(LandLevel& level, Mask const& land, Edge edge, RiverBanks banks);

/// Nodes lie up to a quarter of a cell from the centres of their cells, at one of eight places each way, so that ways
/// of water do not cling to the lattice. A code is eastward * jitter_stride + southward: the difference of two codes
/// names the vector between two places.
inline constexpr int jitter_places = 8;
inline constexpr int jitter_stride = 2 * jitter_places - 1;
inline constexpr int jitter_codes = (jitter_places - 1) * (jitter_stride + 1);

/// Reciprocal distance of two neighbouring nodes [1/cell] in directions 0..3 of d8_steps, by the code of the one there
/// minus that of the one here, plus jitter_codes.
using JitteredPerLength = std::array<std::array<float, 2 * jitter_codes + 1>, 4>;
JitteredPerLength jittered_per_length();

/// Gives every node of a level its place, at random.
void jitter(LandLevel& level, std::uint64_t seed, Run const& run);

/// What lies beyond an open edge.
enum class Beyond : std::uint8_t {
    rivers, ///< at each place one as high as the nearest inside
    valleys ///< of basins with rivers of their own, which fall away from the heads inside
};

/// The cells at which an open land ends: the frame, once round, and land beside what is masked out.
struct EdgeCells {
    /// By cell: where it is, and the river nearest to it.
    struct Part {
        std::vector<std::uint32_t> cell;
        std::vector<std::uint32_t> river; ///< its cell; of the sea the sea's own
        std::vector<std::uint32_t> inner; ///< the cell itself, or the one beside it inside the frame
        std::vector<float> far;           ///< [finest cells] from the river; of the sea 0
    };
    Part ring; ///< clockwise from the north-west corner, the sea's cells among them
    Part inside;
    Beyond beyond = Beyond::rivers;
};
EdgeCells edge_cells(LandLevel const& level, NearestRiver const& near, Beyond beyond);

/// Sets their heights, along the frame as the mean over a stretch, and above the rivers that they touch. Rivers: as
/// high as the nearest. Valleys: lower by the fall of a river's first reaches, the farther the lower, but nowhere so
/// low that a large river could not flow from there to one of the grid.
void set_edge_heights(LandLevel& level, EdgeCells const& edge);

/// First heights of the coarsest level: a gentle rise away from where water leaves, and chance.
void start_from_nothing(LandLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run);

/// First heights of a level: between those of the coarser one, and chance.
void start_from(LandLevel& level, LandLevel const& coarse, std::uint64_t seed, Run const& run);

/// Sets the heights that are not free: sea, what is outside, and rivers that rise from their ends by little. end_z: by
/// river cell, of those that end; empty: 0.
void start_rivers(LandLevel& level, std::vector<float> const& end_z = {});

// region.cpp: the land around the caller's grid

/// The land of which the caller's grid is a window. Coarse levels are solved on all of it.
struct Region {
    std::size_t level = 0;   ///< number of the finest level that is; 0: there is no region
    std::int64_t margin = 0; ///< [finest cells] beyond the grid on each side, whole cells of that level
};

/// None where the land ends at the grid or the sea, rivers end inside, heights are given, or the grid is small.
Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// A level without its frame.
struct LevelExtent {
    std::int64_t width = 0;
    std::int64_t height = 0;
    Cell corner; ///< as LandLevel
};

/// The extent of the region on its finest level.
LevelExtent extent_of(Region const& region, Grid const& grid);

/// Rivers of a window's level in the frame of the region's. Those that leave the window go on, away from it, with
/// chance in their ways, until they meet another or the region's border.
RiverCells rivers_of_region(RiverCells const& rivers, LevelExtent const& window, LevelExtent const& region,
                            std::int64_t side, std::uint64_t seed);

/// How the frame of a window's level and the land in it stand to the region.
struct RegionFrame {
    struct Cell {
        std::uint32_t cell;
        float z;     ///< of the region's valleys
        float share; ///< [0, 2] of the height of land over those valleys: 0 where a valley leaves, 1 in the mean
    };
    struct Sample {
        std::uint32_t cell;
        float z; ///< of the region's valleys
    };
    std::vector<Cell> cells;
    std::vector<Sample> land; ///< well inside
};

/// Sets what lies around a window's level as the region has it. The frame is closed where water flows in, which is
/// given to the lowest cell beside it, and is open elsewhere.
RegionFrame frame_by_region(LandLevel& level, LandLevel const& region, std::uint64_t seed);

/// Sets the heights of an open frame: the region's, and as much as land inside stands higher than the region, whose
/// cells know no hillslopes.
void lift_frame(LandLevel& level, RegionFrame const& frame);

/// By river cell of a window's level the height of the region there, of those that end at the frame.
std::vector<float> end_heights(LandLevel const& level, LandLevel const& region);

/// Where 1000 cells or more drain into the caller's grid, margin cells inside the finest level's frame.
std::vector<RegionInflow> inflows_of(LandLevel const& level, Grid const& grid, std::int64_t margin);

// land.cpp: the land between rivers

/// Finds every cell a receiver, raising it where it must: banks to the river cell beside them down the steepest slope,
/// other land by a flood from where water leaves. Gives: each land cell above its receiver by least_tangent at least,
/// banks above all river cells beside them. Cells that no water can leave become outside. Source: Barnes 2014, with
/// buckets instead of a heap: heights in one bucket are taken in any order, which costs the order of cells, not the
/// law.
void flood_land(LandLevel& level);

/// Turns land cells to their steepest neighbour, by the distances of jittered nodes, banks to their steepest river
/// cell. A cell without a lower neighbour keeps its way: since no cell lies below its receiver, ways never close to a
/// circle.
void steepest_ways(LandLevel& level, JitteredPerLength const& per_length, Run const& run);

/// Orders the land cells so that each stands before its receiver, and counts the cells that drain through every cell.
/// Leaves are peeled off: from each cell without donors water is followed as far as all donors have arrived.
void order_cells(LandLevel& level);

/// One sweep of Gauss and Seidel over the land, receivers first: each cell to the height at which what is lifted equals
/// what water and creep take away.
/// Gives: each cell above its receiver by least_tangent at least and its cap at most (banks may have to stand higher:
/// above every river cell beside them).
void relax_land(LandLevel& level, EquilibriumLaw const& law);

/// Lowers land that stands far steeper above any of its neighbours than its cap allows: cliffs that a river leaves
/// where it is given up, which would else come down by one row of cells a round. Banks and rivers stay.
/// Gives: the greatest heights that fulfil this; every cell that had a lower neighbour has one.
void slide_land(LandLevel& level);

struct FloorParams {
    double width_km = 0.0; ///< half width of a floor where 1 km² drains
    double cell_m = 1.0;
    std::uint64_t seed = 0;
};

/// Lowers the cap on slopes beside rivers, so that floors form that widen downstream: flat, with a concave foot as wide
/// again. The order of cells is lost: its memory is wanted.
void valley_floors(LandLevel& level, FloorParams const& params);

// rivers.cpp: heights of rivers, and rivers that are shortened

/// Tangent of a graded river cell by the area that drains into it, not more than a share of the cap.
float graded_tangent(LandLevel const& level, EquilibriumLaw const& law, std::uint32_t i);

/// Sets rivers to their graded heights for the areas that drain into them: not steeper than a share of what hillslopes
/// may be, and not above the land two cells away, which would leave them perched. Lakes are level.
void relax_rivers(LandLevel& level, EquilibriumLaw const& law);

/// Sets rivers to the heights that are asked; between them they are graded, as steep as it takes; above the highest as
/// the rest of the land. Fixed: kept, but for the least rise that a float knows. Soft: lowered where the land beside is
/// lower, or where it takes that for water to run.
void relax_given_rivers(LandLevel& level, EquilibriumLaw const& law, RiverHeights heights);

/// Whether water leaves the caller's grid from river cell number n of a level.
bool leaves_grid(RiverCells const& rivers, std::size_t n);

/// Whether a river runs through a cell at its cell number n or within so many steps below.
bool runs_through(RiverCells const& rivers, std::size_t n, std::size_t cell, int steps);

/// Numbers in the caller's Channels of river cells that stand perched above what they do not run through themselves, in
/// order.
std::vector<std::int64_t> walled_cells(LandLevel const& level, float tangent);

/// Lowers such cells as far as they stay a step above their receivers, which are lowered with them for a short way.
void lower_perched(LandLevel& level, float tangent, float step);

/// Raises the land two to four cells from a perched river cell until that stands perched no more, on a slope.
void raise_below_perched(LandLevel& level, float tangent);

/// Shortens rivers by the cells that stand perched near their heads, and what lies upstream of these. What is given up
/// becomes land; where banks stay, none that would lie below a river beside it. Gives: numbers in the caller's
/// Channels.
enum class TipBanks : std::uint8_t { stay, rise };
std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent, TipBanks banks);

/// The same for the cells near heads that lie beside cells of another river: there no land between them fits.
std::vector<std::int64_t> give_up_touching_tips(LandLevel& level);

/// Where rivers lie side by side, sets their heights so that the steepest descent of each cell leads to its receiver,
/// and that of a cell at which a river leaves the caller's grid to none in it: the cell is lowered or its neighbour is
/// raised. A few passes; what cannot be kept (a receiver's receiver beside the cell) stays.
/// Takes: the least tangent towards a receiver.
void keep_to_receivers(LandLevel& level, float least = least_tangent);

// written_land.cpp: from the solver's heights to metres

/// What a land has of the relief or the mean slope that is asked, when heights in cells are multiplied: 1 is all of it.
double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params);

/// The caller's grid within the finest level.
struct Window {
    Grid const& grid;
    Mask const& land;    ///< without cells: all
    std::int64_t margin; ///< [cells] without the frame
};

/// From the solver's heights to metres: base_m + metres * z.
struct Raise {
    double metres;
    double base_m;
    double mean_tangent; ///< of the mean slope of the land in metres
};

/// What gives the land in a window the relief or the mean slope that is asked, the lowest river end at 0.
Raise raise_for(LandLevel const& level, Channels const& rivers, Window const& window, EquilibriumParams const& params);

/// What the land in a window has of the relief or the mean slope that is asked, with heights of so many metres.
double share_of_target(LandLevel const& level, Window const& window, double metres, EquilibriumParams const& params);

/// The caller's grid out of a solved finest level, in metres, with the ways of its water. Tips that are still perched
/// are given up besides those that are shortened already, unless heads are kept.
EquilibriumTerrain written_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                std::vector<std::int64_t> shortened, Heads heads, Run const& run);

/// The same with rivers at the heights that are given, or below them; tells which stand on walls and what was lowered.
EquilibriumTerrain written_given_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                      RiverHeights heights, Run const& run);

} // namespace thalweg::surface
