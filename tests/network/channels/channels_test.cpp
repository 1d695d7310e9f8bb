// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/channels.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <network/channel_laws.hpp>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace channels_test {

namespace {

using namespace thalweg;
using network::channels;
using network::ChannelsOfArcs;
using network::ChannelsParams;
using network::shorten;
using network::ShortenedChannels;

ChannelsParams literal() {
    return {.look_cells = 0, .stub_cells = 0};
}

/// '.' for land, else the direction in which the water of a channel goes: 0-7 as d8_steps, 'o' out.
std::string drawn(Channels const& rivers) {
    std::string picture;
    std::map<std::int64_t, std::size_t> number;
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        number[rivers.cell[i]] = i;
    }
    for (std::int64_t i = 0; i < rivers.grid.cells(); ++i) {
        auto const it = number.find(i);
        char sign = '.';
        if (it != number.end()) {
            std::int64_t const to = rivers.receiver[it->second];
            sign = 'o';
            for (std::size_t k = 0; to >= 0 && k < d8_steps.size(); ++k) {
                Cell const here = rivers.grid.at(i);
                Cell const there{here.col + d8_steps[k].col, here.row + d8_steps[k].row};
                if (rivers.grid.at(rivers.cell[static_cast<std::size_t>(to)]) == there) {
                    sign = static_cast<char>('0' + k);
                }
            }
        }
        picture += sign;
        if (i % rivers.grid.width == rivers.grid.width - 1) {
            picture += '\n';
        }
    }
    return picture;
}

// Two arms of five cells, a confluence, a stem of four
StreamNetwork fork() {
    return test::network_of({{5.5, 0.5}, {5.5, 4.5}, {0.5, 9.5}, {10.5, 9.5}},
                            {{1, 0, {}, 7}, {2, 1, {}, 8}, {3, 1, {}, 9}});
}

/// Some channel cells with all that flow into them.
std::vector<std::int64_t> some_tips(Channels const& rivers, std::uint64_t seed, double share) {
    std::vector<std::uint8_t> gone(rivers.cell.size(), 0);
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < gone.size(); ++i) {
        bool const below = rivers.receiver[i] >= 0 && gone[static_cast<std::size_t>(rivers.receiver[i])] != 0;
        gone[i] = below || unit(random_word(seed, i)) < share ? 1 : 0;
        if (gone[i] != 0) {
            out.push_back(static_cast<std::int64_t>(i));
        }
    }
    return out;
}

} // namespace

TEST(Channels, BadInputAndParametersAreRefused) {
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {7.0, 0.5}}, {{1, 0}});
    StreamNetwork const ring = test::network_of({{0.5, 0.5}, {2.5, 0.5}}, {{0, 1}, {1, 0}});
    EXPECT_THROW(channels(net, test::frame(3, 3)), BadInput);
    EXPECT_THROW(channels(ring, test::frame(3, 3)), BadInput);
    EXPECT_THROW(channels(net, test::frame(9, 3), {.look_cells = 65}), BadParameter);
    EXPECT_THROW(channels(net, test::frame(9, 3), {.stub_cells = -1}), BadParameter);
    EXPECT_TRUE(channels(StreamNetwork{}, test::frame(3, 3)).channels.cell.empty());
}

TEST(Channels, AForkAsDrawn) {
    //  two sources, a confluence in the middle, out in the south
    StreamNetwork const net =
        test::network_of({{2.5, 0.5}, {2.5, 2.5}, {0.5, 4.5}, {4.5, 4.5}}, {{1, 0}, {2, 1}, {3, 1}});
    ChannelsOfArcs const out = channels(net, test::frame(5, 5));
    EXPECT_EQ(drawn(out.channels), "1...3\n"
                                   ".1.3.\n"
                                   "..2..\n"
                                   "..2..\n"
                                   "..o..\n");
    EXPECT_EQ(out.of_arc, (std::vector<std::vector<std::int64_t>>{{2, 1, 0}, {4, 3, 2}, {6, 5, 2}}));
    EXPECT_TRUE(out.notes.empty());
}

TEST(Channels, CornersAreCutAndCellsWithoutWaterLeftOut) {
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {3.5, 3.5}}, {{1, 0, {{0.5, 3.5}}}});
    EXPECT_EQ(drawn(channels(net, test::frame(4, 4), literal()).channels), "2444\n"
                                                                           "2...\n"
                                                                           "2...\n"
                                                                           "o...\n");
    EXPECT_EQ(drawn(channels(net, test::frame(4, 4)).channels), ".344\n"
                                                                "2...\n"
                                                                "2...\n"
                                                                "o...\n");
}

