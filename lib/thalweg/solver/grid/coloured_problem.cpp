// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/internal/coloured_problem.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/grid/unreached.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

Contents contents(GridProblem const& problem, Run const& run) {
    bool const laplace = problem.source.cells() == 0;
    std::int64_t const width = problem.kind.width();
    return sum_rows(run, problem.kind.height(), [&](std::int64_t row) {
        Contents c;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            double const value = problem.value[i];
            if (problem.kind[i] == fixed_cell) {
                ++c.fixed;
                c.least = std::min(c.least, value);
                c.greatest = std::max(c.greatest, value);
                c.sum += value;
                c.size = std::max(c.size, std::fabs(value));
                c.bad = std::isfinite(value) ? c.bad : std::min(c.bad, i);
            } else if (problem.kind[i] == free_cell) {
                ++c.free;
                c.guesses += value != 0.0 ? 1 : 0;
                c.unknown += std::isfinite(value) ? 0 : 1;
                if (!laplace) {
                    c.size = std::max(c.size, std::fabs(problem.source[i]));
                    c.bad = std::isfinite(problem.source[i]) ? c.bad : std::min(c.bad, i);
                }
            } else {
                ++c.outside;
                c.bad = problem.kind[i] == outside_cell ? c.bad : std::min(c.bad, i);
            }
        }
        return c;
    });
}

void demand_one_frame(GridProblem const& problem, char const* stage) {
    Grid const& grid = problem.kind.grid();
    auto const fits = [&](Grid const& other) { return other.width == grid.width && other.height == grid.height; };
    if (!fits(problem.value.grid()) || (problem.source.cells() > 0 && !fits(problem.source.grid()))) {
        throw BadInput(fmt::format("{}: kinds of {} x {} cells, values of {} x {}, a source of {} x {}; the three must "
                                   "have one frame",
                                   stage, grid.width, grid.height, problem.value.width(), problem.value.height(),
                                   problem.source.width(), problem.source.height()));
    }
}

void demand_solvable(GridProblem const& problem, Contents const& all, char const* stage, Run const& run) {
    Grid const& grid = problem.kind.grid();
    if (all.bad < grid.cells()) {
        Cell const c = grid.at(all.bad);
        throw BadInput(fmt::format("{}: the cell at column {}, row {} has the kind {}, the value {} "
                                   "and the source {}; a fixed cell needs a finite value, a free one a finite source",
                                   stage, c.col, c.row, problem.kind[c], problem.value[c],
                                   problem.source.cells() > 0 ? problem.source[c] : 0.0));
    }
    if (all.free > 0 && (all.fixed == 0 || all.outside > 0)) {
        if (auto const lost = unreached(problem.kind, run); !lost.empty()) {
            throw BadInput(fmt::format("{}: no path leads from the free cell at column {}, row {} to "
                                       "a fixed one; fix a cell of its part or put the part outside",
                                       stage, lost.front().begin, lost.front().row));
        }
    }
}

enum class FreeCells : std::uint8_t { zero, guess };

/// Values in the two colours' order.
void spread(GridProblem const& problem, FreeCells free, TwoColours<double>& x, Run const& run) {
    parallel_ranges(run, problem.kind.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            auto const kind = problem.kind.row(y);
            auto const value = problem.value.row(y);
            double* const of[2] = {x.of[Board::first(y, 0)].row(y), x.of[1 - Board::first(y, 0)].row(y)};
            for (std::size_t i = 0; i < kind.size(); ++i) {
                bool const taken = kind[i] == fixed_cell || (kind[i] == free_cell && free == FreeCells::guess);
                of[i & 1][i / 2] = taken ? value[i] : 0.0;
            }
        }
    });
}

/// Sets the free cells of x, which are 0.
void start_from(double value, TopLevel const& top, TwoColours<double>& x, Run const& run) {
    parallel_ranges(run, top.board.height, 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            for (int colour : {0, 1}) {
                std::uint8_t const* const free = top.degree.of[colour].row(y);
                double* const to = x.of[colour].row(y);
                for (std::int64_t k = 0; k < top.board.half(); ++k) {
                    to[k] += free[k] != 0 ? value : 0.0;
                }
            }
        }
    });
}

} // namespace

Contents look_through(GridProblem const& problem, char const* stage, Run const& run) {
    demand_one_frame(problem, stage);
    run.check();
    Contents const all = contents(problem, run);
    demand_solvable(problem, all, stage, run);
    return all;
}

ColouredProblem coloured(GridProblem const& problem, Contents const& contents, Run const& run) {
    ColouredProblem made;
    made.top = top_level(problem.kind, run);
    made.x = TwoColours<double>(made.top.board);
    made.b = problem.source.cells() > 0 ? &problem.source : nullptr;
    if (contents.size > 0.0) {
        int exponent = 0;
        std::frexp(contents.size, &exponent);
        made.scale = std::ldexp(1.0, -exponent);
    }
    spread(problem, FreeCells::zero, made.x, run);
    return made;
}

void spread_guess(GridProblem const& problem, ColouredProblem& coloured, Run const& run) {
    spread(problem, FreeCells::guess, coloured.x, run);
}

void set_guess(GridProblem const& problem, Contents const& contents, ColouredProblem& coloured, Run const& run) {
    if (contents.guesses > 0 && contents.unknown == 0) {
        spread_guess(problem, coloured, run);
    } else {
        start_from(contents.sum / static_cast<double>(contents.fixed), coloured.top, coloured.x, run);
    }
}

void collect(ColouredProblem const& coloured, Contents const& contents, GridProblem& problem, Run const& run) {
    double const least = coloured.b == nullptr ? contents.least : std::numeric_limits<double>::lowest();
    double const greatest = coloured.b == nullptr ? contents.greatest : std::numeric_limits<double>::max();
    parallel_ranges(run, problem.kind.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            auto const kind = problem.kind.row(y);
            auto const value = problem.value.row(y);
            double const* const of[2] = {coloured.x.of[Board::first(y, 0)].row(y),
                                         coloured.x.of[1 - Board::first(y, 0)].row(y)};
            for (std::size_t i = 0; i < kind.size(); ++i) {
                value[i] = kind[i] == free_cell ? std::clamp(of[i & 1][i / 2], least, greatest) : value[i];
            }
        }
    });
}

double sum_of(std::vector<double> const& parts) {
    double sum = 0.0;
    for (double const part : parts) {
        sum += part;
    }
    return sum;
}

void residual_row(ColouredProblem const& problem, std::int64_t y, int colour, float* r, GridRows const& rows) {
    Board const& board = problem.top.board;
    Indexed<ColumnIndex, double> b(board.half());
    if (problem.b != nullptr) {
        double const* const given = problem.b->row(y).data();
        for (std::int64_t x = Board::first(y, colour); x < board.width; x += 2) {
            b[x / 2] = given[x];
        }
    }
    rows.residual(r, b.data(), problem.x.of[colour].row(y), {problem.top.degree.of[colour].row(y)},
                  around(problem.x.of[1 - colour], y, colour), problem.scale, board.half());
}

double residual_norm(ColouredProblem const& problem, GridRows const& rows, Run const& run) {
    Board const& board = problem.top.board;
    return std::sqrt(sum_of(each_row(board, run, [&](std::int64_t y) {
        Indexed<ColumnIndex, float> r(board.stride());
        double squares = 0.0;
        for (int colour : {0, 1}) {
            residual_row(problem, y, colour, r.data(), rows);
            squares += rows.dot(r.data(), r.data(), board.half());
        }
        return squares;
    })));
}

} // namespace thalweg::solver
