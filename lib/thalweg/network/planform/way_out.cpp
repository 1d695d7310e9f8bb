// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/way_out.hpp>

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

#include <thalweg/core/cells.hpp>

namespace thalweg::network {

namespace {

constexpr double root_of_two = 1.41421356237309504880;

class WaySearch {
public:
    WaySearch(Vec2 outlet, Cell start, CarryGround const& ground, RiverEnds const& ends,
              std::function<bool(Confluence const&)> const& may_join)
        : outlet_(outlet), start_(start), ground_(ground), grid_(ground.grid()), ends_(ends), may_join_(may_join) {}

    Way find() {
        reached_[grid_.index(start_)] = {};
        queue_.emplace(static_cast<double>(ends_.steps(start_)), grid_.index(start_));
        while (!queue_.empty()) {
            std::int64_t const at = queue_.top().second;
            queue_.pop();
            if (reached_[at].settled) {
                continue;
            }
            reached_[at].settled = true;
            if (reached_[at].into != nullptr || ends_.steps(grid_.at(at)) == 0) {
                return way_to(at);
            }
            go_on_from(at);
        }
        return {};
    }

private:
    struct Reached {
        double cost = 0.0;
        std::int64_t from = -1;
        bool settled = false;
        Confluence const* into = nullptr;
    };

    Way way_to(std::int64_t at) {
        Way way{{}, reached_[at].into};
        for (std::int64_t i = at; i >= 0; i = reached_[i].from) {
            way.cells.push_back(grid_.at(i));
        }
        std::reverse(way.cells.begin(), way.cells.end());
        return way;
    }

    void go_on_from(std::int64_t at) {
        Cell const c = grid_.at(at);
        Vec2 const here = c == start_ ? outlet_ : grid_.centre(c);
        for (std::int64_t dr = -1; dr <= 1; ++dr) {
            for (std::int64_t dc = -1; dc <= 1; ++dc) {
                Cell const next{c.col + dc, c.row + dr};
                if ((dr == 0 && dc == 0) || !grid_.contains(next) || !ends_.is_land(next)) {
                    continue;
                }
                Confluence const* const into = ground_.confluence_in(next);
                if (into != nullptr && may_join_(*into) && ground_.opens_to(*into, here, c, next)) {
                    join(at, next, into);
                } else if (ground_.open(here, c, next)) {
                    step(at, next, dr != 0 && dc != 0 ? root_of_two : 1.0);
                }
            }
        }
    }

    void join(std::int64_t at, Cell next, Confluence const* into) {
        std::int64_t const to = grid_.index(next);
        double const cost = reached_[at].cost + ground_.cost_of_joining();
        auto const [known, is_new] = reached_.try_emplace(to);
        if (is_new || cost < known->second.cost) {
            known->second = {cost, at, false, into};
            queue_.emplace(cost, to); // beside the border it may be dearer than it looks from afar
        }
    }

    void step(std::int64_t at, Cell next, double length) {
        std::int64_t const to = grid_.index(next);
        Reached const here = reached_[at]; // a copy: places move when more are reached
        double const cost = here.cost + ground_.cost(next) * length;
        auto const [known, is_new] = reached_.try_emplace(to);
        bool const straight = here.from >= 0 && to - at == at - here.from;
        if (is_new || cost < known->second.cost || (straight && cost == known->second.cost && !known->second.settled)) {
            known->second = {cost, at, false, nullptr};
            queue_.emplace(cost + static_cast<double>(ends_.steps(next)), to);
        }
    }

    using Entry = std::pair<double, std::int64_t>; // the least that a way through this cell costs, the cell

    Vec2 outlet_;
    Cell start_;
    CarryGround const& ground_;
    Grid const& grid_;
    RiverEnds const& ends_;
    std::function<bool(Confluence const&)> const& may_join_;
    std::unordered_map<std::int64_t, Reached> reached_; // looked up only, never walked
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

} // namespace

RiverEnds::RiverEnds(Mask const& land) : grid_(land.grid()), land_(land), steps_(land.grid(), unreached) {
    std::vector<Cell> front;
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const c = grid_.at(i);
        bool at_sea = false;
        cells_around(grid_, c, 1, [&](Cell n) { at_sea = at_sea || land[n] == 0; });
        if (at_sea || grid_.on_border(c)) {
            steps_[i] = 0;
            front.push_back(c);
        }
    }
    for (std::int32_t steps = 1; !front.empty(); ++steps) {
        std::vector<Cell> next;
        for (Cell const c : front) {
            cells_around(grid_, c, 1, [&](Cell n) {
                if (steps_[n] == unreached) {
                    steps_[n] = steps;
                    next.push_back(n);
                }
            });
        }
        front = std::move(next);
    }
}

std::int64_t RiverEnds::steps(Cell c) const {
    return steps_.cells() > 0 ? steps_[c] : std::min({c.col, c.row, grid_.width - 1 - c.col, grid_.height - 1 - c.row});
}

Way way_out(Vec2 outlet, Cell start, CarryGround const& ground, RiverEnds const& ends,
            std::function<bool(Confluence const&)> const& may_join) {
    return WaySearch(outlet, start, ground, ends, may_join).find();
}

} // namespace thalweg::network