TEST(Channels, RiversThatCrossAreOneFromThere) {
    // the second river crosses the first, by sides and by corners
    for (double const shift : {0.0, 1.0}) {
        StreamNetwork const net =
            test::network_of({{0.5, 0.5}, {19.5, 19.5}, {0.5, 19.5 - shift}, {19.5 - shift, 0.5}}, {{1, 0}, {3, 2}});
        ChannelsOfArcs const out = channels(net, test::frame(20, 20));
        test::require_law(out.channels);
        ASSERT_EQ(out.notes.size(), 1U) << shift;
        EXPECT_EQ(out.notes.front().kind, "captured");
        EXPECT_EQ(out.notes.front().feature, 2);
        EXPECT_EQ(std::count(out.channels.receiver.begin(), out.channels.receiver.end(), -1), 2) << shift;
        EXPECT_GT(out.channels.cell.size(), 36U); // what goes on below the crossing is long enough to stay
    }
}

TEST(Channels, AStubBelowACrossingIsLeftOut) {
    StreamNetwork const net = test::network_of({{0.5, 5.5}, {19.5, 5.5}, {9.5, 0.5}, {9.5, 12.5}}, {{1, 0}, {3, 2}});
    ChannelsOfArcs const out = channels(net, test::frame(20, 20));
    test::require_law(out.channels);
    EXPECT_EQ(std::count(out.channels.receiver.begin(), out.channels.receiver.end(), -1), 1);
    EXPECT_EQ(out.channels.cell.size(), 20U + 7U);
}

TEST(Channels, KeepTheirLawWhateverIsDrawn) {
    ASSERT_TRUE(rc::check("of rivers that may cross, with loops", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const nodes = *rc::gen::inRange<std::size_t>(0, 30);
        auto const basins = *rc::gen::inRange<std::size_t>(1, 4);
        auto const side = *rc::gen::inRange<std::int64_t>(1, 80);
        StreamNetwork const net = test::random_forest(seed, nodes, basins);
        Grid grid = test::frame(side, side);
        grid.cell_m = 1000.0 / static_cast<double>(side);
        grid.north = 1000.0;
        ChannelsParams const params = *rc::gen::element(ChannelsParams{}, literal(), ChannelsParams{64, 3});
        ChannelsOfArcs const out = channels(net, grid, params);
        test::require_law(out.channels);
        test::require_short(out.channels, params.look_cells);
        RC_ASSERT(out.of_arc.size() == net.arc_count());
        std::set<std::int64_t> drawn_cells;
        std::set<std::int64_t> listed;
        for (std::size_t a = 0; a < out.of_arc.size(); ++a) {
            std::set<std::int64_t> own;
            for (Cell const c : cells_along(net.arc(a).line, grid)) {
                own.insert(grid.index(c));
            }
            drawn_cells.insert(own.begin(), own.end());
            std::set<std::int64_t> const once(out.of_arc[a].begin(), out.of_arc[a].end());
            RC_ASSERT(once.size() == out.of_arc[a].size());
            for (std::int64_t const i : out.of_arc[a]) {
                RC_ASSERT(own.contains(out.channels.cell[static_cast<std::size_t>(i)]));
                listed.insert(i);
            }
        }
        RC_ASSERT(listed.size() == out.channels.cell.size());
        for (std::int64_t const cell : out.channels.cell) {
            RC_ASSERT(drawn_cells.contains(cell));
        }
    }));
}

TEST(Channels, RiversOnALatticeKeepTheirWay) {
    ASSERT_TRUE(rc::check("each arc's cells lead down to its outlet, and sources stay", [] {
        StreamNetwork const net = test::random_skeleton(*rc::gen::arbitrary<std::uint64_t>(), 48);
        Grid const grid = test::frame(48, 48);
        ChannelsOfArcs const out = channels(net, grid);
        test::require_law(out.channels);
        test::require_short(out.channels, 8);
        RC_ASSERT(std::count(out.channels.receiver.begin(), out.channels.receiver.end(), -1) ==
                  static_cast<std::int64_t>(net.outlets().size()));
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            if (net.in(net.from(a)).empty()) {
                std::int64_t const source = grid.index(grid.cell_of(net.node(net.from(a)).at));
                RC_ASSERT(out.channels.cell[static_cast<std::size_t>(out.of_arc[a].front())] == source);
            }
            RC_ASSERT(std::is_sorted(out.of_arc[a].rbegin(), out.of_arc[a].rend()));
        }
    }));
}

TEST(Shorten, RefusesWhatIsNoTip) {
    ChannelsOfArcs const drawn = channels(fork(), test::frame(11, 11));
    for (std::int64_t const wrong : {std::int64_t{-1}, std::ssize(drawn.channels.cell), std::int64_t{0}}) {
        EXPECT_TRUE(test::refused("network.shorten", [&] { shorten(fork(), drawn, {wrong}); })) << wrong;
    }
    EXPECT_THROW(shorten(test::network_of({{5.5, 0.5}, {5.5, 4.5}}, {{1, 0}}), drawn, {}), BadInput);
}

