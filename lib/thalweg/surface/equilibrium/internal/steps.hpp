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

// Described in docs/algorithms/equilibrium_levels.md.

/// The steps of equilibrium(), by source file.
namespace thalweg::surface {

// equilibrium.cpp: the caller's rivers, and what both solvers of levels have in common

/// Rounds at the finest level before valley floors are formed: areas have settled by then.
inline constexpr int floors_after = 2;

/// The share of all work that is done at a round of a level, which takes a quarter of the time of the next finer one.
double share_done(std::size_t number, int round, int rounds);

/// \throws BadInput as equilibrium()
void check_rivers(Channels const& rivers, EquilibriumFields const& fields);
/// Whether lakes have levels.
bool has_levels(Channels const& rivers);
/// Prescribed heights that follow the levels of lakes: not below those downstream, below those upstream. Ends stay.
Channels with_levels(Channels rivers);

// erodibility.cpp: uplift and erodibility of a level's cells

struct ErodibilityNoise {
    double longest_wave = 360.0; ///< [finest cells]
    int octaves = 8;             ///< from the longest wave, whose variances add up to 1
    double stretch = 1.0;        ///< ratio of lengths along and across the strike
    double strike = 0.0;         ///< [radians] anticlockwise from east
    std::uint64_t seed = 0;
};

/// Fields on the caller's grid, each divided by its mean over land; without cells: none. Values at the border continue
/// beyond the grid.
struct ErodibilityFields {
    Raster<float> uplift;
    Raster<float> erodibility;
};

struct ErodibilityParams {
    double roughness = 0.0; ///< standard deviation of log erodibility
    ErodibilityNoise noise; ///< in finest cells
};

/// Sets erodibility, the cap on slopes and uplift of a level's cells: means of the given fields over each cell, and
/// noise on land (river cells get the mean). Slopes may be steeper at lower erodibility.
void set_erodibility(TerrainLevel& level, ErodibilityFields const& fields, ErodibilityParams const& params,
                     Run const& run);

/// Lowers erodibility along flow paths beside rivers whose heights the terrain there does not reach, so that the
/// terrain rises to them and they need no walls: the divide between a long and a short river lies close to the head of
/// the long one.
void reduce_erodibility(TerrainLevel& level, EquilibriumLaw const& law);

/// The same on the lower sides of crests; on the higher ones it increases.
void change_erodibility_at_crests(TerrainLevel& level, Run const& run);

/// Copies the reduced erodibility of the coarser level, before the first round.
void copy_firmness(TerrainLevel& level, TerrainLevel const& coarser);

// level.cpp: a level before its first round

/// Whether the terrain continues beyond the grid.
inline bool goes_on(Edge edge) {
    return edge == Edge::open || edge == Edge::mainland;
}

/// Whether the sea, at height 0, lies where there is no land.
inline bool has_sea(Edge edge) {
    return edge == Edge::coast || edge == Edge::mainland;
}

/// The solver's domain: the caller's grid plus a margin into which the terrain may continue.
struct PaddedTerrain {
    Grid grid;           ///< without the frame
    std::int64_t margin; ///< [cells] on each side
    RiverCells rivers; ///< in the frame of that grid; rivers that cross the border continue straight through the margin
    Mask land;         ///< without cells: all
    ErodibilityFields fields;
};
PaddedTerrain padded(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// The region of which the caller's grid is a window. Coarse levels are solved on all of it.
struct Region {
    std::size_t level = 0;   ///< number of its finest level; 0: there is no region
    std::int64_t margin = 0; ///< [finest cells] beyond the grid on each side, in whole cells of that level
};

/// A level without its frame.
struct LevelExtent {
    std::int64_t width = 0;
    std::int64_t height = 0;
    Cell corner; ///< as TerrainLevel
};

/// The content of a level's frame before it is solved.
struct LevelInput {
    LevelExtent extent;
    RiverCells rivers;
    Mask land;
};

/// Makes the levels from the finest to one of about forty cells a side, the coarse ones of the region.
std::vector<LevelInput> level_inputs(PaddedTerrain& land, Region const& region, Grid const& grid, std::uint64_t seed);

/// Coarsens a land mask inside a level's frame: 1 if at least half of a cell's finer cells are land; without cells:
/// all.
Mask coarsened(Mask const& land);

/// Sets the type of each cell of a level, from its rivers, the land mask (inside the frame; without cells: all land)
/// and the boundary. kept: cells beside rivers are banks.
enum class RiverBanks : std::uint8_t { none, kept };
void set_cell_types(TerrainLevel& level, Mask const& land, Edge edge, RiverBanks banks);

/// Nodes lie up to a third of a cell from the centres of their cells, at one of eight places along each axis, so that
/// flow directions do not follow the lattice. A code is eastward + jitter_places * southward.
inline constexpr int jitter_places = 8;
inline constexpr int jitter_cell = 10; ///< distances of two places in a cell's side

/// Places every node of a level at random.
void jitter(TerrainLevel& level, std::uint64_t seed, Run const& run);

/// What lies beyond an open boundary.
enum class Beyond : std::uint8_t {
    rivers, ///< a river at every place, as high as the nearest one inside
    valleys ///< basins with rivers of their own, lower than the heads inside
};

/// The boundary cells of open terrain: the frame in order, and land beside masked-out cells.
struct BoundaryCells {
    /// By boundary cell: its index and the river nearest to it.
    struct Part {
        std::vector<std::uint32_t> cell;
        std::vector<std::uint32_t> river; ///< its cell; of the sea the sea cell itself
        std::vector<std::uint32_t> inner; ///< the cell itself, or its neighbour inside the frame
        std::vector<float> far;           ///< [finest cells] from the river; of the sea 0
    };
    Part ring; ///< clockwise from the north-west corner, sea cells included
    Part inside;
    Beyond beyond = Beyond::rivers;
};
BoundaryCells boundary_cells(TerrainLevel const& level, NearestRiver const& near, Beyond beyond);

/// Sets their heights: smoothed along the frame, and above the rivers that they touch. Rivers: as high as the nearest.
/// Valleys: lower by the fall of a river's first reaches, more with distance, but nowhere so low that a large river
/// could not flow from there to one of the grid.
void set_boundary_heights(TerrainLevel& level, BoundaryCells const& edge);

/// Initialises the coarsest level: a gentle rise away from where water leaves, plus random noise.
void start_from_nothing(TerrainLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run);

/// How a level departs from the coarser one.
struct Departure {
    float rough = 0.15F; ///< [cells of the level] random heights
    float bend = 1.0F;   ///< [coarse cells] largest displacement
};

/// Initialises a level: interpolated heights of the coarser one, displaced, plus random noise.
void start_from(TerrainLevel& level, TerrainLevel const& coarse, std::uint64_t seed, Departure const& departure,
                Run const& run);
/// Adds such noise to heights.
void roughen(TerrainLevel& level, std::uint64_t seed, float rough, Run const& run);

/// Sets the heights that are not free: sea, outside, and rivers that rise slightly from their ends. end_z: by river
/// cell, for those that end; empty: 0.
void start_rivers(TerrainLevel& level, std::vector<float> const& end_z = {});

// region.cpp: terrain around the caller's grid

/// Chooses the region; none if the terrain ends at the grid or the sea, rivers end inside, heights are prescribed, or
/// the grid is small.
Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

/// The extent of the region on its finest level.
LevelExtent extent_of(Region const& region, Grid const& grid);

/// Converts rivers of a window's level to the region's frame. Rivers that leave the window continue away from it, with
/// random bends, until they meet another or the region's border.
RiverCells rivers_of_region(RiverCells const& rivers, LevelExtent const& window, LevelExtent const& region,
                            std::int64_t side, std::uint64_t seed);

/// Relates the frame of a window's level and its terrain to the region.
struct RegionFrame {
    struct Cell {
        std::uint32_t cell;
        float z;     ///< of the region's valleys
        float share; ///< [0, 2] of the height of terrain above those valleys: 0 where a valley leaves, 1 on average
    };
    struct Sample {
        std::uint32_t cell;
        float z; ///< of the region's valleys
    };
    std::vector<Cell> cells;
    std::vector<Sample> land; ///< samples well inside
};

/// Sets the boundary conditions of a window's level from the region. The frame is closed where water flows in, which
/// enters at the lowest cell beside it, and open elsewhere.
RegionFrame frame_by_region(TerrainLevel& level, TerrainLevel const& region, std::uint64_t seed);

/// Sets the heights of an open frame: the region's, plus the excess of the terrain inside over the region, whose cells
/// resolve no hillslopes.
void lift_frame(TerrainLevel& level, RegionFrame const& frame);

/// By river cell of a window's level that ends at the frame: the height of the region there.
std::vector<float> end_heights(TerrainLevel const& level, TerrainLevel const& region);

/// Lists where 1000 cells or more drain into the caller's grid, margin cells inside the finest level's frame.
std::vector<RegionInflow> inflows_of(TerrainLevel const& level, Grid const& grid, std::int64_t margin);

// land.cpp: the terrain between rivers

/// Finds a receiver for every cell and raises cells where necessary: banks drain to the steepest river cell beside
/// them, other land by a flood from the outlets. Each land cell ends up at least level.least above its receiver,
/// banks above all river cells beside them. Cells that cannot drain become outside. Source: Barnes 2014, with buckets
/// instead of a heap: cells of one bucket are taken in any order, which changes the order of cells but not the law.
void flood_terrain(TerrainLevel& level);

/// Directs land cells to their steepest neighbour, by the distances of jittered nodes, banks to their steepest river
/// cell. A cell without a lower neighbour keeps its direction: no cell is below its receiver, so that directions never
/// form a cycle.
void set_steepest_receivers(TerrainLevel& level, Run const& run);

/// Computes the contributing area of every cell, and the order of those that drain to a neighbour: follows water from
/// each cell without donors as long as all donors have arrived, in bands of rows on all workers, then across them.
/// \param rows of a band at least
void accumulate_areas(TerrainLevel& level, Run const& run, std::int64_t rows = 128);

/// How a land cell's height follows from its receiver's: rise + share * z, before limits.
struct Relaxation {
    float rise;
    float share;
};

/// What else holds land cells, by cell; empty: nothing.
struct Pull {
    Cells<float> stiffness; ///< of a spring towards a given height, whose force there is part of the uplift
    Cells<float> floor;     ///< least heights
};

/// One sweep over the terrain, receivers first: sets each cell to the height at which uplift balances incision, towards
/// the receiver's new height, and creep, by the neighbours' heights before the sweep (rivers' as they are). Each cell
/// ends up at least level.least above its receiver and at most its cap (banks may have to be higher: above every
/// river cell beside them). steps: memory, kept from round to round.
void relax_terrain(TerrainLevel& level, LandLaw const& law, Pull const& pull, Cells<Relaxation>& steps, Run const& run);

/// Mean slope of the cells that have four neighbours.
double mean_slope_deg(TerrainLevel const& level, Run const& run);

/// Lowers terrain that is far steeper above one of its neighbours than its cap allows: cliffs left by a removed river,
/// which would otherwise retreat by one row of cells a round. Banks and rivers are unchanged. The result is the largest
/// heights that satisfy this; every cell that had a lower neighbour still has one.
void slide_terrain(TerrainLevel& level, Run const& run);

struct FloorParams {
    double width_km = 0.0; ///< half width of a valley floor where 1 km² drains
    double cell_m = 1.0;
    std::uint64_t seed = 0;
};

/// Lowers the cap on slopes beside rivers to form valley floors that widen downstream: flat, with a concave foot as
/// wide again.
void valley_floors(TerrainLevel& level, FloorParams const& params);

// rivers.cpp: heights of rivers, and shortened rivers

/// Tangent of a graded river cell by its contributing area, at most a share of the cap.
float graded_tangent(TerrainLevel const& level, EquilibriumLaw const& law, std::uint32_t i);

/// Long profiles of rivers through prescribed heights: between them as steep as necessary, above the highest graded.
/// \param fall by river cell: of a graded river, to its receiver
/// \param asked by river cell: the prescribed height, or NaN; they do not rise downstream
std::vector<float> heights_through(RiverCells const& rivers, std::vector<float> const& fall, std::vector<float> asked);

/// Sets rivers to their graded heights for their contributing areas: at most a share of the hillslope cap, and not
/// above the terrain two cells away, so that they are not perched. Lakes are level; below those with levels, rivers
/// rise to them whatever the terrain.
void relax_rivers(TerrainLevel& level, EquilibriumLaw const& law);

/// Sets rivers to prescribed heights; between these they are graded as steeply as necessary, above the highest like the
/// other terrain. Fixed: kept, except for a rise of one ulp where necessary. Soft: lowered where the terrain beside is
/// lower, or where water would not run otherwise.
void relax_given_rivers(TerrainLevel& level, EquilibriumLaw const& law, RiverHeights heights);

/// Whether water leaves the caller's grid at river cell n of a level.
bool leaves_grid(RiverCells const& rivers, std::size_t n);

/// Whether a river runs through a cell at its river cell n or within a number of steps downstream.
bool runs_through(RiverCells const& rivers, std::size_t n, std::size_t cell, int steps);

/// Lists river cells, by number in the caller's Channels and in order, that are perched above cells other than their
/// own river's: all, or those in and below lakes with levels.
enum class Walls : std::uint8_t { all, by_lakes, land }; ///< land: above land that lies beside no river
std::vector<std::int64_t> walled_cells(TerrainLevel const& level, float tangent, Walls walls = Walls::all);

/// Lowers such cells as long as they stay a step above their receivers, which are lowered with them over a short
/// distance.
void lower_perched(TerrainLevel& level, float tangent, float step);

/// Raises the terrain two to four cells from a perched river cell, as a slope, until it is no longer perched.
void raise_below_perched(TerrainLevel& level, float tangent);

/// Raises land two cells from a river, banks aside, to the river less a tangent times a cell.
void raise_land_beside(TerrainLevel& level, float tangent);

/// Shortens rivers: removes perched cells near heads and everything upstream of them. Removed cells become land; under
/// `stay`, a bank does not become lower than a river beside it. Returns numbers in the caller's Channels.
enum class TipBanks : std::uint8_t { stay, rise };
std::vector<std::int64_t> remove_perched_tips(TerrainLevel& level, float tangent, TipBanks banks);

/// Removes likewise the cells near heads that lie beside another river's cells, where no terrain fits between them.
std::vector<std::int64_t> remove_touching_tips(TerrainLevel& level);

/// Where rivers lie side by side, adjusts heights so that each river cell's steepest descent leads to its receiver, and
/// a cell at which a river leaves the caller's grid has none in it: lowers the cell or raises its neighbour, in a few
/// passes. Conflicts that cannot be resolved (a receiver's receiver beside the cell) remain. least: the least tangent
/// towards a receiver.
void enforce_receivers(TerrainLevel& level, float least = least_tangent);

// rebuild_steps.cpp: terrain between rivers with known heights

/// nearest_of() with distances along straight lines.
NearestRiver straight_to(TerrainLevel const& level, std::vector<std::uint32_t> const& cells, Run const& run);

/// Part of an array of rows.
struct Rows {
    std::int64_t width;
    std::int64_t height;
    std::int64_t stride; ///< from row to row
};
struct BlurParams {
    std::int64_t reach = 1; ///< [cells] to each side
    int passes = 2;
};
/// Replaces values by their means in a square around each, a few times; beyond the border values continue.
void blur(float* first, Rows const& rows, BlurParams const& params, Run const& run);

/// How terrain that carries its rivers is found.
struct WallParams {
    float tolerance = 0.05F;    ///< [cells of the level] height of a river cell above the land beside it
    float least_height = 0.02F; ///< [cells of the level] of such land above the river that it drains to
    float reach = 3.0F;         ///< [cells of the level] beside a flow path
};
/// Along the flow paths from land beside river cells that stand above it: by how much [log] it has to rise, at most a
/// half; 0 elsewhere; empty: nowhere.
Cells<float> land_below_rivers(TerrainLevel const& level, WallParams const& params, Run const& run);

/// Marks the flow path from a land cell with that, or with how much it has to sink, if the cell shall have a height;
/// the greater of two marks stays.
void mark_to_move(TerrainLevel const& level, std::size_t from, float wanted, WallParams const& params,
                  Cells<float>& marks);
/// Marks of paths that fade beside them; empty: there are none.
Cells<float> spread_along(TerrainLevel const& level, Cells<float> marks, WallParams const& params, Run const& run);

/// By cell of a level: number of the link to which it drains; -1: none. link: by channel number
Cells<std::int32_t> links_of(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run);

/// By cell of a level: distance [cells of the level] to the nearest land that drains to another link than a neighbour,
/// or that is a crest.
Cells<float> distance_to_divides(TerrainLevel const& level, std::vector<std::int32_t> const& link, Run const& run);

// features.cpp: known heights and crests

/// \throws BadInput for cells outside the grid or out of order, or infinite heights. self: the stage
void check_features(Grid const& grid, std::vector<FeatureCell> const& features, char const* self);

/// Terrain on the caller's grid as one level [m], and what its land rises from.
struct OverRivers {
    TerrainLevel level;
    NearestRiver near;
    std::vector<float> river_z; ///< [m] by number
};
OverRivers over_rivers(Raster<float> const& dem, std::vector<std::int64_t> const& rivers, Run const& run);

/// Marks the land cells of a level that crests run through.
void set_crests(TerrainLevel& level, std::vector<FeatureCell> const& features, Grid const& grid);

/// Lets water flow by heights alone.
inline void open_crests(TerrainLevel& level) {
    level.crests.clear();
    level.is_crest.clear();
}

/// Land cells of a level with known heights, ascending; a coarse cell has the mean of its own.
struct KnownHeights {
    std::vector<std::uint32_t> cell;
    std::vector<float> z;
};
KnownHeights known_heights(TerrainLevel const& level, std::vector<FeatureCell> const& features, Grid const& grid);

/// A smooth field with given values at some cells, each fading to 0 over its reach [cells of the level] or sooner.
Cells<float> spread(TerrainLevel const& level, std::vector<std::uint32_t> const& cells,
                    std::vector<float> const& values, std::vector<float> const& reach, Run const& run);

/// Heights that pass through the known ones, changed no farther from these than to the nearest river.
Cells<float> through_known(TerrainLevel const& level, Cells<float> z, KnownHeights const& known,
                           NearestRiver const& near, Run const& run);

/// Pulls land towards known heights above the end of channel 0, less with the distance from them.
class PullToHeights {
public:
    PullToHeights(TerrainLevel& level, LandLaw const& law, KnownHeights known, Pull& pull, Run const& run);
    /// To be called after rivers changed.
    void follow_rivers(TerrainLevel& level, Pull const& pull);

private:
    std::size_t end_ = 0;
    float from_ = 0.0F; ///< height of the end
};

/// Sets the least heights of crest cells: above the land beside them, as far as slopes allow.
void raise_crests(TerrainLevel const& level, Cells<float>& floor);

/// As land_below_rivers() for crests with a higher and a lower side: these shall meet, the higher one sinks (< 0).
Cells<float> land_off_crests(TerrainLevel const& level, WallParams const& params, Run const& run);

/// Along the flow paths from known heights: by how much [log] land has to rise, or to sink (< 0), to have them.
Cells<float> land_off_known(TerrainLevel const& level, KnownHeights const& known, WallParams const& params,
                            Run const& run);

/// Calls visit(cell) for land beside crest cells, which are none and no banks; more than once beside several.
template <class Visit>
void each_beside_crest(TerrainLevel const& level, std::array<std::int64_t, 8> const& offsets, Visit visit) {
    for (std::uint32_t const crest : level.crests) {
        for (std::int64_t const offset : offsets) {
            std::size_t const n = moved(crest, offset);
            if ((level.type[n] == CellType::land || level.type[n] == CellType::rim) && level.is_crest[n] == 0) {
                visit(n);
            }
        }
    }
}
/// Turns water back that new directions lead onto crests. before: directions_beside_crests() as they were.
void keep_off_crests(TerrainLevel& level, std::vector<std::int8_t> const& before);
std::vector<std::int8_t> directions_beside_crests(TerrainLevel const& level);

// extract_terrain.cpp: from the solver's heights to metres

/// [m] The next height of a river from cell to cell where a lake's level leaves no more: an eighth of a millimetre.
inline float least_above(float z) {
    return std::max(z + 0x1p-13F, std::nextafter(z, std::numeric_limits<float>::infinity()));
}
inline float least_below(float z) {
    return std::min(z - 0x1p-13F, std::nextafter(z, -std::numeric_limits<float>::infinity()));
}

/// The ratio of the terrain's relief or mean slope to its target when heights in cells are multiplied by a factor; 1:
/// reached.
double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params, Run const& run);

/// The caller's grid within the finest level.
struct Window {
    Grid const& grid;
    Mask const& land;    ///< without cells: all
    std::int64_t margin; ///< [cells] without the frame
};

/// Conversion from the solver's heights to metres: base_m + metres * z.
struct HeightConversion {
    double metres;
    double base_m;
    double mean_tangent; ///< mean slope of the terrain in metres
};

/// Extracts the caller's grid from terrain around known heights of rivers. Land two cells from a river is raised to it,
/// less the mean slope; walled: numbers of the river cells that stand higher above such land, banks aside.
EquilibriumTerrain extract_rebuilt(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, Run const& run);

/// Chooses the conversion that gives the terrain in a window the target relief or mean slope, with the lowest river end
/// at 0.
HeightConversion height_conversion_for(TerrainLevel const& level, Channels const& rivers, Window const& window,
                                       EquilibriumParams const& params, Run const& run);

/// The ratio of the relief or mean slope in a window to its target, for this number of metres per unit.
double share_of_target(TerrainLevel const& level, Window const& window, double metres, EquilibriumParams const& params,
                       Run const& run);

/// The caller's grid on the cells of a coarse level.
/// \param conversion of the finest level where it is known: with prescribed heights; null: one that gives about the
/// target
/// \return [m]
Raster<float> coarse_terrain(TerrainLevel const& level, Window const& window, HeightConversion const* conversion,
                             EquilibriumParams const& params, Run const& run);

/// Extracts the caller's grid from a solved finest level, in metres, with its flow directions. Tips that are still
/// perched are removed too, unless heads are kept. Lakes have their levels, which their rivers' water can keep.
EquilibriumTerrain extract_terrain(TerrainLevel level, Channels const& rivers, Window const& window,
                                   HeightConversion const& raise, std::vector<std::int64_t> shortened, Heads heads,
                                   Run const& run);

/// The same with rivers at or below their prescribed heights; reports walls and lowered cells.
EquilibriumTerrain extract_terrain_with_heights(TerrainLevel level, Channels const& rivers, Window const& window,
                                                HeightConversion const& raise, RiverHeights heights, Run const& run);

} // namespace thalweg::surface
