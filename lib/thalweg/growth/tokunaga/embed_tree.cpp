// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/embed_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/growth/tokunaga/internal/embed_tree.hpp>

// Described in docs/algorithms/forest_spreading.md.

namespace thalweg::growth {

Vec2 centroid_of(std::vector<Vec2> const& ring) {
    double sum = 0.0;
    double x = 0.0;
    double y = 0.0;
    for (std::size_t i = 2; i < ring.size(); ++i) {
        double const area = cross(ring[0], ring[i - 1], ring[i]);
        sum += area;
        x += area * (ring[i - 1].x + ring[i].x - 2.0 * ring[0].x);
        y += area * (ring[i - 1].y + ring[i].y - 2.0 * ring[0].y);
    }
    return {ring[0].x + x / (3.0 * sum), ring[0].y + y / (3.0 * sum)};
}

std::vector<geometry::Segment> sides_of(std::vector<Vec2> const& ring) {
    std::vector<geometry::Segment> sides;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        sides.push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
    return sides;
}

std::vector<Vec2> lattice_in(std::vector<Vec2> const& ring, double width_m) {
    std::vector<Vec2> places;
    auto const [low, high] = std::minmax_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
    double const west = std::min_element(ring.begin(), ring.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; })->x;
    std::vector<double> cuts;
    for (double k = 0.5; low->y + k * width_m < high->y; k += 1.0) {
        double const y = low->y + k * width_m;
        cuts.clear();
        for (geometry::Segment const& s : sides_of(ring)) {
            if ((s.a.y > y) != (s.b.y > y)) {
                cuts.push_back(s.a.x + (y - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x));
            }
        }
        std::sort(cuts.begin(), cuts.end());
        for (std::size_t c = 1; c < cuts.size(); c += 2) {
            for (double m = std::ceil((cuts[c - 1] - west) / width_m - 0.5) + 0.5; west + m * width_m < cuts[c];
                 m += 1.0) {
                places.push_back({west + m * width_m, y});
            }
        }
    }
    return places;
}

