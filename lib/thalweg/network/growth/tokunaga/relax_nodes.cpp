// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/forest_layout.hpp>

#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t spread_stage = 0x737072656164; // "spread"

// All lengths are shares of the spacing.
constexpr double weight_of_middles = 0.6;    ///< the middle of a link draws as a node does, by this weight
constexpr double over_relaxation = 1.5;      ///< beyond the centre: fewer sweeps are needed than with 1
constexpr double straightening = 0.25;       ///< of the way to the middle between the neighbours along the stream
constexpr double branches_upstream = 0.25;   ///< for each 1 that the cosine with the course lacks
constexpr double forks_upstream = 0.15;      ///< the same for the node in which streams part
constexpr double widest_branch_cosine = 0.6; ///< 53 degrees: a branch that stands wider is turned upstream
constexpr double shaken_share_of_sweeps = 1.0 / 3.0; ///< nodes are shaken early, so as not to rest in a poor layout
constexpr double shake = 0.12;
constexpr double longest_step = 0.3; ///< longer ones would often cross another link
constexpr int attempts = 3;          ///< a step that does not fit is shortened
constexpr double shortening = 0.4;

/// By site the way to the centre of the samples nearest to it (Lloyd 1982); none for a site without samples.
std::vector<Vec2> ways_to_centres(std::vector<Vec2> const& sites, double spacing_m, std::vector<Vec2> const& samples) {
    constexpr double cell = 0.7; // of the spacing: two sites a node
    geometry::PointGrid const grid(sites, cell * spacing_m);
    std::vector<Vec2> sum(sites.size());
    std::vector<double> count(sites.size(), 0.0);
    for (Vec2 const p : samples) {
        std::size_t const site = grid.nearest(p);
        sum[site] = sum[site] + p;
        count[site] += 1.0;
    }
    std::vector<Vec2> ways(sites.size());
    for (std::size_t s = 0; s < sites.size(); ++s) {
        if (count[s] > 0.0) {
            ways[s] = (1.0 / count[s]) * sum[s] - sites[s];
        }
    }
    return ways;
}

/// Adds to the pull on each node of a tree what its own places and those of its links ask for.
void pull_to_centres(ForestLayout const& layout, std::size_t tree, std::vector<Vec2>& pull) {
    std::vector<std::size_t> owners;
    std::vector<Vec2> sites; // of each owner its node and the middle of its link
    for (std::size_t i = 0; i < layout.links; ++i) {
        if (layout.active[i] != 0 && layout.forest.links[i].tree == tree) {
            owners.push_back(i);
            sites.push_back(layout.at[i]);
            sites.push_back(0.5 * (layout.at[i] + layout.lower_end(i)));
        }
    }
    if (sites.empty() || layout.samples[tree].empty()) {
        return;
    }
    std::vector<Vec2> const way = ways_to_centres(sites, layout.tree_spacing_m[tree], layout.samples[tree]);
    std::vector<double> weight(layout.links, 0.0);
    for (std::size_t k = 0; k < owners.size(); ++k) {
        std::size_t const i = owners[k];
        Vec2 const of_middle = weight_of_middles * way[2 * k + 1];
        pull[i] = pull[i] + way[2 * k] + of_middle;
        weight[i] += 1.0 + weight_of_middles;
        std::size_t const lower = layout.below[i];
        if (!layout.is_mouth(lower)) {
            pull[lower] = pull[lower] + of_middle;
            weight[lower] += weight_of_middles;
        }
    }
    for (std::size_t const i : owners) {
        pull[i] = (over_relaxation / weight[i]) * pull[i];
    }
}

/// The direction of the stream through a node, upstream.
Vec2 course_through(ForestLayout const& layout, std::size_t node) {
    Vec2 const below = direction_of(layout.at[node] - layout.lower_end(node));
    std::size_t const main = layout.main_above(node);
    return main == no_link ? below : direction_of(below + direction_of(layout.at[main] - layout.at[node]));
}

/// Towards a course without bends.
Vec2 straighten(ForestLayout const& layout, std::size_t i) {
    std::size_t const above = layout.main_above(i);
    if (above == no_link) {
        return {};
    }
    return straightening * (0.5 * (layout.at[above] + layout.lower_end(i)) - layout.at[i]);
}

/// Makes side branches and forks point upstream.
Vec2 turn_upstream(ForestLayout const& layout, std::size_t i) {
    Vec2 sum{};
    double const spacing = layout.spacing_m[i];
    std::size_t const node = layout.below[i];
    if (!layout.is_mouth(node) && layout.main_above(node) != i) {
        Vec2 const ahead = course_through(layout, node);
        double const cosine = dot(direction_of(layout.at[i] - layout.at[node]), ahead);
        if (cosine < widest_branch_cosine) {
            sum = sum + (branches_upstream * spacing * (widest_branch_cosine - cosine)) * ahead;
        }
    }
    if (layout.up[i].size() > 1) {
        Vec2 const ahead = course_through(layout, i);
        std::size_t const main = layout.main_above(i);
        for (std::size_t const above : layout.up[i]) {
            double const cosine = dot(direction_of(layout.at[above] - layout.at[i]), ahead);
            if (above != main && cosine < widest_branch_cosine) {
                sum = sum - (forks_upstream * spacing * (widest_branch_cosine - cosine)) * ahead;
            }
        }
    }
    return sum;
}

/// A random step, uniform in a square.
Vec2 shaken(ForestLayout const& layout, int order, int sweep, std::size_t i) {
    auto const words = random_block(layout.forest.seed, spread_stage, static_cast<std::uint64_t>(order) << 32 | i,
                                    static_cast<std::uint64_t>(sweep));
    double const reach = shake * layout.spacing_m[i];
    return {reach * (2.0 * thalweg::unit(words[0]) - 1.0), reach * (2.0 * thalweg::unit(words[1]) - 1.0)};
}

/// Takes the step, or the longest of some shorter ones that fits, if any.
void try_step(ForestLayout& layout, std::size_t i, Vec2 step) {
    double const length = norm(step);
    double const longest = longest_step * layout.spacing_m[i];
    if (length > longest) {
        step = (longest / length) * step;
    }
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (may_lie(layout, i, layout.at[i] + step, Placement::move)) {
            layout.move(i, layout.at[i] + step);
            return;
        }
        step = shortening * step;
    }
}

} // namespace

void relax_nodes(ForestLayout& layout, int order, int sweep, double progress) {
    std::vector<Vec2> pull(layout.links);
    for (std::size_t tree = 0; tree < layout.forest.shares.size(); ++tree) {
        pull_to_centres(layout, tree, pull);
    }
    for (std::size_t i = 0; i < layout.links; ++i) {
        if (layout.active[i] == 0 || layout.is_pinned(i)) {
            continue;
        }
        Vec2 step = pull[i] + straighten(layout, i) + turn_upstream(layout, i);
        if (progress < shaken_share_of_sweeps) {
            step = step + shaken(layout, order, sweep, i);
        }
        try_step(layout, i, step);
    }
}

} // namespace thalweg::network
