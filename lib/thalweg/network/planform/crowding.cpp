// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/crowding.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {
namespace {

constexpr double kept_share = 0.6; // of a distance below the gap
constexpr std::uint32_t no_entry = std::numeric_limits<std::uint32_t>::max();

double inside(Vec2 p, Grid const& grid) {
    return std::min({p.x - grid.west, grid.east() - p.x, grid.north - p.y, p.y - grid.south()});
}

bool is_sea(Vec2 p, Mask const& land) {
    Cell const c = land.grid().cell_of(p);
    return land.grid().contains(c) && land[c] == 0;
}

std::size_t slot(double at, std::size_t count) {
    return at < 0.0 ? 0 : std::min(static_cast<std::size_t>(at), count - 1);
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
    : stems_(stems), stem_of_(stems.stem_of.begin(), stems.stem_of.end()), was_(was), grid_(grid), land_(land),
      gap_(gap), reach_m_(1.001 * gap.gap_m), moved_(was.size()), off_(was.size()), off_land_(was.size()),
      free_(no_entry) {}

/// Lays out the index for the first positions.
void Crowding::cover(std::vector<Vec2> const& is) {
    low_ = is.front();
    Vec2 high = is.front();
    for (Vec2 const p : is) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    double const extent_m = std::max(high.x - low_.x, high.y - low_.y);
    per_m_ = 1.0 / std::max(gap_.gap_m, extent_m / 2000.0);
    width_ = static_cast<std::size_t>((high.x - low_.x) * per_m_) + 1;
    height_ = static_cast<std::size_t>((high.y - low_.y) * per_m_) + 1;
    first_.assign(width_ * height_, no_entry);
    entries_.reserve(2 * is.size());
}

Crowding::Span Crowding::span_of(Vec2 a, Vec2 b, double margin_m) const {
    return {slot((std::min(a.x, b.x) - margin_m - low_.x) * per_m_, width_),
            slot((std::max(a.x, b.x) + margin_m - low_.x) * per_m_, width_),
            slot((std::min(a.y, b.y) - margin_m - low_.y) * per_m_, height_),
            slot((std::max(a.y, b.y) + margin_m - low_.y) * per_m_, height_)};
}

void Crowding::add(std::size_t segment) {
    Span const span = span_of(is_[segment], is_[segment + 1], 0.0);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
            std::uint32_t& first = first_[row * width_ + col];
            std::uint32_t entry = free_;
            if (entry == no_entry) {
                entry = static_cast<std::uint32_t>(entries_.size());
                entries_.emplace_back();
            } else {
                free_ = entries_[entry].next;
            }
            entries_[entry] = {static_cast<std::uint32_t>(segment), first};
            first = entry;
        }
    }
}

void Crowding::remove(std::size_t segment) {
    Span const span = span_of(is_[segment], is_[segment + 1], 0.0);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
            std::uint32_t* link = &first_[row * width_ + col];
            while (entries_[*link].segment != segment) {
                link = &entries_[*link].next;
            }
            std::uint32_t const entry = *link;
            *link = entries_[entry].next;
            entries_[entry].next = free_;
            free_ = entry;
        }
    }
}

/// Calls visit(segment), once or more, for each segment that may be within the gap of the box between two positions.
template <class Visit> void Crowding::each_near(Vec2 a, Vec2 b, Visit const& visit) const {
    Span const span = span_of(a, b, reach_m_);
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        for (std::size_t col = span.first_col; col <= span.last_col; ++col) {
            for (std::uint32_t k = first_[row * width_ + col]; k != no_entry; k = entries_[k].next) {
                visit(std::size_t{entries_[k].segment});
            }
        }
    }
}

/// Notes a point and a segment that are too close.
void Crowding::compare(std::size_t point, std::size_t segment) {
    if (segment == point || segment + 1 == point ||
        (stem_of_[point] == stem_of_[segment] &&
         std::fabs(stems_.way_m[point] - stems_.way_m[segment]) < gap_.along_m)) {
        return;
    }
    double const gap_m2 = gap_.gap_m * gap_.gap_m;
    double const now = squared_distance(is_[point], {is_[segment], is_[segment + 1]});
    if (!(now < gap_m2)) {
        return;
    }
    double const before = squared_distance(was_[point], {was_[segment], was_[segment + 1]});
    if (now < (before >= gap_m2 ? gap_m2 : kept_share * kept_share * before)) {
        close_.emplace_back(static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(segment));
    }
}

void Crowding::look_around(std::size_t point) {
    Vec2 const p = is_[point];
    off_[point] = inside(p, grid_) < std::min(grid_.cell_m, inside(was_[point], grid_)) ? 1 : 0;
    each_near(p, p, [&](std::size_t segment) {
        if (is_in_reach(p, is_[segment], is_[segment + 1])) {
            compare(point, segment);
        }
    });
}

/// Looks for the points beside a segment that have not moved themselves.
void Crowding::look_around_segment(std::size_t segment) {
    Vec2 const a = is_[segment];
    Vec2 const b = is_[segment + 1];
    each_near(a, b, [&](std::size_t other) {
        if (moved_[other] == 0 && is_in_reach(is_[other], a, b)) {
            compare(other, segment);
        }
        if (moved_[other + 1] == 0 && !is_segment(other + 1) && is_in_reach(is_[other + 1], a, b)) { // a river's last
            compare(other + 1, segment);
        }
    });
}

std::vector<std::size_t> Crowding::points(std::vector<Vec2> const& is) {
    bool const first = is_.empty();
    std::vector<std::size_t> points;
    std::vector<std::size_t> segments;
    for (std::size_t i = 0; i < is.size(); ++i) {
        moved_[i] = first || !(is[i] == is_[i]) ? 1 : 0;
    }
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (moved_[i] != 0) {
            points.push_back(i);
        }
        if (is_segment(i) && (moved_[i] | moved_[i + 1]) != 0) {
            segments.push_back(i);
        }
    }
    if (first) {
        cover(is);
        is_ = is;
    } else {
        std::erase_if(close_, [&](auto const& pair) {
            auto const& [point, segment] = pair;
            return (moved_[point] | moved_[segment] | moved_[segment + 1]) != 0;
        });
        for (std::size_t const segment : segments) {
            remove(segment);
        }
        for (std::size_t const point : points) {
            is_[point] = is[point];
        }
    }
    for (std::size_t const segment : segments) {
        add(segment);
    }
    for (std::size_t const point : points) {
        look_around(point);
    }
    for (std::size_t k = 0; !first && k < segments.size(); ++k) {
        look_around_segment(segments[k]);
    }
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
