// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/grid/internal/poisson.hpp>

namespace thalweg::solver {
namespace {

/// Numbers row by row, padded with zeros to an even width and height, plus one more column and two more rows.
template <class T> class Padded {
public:
    explicit Padded(Board const& board)
        : stride_((board.width + 1) / 2 * 2 + 1),
          values_(static_cast<std::size_t>(stride_ * ((board.height + 1) / 2 * 2 + 2))) {}
    T* row(std::int64_t y) { return values_.data() + y * stride_; }
    T const* row(std::int64_t y) const { return values_.data() + y * stride_; }

private:
    std::int64_t stride_;
    std::vector<T, LargePages<T>> values_;
};

/// The equations of a level, row by row: weights of the edges to the east, to the south and to fixed cells.
struct Equations {
    explicit Equations(Board const& level) : board(level), east(level), south(level), fixed(level) {}
    Board board;
    Padded<float> east, south, fixed;
};

Padded<std::uint8_t> degrees(Raster<std::uint8_t> const& kind, Board const& board, Run const& run) {
    Padded<std::uint8_t> degree(board);
    parallel_ranges(run, board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        // The row beyond the border is all outside.
        std::vector<std::uint8_t> const nothing(board.width, outside_cell);
        for (std::int64_t y = begin; y < end; ++y) {
            std::uint8_t const* const here = kind.row(y).data();
            std::uint8_t const* const above = y > 0 ? kind.row(y - 1).data() : nothing.data();
            std::uint8_t const* const below = y + 1 < board.height ? kind.row(y + 1).data() : nothing.data();
            std::uint8_t* __restrict const to = degree.row(y);
            auto const count = [&](std::int64_t x, bool left, bool right) {
                int const sides =
                    (left && here[x - 1] != outside_cell ? 1 : 0) + (right && here[x + 1] != outside_cell ? 1 : 0);
                int const all = sides + (above[x] != outside_cell ? 1 : 0) + (below[x] != outside_cell ? 1 : 0);
                to[x] = here[x] == free_cell ? static_cast<std::uint8_t>(all) : std::uint8_t{0};
            };
            count(0, false, board.width > 1);
            for (std::int64_t x = 1; x + 1 < board.width; ++x) {
                count(x, true, true);
            }
            if (board.width > 1) {
                count(board.width - 1, true, false);
            }
        }
    });
    return degree;
}

/// Distributes a row over the colours.
template <class T> void split(T const* from, std::int64_t y, Board const& board, TwoColours<T>& to) {
    T* const even = to.of[Board::first(y, 0)].row(y);
    T* const odd = to.of[1 - Board::first(y, 0)].row(y);
    for (std::int64_t k = 0; k < board.half(); ++k) {
        even[k] = from[2 * k];
        odd[k] = from[2 * k + 1];
    }
}

/// Weight of the edge between two coarse cells: a piecewise constant correction makes differences look steeper than
/// they are, so the edges on the way from the middle of one cell to that of the other are resistors in series. On an
/// open grid that is half the edges between them, the Laplacian of the coarser grid; where only a gap connects two wide
/// parts, halves of halves would correct them many times too much. Less than half would correct too little.
/// \param between sum of the edges between the cells
/// \param one, other sums of the edges along the same direction within each
float in_series(float one, float between, float other) {
    return std::max(0.5F * between, 1.0F / (0.5F / one + 1.0F / between + 0.5F / other));
}

/// Number of coarser levels, the finest first, that make two cycles for one of the level above. More change nothing.
constexpr std::size_t levels_solved_twice = 2;

/// Combines the equations of 2 x 2 cells into a coarse cell's equation. east(x, y), south(x, y), fixed(x, y): of the
/// finer level.
template <class East, class South, class Fixed>
Equations sums(Board const& fine, Run const& run, East const& east, South const& south, Fixed const& fixed) {
    Equations coarse(fine.coarser());
    parallel_ranges(run, coarse.board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            float* __restrict const to_east = coarse.east.row(row);
            float* __restrict const to_south = coarse.south.row(row);
            float* __restrict const to_fixed = coarse.fixed.row(row);
            std::int64_t const y = 2 * row;
            for (std::int64_t col = 0; col < coarse.board.width; ++col) {
                std::int64_t const x = 2 * col;
                to_east[col] = in_series(east(x, y) + east(x, y + 1), east(x + 1, y) + east(x + 1, y + 1),
                                         east(x + 2, y) + east(x + 2, y + 1));
                to_south[col] = in_series(south(x, y) + south(x + 1, y), south(x, y + 1) + south(x + 1, y + 1),
                                          south(x, y + 2) + south(x + 1, y + 2));
                to_fixed[col] = (fixed(x, y) + fixed(x + 1, y)) + (fixed(x, y + 1) + fixed(x + 1, y + 1));
            }
        }
    });
    return coarse;
}

