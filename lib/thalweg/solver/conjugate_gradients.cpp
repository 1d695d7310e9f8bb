// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/conjugate_gradients.hpp>

#include <thalweg/core/elementary.hpp>
#include <thalweg/core/error.hpp>
#include <thalweg/core/parallel.hpp>
#include <thalweg/solver/v_cycle.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

std::int64_t rows_a_range(Board const& board) {
    return std::max<std::int64_t>(32, 65536 / board.half());
}

/// Sum over the rows, added in their order, of what term(row) gives. scratch: one for each range, as long as a row.
template <class Number, class Term> double sum_over_rows(Board const& board, Run const& run, Term const& term) {
    std::vector<double> parts(static_cast<std::size_t>(board.height));
    parallel_ranges(run, board.height, rows_a_range(board), [&](std::int64_t begin, std::int64_t end) {
        std::vector<Number> scratch(static_cast<std::size_t>(board.stride()));
        for (std::int64_t y = begin; y < end; ++y) {
            parts[static_cast<std::size_t>(y)] = term(y, scratch.data());
        }
    });
    double sum = 0.0;
    for (double const part : parts) {
        sum += part;
    }
    return sum;
}

/// Residual of a row of one colour. b: scratch, zeros where the problem has no right-hand side.
void residual_row(ColouredProblem const& problem, std::int64_t y, int colour, float* r, double* b,
                  GridRows const& rows) {
    Board const& board = problem.levels.board;
    if (problem.b != nullptr) {
        auto const given = problem.b->row(y);
        for (std::int64_t x = Board::first(y, colour); x < board.width; x += 2) {
            b[x / 2] = given[static_cast<std::size_t>(x)];
        }
    }
    rows.residual(r, b, problem.x.of[colour].row(y), problem.levels.degree.of[colour].row(y),
                  around(problem.x.of[1 - colour], y, colour), problem.scale, board.half());
}

class Iteration {
public:
    Iteration(ColouredProblem& problem, GridRows const& rows, Run const& run)
        : problem_(problem), rows_(rows), run_(run), board_(problem.levels.board), n_(board_.half()), r_(board_),
          z_(board_), p_(board_) {}

    /// Counts r from x. Gives its norm.
    double renew() {
        double const sum = sum_over_rows<double>(board_, run_, [&](std::int64_t y, double* b) {
            double squares = 0.0;
            for (int colour : {0, 1}) {
                float* const r = r_.of[colour].row(y);
                residual_row(problem_, y, colour, r, b, rows_);
                squares += rows_.dot(r, r, n_);
            }
            return squares;
        });
        return std::sqrt(sum);
    }

    /// One step of conjugate gradients. Gives the norm of r as it follows from the step before.
    double advance() {
        double const rz = v_cycle(problem_.levels, r_, z_, rows_, run_);
        auto const conjugate = static_cast<float>(rz_ > 0.0 ? rz / rz_ : 0.0);
        rz_ = rz;
        parallel_ranges(run_, board_.height, rows_a_range(board_), [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t y = begin; y < end; ++y) {
                for (int colour : {0, 1}) {
                    rows_.direct(p_.of[colour].row(y), z_.of[colour].row(y), conjugate, n_);
                }
            }
        });
        double const pap = sum_over_rows<float>(board_, run_, [&](std::int64_t y, float* ap) {
            double sum = 0.0;
            for (int colour : {0, 1}) {
                apply(y, colour, ap);
                sum += rows_.dot(p_.of[colour].row(y), ap, n_);
            }
            return sum;
        });
        if (!(pap > 0.0)) { // nothing is left that a float could tell from 0
            rz_ = 0.0;
            return 0.0;
        }
        double const step = rz / pap;
        double const sum = sum_over_rows<float>(board_, run_, [&](std::int64_t y, float* ap) {
            double squares = 0.0;
            for (int colour : {0, 1}) {
                apply(y, colour, ap);
                float* const r = r_.of[colour].row(y);
                rows_.step(problem_.x.of[colour].row(y), r, p_.of[colour].row(y), ap, step / problem_.scale,
                           static_cast<float>(step), n_);
                squares += rows_.dot(r, r, n_);
            }
            return squares;
        });
        return std::sqrt(sum);
    }

private:
    void apply(std::int64_t y, int colour, float* ap) const {
        rows_.apply(ap, p_.of[colour].row(y), problem_.levels.degree.of[colour].row(y),
                    around(p_.of[1 - colour], y, colour), n_);
    }

    ColouredProblem& problem_;
    GridRows const& rows_;
    Run const& run_;
    Board board_;
    std::int64_t n_;
    TwoColours<float> r_, z_, p_; ///< residual, preconditioned residual, direction; 0 where no cell is free
    double rz_ = 0.0;             ///< of the step before
};

} // namespace

double residual_norm(ColouredProblem const& problem, GridRows const& rows, Run const& run) {
    Board const& board = problem.levels.board;
    double const sum = sum_over_rows<double>(board, run, [&](std::int64_t y, double* b) {
        std::vector<float> r(static_cast<std::size_t>(board.stride()));
        double squares = 0.0;
        for (int colour : {0, 1}) {
            residual_row(problem, y, colour, r.data(), b, rows);
            squares += rows.dot(r.data(), r.data(), board.half());
        }
        return squares;
    });
    return std::sqrt(sum);
}

Convergence conjugate_gradients(ColouredProblem& problem, double zero, double goal, int most_iterations,
                                GridRows const& rows, Run const& run) {
    constexpr double lasting = 1e-3; // digits a float keeps without doubt
    Iteration iteration(problem, rows, run);
    double norm = iteration.renew();
    double counted = norm; // the last one that was counted from x
    double share = 0.0;
    int done = 0;
    for (; norm > goal; ++done) {
        if (done == most_iterations) {
            throw NotConverged(fmt::format("solver.solve_poisson: after {} iterations the residual is {:.3g} of what "
                                           "it was instead of {:.3g}; ask for less or allow more of them",
                                           done, norm / zero, goal / zero));
        }
        if (norm < zero) {
            share = std::max(share, exact::log(norm / zero) / exact::log(goal / zero));
        }
        run.at(share, "solve");
        norm = iteration.advance();
        if (norm <= goal || norm < lasting * counted) {
            double const told = norm;
            norm = iteration.renew();
            if (norm > 10.0 * std::max(told, goal) && norm > 0.5 * counted) {
                throw NotConverged(fmt::format("solver.solve_poisson: the residual stays at {:.3g} of what it was, "
                                               "where double has no more digits; a tolerance of {:.3g} is out of reach",
                                               norm / zero, goal / zero));
            }
            counted = norm;
        }
    }
    run.at(1.0, "solve");
    return {done, norm};
}

} // namespace thalweg::solver
