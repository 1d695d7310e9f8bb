// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/opening.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::blend {
namespace {

using solver::fixed_cell;
using solver::free_cell;

std::array<Cell, 4> neighbours_of(Cell c) {
    return {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}};
}

struct Box {
    Cell first;
    Cell last;
};

// With its ring.
Box box_of(Mask const& changes, std::string const& stage) {
    Box box{{changes.width(), changes.height()}, {-1, -1}};
    for (std::int64_t row = 0; row < changes.height(); ++row) {
        auto const cells = changes.row(row);
        auto const is_set = [](std::uint8_t m) { return m != 0; };
        auto const first = std::ranges::find_if(cells, is_set);
        if (first == cells.end()) {
            continue;
        }
        auto const last = std::find_if(cells.rbegin(), cells.rend(), is_set);
        box.first = {std::min(box.first.col, first - cells.begin()), std::min(box.first.row, row)};
        box.last = {std::max(box.last.col, cells.rend() - last - 1), row};
    }
    if (box.last.row < 0) {
        throw BadInput(stage + ": no cell of the target would change: take a mask that holds cells with heights");
    }
    return {{std::max<std::int64_t>(box.first.col - 1, 0), std::max<std::int64_t>(box.first.row - 1, 0)},
            {std::min(box.last.col + 1, changes.width() - 1), std::min(box.last.row + 1, changes.height() - 1)}};
}

Grid frame_of(Grid const& target, Box const& box) {
    Grid frame = target;
    frame.width = box.last.col - box.first.col + 1;
    frame.height = box.last.row - box.first.row + 1;
    frame.west = target.west + static_cast<double>(box.first.col) * target.cell_m;
    frame.north = target.north - static_cast<double>(box.first.row) * target.cell_m;
    return frame;
}

// Every connected part of the free cells needs a fixed neighbour to hang on.
void require_held(Opening const& opening, Grid const& target, std::string const& stage, Run const& run) {
    Grid const& grid = opening.kind.grid();
    Mask seen(grid);
    std::vector<std::int64_t> reached;
    for (std::int64_t start = 0; start < grid.cells(); ++start) {
        if (opening.kind[start] != free_cell || seen[start] != 0) {
            continue;
        }
        run.check();
        bool held = false;
        std::int64_t cells = 0;
        seen[start] = 1;
        reached.assign(1, start);
        while (!reached.empty()) {
            Cell const c = grid.at(reached.back());
            reached.pop_back();
            ++cells;
            for (Cell const n : neighbours_of(c)) {
                if (!grid.contains(n)) {
                    continue;
                }
                held = held || opening.kind[n] == fixed_cell;
                if (opening.kind[n] == free_cell && seen[n] == 0) {
                    seen[n] = 1;
                    reached.push_back(grid.index(n));
                }
            }
        }
        if (held) {
            continue;
        }
        if (cells == target.cells()) {
            throw BadInput(fmt::format("{}: all {} x {} cells of the target would change: leave at least one that "
                                       "keeps its height",
                                       stage, target.width, target.height));
        }
        Cell const c = grid.at(start);
        Cell const there{c.col + opening.corner.col, c.row + opening.corner.row};
        Vec2 const p = target.centre(there);
        throw BadInput(fmt::format("{}: the part of {} cells at column {}, row {} ({:.3f}, {:.3f}) has no neighbour "
                                   "with a height to join: take a part that reaches one",
                                   stage, cells, there.col, there.row, p.x, p.y));
    }
}

} // namespace

Opening open_target(Raster<float> const& target, Mask const& changes, Mask const& given, std::string const& stage,
                    Run const& run) {
    Box const box = box_of(changes, stage);
    Grid const frame = frame_of(target.grid(), box);
    Opening opening{box.first, Raster<std::uint8_t>(frame), Raster<double>(frame)};
    auto const changes_there = [&](Cell c) { return target.grid().contains(c) && changes[c] != 0; };
    for (std::int64_t i = 0; i < frame.cells(); ++i) {
        Cell const c = frame.at(i);
        Cell const there{c.col + box.first.col, c.row + box.first.row};
        opening.target[i] = target[there];
        if (changes[there] != 0) {
            opening.kind[i] = free_cell;
            ++opening.cells;
            continue;
        }
        bool const is_given = given.cells() > 0 && given[there] != 0;
        bool const is_beside = std::ranges::any_of(neighbours_of(there), changes_there);
        if (!is_given && (!is_beside || std::isnan(target[there]))) {
            continue;
        }
        if (!is_given && std::isinf(target[there])) {
            throw BadInput(fmt::format("{}: the target's height at column {}, row {} is infinite: correct it", stage,
                                       there.col, there.row));
        }
        opening.kind[i] = fixed_cell;
        ++opening.neighbours;
    }
    require_held(opening, target.grid(), stage, run);
    return opening;
}

} // namespace thalweg::blend
