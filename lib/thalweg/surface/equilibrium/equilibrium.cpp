// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/surface/equilibrium/internal/base_levels.hpp>
#include <thalweg/surface/equilibrium/internal/erodibility.hpp>
#include <thalweg/surface/equilibrium/internal/extract_terrain.hpp>
#include <thalweg/surface/equilibrium/internal/given_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/level_layers.hpp>
#include <thalweg/surface/equilibrium/internal/region.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

std::string place(Grid const& grid, std::int64_t cell) {
    Cell const c = grid.at(cell);
    return fmt::format("column {}, row {}", c.col, c.row);
}

void check_params(EquilibriumParams const& params) {
    constexpr char const* self = "surface.equilibrium";
    require_in(self, "theta", params.theta, Range::between(0.1, 0.9));
    require_in(self, "hillslope_m", params.hillslope_m, Range::at_least(0.0), "m");
    require_in(self, "debris_area_m2", params.debris_area_m2, Range::at_least(0.0), "m²");
    require_in(self, "floor_width_km", params.floor_width_km, Range::between(0.0, 1.0), "km");
    require_in(self, "roughness", params.roughness, Range::between(0.0, 1.0));
    require_in(self, "longest_wave_m", params.longest_wave_m, Range::above(0.0), "m");
    require_in(self, "region", params.region, Range::between(1.0, 5.0));
    require_in(self, "grain", params.grain, Range::between(1.0, 20.0));
    if (params.strike_deg) {
        require_in(self, "strike_deg", *params.strike_deg, Range::between(-360.0, 360.0), "degrees");
    }
    if (params.cap_share) {
        require_in(self, "cap_share", *params.cap_share, Range{0.0, 1.0, false, true});
    }
    if (params.relief_m) {
        require_in(self, "relief_m", *params.relief_m, Range::above(0.0), "m");
    } else {
        if (params.steepness) {
            require_in(self, "steepness", *params.steepness, Range::above(0.0), "m^0.9");
        }
        require_in(self, "mean_slope_deg", params.mean_slope_deg, Range{0.0, 60.0, false, true}, "degrees");
    }
}

void check_grid(Grid const& grid) {
    constexpr std::int64_t most = std::int64_t{1} << 30; // cells are numbered in 32 bits, the frame included
    refuse_if<BadInput>(grid.width <= 0 || grid.height <= 0, "surface.equilibrium",
                        "the rivers' grid has no cells; make it at least 1 x 1");
    refuse_if<BadInput>(grid.width > most || grid.height > most || grid.cells() > most, "surface.equilibrium",
                        "the grid of {} x {} cells is too large; {} cells at most", grid.width, grid.height, most);
    refuse_if<BadInput>(!(grid.cell_m > 0.0 && std::isfinite(grid.cell_m)), "surface.equilibrium",
                        "the rivers' cell size is {} m; give one above 0", grid.cell_m);
}

void check_order(Channels const& rivers) {
    Grid const& grid = rivers.grid;
    refuse_if<BadInput>(rivers.cell.empty(), "surface.equilibrium",
                        "there are no rivers; give at least one cell in which water leaves");
    refuse_if<BadInput>(
        rivers.receiver.size() != rivers.cell.size() || (!rivers.z.empty() && rivers.z.size() != rivers.cell.size()) ||
            (!rivers.level.empty() && rivers.level.size() != rivers.cell.size()) ||
            (!rivers.lake_z.empty() && rivers.lake_z.size() != rivers.cell.size()),
        "surface.equilibrium",
        "{} river cells have {} receivers, {} heights, {} marks and {} levels of lakes; give one each",
        rivers.cell.size(), rivers.receiver.size(), rivers.z.size(), rivers.level.size(), rivers.lake_z.size());
    Mask taken(grid);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const cell = rivers.cell[n];
        refuse_if<BadInput>(cell < 0 || cell >= grid.cells(), "surface.equilibrium",
                            "river cell {} lies at index {}, outside the grid of {} cells", n, cell, grid.cells());
        if (taken[cell] != 0) {
            throw BadInput("surface.equilibrium",
                           fmt::format("two rivers in one cell, at {} (the later is river cell {}); join them there",
                                       place(grid, cell), n));
        }
        taken[cell] = 1;
        std::int64_t const receiver = rivers.receiver[n];
        if (receiver < -1 || receiver >= static_cast<std::int64_t>(n)) {
            throw BadInput("surface.equilibrium",
                           fmt::format("river cell {} at {} flows to number {}; list cells downstream first", n,
                                       place(grid, cell), receiver));
        }
        if (receiver >= 0) {
            Cell const a = grid.at(cell);
            Cell const b = grid.at(rivers.cell[receiver]);
            if (std::max(std::abs(a.col - b.col), std::abs(a.row - b.row)) != 1) {
                throw BadInput("surface.equilibrium",
                               fmt::format("river cell {} at {} flows to {}, which is not a neighbour", n,
                                           place(grid, cell), place(grid, grid.index(b))));
            }
        }
    }
}

void check_land(Channels const& rivers, Mask const& land) {
    if (land.cells() == 0) {
        return;
    }
    require_same_grid(land.grid(), rivers.grid, "surface.equilibrium", "the land's mask and the rivers",
                      "make both on one grid");
    auto const values = land.values();
    if (std::none_of(values.begin(), values.end(), [](std::uint8_t v) { return v != 0; })) {
        throw BadInput("surface.equilibrium", "the mask leaves no land; mark at least the rivers' cells as land");
    }
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (land[rivers.cell[n]] == 0) {
            throw BadInput("surface.equilibrium",
                           fmt::format("river cell {} at {} lies at sea; end the river at the coast", n,
                                       place(rivers.grid, rivers.cell[n])));
        }
    }
}