TEST(Shorten, CellsBesideTheirLineStay) {
    ChannelsOfArcs drawn = channels(fork(), test::frame(11, 11));
    Grid const& grid = drawn.channels.grid;
    std::vector<std::int64_t> const& arm = drawn.of_arc[1];
    for (std::size_t k = 0; k + 1 < arm.size(); ++k) { // the line touches their corners
        auto const i = static_cast<std::size_t>(arm[k]);
        Cell const c = grid.at(drawn.channels.cell[i]);
        drawn.channels.cell[i] = grid.index({c.col + 1, c.row});
    }
    ShortenedChannels const out = shorten(fork(), drawn, {arm.begin(), arm.begin() + 2});
    ASSERT_EQ(out.network.arc_count(), 3U);
    EXPECT_EQ(out.network.arc(1).line, (std::vector<Vec2>{{3.0, 7.0}, {5.5, 4.5}}));
    EXPECT_EQ(out.drawn.of_arc[1].size(), 4U);
}

TEST(Shorten, AnArmThatGoesLeavesOneRiver) {
    ChannelsOfArcs const drawn = channels(fork(), test::frame(11, 11));
    std::vector<std::int64_t> const left(drawn.of_arc[1].begin(), drawn.of_arc[1].end() - 1);
    ShortenedChannels const out = shorten(fork(), drawn, left);
    ASSERT_EQ(out.network.arc_count(), 1U);
    EXPECT_EQ(out.network.arc(0).line, (std::vector<Vec2>{{10.5, 9.5}, {5.5, 4.5}, {5.5, 0.5}}));
    EXPECT_EQ(out.network.arc(0).feature, 9);
    EXPECT_EQ(out.drawn.of_arc[0].size(), 10U);
    EXPECT_EQ(out.notes.size(), 1U);
}

TEST(Shorten, AHeadInTheCellOfAnotherRiverGoesWithTheCellsBelowIt) {
    StreamNetwork const net = test::network_of({{0.5, 25.5}, {30.5, 25.5}, {5.6, 25.4}, {5.5, 0.5}}, {{0, 1}, {2, 3}});
    ChannelsOfArcs const drawn = channels(net, test::frame(31, 31));
    auto const& cells = drawn.of_arc[1];
    ASSERT_GE(cells.size(), 4U);
    ASSERT_NE(drawn.channels.receiver[static_cast<std::size_t>(cells[0])], cells[1]); // that is the other river's
    ShortenedChannels const out = shorten(net, drawn, {cells.begin() + 1, cells.begin() + 3});
    ASSERT_EQ(out.network.arc_count(), 2U);
    EXPECT_LT(out.network.arc(1).line.front().y, 23.0);
    EXPECT_EQ(out.notes.size(), 1U);
}

TEST(Shorten, WhatIsLeftIsWhatWasDrawn) {
    ASSERT_TRUE(rc::check("lines end parts of lines, channels keep their law, and arcs their cells", [] {
        auto const [seed, on_lattice, net, grid] = test::some_rivers();
        ChannelsOfArcs const drawn = channels(net, grid);
        std::vector<std::int64_t> const gone = some_tips(drawn.channels, seed, *rc::gen::element(0.0, 0.01, 0.1, 1.0));
        ShortenedChannels const out = shorten(net, drawn, gone);
        test::require_law(out.drawn.channels);
        RC_ASSERT(out.drawn.of_arc.size() == out.network.arc_count());
        RC_ASSERT(out.drawn.channels.cell.size() + gone.size() == drawn.channels.cell.size());
        std::set<std::pair<double, double>> vertices;
        double before_m = 0.0;
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            before_m += net.length_m(a);
            for (Vec2 const p : net.arc(a).line) {
                vertices.emplace(p.x, p.y);
            }
        }
        double after_m = 0.0;
        for (std::size_t a = 0; a < out.network.arc_count(); ++a) {
            after_m += out.network.length_m(a);
            auto const& line = out.network.arc(a).line;
            RC_ASSERT(line.size() >= 2U);
            RC_ASSERT(line.front() == out.network.node(out.network.from(a)).at);
            for (std::size_t i = 1; i < line.size(); ++i) {
                RC_ASSERT(vertices.contains({line[i].x, line[i].y}));
            }
            if (on_lattice) {
                // what was drawn from the new line's cells, and no tip stands where a river is gone
                std::set<std::int64_t> cells;
                for (Cell const c : cells_along(line, grid)) {
                    cells.insert(grid.index(c));
                }
                for (std::int64_t const i : out.drawn.of_arc[a]) {
                    RC_ASSERT(cells.contains(out.drawn.channels.cell[static_cast<std::size_t>(i)]));
                }
                if (out.network.in(out.network.from(a)).empty() && !out.drawn.of_arc[a].empty()) {
                    RC_ASSERT(out.drawn.channels.cell[static_cast<std::size_t>(out.drawn.of_arc[a].front())] ==
                              grid.index(grid.cell_of(line.front())));
                }
            }
        }
        double noted_m = 0.0;
        for (Finding const& note : out.notes) {
            noted_m += note.amount;
        }
        RC_ASSERT(noted_m + after_m <= before_m * (1.0 + 1e-12));
        RC_ASSERT(!on_lattice || noted_m + after_m >= before_m * (1.0 - 1e-12));
    }));
}

} // namespace channels_test
