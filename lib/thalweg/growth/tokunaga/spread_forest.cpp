// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/growth/tokunaga/internal/embed_tree.hpp>

// Described in docs/algorithms/forest_spreading.md.

namespace thalweg::growth {
namespace {

constexpr std::size_t no_link = std::numeric_limits<std::size_t>::max();

// The forest during spreading: the positions of its nodes, and which are active. Nodes are numbered by the links whose
// upper ends they are, followed by the mouths of the trees.
struct ForestLayout {
    explicit ForestLayout(Forest const& wanted)
        : forest(wanted), links(wanted.links.size()), at(links + wanted.shares.size()), up(at.size()),
          below(links, no_link), active(links, 0), spacing_m(links, 1.0) {
        for (std::size_t tree = 0; tree < wanted.shares.size(); ++tree) {
            at[links + tree] = wanted.shares[tree].mouth;
        }
        for (std::size_t link = 0; link < links; ++link) {
            if (wanted.links[link].pinned) {
                at[link] = *wanted.links[link].pinned;
            }
        }
    }

    Forest const& forest;
    std::size_t links;
    std::vector<Vec2> at;                        // [m] by node
    std::vector<std::vector<std::size_t>> up;    // by node: the active links that end there
    std::vector<std::size_t> below;              // by link: the active node at which it ends; no_link: not active yet
    std::vector<std::uint8_t> active;            // by link: whether its node is active
    std::vector<double> tree_spacing_m;          // by tree: square root of its area per active node
    std::vector<double> spacing_m;               // by link: spacing of its tree
    std::vector<std::vector<Vec2>> samples;      // by tree: positions spread evenly over its area
    std::optional<geometry::SegmentGrid> placed; // placed links, by number, then the walls

    bool is_mouth(std::size_t node) const { return node >= links; }
    bool is_pinned(std::size_t node) const { return is_mouth(node) || forest.links[node].pinned.has_value(); }
    Vec2 lower_end(std::size_t link) const { return at[below[link]]; }
    geometry::Segment segment(std::size_t link) const { return {at[below[link]], at[link]}; }

    // The node at which a link ends, active or not.
    std::size_t node_below(std::size_t link) const {
        std::int64_t const down = forest.links[link].down;
        return down < 0 ? links + forest.links[link].tree : static_cast<std::size_t>(down);
    }

    // The lowest of the links that an active link represents.
    std::size_t lowest_link(std::size_t link) const {
        std::size_t lowest = link;
        while (node_below(lowest) != below[link]) {
            lowest = node_below(lowest);
        }
        return lowest;
    }

    // The link that continues the stream upstream of a node; no_link: a source or a fork.
    std::size_t main_above(std::size_t node) const {
        for (std::size_t const link : up[node]) {
            if (up[node].size() == 1 || forest.links[lowest_link(link)].turn == 0) {
                return link;
            }
        }
        return no_link;
    }

    void place(std::size_t link, Vec2 to) {
        at[link] = to;
        placed->add(link, segment(link));
    }

