// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled instead of the three files that call OpenCL where it is not installed.
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/opencl/devices.hpp>
#include <thalweg/solver/opencl/internal/opencl.hpp>

namespace thalweg::solver {
namespace {

[[noreturn]] void refuse_opencl() {
    throw BadParameter("solver.opencl_device",
                       "--device opencl: this thalweg was built without OpenCL; install ocl-icd-opencl-dev and "
                       "opencl-headers and build again, or leave --device out");
}

} // namespace

std::vector<std::string> opencl_devices() {
    return {};
}

std::string opencl_device_name() {
    refuse_opencl();
}

GridSolution solve_poisson_opencl(GridProblem, Contents const&, PoissonParams const&, Run const&) {
    refuse_opencl();
}

void relax_opencl(GridProblem&, double, std::int64_t, Run const&) {
    refuse_opencl();
}

} // namespace thalweg::solver
