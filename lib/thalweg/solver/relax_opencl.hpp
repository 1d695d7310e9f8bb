// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run.hpp>
#include <thalweg/solver/poisson.hpp>

namespace thalweg::solver {

/// Diffuses the free cells of a grid by explicit sweeps on the OpenCL device.
/// Takes: a problem whose rasters are of one size; alpha (0, 1/4], the share of a difference that flows in a sweep;
/// sweeps >= 0. Its source is not used.
/// Gives: in every sweep each free cell's u + alpha (w + e + n + s - k u) of the numbers before it, where only the k
/// neighbours that are not outside count, added in this order; all others keep their bits. The same bits as the
/// same sums on the CPU. Throws: BadInput when the sizes differ; BadParameter, also as opencl_device_name(); IoError
/// when the device fails or is too small; Cancelled. Source: paper 003, equations 12 and 13, section 4.3.
void relax_opencl(GridProblem& problem, double alpha, std::int64_t sweeps, Run const& run = {});

} // namespace thalweg::solver
