// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/internal/v_cycle.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/parallel.hpp>

#include <algorithm>
#include <array>

namespace thalweg::solver {
namespace {

constexpr float over_correction = 1.0F; // none: the coarser levels' edges are halved instead
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

/// The last four rows of one colour, each in its own place or where it is lent one.
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

/// Sweeps red, then black, from zero, and hands what is left of r to the coarser level. After the sweep nothing is left
/// in black cells, and in red ones what the black ones' change has brought: the sum of the neighbours.
template <class Level>
void down(Level const& level, TwoColours<float> const& r, CoarseLevel& coarse, GridRows const& rows, Run const& run) {
    SmoothingRows<std::remove_cvref_t<decltype(equations(level, 0, red))>> const& loop = loops(rows, level);
    std::int64_t const n = level.board.half();
    parallel_ranges(run, coarse.board.height, rows_a_range(coarse.board), [&](std::int64_t begin, std::int64_t end) {
        Window e_red(level.board);
        Window e_black(level.board);
        std::array<Indexed<ColumnIndex, float>, 2> rest;
        rest.fill(Indexed<ColumnIndex, float>(level.board.stride()));
        for (std::int64_t y = 2 * begin - 2; y < 2 * end + 2; ++y) {
            loop.first(e_red.row(y), r.of[red].row(y), equations(level, y, red), n);
            if (std::int64_t const b = y - 1; b >= 2 * begin - 1) {
                loop.relax(e_black.row(b), r.of[black].row(b), equations(level, b, black), e_red.around(b, black), n);
            }
            if (std::int64_t const q = y - 2; q >= 2 * begin) {
                loop.rest(rest[q & 1].data(), equations(level, q, red), e_black.around(q, red), n);
                if ((q & 1) != 0) {
                    std::int64_t const row = q / 2;
                    std::int64_t const even = Board::first(row, red);
                    rows.split_sum(coarse.r.of[even].row(row), coarse.r.of[1 - even].row(row), rest[0].data(),
                                   rest[1].data(), coarse.board.half());
                }
            }
        }
    });
}

/// Adds the coarser level's correction and sweeps black, then red. Gives the sum of r e.
template <class Level>
double up(Level const& level, TwoColours<float> const& r, TwoColours<float>& e, CoarseLevel const& coarse,
          GridRows const& rows, Run const& run) {
    SmoothingRows<std::remove_cvref_t<decltype(equations(level, 0, red))>> const& loop = loops(rows, level);
    std::int64_t const n = level.board.half();
    Indexed<RowIndex, double> sums(coarse.board.height);
    parallel_ranges(run, coarse.board.height, rows_a_range(coarse.board), [&](std::int64_t begin, std::int64_t end) {
        Window e_red(level.board);
        Window e_black(level.board);
        Indexed<ColumnIndex, float> correction(level.board.stride());
        for (std::int64_t y = 2 * begin - 2; y < 2 * end + 2; ++y) {
            if ((y & 1) == 0) {
                std::int64_t const row = y / 2;
                std::int64_t const even = Board::first(row, red);
                rows.merge(correction.data(), coarse.e.of[even].row(row), coarse.e.of[1 - even].row(row),
                           over_correction, coarse.board.half());
            }
            loop.corrected(e_red.row(y), r.of[red].row(y), equations(level, y, red), correction.data(), n);
            if (std::int64_t const b = y - 1; b >= 2 * begin - 1) {
                // Rows of the next range are made here too, but only it may write them.
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

/// Solves the level's equations for its own right-hand side, nearly.
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
}

} // namespace

double v_cycle(TopLevel const& top, std::vector<CoarseLevel>& coarse, TwoColours<float> const& r, TwoColours<float>& z,
               GridRows const& rows, Run const& run) {
    down(top, r, coarse.front(), rows, run);
    solve(coarse, 0, rows, run);
    return up(top, r, z, coarse.front(), rows, run);
}

} // namespace thalweg::solver
