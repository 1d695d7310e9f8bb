// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// The role of a cell in a grid problem.
enum class CellKind : std::uint8_t {
    outside, ///< not part of the problem: no flux across its edges
    free,    ///< unknown
    fixed    ///< Dirichlet value
};

/// CellKind as stored in rasters.
inline constexpr auto outside_cell = static_cast<std::uint8_t>(CellKind::outside);
inline constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
inline constexpr auto fixed_cell = static_cast<std::uint8_t>(CellKind::fixed);

/// Poisson's equation on the cells of a grid.
struct GridProblem {
    Raster<std::uint8_t> kind; ///< CellKind
    Raster<double> value;      ///< fixed: the value; free: initial guess, 0 or NaN; outside: not read
    Raster<double> source;     ///< b of free cells; empty for Laplace's equation
};

/// Options of solve_poisson().
struct PoissonParams {
    /// (0, 1) residual norm relative to that with 0 in free cells; and error, estimated by a multigrid cycle, relative
    /// to the largest |value|: 1e-6 is 1 mm for heights of 1000 m
    double tolerance = 1e-10;
    int most_iterations = 1000; ///< [0, ...]
};

/// The solution of a grid problem, with the number of iterations and the residual.
struct GridSolution {
    Raster<double> value; ///< free cells: the solution; others unchanged
    int iterations = 0;
    double residual = 0.0; ///< in double, relative as in PoissonParams::tolerance
};

/// Solves sum over the 4-neighbours n that are not outside of (u_c - u_n) = b_c for every free cell c, by conjugate
/// gradients with a multigrid preconditioner: 15 to 30 iterations for 1e-6 on a grid of any size. Memory beside the
/// problem: 32 bytes a cell, 2 more during preparation.
/// \param problem each connected part with free cells has a fixed one
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return fixed cells bit for bit; for Laplace's equation values between the lowest and highest fixed one; the same
/// bytes for any number of threads. A tolerance of 1e-12 can be reached on any grid, 1e-14 where no cell is far from a
/// fixed one.
/// \throws BadInput naming a cell when a part of the grid has free cells and no fixed one, a value is not finite, or
/// the frames differ
/// \throws BadParameter when a parameter is outside its range
/// \throws NotConverged after most_iterations, or at the limit of double precision
/// \throws Cancelled
///
/// Source: \cite nenu2015, equations 12 and 16; \cite hestenes1952; \cite braess1995 (aggregation).
GridSolution solve_poisson(GridProblem problem, PoissonParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
