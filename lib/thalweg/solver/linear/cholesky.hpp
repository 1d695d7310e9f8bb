// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// The lower triangle L of a symmetric, positive definite matrix L L', in row order.
struct Cholesky {
    std::size_t size = 0;
    std::vector<double> lower;
};

/// Factors a matrix by Cholesky in O(size^3).
/// \param matrix symmetric, size x size numbers; only the lower triangle is read
/// \param size number of rows
/// \param ridge added to the diagonal, relative to its largest number
/// \param run progress, log, stop token and number of threads
/// \return the same bits for any number of threads
/// \throws NotConverged when the matrix is not positive definite
/// \throws Cancelled
Cholesky factor(std::vector<double> matrix, std::size_t size, double ridge, Run const& run = {});

/// Solves a factored system.
/// \param matrix the factor L
/// \param b right-hand side
/// \return x with L L' x = b
std::vector<double> solve(Cholesky const& matrix, std::vector<double> b);

} // namespace thalweg::solver
