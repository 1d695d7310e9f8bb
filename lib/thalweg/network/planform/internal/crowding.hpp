// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/planform/internal/meander.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::network {

/// How close rivers may come.
struct Gap {
    double gap_m = 0.0;
    double along_m = 0.0; ///< positions closer along one river than this may be arbitrarily close
};

/// Whether a point, or one that stems_of would insert between it and the next of its river, lies in the sea.
/// \param at positions by point
/// \param i a point
/// \param land 0: sea; without cells: all land
bool leaves_land(Stems const& stems, std::vector<Vec2> const& at, std::size_t i, Mask const& land);

/// Looks round by round for points that came too close to a river's segment, after the first round only where something
/// has moved since. A point is too close to a segment of any river, its own included, if their distance is less than
/// the gap and less than 0.6 of what it was; or if it has left the grid or the land, or is closer than a cell to the
/// grid's border.
class Crowding {
public:
    /// \param was positions by point before any move; kept by reference like the others
    /// \param land 0: sea; without cells: all land
    Crowding(Stems const& stems, std::vector<Vec2> const& was, Grid const& grid, Mask const& land, Gap const& gap);

    /// \param is positions by point, now
    /// \return ascending: points too close, and the upper points of the segments to which they are
    std::vector<std::size_t> points(std::vector<Vec2> const& is, Run const& run = {});

private:
    /// The cells of the index that a box touches.
    struct Span {
        std::uint16_t first_col = 0;
        std::uint16_t last_col = 0;
        std::uint16_t first_row = 0;
        std::uint16_t last_row = 0;

        bool operator==(Span const&) const = default;
    };

    /// A point and a segment.
    using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

    bool is_segment(std::size_t i) const {
        return i + 1 < stems_.stem_of.size() && stems_.stem_of[i] == stems_.stem_of[i + 1];
    }
    void cover();
    void fill();
    void fill_displaced();
    void put_into_index();
    Span span_of(Vec2 a, Vec2 b, double margin_m) const;
    void note_moves(std::vector<Vec2> const& is);
    /// Whether a position is within the gap of the box around a segment. Most segments that the index gives are not.
    bool is_in_reach(Vec2 p, Vec2 a, Vec2 b) const {
        return std::min(a.x, b.x) - p.x <= reach_m_ && p.x - std::max(a.x, b.x) <= reach_m_ &&
               std::min(a.y, b.y) - p.y <= reach_m_ && p.y - std::max(a.y, b.y) <= reach_m_;
    }
    void compare(std::size_t point, std::size_t segment, Pairs& close) const;
    void compare_segments(std::size_t segment, std::size_t other, Pairs& close) const;
    void look_around(std::size_t segment, Pairs& close) const;

    Stems const& stems_;
    std::vector<Vec2> const& was_;
    Grid const& grid_;
    Mask const& land_;
    Gap gap_;
    double reach_m_; ///< the gap, and a little for rounding
    std::vector<Vec2> is_;
    std::vector<std::uint8_t> moved_;           ///< by point, in this round
    std::vector<std::uint32_t> segments_moved_; ///< ascending: segments with an end that moved
    std::vector<std::uint8_t> off_;             ///< by point: it left the grid
    std::vector<std::uint8_t> off_land_;        ///< by point: it or what follows left the land
    Pairs close_;                               ///< too close, in any order; may repeat

    // The index: segments by cells as wide as the gap. Outside, the nearest cell counts. A segment that has left its
    // cells since it was filled counts where it lies in a list of its own.
    Vec2 low_;
    double per_m_ = 0.0; ///< cells per metre
    std::size_t width_ = 0;
    std::size_t height_ = 0;
    std::vector<Span> spans_;             ///< by point: of the segment that begins there
    std::vector<std::uint32_t> first_;    ///< by cell: its first entry, and after the last cell the end
    std::vector<std::uint32_t> segments_; ///< by entry
    std::vector<std::uint8_t> displaced_; ///< by point: the segment that begins there has left its cells
    std::size_t displaced_segments_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> displaced_entries_; ///< ascending: a cell, and such a segment
};

} // namespace thalweg::network