    void move(std::size_t link, Vec2 to) {
        placed->remove(link);
        for (std::size_t const above : up[link]) {
            placed->remove(above);
        }
        place(link, to);
        for (std::size_t const above : up[link]) {
            placed->add(above, segment(above));
        }
    }
};

// Whether a node is new or moves: when moving, it may stay as close to others as it was.
enum class Placement : std::uint8_t { first, move };

// The unit vector; north for (0, 0).
Vec2 direction_of(Vec2 a) {
    double const length = norm(a);
    return length > 0.0 ? Vec2{a.x / length, a.y / length} : Vec2{0.0, 1.0};
}

constexpr std::size_t most_ends = 8; ///< links at a node whose angles are checked; a binary tree has 3

constexpr double cosine_of_20_degrees = 0.9396926;

/// Whether two links from one point enclose at least the minimum angle or, when moving, no less than before.
bool stand_apart(Vec2 a, Vec2 b, Vec2 old_a, Vec2 old_b, Placement placement) {
    double const cosine = dot(a, b);
    double const limit = cosine_of_20_degrees * norm(a) * norm(b);
    return cosine < limit || (placement == Placement::move &&
                              cosine * norm(old_a) * norm(old_b) <= dot(old_a, old_b) * norm(a) * norm(b));
}

/// Whether the angles at a node are wide enough with the node `mover`, itself or a neighbour, at `to`.
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

constexpr double shortest_link = 0.4; ///< relative to the spacing; shorter links do not shrink further

// Slightly more than settle_links requires, so that links allowed here remain placed there.
constexpr double clearance_margin = 1.1;
constexpr double spacing_margin = 1.05;
/// relative to the spacing: this many links could not keep a larger distance
constexpr double most_bound_spacing = 0.5;

/// The required distance of a link from another; both lengths in metres.
double distance_needed(ForestLayout const& layout, std::size_t link, double length, double other) {
    double const spacing = layout.spacing_m[link];
    return std::max(clearance_margin * layout.forest.clearance * std::min({length, other, spacing}),
                    std::min(spacing_margin * layout.forest.min_spacing_m, most_bound_spacing * spacing));
}

constexpr double same_place_squared = 1e-18; ///< relative to the spacing, squared
// A trunk leaves its mouth through a wall: its upper end keeps a tenth of the clearance from it. Squared.
constexpr double at_mouth_squared = 0.01;

/// Whether a link may run along `wanted` after the node `mover`, one of its ends, has moved.
bool keeps_clear(ForestLayout const& layout, std::size_t link, geometry::Segment const& wanted, std::size_t mover,
                 Placement placement) {
    double const length = distance(wanted.a, wanted.b);
    double const spacing = layout.spacing_m[link];
    geometry::Segment const now = placement == Placement::move ? layout.segment(link) : wanted;
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
        geometry::Segment const& there = (*layout.placed)[other];
        bool const is_wall = other >= layout.links;
        if (is_wall) {
            bool const at_mouth = layout.is_mouth(lower) && geometry::squared_distance(layout.at[lower], there) <
                                                                same_place_squared * spacing * spacing;
            if (at_mouth) {
                return geometry::squared_distance(wanted.b, there) > at_mouth_squared * margin * margin &&
                       layout.forest.inside(wanted.b);
            }
        } else if (is_neighbour(other)) {
            return true; // their angle is checked instead
        }
        double const squared = geometry::squared_distance(wanted, there);
        double const need = is_wall ? margin : distance_needed(layout, link, length, distance(there.a, there.b));
        return squared >= need * need ||
               (placement == Placement::move && squared > 0.0 && squared >= geometry::squared_distance(now, there));
    });
}

// Whether the node of a link may lie at `to`: its links keep the clearance from all but their neighbours, and those
// with a common node enclose at least 20 degrees.
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

// Nine samples per node, so that a centroid is known to about a tenth of the spacing.
constexpr double samples_a_spacing = 3.0;

// Distances at which a new source is tried: first at this share of the spacing, then reduced by the factor, on either
// side of the course.
constexpr double first_reach = 0.75;
constexpr double reach_factor = 0.7;
constexpr int reaches = 24; ///< the last is 0.0002 of the spacing

/// A direction by the cosine and sine of its angle with the course, upstream.
struct Heading {
    double cosine;
    double sine;
};
/// 50, 35, 65, 80, 20, 100 and 120 degrees, the likely ones first: tributaries enter at about 50 degrees, forks
/// separate by 35.
constexpr std::array<Heading, 7> headings = {{{0.6428, 0.7660},
                                              {0.8192, 0.5736},
                                              {0.4226, 0.9063},
                                              {0.1736, 0.9848},
                                              {0.9397, 0.3420},
                                              {-0.1736, 0.9848},
                                              {-0.5, 0.8660}}};

/// Turned left by the angle of a heading.
Vec2 turned_by(Vec2 a, double cosine, double sine) {
    return {cosine * a.x - sine * a.y, sine * a.x + cosine * a.y};
}

/// Activates the nodes of streams of at least an order (confluences of two such streams, and their sources), and links
/// them.
/// \return number of active nodes, by tree
std::vector<std::size_t> activate(ForestLayout& layout, int order) {
    Forest const& forest = layout.forest;
    std::vector<std::uint8_t> runs(layout.links, 0); // the link belongs to an existing stream
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

/// Draws samples of every tree's area, with the density required by its nodes.
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

/// An index over the area of all trees, with the walls only.
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
    std::vector<geometry::Segment> const& walls = layout.forest.walls;
    layout.placed.emplace(low, high, cell_m, layout.links + walls.size());
    for (std::size_t k = 0; k < walls.size(); ++k) {
        layout.placed->add(layout.links + k, walls[k]);
    }
}

