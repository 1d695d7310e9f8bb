// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/forest_layout.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::network {

namespace {

// Nine samples a node, so that a centre is known to about a tenth of the spacing.
constexpr double samples_a_spacing = 3.0;

// Where a new source is tried: first at this share of the spacing, then nearer by the factor, on either side of the
// course.
constexpr double first_reach = 0.75;
constexpr double reach_factor = 0.7;
constexpr int reaches = 24; ///< the last is 0.0002 of the spacing

/// A direction by the cosine and sine of its angle with the course, upstream.
struct Heading {
    double cosine;
    double sine;
};
/// 50, 35, 65, 80, 20, 100 and 120 degrees, the likely ones first: tributaries enter at about 50 degrees, forks part
/// by 35.
constexpr std::array<Heading, 7> headings = {{{0.6428, 0.7660},
                                              {0.8192, 0.5736},
                                              {0.4226, 0.9063},
                                              {0.1736, 0.9848},
                                              {0.9397, 0.3420},
                                              {-0.1736, 0.9848},
                                              {-0.5, 0.8660}}};

/// Turned to the left by the angle of a heading.
Vec2 turned_by(Vec2 a, double cosine, double sine) {
    return {cosine * a.x - sine * a.y, sine * a.x + cosine * a.y};
}

/// Marks the nodes that take part, links them, and gives the number of them by tree.
/// Of a stream those take part in which another stream of this order or higher enters, and its source.
std::vector<std::size_t> activate(ForestLayout& layout, int order) {
    Forest const& forest = layout.forest;
    std::vector<std::uint8_t> runs(layout.links, 0); // the link is part of a stream that is there
    std::vector<int> arrivals(layout.at.size(), 0);
    for (std::size_t i = 0; i < layout.links; ++i) {
        if (forest.links[i].order >= order || layout.is_pinned(i)) {
            runs[i] = 1;
            ++arrivals[layout.node_below(i)];
        }
    }
    for (auto& up : layout.up) {
        up.clear();
    }
    std::vector<std::size_t> count(forest.shares.size(), 0);
    for (std::size_t i = 0; i < layout.links; ++i) {
        layout.active[i] = runs[i] != 0 && (layout.is_pinned(i) || arrivals[i] != 1) ? 1 : 0;
        std::size_t const node = layout.node_below(i);
        layout.below[i] = layout.is_mouth(node) || layout.active[node] != 0 ? node : layout.below[node];
        if (layout.active[i] != 0) {
            layout.up[layout.below[i]].push_back(i);
            ++count[forest.links[i].tree];
        }
    }
    return count;
}

/// Draws samples of every tree's land, as dense as its nodes ask for.
void sample_lands(ForestLayout& layout, std::vector<std::size_t> const& nodes) {
    std::vector<ForestShare> const& shares = layout.forest.shares;
    layout.tree_spacing_m.resize(shares.size());
    layout.samples.resize(shares.size());
    for (std::size_t t = 0; t < shares.size(); ++t) {
        double const spacing = std::sqrt(shares[t].area_m2 / static_cast<double>(std::max<std::size_t>(nodes[t], 1)));
        layout.tree_spacing_m[t] = spacing;
        layout.samples[t] = shares[t].sample(spacing / samples_a_spacing);
    }
    for (std::size_t i = 0; i < layout.links; ++i) {
        layout.spacing_m[i] = layout.tree_spacing_m[layout.forest.links[i].tree];
    }
}

/// An index over the land of all trees that holds the walls alone.
void begin_index(ForestLayout& layout) {
    Vec2 low = layout.at[layout.links];
    Vec2 high = low;
    for (auto const& samples : layout.samples) {
        for (Vec2 const p : samples) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }
    double const cell_m = *std::min_element(layout.tree_spacing_m.begin(), layout.tree_spacing_m.end());
    std::vector<Segment> const& walls = layout.forest.walls;
    layout.placed.emplace(low, high, cell_m, layout.links + walls.size());
    for (std::size_t k = 0; k < walls.size(); ++k) {
        layout.placed->add(layout.links + k, walls[k]);
    }
}

/// Sets the new nodes of old streams at equal distances. Gives: by link whether it was set.
std::vector<std::uint8_t> divide_old_links(ForestLayout& layout, std::vector<std::uint8_t> const& was_active) {
    std::vector<std::uint8_t> divided(layout.links, 0);
    std::vector<std::size_t> chain; // new nodes between two old ones
    for (std::size_t i = 0; i < layout.links; ++i) {
        if (was_active[i] == 0) {
            continue;
        }
        chain.clear();
        std::size_t node = layout.below[i];
        while (!layout.is_mouth(node) && was_active[node] == 0) {
            chain.push_back(node);
            node = layout.below[node];
        }
        for (std::size_t k = 0; k < chain.size(); ++k) {
            double const share = static_cast<double>(k + 1) / static_cast<double>(chain.size() + 1);
            if (!layout.is_pinned(chain[k])) {
                layout.at[chain[k]] = layout.at[i] + share * (layout.at[node] - layout.at[i]);
                divided[chain[k]] = 1;
            }
        }
    }
    return divided;
}

/// The direction of the stream through a node, upstream, as the links say that have a place.
Vec2 course_so_far(ForestLayout const& layout, std::size_t node) {
    Vec2 sum = layout.is_mouth(node) ? direction_of(layout.forest.shares[node - layout.links].far - layout.at[node])
                                     : direction_of(layout.at[node] - layout.lower_end(node));
    for (std::size_t const link : layout.up[node]) {
        if (layout.placed->holds(link) && layout.forest.links[link].turn == 0) {
            sum = sum + direction_of(layout.at[link] - layout.at[node]);
        }
    }
    return direction_of(sum);
}

/// Finds a first place for a new stream's source.
void place_source(ForestLayout& layout, std::size_t i) {
    std::size_t const node = layout.below[i];
    if (layout.is_mouth(node)) {
        layout.place(i, layout.forest.shares[node - layout.links].far);
        return;
    }
    Vec2 const ahead = course_so_far(layout, node);
    int const turn = layout.forest.links[layout.lowest_link(i)].turn;
    bool const fork = turn == 1 || turn == -1;
    std::array<double, 2> const sides = turn > 0 ? std::array{1.0, -1.0} : std::array{-1.0, 1.0};
    double length = first_reach * layout.spacing_m[i];
    for (int reach = 0; reach < reaches; ++reach, length *= reach_factor) {
        for (double const side : sides) {
            for (std::size_t k = 0; k < headings.size(); ++k) {
                Heading const h = headings[fork && k < 2 ? 1 - k : k];
                Vec2 const to = layout.at[node] + length * turned_by(ahead, h.cosine, side * h.sine);
                if (may_lie(layout, i, to, Placement::first)) {
                    layout.place(i, to);
                    return;
                }
            }
        }
    }
    layout.place(i, layout.at[node] + length * ahead); // settle_links finds it another place or leaves it out
}

} // namespace

void admit_streams(ForestLayout& layout, int order) {
    std::vector<std::uint8_t> const was_active = layout.active;
    sample_lands(layout, activate(layout, order));
    std::vector<std::uint8_t> const divided = divide_old_links(layout, was_active);
    begin_index(layout);
    for (std::size_t i = 0; i < layout.links; ++i) {
        bool const has_place = was_active[i] != 0 || divided[i] != 0 || layout.is_pinned(i);
        if (layout.active[i] != 0 && has_place) {
            layout.placed->add(i, layout.segment(i));
        }
    }
    for (std::size_t i = 0; i < layout.links; ++i) {
        if (layout.active[i] != 0 && !layout.placed->holds(i)) {
            place_source(layout, i);
        }
    }
}

} // namespace thalweg::network
