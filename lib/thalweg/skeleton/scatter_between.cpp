// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter_between.hpp>

#include <thalweg/core/cells/nearest_cells.hpp>
#include <thalweg/core/numbers/normal.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/skeleton/internal/place_points.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t share_stage = 0x7363617474657235; // "scatter5"
constexpr double nearest_allowed_cells = 2.0;

void demand(Valley const& valley, Mask const& inside, ScatterBetweenParams const& p) {
    constexpr char const* stage = "skeleton.scatter_between";
    require_in(stage, "count", p.count, Range::at_least(0));
    require_in(stage, "spacing", p.spacing_cells, Range::at_least(0.0), "cells");
    require_in(stage, "gain", p.gain, Range::at_least(0.0));
    require_in(stage, "farthest", p.farthest_m, Range::at_least(0.0), "m");
    if (inside.cells() > 0 && inside.grid() != valley.z.grid()) {
        throw BadInput("skeleton.scatter_between: the mask has another grid than the valley");
    }
}

Mask rivers_of(Valley const& valley) {
    Mask rivers(valley.z.grid());
    for (std::int64_t i = 0; i < rivers.cells(); ++i) {
        rivers[i] = std::isnan(valley.z[i]) ? 0 : 1;
    }
    if (std::find(rivers.values().begin(), rivers.values().end(), 1) == rivers.values().end()) {
        throw BadInput("skeleton.scatter_between: no cell has a river; points need one to stand above");
    }
    return rivers;
}

double distance_cells(Grid const& grid, std::int64_t a, std::int64_t b) {
    Cell const from = grid.at(a);
    Cell const to = grid.at(b);
    auto const dx = static_cast<double>(from.col - to.col);
    auto const dy = static_cast<double>(from.row - to.row);
    return std::sqrt(dx * dx + dy * dy);
}

/// Cell centres along the grid's border, evenly apart: as many as a border has where points spread evenly, and corners.
std::vector<Vec2> border_places(Grid const& grid, std::int64_t count) {
    double const apart = std::sqrt(static_cast<double>(grid.cells()) / static_cast<double>(count)); // [cells]
    auto const parts = [apart](std::int64_t side) {
        return std::clamp<std::int64_t>(std::llround(static_cast<double>(side - 1) / apart), 1,
                                        std::max<std::int64_t>(1, side - 1));
    };
    std::vector<Vec2> places;
    auto const put = [&](std::int64_t col, std::int64_t row) { places.push_back(grid.centre({col, row})); };
    for (std::int64_t k = 0, n = parts(grid.width); k < n; ++k) {
        put(k * (grid.width - 1) / n, 0);
        put((k + 1) * (grid.width - 1) / n, grid.height - 1);
    }
    for (std::int64_t k = 0, n = parts(grid.height); k < n; ++k) {
        put(0, (k + 1) * (grid.height - 1) / n);
        put(grid.width - 1, k * (grid.height - 1) / n);
    }
    return places;
}

/// Of these places those on free cells that keep the spacing, at most count.
std::vector<Vec2> with_room(std::vector<Vec2> const& places, Mask const& free, ScatterBetweenParams const& params) {
    double const spacing_m = params.spacing_cells * free.grid().cell_m;
    std::vector<Vec2> kept;
    for (Vec2 const p : places) {
        bool const has_room =
            std::all_of(kept.begin(), kept.end(), [&](Vec2 q) { return p != q && distance(p, q) >= spacing_m; });
        if (has_room && free[free.grid().cell_of(p)] != 0 && static_cast<std::int64_t>(kept.size()) < params.count) {
            kept.push_back(p);
        }
    }
    return kept;
}

double share_of(std::uint64_t place, ScatterBetweenParams const& params) {
    if (params.law == HeightLaw::uniform) {
        return unit(random_word(params.seed, share_stage, place));
    }
    for (std::uint64_t again = 0;; ++again) {
        auto const words = random_block(params.seed, share_stage, place, again);
        double const share = 0.5 + normal_pair(words[0], words[1])[0] / 6.0;
        if (share >= 0.0 && share <= 1.0) {
            return share;
        }
    }
}

} // namespace

Scattered scatter_between(Valley const& valley, Mask const& inside, ScatterBetweenParams const& params,
                          Run const& run) {
    demand(valley, inside, params);
    Grid const& grid = valley.z.grid();
    Raster<std::int64_t> const nearest = nearest_cells(rivers_of(valley), run);
    double const clear = std::max(params.spacing_cells, nearest_allowed_cells);
    Mask free(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        bool const may_be = inside.cells() == 0 || inside[i] != 0;
        free[i] = may_be && distance_cells(grid, i, nearest[i]) >= clear ? 1 : 0;
    }
    Scattered result;
    result.points.crs = grid.crs;
    if (params.count == 0) {
        return result;
    }
    std::vector<Vec2> places = with_room(border_places(grid, params.count), free, params);
    PlacedPoints const placed =
        place_points(grid, free, {params.seed, params.count, params.spacing_cells, places}, run);
    places.insert(places.end(), placed.places.begin(), placed.places.end());
    result.missing = placed.missing;
    result.density = placed.density;
    double const most =
        params.farthest_m > 0.0 ? params.farthest_m / grid.cell_m : std::numeric_limits<double>::infinity();
    for (std::uint64_t number = 0; Vec2 const p : places) {
        std::int64_t const cell = grid.index(grid.cell_of(p));
        double const rise = params.gain * std::min(distance_cells(grid, cell, nearest[cell]), most) * grid.cell_m;
        result.points.points.push_back(
            {p.x, p.y, static_cast<double>(valley.z[nearest[cell]]) + rise * share_of(number++, params)});
    }
    return result;
}

} // namespace thalweg::skeleton
