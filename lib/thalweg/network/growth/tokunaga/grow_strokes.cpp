// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/grow_strokes.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>
#include <thalweg/network/growth/tokunaga/internal/grow_strokes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace thalweg::network {

namespace {

constexpr std::uint64_t stroke_stage = 0x7374726f6b65; // "stroke"

void check(StrokesParams const& params) {
    require_in("network.grow_strokes", "max_depth", params.max_depth, Range::between(1, 29));
    require_in("network.grow_strokes", "reach", params.reach, Range{0.0, 2.0, false, true});
    require_in("network.grow_strokes", "clearance", params.clearance, Range::between(0.05, 0.35));
    require_in("network.grow_strokes", "min_spacing_m", params.min_spacing_m, Range::at_least(0.0));
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

class Planting {
public:
    Planting(Strokes const& strokes, RiverLines const& drawn, StrokeLands const& lands, double width_m,
             StrokesParams const& params)
        : strokes_(strokes), drawn_(drawn), lands_(lands), width_m_(width_m), params_(params),
          joints_(strokes.size(), -1), junctions_(strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (strokes[k].onto >= 0) {
                junctions_[strokes[k].onto].push_back({strokes[k].onto_way_m, k});
            }
        }
        for (auto& list : junctions_) {
            std::sort(list.begin(), list.end(), [](Junction const& a, Junction const& b) { return a.way_m < b.way_m; });
        }
    }

    void plant(std::size_t stroke, Run const& run) {
        TokunagaParams params = params_.tree;
        params.seed = random_word(params_.tree.seed, stroke_stage, stroke);
        params.generator = drawn_.lines[stroke].lambda > 0 ? drawn_.lines[stroke].lambda : params.generator;
        params.order = depth_of(stroke) + 1;
        TokunagaTree tree = grow_tokunaga(params, run);
        balance_banks(tree, lands_.share_left(stroke));
        std::vector<std::size_t> const trunk = trunk_of(tree);
        std::vector<double> const ways = ways_of_trunk(trunk.size(), strokes_[stroke].way.back(), junctions_[stroke]);

        Indexed<LinkId, LinkId> number(tree.links.size(), -1); // of its links in the forest
        LinkId below = joints_[stroke];
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
                number[i] = add(number[link.down], link.order, link.turn, stroke, {});
            }
        }
    }

    /// A river is of no lower order than those that flow into it.
    Indexed<LinkId, ForestLink> take() {
        for (std::size_t i = links_.size(); i-- > 0;) {
            if (links_[i].down >= 0) {
                int& order = links_[links_[i].down].order;
                order = std::max(order, links_[i].order);
            }
        }
        return std::move(links_);
    }

    /// The link into which each stroke flows, -1 for its own mouth.
    Indexed<StrokeId, LinkId> const& joints() const { return joints_; }

private:
    int depth_of(std::size_t stroke) const {
        double const depth = std::floor(strokes_[stroke].way.back() / width_m_ * params_.max_depth + 0.5);
        return static_cast<int>(std::clamp(depth, 1.0, static_cast<double>(params_.max_depth)));
    }

    /// The bank from which a stroke joins another, as TreeLink::turn has it.
    int side_of(std::size_t stroke) const {
        Stroke const& own = strokes_[stroke];
        Stroke const& onto = strokes_[own.onto];
        Vec2 const a = place_at(onto, own.onto_way_m);
        Vec2 const b = place_at(onto, own.onto_way_m + 0.01 * onto.way.back());
        Vec2 const c = own.line[1];
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0 ? 2 : -2;
    }

    LinkId add(LinkId down, int order, int turn, std::size_t tree, std::optional<Vec2> pinned) {
        links_.push_back({.down = down, .order = order, .turn = turn, .tree = tree, .pinned = pinned});
        return links_.count() - 1;
    }

    Strokes const& strokes_;
    RiverLines const& drawn_;
    StrokeLands const& lands_;
    double width_m_; ///< [m] of the grid
    StrokesParams const& params_;
    Indexed<LinkId, ForestLink> links_;
    Indexed<StrokeId, LinkId> joints_;
    Indexed<StrokeId, std::vector<Junction>> junctions_;
};

/// Throws where a stroke would flow into another further than a cell from where it was drawn to.
void require_in_place(Strokes const& strokes, RiverLines const& drawn, Indexed<StrokeId, LinkId> const& joints,
                      SettledLinks const& settled, double cell_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        Vec3 const start = drawn.lines[k].vertices.front();
        LinkId const joint = joints[k];
        if (joint >= 0 && settled.stays[joint] != 0 && distance(settled.at[joint], {start.x, start.y}) > cell_m) {
            throw BadInput(fmt::format("network.grow_strokes: stroke {} of {} at ({:.3f}, {:.3f}) begins on stroke {}, "
                                       "which others leave no room there; draw the strokes further apart",
                                       strokes[k].feature, drawn.name, start.x, start.y,
                                       strokes[strokes[k].onto].feature));
        }
    }
}

} // namespace

GrownStrokes grow_strokes(RiverLines const& drawn, Grid const& grid, StrokesParams const& params, Run const& run) {
    check(params);
    Strokes const strokes = join_strokes(drawn, grid, run);
    GrownStrokes grown;
    if (strokes.empty()) {
        return grown;
    }
    StrokeLands const lands(strokes, grid, params.reach);
    Planting planting(strokes, drawn, lands, grid.east() - grid.west, params);
    for (std::size_t const k : downstream_first(strokes)) {
        planting.plant(k, run);
    }
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
    require_in_place(strokes, drawn, planting.joints(), settled, grid.cell_m);
    grown.placed = std::count(settled.stays.begin(), settled.stays.end(), std::uint8_t{1});
    grown.dropped = static_cast<std::int64_t>(forest.links.size()) - grown.placed;
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    for (ArcId a = 0; a < kept.network.arcs.size(); ++a) {
        RiverLine const& stroke = drawn.lines[forest.links[kept.links_of_arc[a].front()].tree];
        kept.network.arcs[a].arc.type = stroke.type;
        kept.network.arcs[a].arc.feature = stroke.feature;
    }
    grown.network = std::move(kept.network);
    return grown;
}

} // namespace thalweg::network