CoarseLevel level_of(Equations const& from, Run const& run) {
    Board const& board = from.board;
    CoarseLevel level{board,
                      TwoColours<float>(board),
                      TwoColours<float>(board),
                      {},
                      TwoColours<float>(board),
                      Plane<float>(board),
                      Plane<float>(board),
                      Plane<float>(board),
                      Plane<float>(board)};
    parallel_ranges(run, board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        std::vector<float> inverse(2 * board.half());
        std::vector<float> const none(board.width);
        for (std::int64_t y = begin; y < end; ++y) {
            float const* const east = from.east.row(y);
            float const* const south = from.south.row(y);
            float const* const north = y > 0 ? from.south.row(y - 1) : none.data();
            for (std::int64_t x = 0; x < board.width; ++x) {
                float const sides = (x > 0 ? east[x - 1] : 0.0F) + east[x];
                float const diagonal = from.fixed.row(y)[x] + (sides + (north[x] + south[x]));
                inverse[x] = diagonal > 0.0F ? 1.0F / diagonal : 0.0F;
            }
            split(inverse.data(), y, board, level.inverse);
            for (std::int64_t x = Board::first(y, 0); x < board.width; x += 2) {
                std::int64_t const k = x / 2;
                level.above.row(y)[k] = north[x];
                level.left.row(y)[k] = x > 0 ? east[x - 1] : 0.0F;
                level.right.row(y)[k] = east[x];
                level.below.row(y)[k] = south[x];
            }
        }
    });
    return level;
}

constexpr float over_correction = 1.0F; // none: the coarser levels' edges are weaker instead
constexpr int red = 0;
constexpr int black = 1;

TopRow equations(TopLevel const& level, std::int64_t y, int colour) {
    return {level.degree.of[colour].row(y)};
}

CoarseRow equations(CoarseLevel const& level, std::int64_t y, int colour) {
    float const* const inverse = level.inverse.of[colour].row(y);
    if (colour == red) {
        return {inverse, {level.above.row(y), level.left.row(y), level.right.row(y), level.below.row(y)}};
    }
    // The edges of a black cell are those of the red ones around it.
    std::int64_t const shift = Board::first(y, black);
    return {
        inverse,
        {level.below.row(y - 1), level.right.row(y) + shift - 1, level.left.row(y) + shift, level.above.row(y + 1)}};
}

SmoothingRows<TopRow> const& loops(GridRows const& rows, TopLevel const&) {
    return rows.top;
}
SmoothingRows<CoarseRow> const& loops(GridRows const& rows, CoarseLevel const&) {
    return rows.coarse;
}

/// The last four rows of one colour, stored here or elsewhere (lend).
class Window {
public:
    explicit Window(Board const& board) : stride_(board.stride()), values_(static_cast<std::size_t>(4 * stride_ + 16)) {
        for (std::int64_t y = 0; y < 4; ++y) {
            keep(y);
        }
    }
    float* row(std::int64_t y) { return rows_[y & 3]; }
    void keep(std::int64_t y) { lend(y, values_.data() + 8 + (y & 3) * stride_); }
    void lend(std::int64_t y, float* place) { rows_[y & 3] = place; }
    Around<float> around(std::int64_t y, int colour) {
        std::int64_t const shift = Board::first(y, colour);
        return {row(y - 1), row(y) + shift - 1, row(y) + shift, row(y + 1)};
    }

private:
    std::int64_t stride_;
    std::vector<float> values_;
    std::array<float*, 4> rows_{};
};

