// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology/topology.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

#include "dems.hpp"
#include "faults.hpp"
#include "star.hpp"

namespace topology_test {

using namespace thalweg;
using measure::as_file;
using measure::check_topology;
using measure::TopologyReport;

namespace {

using faults::clean;
using faults::no_number;

using FileArc = NetworkFile::FileArc;

std::multiset<std::string> kinds_of(TopologyReport const& report) {
    std::multiset<std::string> kinds;
    for (Finding const& f : report.findings) {
        kinds.insert(f.kind);
    }
    return kinds;
}

constexpr std::size_t instances = 20;

/// What is wrong with the report of one planted fault; "" for nothing.
std::string complaint(faults::Fault const& fault, faults::Features const& features,
                      measure::TopologyReport const& report) {
    bool named = false;
    for (Finding const& f : report.findings) {
        bool const is_it = f.kind == fault.kind;
        named = named || (is_it && std::find(features.begin(), features.end(), f.feature) != features.end());
        if (!is_it && fault.besides.count(f.kind) == 0) {
            return "found besides: " + std::string(f.kind) + ": " + f.text;
        }
    }
    return named ? "" : "not found";
}

/// Every fault `times` times in networks of so many arcs, of which `networks` differ.
void expect_all_found(std::size_t arcs, std::size_t networks, std::size_t times = instances) {
    std::vector<NetworkFile> clean;
    for (std::size_t seed = 0; seed < networks; ++seed) {
        clean.push_back(faults::clean_of(arcs, seed));
        ASSERT_GE(clean.back().arcs.size(), arcs);
        auto const findings = measure::check_topology(clean.back()).findings;
        ASSERT_TRUE(findings.empty()) << findings.front().text;
    }
    auto const& all = faults::all();
    std::mutex one_at_a_time;
    auto const plant = [&](std::size_t fault, std::size_t instance) {
        for (std::uint64_t seed = instance;; seed += instances) { // until there is a place for it
            NetworkFile file = clean[seed % networks];
            auto const features = all[fault].plant(file, random_word(seed, fault) % file.arcs.size());
            if (features.empty()) {
                ASSERT_LT(seed, 1000 * instances) << all[fault].kind << " has no place";
                continue;
            }
            std::string const wrong = complaint(all[fault], features, measure::check_topology(file));
            std::lock_guard const lock(one_at_a_time);
            EXPECT_EQ(wrong, "") << all[fault].kind << ", " << all[fault].what << ", instance " << instance << ", arc "
                                 << features.front();
            return;
        }
    };
    parallel_ranges({}, static_cast<std::int64_t>(all.size() * times), 1, [&](auto first, auto last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
            plant(i / times, i % times);
        }
    });
}

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
    EXPECT_EQ(report.checks.size(), 29U);
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

TEST(CheckTopology, ArcsAreNamedAsInTheirFile) {
    auto const y = [](std::int64_t shift) {
        NetworkFile file;
        file.id_shift = shift;
        file.nodes = {{1, {0, 0, 0}}, {2, {0, 9, 1}}, {3, {-5, 20, 2}}, {4, {5, 20, 2}}};
        file.arcs = {{.id = 5 + shift,
                      .from_node = 2,
                      .to_node = 1,
                      .strahler = 2,
                      .shreve = 2,
                      .basin = 1,
                      .line = {{0, 9, 1}, {0, 0, 0}}},
                     {.id = 6 + shift,
                      .from_node = 3,
                      .to_node = 2,
                      .ds_arc = 7 + shift,
                      .strahler = 1,
                      .shreve = 1,
                      .basin = 1,
                      .line = {{-5, 20, 2}, {0, 9, 1}}},
                     {.id = 7 + shift,
                      .from_node = 4,
                      .to_node = 2,
                      .ds_arc = 5 + shift,
                      .strahler = 3,
                      .shreve = 1,
                      .basin = 1,
                      .line = {{5, 20, 2}, {-5, 15, 1.5}, {0, 9, 1}}}};
        return check_topology(file).findings;
    };
    auto const plain = y(0);
    auto const shifted = y(1);
    ASSERT_GE(plain.size(), 3U); // a crossing, a wrong ds_arc, a wrong order
    ASSERT_EQ(plain.size(), shifted.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_EQ(plain[i].feature, shifted[i].feature) << shifted[i].text;
        EXPECT_EQ(plain[i].amount, shifted[i].amount) << shifted[i].text;
        if (plain[i].kind != "ds_arc_mismatch") { // which also tells what stands for none
            EXPECT_EQ(plain[i].text, shifted[i].text);
        }
    }
}

TEST(CheckTopology, LoopOnItself) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 5}}, {2, {0, 1, 1}}};
    file.arcs = {{8, 1, 2, 0, 1, 1, 1, {{0, 0, 5}, {2, 2, 4}, {2, -1, 3}, {0, 1, 1}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"self_touching"});
    EXPECT_EQ(report.findings[0].where, (Vec2{0.5, 0.5}));
}

