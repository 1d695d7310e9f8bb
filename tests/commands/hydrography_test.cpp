// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of rivers stays so in every schema, and what is not stays unknown; laws of trees that are known.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <network/drawn_trees.hpp>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/commands/convert.hpp>
#include <thalweg/commands/stats.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/network/order/order.hpp>

namespace hydrography_test {

using namespace thalweg;
using io::Schema;

namespace {

using FileArc = NetworkFile::FileArc;

/// A network and areas, -1 where they are unknown.
struct Rivers {
    StreamNetwork plan;
    std::vector<double> us_area_m2 = {};
    std::vector<double> ds_area_m2 = {};
    bool heights = false;

    void write(std::string const& path, Schema schema) const {
        std::vector<double> z(plan.node_count(), 0.0);
        for (NodeId const n : plan.upstream_order()) {
            z[n] = plan.out(n) == no_arc ? 0.0 : z[plan.to(plan.out(n))] + 1.0;
        }
        ElevatedNetwork const raised = test::elevated(plan, z);
        NetworkOrders const orders = network::order(plan);
        std::vector<double> const nodes(plan.node_count(), -1.0);
        io::NetworkTables tables{raised, orders, us_area_m2, ds_area_m2, nodes, "EPSG:32631", {}};
        tables.heights = heights;
        io::write_network(tables, path, {io::NetworkFormat::geopackage, schema, {}});
    }
};

/// A forest of which some sources begin where another river runs by, as minor branches of divergences.
StreamNetwork with_divergences(StreamNetwork const& forest, std::size_t wanted) {
    NetworkDraft net = forest.draft();
    std::vector<std::vector<NodeId>> below(forest.node_count()); // where the water of a node runs
    for (ArcId a = 0; a < forest.arc_count(); ++a) {
        below[forest.from(a)].push_back(forest.to(a));
    }
    auto const runs = [&](auto const& self, NodeId from, NodeId to) -> bool {
        return from == to || std::ranges::any_of(below[from], [&](NodeId next) { return self(self, next, to); });
    };
    for (ArcId a = 0; a < forest.arc_count() && wanted > 0; ++a) {
        NodeId const head = forest.from(a);
        NodeId const at = *rc::gen::inRange<NodeId>(0, forest.node_count());
        if (forest.in(head).empty() && !forest.in(at).empty() && forest.out(at) != no_arc &&
            !runs(runs, forest.to(a), at)) {
            net.nodes[head].at = forest.node(at).at;
            net.arcs[a].arc.line.front() = forest.node(at).at;
            below[at].push_back(forest.to(a));
            --wanted;
        }
    }
    return net;
}

Rivers random_rivers(StreamNetwork plan) {
    Rivers rivers{std::move(plan)};
    for (ArcId a = 0; a < rivers.plan.arc_count(); ++a) {
        double const us = 1000.0 * *rc::gen::inRange(1, 1000);
        int const known = *rc::gen::inRange(0, 4);
        rivers.us_area_m2.push_back(known > 1 ? us : -1.0);
        rivers.ds_area_m2.push_back(known > 0 ? us + 1000.0 * *rc::gen::inRange(0, 1000) : -1.0);
    }
    return rivers;
}

NetworkFile read(std::string const& path) {
    io::ReadNetworkParams params;
    params.bridge = true;
    return io::read_network(path, params);
}

void convert(std::string const& from, std::string const& to, Schema schema) {
    commands::ConvertParams params;
    params.path = from;
    params.output = to;
    params.schema = schema;
    params.read.bridge = true;
    commands::run_convert(params);
}

bool same(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::fabs(a - b) <= 1e-9 * std::max(1.0, std::fabs(a));
}

measure::NetworkLaws laws_of(Rivers const& rivers, network::StreamCounts& counts) {
    ScratchFolder const folder;
    rivers.write(folder / "tree.gpkg", Schema::native);
    commands::StatsParams params;
    params.path = folder / "tree.gpkg";
    params.laws = true;
    commands::StatsResult const found = commands::run_stats(params);
    EXPECT_TRUE(found.lines.has_value());
    EXPECT_EQ(found.lines->arcs, static_cast<std::int64_t>(rivers.plan.arc_count())) << "the tree is read as it is";
    EXPECT_EQ(found.lines->left_out, 0);
    counts = found.lines->streams;
    return found.lines->laws;
}

Rivers tree_of(test::Links const& down) {
    Rivers rivers{test::drawn_tree(down)};
    for (double const links : test::sizes_of(down)) {
        rivers.ds_area_m2.push_back(1e6 * links);
        rivers.us_area_m2.push_back(1e6 * (links - 1.0));
    }
    return rivers;
}

} // namespace

RC_GTEST_PROP(Hydrography, DivergencesComeBackFromNhdPlus, ()) {
    auto const tree =
        test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(5, 40), 2);
    Rivers const rivers = random_rivers(with_divergences(tree, *rc::gen::inRange<std::size_t>(0, 20)));
    ScratchFolder const folder;
    rivers.write(folder / "a.gpkg", Schema::nhdplus);
    convert(folder / "a.gpkg", folder / "b.gpkg", Schema::nhdplus);
    NetworkFile const a = read(folder / "a.gpkg");
    NetworkFile const b = read(folder / "b.gpkg");
    RC_ASSERT(!a.says.heights);
    RC_ASSERT(!b.says.heights);
    RC_ASSERT(a.arcs.size() == rivers.plan.arc_count());
    RC_ASSERT(b.arcs.size() == a.arcs.size());
    std::map<std::int64_t, std::int64_t> path; // of one file, by that of the other
    for (std::size_t i = 0; i < a.arcs.size(); ++i) {
        FileArc const& one = a.arcs[i];
        FileArc const& other = b.arcs[i];
        double const us = rivers.us_area_m2[i];
        double const ds = rivers.ds_area_m2[i];
        RC_ASSERT(same(one.ds_area_m2, ds < 0.0 ? std::nan("") : ds));
        RC_ASSERT(same(one.us_area_m2, us < 0.0 || ds < 0.0 ? std::nan("") : us));
        RC_ASSERT(same(one.us_area_m2, other.us_area_m2));
        RC_ASSERT(same(one.ds_area_m2, other.ds_area_m2));
        RC_ASSERT(one.ds_arc == other.ds_arc);
        RC_ASSERT(one.channel == other.channel);
        RC_ASSERT(one.strahler == other.strahler);
        RC_ASSERT(one.level == other.level);
        RC_ASSERT(path.try_emplace(one.path, other.path).first->second == other.path);
        RC_ASSERT(one.line.size() == other.line.size());
        RC_ASSERT(std::ranges::equal(one.line, other.line, [](Vec3 p, Vec3 q) { return in_plan(p) == in_plan(q); }));
    }
}

