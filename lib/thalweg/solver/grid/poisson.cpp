// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/solver/grid/internal/poisson.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/solver/opencl/internal/opencl.hpp>

namespace thalweg::solver {
namespace {

/// Spans of cells that are not outside, joined to parts; the root of a part records whether it has a fixed cell.
struct Parts {
    std::vector<CellSpan> spans;
    std::vector<std::size_t> parent;
    std::vector<std::uint8_t> has_fixed;

    std::size_t root(std::size_t i) {
        while (parent[i] != i) {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent[std::max(a, b)] = std::min(a, b);
        has_fixed[std::min(a, b)] |= has_fixed[std::max(a, b)];
    }
};

void add_spans(Raster<std::uint8_t> const& kind, std::int64_t row, Parts& parts) {
    auto const cells = kind.row(row);
    auto const past = cells.end();
    for (auto at = cells.begin(); at != past;) {
        auto const begin = std::find_if(at, past, [](std::uint8_t k) { return k != outside_cell; });
        at = std::find(begin, past, outside_cell);
        if (begin != at) {
            parts.parent.push_back(parts.spans.size());
            parts.spans.push_back({row, begin - cells.begin(), at - cells.begin()});
            parts.has_fixed.push_back(std::find(begin, at, fixed_cell) != at ? 1 : 0);
        }
    }
}

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

void require_one_frame(GridProblem const& problem, char const* stage) {
    Grid const& grid = problem.kind.grid();
    auto const fits = [&](Grid const& other) { return other.width == grid.width && other.height == grid.height; };
    refuse_if<BadInput>(
        !fits(problem.value.grid()) || (problem.source.cells() > 0 && !fits(problem.source.grid())), stage,
        "kinds of {} x {} cells, values of {} x {}, a source of {} x {}; the three must have one frame", grid.width,
        grid.height, problem.value.width(), problem.value.height(), problem.source.width(), problem.source.height());
}

void require_solvable(GridProblem const& problem, Contents const& all, char const* stage, Run const& run) {
    Grid const& grid = problem.kind.grid();
    if (all.bad < grid.cells()) {
        Cell const c = grid.at(all.bad);
        throw BadInput(stage, fmt::format("the cell at column {}, row {} has the kind {}, the value {} and the source "
                                          "{}; a fixed cell needs a finite value, a free one a finite source",
                                          c.col, c.row, problem.kind[c], problem.value[c],
                                          problem.source.cells() > 0 ? problem.source[c] : 0.0));
    }
    if (all.free > 0 && (all.fixed == 0 || all.outside > 0)) {
        if (auto const lost = unreached(problem.kind, run); !lost.empty()) {
            throw BadInput(stage, fmt::format("no path leads from the free cell at column {}, row {} to a fixed one; "
                                              "fix a cell of its part or put the part outside",
                                              lost.front().begin, lost.front().row));
        }
    }
}

enum class FreeCells : std::uint8_t { zero, guess };

/// Copies values into colour order.
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

void require(PoissonParams const& params) {
    require_in("solver.solve_poisson", "tolerance", params.tolerance, Range::inside(0.0, 1.0));
    require_in("solver.solve_poisson", "most_iterations", params.most_iterations, Range::at_least(0));
}

// Sets the free cells of x to their first guess.
void spread_guess(GridProblem const& problem, ColouredProblem& coloured, Run const& run) {
    spread(problem, FreeCells::guess, coloured.x, run);
}

// Even, so that a block's rows have the grid's colours.
constexpr std::int64_t block_rows = 32;
constexpr int sweeps_a_pass = 4; // recomputing the rows around a block costs less than leaving the cache

void require(GridProblem const& problem, ExplicitParams const& params) {
    refuse_if<BadParameter>(!(params.alpha > 0.0 && params.alpha <= 0.25), "solver.relax_explicit",
                            "alpha is {}; it must be greater than 0 and at most 1/4, for beyond it sweeps make the "
                            "differences between cells grow",
                            params.alpha);
    require_in("solver.relax_explicit", "sweeps", params.sweeps, Range::at_least(0));
    refuse_if<BadInput>(problem.source.cells() > 0, "solver.relax_explicit",
                        "the problem has a source; solve_poisson takes one");
}

/// Fixed cells of the value -0, which become +0 in x when steps of 0 are added.
std::vector<CellIndex> fixed_minus_zeros(GridProblem const& problem) {
    std::vector<CellIndex> cells;
    for (CellIndex i = 0; i < problem.value.cells(); ++i) {
        if (problem.value[i] == 0.0 && problem.kind[i] == fixed_cell && std::signbit(problem.value[i])) {
            cells.push_back(i);
        }
    }
    return cells;
}

/// A block of rows and its surrounding rows, before and after a sweep.
struct Block {
    explicit Block(std::int64_t width)
        : board{width, block_rows + 2 * std::int64_t{sweeps_a_pass}}, before(board), after(board) {}
    Board board;
    TwoColours<double> before, after;
};

/// Makes several sweeps over the rows [begin, end) of `from`, into `to`.
void sweep_block(TopLevel const& top, TwoColours<double> const& from, TwoColours<double>& to, std::int64_t begin,
                 std::int64_t sweeps, double alpha, Block& block, GridRows const& rows) {
    std::int64_t const n = top.board.half();
    std::int64_t const height = top.board.height;
    std::int64_t const base = begin - sweeps_a_pass;
    std::int64_t const end = std::min(height, begin + block_rows);
    for (std::int64_t y = base; y < base + block.board.height; ++y) {
        for (std::size_t const colour : {0U, 1U}) {
            double* const before = block.before.of[colour].row(y - base);
            if (y >= 0 && y < height) {
                std::copy_n(from.of[colour].row(y), n, before);
            } else {
                std::fill_n(before, n, 0.0);
                std::fill_n(block.after.of[colour].row(y - base), n, 0.0);
            }
        }
    }
    for (std::int64_t left = sweeps; left-- > 0;) {
        for (std::int64_t y = std::max<std::int64_t>(0, begin - left); y < std::min(height, end + left); ++y) {
            for (std::size_t const colour : {0U, 1U}) {
                rows.diffuse(block.after.of[colour].row(y - base), block.before.of[colour].row(y - base),
                             {top.degree.of[colour].row(y)},
                             around(block.before.of[1 - colour], y - base, static_cast<std::int64_t>(colour)), alpha,
                             n);
            }
        }
        std::swap(block.before, block.after);
    }
    for (std::int64_t y = begin; y < end; ++y) {
        for (std::size_t const colour : {0U, 1U}) {
            std::copy_n(block.before.of[colour].row(y - base), n, to.of[colour].row(y));
        }
    }
}

void sweep(ColouredProblem& problem, ExplicitParams const& params, GridRows const& rows, Run const& run) {
    Board const& board = problem.top.board;
    TwoColours<double> next(board);
    for (int done = 0; done < params.sweeps;) {
        run.at(static_cast<double>(done) / static_cast<double>(params.sweeps), "diffuse");
        int const now = std::min(sweeps_a_pass, params.sweeps - done);
        parallel_ranges(
            run, (board.height + block_rows - 1) / block_rows, 1, [&](std::int64_t first, std::int64_t last) {
                Block block(board.width);
                for (std::int64_t i = first; i < last; ++i) {
                    sweep_block(problem.top, problem.x, next, i * block_rows, now, params.alpha, block, rows);
                }
            });
        std::swap(problem.x, next);
        done += now;
    }
    run.at(1.0, "diffuse");
}

} // namespace

std::vector<CellSpan> unreached(Raster<std::uint8_t> const& kind, Run const& run) {
    Parts parts;
    std::size_t above = 0; // first span of the row above
    for (std::int64_t row = 0; row < kind.height(); ++row) {
        if (row % 512 == 0) {
            run.check();
        }
        std::size_t const here = parts.spans.size();
        add_spans(kind, row, parts);
        for (std::size_t a = above, b = here; a < here && b < parts.spans.size();) {
            if (parts.spans[a].begin < parts.spans[b].end && parts.spans[b].begin < parts.spans[a].end) {
                parts.join(a, b);
            }
            ++(parts.spans[a].end < parts.spans[b].end ? a : b);
        }
        above = here;
    }
    std::vector<CellSpan> found;
    for (std::size_t i = 0; i < parts.spans.size(); ++i) {
        if (parts.has_fixed[parts.root(i)] == 0) {
            found.push_back(parts.spans[i]);
        }
    }
    return found;
}

Contents survey_problem(GridProblem const& problem, char const* stage, Run const& run) {
    require_one_frame(problem, stage);
    run.check();
    Contents const all = contents(problem, run);
    require_solvable(problem, all, stage, run);
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
    bool const is_released = problem.value.cells() == 0;
    if (is_released) {
        problem.value = Raster<double>(problem.kind.grid());
    }
    parallel_ranges(run, problem.kind.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            auto const kind = problem.kind.row(y);
            auto const value = problem.value.row(y);
            double const* const of[2] = {coloured.x.of[Board::first(y, 0)].row(y),
                                         coloured.x.of[1 - Board::first(y, 0)].row(y)};
            for (std::size_t i = 0; i < kind.size(); ++i) {
                double const x = of[i & 1][i / 2];
                value[i] = kind[i] == free_cell ? std::clamp(x, least, greatest) : is_released ? x : value[i];
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
    std::vector<double> b(board.half());
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
        std::vector<float> r(board.stride());
        double squares = 0.0;
        for (int colour : {0, 1}) {
            residual_row(problem, y, colour, r.data(), rows);
            squares += rows.dot(r.data(), r.data(), board.half());
        }
        return squares;
    })));
}

