// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/prune.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace prune_test {

namespace {

using namespace thalweg;
using network::cut_corners;
using network::prune;
using test::refused;
using test::same_network;

/// A network as a set of lines with their thresholds.
using Lines = std::map<std::vector<std::pair<double, double>>, double>;

std::vector<std::pair<double, double>> key(std::vector<Vec2> const& line) {
    std::vector<std::pair<double, double>> out;
    for (Vec2 const p : line) {
        out.emplace_back(p.x, p.y);
    }
    return out;
}

Lines lines_of(StreamNetwork const& net) {
    Lines lines;
    for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
        lines[key(net.arc(arc).line)] = net.arc(arc).persistence;
    }
    return lines;
}

bool same_lines(Lines const& a, Lines const& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](auto const& p, auto const& q) {
        bool const near = std::fabs(p.second - q.second) <= 1e-6 * (1.0 + p.second);
        return p.first == q.first && (near || p.second == q.second);
    });
}

/// The rule, literally: find the shortest leaf, remove it, merge, measure everything again.
struct PlainArc {
    std::size_t from;
    std::size_t to;
    std::vector<Vec2> line;
};

struct PlainForest {
    std::vector<Vec2> at;
    std::vector<PlainArc> arcs;

    explicit PlainForest(StreamNetwork const& net) {
        for (NodeId n = 0; n < net.node_count(); ++n) {
            at.push_back(net.node(n).at);
        }
        for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
            arcs.push_back({net.from(arc), net.to(arc), net.arc(arc).line});
        }
        while (merge_one()) {
        }
    }
    std::size_t above(std::size_t node) const {
        return static_cast<std::size_t>(
            std::count_if(arcs.begin(), arcs.end(), [&](PlainArc const& a) { return a.to == node; }));
    }
    bool merge_one() {
        for (std::size_t up = 0; up < arcs.size(); ++up) {
            for (std::size_t down = 0; down < arcs.size(); ++down) {
                if (arcs[up].to == arcs[down].from && above(arcs[up].to) == 1) {
                    arcs[up].to = arcs[down].to;
                    arcs[up].line.insert(arcs[up].line.end(), arcs[down].line.begin() + 1, arcs[down].line.end());
                    arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(down));
                    return true;
                }
            }
        }
        return false;
    }
    /// The shortest leaf (ties: north, then west), arcs.size() for none.
    std::size_t shortest_leaf() const {
        std::size_t best = arcs.size();
        for (std::size_t a = 0; a < arcs.size(); ++a) {
            if (above(arcs[a].from) > 0) {
                continue;
            }
            auto const rank = [&](std::size_t k) {
                // Steps of the same kinds in another order are the same length.
                double const length = std::floor(length_of(arcs[k].line) * 1e6 + 0.5);
                return std::make_tuple(length, -at[arcs[k].from].y, at[arcs[k].from].x);
            };
            if (best == arcs.size() || rank(a) < rank(best)) {
                best = a;
            }
        }
        return best;
    }
};

Lines plain_prune(StreamNetwork const& net, double length_cells) {
    PlainForest forest(net);
    std::size_t leaf = forest.shortest_leaf();
    while (leaf < forest.arcs.size() && length_of(forest.arcs[leaf].line) < length_cells - 1e-6) {
        forest.arcs.erase(forest.arcs.begin() + static_cast<std::ptrdiff_t>(leaf));
        while (forest.merge_one()) {
        }
        leaf = forest.shortest_leaf();
    }
    Lines lines;
    for (PlainArc const& a : forest.arcs) {
        lines[key(a.line)] = 0.0;
    }
    // Go on until nothing is left, to find how long each line would stay.
    double longest = 0.0;
    std::vector<std::pair<std::vector<Vec2>, double>> removed;
    for (; leaf < forest.arcs.size(); leaf = forest.shortest_leaf()) {
        longest = std::max(longest, length_of(forest.arcs[leaf].line));
        removed.emplace_back(forest.arcs[leaf].line, longest);
        forest.arcs.erase(forest.arcs.begin() + static_cast<std::ptrdiff_t>(leaf));
        while (forest.merge_one()) {
        }
    }
    for (auto& [line, persistence] : lines) {
        for (auto const& [gone, at] : removed) {
            auto const whole = key(gone);
            if (std::search(whole.begin(), whole.end(), line.begin(), line.end()) != whole.end()) {
                persistence = at;
            }
        }
    }
    return lines;
}

/// A length at which something is left: a random share of the longest threshold.
double any_length(StreamNetwork const& net) {
    double longest = 0.0;
    for (ArcId arc = 0; arc < net.arc_count(); ++arc) {
        longest = std::max(longest, net.arc(arc).persistence);
    }
    return longest * *rc::gen::element(0.02, 0.1, 0.3, 0.7, 1.0);
}

} // namespace

