// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/error.hpp>

#include "dems.hpp"
#include "trees.hpp"

using namespace thalweg;
using measure::as_file;
using measure::check_topology;
using measure::TopologyReport;

namespace {

using FileArc = NetworkFile::FileArc;
constexpr std::int64_t new_id = std::int64_t{1} << 62;
double const no_number = std::numeric_limits<double>::quiet_NaN();

NetworkFile clean(std::uint64_t seed, std::int64_t cols = 12, std::int64_t rows = 12) {
    RaisedNetwork const rivers = random_rivers(seed, cols, rows);
    return as_file(rivers, orders_of(rivers.plan));
}

std::multiset<std::string> kinds_of(TopologyReport const& report) {
    std::multiset<std::string> kinds;
    for (Finding const& f : report.findings) {
        kinds.insert(f.kind);
    }
    return kinds;
}

bool names(TopologyReport const& report, std::string const& kind, std::int64_t feature) {
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](Finding const& f) { return f.kind == kind && f.feature == feature; });
}

Vec3 between(Vec3 p, Vec3 q, double t) {
    return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
}

/// One fault: put into a clean file at arc k, it returns the feature that the finding must name.
struct Fault {
    char const* kind;
    std::function<std::int64_t(NetworkFile&, std::size_t k)> plant;
    std::set<std::string> besides = {}; ///< kinds that it cannot help but cause as well
};