void check_field(Grid const& grid, Raster<float> const& field, Mask const& land, std::string_view name) {
    if (field.cells() == 0) {
        return;
    }
    require_same_grid(field.grid(), grid, "surface.equilibrium", fmt::format("{} and the rivers", name),
                      "make both on one grid");
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        bool const dry = land.cells() == 0 || land[i] != 0;
        if (dry && !(field[i] > 0.0F && std::isfinite(field[i]))) {
            throw BadInput("surface.equilibrium",
                           fmt::format("{} is {} at {}; every cell of land needs a number above 0", name, field[i],
                                       place(grid, i)));
        }
    }
}

/// Checks that heights do not rise downstream, also between prescribed heights with free cells between them.
void check_channel_heights(Channels const& rivers) {
    float const none = std::numeric_limits<float>::quiet_NaN();
    // height of the nearest cell downstream that has one, the cell itself included
    std::vector<float> below(rivers.z.size(), none);
    for (std::size_t n = 0; n < rivers.z.size(); ++n) {
        float const z = rivers.z[n];
        if (std::isinf(z)) {
            throw BadInput("surface.equilibrium", fmt::format("the height of river cell {} at {} is infinite", n,
                                                              place(rivers.grid, rivers.cell[n])));
        }
        std::int64_t const receiver = rivers.receiver[n];
        float const next = receiver < 0 ? none : below[receiver];
        if (z < next) {
            throw BadInput(
                "surface.equilibrium",
                fmt::format("the river rises downstream of cell {} at {}, from {} m to {} m; reverse or repair it", n,
                            place(rivers.grid, rivers.cell[n]), z, next));
        }
        below[n] = std::isnan(z) ? next : z;
    }
}

bool is_level(Channels const& rivers, std::size_t n) {
    return !rivers.level.empty() && rivers.level[n] != 0 && rivers.receiver[n] >= 0;
}

void check_levels(Channels const& rivers) {
    for (std::size_t n = 0; n < rivers.lake_z.size(); ++n) {
        if (std::isinf(rivers.lake_z[n]) || (!std::isnan(rivers.lake_z[n]) && is_level(rivers, n))) {
            throw BadInput("surface.equilibrium",
                           fmt::format("the level of a lake at {} is {} m{}", place(rivers.grid, rivers.cell[n]),
                                       rivers.lake_z[n],
                                       is_level(rivers, n) ? " within a lake; give it to the outlet" : ""));
        }
    }
}

constexpr int fine_rounds = 6;
constexpr int coarse_rounds = 30;
constexpr int more_for_heights = 6;
constexpr int pulled_after = 2; // rounds of the finest level, which has its valleys by then
// factor of the tangent that finally counts as perched: such tips will not be lowered any more
constexpr float of_perched = 3.0F;

/// Layers of rock, which are in metres, and what the solver's units are. Metres per unit change while levels are solved
/// where land is to have a relief.
struct LayersOfLand {
    Strata const& strata;
    bool has_target;
    std::optional<double> cap_share; ///< the target; none: it is the relief
    double metres;                   ///< per unit
    /// greatest height of the land without layers: in metres for the first guess, and in units
    double highest_m;
    double highest;

    HeightConversion conversion() const { return {metres, 0.0, 0.0}; }
    /// [m] No slope between closed edges climbs beyond.
    double most_m() const {
        constexpr double far_above = 2.0;
        return far_above * std::max(highest_m, highest * metres);
    }
};

/// What the land of levels is like.
struct LandOfLevels {
    ErodibilityFields const& fields;
    ErodibilityParams const& rock;
    std::vector<FeatureCell> const& features;
    Grid const& grid; ///< of these
    LayersOfLand const* layers;
};

/// Prepares a level for its rounds.
TerrainLevel prepared(LevelInput&& input, std::size_t number, TerrainLevel const& coarser, TerrainLevel const& region,
                      LandOfLevels const& land, EquilibriumParams const& params, Run const& run) {
    TerrainLevel level;
    level.width = input.extent.width + 2;
    level.height = input.extent.height + 2;
    level.corner = input.extent.corner;
    level.side = static_cast<float>(std::int64_t{1} << number);
    level.rivers = std::move(input.rivers);
    set_cell_types(level, input.land, params.edge, number == 0 ? RiverBanks::kept : RiverBanks::none);
    set_crests(level, land.features, land.grid);
    run.check();
    set_erodibility(level, land.fields, land.rock, run);
    copy_firmness(level, coarser);
    copy_grade(level, coarser);
    if (land.layers != nullptr) {
        level.has_falls = true;
        level.strata =
            level_layers(level, land.layers->strata, land.grid, land.layers->conversion(), land.layers->most_m(), run);
    }
    level.jitter = params.seed;
    run.check();
    if (coarser.z.empty()) {
        start_from_nothing(level, nearest_river(level), params.seed, run);
    } else {
        start_from(level, coarser, params.seed, {}, run);
    }
    start_rivers(level, region.z.empty() ? std::vector<float>{} : end_heights(level, region));
    return level;
}

void check_drained(TerrainLevel const& level, Mask const& land, std::int64_t margin, Grid const& grid) {
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        bool const dry = land.cells() == 0 || land[i] != 0;
        auto const at = static_cast<std::size_t>((c.row + margin + 1) * level.width + c.col + margin + 1);
        refuse_if<BadInput>(
            dry && level.type[at] == CellType::outside, "surface.equilibrium",
            "no river drains the closed land at column {}, row {}; let one run there, or leave the edge open", c.col,
            c.row);
    }
}

/// Frees everything that the next level and the output do not need.
void free_finished_memory(TerrainLevel& level) {
    level.rock = {};
    level.strata = {};
    release(level.uplift);
    release(level.area);
}

/// What finer levels need of the region.
TerrainLevel of_region(TerrainLevel const& level) {
    TerrainLevel around;
    around.width = level.width;
    around.height = level.height;
    around.side = level.side;
    around.corner = level.corner;
    around.z = level.z;
    around.direction = level.direction;
    around.area = level.area;
    return around;
}