TEST(Prune, RefusesBadParametersAndNetworks) {
    StreamNetwork const net = test::network_of({{0, 0}, {384, 0}}, {{1, 0}});
    StreamNetwork const circle = test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}});
    for (StreamNetwork const& wrong : {StreamNetwork(), circle}) {
        EXPECT_TRUE(refused("network.prune", [&] { prune(wrong, {1.0, 1.0}); }));
    }
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (auto const& [length_m, cell_m, words] :
         std::vector<std::tuple<double, double, std::string>>{{-1.0, 1.0, ""},
                                                              {nan, 1.0, ""},
                                                              {1.0, 0.0, ""},
                                                              {1.0, 1e-300, ""},
                                                              {500.0, 1.0, "at 500 cells"},
                                                              {12.9 * 30.0, 30.0, "at 12.9 cells"}}) {
        EXPECT_TRUE(refused<BadParameter>(
            "network.prune",
            [&] {
                prune(net, {length_m, cell_m});
            },
            words));
    }
    EXPECT_EQ(prune(net, {384.0, 1.0}).network.arc_count(), 1U); // the boundary is kept
    StreamNetwork const odd = test::network_of({{0, 0}, {1, 1}}, {{1, 0}});
    EXPECT_TRUE(refused<BadParameter>(
        "network.prune",
        [&] {
            prune(odd, {2.0, 1.0});
        },
        "Try 1.41 or less"));
}

TEST(Prune, AMergedArcTakesTheNameOfItsLongestPiece) {
    StreamNetwork const net = test::network_of({{0, 0}, {5, 0}, {5, 3}, {9, 0}},
                                               {{2, 1, {}, 7, "A"}, {3, 1, {}, 8, "B"}, {1, 0, {}, 9, "C"}});
    StreamNetwork const pruned = prune(net, {4.0, 1.0}).network;
    ASSERT_EQ(pruned.arc_count(), 1U);
    Arc const& arc = pruned.arc(0);
    EXPECT_EQ(arc.line, (std::vector<Vec2>{{9, 0}, {5, 0}, {0, 0}}));
    EXPECT_EQ(arc.feature, 9);
    EXPECT_EQ(arc.type, "C");
    EXPECT_EQ(arc.persistence, 9.0);
}

TEST(Prune, Laws) {
    ASSERT_TRUE(rc::check("a forest without short leaves or nodes of degree two", [] {
        StreamNetwork const net = prune(test::any_network(), {0.0, 1.0}).network;
        double const length = any_length(net);
        network::PrunedNetwork const pruned = prune(net, {length, 1.0});
        RC_ASSERT(pruned.arcs_before == static_cast<std::int64_t>(net.arc_count()));
        RC_ASSERT(pruned.network.node_count() == pruned.network.arc_count() + pruned.network.outlets().size());
        RC_ASSERT(pruned.network.upstream_order().size() == pruned.network.node_count());
        for (std::size_t a = 0; a < pruned.network.arc_count(); ++a) {
            NodeId const from = pruned.network.from(a);
            RC_ASSERT(kind_of(pruned.network, from) != NodeKind::pseudo);
            RC_ASSERT((!pruned.network.in(from).empty() || pruned.network.length_m(a) >= length - 1e-6));
            RC_ASSERT(pruned.network.arc(a).line.front() == pruned.network.node(from).at);
            RC_ASSERT(pruned.network.arc(a).line.back() == pruned.network.node(pruned.network.to(a)).at);
        }
        RC_ASSERT(same_network(prune(pruned.network, {length, 1.0}).network, pruned.network));
        network::PrunedNetwork const before = prune(net, {*rc::gen::element(0.3, 0.8) * length, 1.0});
        RC_ASSERT(lines_of(prune(before.network, {length, 1.0}).network) == lines_of(pruned.network)); // as at once
        RC_ASSERT(prune(before.network, {length, 1.0}).network.from() == pruned.network.from());
    }));
}

TEST(Prune, EqualsTheRule) {
    ASSERT_TRUE(rc::check("queue = search for the shortest leaf, arcs and thresholds", [] {
        StreamNetwork const net = test::any_network();
        double const length = any_length(prune(net, {0.0, 1.0}).network);
        RC_ASSERT(same_lines(lines_of(prune(net, {length, 1.0}).network), plain_prune(net, length)));
    }));
}

