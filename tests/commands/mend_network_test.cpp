// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/internal/repair_network.hpp>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "measure/faults.hpp"

namespace mend_network_test {

using namespace thalweg;
using commands::repair_network;
using commands::RepairedNetwork;
using measure::check_topology;

namespace {

RepairedNetwork mend(NetworkFile const& file) {
    return repair_network(file, check_topology(file));
}

std::vector<std::string> kinds_of(RepairedNetwork const& mended) {
    std::vector<std::string> kinds;
    for (Finding const& f : mended.mended) {
        kinds.push_back(f.kind);
    }
    return kinds;
}

/// Lines with their heights, sorted: a network without its numbers.
std::vector<std::vector<std::tuple<double, double, double>>> lines_of(NetworkFile const& file) {
    std::vector<std::vector<std::tuple<double, double, double>>> lines;
    for (auto const& arc : file.arcs) {
        auto& line = lines.emplace_back();
        for (Vec3 const p : arc.line) {
            line.emplace_back(p.x, p.y, p.z);
        }
    }
    std::sort(lines.begin(), lines.end());
    return lines;
}

} // namespace

TEST(MendNetwork, WhatHasNoFaultStays) {
    EXPECT_FALSE(mend({}).done);
    EXPECT_EQ(kinds_of(mend({})), std::vector<std::string>{"not_mended"});
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        NetworkFile const file = faults::clean(seed);
        RepairedNetwork const mended = mend(file);
        ASSERT_TRUE(mended.done);
        EXPECT_TRUE(mended.mended.empty()) << mended.mended.front().text;
        EXPECT_EQ(lines_of(measure::as_file(mended.network, mended.orders)), lines_of(file));
    }
}

TEST(MendNetwork, EveryFaultThatCanBeMendedIs) {
    for (std::size_t fault = 0; fault < faults::all().size(); ++fault) {
        auto const& f = faults::all()[fault];
        for (std::uint64_t seed = 0; seed < 5; ++seed) {
            NetworkFile file = faults::clean(seed);
            if (f.plant(file, random_word(seed, fault) % file.arcs.size()).empty()) {
                continue;
            }
            RepairedNetwork const mended = mend(file);
            std::string const why = mended.mended.empty() ? "nothing" : mended.mended.back().text;
            ASSERT_TRUE(mended.done) << f.kind << ", " << f.what << ", seed " << seed << ": " << why;
            EXPECT_FALSE(mended.mended.empty()) << f.kind << ", " << f.what << ": nothing is reported";
            // By the check itself.
            auto const left = check_topology(measure::as_file(mended.network, mended.orders)).findings;
            EXPECT_TRUE(left.empty()) << f.kind << ", " << f.what << ": " << left.front().text;
        }
    }
}

TEST(MendNetwork, NumbersAloneChangeNoLine) {
    NetworkFile file = faults::clean(5);
    auto const before = lines_of(file);
    file.arcs[3].strahler = 99;
    file.arcs[4].ds_arc = 99;
    file.arcs[5].to_node = 1;
    RepairedNetwork const mended = mend(file);
    ASSERT_TRUE(mended.done);
    EXPECT_EQ(kinds_of(mended), (std::vector<std::string>{"mended", "mended", "mended"}));
    EXPECT_EQ(lines_of(measure::as_file(mended.network, mended.orders)), before);
}

TEST(MendNetwork, AreasStayWhereTheEndDoes) {
    NetworkFile file = faults::clean(5);
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        file.arcs[a].us_area_m2 = 10.0 * static_cast<double>(file.arcs[a].shreve);
        file.arcs[a].ds_area_m2 = file.arcs[a].us_area_m2;
        file.arcs[a].feature = static_cast<std::int64_t>(1000 + a);
        file.arcs[a].braided = a == 7;
    }
    std::reverse(file.arcs[7].line.begin(), file.arcs[7].line.end());
    RepairedNetwork const mended = mend(file);
    ASSERT_TRUE(mended.done);
    EXPECT_EQ(kinds_of(mended), (std::vector<std::string>{"turned", "mended"}));
    ASSERT_EQ(mended.network.planform.arc_count(), file.arcs.size());
    for (std::size_t a = 0; a < mended.network.planform.arc_count(); ++a) {
        auto const was = static_cast<std::size_t>(mended.network.planform.arc(a).feature - 1000);
        EXPECT_EQ(mended.us_area_m2[a], file.arcs[was].us_area_m2);
        EXPECT_EQ(mended.ds_area_m2[a], file.arcs[was].ds_area_m2);
        EXPECT_EQ(mended.braided[a], was == 7 ? 1 : 0);
    }
}

