// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/internal/problem_through.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/grid/unreached.hpp>

#include <cmath>

#include <fmt/format.h>

namespace thalweg::surface {
namespace {

using solver::CellKind;

CellKind kind_of(float z, bool inside) {
    if (!inside) {
        return CellKind::outside;
    }
    return std::isnan(z) ? CellKind::free : CellKind::fixed;
}

} // namespace

solver::GridProblem problem_through(Raster<float> const& z, Mask const& inside, char const* stage, Run const& run) {
    Grid const& grid = z.grid();
    if (inside.cells() > 0 && inside.grid() != grid) {
        throw BadInput(fmt::format("{}: the mask ({} x {} cells of {} m) has another frame than the heights ({} x {} "
                                   "cells of {} m); make both on one grid",
                                   stage, inside.width(), inside.height(), inside.grid().cell_m, grid.width,
                                   grid.height, grid.cell_m));
    }
    run.check();
    solver::GridProblem problem{Raster<std::uint8_t>(grid), Raster<double>(grid), {}};
    bool any = false;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        CellKind const kind = kind_of(z[i], inside.cells() == 0 || inside[i] != 0);
        problem.kind[i] = static_cast<std::uint8_t>(kind);
        if (kind == CellKind::fixed) {
            if (std::isinf(z[i])) {
                Cell const c = grid.at(i);
                throw BadInput(
                    fmt::format("{}: an infinite height at column {}, row {}; give finite ones", stage, c.col, c.row));
            }
            problem.value[i] = static_cast<double>(z[i]);
            any = true;
        }
    }
    if (!any) {
        throw BadInput(fmt::format("{}: no cell of the {} x {} (inside the mask, where there is one) has a height; a "
                                   "surface needs one to pass through",
                                   stage, grid.width, grid.height));
    }
    for (solver::CellSpan const& span : solver::unreached(problem.kind, run)) {
        for (std::int64_t col = span.begin; col < span.end; ++col) {
            problem.kind[{col, span.row}] = solver::outside_cell;
        }
    }
    return problem;
}

} // namespace thalweg::surface