TEST(CheckTopology, TouchOnItsOwnStart) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 5}}, {2, {-3, 0, 1}}};
    file.arcs = {{8, 1, 2, 0, 1, 1, 1, {{0, 0, 5}, {2, 2, 4}, {2, -1, 3}, {0, 0, 2}, {-3, 0, 1}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"self_touching"});
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

TEST(CheckTopology, OverlapIsNoCrossingToo) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 1}}, {2, {4, 0, 0}}, {3, {2, 0, 1}}, {4, {6, 0, 0}}};
    file.arcs = {{1, 1, 2, 0, 1, 1, 1, {{0, 0, 1}, {4, 0, 0}}}, {2, 3, 4, 0, 1, 1, 2, {{2, 0, 1}, {6, 0, 0}}}};
    TopologyReport const report = check_topology(file);
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"overlap"});
    EXPECT_EQ(report.findings[0].feature, 2);
    EXPECT_EQ(report.findings[0].amount, 2.0);
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
    // Nothing is said of orders below the first: they are those of trees.
    EXPECT_EQ(kinds_of(check_topology(file)).count("several_outflows"), 100U);
    EXPECT_EQ(kinds_of(check_topology(file)).count("shreve_mismatch"), 0U);
}

TEST(CheckTopology, CleanNetworksHaveNoFinding) {
    ASSERT_TRUE(rc::check("random rivers are clean", [] {
        auto const cols = *evenly<std::int64_t>(1, 15);
        auto const rows = *evenly<std::int64_t>(2, 15);
        TopologyReport const report = check_topology(clean(*rc::gen::arbitrary<std::uint64_t>(), cols, rows));
        RC_ASSERT(kinds_of(report) == std::multiset<std::string>{});
    }));
}

TEST(CheckTopology, OnlyWhatTheFileSaysIsChecked) {
    NetworkFile file = clean(3);
    for (auto& arc : file.arcs) {
        arc.ds_arc = arc.strahler = arc.shreve = arc.basin = -1;
        for (Vec3& p : arc.line) {
            p.z = no_number;
        }
    }
    for (auto& node : file.nodes) {
        node.at.z = no_number;
    }
    file.says = {.downstream = false, .strahler = false, .shreve = false, .basin = false, .heights = false};
    EXPECT_EQ(kinds_of(check_topology(file)), std::multiset<std::string>{});
    std::reverse(file.arcs[5].line.begin(), file.arcs[5].line.end());
    EXPECT_EQ(kinds_of(check_topology(file)), std::multiset<std::string>{"wrong_direction"});
}

TEST(CheckTopology, NearIsWhatOneSays) {
    NetworkFile file = clean(3);
    Vec3 const joint = faults::between(file.arcs[0].line[0], file.arcs[0].line[1], 0.5);
    faults::add_arc(file, {faults::moved(joint, 0.2, 0.0), faults::moved(joint, 0.01, 0.0)});
    EXPECT_EQ(kinds_of(check_topology(file)), std::multiset<std::string>{});
    TopologyReport const report = check_topology(file, {.near_m = 0.02});
    ASSERT_EQ(kinds_of(report), std::multiset<std::string>{"dangling_end"});
    EXPECT_EQ(report.findings[0].feature, faults::new_id);
    EXPECT_THROW(check_topology(file, {.near_m = -1.0}), BadParameter);
    EXPECT_THROW(check_topology(file, {.near_m = no_number}), BadParameter);
}

TEST(CheckTopology, EveryKindHasAFault) {
    std::set<std::string> planted = {"empty"}; // above
    for (auto const& fault : faults::all()) {
        planted.insert(fault.kind);
    }
    for (std::string const& kind : measure::topology_kinds()) {
        EXPECT_TRUE(planted.count(kind) > 0) << kind << " has no test";
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
            RC_ASSERT(is_finite(f.where) == (f.kind != "empty"));
            RC_ASSERT(std::isfinite(f.amount));
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
    EXPECT_THROW(check_topology(clean(1), {}, run), Cancelled);
}

TEST(AsFile, NumbersFromOne) {
    ElevatedNetwork net;
    NetworkDraft plan;
    for (Vec2 const at : {Vec2{0, 1}, Vec2{0, 0}, Vec2{3, 0}}) {
        plan.add_node(at);
    }
    net.node_z = {2, 1, 0};
    plan.add_arc(1, 2);
    plan.add_arc(0, 1);
    net.planform = std::move(plan);
    net.arc_z = {{1, 0}, {2, 1}};
    NetworkOrders const orders = orders_of(net.planform);
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

// At a node any number of arcs may end: what is asked of each does not ask all others.
TEST(CheckTopology, ColumnsOfAHundredThousandArcsThatEndInOneNode) {
    faults::Star star(100'000);
    ASSERT_TRUE(star.before.empty());
    auto const of_arcs = [](Finding const& f) { return f.kind == "column_mismatch"; };
    auto const right = star.check_columns();
    EXPECT_EQ(std::ranges::count_if(right, of_arcs), 0) << right.front().text;
    star.file.arcs[7].columns.hack = 1.0;
    auto const wrong = star.check_columns();
    EXPECT_GT(std::ranges::count_if(wrong, of_arcs), 0);
}

// Each fault, twenty times at places at random, one a file: it is found, its feature named, and nothing is found beside
// what it cannot help but cause.

TEST(InjectedFaults, OfTenArcs) {
    expect_all_found(10, instances);
}

TEST(InjectedFaults, OfAThousandArcs) {
    expect_all_found(1000, 4);
}

TEST(SoakInjectedFaults, OfAHundredThousandArcs) {
    expect_all_found(100'000, 1);
}

} // namespace topology_test
