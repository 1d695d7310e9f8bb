// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/parallel.hpp>

namespace thalweg {

/// Sums term(row) over the rows [0, rows), in row order whichever thread computes a term.
/// \param run progress, log, stop token and number of threads
/// \param rows number of rows
/// \param term called with a row; its value's type has operator+=
/// \return the same bits for any number of threads
/// \throws Error what term throws
/// \throws Cancelled
template <class Term> auto sum_rows(Run const& run, std::int64_t rows, Term const& term) {
    using Sum = decltype(term(rows));
    Indexed<RowIndex, Sum> parts(rows);
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