std::vector<Fault> const faults = {
    {"bad_arc_id", [](NetworkFile& f, std::size_t k) { return f.arcs[k].id = -new_id; }, {"ds_arc_mismatch"}},
    {"duplicate_arc_id",
     [](NetworkFile& f, std::size_t k) { return f.arcs[k].id = f.arcs[(k + 1) % f.arcs.size()].id; },
     {"ds_arc_mismatch"}},
    {"duplicate_node_id",
     [](NetworkFile& f, std::size_t k) {
         f.nodes.push_back(f.nodes[k % f.nodes.size()]);
         return f.nodes.back().id;
     }},
    {"null_geometry",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line.clear();
         return f.arcs[k].id;
     }},
    {"null_geometry",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line.resize(1);
         return f.arcs[k].id;
     }},
    {"nan",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line[1].z = no_number;
         return f.arcs[k].id;
     }},
    {"nan",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line[0].x = -std::numeric_limits<double>::infinity();
         return f.arcs[k].id;
     }},
    {"nan",
     [](NetworkFile& f, std::size_t k) {
         auto& node = f.nodes[k % f.nodes.size()];
         node.at.y = 1e18;
         return node.id;
     }},
    {"zero_length",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line = {f.arcs[k].line[0], f.arcs[k].line[0]};
         return f.arcs[k].id;
     },
     {"end_mismatch"}},
    {"repeated_vertex",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line.insert(f.arcs[k].line.begin() + 1, f.arcs[k].line[1]);
         return f.arcs[k].id;
     }},
    {"z_rising",
     [](NetworkFile& f, std::size_t k) {
         auto& line = f.arcs[k].line;
         Vec3 high = between(line[0], line[1], 0.5);
         high.z = std::nextafter(line[0].z, 1e300);
         line.insert(line.begin() + 1, high);
         return f.arcs[k].id;
     }},
    {"duplicate_geometry",
     [](NetworkFile& f, std::size_t k) {
         f.arcs.push_back(f.arcs[k]);
         return f.arcs.back().id = new_id;
     },
     {"several_outflows", "strahler_mismatch", "shreve_mismatch"}},
    {"duplicate_geometry",
     [](NetworkFile& f, std::size_t k) {
         FileArc back = f.arcs[k];
         std::reverse(back.line.begin(), back.line.end());
         std::swap(back.from_node, back.to_node);
         back.id = new_id;
         f.arcs.push_back(back);
         return new_id;
     },
     {"several_outflows", "z_rising", "cycle", "no_outlet", "ds_arc_mismatch", "strahler_mismatch", "shreve_mismatch",
      "basin_mismatch"}},
    {"missing_node",
     [](NetworkFile& f, std::size_t k) {
         // Nothing else is lost with the node of a source.
         auto const source = std::find_if(f.arcs.begin() + static_cast<std::ptrdiff_t>(k), f.arcs.end(),
                                          [](FileArc const& arc) { return arc.shreve == 1; });
         std::erase_if(f.nodes, [&](auto const& node) { return node.id == source->from_node; });
         return source->id;
     }},
    {"missing_node",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].to_node = new_id;
         return f.arcs[k].id;
     },
     {"crossing", "ds_arc_mismatch", "strahler_mismatch", "shreve_mismatch", "basin_mismatch", "isolated_node"}},
    {"end_mismatch",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line.back().z = std::nextafter(f.arcs[k].line.back().z, -1.0);
         return f.arcs[k].id;
     }},
    {"end_mismatch",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].line.front().x = std::nextafter(f.arcs[k].line.front().x, 1e9);
         return f.arcs[k].id;
     }},
    {"several_outflows",
     [](NetworkFile& f, std::size_t k) {
         // A way out into nowhere, short enough not to meet anything.
         FileArc const& arc = f.arcs[k];
         Vec3 const start = arc.line[0];
         Vec3 const end{start.x + 0.03, start.y + 0.1, start.z};
         f.nodes.push_back({new_id, end});
         f.arcs.push_back({new_id, arc.from_node, new_id, 0, arc.strahler, arc.shreve, new_id, {start, end}});
         return f.arcs.back().from_node;
     }},
    {"isolated_node",
     [](NetworkFile& f, std::size_t) {
         f.nodes.push_back({-new_id, {-7.0, -7.0, 0.0}});
         return -new_id;
     }},
    {"cycle",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].to_node = f.arcs[k].from_node;
         return f.arcs[k].id;
     },
     {"no_outlet", "end_mismatch", "crossing", "ds_arc_mismatch", "strahler_mismatch", "shreve_mismatch", "isolated_node"}},
    {"ds_arc_mismatch",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].ds_arc = f.arcs[k].ds_arc == 0 ? new_id : 0;
         return f.arcs[k].id;
     }},
    {"strahler_mismatch",
     [](NetworkFile& f, std::size_t k) {
         ++f.arcs[k].strahler;
         return f.arcs[k].id;
     }},
    {"shreve_mismatch",
     [](NetworkFile& f, std::size_t k) {
         f.arcs[k].shreve = std::numeric_limits<std::int64_t>::min();
         return f.arcs[k].id;
     }},
    {"basin_mismatch",
     [](NetworkFile& f, std::size_t k) {
         auto const inner = std::find_if(f.arcs.begin() + static_cast<std::ptrdiff_t>(k), f.arcs.end(),
                                         [](FileArc const& arc) { return arc.shreve == 1 && arc.ds_arc != 0; });
         inner->basin = new_id;
         return inner->id;
     }},
    {"not_simple",
     [](NetworkFile& f, std::size_t k) {
         auto& line = f.arcs[k].line;
         Vec3 const a = line[0];
         Vec3 const b = line[1];
         Vec3 back = between(a, b, 0.25); // runs back over itself
         back.z = between(a, b, 0.5).z;
         line.insert(line.begin() + 1, {between(a, b, 0.5), back});
         return f.arcs[k].id;
     }},
    {"crossing",
     [](NetworkFile& f, std::size_t k) {
         auto const& line = f.arcs[k].line;
         Vec3 const middle = between(line[0], line[1], 0.5);
         Vec3 const west{middle.x - 0.05, middle.y, middle.z};
         Vec3 const east{middle.x + 0.05, middle.y, middle.z};
         f.nodes.push_back({new_id, west});
         f.nodes.push_back({new_id + 1, east});
         f.arcs.push_back({new_id, new_id, new_id + 1, 0, 1, 1, new_id, {west, east}});
         return new_id;
     }},
    {"crossing",
     [](NetworkFile& f, std::size_t k) {
         // A tributary that ends on a river where that has no node.
         auto const& line = f.arcs[k].line;
         Vec3 const joint = between(line[0], line[1], 0.5);
         Vec3 const source{joint.x + 0.05, joint.y, joint.z};
         f.nodes.push_back({new_id, source});
         f.nodes.push_back({new_id + 1, joint});
         f.arcs.push_back({new_id, new_id, new_id + 1, 0, 1, 1, new_id, {source, joint}});
         return new_id;
     }},
};

} // namespace

