// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/grow_forest.hpp>

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t forest_stage = 0x666f726573743031; // "forest01"

void check(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params) {
    constexpr std::int64_t longest = 1 << 20;
    require_in("network.grow_forest", "step_cells", params.step_cells, Range::between(1, 100));
    if (params.particles < 0) {
        throw BadParameter(fmt::format("network.grow_forest: particles is {}, it must be at least 1, or 0 for all that "
                                       "find room",
                                       params.particles));
    }
    require_in("network.grow_forest", "sticking", params.sticking, Range{0.0, 1.0, false, true});
    require_in("network.grow_forest", "visits", params.visits, Range::between(1, 255));
    if (std::max(region.width(), region.height()) > longest) {
        throw BadInput(fmt::format("network.grow_forest: the region has {} x {} cells, at most {} a side are possible",
                                   region.width(), region.height(), longest));
    }
    if (seeds.empty()) {
        throw BadInput("network.grow_forest: there is no seed, give at least one");
    }
    for (Cell const s : seeds) {
        if (!region.grid().contains(s) || region[s] == 0) {
            throw BadInput(fmt::format("network.grow_forest: the seed ({}, {}) lies outside the region", s.col, s.row));
        }
    }
}

/// Counts arrivals until there are enough.
class Visits {
public:
    Visits(Grid const& grid, int wanted) : wanted_(wanted), seen_(wanted > 1 ? grid : Grid{}, 0) {}

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

GrownForest grow_forest(Mask const& region, std::vector<Cell> const& seeds, ForestParams const& params,
                        Run const& run) {
    check(region, seeds, params);
    ForestGrowth growth(region, seeds, params.step_cells);
    Visits visits(region.grid(), params.visits);
    GrownForest forest;
    auto const size = [&] { return static_cast<std::int64_t>(growth.particles().size()); };
    double const in_a_full_one = static_cast<double>(growth.cells()) / static_cast<double>(params.step_cells) /
                                 static_cast<double>(2 * params.step_cells);
    double const goal = params.particles > 0 ? static_cast<double>(params.particles) : in_a_full_one;
    constexpr double most_arrivals = 1e12; // about a day
    if (goal > most_arrivals * params.sticking) {
        throw BadParameter(
            fmt::format("network.grow_forest: about {:.0f} particles with sticking {} need more than {:.0e} "
                        "arrivals of walkers and would not end in a day: set sticking nearer to 1",
                        goal, params.sticking, most_arrivals));
    }
    std::int64_t turns = 0;
    auto const look_up = [&] {
        if (++turns % 4096 == 0) {
            run.at(std::min(static_cast<double>(size()) / goal, 1.0), "grow");
        }
    };
    while (growth.open_cells() > 0 && (params.particles == 0 || size() < params.particles)) {
        RandomStream random(params.seed, forest_stage, static_cast<std::uint64_t>(forest.walkers++));
        look_up();
        for (Cell at = growth.birth(random); growth.free(at); look_up()) {
            if (!growth.walk().approach(at, random)) {
                continue;
            }
            if (!growth.open(at) || !visits.enough(at)) {
                break;
            }
            if (params.sticking >= 1.0 || random.real() < params.sticking) {
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

} // namespace thalweg::network