/// Adds up two rows of the finer level's residual.
void restrict_rows(std::array<std::vector<float>, 2> const& rest, std::int64_t row, CoarseLevel& coarse,
                   GridRows const& rows) {
    std::int64_t const even = Board::first(row, red);
    rows.split_sum(coarse.r.of[even].row(row), coarse.r.of[1 - even].row(row), rest[0].data(), rest[1].data(),
                   coarse.board.half());
}

/// Sweeps red, then black, from zero, and restricts the residual to the coarser level. After the sweep the residual is
/// 0 in black cells; in red ones it is the sum of the changes of their black neighbours.
template <class Level>
void down(Level const& level, TwoColours<float> const& r, CoarseLevel& coarse, GridRows const& rows, Run const& run) {
    SmoothingRows<std::remove_cvref_t<decltype(equations(level, 0, red))>> const& loop = loops(rows, level);
    std::int64_t const n = level.board.half();
    parallel_ranges(run, coarse.board.height, rows_a_range(coarse.board), [&](std::int64_t begin, std::int64_t end) {
        Window e_red(level.board);
        Window e_black(level.board);
        std::array<std::vector<float>, 2> rest;
        rest.fill(std::vector<float>(level.board.stride()));
        for (std::int64_t y = 2 * begin - 2; y < 2 * end + 2; ++y) {
            loop.first(e_red.row(y), r.of[red].row(y), equations(level, y, red), n);
            if (std::int64_t const b = y - 1; b >= 2 * begin - 1) {
                loop.relax(e_black.row(b), r.of[black].row(b), equations(level, b, black), e_red.around(b, black), n);
            }
            if (std::int64_t const q = y - 2; q >= 2 * begin) {
                loop.rest(rest[q & 1].data(), equations(level, q, red), e_black.around(q, red), n);
                if ((q & 1) != 0) {
                    restrict_rows(rest, q / 2, coarse, rows);
                }
            }
        }
    });
}

/// As down, from the values that up left instead of zero: red cells are solved, so only black ones change.
void down_again(CoarseLevel const& level, CoarseLevel& coarse, GridRows const& rows, Run const& run) {
    std::int64_t const n = level.board.half();
    parallel_ranges(run, coarse.board.height, rows_a_range(coarse.board), [&](std::int64_t begin, std::int64_t end) {
        Window change(level.board);
        std::vector<float> black_row(level.board.stride());
        std::array<std::vector<float>, 2> rest;
        rest.fill(std::vector<float>(level.board.stride()));
        for (std::int64_t y = 2 * begin - 1; y <= 2 * end; ++y) {
            std::copy_n(level.e.of[black].row(y), n, change.row(y));
            rows.coarse.relax(black_row.data(), level.r.of[black].row(y), equations(level, y, black),
                              around(level.e.of[red], y, black), n);
            rows.direct(change.row(y), black_row.data(), -1.0F, n);
            if (std::int64_t const q = y - 1; q >= 2 * begin) {
                rows.coarse.rest(rest[q & 1].data(), equations(level, q, red), change.around(q, red), n);
                if ((q & 1) != 0) {
                    restrict_rows(rest, q / 2, coarse, rows);
                }
            }
        }
    });
}

/// Adds the coarser level's correction and sweeps black, then red. corrected(to, y, correction): a row's red cells
/// before these sweeps, with their correction.
/// \return the sum of r e
template <class Level, class Corrected>
double up(Level const& level, TwoColours<float> const& r, TwoColours<float>& e, CoarseLevel const& coarse,
          GridRows const& rows, Run const& run, Corrected const& corrected) {
    SmoothingRows<std::remove_cvref_t<decltype(equations(level, 0, red))>> const& loop = loops(rows, level);
    std::int64_t const n = level.board.half();
    std::vector<double> sums(coarse.board.height);
    parallel_ranges(run, coarse.board.height, rows_a_range(coarse.board), [&](std::int64_t begin, std::int64_t end) {
        Window e_red(level.board);
        Window e_black(level.board);
        std::vector<float> correction(level.board.stride());
        for (std::int64_t y = 2 * begin - 2; y < 2 * end + 2; ++y) {
            if ((y & 1) == 0) {
                std::int64_t const row = y / 2;
                std::int64_t const even = Board::first(row, red);
                rows.merge(correction.data(), coarse.e.of[even].row(row), coarse.e.of[1 - even].row(row),
                           over_correction, coarse.board.half());
            }
            corrected(e_red.row(y), y, correction.data());
            if (std::int64_t const b = y - 1; b >= 2 * begin - 1) {
                // This range also computes rows of the next range, but only the next range may write them.
                b >= 2 * begin&& b < 2 * end ? e_black.lend(b, e.of[black].row(b)) : e_black.keep(b);
                loop.relax(e_black.row(b), r.of[black].row(b), equations(level, b, black), e_red.around(b, black), n);
            }
            if (std::int64_t const q = y - 2; q >= 2 * begin) {
                loop.relax(e.of[red].row(q), r.of[red].row(q), equations(level, q, red), e_black.around(q, red), n);
                sums[q / 2] += rows.dot(r.of[red].row(q), e.of[red].row(q), n) +
                               rows.dot(r.of[black].row(q), e.of[black].row(q), n);
            }
        }
    });
    double sum = 0.0;
    for (double const part : sums) {
        sum += part;
    }
    return sum;
}

