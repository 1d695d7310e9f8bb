// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/water.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include <cairo.h>

namespace thalweg::draw {
namespace {

/// Every value becomes the mean, weighted 1, 2, 1, of its row's three values around it; the same along columns.
void smooth(Raster<float>& field) {
    std::int64_t const width = field.width();
    std::int64_t const height = field.height();
    std::vector<float> line(static_cast<std::size_t>(std::max(width, height)));
    auto const along = [&](std::int64_t first, std::int64_t step, std::int64_t count) {
        for (std::int64_t i = 0; i < count; ++i) {
            float const before = field[first + std::max<std::int64_t>(i - 1, 0) * step];
            float const after = field[first + std::min(i + 1, count - 1) * step];
            line[static_cast<std::size_t>(i)] = 0.25F * before + 0.5F * field[first + i * step] + 0.25F * after;
        }
        for (std::int64_t i = 0; i < count; ++i) {
            field[first + i * step] = line[static_cast<std::size_t>(i)];
        }
    };
    for (std::int64_t row = 0; row < height; ++row) {
        along(row * width, 1, width);
    }
    for (std::int64_t col = 0; col < width; ++col) {
        along(col, width, height);
    }
}

/// Shares of water on a grid three cells larger on every side, with no water in its outermost cells: lines close there.
Raster<float> padded(Mask const& water) {
    constexpr std::int64_t rim = 3;
    Grid grid = water.grid();
    grid.width += 2 * rim;
    grid.height += 2 * rim;
    grid.west -= static_cast<double>(rim) * grid.cell_m;
    grid.north += static_cast<double>(rim) * grid.cell_m;
    Raster<float> out(grid);
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        Cell const c = grid.at(i);
        out[i] = water[Cell{std::clamp<std::int64_t>(c.col - rim, 0, water.width() - 1),
                            std::clamp<std::int64_t>(c.row - rim, 0, water.height() - 1)}];
    }
    smooth(out);
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        out[i] = grid.on_border(grid.at(i)) ? 0.0F : out[i];
    }
    return out;
}

constexpr float shore_share = 0.49F; // not a half: no value of a smoothed mask lies on the line

/// Lines of a shore by the sides between neighbouring cell centres that they cross: twice the index of the western or
/// northern cell, and one more for a side that runs south.
using NextSide = std::unordered_map<std::int64_t, std::int64_t>;

/// Adds the parts of shores in the square south-east of a cell centre.
void cross_square(Raster<float> const& share, Cell c, NextSide& next, std::vector<std::int64_t>& begins) {
    std::int64_t const width = share.width();
    std::int64_t const nw = share.grid().index(c);
    std::array<std::int64_t, 4> const corners = {nw, nw + 1, nw + 1 + width, nw + width}; // clockwise
    std::array<std::int64_t, 4> const sides = {2 * nw, 2 * (nw + 1) + 1, 2 * (nw + width), 2 * nw + 1};
    auto const wet = [&](std::size_t k) { return share[corners[k % 4]] > shore_share; };
    for (std::size_t k = 0; k < 4; ++k) {
        if (!wet(k) || wet(k + 1)) {
            continue;
        }
        std::size_t back = k + 1; // the side where the shore comes back to water
        while (!wet(back + 1)) {
            ++back;
        }
        next[sides[k]] = sides[back % 4];
        begins.push_back(sides[k]);
    }
}

Vec2 place_on_side(Raster<float> const& share, std::int64_t side) {
    Grid const& grid = share.grid();
    std::int64_t const from = side / 2;
    std::int64_t const to = from + (side % 2 == 0 ? 1 : grid.width);
    double const part = (shore_share - share[from]) / (share[to] - share[from]);
    Vec2 const a = grid.centre(grid.at(from));
    Vec2 const b = grid.centre(grid.at(to));
    return a + part * (b - a);
}

/// Moves what closes a shore beyond the grid far off it: no line is drawn along the map's frame.
Vec2 far_off(Vec2 p, Grid const& grid) {
    double const rim = 1.5 * grid.cell_m;
    double const far = static_cast<double>(grid.width + grid.height) * grid.cell_m;
    auto const moved = [&](double x, double low, double high) {
        return x < low - rim ? x - far : x > high + rim ? x + far : x;
    };
    return {moved(p.x, grid.west, grid.east()), moved(p.y, grid.south(), grid.north)};
}

} // namespace

