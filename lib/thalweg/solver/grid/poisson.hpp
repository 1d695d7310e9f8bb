// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// What a cell is to a problem on the grid.
enum class CellKind : std::uint8_t {
    outside, ///< no part of it: nothing flows across its edges
    free,    ///< its value is sought
    fixed    ///< keeps its value
};

/// The same as a raster of kinds holds them.
inline constexpr auto outside_cell = static_cast<std::uint8_t>(CellKind::outside);
inline constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
inline constexpr auto fixed_cell = static_cast<std::uint8_t>(CellKind::fixed);

/// Poisson's equation on the cells of a grid.
struct GridProblem {
    Raster<std::uint8_t> kind; ///< CellKind
    Raster<double> value;      ///< fixed cells: their value; free cells: a first guess, or 0 or NaN; outside: anything
    Raster<double> source;     ///< b of free cells; empty for Laplace's equation
};

/// Options of solve_poisson().
struct PoissonParams {
    /// (0,1) of the residual's norm against that of the problem with 0 in its free cells; and of the error, as a
    /// multigrid cycle sees it, against the greatest |value|: 1e-6 brings land of 1000 m to within 1 mm
    double tolerance = 1e-10;
    int most_iterations = 1000; ///< [0, ...]
};

/// A solved grid, with the number of iterations and the residual.
struct GridSolution {
    Raster<double> value; ///< free cells: the solution; fixed and outside ones as they came
    int iterations = 0;
    double residual = 0.0; ///< reached, as tolerance counts it, from the values in double
};

/// Solves sum over the 4-neighbours n that are not outside of (u_c - u_n) = b_c for every free cell c, by conjugate
/// gradients with a multigrid cycle for preconditioner: some 15 to 30 iterations for 1e-6, whatever the size of the
/// grid.
/// \param problem any grid, of one row or column too. Memory beside the problem: 32 bytes a cell, 2 more while it is
/// prepared
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return fixed cells bit for bit; for Laplace's equation values between the least and the greatest fixed one; the
/// same bytes for any number of threads. Tolerances down to 1e-12 can be reached on grids of any shape, 1e-14 where no
/// cell is far from a fixed one.
/// \throws BadInput naming a cell when a part of the grid has free cells and no fixed one, or a value is not finite, or
/// the frames differ
/// \throws BadParameter
/// \throws NotConverged after most_iterations, or where double has no more digits
/// \throws Cancelled
///
/// Source: \cite nenu2015, equations 12 and 16; \cite hestenes1952; \cite braess1995 (aggregation).
GridSolution solve_poisson(GridProblem problem, PoissonParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