/// [log] the ratio of a level's relief or mean slope to its target.
double off_target(TerrainLevel const& level, Window const& window, double metres, EquilibriumParams const& params,
                  Run const& run) {
    double const share = level.side > 1.0F ? coarse_share_of_target(level, window, metres, params, run)
                                           : share_of_target(level, window, metres, params, run);
    return portable::log(std::max(share, 1e-6));
}

/// [log] by how much land is too high or too low for a share of it to reach the cap rock; 0 where it does.
double off_cap_share(TerrainLevel const& level, Window const& window, double metres, double share, std::size_t cap) {
    LevelLayers const& strata = level.strata;
    auto const side = static_cast<double>(level.side);
    double const bottom = cap > 0 ? strata.layers[cap - 1].top : 0.0;
    std::int64_t const step = level.cells() > 1'000'000 ? 2 : 1; // a sample tells as much
    std::vector<float> above;                                    // the cap rock's bottom
    double heights = 0.0;                                        // of that, the sum
    for (std::int64_t row = 1; row < level.height - 1; row += step) {
        double const south = static_cast<double>(level.corner.row) + (static_cast<double>(row) - 0.5) * side;
        for (std::int64_t col = 1; col < level.width - 1; col += step) {
            double const east = static_cast<double>(level.corner.col) + (static_cast<double>(col) - 0.5) * side;
            auto const i = static_cast<std::size_t>(row * level.width + col);
            bool const is_inside = south > 0.0 && east > 0.0 && south < static_cast<double>(window.grid.height) &&
                                   east < static_cast<double>(window.grid.width);
            if (is_inside && (is_land(level.type[i]) || level.type[i] == CellType::river)) {
                double const at = static_cast<double>(strata.bed[i]) + bottom;
                above.push_back(static_cast<float>(static_cast<double>(level.z[i]) - at));
                heights += at;
            }
        }
    }
    if (above.empty()) {
        return 0.0;
    }
    constexpr double near = 0.02;     // of shares
    constexpr double least = 0.05;    // [log] what is not near is off
    constexpr double lowest_m = 10.0; // above the datum: what less means nothing
    auto const count = static_cast<double>(above.size());
    auto const reached = std::count_if(above.begin(), above.end(), [](float z) { return z >= 0.0F; });
    double const too_much = static_cast<double>(reached) / count - share;
    if (std::fabs(too_much) <= near) {
        return 0.0;
    }
    auto const at = above.begin() + static_cast<std::ptrdiff_t>(std::min((1.0 - share) * count, count - 1.0));
    std::nth_element(above.begin(), at, above.end());
    double const height = std::max(metres * heights / count, lowest_m);
    double const off = portable::log(std::max((metres * static_cast<double>(*at) + height) / height, 1e-3));
    return std::copysign(std::max(std::fabs(off), least), too_much);
}

/// Computes the heights of a level from those of the coarser one.
class Solver {
public:
    /// \param features heights above the first river's end, in units
    /// \param extent [finest cells] of all levels
    /// \param layers null: rock without layers
    Solver(EquilibriumParams const& params, Channels const& rivers, std::vector<FeatureCell> const& features,
           Window const& window, double extent, LayersOfLand* layers, Run const& run)
        : params_(params), rivers_(rivers), features_(features), window_(window), run_(run), layers_(layers),
          law_(params, window.grid.cell_m, extent) {}

    /// The frame is set from the nearest rivers where the region has no information.
    void solve(TerrainLevel& level, std::size_t number, std::size_t levels, RegionFrame const& frame) {
        bool const by_rivers = goes_on(params_.edge) && frame.cells.empty();
        BoundaryCells const edge =
            by_rivers ? boundary_cells(level, nearest_river(level), params_.inflow ? Beyond::rivers : Beyond::valleys)
                      : BoundaryCells{};
        set_boundary_heights(level, edge);
        run_.check();
        Pull pull;
        if (!level.crests.empty()) {
            pull.floor.assign(level.z.size(), -std::numeric_limits<float>::infinity());
        }
        flood_terrain(level);
        KnownHeights const known = number == 0 ? known_heights(level, features_, window_.grid) : KnownHeights{};
        std::optional<PullToHeights> heights;
        int rounds = rounds_of(number, levels) + (known.cell.empty() ? 0 : more_for_heights);
        int more_for_target = most_for_target;
        off_before_ = std::numeric_limits<double>::quiet_NaN();
        bool const given = params_.heights != RiverHeights::graded && !level.rivers.asked.empty();
        if (number == 0 && !given && params_.heads == Heads::kept) {
            take(remove_touching_tips(level));
        }
        for (int round = 0; round < rounds; ++round) {
            run_.at(share_done(number, round, rounds), "fill");
            if (round > 0) {
                if (number == 0 && !given) {
                    remove_tips_late(level, rounds - round);
                }
                set_boundary_heights(level, edge);
                lift_frame(level, frame);
                if (!shortened_.empty() || layers_ != nullptr) { // in layers divides meet at walls, too
                    slide_terrain(level, run_);
                }
                set_steepest_receivers(level, run_);
            }
            if (number == 0 && round == floors_after && params_.floor_width_km > 0.0) {
                valley_floors(level, {params_.floor_width_km, window_.grid.cell_m, params_.seed}, run_);
            }
            run_.check();
            accumulate_areas(level, run_);
            run_.check();
            bool const by_turns = params_.heads == Heads::kept && round % 2 == 1; // firmness and grades
            if (by_turns && !given && number > 1) {
                ease_rivers(level, law_);
                if (by_rivers && !params_.inflow) {
                    soften_valleys_beyond(level);
                }
            }
            if (given) {
                relax_given_rivers(level, law_, params_.heights);
            } else if (number > 0) {
                relax_rivers(level, law_);
            } else {
                relax_finest_rivers(level, rounds - round);
            }
            run_.check();
            if (heights) {
                heights->follow_rivers(level, pull);
            } else if (round >= pulled_after && !known.cell.empty()) {
                heights.emplace(level, law_.land, known, pull, run_);
            }
            raise_crests(level, pull.floor);
            relax_terrain(level, law_.land, pull, run_);
            change_erodibility_at_crests(level, run_);
            if (layers_ != nullptr && layers_->has_target) {
                int const more = follow_target(level, rounds - round, number == 0 ? more_for_target : 0);
                rounds += more;
                more_for_target -= more;
            }
            if (by_turns && rounds - round >= to_come_down) {
                // rivers with heights or lakes stand where they are told to
                reduce_erodibility(level, law_, given || !level.rivers.hold.empty() ? 2.0F : 0.3F);
            }
        }
        if (number == 0) {
            run_.check();
            slide_and_remove_tips(level, given);
        }
    }

