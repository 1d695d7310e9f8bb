// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/internal/conjugate_gradients.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/grid/internal/v_cycle.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

/// Greatest absolute value of all cells.
template <class T> double greatest(TwoColours<T> const& of, Board const& board, Run const& run) {
    auto const parts = each_row(board, run, [&](std::int64_t y) {
        T most = 0;
        for (auto const& plane : of.of) {
            T const* const row = plane.row(y);
            for (std::int64_t k = 0; k < board.half(); ++k) {
                most = std::max(most, std::fabs(row[k]));
            }
        }
        return static_cast<double>(most);
    });
    return *std::max_element(parts.begin(), parts.end());
}

class Iteration {
public:
    Iteration(ColouredProblem& problem, std::vector<CoarseLevel>& levels, GridRows const& rows, Run const& run)
        : problem_(problem), levels_(levels), rows_(rows), run_(run), board_(problem.top.board), n_(board_.half()),
          r_(board_), z_(board_), p_(board_) {}

    /// Counts r from x. Gives its norm.
    double renew() {
        return std::sqrt(sum_of(each_row(board_, run_, [&](std::int64_t y) {
            double squares = 0.0;
            for (int colour : {0, 1}) {
                float* const r = r_.of[colour].row(y);
                residual_row(problem_, y, colour, r, rows_);
                squares += rows_.dot(r, r, n_);
            }
            return squares;
        })));
    }

    /// Makes z, what a cycle would add to x.
    void precondition() { rz_ = v_cycle(problem_.top, levels_, r_, z_, rows_, run_); }

    double greatest_correction() const { return greatest(z_, board_, run_); }

    /// Steps on along the direction that z gives. Gives the norm of r as it follows from the one before.
    double advance() {
        auto const conjugate = static_cast<float>(rz_before_ > 0.0 ? rz_ / rz_before_ : 0.0);
        rz_before_ = rz_;
        Indexed<RowIndex, Products> parts(board_.height);
        std::int64_t const chunk = rows_a_range(board_);
        std::int64_t const chunks = (board_.height + chunk - 1) / chunk;
        parallel_ranges(run_, chunks, 1, [&](std::int64_t first, std::int64_t last) {
            for (std::int64_t i = first; i < last; ++i) {
                std::int64_t const end = std::min(board_.height, (i + 1) * chunk);
                for (std::int64_t y = i * chunk; y < end; ++y) {
                    direct(y, conjugate);
                    if (y >= i * chunk + 2) {
                        parts[y - 1] = apply(y - 1);
                    }
                }
            }
        });
        // The first and last rows of chunks waited for their neighbours.
        parallel_ranges(run_, chunks, 32, [&](std::int64_t first, std::int64_t last) {
            for (std::int64_t i = first; i < last; ++i) {
                for (std::int64_t const y : {i * chunk, std::min(board_.height, (i + 1) * chunk) - 1}) {
                    parts[y] = apply(y);
                }
            }
        });
        Products all;
        for (Products const& part : parts) {
            all.pap += part.pap;
            all.rp += part.rp;
        }
        if (!(all.pap > 0.0)) { // nothing is left that a float could tell from 0
            rz_before_ = 0.0;
            return 0.0;
        }
        double const step = all.rp / all.pap;
        return std::sqrt(sum_of(each_row(board_, run_, [&](std::int64_t y) {
            double squares = 0.0;
            for (int colour : {0, 1}) {
                float* const r = r_.of[colour].row(y);
                rows_.step(problem_.x.of[colour].row(y), r, p_.of[colour].row(y), z_.of[colour].row(y),
                           step / problem_.scale, static_cast<float>(step), n_);
                squares += rows_.dot(r, r, n_);
            }
            return squares;
        })));
    }

private:
    struct Products {
        double pap = 0.0;
        double rp = 0.0; ///< r z but for what floats have lost: with it each step is downhill
    };

    void direct(std::int64_t y, float conjugate) {
        for (int colour : {0, 1}) {
            rows_.direct(p_.of[colour].row(y), z_.of[colour].row(y), conjugate, n_);
        }
    }

    /// z has served: A p takes its place.
    Products apply(std::int64_t y) {
        Products sum;
        for (int colour : {0, 1}) {
            float const* const p = p_.of[colour].row(y);
            float* const ap = z_.of[colour].row(y);
            rows_.apply(ap, p, {problem_.top.degree.of[colour].row(y)}, around(p_.of[1 - colour], y, colour), n_);
            sum.pap += rows_.dot(p, ap, n_);
            sum.rp += rows_.dot(p, r_.of[colour].row(y), n_);
        }
        return sum;
    }

    ColouredProblem& problem_;
    std::vector<CoarseLevel>& levels_;
    GridRows const& rows_;
    Run const& run_;
    Board board_;
    std::int64_t n_;
    TwoColours<float> r_, z_, p_; ///< residual, preconditioned residual, direction; 0 where no cell is free
    double rz_ = 0.0;             ///< sum of r z
    double rz_before_ = 0.0;
};

} // namespace

Convergence conjugate_gradients(ColouredProblem& problem, std::vector<CoarseLevel>& levels, double zero,
                                Goal const& goal, GridRows const& rows, Run const& run) {
    constexpr int patience = 60;     // iterations without a smaller residual
    constexpr double lasting = 1e-3; // digits a float keeps without doubt
    constexpr double unseen = 4.0;   // what a cycle may leave of an error beside what it takes
    double const wanted = goal.tolerance * zero;
    Board const& board = problem.top.board;
    Iteration iteration(problem, levels, rows, run);
    double norm = iteration.renew();
    double counted = norm; // the last one that was counted from x
    double least = norm;
    int least_at = 0;
    double size = -1.0; // of x, once it has settled
    double share = 0.0;
    for (int done = 0;; ++done) {
        iteration.precondition();
        if (norm <= wanted) {
            size = size < 0.0 ? greatest(problem.x, board, run) : size;
            if (unseen * iteration.greatest_correction() <= goal.tolerance * problem.scale * size) {
                norm = iteration.renew();
                if (norm <= wanted) {
                    run.at(1.0, "solve");
                    return {done, norm};
                }
                counted = norm;
                iteration.precondition();
            }
        }
        if (done == goal.most_iterations) {
            throw NotConverged(fmt::format("solver.solve_poisson: after {} iterations the residual is {:.3g} of what "
                                           "it was instead of {:.3g}; ask for less or allow more of them",
                                           done, norm / zero, goal.tolerance));
        }
        if (norm < zero) {
            share = std::clamp(portable::log(norm / zero) / portable::log(goal.tolerance), share, 1.0);
        }
        run.at(share, "solve");
        norm = iteration.advance();
        if (norm < 0.9 * least) {
            least = norm;
            least_at = done;
        }
        bool const stuck = done - least_at > patience;
        if (stuck || norm < lasting * counted) {
            norm = iteration.renew();
            if (stuck || norm > 0.5 * counted) { // double has no more digits
                if (norm <= wanted) {
                    return {done + 1, norm};
                }
                throw NotConverged(fmt::format("solver.solve_poisson: the residual stays at {:.3g} of what it was, "
                                               "where double has no more digits; a tolerance of {:.3g} is out of reach",
                                               norm / zero, goal.tolerance));
            }
            counted = norm;
        }
    }
}

} // namespace thalweg::solver
