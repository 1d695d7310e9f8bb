// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/forest/grow_forest.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/growth/forest/internal/grow_forest.hpp>

namespace thalweg::growth {

/// Two sweeps: exact, because all eight steps count as one.
Raster<std::uint8_t> distance_to_outside(Mask const& region) {
    Raster<std::uint8_t> room = framed<std::uint8_t>(region, 0);
    for (std::uint8_t& r : room.values()) {
        r = r != 0 ? most_room : 0;
    }
    std::int64_t const end = room.width() - 1;
    auto const lower = [end](std::span<std::uint8_t> row, std::span<std::uint8_t const> beside) {
        for (std::int64_t col = 1; col < end; ++col) {
            std::uint8_t const least = std::min(std::min(beside[col - 1], beside[col]), beside[col + 1]);
            auto const one_more = static_cast<std::uint8_t>(least + (least < most_room ? 1 : 0));
            row[col] = std::min(row[col], one_more);
        }
    };
    for (std::int64_t r = 1; r < room.height() - 1; ++r) {
        auto const row = room.row(r);
        lower(row, room.row(r - 1));
        for (std::int64_t col = 1; col < end; ++col) {
            row[col] = static_cast<std::uint8_t>(std::min<int>(row[col], row[col - 1] + 1));
        }
    }
    for (std::int64_t r = room.height() - 2; r > 0; --r) {
        auto const row = room.row(r);
        lower(row, room.row(r + 1));
        for (std::int64_t col = end - 1; col > 0; --col) {
            row[col] = static_cast<std::uint8_t>(std::min<int>(row[col], row[col + 1] + 1));
        }
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

Disc::Disc(std::int64_t radius) {
    for (std::int64_t row = 0; row < radius; ++row) {
        std::int64_t col = radius;
        while (col * col + row * row >= radius * radius) {
            --col;
        }
        reach_.push_back(col);
    }
}

std::vector<Site> Disc::rim() const {
    std::vector<Site> rim;
    for (std::int64_t row = -reach(); row <= reach(); ++row) {
        std::int64_t const beyond = std::min(reach(row - 1), reach(row + 1));
        for (std::int64_t col = -reach(row); col <= reach(row); ++col) {
            if (std::abs(col) == reach(row) || std::abs(col) > beyond) {
                rim.push_back({static_cast<std::int32_t>(col), static_cast<std::int32_t>(row)});
            }
        }
    }
    return rim;
}

std::int64_t take_piece(Cell from, Mask& left, Run const& run) {
    std::int64_t taken = 0;
    std::vector<Cell> open{from};
    for (std::size_t rows = 0; !open.empty(); ++rows) {
        if (rows % 1024 == 0) {
            run.check();
        }
        Cell const c = open.back();
        open.pop_back();
        auto const row = left.row(c.row);
        if (row[c.col] == 0) {
            continue;
        }
        std::int64_t west = c.col;
        std::int64_t end = c.col + 1;
        while (west > 0 && row[west - 1] != 0) {
            --west;
        }
        while (end < left.width() && row[end] != 0) {
            ++end;
        }
        std::fill(row.begin() + west, row.begin() + end, std::uint8_t{0});
        taken += end - west;
        for (std::int64_t const r : {c.row - 1, c.row + 1}) {
            if (r < 0 || r >= left.height()) {
                continue;
            }
            auto const beside = left.row(r);
            for (std::int64_t col = west; col < end; ++col) {
                if (beside[col] != 0 && (col == west || beside[col - 1] == 0)) {
                    open.push_back({col, r});
                }
            }
        }
    }
    return taken;
}

namespace {

Cell moved(Cell c, Site by) {
    return {c.col + by.x, c.row + by.y};
}

/// Cells of the region that a walker can reach from a seed.
Mask reached_from(std::vector<Cell> const& seeds, Mask const& region, Run const& run) {
    Mask left = region;
    for (Cell const s : seeds) {
        take_piece(s, left, run);
    }
    for (std::int64_t i = 0; i < region.cells(); ++i) {
        left[i] = region[i] != 0 && left[i] == 0 ? 1 : 0;
    }
    return left;
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
    constexpr std::int64_t most_cells = 4'000'000'000; // indices in tiles have 32 bits
    require_in("growth.grow_forest", "step_cells", params.step_cells, Range::between(1, 100));
    refuse_if<BadParameter>(params.particles < 0, "growth.grow_forest",
                            "particles is {}, it must be at least 1, or 0 for all that find room", params.particles);
    require_in("growth.grow_forest", "sticking", params.sticking, Range{0.0, 1.0, false, true});
    require_in("growth.grow_forest", "visits", params.visits, Range::between(1, 255));
    refuse_if<BadInput>(std::max(region.width(), region.height()) > longest, "growth.grow_forest",
                        "the region has {} x {} cells, at most {} a side are possible", region.width(), region.height(),
                        longest);
    refuse_if<BadInput>(region.cells() > most_cells, "growth.grow_forest",
                        "the region has {} x {} cells, at most 4e9 are possible", region.width(), region.height());
    refuse_if<BadInput>(seeds.empty(), "growth.grow_forest", "there is no seed, give at least one");
    for (Cell const s : seeds) {
        refuse_if<BadInput>(!region.grid().contains(s) || region[s] == 0, "growth.grow_forest",
                            "the seed ({}, {}) lies outside the region", s.col, s.row);
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
    : grid_(region.grid()), step_(step), disc_(step), rim_(disc_.rim()), walk_(reached_from(seeds, region, run)),
      first_(blocks_of(grid_, step), -1), state_(grid_, State::closed) {
    run.check();
    for (std::int64_t row = 0; row < grid_.height; ++row) {
        for (std::int64_t col = 0; col < grid_.width; ++col) {
            if (walk_.inside({col, row})) {
                state_[Cell{col, row}] = State::far;
                ++cells_;
            }
        }
    }
    start_cells_.resize(static_cast<std::size_t>(cells_) + 1);
    for (Cell const s : seeds) {
        refuse_if<BadInput>(!near(s).empty(), "growth.grow_forest",
                            "the seed ({}, {}) lies nearer than {} cells to another", s.col, s.row, 2 * step);
        place(s, -1);
    }
    for (Cell const s : seeds) {
        look_around(s);
    }
    find_start_cells();
}

std::vector<std::int32_t> const& ForestGrowth::near(Cell c) {
    found_.clear();
    cells_around(first_.grid(), {c.col / step_, c.row / step_}, 2, [&](Cell block) {
        for (std::int32_t p = first_[block]; p >= 0; p = next_[p]) {
            if (squared_cells(particles_[p], c) < 4 * step_ * step_) {
                found_.push_back(p);
            }
        }
    });
    return found_;
}

std::int32_t ForestGrowth::nearest_of(std::vector<std::int32_t> const& near, Cell c) const {
    return *std::ranges::min_element(near, {}, [&](std::int32_t p) {
        return std::pair{squared_cells(particles_[p], c), p};
    });
}

Cell ForestGrowth::draw_start(RandomStream& random) const {
    auto const k = static_cast<std::size_t>(random.real() * static_cast<double>(starts_));
    return state_.cell(start_cells_[k]);
}

void ForestGrowth::add(Cell c) {
    place(c, nearest_of(near(c), c));
    look_around(c);
    if (++added_since_search_ > static_cast<std::int64_t>(starts_) / (8 * step_ * step_) + 64) {
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
    std::int64_t const south = std::min(c.row + disc_.reach(), grid_.height - 1);
    for (std::int64_t row = std::max<std::int64_t>(c.row - disc_.reach(), 0); row <= south; ++row) {
        std::int64_t const reach = disc_.reach(row - c.row);
        std::int64_t const west = std::max<std::int64_t>(c.col - reach, 0);
        std::int64_t const end = std::min(c.col + reach + 1, grid_.width);
        for (std::int64_t col = west; col < end; ++col) {
            State& state = state_[Cell{col, row}];
            open_cells_ -= static_cast<int>(state == State::open);
            state = State::closed;
        }
    }
    // Walkers come from outside: they meet the rim first.
    auto const inside = [&](Site o) { return grid_.contains(moved(c, o)) && walk_.inside(moved(c, o)); };
    if (std::ranges::all_of(rim_.sites(), inside)) {
        walk_.occupy(c, rim_);
        return;
    }
    for (Site const o : rim_.sites()) {
        if (inside(o)) {
            walk_.occupy(moved(c, o));
        }
    }
}

void ForestGrowth::look_around(Cell c) {
    std::int64_t const new_reach = step_ + 1;
    auto const look_at = [&](Cell at) {
        State const state = state_[at];
        bool const begins =
            state != State::closed && squared_cells(at, c) <= new_reach * new_reach && walk_.beside_a_tree(at);
        if (begins || state == State::open) {
            open_or_close(at);
        }
    };
    std::int64_t const south = std::min(c.row + 2 * step_, grid_.height - 1);
    std::int64_t const west = std::max<std::int64_t>(c.col - 2 * step_, 0);
    std::int64_t const east = std::min(c.col + 2 * step_, grid_.width - 1);
    for (std::int64_t row = std::max<std::int64_t>(c.row - 2 * step_, 0); row <= south; ++row) {
        bool const new_row = std::abs(row - c.row) <= new_reach;
        for (std::int64_t first = state_.first_of_eight(west); first <= east; first += 8) {
            std::uint64_t const states = state_.eight({first, row});
            bool const is_new = new_row && first <= c.col + new_reach && first + 7 >= c.col - new_reach;
            constexpr std::uint64_t last_bits = 0x0101010101010101;
            static_assert(static_cast<int>(State::open) == 3 && static_cast<int>(State::start) == 2);
            bool const some_open = (states & states >> 1 & last_bits) != 0;
            if (some_open || (is_new && states != 0)) {
                for (std::int64_t col = std::max(first, west); col <= std::min(first + 7, east); ++col) {
                    look_at({col, row});
                }
            }
        }
    }
}

void ForestGrowth::open_or_close(Cell c) {
    Index const at = state_.index(c);
    State& state = state_[at];
    bool const opens = may_hold(c);
    if (opens && state != State::open) {
        opened_.push_back(at);
        if (state != State::start) {
            added_since_search_ = grid_.cells(); // walkers come from a pocket without an exit
        }
    }
    open_cells_ += static_cast<int>(opens) - static_cast<int>(state == State::open);
    state = opens ? State::open : State::closed;
}

bool ForestGrowth::may_hold(Cell c) {
    std::vector<std::int32_t> const& around = near(c);
    std::int32_t const on = nearest_of(around, c);
    std::int64_t const step2 = step_ * step_;
    return std::ranges::all_of(around, [&](std::int32_t p) {
        std::int64_t const far = squared_cells(particles_[p], c);
        return p == on || (p == parents_[on] && 2 * far >= 5 * step2) || (parents_[p] == on && 2 * far >= 3 * step2);
    });
}

/// Walkers from elsewhere would never stick and are not released. In a nearly full region they would be the majority.
void ForestGrowth::find_start_cells() {
    for (State& state : state_.all()) {
        state = state == State::start ? State::far : state;
    }
    std::erase_if(opened_, [&](Index i) { return state_[i] != State::open; });
    std::ranges::copy(opened_, start_cells_.begin());
    std::span<Index> const starts = start_cells_;
    std::size_t count = opened_.size();
    for (std::size_t k = 0; k < count; ++k) {
        // Without branches, which the processor would foresee badly.
        for (Index const next : state_.neighbours(starts[k])) {
            State& state = state_[next];
            bool const far = state == State::far;
            starts[count] = next;
            state = far ? State::start : state;
            count += static_cast<std::size_t>(far);
        }
    }
    starts_ = count;
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
    refuse_if<BadParameter>(goal > most_arrivals * params.sticking, "growth.grow_forest",
                            "about {:.0f} particles with sticking {} need more than {:.0e} arrivals of walkers and "
                            "would not end in a day: set sticking nearer to 1",
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
