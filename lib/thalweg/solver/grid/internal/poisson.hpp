// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// A grid coloured like a chessboard, with each colour stored separately: the cells of one colour in a row are
/// contiguous, and all neighbours of a cell have the other colour. Cell (x, y) is red (0) if x + y is even; it is the
/// x/2-th of its colour in its row. The grid has a margin of zeros.
struct Board {
    std::int64_t width = 0;
    std::int64_t height = 0;

    static constexpr std::int64_t rows_above = 2;
    static constexpr std::int64_t rows_below = 3;

    static constexpr std::int64_t lanes = 8; ///< cells of one colour computed at a time

    std::int64_t half() const { return (width + 1) / 2; } ///< cells of one colour in a row; the last may lie beyond it
    /// Distance between rows: whole lanes, and at least one zero after them.
    std::int64_t stride() const { return ((half() + lanes - 1) / lanes * lanes + 16) / 16 * 16; }
    Board coarser() const { return {half(), (height + 1) / 2}; }
    /// Column of the first cell of a colour in a row.
    static std::int64_t first(std::int64_t row, std::int64_t colour) { return (row + colour) & 1; }
};

/// Smallest number of rows worth a thread.
inline std::int64_t rows_a_range(Board const& board) {
    return std::max<std::int64_t>(32, 65536 / board.half());
}

/// Values of the cells of one colour. Rows run from -rows_above to height + rows_below - 1, indices in a row from -1 to
/// half().
template <class T> class Plane {
public:
    Plane() = default;
    explicit Plane(Board const& board)
        : stride_(board.stride()),
          values_(static_cast<std::size_t>(lead + (Board::rows_above + board.height + Board::rows_below) * stride_ +
                                           lead)) {}
    T* row(std::int64_t y) { return values_.data() + lead + (y + Board::rows_above) * stride_; }
    T const* row(std::int64_t y) const { return values_.data() + lead + (y + Board::rows_above) * stride_; }

private:
    static constexpr std::int64_t lead = 16;
    std::int64_t stride_ = 0;
    std::vector<T, LargePages<T>> values_;
};

template <class T> struct TwoColours {
    TwoColours() = default;
    explicit TwoColours(Board const& board) : of{Plane<T>(board), Plane<T>(board)} {}
    Plane<T> of[2]; ///< red, black
};

/// Neighbouring rows of the other colour, offset so that [k] is the neighbour of a row's k-th cell.
template <class T> struct Around {
    T const* above = nullptr;
    T const* left = nullptr;
    T const* right = nullptr;
    T const* below = nullptr;
};

/// Neighbours of the cells of a colour in a row; other: the plane of the other colour.
template <class T> Around<T> around(Plane<T> const& other, std::int64_t row, std::int64_t colour) {
    std::int64_t const shift = Board::first(row, colour);
    return {other.row(row - 1), other.row(row) + shift - 1, other.row(row) + shift, other.row(row + 1)};
}

// The inner loops of cycle, conjugate_gradients and relax_explicit: one colour of one row. n: cells of that colour in
// the row; floats up to the next multiple of Board::lanes are also written, as 0.

/// Equations of a row of the finest level: weights 1.
struct TopRow {
    std::uint8_t const* degree = nullptr;
};

/// Equations of a row of a coarser level.
struct CoarseRow {
    float const* inverse = nullptr;
    Around<float> weight;
};

/// Loops over equations of one kind. sum: of the neighbours' e times the weights of their edges.
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
    /// Sum of a[k] b[k]; both are zero from n to the next multiple of 16. The order of summation is the same for all
    /// lanes.
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

/// A coarser grid: each cell represents 2 x 2 of the finer one, its equations are the sums of theirs (Galerkin), with
/// weaker edges.
struct CoarseLevel {
    Board board;
    TwoColours<float> r;       ///< right-hand side
    TwoColours<float> e;       ///< solution
    Plane<float> former;       ///< of red cells, while the next one is computed
    TwoColours<float> inverse; ///< 1 / diagonal; 0 without free cells
    /// Weights of the edges from each red cell; black cells share them.
    Plane<float> above, left, right, below;
};

/// The grid itself.
struct TopLevel {
    Board board;
    TwoColours<std::uint8_t> degree; ///< of free cells: neighbours that are not outside; 0: not free
};

/// Prepares the finest level.
/// \param kind CellKind by cell
TopLevel top_level(Raster<std::uint8_t> const& kind, Run const& run);

