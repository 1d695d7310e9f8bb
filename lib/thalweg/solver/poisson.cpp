// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/poisson.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/solver/poisson_opencl.hpp>

#include <Eigen/SparseCholesky>

#include <array>
#include <vector>

namespace thalweg::solver {

GridSolution solve_poisson(GridProblem problem, PoissonParams const& params, Run const& run) {
    if (run.device == Device::opencl) {
        return solve_poisson_opencl(std::move(problem), params, run);
    }
    Grid const& grid = problem.kind.grid();
    std::vector<int> number(static_cast<std::size_t>(grid.cells()), -1);
    int unknowns = 0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (problem.kind[i] == static_cast<std::uint8_t>(CellKind::free)) {
            number[static_cast<std::size_t>(i)] = unknowns++;
        }
    }
    GridSolution solution;
    if (unknowns > 0) {
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            int const row = number[static_cast<std::size_t>(i)];
            if (row < 0) {
                continue;
            }
            Cell const c = grid.at(i);
            double degree = 0.0;
            right[row] = problem.source.cells() > 0 ? problem.source[i] : 0.0;
            for (Cell const n :
                 {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}}) {
                if (!grid.contains(n) || problem.kind[n] == static_cast<std::uint8_t>(CellKind::outside)) {
                    continue;
                }
                degree += 1.0;
                if (int const column = number[static_cast<std::size_t>(grid.index(n))]; column >= 0) {
                    entries.emplace_back(row, column, -1.0);
                } else {
                    right[row] += problem.value[n];
                }
            }
            entries.emplace_back(row, row, degree);
        }
        Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> const factor(matrix);
        if (factor.info() != Eigen::Success) {
            throw BadInput("solver.solve_poisson: a part of the grid has no fixed cell");
        }
        Eigen::VectorXd const x = factor.solve(right);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (int const row = number[static_cast<std::size_t>(i)]; row >= 0) {
                problem.value[i] = x[row];
            }
        }
    }
    run.check();
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
