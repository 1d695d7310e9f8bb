// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/check_equilibrium.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace thalweg::surface {

namespace {

std::string place(Grid const& grid, std::int64_t cell) {
    Cell const c = grid.at(cell);
    return fmt::format("column {}, row {}", c.col, c.row);
}

void check_params(EquilibriumParams const& params) {
    constexpr char const* self = "surface.equilibrium";
    require_in(self, "theta", params.theta, Range::between(0.1, 0.9));
    require_in(self, "hillslope_m", params.hillslope_m, Range::at_least(0.0), "m");
    require_in(self, "debris_area_m2", params.debris_area_m2, Range::at_least(0.0), "m²");
    require_in(self, "floor_width_km", params.floor_width_km, Range::between(0.0, 1.0), "km");
    require_in(self, "roughness", params.roughness, Range::between(0.0, 1.0));
    require_in(self, "longest_wave_m", params.longest_wave_m, Range::above(0.0), "m");
    require_in(self, "region", params.region, Range::between(1.0, 5.0));
    require_in(self, "grain", params.grain, Range::between(1.0, 20.0));
    if (params.strike_deg) {
        require_in(self, "strike_deg", *params.strike_deg, Range::between(-360.0, 360.0), "degrees");
    }
    if (params.relief_m) {
        require_in(self, "relief_m", *params.relief_m, Range::above(0.0), "m");
    } else {
        require_in(self, "mean_slope_deg", params.mean_slope_deg, Range{0.0, 60.0, false, true}, "degrees");
    }
}

void check_grid(Grid const& grid) {
    constexpr std::int64_t most = std::int64_t{1} << 30; // cells are counted in 32 bits, the frame included
    if (grid.width <= 0 || grid.height <= 0) {
        throw BadInput("surface.equilibrium: the rivers' grid has no cells; make it at least 1 x 1");
    }
    if (grid.width > most || grid.height > most || grid.cells() > most) {
        throw BadInput(fmt::format("surface.equilibrium: the grid of {} x {} cells is too large; {} cells at most",
                                   grid.width, grid.height, most));
    }
    if (!(grid.cell_m > 0.0 && std::isfinite(grid.cell_m))) {
        throw BadInput(
            fmt::format("surface.equilibrium: the rivers' cell size is {} m; give one above 0", grid.cell_m));
    }
}

void check_order(Channels const& rivers) {
    Grid const& grid = rivers.grid;
    if (rivers.cell.empty()) {
        throw BadInput("surface.equilibrium: there are no rivers; give at least one cell in which water leaves");
    }
    if (rivers.receiver.size() != rivers.cell.size() || (!rivers.z.empty() && rivers.z.size() != rivers.cell.size()) ||
        (!rivers.level.empty() && rivers.level.size() != rivers.cell.size())) {
        throw BadInput(fmt::format("surface.equilibrium: {} river cells have {} receivers, {} heights and {} marks of "
                                   "lakes; give one each",
                                   rivers.cell.size(), rivers.receiver.size(), rivers.z.size(), rivers.level.size()));
    }
    Mask taken(grid);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const cell = rivers.cell[n];
        if (cell < 0 || cell >= grid.cells()) {
            throw BadInput(fmt::format("surface.equilibrium: river cell {} lies at index {}, outside the grid of {} "
                                       "cells",
                                       n, cell, grid.cells()));
        }
        if (taken[cell] != 0) {
            throw BadInput(fmt::format("surface.equilibrium: two rivers in one cell, at {} (the later is river cell "
                                       "{}); join them there",
                                       place(grid, cell), n));
        }
        taken[cell] = 1;
        std::int64_t const receiver = rivers.receiver[n];
        if (receiver < -1 || receiver >= static_cast<std::int64_t>(n)) {
            throw BadInput(fmt::format("surface.equilibrium: river cell {} at {} flows to number {}; list cells "
                                       "downstream first",
                                       n, place(grid, cell), receiver));
        }
        if (receiver >= 0) {
            Cell const a = grid.at(cell);
            Cell const b = grid.at(rivers.cell[static_cast<std::size_t>(receiver)]);
            if (std::max(std::abs(a.col - b.col), std::abs(a.row - b.row)) != 1) {
                throw BadInput(
                    fmt::format("surface.equilibrium: river cell {} at {} flows to {}, which is not a neighbour", n,
                                place(grid, cell), place(grid, grid.index(b))));
            }
        }
    }
}

void check_land(Channels const& rivers, Mask const& land) {
    if (land.cells() == 0) {
        return;
    }
    if (land.grid() != rivers.grid) {
        throw BadInput("surface.equilibrium: the land's mask has another frame than the rivers; make both on one grid");
    }
    auto const values = land.values();
    if (std::none_of(values.begin(), values.end(), [](std::uint8_t v) { return v != 0; })) {
        throw BadInput("surface.equilibrium: the mask leaves no land; mark at least the rivers' cells as land");
    }
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (land[rivers.cell[n]] == 0) {
            throw BadInput(fmt::format("surface.equilibrium: river cell {} at {} lies at sea; end the river at the "
                                       "coast",
                                       n, place(rivers.grid, rivers.cell[n])));
        }
    }
}

void check_field(Grid const& grid, Raster<float> const& field, Mask const& land, std::string_view name) {
    if (field.cells() == 0) {
        return;
    }
    if (field.grid() != grid) {
        throw BadInput(
            fmt::format("surface.equilibrium: {} has another frame than the rivers; make both on one grid", name));
    }
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        bool const dry = land.cells() == 0 || land[i] != 0;
        if (dry && !(field[i] > 0.0F && std::isfinite(field[i]))) {
            throw BadInput(fmt::format("surface.equilibrium: {} is {} at {}; every cell of land needs a number above 0",
                                       name, field[i], place(grid, i)));
        }
    }
}

/// Heights may not rise downstream, also from one that is given to the next, past cells without.
void check_channel_heights(Channels const& rivers) {
    float const none = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> below(rivers.z.size(), none); // height of the nearest cell downstream that has one, itself first
    for (std::size_t n = 0; n < rivers.z.size(); ++n) {
        float const z = rivers.z[n];
        if (std::isinf(z)) {
            throw BadInput(fmt::format("surface.equilibrium: the height of river cell {} at {} is infinite", n,
                                       place(rivers.grid, rivers.cell[n])));
        }
        std::int64_t const receiver = rivers.receiver[n];
        float const next = receiver < 0 ? none : below[static_cast<std::size_t>(receiver)];
        if (z < next) {
            throw BadInput(fmt::format("surface.equilibrium: the river rises downstream of cell {} at {}, from {} m to "
                                       "{} m; reverse or repair it",
                                       n, place(rivers.grid, rivers.cell[n]), z, next));
        }
        below[n] = std::isnan(z) ? next : z;
    }
}

} // namespace

void check_equilibrium(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    check_params(params);
    check_grid(rivers.grid);
    check_order(rivers);
    check_land(rivers, fields.land);
    check_field(rivers.grid, fields.uplift, fields.land, "uplift");
    check_field(rivers.grid, fields.erodibility, fields.land, "erodibility");
    check_channel_heights(rivers);
}

} // namespace thalweg::surface