TEST(CheckTopology, EmptyFile) {
    TopologyReport const report = check_topology({});
    EXPECT_EQ(kinds_of(report), std::multiset<std::string>{"empty"});
    EXPECT_EQ(report.findings[0].feature, 0);
}

TEST(CheckTopology, OneArc) {
    NetworkFile file;
    file.nodes = {{7, {0, 0, 1}}, {9, {5, 0, 0}}};
    file.arcs = {{3, 7, 9, 0, 1, 1, 1, {{0, 0, 1}, {5, 0, 0}}}};
    TopologyReport const report = check_topology(file);
    EXPECT_TRUE(report.findings.empty());
    EXPECT_EQ(report.checks.size(), 22U);
    for (Check const& check : report.checks) {
        EXPECT_TRUE(check.ok) << check.name;
        EXPECT_EQ(check.value, 0.0);
    }
}

TEST(CheckTopology, ConfluenceOfThreeAndPseudoNodeAreAllowed) {
    NetworkFile file;
    file.nodes = {{1, {0, 2, 3}}, {2, {1, 2, 3}}, {3, {2, 2, 3}}, {4, {1, 1, 2}}, {5, {1, 0, 1}}, {6, {1, -1, 0}}};
    file.arcs = {{1, 1, 4, 4, 1, 1, 0, {{0, 2, 3}, {1, 1, 2}}},
                 {2, 2, 4, 4, 1, 1, 0, {{1, 2, 3}, {1, 1, 2}}},
                 {3, 3, 4, 4, 1, 1, 0, {{2, 2, 3}, {1, 1, 2}}},
                 {4, 4, 5, 5, 2, 3, 0, {{1, 1, 2}, {1, 0, 1}}},
                 {5, 5, 6, 0, 2, 3, 0, {{1, 0, 1}, {1, -1, 0}}}};
    EXPECT_EQ(kinds_of(check_topology(file)), std::multiset<std::string>{});
}

TEST(CheckTopology, SaysWhatWhereAndHowMuch) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 5}}, {2, {4, 0, 1}}};
    file.arcs = {{8, 1, 2, 0, 1, 1, 1, {{0, 0, 5}, {1, 2, 2}, {2, 1, 4.5}, {4, 0, 1}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(report.findings.size(), 1U);
    Finding const& f = report.findings[0];
    EXPECT_EQ(f.kind, "z_rising");
    EXPECT_EQ(f.feature, 8);
    EXPECT_EQ(f.where, (Vec2{2, 1}));
    EXPECT_EQ(f.amount, 2.5);
    EXPECT_EQ(f.text, "arc 8: runs uphill by 2.5 m to vertex 2 at (2, 1)");
    auto const check = std::find_if(report.checks.begin(), report.checks.end(), [](Check const& c) { return !c.ok; });
    EXPECT_EQ(check->name, "z_rising");
    EXPECT_EQ(check->value, 1.0);
}

TEST(CheckTopology, LoopOnItself) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 5}}, {2, {0, 1, 1}}};
    file.arcs = {{8, 1, 2, 0, 1, 1, 1, {{0, 0, 5}, {2, 2, 4}, {2, -1, 3}, {0, 1, 1}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"not_simple"});
    EXPECT_EQ(report.findings[0].where, (Vec2{0.5, 0.5}));
}

TEST(CheckTopology, TouchOnItsOwnStart) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 5}}, {2, {-3, 0, 1}}};
    file.arcs = {{8, 1, 2, 0, 1, 1, 1, {{0, 0, 5}, {2, 2, 4}, {2, -1, 3}, {0, 0, 2}, {-3, 0, 1}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"not_simple"});
    EXPECT_EQ(report.findings[0].where, (Vec2{0, 0}));
}

TEST(CheckTopology, CircleWithATributary) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 0}}, {2, {4, 0, 0}}, {3, {2, 3, 0}}, {4, {9, 0, 1}}};
    file.arcs = {{40, 4, 2, 20, 1, 1, 1, {{9, 0, 1}, {4, 0, 0}}},
                 {10, 1, 2, 20, 1, 1, 1, {{0, 0, 0}, {4, 0, 0}}},
                 {20, 2, 3, 30, 1, 1, 1, {{4, 0, 0}, {2, 3, 0}}},
                 {30, 3, 1, 10, 1, 1, 1, {{2, 3, 0}, {0, 0, 0}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), (std::multiset<std::string>{"cycle", "no_outlet"}));
    EXPECT_EQ(report.findings[0].feature, 10);
    EXPECT_EQ(report.findings[0].amount, 3.0);
    EXPECT_EQ(report.findings[1].feature, 40);
    EXPECT_EQ(report.findings[1].amount, 4.0);
}

