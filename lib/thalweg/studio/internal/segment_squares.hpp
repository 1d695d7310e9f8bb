// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::studio {

/// Segments by the squares of the plane that they pass, so that those near another are found without looking at all.
class SegmentSquares {
public:
    /// \param side_m [m] > 0, of a square
    explicit SegmentSquares(double side_m) : side_m_(side_m) {}

    /// Squares twice as wide as the line's segments are long.
    /// \param line two vertices or more
    /// \param least_m [m] > 0, least side of a square
    static SegmentSquares of_line(std::vector<Vec2> const& line, double least_m) {
        SegmentSquares squares(std::max(least_m, 2.0 * length_of(line) / static_cast<double>(line.size() - 1)));
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            squares.add(i, line[i], line[i + 1]);
        }
        return squares;
    }

    void add(std::size_t number, Vec2 a, Vec2 b) {
        each_square(a, b, 0.0, [&](std::uint64_t square) { in_[square].push_back(number); });
    }

    /// \param margin_m [m] >= 0
    /// \return the numbers of all segments within the margin of one, and of some others, in order, each once
    std::vector<std::size_t> near(Vec2 a, Vec2 b, double margin_m) const {
        std::vector<std::size_t> numbers;
        each_square(a, b, margin_m, [&](std::uint64_t square) {
            if (auto const found = in_.find(square); found != in_.end()) {
                numbers.insert(numbers.end(), found->second.begin(), found->second.end());
            }
        });
        std::ranges::sort(numbers);
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        return numbers;
    }

private:
    std::int64_t slot(double along) const { return static_cast<std::int64_t>(std::floor(along / side_m_)); }

    /// Calls visit(square) for the squares within a margin of a segment, row by row.
    template <class Visit> void each_square(Vec2 a, Vec2 b, double margin_m, Visit visit) const {
        if (a.y > b.y) {
            std::swap(a, b);
        }
        double const rise = b.y - a.y;
        for (std::int64_t row = slot(a.y - margin_m); row <= slot(b.y + margin_m); ++row) {
            double const low = static_cast<double>(row) * side_m_ - margin_m;
            double const high = low + side_m_ + 2.0 * margin_m;
            auto const x_at = [&](double y) {
                double const share = rise > 0.0 ? std::clamp((y - a.y) / rise, 0.0, 1.0) : 0.0;
                return a.x + share * (b.x - a.x);
            };
            double const one = rise > 0.0 ? x_at(low) : a.x;
            double const other = rise > 0.0 ? x_at(high) : b.x;
            // Rounding of a place far from the origin must not lose a square.
            double const slack_m = margin_m + 1e-9 * (side_m_ + std::fabs(a.x) + std::fabs(b.x));
            auto const [west, east] = std::minmax(one, other);
            for (std::int64_t col = slot(west - slack_m); col <= slot(east + slack_m); ++col) {
                visit(static_cast<std::uint64_t>(row) << 32U ^ (static_cast<std::uint64_t>(col) & 0xffffffffU));
            }
        }
    }

    double side_m_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> in_;
};

} // namespace thalweg::studio
