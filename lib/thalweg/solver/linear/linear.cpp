// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/linear.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::solver {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double ridge_share = 1e-10;

MatrixXd matrix_of(Matrix const& a) {
    return Eigen::Map<MatrixXd const>(a.values.data(), static_cast<Index>(a.rows), static_cast<Index>(a.columns));
}

void require(Matrix const& a, std::vector<double> const& b) {
    refuse_if<BadInput>(a.rows != b.size() || a.columns == 0 || a.values.size() != a.rows * a.columns,
                        "solver.least_squares", "{} x {} matrix with {} values for {} right sides", a.rows, a.columns,
                        a.values.size(), b.size());
    auto const finite = [](double v) { return std::isfinite(v); };
    refuse_if<BadInput>(!std::all_of(a.values.begin(), a.values.end(), finite) ||
                            !std::all_of(b.begin(), b.end(), finite),
                        "solver.least_squares", "matrix or right side holds a value that is not a number");
}

Solution finished(MatrixXd const& a, VectorXd const& b, VectorXd const& x, Index rank) {
    double const squares = (a * x - b).squaredNorm();
    return {{x.begin(), x.end()},
            static_cast<std::size_t>(rank),
            a.rows() > 0 ? std::sqrt(squares / static_cast<double>(a.rows())) : 0.0};
}

/// Finds y of length tau that minimises y' S y - 2 g' y, S symmetric.
VectorXd least_on_sphere(MatrixXd const& s, VectorXd const& g, double tau) {
    Eigen::SelfAdjointEigenSolver<MatrixXd> const eigen(s);
    VectorXd const& w = eigen.eigenvalues(); // ascending
    VectorXd const h = eigen.eigenvectors().transpose() * g;
    double const size = std::max(std::fabs(w[0]), std::fabs(w[w.size() - 1])) + g.norm() / tau;
    auto const length = [&](double lambda) { return (h.array() / (w.array() + lambda)).matrix().norm(); };
    // lambda = -w_min + gap. At the largest gap the vector is shorter than tau.
    double low = 0.0;
    double high = h.norm() / tau * (1.0 + 1e-9) + size * 1e-15;
    double const tiny = size * 1e-14;
    VectorXd y;
    if (length(-w[0] + tiny) < tau) {
        // The hard case: even next to the pole the vector is too short.
        VectorXd part = VectorXd::Zero(w.size());
        for (Index i = 0; i < w.size(); ++i) {
            part[i] = w[i] - w[0] > tiny ? h[i] / (w[i] - w[0]) : 0.0;
        }
        double const missing = tau * tau - part.squaredNorm();
        part[0] += (h[0] < 0.0 ? -1.0 : 1.0) * std::sqrt(std::max(0.0, missing));
        y = eigen.eigenvectors() * part;
    } else {
        for (int step = 0; step < 2000 && high - low > 1e-16 * high; ++step) {
            double const middle = low + 0.5 * (high - low);
            (length(-w[0] + middle) > tau ? low : high) = middle;
        }
        y = eigen.eigenvectors() * (h.array() / (w.array() - w[0] + high)).matrix();
    }
    return y * (tau / y.norm()); // removes rounding
}

/// The columns outside the constraint, in order.
std::vector<Index> unbound_columns(std::size_t columns, std::vector<std::size_t> const& unknowns) {
    std::vector<bool> bound(columns, false);
    for (std::size_t const column : unknowns) {
        refuse_if<BadParameter>(column >= columns || bound[column], "solver.least_squares_on_sphere", "column {} of {}",
                                column, columns);
        bound[column] = true;
    }
    std::vector<Index> others;
    for (std::size_t c = 0; c < columns; ++c) {
        if (!bound[c]) {
            others.push_back(static_cast<Index>(c));
        }
    }
    return others;
}

} // namespace

Solution least_squares(Matrix const& a, std::vector<double> const& b) {
    require(a, b);
    MatrixXd const m = matrix_of(a);
    VectorXd const right = Eigen::Map<VectorXd const>(b.data(), static_cast<Index>(b.size()));
    Eigen::ColPivHouseholderQR<MatrixXd> const qr(m);
    if (qr.rank() == m.cols()) {
        return finished(m, right, qr.solve(right), qr.rank());
    }
    double const largest = m.colwise().squaredNorm().maxCoeff();
    double const ridge = std::sqrt(ridge_share * (largest > 0.0 ? largest : 1.0));
    MatrixXd stacked(m.rows() + m.cols(), m.cols());
    stacked << m, ridge * MatrixXd::Identity(m.cols(), m.cols());
    VectorXd wanted = VectorXd::Zero(stacked.rows());
    wanted.head(m.rows()) = right;
    return finished(m, right, Eigen::ColPivHouseholderQR<MatrixXd>(stacked).solve(wanted), qr.rank());
}

