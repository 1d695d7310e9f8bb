// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

namespace thalweg::skeleton {

Raster<float> attract(Raster<float> dem, Attraction const& attraction) {
    Cell const centre = attraction.centre;
    refuse_if<BadParameter>(!dem.grid().contains(centre), "skeleton.attract",
                            "column {}, row {} is off the grid of {} x {} cells", centre.col, centre.row, dem.width(),
                            dem.height());
    require_in("skeleton.attract", "radius", attraction.radius_cells, Range::above(0.0).or_infinite(), "cells");
    require_in("skeleton.attract", "height", attraction.z, Range::finite(), "m");
    double const square = attraction.radius_cells * attraction.radius_cells;
    double const at_radius = attraction.falloff == Falloff::literal ? 0.0 : portable::exp(-1.0);
    auto const reach = static_cast<std::int64_t>(std::min(attraction.radius_cells, 1e9));
    cells_around(dem.grid(), centre, reach, [&](Cell c) {
        auto const distance = static_cast<double>(squared_cells(c, centre));
        if (distance <= square) {
            double const h = dem[c];
            double const pull = (portable::exp(-distance / square) - at_radius) / (1.0 - at_radius);
            dem[c] = static_cast<float>(h + pull * (attraction.z - h));
        }
    });
    if (!std::isnan(dem[centre])) {
        dem[centre] = static_cast<float>(attraction.z);
    }
    return dem;
}

namespace {

struct PlacePointsParams {
    std::uint64_t seed = 7;
    std::int64_t count = 0;          // >= 0, those that already exist included
    double spacing_cells = 0.0;      // [cells] >= 0
    std::vector<Vec2> standing = {}; // [m] existing places, at least the spacing apart
};

struct PlacedPoints {
    std::vector<Vec2> places; // [m] without the existing ones
    std::int64_t missing = 0; // number that found no room
    double density = 0.0;     // count spacing^2 / area; dart throwing jams at 0.6965, 1.1547 is the densest packing
};

constexpr std::uint64_t place_stage = 0x7363617474657231; // "scatter1"
constexpr std::uint64_t annulus_stage = 0x7363617474657232;
constexpr std::uint64_t choice_stage = 0x7363617474657234;
constexpr double densest = 1.15;
constexpr std::int64_t most_darts = 1'000'000;
constexpr int candidates = 30; // around a point (Bridson)

/// Points at a minimum distance, indexed by square tiles of side spacing / sqrt 2: at most one per tile.
class Crowd {
public:
    Crowd(Grid const& grid, double spacing_m) : grid_(grid), spacing_m_(spacing_m), tile_(spacing_m / std::sqrt(2.0)) {}

    bool has_room(Vec2 p) const {
        if (spacing_m_ == 0.0) {
            return true;
        }
        auto const [column, row] = tile_of(p);
        for (std::int64_t r = row - 2; r <= row + 2; ++r) {
            for (std::int64_t c = column - 2; c <= column + 2; ++c) {
                auto const found = tiles_.find(key(c, r));
                if (found != tiles_.end() && distance(places_[found->second], p) < spacing_m_) {
                    return false;
                }
            }
        }
        return true;
    }
    void add(Vec2 p) {
        if (spacing_m_ > 0.0) {
            auto const [column, row] = tile_of(p);
            tiles_.emplace(key(column, row), places_.size());
        }
        places_.push_back(p);
    }
    std::vector<Vec2> const& places() const { return places_; }

private:
    struct Tile {
        std::int64_t column;
        std::int64_t row;
    };
    Tile tile_of(Vec2 p) const {
        return {static_cast<std::int64_t>(std::floor((p.x - grid_.west) / tile_)),
                static_cast<std::int64_t>(std::floor((grid_.north - p.y) / tile_))};
    }
    static std::uint64_t key(std::int64_t column, std::int64_t row) {
        return (static_cast<std::uint64_t>(row) << 32U) ^ (static_cast<std::uint64_t>(column) & 0xffffffffU);
    }

    Grid const& grid_;
    double spacing_m_;
    double tile_;
    std::vector<Vec2> places_;
    std::unordered_map<std::uint64_t, std::size_t> tiles_;
};

/// The area in which points may lie.
struct Ground {
    Grid const& grid;
    Mask const& free; ///< without cells: the whole grid

