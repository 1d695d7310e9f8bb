// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/internal/place_points.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t place_stage = 0x7363617474657231; // "scatter1"
constexpr std::uint64_t annulus_stage = 0x7363617474657232;
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

/// The ground that points may lie on.
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

/// Fills the ground from the points that stand already: candidates between one and two spacings around each.
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
            // In the square of side 4 spacings; what falls outside the annulus is drawn anew.
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

void demand_room(Grid const& grid, PlacePointsParams const& params) {
    // Points may stand on the border itself: what the spacing asks for is a little less than the grid's ground alone.
    double const ground = (static_cast<double>(grid.width) + params.spacing_cells) *
                          (static_cast<double>(grid.height) + params.spacing_cells);
    double const square = static_cast<double>(params.count) * params.spacing_cells * params.spacing_cells;
    if (params.count > 1 && square / ground > densest) {
        throw BadParameter(fmt::format("skeleton.scatter: {} points {} cells apart have a density of {:.3f}; even the "
                                       "densest packing ends at 1.155: ask for fewer or nearer ones",
                                       params.count, params.spacing_cells, square / static_cast<double>(grid.cells())));
    }
}

/// More than asked for: those that a draw puts first.
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

} // namespace

PlacedPoints place_points(Grid const& grid, Mask const& free, PlacePointsParams const& params, Run const& run) {
    demand_room(grid, params);
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
    if (placed.density > darts_jam) {
        run.say(fmt::format("warning: {} points {} cells apart have a density of {:.3f}, about as dense as points at "
                            "random can stand (0.7)",
                            params.count, params.spacing_cells, placed.density));
    }
    if (placed.density > darts_jam && free.cells() == 0) {
        spread(crowd, ground, params, spacing_m, run);
    } else { // which also reaches ground that is cut off
        throw_darts(crowd, ground, params, run);
    }
    auto const first = crowd.places().begin() + static_cast<std::ptrdiff_t>(params.standing.size());
    placed.places.assign(first, crowd.places().end());
    thin_out(placed.places, static_cast<std::size_t>(placed.missing), params.seed);
    placed.missing -= static_cast<std::int64_t>(placed.places.size());
    return placed;
}

} // namespace thalweg::skeleton
