// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/crowding.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>

#include <thalweg/geometry/segment_grid.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::network {
namespace {

constexpr double kept_share = 0.6; // of a distance below the gap

double inside(Vec2 p, Grid const& grid) {
    return std::min({p.x - grid.west, grid.east() - p.x, grid.north - p.y, p.y - grid.south()});
}

bool is_sea(Vec2 p, Mask const& land) {
    Cell const c = land.grid().cell_of(p);
    return land.grid().contains(c) && land[c] == 0;
}

std::uint16_t slot(double at, std::size_t count) {
    return at < 0.0 ? std::uint16_t{0} : static_cast<std::uint16_t>(std::min(static_cast<std::size_t>(at), count - 1));
}

} // namespace

bool leaves_land(Stems const& stems, std::vector<Vec2> const& at, std::size_t i, Mask const& land) {
    if (land.cells() == 0) {
        return false;
    }
    if (is_sea(at[i], land)) {
        return true;
    }
    if (i + 1 == at.size() || stems.stem_of[i] != stems.stem_of[i + 1]) {
        return false;
    }
    auto const [count, step] = steps_between(at[i], at[i + 1], land.grid().cell_m);
    for (double k = 1.0; k < count; k += 1.0) {
        if (is_sea({at[i].x + k * step.x, at[i].y + k * step.y}, land)) {
            return true;
        }
    }
    return false;
}

Crowding::Crowding(Stems const& stems, std::vector<Vec2> const& was, Grid const& grid, Mask const& land, Gap const& gap)
    : stems_(stems), was_(was), grid_(grid), land_(land), gap_(gap), reach_m_(1.001 * gap.gap_m), moved_(was.size()),
      off_(was.size()), off_land_(was.size()), spans_(was.size()), displaced_(was.size()) {}

/// Lays out the index for the first positions.
void Crowding::cover() {
    constexpr double most_cells = 2000.0; // a side
    low_ = is_.front();
    Vec2 high = is_.front();
    for (Vec2 const p : is_) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    double const extent_m = std::max(high.x - low_.x, high.y - low_.y);
    per_m_ = 1.0 / std::max(gap_.gap_m, extent_m / most_cells);
    width_ = static_cast<std::size_t>((high.x - low_.x) * per_m_) + 1;
    height_ = static_cast<std::size_t>((high.y - low_.y) * per_m_) + 1;
}

Crowding::Span Crowding::span_of(Vec2 a, Vec2 b, double margin_m) const {
    return {slot((std::min(a.x, b.x) - margin_m - low_.x) * per_m_, width_),
            slot((std::max(a.x, b.x) + margin_m - low_.x) * per_m_, width_),
            slot((std::min(a.y, b.y) - margin_m - low_.y) * per_m_, height_),
            slot((std::max(a.y, b.y) + margin_m - low_.y) * per_m_, height_)};
}

/// Brings the index up to date. Few segments leave their cells after the first rounds.
void Crowding::fill() {
    constexpr std::size_t one_of = 8;
    for (std::size_t const segment : segments_moved_) {
        Span const span = span_of(is_[segment], is_[segment + 1], 0.0);
        if (displaced_[segment] == 0 && !(span == spans_[segment])) {
            displaced_[segment] = 1;
            ++displaced_segments_;
        }
        spans_[segment] = span;
    }
    if (first_.empty() || displaced_segments_ > is_.size() / one_of) {
        put_into_index();
        std::ranges::fill(displaced_, std::uint8_t{0});
        displaced_segments_ = 0;
    }
    fill_displaced();
}

/// Lists the segments that have left their cells by those in which they lie now.
void Crowding::fill_displaced() {
    displaced_entries_.clear();
    for (std::size_t i = 0; displaced_segments_ > 0 && i < displaced_.size(); ++i) {
        if (displaced_[i] == 0) {
            continue;
        }
        for (std::size_t row = spans_[i].first_row; row <= spans_[i].last_row; ++row) {
            for (std::size_t col = spans_[i].first_col; col <= spans_[i].last_col; ++col) {
                displaced_entries_.emplace_back(static_cast<std::uint32_t>(row * width_ + col),
                                                static_cast<std::uint32_t>(i));
            }
        }
    }
    std::ranges::sort(displaced_entries_);
}

/// Puts the segments into the index: a row's cells side by side, so that a search reads on.
void Crowding::put_into_index() {
    first_.assign(width_ * height_ + 1, 0);
    auto const each_cell = [&](auto const& visit) {
        for (std::size_t i = 0; i < is_.size(); ++i) {
            for (std::size_t row = spans_[i].first_row; is_segment(i) && row <= spans_[i].last_row; ++row) {
                for (std::size_t col = spans_[i].first_col; col <= spans_[i].last_col; ++col) {
                    visit(row * width_ + col, i);
                }
            }
        }
    };
    each_cell([&](std::size_t cell, std::size_t) { ++first_[cell]; });
    std::uint32_t entries = 0;
    for (std::uint32_t& first : first_) {
        entries += first;
        first = entries; // its end, until it is filled from there
    }
    segments_.resize(entries);
    each_cell([&](std::size_t cell, std::size_t i) { segments_[--first_[cell]] = static_cast<std::uint32_t>(i); });
}

