// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/opencl/internal/relax_opencl.hpp>

#include <algorithm>
#include <utility>

#include <thalweg/solver/opencl/internal/device_queue.hpp>
#include <thalweg/solver/opencl/internal/relax_kernels.hpp>

namespace thalweg::solver {

namespace {

constexpr char const* relax_stage = "solver.relax_explicit";

/// Sweeps that are queued before the host looks whether it shall stop: about a tenth of a second on slow devices.
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
    // The last group may reach beyond the cells, and from there asks for neighbours.
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
