// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <thalweg/core/chance.hpp>
#include <thalweg/core/elementary.hpp>
#include <thalweg/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t place_stage = 0x7363617474657231; // "scatter1"
constexpr std::uint64_t annulus_stage = 0x7363617474657232;
constexpr std::uint64_t height_stage = 0x7363617474657233;
constexpr std::uint64_t choice_stage = 0x7363617474657234;
constexpr double darts_jam = 0.62;
constexpr double densest = 1.15;
constexpr std::int64_t most_darts = 1'000'000;
constexpr int candidates = 30; // around a point (Bridson)

/// Points with room around them, found again by square tiles of side spacing / sqrt 2: at most one a tile.
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

bool inside(Grid const& grid, Vec2 p) {
    return p.x >= grid.west && p.x < grid.east() && p.y <= grid.north && p.y > grid.south();
}

Vec2 anywhere(Grid const& grid, std::array<std::uint64_t, 4> const& words) {
    return {grid.west + unit(words[0]) * static_cast<double>(grid.width) * grid.cell_m,
            grid.north - unit(words[1]) * static_cast<double>(grid.height) * grid.cell_m};
}

void throw_darts(Crowd& crowd, Grid const& grid, ScatterParams const& params, Run const& run) {
    std::int64_t misses = 0;
    for (std::uint64_t dart = 0; static_cast<std::int64_t>(crowd.places().size()) < params.count; ++dart) {
        if (dart % 65536 == 0) {
            run.at(static_cast<double>(crowd.places().size()) / static_cast<double>(params.count), "scatter");
        }
        Vec2 const p = anywhere(grid, chance_block(params.seed, place_stage, dart));
        if (inside(grid, p) && crowd.has_room(p)) {
            crowd.add(p);
            misses = 0;
        } else if (++misses > most_darts) {
            return;
        }
    }
}

