// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/embed_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/growth/tokunaga/internal/embed_tree.hpp>
#include <thalweg/network/order/order.hpp>

namespace embed_tree_test {

using namespace thalweg;
using growth::embed_tree;
using growth::EmbeddedTree;
using growth::EmbedParams;
using growth::grow_tokunaga;
using growth::TokunagaTree;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<Vec2> square(double side_m) {
    return {{0, 0}, {side_m, 0}, {side_m, side_m}, {0, side_m}};
}

/// A ring around (1e6, 5e6) with a corner at each of these distances [m].
std::vector<Vec2> star(std::vector<double> const& radii) {
    std::vector<Vec2> ring;
    for (double const radius : radii) {
        double const angle =
            2.0 * 3.14159265358979 * static_cast<double>(ring.size()) / static_cast<double>(radii.size());
        ring.push_back({1e6 + radius * std::cos(angle), 5e6 + radius * std::sin(angle)});
    }
    return ring;
}

EmbedParams in_square(double side_m) {
    return {.region = square(side_m), .mouth = {0.5 * side_m, 0.0}};
}

struct PlacedLink {
    std::int64_t link;
    Vec2 upper;
    Vec2 lower;
};

std::vector<PlacedLink> placed_links(EmbeddedTree const& out) {
    std::vector<PlacedLink> links;
    for (std::size_t a = 0; a < out.network.arc_count(); ++a) {
        auto const& line = out.network.arc(a).line;
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            links.push_back({out.links_of_arc.at(a).at(k), line[k], line[k + 1]});
        }
    }
    return links;
}

double from_link(Vec2 p, PlacedLink const& l) {
    return distance(p, geometry::foot_on(l.upper, l.lower, p).at);
}

/// Of links that do not cross.
double apart(PlacedLink const& a, PlacedLink const& b) {
    return std::min({from_link(a.upper, b), from_link(a.lower, b), from_link(b.upper, a), from_link(b.lower, a)});
}

double angle_deg(Vec2 here, Vec2 a, Vec2 b) {
    double const dot = (a.x - here.x) * (b.x - here.x) + (a.y - here.y) * (b.y - here.y);
    return std::acos(std::clamp(dot / (distance(here, a) * distance(here, b)), -1.0, 1.0)) * 180.0 / 3.14159265358979;
}

/// What is wrong with the links of the arcs as parts of the tree, or "".
std::string broken_tree(TokunagaTree const& tree, EmbedParams const& params, EmbeddedTree const& out) {
    if (out.placed + out.dropped != static_cast<std::int64_t>(tree.links.size())) {
        return "placed and dropped are not all";
    }
    if (out.network.arc_count() != out.links_of_arc.size()) {
        return "other arcs than lists of links";
    }
    std::set<std::int64_t> seen;
    for (std::size_t a = 0; a < out.network.arc_count(); ++a) {
        auto const& links = out.links_of_arc[a];
        std::size_t const pieces = out.network.arc(a).line.size() - 1;
        if (links.empty() || pieces > links.size() || (params.min_spacing_m == 0.0 && pieces < links.size())) {
            return "an arc's line has not one piece for each link";
        }
        for (std::size_t k = 0; k < links.size(); ++k) {
            if (!seen.insert(links[k]).second) {
                return "a link is placed twice";
            }
            bool const last = k + 1 == links.size();
            if (!last && tree.links.at(static_cast<std::size_t>(links[k])).down != links[k + 1]) {
                return "an arc's links do not flow into one another";
            }
            if (last) {
                std::int64_t const out_arc = out.network.out(out.network.to(a));
                std::int64_t const below =
                    out_arc < 0 ? -1 : out.links_of_arc[static_cast<std::size_t>(out_arc)].front();
                if (tree.links.at(static_cast<std::size_t>(links[k])).down != below) {
                    return "an arc ends in another link than the tree says";
                }
            }
        }
    }
    if (static_cast<std::int64_t>(seen.size()) != out.placed) {
        return "not every placed link is in an arc";
    }
    return "";
}

