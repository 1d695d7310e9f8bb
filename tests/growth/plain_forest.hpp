// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/forest/internal/grow_forest.hpp>

/// The rules of grow_forest written out: every step of a walker is a unit step, every question is asked of all
/// particles.
namespace plain_forest {

using thalweg::Cell;
using thalweg::Mask;
using thalweg::RandomStream;
using thalweg::growth::ForestParams;
using thalweg::growth::GrownForest;

inline std::int64_t squared_distance(Cell a, Cell b) {
    return (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row);
}

inline std::vector<Cell> neighbours(Cell c) {
    return {{c.col, c.row - 1}, {c.col + 1, c.row}, {c.col, c.row + 1}, {c.col - 1, c.row}};
}

inline Mask reached_from(std::vector<Cell> const& seeds, Mask const& region) {
    Mask reached(region.grid(), 0);
    for (Cell const s : seeds) {
        reached[s] = 1;
    }
    for (bool more = true; more;) {
        more = false;
        for (std::int64_t i = 0; i < region.cells(); ++i) {
            for (Cell const n : neighbours(region.grid().at(i))) {
                if (region[i] != 0 && reached[i] == 0 && region.grid().contains(n) && reached[n] != 0) {
                    reached[i] = 1;
                    more = true;
                }
            }
        }
    }
    return reached;
}

class Trees {
public:
    Trees(Mask const& region, std::int64_t step) : region_(region), step_(step) {}

    void add(Cell c, std::int64_t parent) {
        cells_.push_back(c);
        parents_.push_back(parent);
    }

    bool is_land(Cell c) const { return region_.grid().contains(c) && region_[c] != 0; }

    /// Nearer than a step to a particle.
    bool within(Cell c) const {
        return std::ranges::any_of(cells_, [&](Cell p) { return squared_distance(p, c) < step_ * step_; });
    }

    /// Beside the cells of the region that lie within a tree.
    bool arrived(Cell c) const {
        return !within(c) && std::ranges::any_of(neighbours(c), [&](Cell n) { return is_land(n) && within(n); });
    }

    std::int64_t nearest(Cell c) const {
        auto const at = std::ranges::min_element(cells_, {}, [&](Cell p) { return squared_distance(p, c); });
        return at - cells_.begin();
    }