    std::vector<std::int64_t> const& shortened() const { return shortened_; }
    std::int64_t graded_heads() const { return graded_heads_; }

private:
    /// Few at the finest level, many at the coarsest.
    static int rounds_of(std::size_t number, std::size_t levels) {
        auto const part = static_cast<int>(number * number);
        auto const all = static_cast<int>((levels - 1) * (levels - 1));
        return all == 0 ? coarse_rounds : fine_rounds + (coarse_rounds - fine_rounds) * part / all;
    }

    /// Changes metres per unit by how far land is off its target, and by how far it goes on to move by itself: in
    /// dipping rock it takes rounds to follow.
    /// \param most_rounds that may be added
    /// \return rounds that it needs beyond those that are left
    int follow_target(TerrainLevel& level, int rounds_left, int most_rounds) {
        constexpr double near = 0.035;        // [log]
        constexpr double near_at_last = 0.03; // slides come after it
        constexpr double growth = 0.8;        // of relief with metres per unit, about
        constexpr double ahead = 2.0;         // rounds
        constexpr double widest = 0.3;        // step
        bool const is_last = rounds_left == 1;
        if (!is_last && rounds_left <= settled_rounds) {
            return 0;
        }
        double const off = layers_->cap_share ? off_cap_share(level, window_, layers_->metres, *layers_->cap_share,
                                                              *cap_rock(layers_->strata))
                                              : off_target(level, window_, layers_->metres, params_, run_);
        double const before = std::isnan(off_before_) ? off : off_before_;
        off_before_ = off;
        double const to_come = off + ahead * (off - before);
        bool const is_near =
            is_last ? std::fabs(off) <= near_at_last : std::max(std::fabs(off), std::fabs(to_come)) <= near;
        if (is_near || (is_last && most_rounds == 0)) {
            return 0;
        }
        double const scale = portable::exp(std::clamp(to_come / growth, -widest, widest));
        layers_->metres /= scale;
        for (float& z : level.z) {
            z *= static_cast<float>(scale);
        }
        level.strata.scale(scale);
        level.strata.most = layers_->most_m() / layers_->metres;
        if (is_last) {
            return std::min(most_rounds, settled_rounds + 1);
        }
        return rounds_left == to_come_down + 2 && most_rounds > late_rounds ? 1 : 0;
    }

    /// Removes tips as late as the terrain can still come down where they were.
    void remove_tips_late(TerrainLevel& level, int rounds_left) {
        if (rounds_left == to_come_down || rounds_left == to_come_down + 1) {
            remove_tips(level);
        }
    }

    /// Relaxes rivers with the constraints of the grid's own rivers: no perched head, and water that follows them.
    void relax_finest_rivers(TerrainLevel& level, int rounds_left) {
        relax_rivers(level, law_);
        if (rounds_left <= to_come_down) {
            lower_perched(level, perched_, least_tangent);
        }
        enforce_receivers(level);
    }

    /// Where divides moved in the last round, terrain slides and may leave tips of rivers perched.
    void slide_and_remove_tips(TerrainLevel& level, bool given) {
        slide_terrain(level, run_);
        run_.check();
        if (!given) {
            remove_tips(level);
            lower_perched(level, perched_, least_tangent);
            lower_banks(level, level.bank_rise, least_tangent);
            slide_terrain(level, run_);
            run_.check();
        }
        open_crests(level);
        set_steepest_receivers(level, run_);
        accumulate_areas(level, run_);
    }

    void remove_tips(TerrainLevel& level) {
        HeightConversion raise{};
        if (layers_ != nullptr) {
            raise = {layers_->metres, 0.0, mean_tangent(level, window_, layers_->metres, run_)};
        } else {
            raise = height_conversion_for(level, rivers_, window_, params_, run_);
        }
        perched_ = static_cast<float>(raise.mean_tangent * window_.grid.cell_m / raise.metres);
        level.bank_rise = steepest_bank * perched_ * level.side;
        if (params_.heads == Heads::kept) {
            return;
        }
        take(remove_perched_tips(level, of_perched * perched_, TipBanks::rise));
        std::vector<std::int64_t> const trenched = remove_trenched_tips(level, perched_);
        graded_heads_ += heads_of(trenched);
        take(trenched);
    }

    /// Counts the pieces of rivers that these cells are.
    std::int64_t heads_of(std::vector<std::int64_t> numbers) const {
        std::sort(numbers.begin(), numbers.end());
        return std::count_if(numbers.begin(), numbers.end(), [&](std::int64_t n) {
            return !std::binary_search(numbers.begin(), numbers.end(), rivers_.receiver[n]);
        });
    }

    void take(std::vector<std::int64_t> const& numbers) {
        shortened_.insert(shortened_.end(), numbers.begin(), numbers.end());
    }

    static constexpr int to_come_down =
        3; ///< rounds that the terrain needs where a river was removed or its erodibility lowered
    static constexpr int late_rounds = 9;      ///< more rounds of a level that are kept for its end
    static constexpr int settled_rounds = 2;   ///< the last ones, in which metres per unit stay
    static constexpr int most_for_target = 15; ///< more rounds of a level

    EquilibriumParams const& params_;
    Channels const& rivers_;
    std::vector<FeatureCell> const& features_;
    Window const& window_;
    Run const& run_;
    LayersOfLand* layers_;
    EquilibriumLaw law_;
    double off_before_ = 0.0; ///< [log] from the target, a round before
    float perched_ = 0.0F;    ///< tangent above which river cells count as perched, in the solver's units
    std::vector<std::int64_t> shortened_;
    std::int64_t graded_heads_ = 0;
};

