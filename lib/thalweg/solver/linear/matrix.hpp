// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace thalweg::solver {

/// A dense matrix in column order.
struct Matrix {
    Matrix() = default;
    Matrix(std::size_t row_count, std::size_t column_count)
        : rows(row_count), columns(column_count), values(row_count * column_count, 0.0) {}

    double& at(std::size_t row, std::size_t column) { return values[column * rows + row]; }
    double at(std::size_t row, std::size_t column) const { return values[column * rows + row]; }

    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<double> values;
};

} // namespace thalweg::solver
