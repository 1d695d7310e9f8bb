// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/solver/grid/poisson.hpp>
#include <thalweg/solver/opencl/devices.hpp>

// Paper 003's diffusion and the equation that it tends to, on the OpenCL device beside the processor; items = cells,
// for the sweeps times sweeps. One cell in a hundred is fixed, at heights to 1000 m. Copies to and from the device
// count.
namespace {

using namespace thalweg;

constexpr int sweeps = 500;

solver::GridProblem land(std::int64_t side) {
    Grid grid;
    grid.width = side;
    grid.height = side;
    solver::GridProblem problem{Raster<std::uint8_t>(grid, 1), Raster<double>(grid, 0.0), Raster<double>()};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        auto const cell = static_cast<std::uint64_t>(i);
        if (unit(random_word(7, cell)) < 0.01) {
            problem.kind[i] = static_cast<std::uint8_t>(solver::CellKind::fixed);
            problem.value[i] = 1000.0 * unit(random_word(8, cell));
        }
    }
    return problem;
}

Run on(Device device) {
    Run run;
    run.device = device;
    return run;
}

void relax(benchmark::State& state, Device device) {
    auto const problem = land(state.range(0));
    solver::ExplicitParams params{.sweeps = 1};
    solver::relax_explicit(problem, params, on(device)); // the kernels are compiled
    params.sweeps = sweeps;
    for (auto _ : state) {
        benchmark::DoNotOptimize(solver::relax_explicit(problem, params, on(device)).residual);
    }
    state.SetItemsProcessed(state.iterations() * problem.kind.cells() * sweeps);
}
void BM_relax_processor(benchmark::State& state) {
    relax(state, Device::cpu);
}
void BM_relax_opencl(benchmark::State& state) {
    state.SetLabel(solver::opencl_device_name());
    relax(state, Device::opencl);
}
BENCHMARK(BM_relax_processor)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_relax_opencl)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

void poisson(benchmark::State& state, Device device) {
    auto const problem = land(state.range(0));
    int iterations = solver::solve_poisson(problem, {.tolerance = 0.1}, on(device)).iterations;
    for (auto _ : state) {
        iterations = solver::solve_poisson(problem, {}, on(device)).iterations;
    }
    state.counters["iterations"] = iterations;
    state.SetItemsProcessed(state.iterations() * problem.kind.cells());
}
void BM_poisson_processor(benchmark::State& state) {
    poisson(state, Device::cpu);
}
void BM_poisson_opencl(benchmark::State& state) {
    state.SetLabel(solver::opencl_device_name());
    poisson(state, Device::opencl);
}
BENCHMARK(BM_poisson_processor)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_poisson_opencl)->Arg(1024)->Arg(2048)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