struct EquilibriumSolution {
    TerrainLevel level;
    std::vector<std::int64_t> shortened;
    std::int64_t graded_heads = 0;
    std::int64_t margin = 0;
    bool in_region = false;
    std::vector<RegionInflow> inflows;
    double steepness = 0.0; ///< as stem_steepness()
};

ErodibilityParams erodibility_of(EquilibriumParams const& params, Window const& window) {
    constexpr double radians = portable::pi / 180.0;
    ErodibilityNoise noise;
    noise.longest_wave = params.longest_wave_m / window.grid.cell_m;
    noise.stretch = params.grain;
    noise.strike = (90.0 - params.strike_deg.value_or(random_strike_deg(params.seed))) * radians;
    noise.seed = params.seed;
    return {params.roughness, noise};
}

/// Whether a coarse level is worth a look: not as fine as to keep it waiting, not so coarse that it shows nothing.
bool shows_terrain(TerrainLevel const& level, Grid const& grid) {
    constexpr double most_cells = 600.0 * 600.0;
    constexpr double least_cells = 180.0 * 180.0;
    double const cells = static_cast<double>(grid.cells()) / (static_cast<double>(level.side) * level.side);
    return level.side > 1.0F && cells <= most_cells && cells >= least_cells;
}

/// [finest cells] of the largest level.
double extent_of(std::vector<LevelInput> const& levels) {
    double most = 1.0;
    for (std::size_t number = 0; number < levels.size(); ++number) {
        LevelExtent const& extent = levels[number].extent;
        double const cell = std::ldexp(1.0, static_cast<int>(2 * number));
        most = std::max(most, static_cast<double>(extent.width) * static_cast<double>(extent.height) * cell);
    }
    return most;
}

/// Solves all levels; rivers' heights are in solver units, or free.
/// \param conversion of prescribed heights; null: none are
/// \param layers null: rock without layers
/// \param least_cells a level that has as many is the last one; 0: the finest is
EquilibriumSolution solved(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params,
                           HeightConversion const* conversion, Run const& run, LayersOfLand* layers = nullptr,
                           std::int64_t least_cells = 0) {
    PaddedTerrain land = padded(rivers, fields, params);
    Region const region = region_around(rivers, fields, params);
    std::vector<LevelInput> levels = level_inputs(land, region, rivers.grid, params.seed);
    Window const window{rivers.grid, fields.land, land.margin};
    Solver solver(params, rivers, fields.features, window, extent_of(levels), layers, run);
    ErodibilityParams const rock = erodibility_of(params, window);
    TerrainLevel level;
    TerrainLevel around; // the region's finest level
    double steepness = std::numeric_limits<double>::quiet_NaN();
    std::vector<RegionInflow> inflows;
    for (std::size_t number = levels.size(); number-- > 0;) {
        level = prepared(std::move(levels[number]), number, level, around,
                         {land.fields, rock, fields.features, rivers.grid, layers}, params, run);
        RegionFrame const frame =
            around.z.empty() || !params.inflow ? RegionFrame{} : frame_by_region(level, around, params.seed);
        solver.solve(level, number, levels.size(), frame);
        if (run.preview && shows_terrain(level, rivers.grid)) {
            HeightConversion const of_layers = layers != nullptr ? layers->conversion() : HeightConversion{};
            run.preview(coarse_terrain(level, window, layers != nullptr ? &of_layers : conversion, params, run), false);
        }
        if (region.level > 0 && number == region.level) {
            accumulate_areas(level, run);
            around = of_region(level);
        }
        if (number == 0 && region.level > 0) {
            inflows = inflows_of(level, window.grid, window.margin);
        }
        bool const is_enough = number > 0 && least_cells > 0 && level.cells() >= least_cells;
        if (number == 0 || is_enough) {
            steepness = stem_steepness(level, window.grid.cell_m);
        }
        free_finished_memory(level);
        if (is_enough) {
            return {std::move(level), {}, 0, land.margin, false, {}, steepness};
        }
    }
    check_drained(level, fields.land, land.margin, rivers.grid);
    return {std::move(level),   solver.shortened(), solver.graded_heads(), land.margin, region.level > 0,
            std::move(inflows), steepness};
}

bool asks_heights(Channels const& rivers, EquilibriumParams const& params) {
    return params.heights != RiverHeights::graded &&
           std::any_of(rivers.z.begin(), rivers.z.end(), [](float z) { return !std::isnan(z); });
}

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// The levels of lakes that their water can keep: as wanted, or the least from which it falls to the next such lake and
/// the river's end.
/// \param end_z [m] by number: the height of each end, which stays; NaN: free
std::vector<float> kept_levels(Channels const& rivers, std::vector<float> const& end_z) {
    std::vector<float> kept(rivers.cell.size(), none);
    std::vector<float> lowest(kept.size());
    for (std::size_t n = 0; n < kept.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (r < 0) {
            lowest[n] = std::isnan(end_z[n]) ? -std::numeric_limits<float>::infinity() : end_z[n];
        } else {
            lowest[n] = is_level(rivers, n) ? lowest[r] : least_above(lowest[r]);
        }
        if (!std::isnan(rivers.lake_z[n])) {
            kept[n] = std::max(rivers.lake_z[n], lowest[n]);
            lowest[n] = kept[n];
        }
    }
    return kept;
}

/// The least metres per unit at which heights are numbers that floats tell from those a least step above: else
/// directions of flow may form a circle.
double least_metres(std::vector<float> const& heights_m, double base_m) {
    constexpr double most_units = 4096.0;
    double metres = 0.0;
    for (float const z : heights_m) {
        if (!std::isnan(z)) {
            metres = std::max(metres, (static_cast<double>(z) - base_m) / most_units);
        }
    }
    return metres;
}