    bool holds(Vec2 p) const {
        if (!(p.x >= grid.west && p.x < grid.east() && p.y <= grid.north && p.y > grid.south())) {
            return false;
        }
        Cell const cell = grid.cell_of(p);
        return free.cells() == 0 || (grid.contains(cell) && free[cell] != 0);
    }
    std::int64_t cells() const {
        return free.cells() == 0 ? grid.cells()
                                 : grid.cells() - std::count(free.values().begin(), free.values().end(), 0);
    }
};

Vec2 anywhere(Grid const& grid, std::array<std::uint64_t, 4> const& words) {
    return {grid.west + unit(words[0]) * static_cast<double>(grid.width) * grid.cell_m,
            grid.north - unit(words[1]) * static_cast<double>(grid.height) * grid.cell_m};
}

void throw_darts(Crowd& crowd, Ground const& ground, PlacePointsParams const& params, Run const& run) {
    std::int64_t misses = 0;
    for (std::uint64_t dart = 0; static_cast<std::int64_t>(crowd.places().size()) < params.count; ++dart) {
        if (dart % 65536 == 0) {
            run.at(static_cast<double>(crowd.places().size()) / static_cast<double>(params.count), "scatter");
        }
        Vec2 const p = anywhere(ground.grid, random_block(params.seed, place_stage, dart));
        if (ground.holds(p) && crowd.has_room(p)) {
            crowd.add(p);
            misses = 0;
        } else if (++misses > most_darts) {
            return;
        }
    }
}

/// Fills the area from the existing points: candidates lie between one and two spacings around each.
void spread(Crowd& crowd, Ground const& ground, PlacePointsParams const& params, double spacing_m, Run const& run) {
    if (crowd.places().empty()) {
        for (std::uint64_t dart = 0; crowd.places().empty(); ++dart) {
            Vec2 const p = anywhere(ground.grid, random_block(params.seed, place_stage, dart));
            if (ground.holds(p)) {
                crowd.add(p);
            }
        }
    }
    std::vector<std::size_t> active(crowd.places().size());
    for (std::size_t i = 0; i < active.size(); ++i) {
        active[i] = i;
    }
    for (std::uint64_t turn = 0; !active.empty(); ++turn) {
        if (turn % 4096 == 0) {
            run.check();
        }
        std::size_t const which =
            static_cast<std::size_t>(random_word(params.seed, annulus_stage, turn) % active.size());
        Vec2 const around = crowd.places()[active[which]];
        bool found = false;
        for (std::uint64_t k = 1; k <= candidates && !found; ++k) {
            // In the square of side 4 spacings; candidates outside the annulus are redrawn.
            for (std::uint64_t again = 0;; ++again) {
                auto const words = random_block(params.seed, annulus_stage, turn, k, again);
                Vec2 const p{around.x + (4.0 * unit(words[0]) - 2.0) * spacing_m,
                             around.y + (4.0 * unit(words[1]) - 2.0) * spacing_m};
                double const away = distance(p, around);
                if (away < spacing_m || away > 2.0 * spacing_m) {
                    continue;
                }
                if (ground.holds(p) && crowd.has_room(p)) {
                    active.push_back(crowd.places().size());
                    crowd.add(p);
                    found = true;
                }
                break;
            }
        }
        if (!found) {
            active[which] = active.back();
            active.pop_back();
        }
    }
}

void require_room(Grid const& grid, PlacePointsParams const& params) {
    // Points may lie on the border itself: the spacing requires slightly less than the grid's area.
    double const ground = (static_cast<double>(grid.width) + params.spacing_cells) *
                          (static_cast<double>(grid.height) + params.spacing_cells);
    double const square = static_cast<double>(params.count) * params.spacing_cells * params.spacing_cells;
    if (params.count > 1 && square / ground > densest) {
        throw BadParameter("skeleton.scatter",
                           fmt::format("{} points {} cells apart have a density of {:.3f}; even the densest packing "
                                       "ends at 1.155: ask for fewer or nearer ones",
                                       params.count, params.spacing_cells, square / static_cast<double>(grid.cells())));
    }
}

/// Reduces the points to the wanted number, in random order.
void thin_out(std::vector<Vec2>& places, std::size_t wanted, std::uint64_t seed) {
    if (places.size() <= wanted) {
        return;
    }
    for (std::size_t i = 0; i < wanted; ++i) {
        std::size_t const j = i + static_cast<std::size_t>(random_word(seed, choice_stage, i) % (places.size() - i));
        std::swap(places[i], places[j]);
    }
    places.resize(wanted);
}

// Finds places at distances >= spacing exactly; returns count points, or the number missing. free: cells that may
// contain points (not 0); without cells: all of the grid. Throws BadParameter, with the density, when no packing on the
// whole grid could hold the points. Source: Zhang, Liu and Li, equations 6, 7 and 11; dart throwing, above a density of
// 0.62 on a whole grid Bridson 2007 (denser).
PlacedPoints place_points(Grid const& grid, Mask const& free, PlacePointsParams const& params, Run const& run) {
    require_room(grid, params);
    Ground const ground{grid, free};
    std::int64_t const cells = ground.cells();
    PlacedPoints placed;
    placed.missing = params.count - static_cast<std::int64_t>(params.standing.size());
    if (cells == 0) {
        return placed;
    }
    placed.density =
        static_cast<double>(params.count) * params.spacing_cells * params.spacing_cells / static_cast<double>(cells);
    double const spacing_m = params.spacing_cells * grid.cell_m;
    Crowd crowd(grid, spacing_m);
    for (Vec2 const p : params.standing) {
        crowd.add(p);
    }
    if (placed.density > darts_density && free.cells() == 0) {
        spread(crowd, ground, params, spacing_m, run);
    } else { // which also reaches separate areas
        throw_darts(crowd, ground, params, run);
    }
    auto const first = crowd.places().begin() + static_cast<std::ptrdiff_t>(params.standing.size());
    placed.places.assign(first, crowd.places().end());
    thin_out(placed.places, static_cast<std::size_t>(placed.missing), params.seed);
    placed.missing -= static_cast<std::int64_t>(placed.places.size());
    return placed;
}

constexpr std::uint64_t height_stage = 0x7363617474657233; // "scatter3"

bool inside(Grid const& grid, Vec2 p) {
    return p.x >= grid.west && p.x < grid.east() && p.y <= grid.north && p.y > grid.south();
}

double normal(std::uint64_t seed, std::uint64_t place) {
    auto const words = random_block(seed, height_stage, place);
    double const u = 1.0 - unit(words[0]); // (0, 1]
    return std::sqrt(-2.0 * portable::log(u)) * portable::cos(2.0 * portable::pi * unit(words[1]));
}

/// Draws numbers by the law: uniform in [-1, 1), or normal.
std::vector<double> drawn(std::size_t count, ScatterParams const& params) {
    std::vector<double> z(count);
    for (std::size_t i = 0; i < count; ++i) {
        z[i] = params.law == HeightLaw::normal ? normal(params.seed, i)
                                               : 2.0 * unit(random_word(params.seed, height_stage, i)) - 1.0;
    }
    return z;
}

/// Shifts numbers to mean 0.
/// \return their standard deviation
double centre(std::vector<double>& z) {
    auto const count = static_cast<double>(z.size());
    double mean = 0.0;
    for (double const v : z) {
        mean += v / count;
    }
    double square = 0.0;
    for (double& v : z) {
        v -= mean;
        square += v * v / count;
    }
    return std::sqrt(square);
}

std::vector<double> heights(std::size_t count, ScatterParams const& params) {
    std::vector<double> z = drawn(count, params);
    double scale = params.std_m;
    if (params.deviation == Deviation::exact) {
        double const deviation = centre(z);
        scale = deviation > 0.0 ? params.std_m / deviation : 0.0;
    }
    for (double& v : z) {
        v = params.mean_m + v * scale;
    }
    return z;
}

void require(Grid const& grid, ScatterParams const& p, double spacing_m) {
    auto const refuse = [](std::string const& what) { throw BadParameter("skeleton.scatter", what); };
    if (grid.cells() <= 0 || !(grid.cell_m > 0.0)) {
        refuse("the grid has no cells");
    }
    std::int64_t const extremes = (p.highest ? 1 : 0) + (p.lowest ? 1 : 0);
    if (p.count < std::max<std::int64_t>(1, extremes)) {
        refuse(fmt::format("{} points with {} extremes: give 1 or more, the extremes included", p.count, extremes));
    }
    require_in("skeleton.scatter", "spacing", p.spacing_cells, Range::at_least(0.0), "cells");
    require_in("skeleton.scatter", "reach", p.reach_cells, Range::at_least(0.0), "cells");
    require_in("skeleton.scatter", "deviation", p.std_m, Range::at_least(0.0), "m");
    require_in("skeleton.scatter", "mean", p.mean_m, Range::finite(), "m");
    for (auto const& extreme : {p.highest, p.lowest}) {
        if (extreme && !(inside(grid, {extreme->x, extreme->y}) && std::isfinite(extreme->z))) {
            refuse(fmt::format("the extreme at ({}, {}) with {} m does not lie on the grid", extreme->x, extreme->y,
                               extreme->z));
        }
    }
    if (p.highest && p.lowest) {
        double const apart = distance({p.highest->x, p.highest->y}, {p.lowest->x, p.lowest->y});
        if (apart == 0.0 || apart < spacing_m) {
            refuse(fmt::format("highest and lowest are {} m apart, the spacing is {} m", apart, spacing_m));
        }
    }
    double const top = p.highest ? p.highest->z : std::numeric_limits<double>::max();
    double const bottom = p.lowest ? p.lowest->z : std::numeric_limits<double>::lowest();
    if (!(bottom < p.mean_m && p.mean_m < top)) {
        refuse(fmt::format("the mean {} m does not lie between the lowest {} m and the highest {} m", p.mean_m, bottom,
                           top));
    }
}

/// Equation 10: moves a height towards an extreme, fully at its place; at the reach by 1/e as printed, or not at all.
void attract(Vec3& point, Vec3 const& extreme, double reach_m, Falloff falloff) {
    double const away = distance({point.x, point.y}, {extreme.x, extreme.y});
    if (away <= reach_m) {
        double const share = away / reach_m;
        double const at_reach = falloff == Falloff::literal ? 0.0 : portable::exp(-1.0);
        point.z += (portable::exp(-share * share) - at_reach) / (1.0 - at_reach) * (extreme.z - point.z);
    }
}

constexpr std::uint64_t share_stage = 0x7363617474657235; // "scatter5"
constexpr double nearest_allowed_cells = 2.0;

void require(Valley const& valley, Mask const& inside, ScatterBetweenParams const& p) {
    constexpr char const* stage = "skeleton.scatter_between";
    require_in(stage, "count", p.count, Range::at_least(0));
    require_in(stage, "spacing", p.spacing_cells, Range::at_least(0.0), "cells");
    require_in(stage, "gain", p.gain, Range::at_least(0.0));
    require_in(stage, "farthest", p.farthest_m, Range::at_least(0.0), "m");
    if (inside.cells() > 0) {
        require_same_grid(inside.grid(), valley.z.grid(), "skeleton.scatter_between", "the mask and the valley",
                          "make both on one grid");
    }
}

Mask rivers_of(Valley const& valley) {
    Mask rivers(valley.z.grid());
    for (std::int64_t i = 0; i < rivers.cells(); ++i) {
        rivers[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    refuse_if<BadInput>(std::find(rivers.values().begin(), rivers.values().end(), 1) == rivers.values().end(),
                        "skeleton.scatter_between", "no cell has a river; points need one to stand above");
    return rivers;
}

double distance_cells(Grid const& grid, std::int64_t a, std::int64_t b) {
    return std::sqrt(static_cast<double>(squared_cells(grid.at(a), grid.at(b))));
}

/// Evenly spaced cell centres along the grid's border, corners included: as many as evenly spread points would put
/// there.
std::vector<Vec2> border_places(Grid const& grid, std::int64_t count) {
    double const apart = std::sqrt(static_cast<double>(grid.cells()) / static_cast<double>(count)); // [cells]
    auto const parts = [apart](std::int64_t side) {
        return std::clamp<std::int64_t>(std::llround(static_cast<double>(side - 1) / apart), 1,
                                        std::max<std::int64_t>(1, side - 1));
    };
    std::vector<Vec2> places;
    auto const put = [&](std::int64_t col, std::int64_t row) { places.push_back(grid.centre({col, row})); };
    for (std::int64_t k = 0, n = parts(grid.width); k < n; ++k) {
        put(k * (grid.width - 1) / n, 0);
        put((k + 1) * (grid.width - 1) / n, grid.height - 1);
    }
    for (std::int64_t k = 0, n = parts(grid.height); k < n; ++k) {
        put(0, (k + 1) * (grid.height - 1) / n);
        put(grid.width - 1, k * (grid.height - 1) / n);
    }
    return places;
}

/// Selects up to count of these places that lie in free cells and keep the spacing.
std::vector<Vec2> with_room(std::vector<Vec2> const& places, Mask const& free, ScatterBetweenParams const& params) {
    double const spacing_m = params.spacing_cells * free.grid().cell_m;
    std::vector<Vec2> kept;
    for (Vec2 const p : places) {
        bool const has_room =
            std::all_of(kept.begin(), kept.end(), [&](Vec2 q) { return p != q && distance(p, q) >= spacing_m; });
        if (has_room && free[free.grid().cell_of(p)] != 0 && static_cast<std::int64_t>(kept.size()) < params.count) {
            kept.push_back(p);
        }
    }
    return kept;
}

double share_of(std::uint64_t place, ScatterBetweenParams const& params) {
    if (params.law == HeightLaw::uniform) {
        return unit(random_word(params.seed, share_stage, place));
    }
    for (std::uint64_t again = 0;; ++again) {
        auto const words = random_block(params.seed, share_stage, place, again);
        double const share = 0.5 + normal_pair(words[0], words[1])[0] / 6.0;
        if (share >= 0.0 && share <= 1.0) {
            return share;
        }
    }
}

} // namespace

ScatteredPoints scatter(Grid const& grid, ScatterParams const& params, Run const& run) {
    double const spacing_m = params.spacing_cells * grid.cell_m;
    require(grid, params, spacing_m);
    std::vector<Vec3> extremes;
    PlacePointsParams placing{params.seed, params.count, params.spacing_cells};
    for (auto const& extreme : {params.highest, params.lowest}) {
        if (extreme) {
            extremes.push_back(*extreme);
            placing.standing.push_back({extreme->x, extreme->y});
        }
    }
    PlacedPoints const placed = place_points(grid, {}, placing, run);
    std::vector<Vec2> const& places = placed.places;
    ScatteredPoints result;
    result.points.crs = grid.crs;
    result.missing = placed.missing;
    result.density = placed.density;

    std::vector<double> const z = heights(places.size(), params);
    result.points.points = extremes;
    double const top = params.highest ? params.highest->z : std::numeric_limits<double>::max();
    double const bottom = params.lowest ? params.lowest->z : std::numeric_limits<double>::lowest();
    double const hair = params.highest && params.lowest ? 1e-6 * (top - bottom) : 1e-6;
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec3 point{places[i].x, places[i].y, z[i]};
        for (Vec3 const& extreme : extremes) {
            if (params.reach_cells > 0.0) {
                attract(point, extreme, params.reach_cells * grid.cell_m, params.falloff);
            }
        }
        point.z = std::clamp(point.z, bottom + hair, top - hair);
        result.points.points.push_back(point);
    }
    return result;
}

ScatteredPoints scatter_between(Valley const& valley, Mask const& inside, ScatterBetweenParams const& params,
                                Run const& run) {
    require(valley, inside, params);
    Grid const& grid = valley.z.grid();
    Raster<std::int64_t> const nearest = nearest_cells(rivers_of(valley), run);
    double const clear = std::max(params.spacing_cells, nearest_allowed_cells);
    Mask free(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        bool const may_be = inside.cells() == 0 || inside[i] != 0;
        free[i] = may_be && distance_cells(grid, i, nearest[i]) >= clear ? 1 : 0;
    }
    ScatteredPoints result;
    result.points.crs = grid.crs;
    if (params.count == 0) {
        return result;
    }
    std::vector<Vec2> places = with_room(border_places(grid, params.count), free, params);
    PlacedPoints const placed =
        place_points(grid, free, {params.seed, params.count, params.spacing_cells, places}, run);
    places.insert(places.end(), placed.places.begin(), placed.places.end());
    result.missing = placed.missing;
    result.density = placed.density;
    double const most =
        params.farthest_m > 0.0 ? params.farthest_m / grid.cell_m : std::numeric_limits<double>::infinity();
    for (std::uint64_t number = 0; Vec2 const p : places) {
        std::int64_t const cell = grid.index(grid.cell_of(p));
        double const rise = params.gain * std::min(distance_cells(grid, cell, nearest[cell]), most) * grid.cell_m;
        result.points.points.push_back(
            {p.x, p.y, static_cast<double>(valley.z[nearest[cell]]) + rise * share_of(number++, params)});
    }
    return result;
}

} // namespace thalweg::skeleton
