// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laplace's equation on a grid with lines of fixed cells, to 1e-6: our solver, two of Eigen's on the very same problem,
// and memcpy of a float grid. One thread. Memory counts, first touch included: ours from the problem to the solution,
// Eigen's from the assembled matrix to the vector. max_error_m: against our solution to 1e-12.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <benchmark/benchmark.h>
#include <solver/winding_lines.hpp>

#include <thalweg/solver/grid/poisson.hpp>

namespace {

using namespace thalweg;
using namespace thalweg::solver;
using Matrix = Eigen::SparseMatrix<double>;

Run one_thread() {
    Run run;
    run.threads = 1;
    return run;
}

struct Case {
    GridProblem problem;
    Raster<double> exact;
};

Case const& case_of(std::int64_t side) {
    static Case made;
    if (made.problem.kind.width() != side) {
        made.problem = test::winding_lines(side, 0.035);
        made.exact = solve_poisson(made.problem, {1e-12, 200}, one_thread()).value;
    }
    return made;
}

/// The matrix of the free cells, numbered row by row.
struct Assembled {
    std::vector<std::int64_t> cells;
    Matrix matrix;
    Eigen::VectorXd right;
};

Assembled assembled(GridProblem const& problem) {
    Grid const& grid = problem.kind.grid();
    Assembled made;
    std::vector<int> number(static_cast<std::size_t>(grid.cells()), -1);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (problem.kind[i] != fixed_cell) {
            number[static_cast<std::size_t>(i)] = static_cast<int>(made.cells.size());
            made.cells.push_back(i);
        }
    }
    auto const n = static_cast<int>(made.cells.size());
    std::vector<Eigen::Triplet<double>> entries;
    made.right = Eigen::VectorXd::Zero(n);
    for (int row = 0; row < n; ++row) {
        Cell const c = grid.at(made.cells[static_cast<std::size_t>(row)]);
        double degree = 0.0;
        for (Cell const near : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
            if (grid.contains(near)) {
                degree += 1.0;
                if (problem.kind[near] == fixed_cell) {
                    made.right[row] += problem.value[near];
                } else {
                    entries.emplace_back(row, number[static_cast<std::size_t>(grid.index(near))], -1.0);
                }
            }
        }
        entries.emplace_back(row, row, degree);
    }
    made.matrix.resize(n, n);
    made.matrix.setFromTriplets(entries.begin(), entries.end());
    return made;
}

void count(benchmark::State& state, std::int64_t side) {
    std::int64_t const cells = state.iterations() * side * side;
    state.SetItemsProcessed(cells);
    state.counters["ns_per_cell"] = benchmark::Counter(static_cast<double>(cells) * 1e-9,
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void count_error(benchmark::State& state, Case const& of, Assembled const& system, Eigen::VectorXd const& x) {
    double most = 0.0;
    for (std::size_t i = 0; i < system.cells.size(); ++i) {
        most = std::max(most, std::fabs(x[static_cast<Eigen::Index>(i)] - of.exact[system.cells[i]]));
    }
    state.counters["max_error_m"] = most;
}

void BM_laplace_memcpy(benchmark::State& state) {
    Grid const grid{state.range(0), state.range(0), 1.0, 0.0, 0.0, ""};
    Raster<float> const from(grid, 1.0F);
    Raster<float> to(grid);
    for (auto _ : state) {
        std::memcpy(to.values().data(), from.values().data(), to.values().size_bytes());
        benchmark::ClobberMemory();
    }
    count(state, state.range(0));
}

void BM_laplace(benchmark::State& state) {
    Case const& of = case_of(state.range(0));
    GridSolution solution;
    for (auto _ : state) {
        state.PauseTiming();
        GridProblem problem = of.problem;
        state.ResumeTiming();
        solution = solve_poisson(std::move(problem), {1e-6, 200}, one_thread());
    }
    double most = 0.0;
    for (std::int64_t i = 0; i < of.exact.cells(); ++i) {
        most = std::max(most, std::fabs(solution.value[i] - of.exact[i]));
    }
    state.counters["max_error_m"] = most;
    state.counters["solver_iterations"] = solution.iterations;
    count(state, state.range(0));
}

void BM_laplace_eigen_ldlt(benchmark::State& state) {
    Case const& of = case_of(state.range(0));
    Assembled const system = assembled(of.problem);
    Eigen::VectorXd x;
    for (auto _ : state) {
        Eigen::SimplicialLDLT<Matrix> const factor(system.matrix);
        x = factor.solve(system.right);
    }
    count_error(state, of, system, x);
    count(state, state.range(0));
}

void BM_laplace_eigen_iccg(benchmark::State& state) {
    Case const& of = case_of(state.range(0));
    Assembled const system = assembled(of.problem);
    Eigen::VectorXd x;
    for (auto _ : state) {
        Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper,
                                 Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>>
            iteration;
        iteration.setTolerance(1e-6);
        iteration.compute(system.matrix);
        x = iteration.solve(system.right);
        state.counters["solver_iterations"] = static_cast<double>(iteration.iterations());
    }
    count_error(state, of, system, x);
    count(state, state.range(0));
}

BENCHMARK(BM_laplace_memcpy)->Arg(2048)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_laplace)->RangeMultiplier(2)->Range(512, 8192)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_laplace_eigen_ldlt)->Arg(2048)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_laplace_eigen_iccg)->Arg(2048)->Unit(benchmark::kMillisecond);

} // namespace