TEST(CheckTopology, TwoOutletsMustNotShareABasin) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 1}}, {2, {1, 0, 0}}, {3, {0, 5, 1}}, {4, {1, 5, 0}}};
    file.arcs = {{1, 1, 2, 0, 1, 1, 6, {{0, 0, 1}, {1, 0, 0}}}, {2, 3, 4, 0, 1, 1, 6, {{0, 5, 1}, {1, 5, 0}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"basin_mismatch"});
    EXPECT_EQ(report.findings[0].feature, 2);
}

TEST(CheckTopology, OverlapIsACrossing) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 1}}, {2, {4, 0, 0}}, {3, {2, 0, 1}}, {4, {6, 0, 0}}};
    file.arcs = {{1, 1, 2, 0, 1, 1, 1, {{0, 0, 1}, {4, 0, 0}}}, {2, 3, 4, 0, 1, 1, 2, {{2, 0, 1}, {6, 0, 0}}}};
    EXPECT_EQ(kinds_of(check_topology(file)), (std::multiset<std::string>{"crossing", "crossing"}));
}

TEST(CheckTopology, RiversThatPartWithoutEnd) {
    // 100 times two ways from one node to the next: 2^100 sources.
    NetworkFile file;
    for (std::int64_t i = 0; i <= 100; ++i) {
        double const x = static_cast<double>(i);
        file.nodes.push_back({i, {x, 0, -x}});
        if (i > 0) {
            file.arcs.push_back({2 * i - 1, i - 1, i, 0, 1, 1, 1, {{x - 1, 0, 1 - x}, {x, 0, -x}}});
            file.arcs.push_back({2 * i, i - 1, i, 0, 1, 1, 1, {{x - 1, 0, 1 - x}, {x - 0.5, 0.5, -x}, {x, 0, -x}}});
        }
    }
    TopologyReport const report = check_topology(file);
    EXPECT_EQ(kinds_of(report).count("several_outflows"), 100U);
    auto const last = std::find_if(report.findings.begin(), report.findings.end(),
                                   [](Finding const& f) { return f.kind == "shreve_mismatch" && f.feature == 200; });
    ASSERT_NE(last, report.findings.end());
    EXPECT_EQ(last->amount, 0x1p63); // as many as can be counted
}

TEST(CheckTopology, CleanNetworksHaveNoFinding) {
    ASSERT_TRUE(rc::check("random rivers are clean", [] {
        auto const cols = *evenly<std::int64_t>(1, 15);
        auto const rows = *evenly<std::int64_t>(2, 15);
        TopologyReport const report = check_topology(clean(*rc::gen::arbitrary<std::uint64_t>(), cols, rows));
        RC_ASSERT(kinds_of(report) == std::multiset<std::string>{});
    }));
}

TEST(CheckTopology, EachFaultIsFoundAndNamed) {
    std::set<std::string> planted = {"empty", "no_outlet"}; // above
    for (std::size_t i = 0; i < faults.size(); ++i) {
        Fault const& fault = faults[i];
        planted.insert(fault.kind);
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            NetworkFile file = clean(seed);
            // Not the last arcs: some faults look for their place from k on.
            auto const k = static_cast<std::size_t>(chance(seed, 99) % (file.arcs.size() / 2));
            std::int64_t const feature = fault.plant(file, k);
            TopologyReport const report = check_topology(file);
            ASSERT_TRUE(names(report, fault.kind, feature)) << "fault " << i << ", " << fault.kind << ", seed " << seed;
            for (Finding const& f : report.findings) {
                ASSERT_TRUE(f.kind == fault.kind || fault.besides.count(f.kind) > 0)
                    << "fault " << i << ", " << fault.kind << ", seed " << seed << " also found " << f.text;
            }
        }
    }
    for (Check const& check : check_topology({}).checks) {
        EXPECT_TRUE(planted.count(check.name) > 0) << check.name << " has no test";
    }
}

