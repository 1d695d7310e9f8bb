// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>

namespace thalweg::solver {

// Not Eigen's: its products cut matrices by the size of the processor's caches, and so sum in another order elsewhere.
Cholesky factor(std::vector<double> matrix, std::size_t size, double ridge, Run const& run) {
    double largest = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        largest = std::max(largest, matrix[i * size + i]);
    }
    for (std::size_t i = 0; i < size; ++i) {
        matrix[i * size + i] += ridge * largest;
    }
    std::vector<double> column(size);
    for (std::size_t k = 0; k < size; ++k) {
        run.check();
        double const pivot = matrix[k * size + k];
        if (!(pivot > 0.0)) {
            throw NotConverged(
                fmt::format("solver.factor: the matrix of {0} x {0} numbers is not positive definite: pivot {1} "
                            "is {2}; are two of its rows alike?",
                            size, k, pivot));
        }
        double const root = std::sqrt(pivot);
        matrix[k * size + k] = root;
        for (std::size_t i = k + 1; i < size; ++i) {
            matrix[i * size + k] /= root;
            column[i] = matrix[i * size + k];
        }
        // Each number is reduced by one product at a time, in the order of k, whatever thread it falls to.
        parallel_ranges(run, static_cast<std::int64_t>(size - k - 1), 128, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t r = begin; r < end; ++r) {
                std::size_t const i = k + 1 + static_cast<std::size_t>(r);
                double* const row = &matrix[i * size];
                double const times = column[i];
                for (std::size_t j = k + 1; j <= i; ++j) {
                    row[j] -= times * column[j];
                }
            }
        });
    }
    return {size, std::move(matrix)};
}

std::vector<double> solve(Cholesky const& matrix, std::vector<double> b) {
    std::size_t const n = matrix.size;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            b[i] -= matrix.lower[i * n + j] * b[j];
        }
        b[i] /= matrix.lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        b[i] /= matrix.lower[i * n + i];
        for (std::size_t j = 0; j < i; ++j) {
            b[j] -= matrix.lower[i * n + j] * b[i];
        }
    }
    return b;
}

} // namespace thalweg::solver