/// Height of the solver's 0 if heights are prescribed: the sea, otherwise the lowest of them.
float base_of(Channels const& rivers, Edge edge) {
    float low = std::numeric_limits<float>::infinity();
    for (float const z : rivers.z) {
        low = z < low ? z : low;
    }
    return has_sea(edge) ? 0.0F : low;
}

/// Terrain solved around prescribed heights, and the metres of the solver's unit.
struct ScaledSolution {
    EquilibriumSolution land;
    double metres = 0.0;
};

ScaledSolution solved_terrain(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params,
                              double metres, Run const& run) {
    Channels drawn = rivers;
    double const base_m = base_of(rivers, params.edge);
    for (std::vector<float>* heights : {&drawn.z, &drawn.lake_z}) {
        for (float& z : *heights) {
            z = static_cast<float>((static_cast<double>(z) - base_m) / metres);
        }
    }
    HeightConversion const conversion{metres, base_m, 0.0};
    return {solved(drawn, fields, params, &conversion, run), metres};
}

/// Solves again with other metres per unit until the terrain reaches its target; returns the closest solution.
/// \param solve the terrain for metres per unit
template <class Solve>
ScaledSolution terrain_at_target(Grid const& grid, Mask const& land, EquilibriumParams const& params, double metres,
                                 Run const& run, Solve solve_with) {
    constexpr int most_solves = 6;
    constexpr double near_enough = 0.01;
    constexpr double widest = 2.0;                        // [log] of one step
    auto const off_by = [&](ScaledSolution const& held) { // [log]
        Window const window{grid, land, held.land.margin};
        double const share = share_of_target(held.land.level, window, held.metres, params, run);
        return portable::log(std::max(share, 1e-6));
    };
    ScaledSolution best = solve_with(metres);
    double best_off = off_by(best);
    double at = portable::log(metres);
    double off = best_off;
    double step = -1.5 * off;
    for (int solve = 1; solve < most_solves && std::fabs(best_off) > near_enough; ++solve) {
        step = std::clamp(step, -widest, widest);
        ScaledSolution next = solve_with(portable::exp(at + step));
        double const next_off = off_by(next);
        double const per_step = (next_off - off) / step;
        at += step;
        off = next_off;
        if (std::fabs(off) < std::fabs(best_off)) {
            best = std::move(next);
            best_off = off;
        }
        constexpr double flat = 0.05; // the rivers alone determine the result
        if (!(per_step > flat)) {
            break;
        }
        step = -off / per_step;
    }
    return best;
}

/// Graded rivers with lakes that have levels. Their ends stay at the heights that they have without levels.
class RiversWithLevels {
public:
    /// \param raise of the terrain without levels
    RiversWithLevels(Channels const& rivers, TerrainLevel const& without, HeightConversion const& raise)
        : rivers_(rivers), raise_(raise), ends_(rivers.cell.size(), none) {
        RiverCells const& cells = without.rivers;
        for (std::size_t n = 0; n < cells.cell.size(); ++n) {
            if (cells.number[n] >= 0 && rivers.receiver[cells.number[n]] < 0) {
                ends_[cells.number[n]] = without.z[cells.cell[n]];
            }
        }
    }

    HeightConversion conversion(double metres) const {
        return {metres, raise_.base_m / raise_.metres * metres, raise_.mean_tangent};
    }

    /// Levels that the water can keep, in metres.
    Channels in_metres(double metres) const {
        HeightConversion const raise = conversion(metres);
        Channels out = rivers_;
        out.z = ends_;
        for (float& z : out.z) {
            z = static_cast<float>(raise.base_m + static_cast<double>(z) * metres);
        }
        out.lake_z = kept_levels(out, out.z);
        return out;
    }

    /// Levels and ends in the solver's units.
    Channels in_units(double metres) const {
        HeightConversion const raise = conversion(metres);
        Channels out = in_metres(metres);
        out.z = ends_;
        for (std::size_t n = 0; n < out.z.size(); ++n) {
            if (float& z = out.lake_z[n]; !std::isnan(z)) {
                z = static_cast<float>((static_cast<double>(z) - raise.base_m) / metres);
                out.z[n] = z;
            }
        }
        return out;
    }

private:
    Channels const& rivers_;
    HeightConversion raise_;
    std::vector<float> ends_; ///< in the solver's units, by number
};

/// Terrain around graded rivers, with the levels of lakes that they have.
EquilibriumTerrain graded_terrain(EquilibriumSolution&& land, Channels const& rivers, EquilibriumFields const& fields,
                                  EquilibriumParams const& params, HeightConversion const& raise, Run const& run) {
    Window const window{rivers.grid, fields.land, land.margin};
    EquilibriumTerrain out =
        extract_terrain(std::move(land.level), rivers, window, raise, std::move(land.shortened), params.heads, run);
    out.graded_heads = land.graded_heads;
    out.inflows = std::move(land.inflows);
    out.in_region = land.in_region;
    out.target_share = share_of_target(out.dem, 1.0 / rivers.grid.cell_m, params, run);
    return out;
}

/// \param without the terrain without levels, and the conversion of its heights
EquilibriumTerrain terrain_with_levels(Channels const& rivers, EquilibriumFields const& fields,
                                       EquilibriumParams const& params, EquilibriumSolution&& without,
                                       HeightConversion const& raise, Run const& run) {
    RiversWithLevels const lakes(rivers, without.level, raise);
    without = {};
    double const least = least_metres(rivers.lake_z, 0.0);
    auto const solve = [&](double wanted) {
        double const metres = std::max(wanted, least);
        HeightConversion const conversion = lakes.conversion(metres);
        return ScaledSolution{solved(lakes.in_units(metres), fields, params, &conversion, run), metres};
    };
    ScaledSolution held = params.bring_to_target
                              ? terrain_at_target(rivers.grid, fields.land, params, raise.metres, run, solve)
                              : solve(raise.metres);
    return graded_terrain(std::move(held.land), lakes.in_metres(held.metres), fields, params,
                          lakes.conversion(held.metres), run);
}