TEST(CheckTopology, NothingInAFileIsAnError) {
    ASSERT_TRUE(rc::check("rubbish gives findings that add up", [] {
        constexpr std::int64_t huge = std::numeric_limits<std::int64_t>::max();
        auto const id = rc::gen::element<std::int64_t>(0, 1, 2, 3, 4, 5, 6, huge, -huge - 1);
        auto const number = rc::gen::element(0.0, -0.0, 1.0, 2.0, 3.0, 0.1, 1e-300, 1e17, 1e300, no_number,
                                             std::numeric_limits<double>::infinity());
        auto const tame = rc::gen::element(0.0, 1.0, 2.0, 3.0, 0.1);
        auto const coordinate = *rc::gen::element(0, 1) == 0 ? number : tame;
        auto const point = rc::gen::exec([=] { return Vec3{*coordinate, *coordinate, *coordinate}; });
        auto const line = rc::gen::resize(5, rc::gen::container<std::vector<Vec3>>(point));
        NetworkFile file;
        file.nodes = *rc::gen::container<std::vector<NetworkFile::FileNode>>(rc::gen::exec([=] {
            return NetworkFile::FileNode{*id, *point};
        }));
        file.arcs = *rc::gen::container<std::vector<FileArc>>(
            rc::gen::exec([=] { return FileArc{*id, *id, *id, *id, *id, *id, *id, *line}; }));
        TopologyReport const report = check_topology(file);
        double counted = 0.0;
        for (Check const& check : report.checks) {
            counted += check.value;
            RC_ASSERT(check.ok == (check.value == 0.0));
        }
        RC_ASSERT(counted == static_cast<double>(report.findings.size()));
        for (Finding const& f : report.findings) {
            RC_ASSERT((std::isfinite(f.where.x) && std::isfinite(f.where.y) && std::isfinite(f.amount)));
            RC_ASSERT((!f.text.empty() && f.text.find('\n') == std::string::npos));
        }
        RC_ASSERT((!report.findings.empty() || !file.arcs.empty()));
    }));
}

TEST(CheckTopology, AHundredThousandArcs) {
    NetworkFile file = clean(1, 520, 520);
    ASSERT_GT(file.arcs.size(), 100'000U);
    file.arcs[70'000].line.back().z -= 1e-9;
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0].feature, 70'001);
    EXPECT_EQ(report.findings[0].kind, "end_mismatch");
}

TEST(CheckTopology, StopsWhenAsked) {
    thalweg::Run run;
    run.progress = [](double, char const*, void*) { return 0; };
    EXPECT_THROW(check_topology(clean(1), run), Cancelled);
}

TEST(AsFile, NumbersFromOne) {
    RaisedNetwork net;
    for (Vec2 const at : {Vec2{0, 1}, Vec2{0, 0}, Vec2{3, 0}}) {
        add_node(net.plan, at);
    }
    net.node_z = {2, 1, 0};
    add_arc(net.plan, 1, 2, {});
    add_arc(net.plan, 0, 1, {});
    net.arc_z = {{1, 0}, {2, 1}};
    NetworkOrders const orders = orders_of(net.plan);
    NetworkFile const file = as_file(net, orders);
    ASSERT_EQ(file.nodes.size(), 3U);
    EXPECT_EQ(file.nodes[0].id, 1);
    EXPECT_EQ(file.nodes[0].at, (Vec3{0, 1, 2}));
    ASSERT_EQ(file.arcs.size(), 2U);
    EXPECT_EQ(file.arcs[0].from_node, 2);
    EXPECT_EQ(file.arcs[0].to_node, 3);
    EXPECT_EQ(file.arcs[0].ds_arc, 0);
    EXPECT_EQ(file.arcs[1].id, 2);
    EXPECT_EQ(file.arcs[1].ds_arc, 1);
    EXPECT_EQ(file.arcs[1].basin, 1);
    EXPECT_EQ(file.arcs[1].line, (std::vector<Vec3>{{0, 1, 2}, {0, 0, 1}}));
    net.arc_z[1].push_back(0.0);
    EXPECT_THROW(as_file(net, orders), BadInput);
    EXPECT_THROW(as_file(net, {}), BadInput);
}
