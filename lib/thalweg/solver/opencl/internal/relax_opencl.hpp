// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// What relax_explicit does for Device::opencl, on that device.
/// Takes: a problem whose numbers are finite but outside; alpha in (0, 1/4]; sweeps >= 0.
/// Gives: in every sweep each free cell's u + alpha ((w + e) + (n + s) - k u) of the numbers before it, where only the
/// k neighbours that are not outside count; all others keep their bits. The same bits as relax_explicit's on the
/// processor. Memory on the device: 18 bytes a cell.
/// Throws: BadParameter as opencl_device_name(); IoError when the device fails or is too small; Cancelled.
/// Source: paper 003, equation 13 with its sign mended, and section 4.3.
void relax_opencl(GridProblem& problem, double alpha, std::int64_t sweeps, Run const& run);

} // namespace thalweg::solver
