// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/internal/grid_levels.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/grid/poisson.hpp>

#include <algorithm>
#include <array>

namespace thalweg::solver {
namespace {

/// Numbers row by row, with zeros to an even width and height and one more row and column.
template <class T> class Padded {
public:
    explicit Padded(Board const& board)
        : stride_((board.width + 1) / 2 * 2 + 1),
          values_(static_cast<std::size_t>(stride_ * ((board.height + 1) / 2 * 2 + 1))) {}
    T* row(std::int64_t y) { return values_.data() + y * stride_; }
    T const* row(std::int64_t y) const { return values_.data() + y * stride_; }

private:
    std::int64_t stride_;
    std::vector<T, LargePages<T>> values_;
};

/// The equations of a level, row by row: edges to the east and south, and the diagonal.
struct Equations {
    explicit Equations(Board const& level) : board(level), east(level), south(level), diagonal(level) {}
    Board board;
    Padded<float> east, south, diagonal;
};

Padded<std::uint8_t> degrees(Raster<std::uint8_t> const& kind, Board const& board, Run const& run) {
    Padded<std::uint8_t> degree(board);
    parallel_ranges(run, board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        // No row beyond the border: all of it is outside.
        Indexed<ColumnIndex, std::uint8_t> const nothing(board.width, outside_cell);
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

/// Spreads a row over the colours.
template <class T> void split(T const* from, std::int64_t y, Board const& board, TwoColours<T>& to) {
    T* const even = to.of[Board::first(y, 0)].row(y);
    T* const odd = to.of[1 - Board::first(y, 0)].row(y);
    for (std::int64_t k = 0; k < board.half(); ++k) {
        even[k] = from[2 * k];
        odd[k] = from[2 * k + 1];
    }
}

/// What is left of an edge between cells of 2 x 2: numbers that are alike two by two make differences look steeper than
/// they are. With a half, the Laplacian is that of the coarser grid; edges to fixed cells stay whole. A power of two,
/// so that nothing is rounded off, and the diagonal less all edges is exactly that to fixed cells.
constexpr float share_of_edges = 0.5F;

/// A coarse cell's equation from those of the 2 x 2 cells it stands for.
/// east(x, y), south(x, y), diagonal(x, y): of the finer level.
template <class Edge, class South, class Diagonal>
Equations sums(Board const& fine, Run const& run, Edge const& east, South const& south, Diagonal const& diagonal) {
    Equations coarse(fine.coarser());
    parallel_ranges(run, coarse.board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            float* __restrict const to_east = coarse.east.row(row);
            float* __restrict const to_south = coarse.south.row(row);
            float* __restrict const to_diagonal = coarse.diagonal.row(row);
            std::int64_t const y = 2 * row;
            for (std::int64_t col = 0; col < coarse.board.width; ++col) {
                std::int64_t const x = 2 * col;
                float const inner = (east(x, y) + east(x, y + 1)) + (south(x, y) + south(x + 1, y));
                float const all = (diagonal(x, y) + diagonal(x + 1, y)) + (diagonal(x, y + 1) + diagonal(x + 1, y + 1));
                float const to_west = x > 0 ? east(x - 1, y) + east(x - 1, y + 1) : 0.0F;
                float const to_north = y > 0 ? south(x, y - 1) + south(x + 1, y - 1) : 0.0F;
                to_east[col] = share_of_edges * (east(x + 1, y) + east(x + 1, y + 1));
                to_south[col] = share_of_edges * (south(x, y + 1) + south(x + 1, y + 1));
                to_diagonal[col] =
                    (all - 2.0F * inner) - share_of_edges * (to_west + to_north) - (to_east[col] + to_south[col]);
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
                      TwoColours<float>(board),
                      Plane<float>(board),
                      Plane<float>(board),
                      Plane<float>(board),
                      Plane<float>(board)};
    parallel_ranges(run, board.height, 64, [&](std::int64_t begin, std::int64_t end) {
        Indexed<ColumnIndex, float> inverse(2 * board.half());
        for (std::int64_t y = begin; y < end; ++y) {
            float const* const diagonal = from.diagonal.row(y);
            for (std::int64_t x = 0; x < board.width; ++x) {
                inverse[x] = diagonal[x] > 0.0F ? 1.0F / diagonal[x] : 0.0F;
            }
            split(inverse.data(), y, board, level.inverse);
            for (std::int64_t x = Board::first(y, 0); x < board.width; x += 2) {
                std::int64_t const k = x / 2;
                level.above.row(y)[k] = y > 0 ? from.south.row(y - 1)[x] : 0.0F;
                level.left.row(y)[k] = x > 0 ? from.east.row(y)[x - 1] : 0.0F;
                level.right.row(y)[k] = from.east.row(y)[x];
                level.below.row(y)[k] = from.south.row(y)[x];
            }
        }
    });
    return level;
}

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
        return sums(
            top, run, [&](std::int64_t x, std::int64_t y) { return both(degree.row(y)[x], degree.row(y)[x + 1]); },
            [&](std::int64_t x, std::int64_t y) { return both(degree.row(y)[x], degree.row(y + 1)[x]); },
            [&](std::int64_t x, std::int64_t y) { return static_cast<float>(degree.row(y)[x]); });
    }();
    levels.push_back(level_of(equations, run));
    while (equations.board.width > 1 || equations.board.height > 1) {
        Equations const& fine = equations;
        equations = sums(
            fine.board, run, [&](std::int64_t x, std::int64_t y) { return fine.east.row(y)[x]; },
            [&](std::int64_t x, std::int64_t y) { return fine.south.row(y)[x]; },
            [&](std::int64_t x, std::int64_t y) { return fine.diagonal.row(y)[x]; });
        levels.push_back(level_of(equations, run));
    }
    return levels;
}

} // namespace thalweg::solver