namespace {

constexpr double sharpest = 0.93969262;       // cosine of 20 degrees
constexpr double sharpest_drawn = 0.99984770; // cosine of 1 degree

/// Cosine of the angle at a position between two others.
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
        auto const rank = [&](std::size_t i) { // drawn links are never displaced by grown ones
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
    geometry::Segment segment(std::size_t i) const { return {lower_end(i), at_[i]}; }

    bool neighbours(std::size_t i, std::size_t k) const {
        LinkId const down = forest_.links[i].down;
        LinkId const other = forest_.links[k].down;
        return std::cmp_equal(down, k) || (down >= 0 && down == other) || std::cmp_equal(other, i);
    }

    /// Whether the position of the link is prescribed: it then takes precedence over nearby links and the border.
    bool drawn(std::size_t i) const { return forest_.links[i].pinned && rounded(*forest_.links[i].pinned) == at_[i]; }

    bool fits(std::size_t i) const { return enters(i) && clear(i) && bends_gently(i); }

    /// Moves the node of a link to the nearest position with enough space; leaves it if there is none.
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

    /// A link from a mouth runs inwards: the mouth is rounded and may lie slightly outside, where no wall is in the
    /// way.
    bool enters(std::size_t i) const {
        ForestLink const& link = forest_.links[i];
        return link.down >= 0 || link.pinned || forest_.inside(at_[i]);
    }

    /// A link may begin on a wall at its tree's mouth, which is rounded and may lie slightly beside the wall.
    bool begins_on(std::size_t i, geometry::Segment const& wall) const {
        double const wide = usual_[forest_.links[i].tree];
        return forest_.links[i].down < 0 && geometry::squared_distance(lower_end(i), wall) <= 1e-10 * wide * wide;
    }

    bool clear(std::size_t i) const {
        geometry::Segment const s = segment(i);
        double const length = distance(s.a, s.b);
        if (!(length > 0.0)) {
            return false;
        }
        double const margin = std::max(forest_.clearance * length, forest_.min_spacing_m);
        return grid_->near(s, margin, [&](std::size_t k) {
            geometry::Segment const& t = (*grid_)[k];
            if (k >= links_) {
                return drawn(i) || geometry::squared_distance(s, t) > 0.0 || begins_on(i, t);
            }
            if (k == i || neighbours(i, k)) {
                return true;
            }
            double const need =
                drawn(i) && drawn(k)
                    ? 0.0
                    : std::max(forest_.clearance * std::min(length, distance(t.a, t.b)), forest_.min_spacing_m);
            double const squared = geometry::squared_distance(s, t);
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
    std::vector<Vec2> at_;
    std::vector<double> usual_; ///< [m] by tree: square root of its area per link
    std::size_t links_;
    std::vector<std::uint8_t> stays_;
    std::vector<std::vector<std::size_t>> up_;
    std::optional<geometry::SegmentGrid> grid_;
};

constexpr std::uint64_t embed_stage = 0x656d626564; // "embed"

/// Checks that a ring can be a region.
void check_ring(std::vector<Vec2> const& ring) {
    refuse_if<BadParameter>(ring.size() < 3, "growth.embed_tree", "the region has {} vertices, it needs three at least",
                            ring.size());
    for (Vec2 const p : ring) {
        refuse_if<BadParameter>(!is_finite(p), "growth.embed_tree", "the region's vertex ({}, {}) is not finite", p.x,
                                p.y);
    }
    std::vector<Vec2> closed = ring;
    closed.push_back(ring.front());
    for (geometry::Crossing const& c : geometry::crossings({closed})) {
        bool const closing = c.at == ring.front();
        refuse_if<BadParameter>(!closing, "growth.embed_tree",
                                "the region's ring meets itself at ({}, {}); draw it without loops", c.at.x, c.at.y);
    }
    refuse_if<BadParameter>(!(std::fabs(geometry::signed_area(ring)) > 0.0), "growth.embed_tree",
                            "the region has no area; give three places that are not in line");
}

void check(EmbedParams const& params, std::size_t links) {
    require_in("growth.embed_tree", "clearance", params.clearance, Range::between(0.05, 0.35));
    require_in("growth.embed_tree", "min_spacing_m", params.min_spacing_m, Range::at_least(0.0));
    refuse_if<BadParameter>(!is_finite(params.direction) || !is_finite(params.mouth), "growth.embed_tree",
                            "mouth and direction must be finite numbers");
    check_ring(params.region);
    double const spacing = std::sqrt(std::fabs(geometry::signed_area(params.region)) / static_cast<double>(links));
    if (spacing < 1e-3) {
        throw BadParameter("growth.embed_tree",
                           fmt::format("{} links in {} m2 lie {} m apart; take a larger region or fewer links", links,
                                       std::fabs(geometry::signed_area(params.region)), spacing));
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (geometry::Segment const& side : sides_of(params.region)) {
        nearest = std::min(nearest, std::sqrt(geometry::squared_distance(params.mouth, side)));
    }
    refuse_if<BadParameter>(!geometry::contains(params.region, params.mouth) && nearest > 1e-6 * spacing,
                            "growth.embed_tree",
                            "the outlet ({}, {}) lies {} m outside the region; move it to its edge", params.mouth.x,
                            params.mouth.y, nearest);
}

/// Where the trunk's first line ends: at two thirds of the distance to the other side.
Vec2 far_end(EmbedParams const& params, double spacing) {
    Vec2 ahead = params.direction;
    if (ahead.x == 0.0 && ahead.y == 0.0) {
        Vec2 const middle = centroid_of(params.region);
        ahead = {middle.x - params.mouth.x, middle.y - params.mouth.y};
    }
    double const length = std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y);
    ahead = length > 0.0 ? Vec2{ahead.x / length, ahead.y / length} : Vec2{0.0, 1.0};
    // The first exit from the region, found by steps: rings may have any shape.
    double const step = 0.25 * spacing;
    double reach = step;
    auto const there = [&](double way) { return Vec2{params.mouth.x + way * ahead.x, params.mouth.y + way * ahead.y}; };
    while (geometry::contains(params.region, there(reach + step))) {
        reach += step;
    }
    return there(0.66 * reach);
}

/// A tree without its lowest orders; links without inflow between them are joined.
struct ThinnedTree {
    std::vector<ForestLink> links;
    std::vector<std::vector<LinkId>> links_of; ///< of the tree, by link of the forest, downstream first
};

ThinnedTree thinned(TokunagaTree const& tree, int lowest) {
    std::vector<int> arrivals(tree.links.size(), 0);
    for (TreeLink const& link : tree.links) {
        if (link.down >= 0 && link.order >= lowest) {
            ++arrivals[link.down];
        }
    }
    ThinnedTree out;
    std::vector<LinkId> part(tree.links.size(), -1); // of the forest
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        TreeLink const& link = tree.links[i];
        if (link.order < lowest) {
            continue;
        }
        LinkId const below = link.down < 0 ? -1 : part[link.down];
        if (link.down >= 0 && arrivals[link.down] == 1) {
            part[i] = below;
        } else {
            part[i] = std::ssize(out.links);
            out.links.push_back({.down = below, .order = link.order, .turn = link.turn, .tree = 0, .pinned = {}});
            out.links_of.emplace_back();
        }
        out.links_of[part[i]].push_back(static_cast<LinkId>(i));
    }
    return out;
}

/// Keeps as many orders as fit with the minimum spacing.
ThinnedTree thinned_to_fit(TokunagaTree const& tree, double area_m2, double min_spacing_m) {
    constexpr double room = 1.8; // links without a common node keep apart, along a stream too
    int const highest = tree.links.empty() ? 1 : tree.links.front().order;
    for (int lowest = 1;; ++lowest) {
        ThinnedTree out = thinned(tree, lowest);
        if (lowest >= highest || std::sqrt(area_m2 / static_cast<double>(out.links.size())) >= room * min_spacing_m) {
            return out;
        }
    }
}

} // namespace

SettledLinks settle_links(Forest const& forest, std::vector<Vec2> wanted) {
    return Settler(forest, std::move(wanted)).settle();
}

KeptNetwork join_links(Forest const& forest, std::vector<Vec2> const& at, std::vector<std::uint8_t> const& stays) {
    std::size_t const links = at.size();
    std::vector<int> arrivals(links, 0);
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] != 0 && forest.links[i].down >= 0) {
            ++arrivals[forest.links[i].down];
        }
    }
    KeptNetwork kept;
    std::vector<NodeId> node(links);
    std::vector<NodeId> mouth(forest.shares.size());
    std::vector<std::uint8_t> has_mouth(forest.shares.size(), 0);
    struct Course {
        std::vector<Vec2> line; ///< upstream
        std::vector<LinkId> links;
        NodeId to = 0;
    };
    std::vector<Course> open(links); ///< the partial course that has reached the node
    for (std::size_t i = 0; i < links; ++i) {
        if (stays[i] == 0) {
            continue;
        }
        ForestLink const& link = forest.links[i];
        Course course;
        if (link.down >= 0 && arrivals[link.down] == 1) {
            course = std::move(open[link.down]);
        } else if (link.down >= 0) {
            course = {{at[link.down]}, {}, node[link.down]};
        } else {
            if (has_mouth[link.tree] == 0) {
                mouth[link.tree] = kept.network.add_node(forest.shares[link.tree].mouth);
                has_mouth[link.tree] = 1;
            }
            course = {{forest.shares[link.tree].mouth}, {}, mouth[link.tree]};
        }
        course.line.push_back(at[i]);
        course.links.push_back(static_cast<LinkId>(i));
        if (arrivals[i] == 1) {
            open[i] = std::move(course);
            continue;
        }
        node[i] = kept.network.add_node(at[i]);
        std::reverse(course.line.begin(), course.line.end());
        std::reverse(course.links.begin(), course.links.end());
        Arc arc;
        arc.line = std::move(course.line);
        kept.network.add_arc(node[i], course.to, std::move(arc));
        kept.links_of_arc.push_back(std::move(course.links));
    }
    return kept;
}