RC_GTEST_PROP(Hydrography, TheUnknownStaysSoInEverySchema, ()) {
    auto const links =
        test::random_binary_tree(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(1, 30));
    Rivers rivers = random_rivers(test::drawn_tree(links));
    rivers.heights = *rc::gen::arbitrary<bool>();
    ScratchFolder const folder;
    rivers.write(folder / "native.gpkg", Schema::native);
    for (Schema const schema : {Schema::taudem, Schema::nhdplus, Schema::hydrorivers, Schema::grass}) {
        std::string const name(io::table_of(schema).name);
        convert(folder / "native.gpkg", folder / (name + ".gpkg"), schema);
        convert(folder / (name + ".gpkg"), folder / (name + "_back.gpkg"), Schema::native);
        NetworkFile const back = read(folder / (name + "_back.gpkg"));
        RC_ASSERT(back.says.heights == rivers.heights);
        RC_ASSERT(back.arcs.size() == rivers.plan.arc_count());
        for (std::size_t i = 0; i < back.arcs.size(); ++i) {
            double const us = rivers.us_area_m2[i];
            double const ds = rivers.ds_area_m2[i];
            bool const holds = schema != Schema::grass; // which has no areas
            RC_ASSERT(same(back.arcs[i].ds_area_m2, ds < 0.0 || !holds ? std::nan("") : ds));
            bool const by_difference = schema == Schema::nhdplus || schema == Schema::hydrorivers;
            bool const knows_up = us >= 0.0 && holds && (ds >= 0.0 || !by_difference);
            RC_ASSERT(same(back.arcs[i].us_area_m2, knows_up ? us : std::nan("")));
            RC_ASSERT(rivers.heights || std::isnan(back.arcs[i].columns.z_up_m));
            RC_ASSERT(rivers.heights || std::isnan(back.arcs[i].columns.slope));
        }
    }
}

TEST(LawsOfLines, PeanosBasinHasExactNumbers) {
    network::StreamCounts counts;
    measure::NetworkLaws const laws = laws_of(tree_of(test::peano_basin(7)), counts);
    EXPECT_EQ(counts.streams, (std::vector<std::int64_t>{10923, 2731, 683, 171, 43, 11, 3, 1}));
    ASSERT_EQ(counts.side.size(), 7U);
    for (std::size_t k = 0; k < counts.side.size(); ++k) {
        EXPECT_DOUBLE_EQ(counts.side[k], std::ldexp(1.0, static_cast<int>(k))) << k;
    }
    ASSERT_TRUE(laws.tokunaga && laws.horton.bifurcation && laws.horton.area);
    EXPECT_NEAR(laws.tokunaga->a, 1.0, 1e-9);
    EXPECT_NEAR(laws.tokunaga->c, 2.0, 1e-9);
    EXPECT_NEAR(laws.horton.bifurcation->ratio, 4.0, 0.3);
    EXPECT_NEAR(laws.horton.area->ratio, 4.0, 0.3);
}