Shores shores(Mask const& water) {
    Raster<float> const share = padded(water);
    NextSide next;
    std::vector<std::int64_t> begins;
    for (std::int64_t row = 0; row + 1 < share.height(); ++row) {
        for (std::int64_t col = 0; col + 1 < share.width(); ++col) {
            cross_square(share, {col, row}, next, begins);
        }
    }
    Shores out;
    for (std::int64_t const begin : begins) {
        std::vector<Vec2> line;
        for (auto at = next.find(begin); at != next.end();) {
            line.push_back(far_off(place_on_side(share, at->first), water.grid()));
            std::int64_t const following = at->second;
            next.erase(at);
            at = next.find(following);
        }
        if (line.size() > 2) {
            line.push_back(line.front());
            out.push_back(std::move(line));
        }
    }
    return out;
}

Mask holes_of(Raster<float> const& dem) {
    Mask out(dem.grid());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        out[i] = std::isfinite(dem[i]) ? 0 : 1;
    }
    return out;
}

Relief sea_depths(Mask const& sea) {
    constexpr std::int64_t longest = 128; // sides of the image
    constexpr int rounds = 24;            // of smoothing: a fortieth of the longer side
    std::int64_t const block = (std::max(sea.width(), sea.height()) + longest - 1) / longest;
    Raster<float> share(Grid{(sea.width() + block - 1) / block, (sea.height() + block - 1) / block, 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < share.cells(); ++i) {
        Cell const c = share.grid().at(i);
        std::int64_t const right = std::min(sea.width(), (c.col + 1) * block);
        std::int64_t const bottom = std::min(sea.height(), (c.row + 1) * block);
        std::int64_t wet = 0;
        for (std::int64_t row = c.row * block; row < bottom; ++row) {
            for (std::int64_t col = c.col * block; col < right; ++col) {
                wet += sea[Cell{col, row}];
            }
        }
        std::int64_t const cells = (right - c.col * block) * (bottom - c.row * block);
        share[i] = static_cast<float>(wet) / static_cast<float>(cells);
    }
    for (int k = 0; k < rounds; ++k) {
        smooth(share);
    }
    Relief out;
    out.width = static_cast<int>(share.width());
    out.height = static_cast<int>(share.height());
    out.cells_a_pixel = static_cast<double>(block);
    for (float const wet : share.values()) {
        Colour const colour = mix(shallow_sea, deep_sea, std::clamp(2.0 * static_cast<double>(wet) - 1.0, 0.0, 1.0));
        out.pixels.push_back(packed(colour.red, colour.green, colour.blue, 1.0));
    }
    return out;
}

void draw_water(Cairo* canvas, Shores const& on_sheet, Relief const* depths, Box where, double px_per_cell,
                double unit) {
    auto const trace = [&] {
        for (std::vector<Vec2> const& shore : on_sheet) {
            trace_line(canvas, shore, 0.6 * px_per_cell);
            cairo_close_path(canvas);
        }
    };
    cairo_save(canvas);
    cairo_set_fill_rule(canvas, CAIRO_FILL_RULE_EVEN_ODD);
    trace();
    cairo_clip(canvas);
    if (depths != nullptr) {
        draw_relief(canvas, *depths, where, px_per_cell);
    } else {
        fill_box(canvas, where, lake_colour);
    }
    for (double const width : {12.0, 6.0}) { // the shelf: half of a line lies in the water
        trace();
        set_colour(canvas, {1.0, 1.0, 1.0, 0.16});
        cairo_set_line_width(canvas, width * unit);
        cairo_stroke(canvas);
    }
    cairo_restore(canvas);
    trace();
    set_colour(canvas, {0.25, 0.47, 0.62, 0.9});
    cairo_set_line_width(canvas, 0.9 * unit);
    cairo_stroke(canvas);
}

} // namespace thalweg::draw
