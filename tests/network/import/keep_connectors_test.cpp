// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/vec.hpp>

namespace keep_connectors_test {

using namespace thalweg;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

RiverLine line(std::int64_t feature, std::vector<Vec2> const& plan, std::string artificial = "") {
    RiverLine one;
    one.feature = feature;
    for (Vec2 const p : plan) {
        one.vertices.push_back({p.x, p.y, none});
    }
    one.artificial = std::move(artificial);
    return one;
}

RiverLines file(std::vector<RiverLine> rivers, std::vector<RiverLine> channels) {
    RiverLines lines;
    lines.lines = std::move(rivers);
    lines.channels = std::move(channels);
    return lines;
}

/// Feature and length of the channels that are kept.
std::vector<std::pair<std::int64_t, double>> kept(RiverLines const& before) {
    RiverLines const after = network::keep_connectors(before, 0.0);
    EXPECT_TRUE(after.channels.empty());
    std::vector<std::pair<std::int64_t, double>> result;
    double of_channels = 0.0;
    for (std::size_t l = 0; l < after.lines.size(); ++l) {
        if (l < before.lines.size()) {
            EXPECT_EQ(after.lines[l].feature, before.lines[l].feature);
        } else {
            EXPECT_FALSE(after.lines[l].artificial.empty());
            result.emplace_back(after.lines[l].feature, length_in_plan(after.lines[l].vertices));
            of_channels += result.back().second;
        }
    }
    EXPECT_EQ(std::ranges::count(after.findings, "connector", &Finding::kind), std::ssize(result));
    for (SecondaryLine const& one : after.secondary) {
        EXPECT_EQ(one.cause, LeftOut::filter);
        EXPECT_EQ(one.reason, "waterway ditch");
        of_channels += length_in_plan(one.vertices);
    }
    double given = 0.0;
    for (RiverLine const& channel : before.channels) {
        given += length_in_plan(channel.vertices);
    }
    EXPECT_NEAR(of_channels, given, 1e-9); // law: each metre is kept or left out
    return result;
}

using Kept = std::vector<std::pair<std::int64_t, double>>;
std::string const ditch = "waterway ditch";

} // namespace

TEST(KeepConnectors, NothingToKeep) {
    EXPECT_EQ(kept(file({}, {})), Kept{});
    EXPECT_EQ(kept(file({}, {line(1, {{0, 0}, {5, 0}}, ditch)})), Kept{});
    EXPECT_EQ(kept(file({line(1, {{0, 9}, {0, 0}})}, {line(2, {{50, 0}, {60, 0}}, ditch)})), Kept{});
}

TEST(KeepConnectors, ARiverContinuesThroughADitch) {
    std::vector<RiverLine> const rivers = {line(1, {{0, 100}, {0, 50}}), line(2, {{0, 30}, {0, 0}})};
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {0, 30}}, ditch)})), (Kept{{3, 20.0}}));
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 30}, {0, 50}}, ditch)})), (Kept{{3, 20.0}})) << "drawn against the flow";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {0, 40}}, ditch), line(4, {{0, 40}, {0, 30}}, ditch)})),
              (Kept{{3, 10.0}, {4, 10.0}}));
}

TEST(KeepConnectors, DitchesThatNoRiverNeedsAreLeftOut) {
    std::vector<RiverLine> const rivers = {line(1, {{0, 100}, {0, 50}, {0, 0}}), line(2, {{80, 90}, {80, 0}})};
    EXPECT_EQ(kept(file(rivers, {line(3, {{30, 60}, {0, 50}}, ditch)})), Kept{}) << "it drains a field";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {30, 40}}, ditch)})), Kept{}) << "it irrigates one";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {80, 90}}, ditch)})), Kept{}) << "it feeds another river";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 0}, {0, -50}}, ditch)})), Kept{}) << "it leads to no river";
}

TEST(KeepConnectors, OnlyTheNeededPartOfACanalIsKept) {
    EXPECT_EQ(kept(file({line(1, {{0, 100}, {0, 50}}), line(2, {{20, 50}, {20, 0}})},
                        {line(3, {{-40, 50}, {0, 50}, {10, 50}, {20, 50}, {90, 50}}, ditch)})),
              (Kept{{3, 20.0}}));
}

TEST(KeepConnectors, TheShorterOfTwoWaysIsKept) {
    EXPECT_EQ(kept(file({line(1, {{0, 100}, {0, 50}}), line(2, {{0, 30}, {0, 0}})},
                        {line(3, {{0, 50}, {15, 40}, {0, 30}}, ditch), line(4, {{0, 50}, {0, 30}}, ditch)})),
              (Kept{{4, 20.0}}));
}

TEST(KeepConnectors, RiversThatAreDrawnUpstreamEndWhereTheyBegin) {
    // One source and two ends: the group is drawn upstream, and so is the river without a tributary.
    EXPECT_EQ(kept(file({line(1, {{0, 50}, {0, 80}}), line(2, {{0, 80}, {9, 99}}), line(3, {{0, 80}, {-9, 99}}),
                         line(4, {{0, 0}, {0, 30}})},
                        {line(5, {{0, 50}, {0, 30}}, ditch)})),
              (Kept{{5, 20.0}}));
}

TEST(KeepConnectors, HeightsDecideWhereARiverEnds) {
    RiverLines lines =
        file({line(1, {{0, 50}, {0, 100}}), line(2, {{0, 30}, {0, 0}})}, {line(3, {{0, 50}, {0, 30}}, ditch)});
    EXPECT_EQ(kept(lines), Kept{});
    lines.lines[0].vertices[0].z = 5.0;
    lines.lines[0].vertices[1].z = 9.0;
    lines.lines[1].vertices[0].z = lines.lines[1].vertices[1].z = 1.0;
    lines.has_z = true;
    EXPECT_EQ(kept(lines), (Kept{{3, 20.0}}));
    EXPECT_FALSE(network::keep_connectors(lines, 0.0).has_z); // the ditch has none yet
}

TEST(KeepConnectors, EndsMeetWithinTheSnappingDistance) {
    RiverLines const lines =
        file({line(1, {{0, 100}, {0, 52}}), line(2, {{1, 29}, {0, 0}})}, {line(3, {{0, 50}, {0, 30}}, ditch)});
    EXPECT_EQ(kept(lines), Kept{});
    EXPECT_EQ(network::keep_connectors(lines, 3.0).lines.size(), 3U);
}

} // namespace keep_connectors_test
