// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/grow_strokes.hpp>

#include <thalweg/core/chance.hpp>
#include <thalweg/core/error.hpp>
#include <thalweg/geometry/segments_near.hpp>
#include <thalweg/network/embed_tree.hpp>
#include <thalweg/network/join_links.hpp>
#include <thalweg/network/join_strokes.hpp>
#include <thalweg/network/polygon.hpp>
#include <thalweg/network/settle_links.hpp>
#include <thalweg/network/spread_forest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace thalweg::network {

namespace {

constexpr std::uint64_t stage = 0x7374726f6b65; // "stroke"

void check(StrokesParams const& params) {
    if (params.max_depth < 1 || params.max_depth > 29) {
        throw BadParameter(
            fmt::format("network.grow_strokes: max_depth is {}, it must lie in [1, 29]", params.max_depth));
    }
    if (!(params.reach > 0.0 && params.reach <= 2.0)) {
        throw BadParameter(fmt::format("network.grow_strokes: reach is {}, it must lie in (0, 2]", params.reach));
    }
    if (!(params.clearance >= 0.05 && params.clearance <= 0.35)) {
        throw BadParameter(
            fmt::format("network.grow_strokes: clearance is {}, it must lie in [0.05, 0.35]", params.clearance));
    }
    if (!(params.min_spacing_m >= 0.0) || !std::isfinite(params.min_spacing_m)) {
        throw BadParameter(
            fmt::format("network.grow_strokes: min_spacing_m is {}, it must be at least 0", params.min_spacing_m));
    }
}

double distance_to(Stroke const& stroke, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
        least = std::min(least, distance(p, geometry::foot_on(stroke.line[i], stroke.line[i + 1], p).at));
    }
    return least;
}

/// The land of every stroke: what lies nearer to it than to others, measured by their lengths, and within its reach.
class Lands {
public:
    Lands(std::vector<Stroke> const& strokes, Grid const& grid, double reach)
        : strokes_(strokes), grid_(grid), reach_(reach) {}

    std::vector<Vec2> sample(std::size_t stroke, double width_m) const {
        double const far = reach_m(stroke);
        Vec2 low = strokes_[stroke].line.front();
        Vec2 high = low;
        for (Vec2 const p : strokes_[stroke].line) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        low = {std::max(low.x - far, grid_.west), std::max(low.y - far, grid_.south())};
        high = {std::min(high.x + far, grid_.east()), std::min(high.y + far, grid_.north)};
        std::vector<Vec2> places;
        for (double y = low.y + 0.5 * width_m; y < high.y; y += width_m) {
            for (double x = low.x + 0.5 * width_m; x < high.x; x += width_m) {
                if (belongs(stroke, {x, y})) {
                    places.push_back({x, y});
                }
            }
        }
        return places;
    }

    double area_m2(std::size_t stroke) const {
        double const width = reach_m(stroke) / 24.0;
        return std::max(1.0, static_cast<double>(sample(stroke, width).size())) * width * width;
    }

private:
    double reach_m(std::size_t stroke) const { return reach_ * strokes_[stroke].way.back(); }

    bool belongs(std::size_t stroke, Vec2 p) const {
        double const own = distance_to(strokes_[stroke], p) / reach_m(stroke);
        if (!(own < 1.0)) {
            return false;
        }
        for (std::size_t k = 0; k < strokes_.size(); ++k) {
            if (k == stroke) {
                continue;
            }
            double const other = distance_to(strokes_[k], p) / reach_m(k);
            if (other < own || (other == own && k < stroke)) {
                return false;
            }
        }
        return true;
    }

    std::vector<Stroke> const& strokes_;
    Grid const& grid_;
    double reach_;
};

/// Strokes so that each comes after the one on which it begins.
std::vector<std::size_t> downstream_first(std::vector<Stroke> const& strokes) {
    std::vector<std::size_t> turn;
    std::vector<std::uint8_t> done(strokes.size(), 0);
    while (turn.size() < strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (done[k] == 0 && (strokes[k].onto < 0 || done[static_cast<std::size_t>(strokes[k].onto)] != 0)) {
                done[k] = 1;
                turn.push_back(k);
            }
        }
    }
    return turn;
}