/// Builds multigrid's coarser levels, the finest first, the last of one cell.
/// \param kind at least two cells
std::vector<CoarseLevel> coarse_levels(Raster<std::uint8_t> const& kind, Run const& run);

// Shared by solve_poisson and relax_explicit: checks a GridProblem and reorders it by colour.

/// Statistics of a problem's cells.
struct Contents {
    std::int64_t free = 0;
    std::int64_t fixed = 0;
    std::int64_t outside = 0;
    std::int64_t bad = std::numeric_limits<std::int64_t>::max(); ///< first unusable cell
    std::int64_t guesses = 0;                                    ///< free cells with an initial guess other than 0
    std::int64_t unknown = 0;                                    ///< free cells without a finite value
    double least = std::numeric_limits<double>::infinity();      ///< least value of fixed cells
    double greatest = -std::numeric_limits<double>::infinity();
    double sum = 0.0;
    double size = 0.0; ///< greatest |value| of fixed cells, |source| of free ones

    Contents& operator+=(Contents const& o) {
        free += o.free;
        fixed += o.fixed;
        outside += o.outside;
        bad = std::min(bad, o.bad);
        guesses += o.guesses;
        unknown += o.unknown;
        least = std::min(least, o.least);
        greatest = std::max(greatest, o.greatest);
        sum += o.sum;
        size = std::max(size, o.size);
        return *this;
    }
};

/// Checks a problem.
/// \param stage "module.verb" for messages
/// \throws BadInput naming a cell: a part with free cells and no fixed one, or a value or source that is not finite;
/// rasters of different frames
Contents survey_problem(GridProblem const& problem, char const* stage, Run const& run);

/// A problem in colour order.
struct ColouredProblem {
    TopLevel top;
    TwoColours<double> x;              ///< free and fixed cells: their values; 0 outside
    Raster<double> const* b = nullptr; ///< of free cells; null for Laplace's equation
    double scale = 1.0;                ///< power of two that brings floats near 1
};

/// Reorders a problem. It refers to the problem's source.
/// \return free cells are 0
ColouredProblem coloured(GridProblem const& problem, Contents const& contents, Run const& run);

/// Sets the free cells of x, which are 0, to their initial guess, or without one to the mean of the fixed cells.
void set_guess(GridProblem const& problem, Contents const& contents, ColouredProblem& coloured, Run const& run);

/// Copies x into the problem's free cells; for Laplace's equation clamped between the least and the greatest value of
/// `contents`. Where the problem's values were released, as they may be without outside cells, the fixed ones come from
/// x too.
void collect(ColouredProblem const& coloured, Contents const& contents, GridProblem& problem, Run const& run);

/// Calls term(row) for each row of a board.
/// \return the results, by row
template <class Part = double, class Term>
std::vector<Part> each_row(Board const& board, Run const& run, Term const& term) {
    std::vector<Part> parts(board.height);
    parallel_ranges(run, board.height, rows_a_range(board), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            parts[y] = term(y);
        }
    });
    return parts;
}

/// Sums in row order.
double sum_of(std::vector<double> const& parts);

/// Computes the residual of a row of one colour, times scale; r: as long as the stride.
void residual_row(ColouredProblem const& problem, std::int64_t y, int colour, float* r, GridRows const& rows);

/// Computes the norm of the problem's residual times scale, in double from x.
double residual_norm(ColouredProblem const& problem, GridRows const& rows, Run const& run);

struct Goal {
    double tolerance = 0.0; ///< of the residual's norm, and of the values' error estimated by a cycle
    int most_iterations = 0;
};

struct Convergence {
    int iterations = 0;
    double residual = 0.0; ///< norm reached, in units of scale
};

/// Improves x until the norm of the residual is at most tolerance * zero, and four times the largest correction of
/// another cycle is at most tolerance times the largest value: conjugate gradients preconditioned by cycle. x is
/// stored in double, everything else in float; the residual is recomputed from x after each reduction by a factor of
/// 1000 and before returning, so that float rounding does not limit the accuracy.
/// \param levels of the problem
/// \param zero norm of the residual with 0 in the free cells
/// \throws NotConverged after most_iterations, or at the limit of double precision
Convergence conjugate_gradients(ColouredProblem& problem, std::vector<CoarseLevel>& levels, double zero,
                                Goal const& goal, GridRows const& rows, Run const& run);

} // namespace thalweg::solver