TEST(Prune, TheSameArcsWhateverTheCell) {
    ASSERT_TRUE(rc::check("cells of 0.1 m far from the origin, where no coordinate is exact", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Mask const mask = network::thin(test::random_blob(seed, 40, 40, 8, 2));
        Mask fine(Grid{40, 40, 0.1, 500000.3, 4000000.7, ""});
        std::copy(mask.values().begin(), mask.values().end(), fine.values().begin());
        Vec2 const mouth = mask.grid().centre({20, 39});
        RC_PRE(test::components(mask, 1, 8) == 1);
        std::int64_t cells = 0;
        for (auto const v : mask.values()) {
            cells += v;
        }
        RC_PRE(cells > 12);
        StreamNetwork const coarse = network::trace(mask, {mouth});
        StreamNetwork const small = network::trace(fine, {fine.grid().centre({20, 39})});
        network::PrunedNetwork const a = prune(coarse, {3.0, 1.0});
        network::PrunedNetwork const b = prune(small, {3.0 * 0.1, 0.1});
        RC_ASSERT(a.network.from() == b.network.from());
        RC_ASSERT(a.network.to() == b.network.to());
        for (std::size_t k = 0; k < a.network.arc_count(); ++k) {
            RC_ASSERT(a.network.arc(k).persistence == b.network.arc(k).persistence);
        }
    }));
}

TEST(Prune, MetresMadeOfCellsAreThoseCells) {
    for (double const cell_m : {0.1, 0.3, 1.0 / 3.0, 30.0, 92.6}) {
        for (int cells = 1; cells <= 300; ++cells) {
            double const length_m = cells * cell_m; // over cell_m, it may be a little more than the cells
            StreamNetwork const net = test::network_of({{0, 0}, {length_m, 0}}, {{1, 0}});
            EXPECT_EQ(prune(net, {.length_m = length_m, .cell_m = cell_m}).network.arc_count(), 1U);
            EXPECT_THROW(prune(net, {.length_m = length_m + 1e-6 * cell_m, .cell_m = cell_m}), BadParameter);
        }
    }
}

TEST(Prune, ACombOfManyTeeth) {
    // Teeth that grow upstream along a spine: each removal merges the spine again, a quadratic rule would not end.
    std::size_t const teeth = 100000;
    NetworkDraft net;
    net.add_node({0.0, 0.0});
    for (std::size_t t = 1; t <= teeth; ++t) {
        auto const x = static_cast<double>(t);
        NodeId const spine = net.add_node({x, 0.0});
        NodeId const tip = net.add_node({x, 1.0 + x / 1024.0});
        net.add_arc(spine, t == 1 ? 0 : spine - 2);
        net.add_arc(tip, spine);
    }
    StreamNetwork const pruned = prune(net, {50.0, 1.0}).network;
    std::size_t const left = teeth - 49 * 1024 + 1;
    EXPECT_EQ(pruned.arc_count(), 2 * left - 1); // the head of the spine is merged with its tooth
}

TEST(CutCorners, RefusesCellsWithoutSize) {
    StreamNetwork const net = test::network_of({{0, 0}, {1, 0}}, {{0, 1}});
    for (double const cell : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW(cut_corners(net, cell), BadParameter);
    }
}

TEST(CutCorners, CornersGoAndOtherVerticesStay) {
    using Line = std::vector<Vec2>;
    for (auto const& [what, line, wanted] : std::vector<std::tuple<std::string, Line, Line>>{
             {"straight and diagonal steps stay",
              {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {3, 2}, {4, 3}, {5, 3}, {5, 4}},
              {{0, 0}, {1, 0}, {2, 1}, {3, 2}, {4, 3}, {5, 4}}},
             {"every second corner of a staircase", {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}}, {{0, 0}, {1, 1}, {2, 2}}},
             {"not from cell to cell", {{0, 0}, {20, 0}, {20, 20}}, {{0, 0}, {20, 0}, {20, 20}}}}) {
        StreamNetwork const net =
            test::network_of({line.front(), line.back()}, {{0, 1, {line.begin() + 1, line.end() - 1}}});
        EXPECT_EQ(cut_corners(net, 1.0).arcs().front().line, wanted) << what;
    }
}

TEST(CutCorners, PrunedRiversHaveNoCornerAndKeepTheirEnds) {
    ASSERT_TRUE(rc::check("corners", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
        StreamNetwork const net = network::prune(test::random_skeleton(seed, 48), {3.0, 1.0}).network;
        StreamNetwork const cut = cut_corners(net, 1.0);
        RC_ASSERT(net.from() == cut.from());
        RC_ASSERT(net.to() == cut.to());
        for (std::size_t a = 0; a < cut.arc_count(); ++a) {
            auto const& line = cut.arc(a).line;
            RC_ASSERT(line.front() == net.arc(a).line.front());
            RC_ASSERT(line.back() == net.arc(a).line.back());
            RC_ASSERT(cut.length_m(a) <= net.length_m(a));
            for (std::size_t i = 2; i < line.size(); ++i) {
                RC_ASSERT(distance(line[i - 2], line[i]) > 1.5);
            }
        }
    }));
}

} // namespace prune_test