/// Another stroke's beginning on a trunk.
struct Junction {
    double way_m;
    std::size_t stroke;
};

/// Ways of a trunk's own nodes, evenly between the junctions, the last where it forks.
std::vector<double> ways_of_trunk(std::size_t nodes, double length_m, std::vector<Junction> const& junctions) {
    double fork = length_m * static_cast<double>(nodes) / static_cast<double>(nodes + 1);
    if (!junctions.empty() && junctions.back().way_m >= fork) {
        fork = 0.5 * (junctions.back().way_m + length_m);
    }
    std::vector<double> fixed{0.0};
    for (Junction const& j : junctions) {
        fixed.push_back(j.way_m);
    }
    fixed.push_back(fork);
    std::vector<std::size_t> count(fixed.size() - 1, 0);
    std::vector<std::size_t> part(nodes - 1);
    for (std::size_t i = 0; i + 1 < nodes; ++i) {
        double const nominal = fork * static_cast<double>(i + 1) / static_cast<double>(nodes);
        while (part[i] + 1 < count.size() && fixed[part[i] + 1] <= nominal) {
            ++part[i];
        }
        ++count[part[i]];
    }
    std::vector<double> ways;
    std::size_t in_part = 0;
    for (std::size_t i = 0; i + 1 < nodes; ++i) {
        in_part = i > 0 && part[i] == part[i - 1] ? in_part + 1 : 1;
        double const share = static_cast<double>(in_part) / static_cast<double>(count[part[i]] + 1);
        ways.push_back(fixed[part[i]] + share * (fixed[part[i] + 1] - fixed[part[i]]));
    }
    ways.push_back(fork);
    return ways;
}

/// Links of the stream that runs from the mouth to the fork, by number.
std::vector<std::size_t> trunk_of(TokunagaTree const& tree) {
    std::vector<std::size_t> trunk;
    std::int64_t link = 0;
    while (link >= 0) {
        TreeLink const& here = tree.links[static_cast<std::size_t>(link)];
        trunk.push_back(static_cast<std::size_t>(link));
        std::int64_t const next = here.up[0];
        link = next >= 0 && tree.links[static_cast<std::size_t>(next)].order == here.order ? next : -1;
    }
    return trunk;
}

class Planting {
public:
    Planting(std::vector<Stroke> const& strokes, RiverLines const& drawn, Grid const& grid, StrokesParams const& params)
        : strokes_(strokes), drawn_(drawn), grid_(grid), params_(params), joints_(strokes.size(), -1),
          junctions_(strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (strokes[k].onto >= 0) {
                junctions_[static_cast<std::size_t>(strokes[k].onto)].push_back({strokes[k].onto_way_m, k});
            }
        }
        for (auto& list : junctions_) {
            std::sort(list.begin(), list.end(), [](Junction const& a, Junction const& b) { return a.way_m < b.way_m; });
        }
    }

    void plant(std::size_t stroke, Run const& run) {
        TokunagaParams params = params_.tree;
        params.seed = chance(params_.tree.seed, stage, stroke);
        params.generator = drawn_.lines[stroke].lambda > 0 ? drawn_.lines[stroke].lambda : params.generator;
        params.order = depth_of(stroke) + 1;
        TokunagaTree const tree = grow_tokunaga(params, run);
        std::vector<std::size_t> const trunk = trunk_of(tree);
        std::vector<double> const ways = ways_of_trunk(trunk.size(), strokes_[stroke].way.back(), junctions_[stroke]);

        std::vector<std::int64_t> number(tree.links.size(), -1); // of its links in the forest
        std::int64_t below = joints_[stroke];
        int turn = below < 0 ? 0 : side_of(stroke);
        std::size_t joined = 0;
        for (std::size_t i = 0; i < trunk.size(); ++i) {
            for (; joined < junctions_[stroke].size() && junctions_[stroke][joined].way_m < ways[i]; ++joined) {
                Junction const& junction = junctions_[stroke][joined];
                below =
                    add(below, tree.links[trunk[i]].order, turn, stroke, place_at(strokes_[stroke], junction.way_m));
                joints_[junction.stroke] = below;
                turn = 0;
            }
            below = add(below, tree.links[trunk[i]].order, turn, stroke, place_at(strokes_[stroke], ways[i]));
            number[trunk[i]] = below;
            turn = 0;
        }
        for (std::size_t i = 0; i < tree.links.size(); ++i) {
            TreeLink const& link = tree.links[i];
            if (number[i] < 0) {
                number[i] = add(number[static_cast<std::size_t>(link.down)], link.order, link.turn, stroke, {});
            }
        }
    }

    /// A river is of no lower order than those that flow into it.
    std::vector<ForestLink> take() {
        for (std::size_t i = links_.size(); i-- > 0;) {
            if (links_[i].down >= 0) {
                int& order = links_[static_cast<std::size_t>(links_[i].down)].order;
                order = std::max(order, links_[i].order);
            }
        }
        return std::move(links_);
    }