/// Where arcs meet one another or the ring and may not, or "".
std::string broken_plane(EmbedParams const& params, EmbeddedTree const& out) {
    std::vector<std::vector<Vec2>> lines;
    for (ArcId arc = 0; arc < out.network.arc_count(); ++arc) {
        lines.push_back(out.network.arc(arc).line);
    }
    lines.push_back(params.region);
    lines.back().push_back(params.region.front());
    for (auto const& c : geometry::crossings(lines)) {
        auto const& line = lines[c.line];
        bool const is_end = c.at == line.front() || c.at == line.back();
        // The mouth is rounded to 1e-6 m: an arc that comes in at a flat angle meets the ring so much farther off.
        bool const at_mouth = distance(c.at, params.mouth) < 1e-4;
        bool const of_ring = c.line + 1 == lines.size();
        if (!(at_mouth || is_end)) {
            return (of_ring ? "the ring is met at (" : "arcs meet at (") + std::to_string(c.at.x) + ", " +
                   std::to_string(c.at.y) + ")";
        }
    }
    for (ArcId arc = 0; arc < out.network.arc_count(); ++arc) {
        for (Vec2 const p : out.network.arc(arc).line) {
            if (distance(p, params.mouth) > 2e-6 && !geometry::contains(params.region, p)) {
                return "a vertex lies outside";
            }
            if (std::fabs(p.x * 1e6 - std::round(p.x * 1e6)) > 1e-3) {
                return "a coordinate is not rounded";
            }
        }
    }
    if (out.placed > 0 && out.network.outlets().size() != 1) {
        return "not one outlet";
    }
    for (std::size_t n = 0; n < out.network.node_count(); ++n) {
        if (out.network.basin(n) != 1) {
            return "a node does not reach the outlet";
        }
    }
    if (out.placed > 0 && distance(out.network.node(out.network.outlets()[0]).at, params.mouth) > 1e-6) {
        return "the outlet is not at the mouth";
    }
    return "";
}

/// Links too near or at too sharp an angle, pair by pair, or "".
std::string broken_room(EmbedParams const& params, EmbeddedTree const& out) {
    auto const links = placed_links(out);
    for (std::size_t i = 0; i < links.size(); ++i) {
        for (std::size_t k = i + 1; k < links.size(); ++k) {
            PlacedLink const& a = links[i];
            PlacedLink const& b = links[k];
            std::string const pair = " of links " + std::to_string(a.link) + " and " + std::to_string(b.link);
            if (a.lower == b.lower || a.lower == b.upper || a.upper == b.lower) {
                double const angle = a.lower == b.lower   ? angle_deg(a.lower, a.upper, b.upper)
                                     : a.lower == b.upper ? angle_deg(a.lower, a.upper, b.lower)
                                                          : angle_deg(a.upper, a.lower, b.upper);
                if (angle < 20.0 - 1e-3) {
                    return "angle " + std::to_string(angle) + pair;
                }
                continue;
            }
            double const shorter = std::min(distance(a.upper, a.lower), distance(b.upper, b.lower));
            double const need = std::max(params.clearance * shorter, params.min_spacing_m);
            if (apart(a, b) < need - 1e-6) {
                return "distance " + std::to_string(apart(a, b)) + " below " + std::to_string(need) + pair;
            }
        }
    }
    return "";
}

std::string broken(TokunagaTree const& tree, EmbedParams const& params, EmbeddedTree const& out) {
    std::string words = broken_tree(tree, params, out);
    words = words.empty() ? broken_plane(params, out) : words;
    return words.empty() ? broken_room(params, out) : words;
}

std::vector<Vec2> vertices(EmbeddedTree const& out) {
    std::vector<Vec2> all;
    for (auto const& link : placed_links(out)) {
        all.push_back(link.upper);
    }
    return all;
}

int highest_order_below(int lambda, std::size_t links) {
    int order = 1;
    while (order < 12 && grow_tokunaga({.generator = lambda, .order = order + 1}).links.size() <= links) {
        ++order;
    }
    return order;
}

} // namespace

TEST(EmbedTree, RefusesRegionsAndParameters) {
    auto const changed = [](auto change) {
        EmbedParams params = in_square(100);
        change(params);
        return params;
    };
    std::vector<std::pair<EmbedParams, std::string>> cases{
        {{}, "the region has 0 vertices"},
        {{.region = {{0, 0}, {1, 0}}}, "the region has 2 vertices"},
        {{.region = {{0, 0}, {9, 9}, {9, 0}, {0, 9}}, .mouth = {1, 1}}, "meets itself at (4.5, 4.5)"},
        {{.region = {{5, 5}, {5, 5}, {5, 5}}, .mouth = {5, 5}}, "has no area"},
        {{.region = {{0, 0}, {5, 5}, {9, 9}}, .mouth = {5, 5}}, ""},
        {{.region = {{0, 0}, {9, not_a_number}, {9, 9}}}, "vertex (9, nan)"},
        {{.region = square(0.001)}, "21 links"},
        {changed([](EmbedParams& p) {
             p.mouth = {50, -3};
         }),
         "the outlet (50, -3) lies 3 m outside"},
        {changed([](EmbedParams& p) {
             p.mouth = {not_a_number, 0};
         }),
         ""},
        {changed([](EmbedParams& p) {
             p.direction = {0, not_a_number};
         }),
         ""}};
    for (double const wrong : {not_a_number, 0.0499, 0.3501}) {
        cases.emplace_back(changed([=](EmbedParams& p) { p.clearance = wrong; }), "clearance");
    }
    for (double const wrong : {not_a_number, -1.0, std::numeric_limits<double>::infinity()}) {
        cases.emplace_back(changed([=](EmbedParams& p) { p.min_spacing_m = wrong; }), "min_spacing_m");
    }
    auto const tree = grow_tokunaga({.order = 3});
    for (auto const& [params, words] : cases) {
        EXPECT_TRUE(test::refused<BadParameter>(
            "growth.embed_tree", [&] { embed_tree(tree, params); }, words));
    }
}