TEST(LawsOfLines, TokunagasTreeHasExactBranches) {
    network::StreamCounts counts;
    measure::NetworkLaws const laws = laws_of(tree_of(test::tokunaga_tree(7, 2)), counts);
    EXPECT_EQ(counts.order, 7);
    for (std::size_t w = 1; w < 7; ++w) {
        for (std::size_t k = 1; k <= w; ++k) {
            EXPECT_EQ(counts.branches[w][k - 1], counts.streams[w] << (k - 1)) << w << " " << k;
        }
    }
    ASSERT_TRUE(laws.tokunaga);
    EXPECT_NEAR(laws.tokunaga->a, 1.0, 1e-9);
    EXPECT_NEAR(laws.tokunaga->c, 2.0, 1e-9);
}

TEST(LawsOfLines, RandomTreesHaveShrevesRatios) {
    network::StreamCounts counts;
    measure::NetworkLaws const laws = laws_of(tree_of(test::random_binary_tree(1, 20000)), counts);
    EXPECT_EQ(counts.sources, 20000);
    // Of n sources n (n - 1) / (2 (2 n - 3)) second orders are expected (Shreve 1966), a quarter of them.
    EXPECT_NEAR(static_cast<double>(counts.streams[1]) / 20000.0, 0.25, 0.01);
    EXPECT_NEAR(static_cast<double>(counts.streams[2]) / static_cast<double>(counts.streams[1]), 0.25, 0.02);
    EXPECT_NEAR(counts.side[0], 1.0, 0.05);
    EXPECT_NEAR(counts.side[1], 2.0, 0.15);
    EXPECT_NEAR(counts.side[2], 4.0, 0.5);
    ASSERT_TRUE(laws.horton.bifurcation);
    EXPECT_NEAR(laws.horton.bifurcation->ratio, 4.0, 0.5);
}

TEST(LawsOfLines, ScheideggersRiversHaveTheirExponents) {
    // Water runs south-west or south-east, at random.
    constexpr std::int64_t columns = 240;
    constexpr std::int64_t rows = 240;
    auto const index = [](std::int64_t col, std::int64_t row) { return static_cast<std::size_t>(row * columns + col); };
    std::vector<Vec2> at;
    for (std::int64_t row = 0; row < rows; ++row) {
        for (std::int64_t col = 0; col < columns; ++col) {
            at.push_back({500000.0 + 100.0 * (static_cast<double>(col) + 0.5 * static_cast<double>(row % 2)),
                          5000000.0 + 100.0 * static_cast<double>(row)});
        }
    }
    std::vector<double> area(at.size(), 1.0);
    std::vector<std::size_t> below(at.size(), at.size());
    for (std::int64_t row = rows - 1; row > 0; --row) {
        for (std::int64_t col = 0; col < columns; ++col) {
            auto const step = static_cast<std::int64_t>((random_word(5, index(col, row)) >> 13U) & 1U);
            std::int64_t const to = std::clamp<std::int64_t>(col + (row % 2 == 0 ? step - 1 : step), 0, columns - 1);
            below[index(col, row)] = index(to, row - 1);
            area[index(to, row - 1)] += area[index(col, row)];
        }
    }
    Rivers rivers;
    NetworkDraft net;
    std::map<std::size_t, NodeId> node; // of those with arcs
    auto const node_at = [&](std::size_t i) {
        auto const [found, is_new] = node.try_emplace(i, net.nodes.size());
        if (is_new) {
            net.add_node(at[i]);
        }
        return found->second;
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (below[i] < at.size()) {
            Arc arc;
            arc.line = {at[i], at[below[i]]};
            net.add_arc(node_at(i), node_at(below[i]), std::move(arc));
            rivers.us_area_m2.push_back(1e4 * area[i]);
            rivers.ds_area_m2.push_back(1e4 * area[i]);
        }
    }
    rivers.plan = StreamNetwork(std::move(net));
    network::StreamCounts counts;
    measure::NetworkLaws const laws = laws_of(rivers, counts);
    ASSERT_TRUE(laws.hack && laws.horton.bifurcation);
    // Dodds and Rothman (2000): h = 2/3, R_n = 5.2 in the limit; here the border cuts the highest orders.
    EXPECT_NEAR(laws.hack->exponent, 2.0 / 3.0, 0.03);
    EXPECT_NEAR(laws.horton.bifurcation->ratio, 5.2, 0.7);
}

} // namespace hydrography_test