/// Places the new nodes of existing streams at equal distances.
/// \return by link: whether it was placed
std::vector<std::uint8_t> divide_old_links(ForestLayout& layout, std::vector<std::uint8_t> const& was_active) {
    std::vector<std::uint8_t> divided(layout.links, 0);
    std::vector<std::size_t> chain; // new nodes between two existing ones
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

/// The direction of the stream through a node, upstream, from the placed links.
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

/// Finds an initial position for a new stream's source.
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
    layout.place(i, layout.at[node] + length * ahead); // settle_links relocates or omits it
}

// Activates the streams of an order: nodes on existing streams are placed at equal distances, sources of new ones near
// the nodes they drain to.
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

constexpr std::uint64_t spread_stage = 0x737072656164; // "spread"

// All lengths are relative to the spacing.
constexpr double weight_of_middles = 0.6;  ///< weight of a link's midpoint relative to a node
constexpr double over_relaxation = 1.5;    ///< beyond the centroid: reduces the number of sweeps compared with 1
constexpr double straightening = 0.25;     ///< share of the distance to the midpoint of the neighbours along the stream
constexpr double branches_upstream = 0.25; ///< per unit that the cosine with the course lacks
constexpr double forks_upstream = 0.15;    ///< the same for the node at a fork
constexpr double widest_branch_cosine = 0.6;         ///< 53 degrees: wider branches are turned upstream
constexpr double shaken_share_of_sweeps = 1.0 / 3.0; ///< nodes are shaken early, to escape poor layouts
constexpr double shake = 0.12;
constexpr double longest_step = 0.3; ///< longer ones would often cross another link
constexpr int attempts = 3;          ///< a step that does not fit is shortened
constexpr double shortening = 0.4;

/// By site: vector to the centroid of the samples nearest to it (Lloyd 1982); 0 for a site without samples.
std::vector<Vec2> vectors_to_centroids(std::vector<Vec2> const& sites, double spacing_m,
                                       std::vector<Vec2> const& samples) {
    constexpr double cell = 0.7; // relative to the spacing: two sites per node
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

/// Adds the pull of a tree's samples on its nodes and on their links.
void pull_to_centres(ForestLayout const& layout, std::size_t tree, std::vector<Vec2>& pull) {
    std::vector<std::size_t> owners;
    std::vector<Vec2> sites; // for each owner its node and the midpoint of its link
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
    std::vector<Vec2> const way = vectors_to_centroids(sites, layout.tree_spacing_m[tree], layout.samples[tree]);
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

/// The vector towards a straight course.
Vec2 straighten(ForestLayout const& layout, std::size_t i) {
    std::size_t const above = layout.main_above(i);
    if (above == no_link) {
        return {};
    }
    return straightening * (0.5 * (layout.at[above] + layout.lower_end(i)) - layout.at[i]);
}

/// The vector that makes side branches and forks point upstream.
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

/// Takes the step, or the longest shortened one that fits, if any.
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

// Moves every free node once: towards the centroids of the samples nearest to it and to its links, towards a straight
// course, tributaries upstream, and randomly in the first sweeps. progress: [0, 1) of the sweeps of this order.
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

// Sweeps per order. The lowest order has most of the links and comes last; no other stream depends on its courses.
constexpr int sweeps_of_an_order = 60;
constexpr int sweeps_of_the_last = 40;

int highest_order(Forest const& forest) {
    int highest = 1;
    for (ForestLink const& link : forest.links) {
        highest = std::max(highest, link.order);
    }
    return highest;
}

} // namespace

std::vector<Vec2> spread_forest(Forest const& forest, Run const& run) {
    ForestLayout layout(forest);
    for (int order = highest_order(forest); order >= 1; --order) {
        admit_streams(layout, order);
        int const sweeps = order == 1 ? sweeps_of_the_last : sweeps_of_an_order;
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            run.check();
            relax_nodes(layout, order, sweep, static_cast<double>(sweep) / sweeps);
        }
    }
    layout.at.resize(layout.links);
    return std::move(layout.at);
}

} // namespace thalweg::growth
