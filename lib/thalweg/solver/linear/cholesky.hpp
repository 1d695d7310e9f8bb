// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg::solver {

/// The lower triangle L of a symmetric, positive definite matrix L L', row by row.
struct Cholesky {
    std::size_t size = 0;
    std::vector<double> lower;
};

/// \pre a symmetric matrix of size x size numbers, of which the lower triangle is read; ridge, which is added to the
/// diagonal as a share of its largest number.
/// \param matrix the matrix
/// \param size number of rows and columns
/// \param ridge share of the largest diagonal number that is added to the diagonal
/// \param run progress, log, stop token and number of threads
/// \return its factor, the same bits for any number of threads; O(size^3).
/// \throws NotConverged when the matrix is not positive definite
/// \throws Cancelled
Cholesky factor(std::vector<double> matrix, std::size_t size, double ridge, Run const& run = {});

/// \param matrix the matrix
/// \param b the right side b
/// \return the x of L L' x = b.
std::vector<double> solve(Cholesky const& matrix, std::vector<double> b);

} // namespace thalweg::solver