TEST(MendNetwork, AnAreaIsRaisedToThatOfALargerInflowAndSaidSo) {
    // Two rivers of 6 and 5 km2 meet; below, the file says 9 km2, which holds where both count common water; then 4.
    auto const file_with = [](double below_m2, double inflow_m2) {
        NetworkFile file;
        file.schema = "nhdplus";
        file.says.nodes = false;
        file.nodes = {{1, {0, 2000, 8}}, {2, {2000, 2000, 8}}, {3, {1000, 1000, 4}}, {4, {1000, 0, 0}}};
        file.arcs = {{1, 1, 3, 3, 1, 1, 4, {{0, 2000, 8}, {1000, 1000, 4}}},
                     {2, 2, 3, 3, 1, 1, 4, {{2000, 2000, 8}, {1000, 1000, 4}}},
                     {3, 3, 4, 0, 2, 2, 4, {{1000, 1000, 4}, {1000, 0, 0}}}};
        file.arcs[0].ds_area_m2 = 6e6;
        file.arcs[1].ds_area_m2 = inflow_m2;
        file.arcs[2].us_area_m2 = below_m2;
        file.arcs[2].ds_area_m2 = below_m2;
        return file;
    };
    RepairedNetwork const kept = mend(file_with(9e6, 5e6));
    ASSERT_TRUE(kept.done);
    EXPECT_TRUE(kept.mended.empty());
    EXPECT_EQ(kept.ds_area_m2, (std::vector<double>{6e6, 5e6, 9e6}));
    EXPECT_EQ(kept.us_area_m2, (std::vector<double>{-1.0, -1.0, 9e6}));
    RepairedNetwork const raised = mend(file_with(4e6, 5e6));
    ASSERT_TRUE(raised.done);
    EXPECT_EQ(kinds_of(raised), std::vector<std::string>{"area_raised"});
    EXPECT_EQ(raised.mended[0].feature, 3);
    EXPECT_EQ(raised.mended[0].amount, 2e6);
    EXPECT_EQ(raised.ds_area_m2, (std::vector<double>{6e6, 5e6, 6e6}));
    RepairedNetwork const unknown = mend(file_with(9e6, faults::no_number));
    EXPECT_EQ(unknown.ds_area_m2, (std::vector<double>{6e6, -1.0, 9e6}));
}

TEST(MendNetwork, WithoutHeightsThereAreNone) {
    NetworkFile file = faults::clean(5);
    for (auto& arc : file.arcs) {
        for (Vec3& p : arc.line) {
            p.z = faults::no_number;
        }
    }
    for (auto& node : file.nodes) {
        node.at.z = faults::no_number;
    }
    file.says.heights = false;
    RepairedNetwork const mended = mend(file);
    ASSERT_TRUE(mended.done);
    EXPECT_EQ(kinds_of(mended), std::vector<std::string>{"level"});
    EXPECT_FALSE(mended.has_heights);
    EXPECT_EQ(std::count(mended.network.node_z.begin(), mended.network.node_z.end(), 0.0),
              static_cast<std::ptrdiff_t>(mended.network.node_z.size()));
}

TEST(MendNetwork, AHeightIsFilledBetweenItsNeighbours) {
    NetworkFile file;
    file.nodes = {{1, {0, 0, 8}}, {2, {4, 0, 0}}};
    file.arcs = {{1, 1, 2, 0, 1, 1, 1, {{0, 0, 8}, {1, 0, 6}, {2, 0, faults::no_number}, {3, 1, 2}, {4, 0, 0}}}};
    RepairedNetwork const mended = mend(file);
    ASSERT_TRUE(mended.done);
    EXPECT_EQ(mended.network.arc_z.front(), (std::vector<double>{8, 6, 4, 2, 0}));
}

} // namespace mend_network_test
