// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

namespace {

Cell moved(Cell c, Site by) {
    return {c.col + by.x, c.row + by.y};
}

/// Cells of the region that a walker can reach from a seed.
Mask reached_from(std::vector<Cell> const& seeds, Mask const& region) {
    Mask reached(region.grid(), 0);
    std::vector<Cell> open = seeds;
    for (Cell const s : seeds) {
        reached[s] = 1;
    }
    while (!open.empty()) {
        Cell const c = open.back();
        open.pop_back();
        for (Site const o : neighbour_offsets) {
            Cell const next = moved(c, o);
            if (region.grid().contains(next) && region[next] != 0 && reached[next] == 0) {
                reached[next] = 1;
                open.push_back(next);
            }
        }
    }
    return reached;
}

Grid blocks_of(Grid const& grid, std::int64_t side) {
    Grid blocks;
    blocks.width = (grid.width + side - 1) / side;
    blocks.height = (grid.height + side - 1) / side;
    return blocks;
}

} // namespace

ForestGrowth::ForestGrowth(Mask const& region, std::vector<Cell> const& seeds, std::int64_t step)
    : grid_(region.grid()), step_(step), land_(reached_from(seeds, region)), walk_(land_), nearest_(grid_, -1),
      first_(blocks_of(grid_, step), -1), state_(grid_, State::far), fertile_(grid_, 0) {
    for (std::int64_t i = 0; i < grid_.cells(); ++i) {
        cells_ += land_[i];
        state_[i] = land_[i] != 0 ? State::far : State::barren;
    }
    for (Cell const s : seeds) {
        bool const alone = all_near(s, [](std::int32_t) { return false; });
        if (!alone) {
            throw BadInput(fmt::format("network.grow_forest: the seed ({}, {}) lies nearer than {} cells to another",
                                       s.col, s.row, 2 * step));
        }
        place(s, -1);
    }
    for (Cell const s : seeds) {
        look_around(s);
    }
    find_births();
}

template <class Visit> bool ForestGrowth::all_near(Cell c, Visit visit) const {
    std::int64_t const reach = 2 * step_;
    bool all = true;
    cells_around(first_.grid(), {c.col / step_, c.row / step_}, 2, [&](Cell block) {
        for (std::int32_t p = first_[block]; all && p >= 0; p = next_[p]) {
            if (squared_cells(particles_[p], c) < reach * reach) {
                all = visit(p);
            }
        }
    });
    return all;
}

Cell ForestGrowth::birth(RandomStream& random) const {
    auto const k = static_cast<std::size_t>(random.real() * static_cast<double>(births_.size()));
    return births_[k];
}

void ForestGrowth::add(Cell c) {
    place(c, nearest_[c]);
    look_around(c);
    if (++outdated_ > static_cast<std::int64_t>(births_.size()) / (8 * step_ * step_) + 64) {
        find_births();
    }
}

void ForestGrowth::place(Cell c, std::int64_t parent) {
    std::int32_t const number = particles_.count();
    particles_.push_back(c);
    parents_.push_back(parent);
    std::int32_t& first = first_[Cell{c.col / step_, c.row / step_}];
    next_.push_back(first);
    first = number;
    auto const inside = [&](Cell at) { return squared_cells(at, c) < step_ * step_; };
    cells_around(grid_, c, step_ + 1, [&](Cell at) {
        std::int64_t const far = squared_cells(at, c);
        if (far > (step_ + 1) * (step_ + 1)) {
            return;
        }
        std::int32_t& nearest = nearest_[at];
        if (nearest < 0 || far < squared_cells(at, particles_[nearest])) {
            nearest = number;
        }
        if (!inside(at)) {
            return;
        }
        set(at, State::barren);
        // Walkers come from outside: they meet the rim first.
        bool const rim = std::any_of(std::begin(neighbour_offsets), std::end(neighbour_offsets),
                                     [&](Site o) { return !inside(moved(at, o)); });
        if (rim && land_[at] != 0) {
            walk_.occupy(at);
        }
    });
}

void ForestGrowth::look_around(Cell c) {
    std::int64_t const new_reach = (step_ + 1) * (step_ + 1);
    cells_around(grid_, c, 2 * step_, [&](Cell at) {
        bool const begins = state_[at] == State::far && squared_cells(at, c) <= new_reach && walk_.beside_a_tree(at);
        if (begins || state_[at] == State::open) {
            set(at, may_hold(at) ? State::open : State::barren);
        }
    });
}

bool ForestGrowth::may_hold(Cell c) const {
    std::int32_t const on = nearest_[c];
    std::int64_t const step2 = step_ * step_;
    return all_near(c, [&](std::int32_t p) {
        std::int64_t const far = squared_cells(particles_[p], c);
        return p == on || (p == parents_[on] && 2 * far >= 5 * step2) || (parents_[p] == on && 2 * far >= 3 * step2);
    });
}

void ForestGrowth::set(Cell c, State state) {
    open_cells_ += static_cast<int>(state == State::open) - static_cast<int>(state_[c] == State::open);
    if (state == State::open && state_[c] != State::open) {
        opened_.push_back(c);
        if (fertile_[c] == 0) {
            outdated_ = grid_.cells(); // walkers come from a pocket out of which there was no way
        }
    }
    state_[c] = state;
}

/// Walkers from elsewhere come to nothing: they need not be released. In a region that is nearly full they would be
/// most of all.
void ForestGrowth::find_births() {
    for (Cell const c : births_) {
        fertile_[c] = 0;
    }
    std::erase_if(opened_, [&](Cell c) { return state_[c] != State::open; });
    births_ = opened_;
    for (Cell const c : births_) {
        fertile_[c] = 1;
    }
    for (std::size_t k = 0; k < births_.size(); ++k) {
        for (Site const o : neighbour_offsets) {
            Cell const next = moved(births_[k], o);
            if (grid_.contains(next) && state_[next] == State::far && fertile_[next] == 0) {
                fertile_[next] = 1;
                births_.push_back(next);
            }
        }
    }
    outdated_ = 0;
}

} // namespace thalweg::network
