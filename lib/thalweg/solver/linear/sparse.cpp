// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/sparse.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::solver {

struct SparseFactor::Factor {
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt;
    Eigen::Index size = 0;
};

SparseFactor::SparseFactor(std::size_t size, std::vector<SparseEntry> const& entries)
    : factor_(std::make_unique<Factor>()) {
    if (std::cmp_greater(size, std::numeric_limits<int>::max())) {
        throw BadInput(fmt::format("solver.sparse: a matrix of {} rows; at most 2^31 - 1", size));
    }
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (SparseEntry const& e : entries) {
        if (e.column > e.row || e.row >= size || !std::isfinite(e.value)) {
            throw BadInput(fmt::format("solver.sparse: row {}, column {} of a matrix of {} rows holds {}: numbers are "
                                       "finite and not above the diagonal",
                                       e.row, e.column, size, e.value));
        }
        triplets.emplace_back(static_cast<int>(e.row), static_cast<int>(e.column), e.value);
    }
    factor_->size = static_cast<Eigen::Index>(size);
    if (size == 0) {
        return;
    }
    Eigen::SparseMatrix<double> matrix(factor_->size, factor_->size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factor_->ldlt.compute(matrix);
    if (factor_->ldlt.info() != Eigen::Success || !(factor_->ldlt.vectorD().minCoeff() > 0.0)) {
        throw NotConverged(fmt::format("solver.sparse: the matrix of {} rows is not positive definite", size));
    }
}

SparseFactor::SparseFactor(SparseFactor&& other) noexcept = default;
SparseFactor& SparseFactor::operator=(SparseFactor&& other) noexcept = default;
SparseFactor::~SparseFactor() = default;

std::vector<double> SparseFactor::solve(std::vector<double> const& b) const {
    if (static_cast<Eigen::Index>(b.size()) != factor_->size) {
        throw BadInput(fmt::format("solver.sparse: a right-hand side of {} numbers for a matrix of {} rows", b.size(),
                                   factor_->size));
    }
    if (b.empty()) {
        return {};
    }
    Eigen::VectorXd const x = factor_->ldlt.solve(Eigen::Map<Eigen::VectorXd const>(b.data(), factor_->size));
    return {x.data(), x.data() + x.size()};
}

} // namespace thalweg::solver