TEST(EmbedTree, StopsWhenAsked) {
    EXPECT_THROW(embed_tree(grow_tokunaga(), in_square(100), test::stopped_run()), Cancelled);
}

TEST(Polygon, OfATriangle) {
    std::vector<Vec2> const ring{{1, 0}, {5, 0}, {1, 2}};
    EXPECT_EQ(geometry::signed_area(ring), 4.0);
    EXPECT_LT(distance(growth::centroid_of(ring), {7.0 / 3.0, 2.0 / 3.0}), 1e-12);
    EXPECT_EQ(growth::lattice_in(ring, 1.0), (std::vector<Vec2>{{1.5, 0.5}, {2.5, 0.5}, {3.5, 0.5}, {1.5, 1.5}}));
}

TEST(EmbedTree, OutlineOfAGrid) {
    auto const ring =
        growth::outline(Grid{.width = 20, .height = 40, .cell_m = 5, .west = 10, .north = 500, .crs = ""});
    EXPECT_EQ(ring, (std::vector<Vec2>{{10, 300}, {110, 300}, {110, 500}, {10, 500}}));
}

TEST(EmbedTree, FillsASquareAndKeepsEveryLaw) {
    for (int lambda = 1; lambda <= 4; ++lambda) {
        int const order = highest_order_below(lambda, 1500);
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            auto const tree = grow_tokunaga({.seed = seed, .generator = lambda, .order = order});
            auto params = in_square(5000);
            params.seed = seed;
            auto const out = embed_tree(tree, params);
            std::string const which = "lambda " + std::to_string(lambda) + ", seed " + std::to_string(seed);
            EXPECT_EQ(broken(tree, params, out), "") << which;
            EXPECT_NEAR(out.spacing_m, 5000.0 / std::sqrt(static_cast<double>(tree.links.size())), 1e-9);
            EXPECT_GE(static_cast<double>(out.placed), 0.97 * static_cast<double>(tree.links.size())) << which;
            if (out.dropped == 0) {
                auto const orders = network::order(out.network);
                for (std::size_t a = 0; a < out.links_of_arc.size(); ++a) {
                    for (std::int64_t const link : out.links_of_arc[a]) {
                        ASSERT_EQ(tree.links[static_cast<std::size_t>(link)].order, orders.strahler[a]) << which;
                    }
                }
            }
        }
    }
}

TEST(EmbedTree, FillsARegionOfAnyShape) {
    std::vector<Vec2> const hook{{0, 0},       {3000, 0},    {3000, 2000}, {1800, 2000},
                                 {1800, 1000}, {1000, 1000}, {1000, 3000}, {0, 3000}};
    auto const tree = grow_tokunaga({.order = 5});
    for (Vec2 const mouth : {Vec2{500, 3000}, Vec2{3000, 1500}, Vec2{1000, 1000}, Vec2{0, 0}, Vec2{1500, 500}}) {
        for (bool const turned : {false, true}) {
            EmbedParams params{.region = hook, .mouth = mouth};
            if (turned) {
                std::reverse(params.region.begin(), params.region.end());
            }
            auto const out = embed_tree(tree, params);
            EXPECT_EQ(broken(tree, params, out), "") << mouth.x << " " << mouth.y;
            EXPECT_GE(out.placed, 300) << mouth.x << " " << mouth.y;
        }
    }
}

TEST(EmbedTree, ATrunkSentOutsideStaysInside) {
    auto const tree = grow_tokunaga({.order = 3});
    for (Vec2 const direction : {Vec2{0, -1}, Vec2{1, 0}, Vec2{-1, 1e-3}}) {
        auto params = in_square(1000);
        params.direction = direction;
        EXPECT_EQ(broken(tree, params, embed_tree(tree, params)), "") << direction.x << " " << direction.y;
    }
    std::vector<Vec2> const pentagon = star(std::vector(5, 300.0));
    for (Vec2 const corner : pentagon) { // mouths are rounded: some lie outside
        EmbedParams const params{.region = pentagon, .mouth = corner, .direction = {corner.x - 1e6, corner.y - 5e6}};
        auto const link = grow_tokunaga({.order = 1});
        EXPECT_EQ(broken(link, params, embed_tree(link, params)), "") << corner.x << " " << corner.y;
    }
}