GridSolution solve_poisson(GridProblem problem, PoissonParams const& params, Run const& run) {
    require(params);
    Contents const contents = survey_problem(problem, "solver.solve_poisson", run);
    if (run.device == Device::opencl) {
        return solve_poisson_opencl(std::move(problem), contents, params, run);
    }
    GridSolution solution;
    if (contents.free > 0) {
        GridRows const& rows = grid_rows(widest_lanes());
        ColouredProblem iterate = coloured(problem, contents, run);
        std::vector<CellIndex> minus_zeros;
        if (double const zero = residual_norm(iterate, rows, run); zero > 0.0) {
            set_guess(problem, contents, iterate, run);
            if (contents.outside == 0) { // x has them all
                minus_zeros = fixed_minus_zeros(problem);
                problem.value = {};
            }
            auto levels = coarse_levels(problem.kind, run);
            Convergence const reached =
                conjugate_gradients(iterate, levels, zero, {params.tolerance, params.most_iterations}, rows, run);
            solution.iterations = reached.iterations;
            solution.residual = reached.residual / zero;
        }
        collect(iterate, contents, problem, run);
        for (CellIndex const cell : minus_zeros) {
            problem.value[cell] = -0.0;
        }
    }
    solution.value = std::move(problem.value);
    return solution;
}

GridSolution relax_explicit(GridProblem problem, ExplicitParams const& params, Run const& run) {
    require(problem, params);
    Contents const contents = survey_problem(problem, "solver.relax_explicit", run);
    refuse_if<BadInput>(contents.unknown > 0, "solver.relax_explicit",
                        "{} free cells have no finite value; each needs one to start from", contents.unknown);
    GridSolution solution;
    if (contents.free > 0) {
        GridRows const& rows = grid_rows(widest_lanes());
        ColouredProblem iterate = coloured(problem, contents, run);
        double const zero = residual_norm(iterate, rows, run);
        if (run.device == Device::opencl) {
            relax_opencl(problem, params.alpha, params.sweeps, run);
            spread_guess(problem, iterate, run);
        } else {
            spread_guess(problem, iterate, run);
            sweep(iterate, params, rows, run);
        }
        collect(iterate, contents, problem, run);
        solution.residual = zero > 0.0 ? residual_norm(iterate, rows, run) / zero : 0.0;
    }
    solution.iterations = params.sweeps;
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
