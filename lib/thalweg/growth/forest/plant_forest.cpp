// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/growth/forest/internal/grow_forest.hpp>

namespace thalweg::growth {

namespace {

/// The distance from the region's border that trees keep inland: then all cells between two neighbouring ones a step
/// apart are land, and not coast.
std::int64_t inland_distance(std::int64_t step) {
    return (step + 2) / 2 + 2;
}

Mask inland_of(Mask const& land, std::int64_t step) {
    Raster<std::uint8_t> const room = distance_to_outside(land);
    Mask inland(land.grid());
    for (std::int64_t row = 0; row < land.height(); ++row) {
        for (std::int64_t col = 0; col < land.width(); ++col) {
            inland[Cell{col, row}] = room[Cell{col + 1, row + 1}] >= inland_distance(step) ? 1 : 0;
        }
    }
    return inland;
}

/// Where a river leaves the land, and the cell inland where its tree begins: the river between is straight.
struct Mouth {
    Cell outlet;
    Cell seed;
};

/// Selects the outlets that get a tree.
class Mouths {
public:
    Mouths(Mask const& land, Mask const& inland, std::int64_t step)
        : land_(land), inland_(inland), step_(step), near_way_(land.grid(), 0), near_seed_(land.grid(), 0) {}

    std::vector<Mouth> const& all() const { return mouths_; }

    /// The inland cell nearest to an outlet, straight over land; nothing: none is so close that its river cannot touch
    /// another one.
    std::optional<Cell> seed_for(Cell outlet) const {
        std::int64_t const reach = inland_distance(step_) + 1;
        std::optional<Cell> best;
        cells_around(land_.grid(), outlet, reach, [&](Cell c) {
            bool const nearer = !best || squared_cells(c, outlet) < squared_cells(*best, outlet);
            if (inland_[c] != 0 && nearer && over_land(c, outlet)) {
                best = c;
            }
        });
        return best;
    }

    /// \return whether the outlet got a tree.
    bool add(Cell outlet) {
        constexpr std::int64_t apart = 3;
        std::optional<Cell> const seed = seed_for(outlet);
        if (!seed || near_seed_[*seed] != 0) {
            return false;
        }
        bool meets = false;
        auto const along = [&](auto visit) {
            walk_cells(*seed, outlet, [&](Cell c, std::int64_t, std::int64_t) { visit(c); });
        };
        along([&](Cell c) { meets = meets || near_way_[c] != 0; });
        if (meets) {
            return false;
        }
        along([&](Cell c) { cells_around(land_.grid(), c, apart, [&](Cell n) { near_way_[n] = 1; }); });
        cells_around(land_.grid(), *seed, 2 * step_, [&](Cell c) {
            if (squared_cells(c, *seed) < 4 * step_ * step_) {
                near_seed_[c] = 1;
            }
        });
        mouths_.push_back({outlet, *seed});
        return true;
    }

private:
    bool over_land(Cell a, Cell b) const {
        bool dry = true;
        walk_cells(a, b, [&](Cell c, std::int64_t, std::int64_t) { dry = dry && land_[c] != 0; });
        return dry;
    }

