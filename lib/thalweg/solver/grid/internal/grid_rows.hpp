// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/lanes.hpp>
#include <thalweg/solver/grid/internal/two_colours.hpp>

/// The inner loops of v_cycle, conjugate_gradients and relax_explicit: one colour of one row. n: cells of that colour
/// in the row; of floats those up to the next multiple of Board::lanes are written too, as 0.
namespace thalweg::solver {

/// Equations of a row of the finest level: weights 1.
struct TopRow {
    std::uint8_t const* degree = nullptr;
};

/// Equations of a row of a coarser level.
struct CoarseRow {
    float const* inverse = nullptr;
    Around<float> weight;
};

/// Loops over equations of one kind. sum: of the neighbours' e, each times its edge's weight.
template <class Row> struct SmoothingRows {
    /// e = r / diagonal
    void (*first)(float* e, float const* r, Row const& row, std::int64_t n);
    /// e = (r + sum) / diagonal
    void (*relax)(float* e, float const* r, Row const& row, Around<float> const& others, std::int64_t n);
    /// rest = sum; 0 where the cell is not free
    void (*rest)(float* rest, Row const& row, Around<float> const& others, std::int64_t n);
    /// e = r / diagonal + correction; 0 where the cell is not free
    void (*corrected)(float* e, float const* r, Row const& row, float const* correction, std::int64_t n);
};

struct GridRows {
    SmoothingRows<TopRow> top;
    SmoothingRows<CoarseRow> coarse;
    /// to[2 k] = times * even[k], to[2 k + 1] = times * odd[k]
    void (*merge)(float* to, float const* even, float const* odd, float times, std::int64_t n);
    /// even[k] = a[2 k] + b[2 k], odd[k] = a[2 k + 1] + b[2 k + 1]; a and b hold 2 n numbers
    void (*split_sum)(float* even, float* odd, float const* a, float const* b, std::int64_t n);
    /// Sum of a[k] b[k]; both are zero from n to the next multiple of 16. One order of adding whatever the lanes.
    double (*dot)(float const* a, float const* b, std::int64_t n);
    /// p = z + times * p
    void (*direct)(float* p, float const* z, float times, std::int64_t n);
    /// ap = degree * p - sum of the neighbours; 0 where the cell is not free
    void (*apply)(float* ap, float const* p, TopRow const& row, Around<float> const& others, std::int64_t n);
    /// x += x_step * p, r -= r_step * ap
    void (*step)(double* x, float* r, float const* p, float const* ap, double x_step, float r_step, std::int64_t n);
    /// r = scale * (b + sum of the neighbours - degree * x); 0 where the cell is not free
    void (*residual)(float* r, double const* b, double const* x, TopRow const& row, Around<double> const& others,
                     double scale, std::int64_t n);
    /// to = x + alpha * (sum of the neighbours - degree * x); x where the cell is not free
    void (*diffuse)(double* to, double const* x, TopRow const& row, Around<double> const& others, double alpha,
                    std::int64_t n);
};

GridRows const& grid_rows(Lanes lanes);

} // namespace thalweg::solver
