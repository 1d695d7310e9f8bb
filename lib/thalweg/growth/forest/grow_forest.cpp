// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/forest/grow_forest.hpp>

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/growth/forest/internal/grow_forest.hpp>

namespace thalweg::growth {

/// Two sweeps: exact, because all eight steps count as one.
Raster<std::uint8_t> distance_to_outside(Mask const& region) {
    Raster<std::uint8_t> room = framed<std::uint8_t>(region, 0);
    std::int64_t const width = room.width();
    for (std::uint8_t& r : room.values()) {
        r = r != 0 ? most_room : 0;
    }
    auto const lower = [&](std::int64_t i, std::int64_t sign) {
        for (std::int64_t const offset : {std::int64_t{1}, width - 1, width, width + 1}) {
            if (room[i] > 0) {
                room[i] = static_cast<std::uint8_t>(std::min<int>(room[i], room[i + sign * offset] + 1));
            }
        }
    };
    for (std::int64_t i = 0; i < room.cells(); ++i) {
        lower(i, -1);
    }
    for (std::int64_t i = room.cells() - 1; i >= 0; --i) {
        lower(i, 1);
    }
    return room;
}

RegionWalk::RegionWalk(Mask const& region)
    : room_(distance_to_outside(region)), middle_{region.width() / 2, region.height() / 2} {
    trees_.reach(static_cast<std::int32_t>(std::max(region.width(), region.height()) / 2 + 1));
    law_.prepare(std::max<int>(std::ranges::max(room_.values()), 1));
}

bool RegionWalk::beside_a_tree(Cell c) const {
    return std::any_of(std::begin(neighbour_offsets), std::end(neighbour_offsets), [&](Site o) {
        return trees_.occupied({site(c).x + o.x, site(c).y + o.y});
    });
}

bool RegionWalk::approach(Cell& at, RandomStream& random) const {
    constexpr int most_jumps = 4096;
    for (int jumps = 0; jumps < most_jumps; ++jumps) {
        std::int32_t const free = trees_.free_half(site(at));
        if (free == 0 && beside_a_tree(at)) {
            return true;
        }
        std::int32_t const half = std::min<std::int32_t>(free, room_[framed(at)] - 1);
        if (half < 1) {
            step(at, random);
            continue;
        }
        ExitLaw::Offset const jump = law_.leave(half, random);
        at = {at.col + jump.x, at.row + jump.y};
    }
    return false;
}

void RegionWalk::step(Cell& at, RandomStream& random) const {
    Site const offset = neighbour_offsets[random.word() >> 62];
    Cell const next{at.col + offset.x, at.row + offset.y};
    if (inside(next) && !occupied(next)) {
        at = next;
    }
}

namespace {

Cell moved(Cell c, Site by) {
    return {c.col + by.x, c.row + by.y};
}

/// Cells of the region that a walker can reach from a seed.
Mask reached_from(std::vector<Cell> const& seeds, Mask const& region, Run const& run) {
    Mask reached(region.grid(), 0);
    std::vector<Cell> open = seeds;
    for (Cell const s : seeds) {
        reached[s] = 1;
    }
    for (std::size_t visited = 0; !open.empty(); ++visited) {
        if (visited % (1U << 18U) == 0) {
            run.check();
        }
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

constexpr std::uint64_t forest_stage = 0x666f726573743031; // "forest01"

void check(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params) {
    constexpr std::int64_t longest = 1 << 20;
    require_in("growth.grow_forest", "step_cells", params.step_cells, Range::between(1, 100));
    refuse_if<BadParameter>(params.particles < 0,
                            "growth.grow_forest: particles is {}, it must be at least 1, or 0 for all that find room",
                            params.particles);
    require_in("growth.grow_forest", "sticking", params.sticking, Range{0.0, 1.0, false, true});
    require_in("growth.grow_forest", "visits", params.visits, Range::between(1, 255));
    refuse_if<BadInput>(std::max(region.width(), region.height()) > longest,
                        "growth.grow_forest: the region has {} x {} cells, at most {} a side are possible",
                        region.width(), region.height(), longest);
    refuse_if<BadInput>(seeds.empty(), "growth.grow_forest: there is no seed, give at least one");
    for (Cell const s : seeds) {
        refuse_if<BadInput>(!region.grid().contains(s) || region[s] == 0,
                            "growth.grow_forest: the seed ({}, {}) lies outside the region", s.col, s.row);
    }
}

/// Counts arrivals until the noise-reduction count is reached.
class ArrivalCounts {
public:
    ArrivalCounts(Grid const& grid, int wanted) : wanted_(wanted), seen_(wanted > 1 ? grid : Grid{}, 0) {}

    bool enough(Cell c) {
        if (wanted_ == 1) {
            return true;
        }
        seen_[c] = static_cast<std::uint8_t>(std::min(seen_[c] + 1, wanted_));
        return seen_[c] == wanted_;
    }

private:
    int wanted_;
    Mask seen_;
};

} // namespace

ForestGrowth::ForestGrowth(Mask const& region, std::vector<Cell> const& seeds, std::int64_t step, Run const& run)
    : grid_(region.grid()), step_(step), land_(reached_from(seeds, region, run)), walk_(land_), nearest_(grid_, -1),
      first_(blocks_of(grid_, step), -1), state_(grid_, State::far), is_start_(grid_, 0) {
    run.check();
    for (std::int64_t i = 0; i < grid_.cells(); ++i) {
        cells_ += land_[i];
        state_[i] = land_[i] != 0 ? State::far : State::closed;
    }
    for (Cell const s : seeds) {
        bool const alone = all_near(s, [](std::int32_t) { return false; });
        if (!alone) {
            throw BadInput(fmt::format("growth.grow_forest: the seed ({}, {}) lies nearer than {} cells to another",
                                       s.col, s.row, 2 * step));
        }
        place(s, -1);
    }
    for (Cell const s : seeds) {
        look_around(s);
    }
    find_start_cells();
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

Cell ForestGrowth::draw_start(RandomStream& random) const {
    auto const k = static_cast<std::size_t>(random.real() * static_cast<double>(start_cells_.size()));
    return start_cells_[k];
}

void ForestGrowth::add(Cell c) {
    place(c, nearest_[c]);
    look_around(c);
    if (++added_since_search_ > static_cast<std::int64_t>(start_cells_.size()) / (8 * step_ * step_) + 64) {
        find_start_cells();
    }
}

void ForestGrowth::place(Cell c, std::int64_t parent) {
    std::int32_t const number = static_cast<std::int32_t>(particles_.size());
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
        set(at, State::closed);
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
            set(at, may_hold(at) ? State::open : State::closed);
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
        if (is_start_[c] == 0) {
            added_since_search_ = grid_.cells(); // walkers come from a pocket without an exit
        }
    }
    state_[c] = state;
}

/// Walkers from elsewhere would never stick and are not released. In a nearly full region they would be the majority.
void ForestGrowth::find_start_cells() {
    for (Cell const c : start_cells_) {
        is_start_[c] = 0;
    }
    std::erase_if(opened_, [&](Cell c) { return state_[c] != State::open; });
    start_cells_ = opened_;
    for (Cell const c : start_cells_) {
        is_start_[c] = 1;
    }
    for (std::size_t k = 0; k < start_cells_.size(); ++k) {
        for (Site const o : neighbour_offsets) {
            Cell const next = moved(start_cells_[k], o);
            if (grid_.contains(next) && state_[next] == State::far && is_start_[next] == 0) {
                is_start_[next] = 1;
                start_cells_.push_back(next);
            }
        }
    }
    added_since_search_ = 0;
}

GrownForest grow_forest(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params,
                        Run const& run) {
    check(region, seeds, params);
    ForestGrowth growth(region, seeds, params.step_cells, run);
    run.check();
    ArrivalCounts visits(region.grid(), params.visits);
    GrownForest forest;
    auto const size = [&] { return static_cast<std::int64_t>(growth.particles().size()); };
    double const in_a_full_one = static_cast<double>(growth.cells()) / static_cast<double>(params.step_cells) /
                                 static_cast<double>(2 * params.step_cells);
    double const goal = params.particles > 0 ? static_cast<double>(params.particles) : in_a_full_one;
    constexpr double most_arrivals = 1e12; // about a day
    refuse_if<BadParameter>(goal > most_arrivals * params.sticking,
                            "growth.grow_forest: about {:.0f} particles with sticking {} need more than {:.0e} "
                            "arrivals of walkers and would not end in a day: set sticking nearer to 1",
                            goal, params.sticking, most_arrivals);
    std::int64_t turns = 0;
    auto const look_up = [&] {
        if (++turns % 4096 == 0) {
            run.at(std::min(static_cast<double>(size()) / goal, 1.0), "grow");
        }
    };
    while (growth.open_cells() > 0 && (params.particles == 0 || size() < params.particles)) {
        RandomStream random(params.seed, forest_stage, static_cast<std::uint64_t>(forest.walkers++));
        look_up();
        for (Cell at = growth.draw_start(random); growth.free(at); look_up()) {
            if (!growth.walk().approach(at, random)) {
                continue;
            }
            if (!growth.open(at) || !visits.enough(at)) {
                break;
            }
            if (params.sticking >= 1.0 || random.real() < params.sticking) {
                run.check(); // it takes as long as many walkers
                growth.add(at);
                break;
            }
            growth.walk().step(at, random);
        }
    }
    forest.stop = growth.open_cells() == 0 ? ForestStop::full : ForestStop::particles;
    forest.cells = growth.particles();
    forest.parent = growth.parents();
    for (std::size_t p = 0; p < forest.cells.size(); ++p) {
        std::int64_t const up = forest.parent[p];
        forest.tree.push_back(up < 0 ? static_cast<std::int64_t>(p) : forest.tree[up]);
    }
    return forest;
}

} // namespace thalweg::growth
