// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace thalweg::solver {

/// What relax_opencl runs on the device, in OpenCL C.
std::string_view relax_kernels();

} // namespace thalweg::solver