/// Fills the ground from the points that stand already: candidates between one and two spacings around each.
void spread(Crowd& crowd, Grid const& grid, ScatterParams const& params, double spacing_m, Run const& run) {
    if (crowd.places().empty()) {
        for (std::uint64_t dart = 0; crowd.places().empty(); ++dart) {
            Vec2 const p = anywhere(grid, chance_block(params.seed, place_stage, dart));
            if (inside(grid, p)) {
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
        std::size_t const which = static_cast<std::size_t>(chance(params.seed, annulus_stage, turn) % active.size());
        Vec2 const around = crowd.places()[active[which]];
        bool found = false;
        for (std::uint64_t k = 1; k <= candidates && !found; ++k) {
            // In the square of side 4 spacings; what falls outside the annulus is drawn anew.
            for (std::uint64_t again = 0;; ++again) {
                auto const words = chance_block(params.seed, annulus_stage, turn, k, again);
                Vec2 const p{around.x + (4.0 * unit(words[0]) - 2.0) * spacing_m,
                             around.y + (4.0 * unit(words[1]) - 2.0) * spacing_m};
                double const away = distance(p, around);
                if (away < spacing_m || away > 2.0 * spacing_m) {
                    continue;
                }
                if (inside(grid, p) && crowd.has_room(p)) {
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

double normal(std::uint64_t seed, std::uint64_t place) {
    auto const words = chance_block(seed, height_stage, place);
    double const u = 1.0 - unit(words[0]); // (0, 1]
    return std::sqrt(-2.0 * exact::log(u)) * exact::cos(2.0 * exact::pi * unit(words[1]));
}

std::vector<double> heights(std::size_t count, ScatterParams const& params) {
    std::vector<double> z(count);
    double mean = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        z[i] = params.law == HeightLaw::normal ? normal(params.seed, i)
                                               : 2.0 * unit(chance(params.seed, height_stage, i)) - 1.0;
        mean += z[i] / static_cast<double>(count);
    }
    double square = 0.0;
    for (double& v : z) {
        v -= mean;
        square += v * v / static_cast<double>(count);
    }
    double const scale = square > 0.0 ? params.std_m / std::sqrt(square) : 0.0;
    for (double& v : z) {
        v = params.mean_m + v * scale;
    }
    return z;
}

void demand(Grid const& grid, ScatterParams const& p, double spacing_m) {
    auto const refuse = [](std::string const& what) { throw BadParameter("skeleton.scatter: " + what); };
    if (grid.cells() <= 0 || !(grid.cell_m > 0.0)) {
        refuse("the grid has no cells");
    }
    std::int64_t const extremes = (p.highest ? 1 : 0) + (p.lowest ? 1 : 0);
    if (p.count < std::max<std::int64_t>(1, extremes)) {
        refuse(fmt::format("{} points with {} extremes: give 1 or more, the extremes included", p.count, extremes));
    }
    if (!(p.spacing_cells >= 0.0) || !(p.reach_cells >= 0.0) || !(p.std_m >= 0.0) ||
        !std::isfinite(p.spacing_cells + p.reach_cells + p.std_m + p.mean_m)) {
        refuse(fmt::format("spacing {} cells, reach {} cells, deviation {} m: give finite numbers of 0 or more",
                           p.spacing_cells, p.reach_cells, p.std_m));
    }
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
    double const top = p.highest ? p.highest->z : INFINITY;
    double const bottom = p.lowest ? p.lowest->z : -INFINITY;
    if (!(bottom < p.mean_m && p.mean_m < top)) {
        refuse(fmt::format("the mean {} m does not lie between the lowest {} m and the highest {} m", p.mean_m, bottom,
                           top));
    }
}

/// Equation 10: draws a height to an extreme, the whole way at its place, by 1/e at the reach.
void attract(Vec3& point, Vec3 const& extreme, double reach_m) {
    double const away = distance({point.x, point.y}, {extreme.x, extreme.y});
    if (away <= reach_m) {
        double const share = away / reach_m;
        point.z += exact::exp(-share * share) * (extreme.z - point.z);
    }
}

} // namespace

Scattered scatter(Grid const& grid, ScatterParams const& params, Run const& run) {
    double const spacing_m = params.spacing_cells * grid.cell_m;
    demand(grid, params, spacing_m);
    Scattered result;
    result.points.crs = grid.crs;
    result.density = static_cast<double>(params.count) * params.spacing_cells * params.spacing_cells /
                     static_cast<double>(grid.cells());
    // Points may stand on the border itself: what the spacing asks for is a little less than the grid's ground alone.
    double const ground = (static_cast<double>(grid.width) + params.spacing_cells) *
                          (static_cast<double>(grid.height) + params.spacing_cells);
    double const fullest = static_cast<double>(params.count) * params.spacing_cells * params.spacing_cells / ground;
    if (params.count > 1 && fullest > densest) {
        throw BadParameter(fmt::format("skeleton.scatter: {} points {} cells apart have a density of {:.3f}; even the "
                                       "densest packing ends at 1.155: ask for fewer or nearer ones",
                                       params.count, params.spacing_cells, result.density));
    }

    Crowd crowd(grid, spacing_m);
    std::vector<Vec3> extremes;
    for (auto const& extreme : {params.highest, params.lowest}) {
        if (extreme) {
            extremes.push_back(*extreme);
            crowd.add({extreme->x, extreme->y});
        }
    }
    if (result.density > darts_jam) {
        run.say(fmt::format("warning: {} points {} cells apart have a density of {:.3f}, about as dense as points at "
                            "random can stand (0.7)",
                            params.count, params.spacing_cells, result.density));
        spread(crowd, grid, params, spacing_m, run);
    } else {
        throw_darts(crowd, grid, params, run);
    }

    // More than asked for: extremes stay, of the others those that a draw puts first.
    std::vector<Vec2> places(crowd.places().begin() + static_cast<std::ptrdiff_t>(extremes.size()),
                             crowd.places().end());
    auto const wanted = static_cast<std::size_t>(params.count) - extremes.size();
    if (places.size() > wanted) {
        for (std::size_t i = 0; i < wanted; ++i) {
            std::size_t const j =
                i + static_cast<std::size_t>(chance(params.seed, choice_stage, i) % (places.size() - i));
            std::swap(places[i], places[j]);
        }
        places.resize(wanted);
    }
    result.missing = static_cast<std::int64_t>(wanted - places.size());

    std::vector<double> const z = heights(places.size(), params);
    result.points.points = extremes;
    double const top = params.highest ? params.highest->z : INFINITY;
    double const bottom = params.lowest ? params.lowest->z : -INFINITY;
    double const hair = params.highest && params.lowest ? 1e-6 * (top - bottom) : 1e-6;
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec3 point{places[i].x, places[i].y, z[i]};
        for (Vec3 const& extreme : extremes) {
            if (params.reach_cells > 0.0) {
                attract(point, extreme, params.reach_cells * grid.cell_m);
            }
        }
        point.z = std::clamp(point.z, bottom + hair, top - hair);
        result.points.points.push_back(point);
    }
    return result;
}

} // namespace thalweg::skeleton
