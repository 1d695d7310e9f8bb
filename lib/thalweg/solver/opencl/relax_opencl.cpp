// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <thalweg/solver/opencl/internal/device.hpp>
#include <thalweg/solver/opencl/internal/opencl.hpp>

namespace thalweg::solver {
namespace {

// Kernels of relax_opencl, in OpenCL C.
std::string_view relax_kernels() {
    return R"(
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

/* By free cell one bit for each neighbour that is not outside: west 1, east 2, north 4, south 8; other cells 0. */
kernel void find_sides(global const uchar* kind, long width, long height, long margin, global uchar* sides) {
    long const col = get_global_id(0);
    long const row = get_global_id(1);
    long const i = row * width + col;
    if (col >= width || kind[i] != 1) {
        return;
    }
    uchar open = 0;
    if (col > 0 && kind[i - 1] != 0) {
        open |= 1;
    }
    if (col + 1 < width && kind[i + 1] != 0) {
        open |= 2;
    }
    if (row > 0 && kind[i - width] != 0) {
        open |= 4;
    }
    if (row + 1 < height && kind[i + width] != 0) {
        open |= 8;
    }
    sides[margin + i] = open;
}

/* One sweep over all cells in index order; the margins keep neighbours inside the arrays. */
kernel void sweep(global const uchar* restrict sides, global const double* restrict from, double alpha, long width,
                  long margin, global double* restrict to) {
    long const i = margin + get_global_id(0);
    uchar const open = sides[i];
    double const u = from[i];
    double const west = (open & 1) ? from[i - 1] : 0.0;
    double const east = (open & 2) ? from[i + 1] : 0.0;
    double const north = (open & 4) ? from[i - width] : 0.0;
    double const south = (open & 8) ? from[i + width] : 0.0;
    double const sum = (west + east) + (north + south);
    double const count = (open & 1) + (open >> 1 & 1) + (open >> 2 & 1) + (open >> 3);
    to[i] = open ? u + alpha * (sum - count * u) : u;
}
)";
}

constexpr char const* relax_stage = "solver.relax_explicit";

/// Sweeps queued between two checks of the stop token: about a tenth of a second on slow devices.
std::int64_t batch(std::int64_t cells) {
    return std::clamp<std::int64_t>((std::int64_t{1} << 26) / cells, 1, 256);
}

} // namespace

void relax_opencl(GridProblem& problem, double alpha, std::int64_t sweeps, Run const& run) {
    Grid const& grid = problem.kind.grid();
    std::int64_t const cells = grid.cells();
    if (cells == 0 || sweeps == 0) {
        return;
    }
    DeviceQueue queue(relax_stage, relax_kernels());
    // The last group may read beyond the cells, including their neighbours.
    std::int64_t const margin = grid.width + static_cast<std::int64_t>(DeviceQueue::group);
    std::int64_t const block = (cells + 2 * margin) * static_cast<std::int64_t>(sizeof(double));
    check_device_memory(queue.device(), relax_stage, 2 * block + 2 * cells, block);

    auto sides = queue.zeros<std::uint8_t>(cells + 2 * margin);
    queue.run("find_sides", grid.width, grid.height, queue.copy_of(std::as_const(problem.kind).values()), grid.width,
              grid.height, margin, sides);
    auto now = queue.copy_of(std::as_const(problem.value).values(), margin);
    auto next = queue.zeros<double>(cells + 2 * margin);
    for (std::int64_t done = 0; done < sweeps;) {
        run.at(static_cast<double>(done) / static_cast<double>(sweeps), "diffuse");
        for (std::int64_t const end = std::min(sweeps, done + batch(cells)); done < end; ++done) {
            queue.run("sweep", cells, 1, sides, now, alpha, grid.width, margin, next);
            std::swap(now, next);
        }
        queue.finish();
    }
    run.at(1.0, "diffuse");
    queue.read(now, problem.value.values(), margin);
}

} // namespace thalweg::solver