private:
    int depth_of(std::size_t stroke) const {
        double const width = grid_.east() - grid_.west;
        double const depth = std::floor(strokes_[stroke].way.back() / width * params_.max_depth + 0.5);
        return static_cast<int>(std::clamp(depth, 1.0, static_cast<double>(params_.max_depth)));
    }

    /// The bank from which a stroke joins another, as TreeLink::turn has it.
    int side_of(std::size_t stroke) const {
        Stroke const& own = strokes_[stroke];
        Stroke const& onto = strokes_[static_cast<std::size_t>(own.onto)];
        Vec2 const a = place_at(onto, own.onto_way_m);
        Vec2 const b = place_at(onto, own.onto_way_m + 0.01 * onto.way.back());
        Vec2 const c = own.line[1];
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0 ? 2 : -2;
    }

    std::int64_t add(std::int64_t down, int order, int turn, std::size_t tree, std::optional<Vec2> pinned) {
        links_.push_back({.down = down, .order = order, .turn = turn, .tree = tree, .pinned = pinned});
        return static_cast<std::int64_t>(links_.size()) - 1;
    }

    std::vector<Stroke> const& strokes_;
    RiverLines const& drawn_;
    Grid const& grid_;
    StrokesParams const& params_;
    std::vector<ForestLink> links_;
    std::vector<std::int64_t> joints_; ///< by stroke: the link into which it flows, -1 for its own mouth
    std::vector<std::vector<Junction>> junctions_;
};

} // namespace

GrownStrokes grow_strokes(RiverLines const& drawn, Grid const& grid, StrokesParams const& params, Run const& run) {
    check(params);
    std::vector<Stroke> const strokes = join_strokes(drawn, grid, run);
    GrownStrokes grown;
    if (strokes.empty()) {
        return grown;
    }
    Planting planting(strokes, drawn, grid, params);
    for (std::size_t const k : downstream_first(strokes)) {
        planting.plant(k, run);
    }
    Lands const lands(strokes, grid, params.reach);
    Forest forest;
    forest.links = planting.take();
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        forest.shares.push_back({.mouth = strokes[k].line.front(),
                                 .far = strokes[k].line.back(),
                                 .area_m2 = lands.area_m2(k),
                                 .sample = [&lands, k](double width) { return lands.sample(k, width); }});
    }
    std::vector<Vec2> const edge = outline(grid);
    forest.walls = sides_of(edge);
    forest.inside = [&edge](Vec2 p) { return contains(edge, p); };
    forest.seed = params.tree.seed;
    forest.clearance = params.clearance;
    forest.min_spacing_m = params.min_spacing_m;

    SettledLinks const settled = settle_links(forest, spread_forest(forest, run));
    grown.placed = std::count(settled.stays.begin(), settled.stays.end(), std::uint8_t{1});
    grown.dropped = static_cast<std::int64_t>(forest.links.size()) - grown.placed;
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    grown.network = std::move(kept.network);
    NetworkIndex const index(grown.network);
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        RiverLine const& stroke =
            drawn.lines[forest.links[static_cast<std::size_t>(kept.links_of_arc[a].front())].tree];
        grown.network[index.arcs[a]].type = stroke.type;
        grown.network[index.arcs[a]].feature = stroke.feature;
    }
    return grown;
}

} // namespace thalweg::network
