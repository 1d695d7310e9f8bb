// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: A free cell times its number of neighbours less their sum equals the source: one sparse,
// symmetric equation a cell. Conjugate gradients solve it, and need as many iterations as the grid
// is wide unless something corrects long waves. That is one multigrid cycle: 2 x 2 cells become
// one, down to a single cell; each level sweeps red, then black cells, adds the correction of the
// coarser level, and sweeps back. Coarse corrections are constant over 2 x 2 cells and would be too
// steep, so edges between coarse cells are weakened (resistors in series from middle to middle),
// and the first two coarser levels make two cycles. The cycle works in float, the values in double.
// It stops where both the residual and the estimated error are small. relax_explicit is plain
// diffusion by small steps.
// Source: Hestenes and Stiefel 1952; Braess 1995 (aggregation); edges and second cycles are ours:
// docs/decisions/0011-solver.md. Northeast Normal University 2015, equations 12, 13 and 16.
// Cost: O(n) for each of 8 or 9 iterations to 1e-6 on a grid of any size. docs/performance.md: 85
// ns and 56 bytes a cell for 2048 x 2048, 0.06 of the time of a sparse Cholesky factor. All cores;
// the same bytes for any number.
// Not for: varying conductivity or meshes (SparseFactor in linear/linear.hpp); parts without a
// fixed cell, which have no unique answer and are refused (unreached finds them). Mazes of one-cell
// gaps take more iterations.
// Example:
//     GridProblem problem{Raster<std::uint8_t>(grid, free_cell), Raster<double>(grid), {}};
//     problem.kind[Cell{0, 0}] = fixed_cell;
//     problem.value[Cell{0, 0}] = 120.0;
//     GridSolution const heights = solve_poisson(std::move(problem), {.tolerance = 1e-8});
// More: docs/rivers.md, "Diffusion" and "On a graphics card".

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
/// gradients with a multigrid preconditioner: 8 or 9 iterations for 1e-6 on a grid of any size, more where many cells
/// are outside. Memory beside the problem: 34 bytes a cell, 2 more during preparation.
/// \param problem each connected part with free cells has a fixed one
/// \return fixed cells bit for bit; for Laplace's equation values between the lowest and highest fixed one; the same
/// bytes for any number of threads. A tolerance of 1e-12 can be reached on any grid, 1e-14 where no cell is far from a
/// fixed one.
/// \throws BadInput naming a cell when a part of the grid has free cells and no fixed one, a value is not finite, or
/// the frames differ
/// \throws BadParameter when a parameter is outside its range
/// \throws NotConverged after most_iterations, or at the limit of double precision
///
/// Source: \cite nenu2015, equations 12 and 16; \cite hestenes1952; \cite braess1995 (aggregation).
GridSolution solve_poisson(GridProblem problem, PoissonParams const& params = {}, Run const& run = {});

/// Consecutive cells of one row.
struct CellSpan {
    std::int64_t row = 0;
    std::int64_t begin = 0; ///< first column
    std::int64_t end = 0;   ///< one past the last column
};

/// Finds the free cells not connected (by 4-neighbours that are not outside) to a fixed cell: Laplace's equation has no
/// unique solution there.
/// \param kind CellKind by cell
/// \return each such cell in one span; spans in row order
std::vector<CellSpan> unreached(Raster<std::uint8_t> const& kind, Run const& run = {});

/// Options of relax_explicit().
struct ExplicitParams {
    double alpha = 0.25; ///< (0, 1/4] time step times diffusivity / area of a cell
    int sweeps = 5500;   ///< [0, ...]
};

/// Diffuses the values of free cells by explicit sweeps: U += alpha (sum over the 4-neighbours n that are not outside
/// of (U_n - U_c)), all cells at once.
/// \param problem without a source; finite initial values
/// \return fixed cells bit for bit; values between the lowest and highest fixed one; residual as in solve_poisson; the
/// same bytes for any number of threads
/// \throws BadParameter for alpha above 1/4, where the sweeps are unstable
/// \throws BadInput as solve_poisson, for a source, or for an initial value that is not finite
///
/// Source: \cite nenu2015, equation 13 with its sign corrected.
GridSolution relax_explicit(GridProblem problem, ExplicitParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
