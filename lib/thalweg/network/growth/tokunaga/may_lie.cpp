// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/forest_layout.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace thalweg::network {

namespace {

constexpr double cosine_of_20_degrees = 0.9396926;
// A little more than settle_links asks for, so that what is allowed here also stays there.
constexpr double clearance_margin = 1.1;
constexpr double spacing_margin = 1.05;
constexpr double most_bound_spacing = 0.5;   ///< of the spacing: a wider bound could not be kept by so many links
constexpr double shortest_link = 0.4;        ///< of the spacing: shorter ones do not shrink further
constexpr double same_place_squared = 1e-18; ///< of the spacing, squared
// A trunk leaves its mouth through a wall: its upper end keeps a tenth of the clearance from that. Squared.
constexpr double at_mouth_squared = 0.01;
constexpr std::size_t most_ends = 8; ///< links in a node whose angles are looked at; in a binary tree there are 3

/// How far a link must keep from another; both lengths in metres.
double distance_needed(ForestLayout const& layout, std::size_t link, double length, double other) {
    double const spacing = layout.spacing_m[link];
    return std::max(clearance_margin * layout.forest.clearance * std::min({length, other, spacing}),
                    std::min(spacing_margin * layout.forest.min_spacing_m, most_bound_spacing * spacing));
}

/// Whether a link may run along `wanted` once the node `mover`, one of its ends, has moved.
bool keeps_clear(ForestLayout const& layout, std::size_t link, Segment const& wanted, std::size_t mover,
                 Placement placement) {
    double const length = distance(wanted.a, wanted.b);
    double const spacing = layout.spacing_m[link];
    Segment const now = placement == Placement::move ? layout.segment(link) : wanted;
    if (placement == Placement::move && length < shortest_link * spacing && length < distance(now.a, now.b)) {
        return false;
    }
    double const margin = distance_needed(layout, link, length, std::numeric_limits<double>::infinity());
    std::size_t const lower = layout.below[link];
    auto const is_neighbour = [&](std::size_t other) {
        std::size_t const below = layout.below[other];
        return other == lower || below == lower || below == link || other == mover || below == mover;
    };
    return layout.placed->near(wanted, margin, [&](std::size_t other) {
        if (other == link) {
            return true;
        }
        Segment const& there = (*layout.placed)[other];
        bool const is_wall = other >= layout.links;
        if (is_wall) {
            bool const at_mouth = layout.is_mouth(lower) &&
                                  squared_distance(layout.at[lower], there) < same_place_squared * spacing * spacing;
            if (at_mouth) {
                return squared_distance(wanted.b, there) > at_mouth_squared * margin * margin &&
                       layout.forest.inside(wanted.b);
            }
        } else if (is_neighbour(other)) {
            return true; // their angle counts
        }
        double const squared = squared_distance(wanted, there);
        double const need = is_wall ? margin : distance_needed(layout, link, length, distance(there.a, there.b));
        return squared >= need * need ||
               (placement == Placement::move && squared > 0.0 && squared >= squared_distance(now, there));
    });
}

/// Whether two links that leave one place enclose the least angle, or, where they move, no less than before.
bool stand_apart(Vec2 a, Vec2 b, Vec2 old_a, Vec2 old_b, Placement placement) {
    double const cosine = dot(a, b);
    double const limit = cosine_of_20_degrees * norm(a) * norm(b);
    return cosine < limit || (placement == Placement::move &&
                              cosine * norm(old_a) * norm(old_b) <= dot(old_a, old_b) * norm(a) * norm(b));
}

/// Whether the angles in a node are wide enough when the node `mover`, it or one beside it, lies at `to`.
bool angles_fit(ForestLayout const& layout, std::size_t node, std::size_t mover, Vec2 to, Placement placement) {
    std::array<std::size_t, most_ends> ends{};
    std::size_t count = 0;
    if (!layout.is_mouth(node)) {
        ends[count++] = layout.below[node];
    }
    for (std::size_t const link : layout.up[node]) {
        if ((layout.placed->holds(link) || link == mover) && count < ends.size()) {
            ends[count++] = link;
        }
    }
    auto const place_of = [&](std::size_t n) { return n == mover ? to : layout.at[n]; };
    Vec2 const here = place_of(node);
    Vec2 const here_now = layout.at[node];
    for (std::size_t k = 0; k < count; ++k) {
        for (std::size_t m = k + 1; m < count; ++m) {
            if (!stand_apart(place_of(ends[k]) - here, place_of(ends[m]) - here, layout.at[ends[k]] - here_now,
                             layout.at[ends[m]] - here_now, placement)) {
                return false;
            }
        }
    }
    return true;
}

} // namespace

bool may_lie(ForestLayout const& layout, std::size_t link, Vec2 to, Placement placement) {
    auto const all_above = [&](auto const& fits) {
        return std::all_of(layout.up[link].begin(), layout.up[link].end(),
                           [&](std::size_t above) { return !layout.placed->holds(above) || fits(above); });
    };
    return angles_fit(layout, layout.below[link], link, to, placement) &&
           angles_fit(layout, link, link, to, placement) &&
           all_above([&](std::size_t above) { return angles_fit(layout, above, link, to, placement); }) &&
           keeps_clear(layout, link, {layout.lower_end(link), to}, link, placement) &&
           all_above([&](std::size_t above) {
               return keeps_clear(layout, above, {to, layout.at[above]}, link, placement);
           });
}

} // namespace thalweg::network
