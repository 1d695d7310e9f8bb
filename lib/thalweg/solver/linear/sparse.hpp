// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace thalweg::solver {

/// A number of a sparse matrix.
struct SparseEntry {
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    double value = 0.0;
};

/// A sparse, symmetric, positive definite matrix, factored once for any number of right-hand sides.
class SparseFactor {
public:
    /// \pre size; the numbers on the diagonal and below it (column <= row); those of one place are added in order.
    /// \param size number of rows and columns
    /// \param entries numbers on and below the diagonal
    /// \throws BadInput naming an entry that is above the diagonal, outside or not finite
    /// \throws NotConverged when the matrix is not positive definite
    SparseFactor(std::size_t size, std::vector<SparseEntry> const& entries);
    SparseFactor(SparseFactor const&) = delete;
    SparseFactor& operator=(SparseFactor const&) = delete;
    SparseFactor(SparseFactor&& other) noexcept;
    SparseFactor& operator=(SparseFactor&& other) noexcept;
    ~SparseFactor();

    /// \param b the right side b
    /// \return the x of A x = b.
    /// \throws BadInput when b has another size than the matrix
    std::vector<double> solve(std::vector<double> const& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

} // namespace thalweg::solver