    bool may_hold(Cell c) const {
        if (!is_land(c) || !arrived(c)) {
            return false;
        }
        auto const on = static_cast<std::size_t>(nearest(c));
        for (std::size_t p = 0; p < cells_.size(); ++p) {
            auto const far = static_cast<double>(squared_distance(cells_[p], c));
            auto const step2 = static_cast<double>(step_ * step_);
            double const keeps = p == on                                        ? 1.0
                                 : parents_[on] == static_cast<std::int64_t>(p) ? 2.5
                                 : parents_[p] == static_cast<std::int64_t>(on) ? 1.5
                                                                                : 4.0;
            if (far < keeps * step2) {
                return false;
            }
        }
        return true;
    }

private:
    Mask const& region_;
    std::int64_t step_;
    std::vector<Cell> cells_;
    std::vector<std::int64_t> parents_;
};

inline void step(Cell& at, Trees const& trees, RandomStream& random) {
    Cell const next = neighbours(at)[random.word() % 4];
    if (trees.is_land(next) && !trees.within(next)) {
        at = next;
    }
}

inline GrownForest grow(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params) {
    Mask const reached = reached_from(seeds, region);
    Trees trees(reached, params.step_cells);
    GrownForest forest;
    std::vector<int> visits(static_cast<std::size_t>(region.cells()), 0);
    auto const add = [&](Cell c, std::int64_t parent) {
        trees.add(c, parent);
        forest.cells.push_back(c);
        forest.parent.push_back(parent);
    };
    for (Cell const s : seeds) {
        add(s, -1);
    }
    std::vector<Cell> cells;
    for (std::int64_t i = 0; i < region.cells(); ++i) {
        if (reached[i] != 0) {
            cells.push_back(region.grid().at(i));
        }
    }
    auto const room = [&] { return std::ranges::any_of(cells, [&](Cell c) { return trees.may_hold(c); }); };
    bool is_room = room();
    while (is_room) {
        RandomStream random(params.seed, 78, static_cast<std::uint64_t>(forest.walkers++));
        Cell at = cells[random.word() % cells.size()];
        while (!trees.within(at)) {
            if (!trees.arrived(at)) {
                step(at, trees, random);
                continue;
            }
            if (!trees.may_hold(at) || ++visits[static_cast<std::size_t>(region.grid().index(at))] < params.visits) {
                break;
            }
            if (random.real() < params.sticking) {
                add(at, trees.nearest(at));
                is_room = room();
                break;
            }
            step(at, trees, random);
        }
    }
    return forest;
}

/// Where walkers from a few free cells arrive beside trees that stand.
inline std::vector<Cell> starts(Mask const& region, Trees const& trees) {
    std::vector<Cell> free;
    for (std::int64_t i = 0; i < region.cells(); ++i) {
        Cell const c = region.grid().at(i);
        if (region[i] != 0 && !trees.within(c)) {
            free.push_back(c);
        }
    }
    return free;
}

inline Trees trees_of(Mask const& region, GrownForest const& forest, std::int64_t step) {
    Trees trees(region, step);
    for (std::size_t p = 0; p < forest.cells.size(); ++p) {
        trees.add(forest.cells[p], forest.parent[p]);
    }
    return trees;
}

inline std::vector<std::int64_t> arrivals_by_steps(Mask const& region, GrownForest const& forest, std::int64_t size,
                                                   std::int64_t walkers, std::uint64_t seed) {
    Trees const trees = trees_of(region, forest, size);
    Mask within(region.grid(), 0);
    Mask arrived(region.grid(), 0);
    for (std::int64_t i = 0; i < region.cells(); ++i) {
        within[i] = region[i] == 0 || trees.within(region.grid().at(i)) ? 1 : 0;
        arrived[i] = trees.arrived(region.grid().at(i)) ? 1 : 0;
    }
    std::vector<Cell> const free = starts(region, trees);
    std::vector<std::int64_t> hits;
    for (std::int64_t w = 0; w < walkers; ++w) {
        RandomStream random(seed, 79, static_cast<std::uint64_t>(w));
        Cell at = free[random.word() % free.size()];
        std::uint64_t bits = 0;
        for (int left = 0; arrived[at] == 0; --left) {
            if (left == 0) {
                bits = random.word();
                left = 32;
            }
            std::uint64_t const way = bits & 3;
            bits >>= 2;
            std::int64_t const by = (way & 1) != 0 ? 1 : -1;
            Cell const next = (way & 2) != 0 ? Cell{at.col + by, at.row} : Cell{at.col, at.row + by};
            at = region.grid().contains(next) && within[next] == 0 ? next : at;
        }
        hits.push_back(region.grid().index(at));
    }
    return hits;
}

inline std::vector<std::int64_t> arrivals_by_jumps(Mask const& region, GrownForest const& forest, std::int64_t size,
                                                   std::int64_t walkers, std::uint64_t seed) {
    Trees const trees = trees_of(region, forest, size);
    thalweg::growth::RegionWalk walk(region);
    for (std::int64_t i = 0; i < region.cells(); ++i) {
        Cell const c = region.grid().at(i);
        if (region[i] != 0 && trees.within(c)) {
            walk.occupy(c);
        }
    }
    std::vector<Cell> const free = starts(region, trees);
    std::vector<std::int64_t> hits;
    for (std::int64_t w = 0; w < walkers; ++w) {
        RandomStream random(seed, 79, static_cast<std::uint64_t>(w));
        Cell at = free[random.word() % free.size()];
        while (!walk.approach(at, random)) {
        }
        hits.push_back(region.grid().index(at));
    }
    return hits;
}

} // namespace plain_forest
