// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/poisson.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// What solve_poisson does for Device::opencl, on that device.
/// Takes: a problem and what look_through has found in it.
/// Gives: as solve_poisson; fixed cells bit for bit. For heights up to 1000 m the free ones differ from the processor's
/// by less than 1e-6 m at a tolerance of 1e-10; the same device gives the same bits each time. Memory on the device: 90
/// bytes a cell. Throws: NotConverged; Cancelled; BadParameter as opencl_device_name(); IoError when the device fails
/// or is too small.
/// Source: paper 003, section 4.3; conjugate gradients (Hestenes and Stiefel 1952) with a multigrid cycle of plain
/// aggregation for a preconditioner (Braess 1995, but with half of Galerkin's ties in the place of over-correction).
GridSolution solve_poisson_opencl(GridProblem problem, Contents const& contents, PoissonParams const& params,
                                  Run const& run);

/// What relax_explicit does for Device::opencl, on that device.
/// Takes: a problem whose numbers are finite but outside; alpha in (0, 1/4]; sweeps >= 0.
/// Gives: in every sweep each free cell's u + alpha ((w + e) + (n + s) - k u) of the numbers before it, where only the
/// k neighbours that are not outside count; all others keep their bits. The same bits as relax_explicit's on the
/// processor. Memory on the device: 18 bytes a cell.
/// Throws: BadParameter as opencl_device_name(); IoError when the device fails or is too small; Cancelled.
/// Source: paper 003, equation 13 with its sign mended, and section 4.3.
void relax_opencl(GridProblem& problem, double alpha, std::int64_t sweeps, Run const& run);

} // namespace thalweg::solver
