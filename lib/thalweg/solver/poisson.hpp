// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>

namespace thalweg::solver {

/// What a cell is to a problem on the grid.
enum class CellKind : std::uint8_t {
    outside, ///< no part of it: nothing flows across its edges
    free,    ///< its value is sought
    fixed    ///< keeps its value
};

/// Poisson's equation on the cells of a grid.
struct GridProblem {
    Raster<std::uint8_t> kind; ///< CellKind
    Raster<double> value;      ///< fixed cells: their value; free cells: a first guess, or 0 or NaN; outside: anything
    Raster<double> source;     ///< b of free cells; empty for Laplace's equation
};

struct PoissonParams {
    double tolerance = 1e-10; ///< (0,1) of the residual's norm against that of the problem with 0 in its free cells
    int most_iterations = 1000;
};

struct GridSolution {
    Raster<double> value; ///< free cells: the solution; fixed and outside ones as they came
    int iterations = 0;
    double residual = 0.0; ///< reached, as tolerance counts it
};

/// Solves sum over the 4-neighbours n that are not outside of (u_c - u_n) = b_c for every free cell c.
/// Gives: fixed cells bit for bit; for Laplace's equation values between the least and the greatest fixed one.
/// Throws: BadInput naming a cell when a part of the grid has free cells and no fixed one, or a value is not finite;
/// BadParameter; NotConverged; Cancelled.
GridSolution solve_poisson(GridProblem problem, PoissonParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