    Mask const& land_;
    Mask const& inland_;
    std::int64_t step_;
    Mask near_way_;
    Mask near_seed_;
    std::vector<Mouth> mouths_;
};

Finding finding(FindingKind kind, Grid const& grid, Cell c, double amount, std::string text) {
    return {kind, 0, grid.centre(c), amount, fmt::format("{} ({}, {})", text, c.col, c.row)};
}

void check(Mask const& land, std::vector<Cell> const& coast, std::vector<Cell> const& outlets,
           ForestParams const& params) {
    constexpr std::int64_t least_step = 4; // with less, rivers of two trees could touch between their seeds and outlets
    require_in("growth.plant_forest", "step_cells", params.step_cells, Range::between(least_step, 100));
    refuse_if<BadInput>(coast.empty(), "growth.plant_forest", "there is no land, all cells are sea");
    auto const place = [&](Cell c) { return land.grid().index(c); };
    for (Cell const c : outlets) {
        refuse_if<BadInput>(!land.grid().contains(c) || !std::ranges::binary_search(coast, place(c), {}, place),
                            "growth.plant_forest", "the outlet ({}, {}) lies off the land's coast", c.col, c.row);
    }
}

/// Adds a tree to every inland piece without one, at the first coast cell with enough space.
void add_missing(Mask const& inland, std::vector<Cell> const& coast, Mouths& mouths, std::vector<Finding>& notes,
                 Run const& run) {
    Mask left = inland;
    for (Mouth const& mouth : mouths.all()) {
        take_piece(mouth.seed, left, run);
    }
    std::int64_t cells_left = std::ranges::count_if(left.values(), [](std::uint8_t v) { return v != 0; });
    for (Cell const c : coast) {
        if (cells_left == 0) { // as on most maps: the seed of each coast cell needs a search
            break;
        }
        std::optional<Cell> const seed = mouths.seed_for(c);
        if (seed && left[*seed] != 0 && mouths.add(c)) {
            cells_left -= take_piece(*seed, left, run);
            notes.push_back(
                finding("added_outlet", inland.grid(), c, 0.0, "an outlet was added for land without one, at cell"));
        }
    }
}

/// Notes each piece of land without a tree.
void note_dry_land(Mask const& land, Mouths const& mouths, std::vector<Finding>& notes, Run const& run) {
    Mask left = land;
    for (Mouth const& mouth : mouths.all()) {
        take_piece(mouth.outlet, left, run);
    }
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        if (left[i] != 0) {
            Cell const c = land.grid().at(i);
            auto const size = static_cast<double>(take_piece(c, left, run));
            notes.push_back(finding("dry_land", land.grid(), c, size,
                                    fmt::format("a piece of land of {} cells has no room for a river, at cell", size)));
        }
    }
}

/// The trees as arcs: outlets and particles with no or several children are nodes.
NetworkDraft as_network(GrownForest const& forest, Grid const& grid, std::vector<Mouth> const& mouths) {
    ParticleId const count = std::ssize(forest.cells);
    std::vector<int> children(count, 0);
    for (std::int64_t const up : forest.parent) {
        if (up >= 0) {
            ++children[up];
        }
    }
    NetworkDraft network;
    for (Mouth const& mouth : mouths) {
        network.add_node(grid.centre(mouth.outlet));
    }
    std::vector<NodeId> node(count, 0);
    for (ParticleId p = 0; p < count; ++p) {
        if (children[p] != 1) {
            node[p] = network.add_node(grid.centre(forest.cells[p]));
        }
    }
    for (ParticleId p = 0; p < count; ++p) {
        if (children[p] == 1) {
            continue;
        }
        Arc arc;
        ParticleId at = p;
        do {
            arc.line.push_back(grid.centre(forest.cells[at]));
            at = forest.parent[at];
        } while (at >= 0 && children[at] == 1);
        NodeId const end = at >= 0 ? node[at] : static_cast<NodeId>(forest.tree[p]);
        arc.line.push_back(network.nodes[end].at);
        network.add_arc(node[p], end, std::move(arc));
    }
    return network;
}

/// Selects the outlets that get a tree, adds missing ones, and notes land that has none.
std::vector<Mouth> mouths_of(Mask const& land, Mask const& inland, std::vector<Cell> const& coast,
                             std::vector<Cell> const& outlets, std::int64_t step, std::vector<Finding>& notes,
                             Run const& run) {
    Mouths mouths(land, inland, step);
    for (Cell const c : outlets) {
        if (!mouths.add(c)) {
            notes.push_back(finding("crowded_outlet", land.grid(), c, 0.0,
                                    "an outlet was left out, with no room for its river between others or coasts, at "
                                    "cell"));
        }
    }
    run.check();
    add_missing(inland, coast, mouths, notes, run);
    run.check();
    note_dry_land(land, mouths, notes, run);
    if (mouths.all().empty()) {
        throw BadInput("growth.plant_forest", fmt::format("there is no room for a river: no cell is {} cells away "
                                                          "from the sea; take smaller cells or shorter steps",
                                                          inland_distance(step)));
    }
    return mouths.all();
}

} // namespace

PlantedForest plant_forest(Mask const& land, std::vector<Cell> const& outlets, ForestParams const& params,
                           Run const& run) {
    std::vector<Cell> const coast = coast_cells(land);
    check(land, coast, outlets, params);
    run.check();
    Mask const inland = inland_of(land, params.step_cells);
    run.check();
    PlantedForest planted;
    std::vector<Mouth> const mouths = mouths_of(land, inland, coast, outlets, params.step_cells, planted.notes, run);
    std::vector<Cell> seeds;
    for (Mouth const& mouth : mouths) {
        seeds.push_back(mouth.seed);
    }
    run.check();
    GrownForest const forest = grow_forest(inland, seeds, params, run);
    planted.network = as_network(forest, land.grid(), mouths);
    planted.outlets = static_cast<std::int64_t>(seeds.size());
    planted.particles = static_cast<std::int64_t>(forest.cells.size());
    planted.walkers = forest.walkers;
    planted.stop = forest.stop;
    return planted;
}

} // namespace thalweg::growth