EmbeddedTree embed_tree(TokunagaTree const& tree, EmbedParams const& params, Run const& run) {
    check(params, tree.links.size());
    EmbeddedTree out;
    double const area = std::fabs(geometry::signed_area(params.region));
    out.spacing_m = std::sqrt(area / static_cast<double>(tree.links.size()));
    ThinnedTree const fits = thinned_to_fit(tree, area, params.min_spacing_m);
    Forest forest;
    forest.links = fits.links;
    forest.shares.push_back({.mouth = {rounded(params.mouth.x), rounded(params.mouth.y)},
                             .far = far_end(params, out.spacing_m),
                             .area_m2 = area,
                             .sample = [&](double width) { return lattice_in(params.region, width); }});
    forest.walls = sides_of(params.region);
    forest.inside = [&](Vec2 p) { return geometry::contains(params.region, p); };
    forest.clearance = params.clearance;
    forest.min_spacing_m = params.min_spacing_m;

    // Of a few starts the one that omits the fewest links; large trees omit few in any.
    constexpr std::uint64_t beginnings = 6;
    constexpr std::size_t large = 5000;
    constexpr double enough = 0.98;
    SettledLinks settled;
    std::int64_t most = -1;
    for (std::uint64_t k = 0; k < beginnings; ++k) {
        forest.seed = k == 0 ? params.seed : random_word(params.seed, embed_stage, k);
        SettledLinks found = settle_links(forest, spread_forest(forest, run));
        std::int64_t const placed = std::count(found.stays.begin(), found.stays.end(), std::uint8_t{1});
        if (placed > most) {
            most = placed;
            settled = std::move(found);
        }
        if (forest.links.size() > large ||
            static_cast<double>(most) >= enough * static_cast<double>(forest.links.size())) {
            break;
        }
    }
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    out.network = std::move(kept.network);
    for (std::vector<LinkId> const& parts : kept.links_of_arc) {
        std::vector<LinkId>& links = out.links_of_arc.emplace_back();
        for (LinkId const part : parts) {
            std::vector<LinkId> const& own = fits.links_of[part];
            links.insert(links.end(), own.rbegin(), own.rend());
        }
        out.placed += static_cast<std::int64_t>(links.size());
    }
    out.dropped = static_cast<std::int64_t>(tree.links.size()) - out.placed;
    return out;
}

std::vector<Vec2> outline(Grid const& grid) {
    return {{grid.west, grid.south()}, {grid.east(), grid.south()}, {grid.east(), grid.north}, {grid.west, grid.north}};
}

} // namespace thalweg::growth