/// The second half of a cycle, after down.
template <class Level>
double up(Level const& level, TwoColours<float> const& r, TwoColours<float>& e, CoarseLevel const& coarse,
          GridRows const& rows, Run const& run) {
    return up(level, r, e, coarse, rows, run, [&](float* to, std::int64_t y, float const* correction) {
        loops(rows, level).corrected(to, r.of[red].row(y), equations(level, y, red), correction, level.board.half());
    });
}

/// The second half of a cycle, after down_again. Of the former values only those of red cells are read.
void up_again(CoarseLevel& level, CoarseLevel const& coarse, GridRows const& rows, Run const& run) {
    std::int64_t const n = level.board.half();
    std::swap(level.e.of[red], level.former);
    up(level, level.r, level.e, coarse, rows, run, [&](float* to, std::int64_t y, float const* correction) {
        std::copy_n(correction, n, to);
        rows.direct(to, level.former.row(y), 1.0F, n); // cells that are not free have no edges
    });
}

/// Approximately solves the level's equations for its own right-hand side.
void solve(std::vector<CoarseLevel>& levels, std::size_t index, GridRows const& rows, Run const& run) {
    CoarseLevel& level = levels[index];
    if (index + 1 == levels.size()) { // one red cell
        level.e.of[red].row(0)[0] = level.inverse.of[red].row(0)[0] * level.r.of[red].row(0)[0];
        return;
    }
    CoarseLevel& coarser = levels[index + 1];
    down(level, level.r, coarser, rows, run);
    solve(levels, index + 1, rows, run);
    up(level, level.r, level.e, coarser, rows, run);
    if (index < levels_solved_twice) {
        down_again(level, coarser, rows, run);
        solve(levels, index + 1, rows, run);
        up_again(level, coarser, rows, run);
    }
}

// z = M r with M one cycle: symmetric, close to the inverse of the problem's matrix, and positive definite as long as
// one cycle of a level that makes two corrects nothing twice too much (in_series). Each level makes one red-black
// Gauss-Seidel sweep from zero, adds the coarser level's correction, and sweeps backwards; the coarser levels' edges
// are weaker because corrections are piecewise constant. The first coarser levels make two cycles each: their errors,
// not those of the grid itself, decide how often to iterate. Sweeps are fused in one pass over the rows per leg, so
// that only z is stored. Returns the sum of r z. The same bytes for any number of threads: each range of rows
// recomputes the rows around it. Source: Braess 1995, Towards algebraic multigrid for elliptic problems of second order
// (aggregation).
double cycle(TopLevel const& top, std::vector<CoarseLevel>& coarse, TwoColours<float> const& r, TwoColours<float>& z,
             GridRows const& rows, Run const& run) {
    down(top, r, coarse.front(), rows, run);
    solve(coarse, 0, rows, run);
    return up(top, r, z, coarse.front(), rows, run);
}

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

    /// Computes r from x.
    /// \return its norm
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

    /// Computes z, the correction that a cycle would add to x.
    void precondition() { rz_ = cycle(problem_.top, levels_, r_, z_, rows_, run_); }

    double greatest_correction() const { return greatest(z_, board_, run_); }

    /// Takes a step along the direction given by z.
    /// \return the norm of r by recurrence
    double advance() {
        auto const conjugate = static_cast<float>(rz_before_ > 0.0 ? rz_ / rz_before_ : 0.0);
        rz_before_ = rz_;
        std::vector<Products> parts(board_.height);
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
        // The first and last rows of chunks had to wait for their neighbours.
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
        if (!(all.pap > 0.0)) { // the rest is 0 in single precision
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
        double rp = 0.0; ///< r z but for float rounding; with it every step goes downhill
    };

    void direct(std::int64_t y, float conjugate) {
        for (int colour : {0, 1}) {
            rows_.direct(p_.of[colour].row(y), z_.of[colour].row(y), conjugate, n_);
        }
    }

    /// z is no longer needed: A p replaces it.
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

TopLevel top_level(Raster<std::uint8_t> const& kind, Run const& run) {
    TopLevel top;
    top.board = {kind.width(), kind.height()};
    top.degree = TwoColours<std::uint8_t>(top.board);
    Padded<std::uint8_t> const degree = degrees(kind, top.board, run);
    parallel_ranges(run, top.board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            split(degree.row(y), y, top.board, top.degree);
        }
    });
    return top;
}