/// Notes a point and a segment that are too close.
void Crowding::compare(std::size_t point, std::size_t segment, Pairs& close) const {
    if (segment == point || segment + 1 == point ||
        (stems_.stem_of[point] == stems_.stem_of[segment] &&
         std::fabs(stems_.way_m[point] - stems_.way_m[segment]) < gap_.along_m)) {
        return;
    }
    double const gap_m2 = gap_.gap_m * gap_.gap_m;
    double const now = geometry::squared_distance(is_[point], {is_[segment], is_[segment + 1]});
    if (!(now < gap_m2)) {
        return;
    }
    double const before = geometry::squared_distance(was_[point], {was_[segment], was_[segment + 1]});
    if (now < (before >= gap_m2 ? gap_m2 : kept_share * kept_share * before)) {
        close.emplace_back(static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(segment));
    }
}

/// Compares a segment that moved with another: their ends, of which each belongs to the segment that it begins.
void Crowding::compare_segments(std::size_t segment, std::size_t other, Pairs& close) const {
    Vec2 const a = is_[segment];
    Vec2 const b = is_[segment + 1];
    Vec2 const c = is_[other];
    Vec2 const d = is_[other + 1];
    if (moved_[segment] != 0 && is_in_reach(a, c, d)) {
        compare(segment, other, close);
    }
    if (moved_[segment + 1] != 0 && !is_segment(segment + 1) && is_in_reach(b, c, d)) { // a river's last
        compare(segment + 1, other, close);
    }
    if (moved_[other] == 0 && is_in_reach(c, a, b)) {
        compare(other, segment, close);
    }
    if (moved_[other + 1] == 0 && !is_segment(other + 1) && is_in_reach(d, a, b)) {
        compare(other + 1, segment, close);
    }
}

/// Compares a segment that moved, or its ends, with what is near.
void Crowding::look_around(std::size_t segment, Pairs& close) const {
    Span const span = span_of(is_[segment], is_[segment + 1], reach_m_);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        std::size_t const from = row * width_ + span.first_col;
        std::size_t const to = row * width_ + span.last_col;
        for (std::uint32_t k = first_[from]; k < first_[to + 1]; ++k) {
            if (displaced_[segments_[k]] == 0) {
                compare_segments(segment, segments_[k], close);
            }
        }
        auto const cell = &std::pair<std::uint32_t, std::uint32_t>::first;
        for (auto one = std::ranges::lower_bound(displaced_entries_, from, {}, cell);
             one != displaced_entries_.end() && one->first <= to; ++one) {
            compare_segments(segment, one->second, close);
        }
    }
}

/// Takes new positions, and forgets what was too close there.
void Crowding::note_moves(std::vector<Vec2> const& is) {
    bool const first = is_.empty();
    for (std::size_t i = 0; i < is.size(); ++i) {
        moved_[i] = first || !(is[i] == is_[i]) ? 1 : 0;
    }
    is_ = is;
    segments_moved_.clear();
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (moved_[i] != 0) {
            off_[i] = inside(is[i], grid_) < std::min(grid_.cell_m, inside(was_[i], grid_)) ? 1 : 0;
        }
        if (is_segment(i) && (moved_[i] | moved_[i + 1]) != 0) {
            segments_moved_.push_back(static_cast<std::uint32_t>(i));
        }
    }
    std::erase_if(close_, [&](auto const& pair) {
        auto const& [point, segment] = pair;
        return (moved_[point] | moved_[segment] | moved_[segment + 1]) != 0;
    });
    if (first) {
        cover();
    }
}

std::vector<std::size_t> Crowding::points(std::vector<Vec2> const& is, Run const& run) {
    constexpr std::int64_t least_segments = 2048; // that are worth a thread
    note_moves(is);
    fill();
    std::mutex mutex;
    parallel_ranges(run, static_cast<std::int64_t>(segments_moved_.size()), least_segments,
                    [&](std::int64_t begin, std::int64_t end) {
                        Pairs close;
                        for (std::int64_t k = begin; k < end; ++k) {
                            look_around(segments_moved_[static_cast<std::size_t>(k)], close);
                        }
                        std::scoped_lock const lock(mutex);
                        close_.insert(close_.end(), close.begin(), close.end());
                    });
    std::vector<std::uint8_t> found = off_;
    for (auto const& [point, segment] : close_) {
        found[point] = found[segment] = 1;
    }
    for (std::size_t i = 0; land_.cells() > 0 && i < is.size(); ++i) {
        std::size_t const next = std::min(i + 1, is.size() - 1);
        if ((moved_[i] | moved_[next]) != 0) {
            off_land_[i] = leaves_land(stems_, is_, i, land_) && !leaves_land(stems_, was_, i, land_) ? 1 : 0;
        }
        if (off_land_[i] != 0) {
            found[i] = found[next] = 1;
        }
    }
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] != 0) {
            out.push_back(i);
        }
    }
    return out;
}

} // namespace thalweg::network
