// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/poisson.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// solve_poisson on the OpenCL device. At a tolerance of 1e-10 heights up to 1000 m differ from the processor's by less
/// than 1e-6 m; the same device gives the same bits each time. Memory on the device: 90 bytes a cell.
/// \param problem a problem
/// \param contents result of survey_problem for it
/// \return as solve_poisson; fixed cells bit for bit
/// \throws NotConverged as solve_poisson
/// \throws BadParameter as opencl_device_name()
/// \throws IoError when the device fails or has too little memory
///
/// Source: \cite nenu2015, section 4.3; conjugate gradients (Hestenes and Stiefel 1952), preconditioned by a multigrid
/// cycle of plain aggregation (Braess 1995, with half of Galerkin's edge weights instead of over-correction).
GridSolution solve_poisson_opencl(GridProblem problem, Contents const& contents, PoissonParams const& params,
                                  Run const& run);

/// relax_explicit on the OpenCL device. In every sweep a free cell becomes u + alpha ((w + e) + (n + s) - k u), where
/// only its k neighbours that are not outside count; other cells are unchanged. The same bits as relax_explicit on the
/// processor. Memory on the device: 18 bytes a cell.
/// \param problem finite values, except outside
/// \param alpha (0, 1/4]
/// \param sweeps >= 0
/// \throws BadParameter as opencl_device_name()
/// \throws IoError when the device fails or has too little memory
///
/// Source: \cite nenu2015, equation 13 with its sign corrected, and section 4.3.
void relax_opencl(GridProblem& problem, double alpha, std::int64_t sweeps, Run const& run);

} // namespace thalweg::solver