Solution least_squares_on_sphere(Matrix const& a, std::vector<double> const& b, Sphere const& sphere) {
    require(a, b);
    auto const p = static_cast<Index>(sphere.unknowns.size());
    refuse_if<BadParameter>(!(sphere.tau > 0.0) || p == 0 || sphere.form.rows != sphere.unknowns.size() ||
                                sphere.form.columns != sphere.unknowns.size(),
                            "solver.least_squares_on_sphere", "{} unknowns with a {} x {} form and tau {}", p,
                            sphere.form.rows, sphere.form.columns, sphere.tau);
    MatrixXd const all = matrix_of(a);
    VectorXd const right = Eigen::Map<VectorXd const>(b.data(), static_cast<Index>(b.size()));
    std::vector<Index> const others = unbound_columns(a.columns, sphere.unknowns);
    MatrixXd with(all.rows(), p);
    for (Index i = 0; std::size_t const column : sphere.unknowns) {
        with.col(i++) = all.col(static_cast<Index>(column));
    }
    MatrixXd const free = all(Eigen::all, others);
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    MatrixXd rest = with; // the part that the free unknowns cannot explain
    VectorXd rest_right = right;
    if (!others.empty()) {
        qr.compute(free);
        if (qr.rank() < free.cols()) {
            throw BadInput("solver.least_squares_on_sphere",
                           fmt::format("the {} free columns have rank {}", free.cols(), qr.rank()));
        }
        MatrixXd const explained = qr.solve(with);
        rest -= free.lazyProduct(explained);
        rest_right -= free * qr.solve(right);
    }
    Eigen::LLT<MatrixXd> const form(matrix_of(sphere.form));
    refuse_if<BadParameter>(form.info() != Eigen::Success, "solver.least_squares_on_sphere",
                            "the form is not positive definite");
    // With u = L' y the condition is |u| = tau.
    auto const l = form.matrixL();
    // Lazy products: the block sizes of Eigen's other products depend on the processor's caches, and so does their
    // order of summation.
    MatrixXd const gram = rest.transpose().lazyProduct(rest);
    MatrixXd const half = l.solve(gram);
    MatrixXd s = l.solve(half.transpose());
    s = 0.5 * (s + s.transpose().eval());
    VectorXd const pull = rest.transpose().lazyProduct(rest_right);
    VectorXd const u = least_on_sphere(s, l.solve(pull), sphere.tau);
    VectorXd const y = l.transpose().solve(u);
    VectorXd x(all.cols());
    for (Index i = 0; std::size_t const column : sphere.unknowns) {
        x[static_cast<Index>(column)] = y[i++];
    }
    if (!others.empty()) {
        VectorXd const z = qr.solve(right - with * y);
        for (std::size_t k = 0; k < others.size(); ++k) {
            x[others[k]] = z[static_cast<Index>(k)];
        }
    }
    return finished(all, right, x, Eigen::ColPivHouseholderQR<MatrixXd>(all).rank());
}

// Not Eigen's: it blocks matrices by the size of the processor's caches, which changes the order of summation between
// machines.
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
        refuse_if<NotConverged>(
            !(pivot > 0.0), "solver.factor",
            "the matrix of {0} x {0} numbers is not positive definite: pivot {1} is {2}; are two of its rows alike?",
            size, k, pivot);
        double const root = std::sqrt(pivot);
        matrix[k * size + k] = root;
        for (std::size_t i = k + 1; i < size; ++i) {
            matrix[i * size + k] /= root;
            column[i] = matrix[i * size + k];
        }
        // Each number is reduced by one product at a time, in the order of k, on any thread.
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

struct SparseFactor::Factor {
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt;
    Eigen::Index size = 0;
};

SparseFactor::SparseFactor(std::size_t size, std::vector<SparseEntry> const& entries)
    : factor_(std::make_unique<Factor>()) {
    refuse_if<BadInput>(std::cmp_greater(size, std::numeric_limits<int>::max()), "solver.SparseFactor",
                        "a matrix of {} rows; at most 2^31 - 1", size);
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (SparseEntry const& e : entries) {
        refuse_if<BadInput>(
            e.column > e.row || e.row >= size || !std::isfinite(e.value), "solver.SparseFactor",
            "row {}, column {} of a matrix of {} rows holds {}: numbers are finite and not above the diagonal", e.row,
            e.column, size, e.value);
        triplets.emplace_back(static_cast<int>(e.row), static_cast<int>(e.column), e.value);
    }
    factor_->size = static_cast<Eigen::Index>(size);
    if (size == 0) {
        return;
    }
    Eigen::SparseMatrix<double> matrix(factor_->size, factor_->size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factor_->ldlt.compute(matrix);
    refuse_if<NotConverged>(factor_->ldlt.info() != Eigen::Success || !(factor_->ldlt.vectorD().minCoeff() > 0.0),
                            "solver.SparseFactor", "the matrix of {} rows is not positive definite", size);
}

SparseFactor::SparseFactor(SparseFactor&& other) noexcept = default;
SparseFactor& SparseFactor::operator=(SparseFactor&& other) noexcept = default;
SparseFactor::~SparseFactor() = default;

std::vector<double> SparseFactor::solve(std::vector<double> const& b) const {
    refuse_if<BadInput>(static_cast<Eigen::Index>(b.size()) != factor_->size, "solver.SparseFactor",
                        "a right-hand side of {} numbers for a matrix of {} rows", b.size(), factor_->size);
    if (b.empty()) {
        return {};
    }
    Eigen::VectorXd const x = factor_->ldlt.solve(Eigen::Map<Eigen::VectorXd const>(b.data(), factor_->size));
    return {x.data(), x.data() + x.size()};
}

} // namespace thalweg::solver