/// Terrain around prescribed heights of rivers.
/// \param raise of terrain around graded rivers
EquilibriumTerrain terrain_with_heights(Channels const& rivers, EquilibriumFields const& fields,
                                        EquilibriumParams const& params, HeightConversion const& raise,
                                        Run const& run) {
    auto const base_m = static_cast<double>(base_of(rivers, params.edge));
    double const least = std::max(least_metres(rivers.lake_z, base_m), least_metres(rivers.z, base_m));
    auto const solve = [&](double metres) {
        return solved_terrain(rivers, fields, params, std::max(metres, least), run);
    };
    ScaledSolution held = params.bring_to_target
                              ? terrain_at_target(rivers.grid, fields.land, params, raise.metres, run, solve)
                              : solve(raise.metres);
    HeightConversion const given{held.metres, base_m, raise.mean_tangent};
    Window const window{rivers.grid, fields.land, held.land.margin};
    EquilibriumTerrain land =
        extract_terrain_with_heights(std::move(held.land.level), rivers, window, given, params.heights, run);
    land.target_share = share_of_target(land.dem, 1.0 / rivers.grid.cell_m, params, run);
    return land;
}

/// Metres per unit that give rock without layers its target, on a coarse level.
double metres_without_layers(TerrainLevel const& level, Window const& window, EquilibriumParams const& params,
                             Run const& run) {
    constexpr int most = 24;
    constexpr double near = 1e-3;  // [log]
    constexpr double widest = 1.0; // step, of a function that grows by about as much
    double at = portable::log(window.grid.cell_m);
    for (int k = 0; k < most; ++k) {
        double const off = off_target(level, window, portable::exp(at), params, run);
        if (std::fabs(off) <= near) {
            break;
        }
        at -= std::clamp(off, -widest, widest);
    }
    return portable::exp(at);
}

/// The share of land that reaches the bottom of the cap rock.
double share_at_cap_rock(Raster<float> const& dem, Strata const& strata, double shift_m, Run const& run) {
    Raster<float> const bed = bed_heights(dem.grid(), strata, shift_m, run);
    std::size_t const cap = *cap_rock(strata);
    double const bottom_m = cap > 0 ? stack_of(strata, 0.0, 0.0)[cap - 1].top_m : 0.0;
    std::int64_t land = 0;
    std::int64_t reached = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        land += std::isnan(dem[i]) ? 0 : 1;
        reached += static_cast<double>(dem[i]) - static_cast<double>(bed[i]) >= bottom_m ? 1 : 0;
    }
    return land > 0 ? static_cast<double>(reached) / static_cast<double>(land) : 0.0;
}

/// Terrain in layers of rock around graded rivers. Layers are in metres and the solver is not, so that the number of
/// metres per unit that gives a relief is found while levels are solved. A mean slope and a greatest steepness are
/// those of rock without layers: a plateau has no such slope, whatever its height.
EquilibriumTerrain terrain_in_layers(Channels const& rivers, EquilibriumFields const& fields,
                                     EquilibriumParams const& params, Run const& run) {
    constexpr std::int64_t cells_without = 20'000; // of the coarse level that is solved without layers, at least
    Run quiet = run;
    quiet.preview = nullptr;
    EquilibriumSolution coarse = solved(rivers, fields, params, nullptr, quiet, nullptr, cells_without);
    Window const window{rivers.grid, fields.land, coarse.margin};
    double const wanted = metres_without_layers(coarse.level, window, params, run);
    bool const is_bounded = params.steepness && !params.relief_m && wanted * coarse.steepness > *params.steepness;
    double const guess = is_bounded ? *params.steepness / coarse.steepness : wanted;
    double const share = portable::exp(off_target(coarse.level, window, guess, params, run));
    HeightConversion const unit{1.0, 0.0, 0.0};
    Raster<float> const without = coarse_terrain(coarse.level, window, &unit, params, run);
    double highest = 0.0;
    for (float const z : without.values()) {
        highest = std::isnan(z) ? highest : std::max(highest, static_cast<double>(z));
    }
    coarse = {};
    bool const has_target = params.cap_share || (params.relief_m && params.bring_to_target);
    LayersOfLand layers{fields.strata, has_target, params.cap_share, guess, highest * guess, highest};
    EquilibriumSolution land = solved(rivers, fields, params, nullptr, run, &layers);
    double const metres = layers.metres;
    double const steepness = land.steepness * metres;
    HeightConversion const raise{metres, -lowest_end_of(land.level, rivers, window) * metres,
                                 mean_tangent(land.level, window, metres, run)};
    EquilibriumTerrain out = graded_terrain(std::move(land), rivers, fields, params, raise, run);
    out.strata_shift_m = -raise.base_m;
    auto const highest_m = static_cast<float>(layers.most_m() + raise.base_m);
    out.held_back = std::count_if(out.dem.values().begin(), out.dem.values().end(),
                                  [highest_m](float z) { return z >= 0.9999F * highest_m; });
    out.steepness = steepness;
    out.is_bounded = is_bounded;
    out.target_share = params.relief_m ? out.target_share : share;
    if (params.cap_share) {
        out.cap_share = share_at_cap_rock(out.dem, fields.strata, out.strata_shift_m, run);
    }
    return out;
}

