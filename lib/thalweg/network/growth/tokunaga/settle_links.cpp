// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::network {

namespace {

constexpr double sharpest = 0.93969262;       // cosine of 20 degrees
constexpr double sharpest_drawn = 0.99984770; // cosine of 1 degree

/// Cosine of the angle between the ways from one place to two others.
double cosine_at(Vec2 here, Vec2 a, Vec2 b) {
    return ((a.x - here.x) * (b.x - here.x) + (a.y - here.y) * (b.y - here.y)) /
           (distance(here, a) * distance(here, b));
}

class Settler {
public:
    Settler(Forest const& forest, std::vector<Vec2> wanted)
        : forest_(forest), at_(std::move(wanted)), links_(at_.size()), stays_(links_, 0), up_(links_) {
        Vec2 low = forest.shares.front().mouth;
        Vec2 high = low;
        for (Vec2& p : at_) {
            p = rounded(p);
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        std::vector<double> count(forest.shares.size(), 0.0);
        double length = 0.0;
        for (std::size_t i = 0; i < links_; ++i) {
            count[forest.links[i].tree] += 1.0;
            length += distance(segment(i).a, segment(i).b);
        }
        for (std::size_t t = 0; t < count.size(); ++t) {
            usual_.push_back(std::sqrt(forest.shares[t].area_m2 / std::max(count[t], 1.0)));
        }
        grid_.emplace(low, high, 1.2 * length / static_cast<double>(links_), links_ + forest.walls.size());
        for (std::size_t k = 0; k < forest.walls.size(); ++k) {
            grid_->add(links_ + k, forest.walls[k]);
        }
    }

    SettledLinks settle() {
        std::vector<std::size_t> turn(links_);
        std::iota(turn.begin(), turn.end(), std::size_t{0});
        auto const rank = [&](std::size_t i) { // what was drawn gives way to nothing that grew
            return std::pair{forest_.links[i].pinned.has_value(), forest_.links[i].order};
        };
        std::stable_sort(turn.begin(), turn.end(), [&](std::size_t i, std::size_t k) { return rank(i) > rank(k); });
        for (std::size_t const i : turn) {
            LinkId const down = forest_.links[i].down;
            if ((down < 0 || stays_[down] != 0) && (fits(i) || fits_elsewhere(i))) {
                stays_[i] = 1;
                grid_->add(i, segment(i));
                if (down >= 0) {
                    up_[down].push_back(i);
                }
            }
        }
        return {std::move(at_), std::move(stays_)};
    }

private:
    Vec2 lower_end(std::size_t i) const {
        ForestLink const& link = forest_.links[i];
        return link.down < 0 ? forest_.shares[link.tree].mouth : at_[link.down];
    }
    Segment segment(std::size_t i) const { return {lower_end(i), at_[i]}; }

    bool neighbours(std::size_t i, std::size_t k) const {
        LinkId const down = forest_.links[i].down;
        LinkId const other = forest_.links[k].down;
        return std::cmp_equal(down, k) || (down >= 0 && down == other) || std::cmp_equal(other, i);
    }

    /// Whether somebody else chose the link's place, which then counts more than what is near it, the edge too.
    bool drawn(std::size_t i) const { return forest_.links[i].pinned && rounded(*forest_.links[i].pinned) == at_[i]; }

    bool fits(std::size_t i) const { return clear(i) && bends_gently(i); }

    /// Moves the node of a link to the nearest place that has room for it; leaves it where there is none.
    bool fits_elsewhere(std::size_t i) {
        constexpr std::size_t headings = 24;
        constexpr double cosine = 0.96592582628906829; // of 15 degrees
        constexpr double sine = 0.25881904510252076;
        Vec2 const wanted = at_[i];
        Vec2 const from = lower_end(i);
        double const usual = usual_[forest_.links[i].tree];
        double length = std::clamp(distance(from, wanted), 0.5 * usual, 1.5 * usual);
        std::vector<std::pair<double, Vec2>> places;
        for (int shorter = 0; shorter < 9; ++shorter, length *= 0.7) {
            Vec2 heading{0.0, 1.0};
            for (std::size_t k = 0; k < headings; ++k) {
                Vec2 const to = rounded({from.x + length * heading.x, from.y + length * heading.y});
                places.emplace_back(distance(to, wanted), to);
                heading = {cosine * heading.x - sine * heading.y, sine * heading.x + cosine * heading.y};
            }
        }
        std::stable_sort(places.begin(), places.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
        for (auto const& [off, to] : places) {
            at_[i] = to;
            if (forest_.inside(to) && fits(i)) {
                return true;
            }
        }
        at_[i] = wanted;
        return false;
    }

    /// At the mouth a link may begin on the wall; the mouth is rounded, so that it may lie a little beside it.
    bool begins_on(std::size_t i, Segment const& wall) const {
        double const wide = usual_[forest_.links[i].tree];
        return forest_.links[i].down < 0 && squared_distance(lower_end(i), wall) <= 1e-10 * wide * wide &&
               (forest_.links[i].pinned.has_value() || forest_.inside(at_[i]));
    }

    bool clear(std::size_t i) const {
        Segment const s = segment(i);
        double const length = distance(s.a, s.b);
        if (!(length > 0.0)) {
            return false;
        }
        double const margin = std::max(forest_.clearance * length, forest_.min_spacing_m);
        return grid_->near(s, margin, [&](std::size_t k) {
            Segment const& t = (*grid_)[k];
            if (k >= links_) {
                return drawn(i) || squared_distance(s, t) > 0.0 || begins_on(i, t);
            }
            if (k == i || neighbours(i, k)) {
                return true;
            }
            double const need =
                drawn(i) && drawn(k)
                    ? 0.0
                    : std::max(forest_.clearance * std::min(length, distance(t.a, t.b)), forest_.min_spacing_m);
            double const squared = squared_distance(s, t);
            return squared > 0.0 && squared >= need * need;
        });
    }

    bool bends_gently(std::size_t i) const {
        LinkId const down = forest_.links[i].down;
        if (down < 0) {
            return true;
        }
        auto const below = static_cast<std::size_t>(down);
        Vec2 const here = at_[below];
        auto const apart = [&](std::size_t other, Vec2 to) {
            return cosine_at(here, to, at_[i]) <= (drawn(i) && drawn(other) ? sharpest_drawn : sharpest);
        };
        return apart(below, lower_end(below)) &&
               std::all_of(up_[below].begin(), up_[below].end(), [&](std::size_t k) { return apart(k, at_[k]); });
    }

    Forest const& forest_;
    Indexed<LinkId, Vec2> at_;
    std::vector<double> usual_; ///< [m] by tree: root of its land for each link
    std::size_t links_;
    Indexed<LinkId, std::uint8_t> stays_;
    Indexed<LinkId, std::vector<std::size_t>> up_;
    std::optional<SegmentGrid> grid_;
};

} // namespace

SettledLinks settle_links(Forest const& forest, std::vector<Vec2> wanted) {
    return Settler(forest, std::move(wanted)).settle();
}

} // namespace thalweg::network