std::vector<CoarseLevel> coarse_levels(Raster<std::uint8_t> const& kind, Run const& run) {
    Board const top{kind.width(), kind.height()};
    std::vector<CoarseLevel> levels;
    Equations equations = [&] {
        Padded<std::uint8_t> const degree = degrees(kind, top, run);
        auto const both = [](std::uint8_t a, std::uint8_t b) { return a > 0 && b > 0 ? 1.0F : 0.0F; };
        auto const east = [&](std::int64_t x, std::int64_t y) { return both(degree.row(y)[x], degree.row(y)[x + 1]); };
        auto const south = [&](std::int64_t x, std::int64_t y) { return both(degree.row(y)[x], degree.row(y + 1)[x]); };
        return sums(top, run, east, south, [&](std::int64_t x, std::int64_t y) {
            float const back = (x > 0 ? east(x - 1, y) : 0.0F) + (y > 0 ? south(x, y - 1) : 0.0F);
            return static_cast<float>(degree.row(y)[x]) - (east(x, y) + south(x, y) + back);
        });
    }();
    levels.push_back(level_of(equations, run));
    while (equations.board.width > 1 || equations.board.height > 1) {
        Equations const& fine = equations;
        equations = sums(
            fine.board, run, [&](std::int64_t x, std::int64_t y) { return fine.east.row(y)[x]; },
            [&](std::int64_t x, std::int64_t y) { return fine.south.row(y)[x]; },
            [&](std::int64_t x, std::int64_t y) { return fine.fixed.row(y)[x]; });
        levels.push_back(level_of(equations, run));
    }
    for (std::size_t i = 0; i < std::min(levels_solved_twice, levels.size()); ++i) {
        levels[i].former = Plane<float>(levels[i].board);
    }
    return levels;
}

Convergence conjugate_gradients(ColouredProblem& problem, std::vector<CoarseLevel>& levels, double zero,
                                Goal const& goal, GridRows const& rows, Run const& run) {
    constexpr int patience = 60;     // iterations allowed without a smaller residual
    constexpr double lasting = 1e-3; // reduction over which float keeps its accuracy
    constexpr double unseen = 4.0;   // bound of the error after a cycle, relative to the correction it makes
    double const wanted = goal.tolerance * zero;
    Board const& board = problem.top.board;
    Iteration iteration(problem, levels, rows, run);
    double norm = iteration.renew();
    double counted = norm; // the last one computed from x
    double least = norm;
    int least_at = 0;
    double size = -1.0; // largest |x|, once it has settled
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
            throw NotConverged("solver.solve_poisson",
                               fmt::format("after {} iterations the residual is {:.3g} of what it was instead of "
                                           "{:.3g}; ask for less or allow more of them",
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
            if (stuck || norm > 0.5 * counted) { // the limit of double precision
                if (norm <= wanted) {
                    return {done + 1, norm};
                }
                throw NotConverged("solver.solve_poisson",
                                   fmt::format("the residual stays at {:.3g} of what it was, where double has no more "
                                               "digits; a tolerance of {:.3g} is out of reach",
                                               norm / zero, goal.tolerance));
            }
            counted = norm;
        }
    }
}

} // namespace thalweg::solver
