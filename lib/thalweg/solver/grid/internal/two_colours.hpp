// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/large_pages.hpp>

namespace thalweg::solver {

/// A grid coloured like a chessboard, each colour stored by itself: the cells of one colour in a row lie side by side,
/// and all neighbours of a cell have the other colour. Cell (x, y) is red (0) where x + y is even; it is the x/2-th of
/// its colour in its row. Around the grid lies a margin of zeros.
struct Board {
    std::int64_t width = 0;
    std::int64_t height = 0;

    static constexpr std::int64_t rows_above = 2;
    static constexpr std::int64_t rows_below = 3;

    static constexpr std::int64_t lanes = 8; ///< cells of one colour that are computed side by side

    std::int64_t half() const { return (width + 1) / 2; } ///< cells of one colour in a row, the last one maybe beyond
    /// From row to row: whole lanes, and at least one zero behind them.
    std::int64_t stride() const { return ((half() + lanes - 1) / lanes * lanes + 16) / 16 * 16; }
    Board coarser() const { return {half(), (height + 1) / 2}; }
    /// Column of the first cell of a colour in a row.
    static std::int64_t first(std::int64_t row, std::int64_t colour) { return (row + colour) & 1; }
};

/// Rows that are worth a thread of their own.
inline std::int64_t rows_a_range(Board const& board) {
    return std::max<std::int64_t>(32, 65536 / board.half());
}

/// What belongs to the cells of one colour. Takes rows from -rows_above to height + rows_below - 1, and in each row
/// indices from -1 to half().
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

/// Rows of the other colour so that [k] is the neighbour of the k-th cell of a row.
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

} // namespace thalweg::solver
