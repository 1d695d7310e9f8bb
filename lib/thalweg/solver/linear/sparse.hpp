// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace thalweg::solver {

/// An entry of a sparse matrix.
struct SparseEntry {
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    double value = 0.0;
};

/// The factor of a sparse, symmetric, positive definite matrix, for any number of right-hand sides.
class SparseFactor {
public:
    /// Factors a matrix.
    /// \param size number of rows
    /// \param entries on and below the diagonal (column <= row); those of one position are added in order
    /// \throws BadInput naming an entry that is above the diagonal, outside or not finite
    /// \throws NotConverged when the matrix is not positive definite
    SparseFactor(std::size_t size, std::vector<SparseEntry> const& entries);
    SparseFactor(SparseFactor const&) = delete;
    SparseFactor& operator=(SparseFactor const&) = delete;
    SparseFactor(SparseFactor&& other) noexcept;
    SparseFactor& operator=(SparseFactor&& other) noexcept;
    ~SparseFactor();

    /// Solves A x = b.
    /// \param b `size` numbers
    /// \return x
    /// \throws BadInput when b has another size than the matrix
    std::vector<double> solve(std::vector<double> const& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

} // namespace thalweg::solver