EquilibriumTerrain balanced(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params,
                            Run const& run) {
    Channels drawn = rivers;
    drawn.z.clear();
    drawn.lake_z.clear();
    bool const is_asked = asks_heights(rivers, params);
    bool const by_lakes = has_levels(rivers);
    EquilibriumParams wanted = params;
    // prescribed heights and layers do not depend on the region
    wanted.region = is_asked || !fields.strata.empty() ? 1.0 : params.region;
    wanted.heights = is_asked ? params.heights : RiverHeights::graded;
    if (!fields.strata.empty()) {
        return terrain_in_layers(drawn, fields, wanted, run);
    }
    Run quiet = run; // heights that are prescribed are not in the first solution
    quiet.preview = is_asked || by_lakes ? nullptr : run.preview;
    EquilibriumSolution graded = solved(drawn, fields, wanted, nullptr, quiet);
    Window const window{rivers.grid, fields.land, graded.margin};
    run.check();
    HeightConversion raise = height_conversion_for(graded.level, rivers, window, params, run);
    run.check();
    bool const is_bounded = params.steepness && !params.relief_m && raise.metres * graded.steepness > *params.steepness;
    if (is_bounded) {
        double const lower = *params.steepness / (raise.metres * graded.steepness);
        raise = {raise.metres * lower, raise.base_m * lower, raise.mean_tangent * lower};
    }
    // The scale of heights is known only now, so that prescribed metres can be converted to solver units.
    if (is_asked) {
        graded = {};
        drawn.z = rivers.z;
        return terrain_with_heights(by_lakes ? with_levels(rivers) : drawn, fields, params, raise, run);
    }
    if (by_lakes) {
        return terrain_with_levels(rivers, fields, wanted, std::move(graded), raise, run);
    }
    double const steepness = graded.steepness * raise.metres;
    EquilibriumTerrain land = graded_terrain(std::move(graded), rivers, fields, params, raise, run);
    land.steepness = steepness;
    land.is_bounded = is_bounded;
    return land;
}

void check_layers(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    if (fields.strata.empty()) {
        return;
    }
    Bed const checked(fields.strata);
    refuse_if<BadParameter>(
        params.cap_share && !cap_rock(fields.strata), "surface.equilibrium",
        "no layer is the cap rock: one that is firmer than the one upon it, in a stack without repeats");
    if (asks_heights(rivers, params)) {
        refuse_layers(fields, "prescribed heights of rivers", R"(network.heights = "graded" does without)");
    }
    if (has_levels(rivers)) {
        refuse_layers(fields, "levels of lakes", "leave the levels out");
    }
    if (!fields.features.empty()) {
        refuse_layers(fields, "known points and ridges", "leave them out");
    }
}

/// Known heights as heights above the first river's end, in the solver's units.
std::vector<FeatureCell> in_units(std::vector<FeatureCell> features, EquilibriumTerrain const& land,
                                  Channels const& rivers) {
    double const metres = land.rise * rivers.grid.cell_m;
    auto const end_m = static_cast<double>(land.dem[rivers.cell.front()]);
    for (FeatureCell& feature : features) {
        feature.z = static_cast<float>((static_cast<double>(feature.z) - end_m) / metres);
    }
    return features;
}

/// Solves again where heights are known, as metres per unit follow from the terrain.
EquilibriumTerrain through_features(Channels const& rivers, EquilibriumFields const& fields,
                                    EquilibriumParams const& params, Run const& run) {
    constexpr int solves = 4;
    EquilibriumFields with = fields;
    for (FeatureCell& feature : with.features) {
        feature.z = none;
    }
    EquilibriumTerrain land = balanced(rivers, with, params, run);
    bool const has_heights = std::any_of(fields.features.begin(), fields.features.end(),
                                         [](FeatureCell const& feature) { return !std::isnan(feature.z); });
    for (int solve = 1; has_heights && solve < solves; ++solve) {
        with.features = in_units(fields.features, land, rivers);
        land = balanced(rivers, with, params, run);
    }
    return land;
}

} // namespace

double share_done(std::size_t number, int round, int rounds) {
    double below = 1.0;
    for (std::size_t k = 0; k < number; ++k) {
        below *= 0.25;
    }
    return below * (0.25 + 0.75 * static_cast<double>(round) / static_cast<double>(rounds));
}

void check_rivers(Channels const& rivers, EquilibriumFields const& fields) {
    check_grid(rivers.grid);
    check_order(rivers);
    check_land(rivers, fields.land);
    check_field(rivers.grid, fields.uplift, fields.land, "uplift");
    check_field(rivers.grid, fields.erodibility, fields.land, "erodibility");
    check_features(rivers.grid, fields.features, "surface.equilibrium");
    check_channel_heights(rivers);
    check_levels(rivers);
}

void refuse_layers(EquilibriumFields const& fields, char const* with, char const* instead) {
    refuse_if<BadInput>(!fields.strata.empty(), "surface.equilibrium",
                        "layers of rock cannot be combined with {} yet; {}", with, instead);
}

bool has_levels(Channels const& rivers) {
    return std::any_of(rivers.lake_z.begin(), rivers.lake_z.end(), [](float z) { return !std::isnan(z); });
}

Channels with_levels(Channels rivers) {
    rivers.lake_z = kept_levels(rivers, rivers.z);
    std::vector<float> most(rivers.z.size(), std::numeric_limits<float>::infinity());
    for (std::size_t n = most.size(); n-- > 0;) {
        most[n] = std::isnan(rivers.lake_z[n]) ? most[n] : rivers.lake_z[n];
        if (std::int64_t const r = rivers.receiver[n]; r >= 0) {
            most[r] = std::min(most[r], is_level(rivers, n) ? most[n] : least_below(most[n]));
        }
    }
    std::vector<float> least(most.size(), -std::numeric_limits<float>::infinity());
    for (std::size_t n = 0; n < most.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        float& z = rivers.z[n];
        if (!std::isnan(rivers.lake_z[n])) {
            z = rivers.lake_z[n];
            least[n] = z;
        } else if (r >= 0) {
            least[n] = least[r];
            z = is_level(rivers, n) ? rivers.z[r] : std::isnan(z) ? z : std::max(std::min(z, most[n]), least[n]);
        }
    }
    return rivers;
}

EquilibriumTerrain equilibrium(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params,
                               Run const& run) {
    check_params(params);
    check_rivers(rivers, fields);
    check_layers(rivers, fields, params);
    run.check();
    return fields.features.empty() ? balanced(rivers, fields, params, run)
                                   : through_features(rivers, fields, params, run);
}

} // namespace thalweg::surface
