// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <utility>
#include <vector>

#include <thalweg/core/chance.hpp>
#include <thalweg/solver/devices.hpp>
#include <thalweg/solver/poisson.hpp>
#include <thalweg/solver/relax_opencl.hpp>

// Paper 003's diffusion and the equation that it tends to, on the OpenCL device beside the processor; items = cells,
// for the sweeps times sweeps. One cell in a hundred is fixed, at heights to 1000 m. Copies to and from the device
// count.
namespace {

using namespace thalweg;

constexpr std::int64_t sweeps = 500;

solver::GridProblem land(std::int64_t side) {
    Grid grid;
    grid.width = side;
    grid.height = side;
    solver::GridProblem problem{Raster<std::uint8_t>(grid, 1), Raster<double>(grid, 0.0), Raster<double>()};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        auto const cell = static_cast<std::uint64_t>(i);
        if (unit(chance(7, cell)) < 0.01) {
            problem.kind[i] = static_cast<std::uint8_t>(solver::CellKind::fixed);
            problem.value[i] = 1000.0 * unit(chance(8, cell));
        }
    }
    return problem;
}

/// One thread, row by row; the border keeps its numbers, so that no loop has to look for it.
void sweep_here(solver::GridProblem& problem, double alpha) {
    std::int64_t const width = problem.kind.width();
    Raster<double> next = problem.value;
    for (std::int64_t s = 0; s < sweeps; ++s) {
        for (std::int64_t row = 1; row + 1 < problem.kind.height(); ++row) {
            std::uint8_t const* const kind = problem.kind.row(row).data();
            double const* const u = problem.value.row(row).data();
            double* __restrict const to = next.row(row).data();
            for (std::int64_t col = 1; col + 1 < width; ++col) {
                double const sum = u[col - 1] + u[col + 1] + u[col - width] + u[col + width];
                double const moved = u[col] + alpha * (sum - 4.0 * u[col]);
                to[col] = kind[col] == 1 ? moved : u[col];
            }
        }
        std::swap(problem.value, next);
    }
}

void BM_relax_processor(benchmark::State& state) {
    auto problem = land(state.range(0));
    for (auto _ : state) {
        sweep_here(problem, 0.25);
        benchmark::DoNotOptimize(problem.value.values().data());
    }
    state.SetItemsProcessed(state.iterations() * problem.kind.cells() * sweeps);
}
void BM_relax_opencl(benchmark::State& state) {
    auto problem = land(state.range(0));
    state.SetLabel(solver::opencl_device_name());
    solver::relax_opencl(problem, 0.25, 1); // the kernels are compiled
    for (auto _ : state) {
        solver::relax_opencl(problem, 0.25, sweeps);
    }
    state.SetItemsProcessed(state.iterations() * problem.kind.cells() * sweeps);
}
BENCHMARK(BM_relax_processor)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_relax_opencl)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

void poisson(benchmark::State& state, Device device) {
    Run run;
    run.device = device;
    auto const problem = land(state.range(0));
    int iterations = 0;
    for (auto _ : state) {
        iterations = solver::solve_poisson(problem, {}, run).iterations;
    }
    state.counters["iterations"] = iterations;
    state.SetItemsProcessed(state.iterations() * problem.kind.cells());
}
void BM_poisson_processor(benchmark::State& state) {
    poisson(state, Device::cpu);
}
void BM_poisson_opencl(benchmark::State& state) {
    state.SetLabel(solver::opencl_device_name());
    solver::solve_poisson(land(64), {}, [] {
        Run run;
        run.device = Device::opencl;
        return run;
    }()); // the kernels are compiled
    poisson(state, Device::opencl);
}
BENCHMARK(BM_poisson_processor)->Arg(1024)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_poisson_opencl)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
