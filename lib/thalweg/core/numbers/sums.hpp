// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg {

/// A compensated sum (Neumaier 1974): rounding errors do not accumulate over millions of terms.
class CompensatedSum {
public:
    void add(double value) {
        double const sum = sum_ + value;
        lost_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
        sum_ = sum;
    }
    double value() const { return sum_ + lost_; }

private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

/// Sums term(row) over the rows [0, rows), in row order whichever thread computes a term.
/// \param rows number of rows
/// \param term called with a row; its value's type has operator+=
/// \return the same bits for any number of threads
/// \throws Error what term throws
template <class Term> auto sum_rows(Run const& run, std::int64_t rows, Term const& term) {
    using Sum = decltype(term(rows));
    std::vector<Sum> parts(rows);
    parallel_ranges(run, rows, 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            parts[r] = term(r);
        }
    });
    Sum sum{};
    for (Sum const& part : parts) {
        sum += part;
    }
    return sum;
}

} // namespace thalweg