TEST(EmbedTree, LawsHoldForAnyStar) {
    ASSERT_TRUE(rc::check("laws hold in a star-shaped region", [] {
        std::vector<double> radii(*rc::gen::inRange<std::size_t>(4, 11));
        EmbedParams params{.seed = *rc::gen::arbitrary<std::uint64_t>()};
        std::ranges::generate(radii, [] { return *rc::gen::inRange(300, 1000); });
        params.region = star(radii);
        params.mouth = params.region[*rc::gen::inRange<std::size_t>(0, radii.size())];
        if (*rc::gen::arbitrary<bool>()) { // outward directions too
            double const angle = 0.1 * *rc::gen::inRange(0, 63);
            params.direction = {std::cos(angle), std::sin(angle)};
        }
        params.clearance = std::min(0.35, 0.01 * *rc::gen::inRange(5, 36));
        params.min_spacing_m = *rc::gen::inRange(0, 60);
        int const lambda = *rc::gen::inRange(1, 6);
        auto const tree = grow_tokunaga({.seed = params.seed, .generator = lambda, .order = *rc::gen::inRange(1, 4)});
        auto const out = embed_tree(tree, params);
        RC_ASSERT(broken(tree, params, out) == "");
    }));
}

// Where spacing leaves no room for streams of low orders, links that lie between such share a piece of a line.
TEST(EmbedTree, ACrowdedPentagonLosesItsLowestOrders) {
    EmbedParams params{.seed = 1, .region = star(std::vector(5, 300.0)), .clearance = 0.05, .min_spacing_m = 27.0};
    params.mouth = params.region[0];
    auto const tree = grow_tokunaga({.seed = 1, .generator = 5, .order = 3});
    auto const out = embed_tree(tree, params);
    EXPECT_EQ(broken(tree, params, out), "");
    ASSERT_FALSE(out.links_of_arc.empty());
    EXPECT_GT(out.links_of_arc[0].size() + 1, out.network.arc(0).line.size());
    EXPECT_GT(out.dropped, 0);
}

TEST(EmbedTree, SpreadsEvenly) {
    auto const tree = grow_tokunaga({.generator = 2, .order = 6});
    auto const params = in_square(6400);
    std::vector<int> in_cell(64, 0);
    auto const places = vertices(embed_tree(tree, params));
    for (Vec2 const p : places) {
        ++in_cell[static_cast<std::size_t>(p.y / 800.0) * 8 + static_cast<std::size_t>(p.x / 800.0)];
    }
    double const mean = static_cast<double>(places.size()) / 64.0; // 21
    for (int const n : in_cell) {
        EXPECT_GT(n, 0.4 * mean);
        EXPECT_LT(n, 2.5 * mean);
    }
}

TEST(EmbedTree, SeedAloneDecides) {
    auto const tree = grow_tokunaga({.order = 5});
    auto params = in_square(1000);
    auto const first = vertices(embed_tree(tree, params));
    EXPECT_EQ(vertices(embed_tree(tree, params)), first);
    params.seed = 8;
    EXPECT_NE(vertices(embed_tree(tree, params)), first);
}

TEST(EmbedTree, WhereRoomIsShortTheHighestOrdersStay) {
    auto const tree = grow_tokunaga({.generator = 2, .order = 6});
    auto params = in_square(1000);
    params.min_spacing_m = 30.0; // the links' own is 27
    auto const out = embed_tree(tree, params);
    EXPECT_EQ(broken(tree, params, out), ""); // what flows into a dropped link is dropped
    EXPECT_GT(out.dropped, 200);
    EXPECT_GT(out.placed, 300);
    std::vector<double> all(7, 0.0);
    std::vector<double> kept(7, 0.0);
    for (auto const& link : tree.links) {
        all[static_cast<std::size_t>(link.order)] += 1.0;
    }
    for (auto const& links : out.links_of_arc) {
        for (std::int64_t const link : links) {
            kept[static_cast<std::size_t>(tree.links[static_cast<std::size_t>(link)].order)] += 1.0;
        }
    }
    EXPECT_EQ(kept[6], all[6]);
    EXPECT_EQ(kept[1], 0.0);
    EXPECT_GE(kept[4] / all[4], kept[2] / all[2]);
}

} // namespace embed_tree_test
