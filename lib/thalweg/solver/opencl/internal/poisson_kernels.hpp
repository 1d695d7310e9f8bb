// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::solver {

/// What solve_poisson_opencl runs on the device, in OpenCL C.
std::string_view poisson_kernels();

} // namespace thalweg::solver
