// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/lakes.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <network/channel_laws.hpp>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace lakes_test {

namespace {

using namespace thalweg;
using network::channels;
using network::ChannelsOfArcs;
using network::choose_lakes;
using network::flood_lakes;
using network::FloodedLakes;

Raster<std::int32_t> labels_of(std::vector<std::string> const& rows) {
    Raster<std::int32_t> out(
        test::frame(static_cast<std::int64_t>(rows[0].size()), static_cast<std::int64_t>(rows.size())));
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        Cell const c = out.grid().at(i);
        char const sign = rows[static_cast<std::size_t>(c.row)][static_cast<std::size_t>(c.col)];
        out[i] = sign == '.' ? 0 : sign - '0';
    }
    return out;
}

/// A lake that fills the cells from one in its north-west to one in its south-east.
Raster<std::int32_t> lake_between(Cell first, Cell last, Grid const& grid) {
    Raster<std::int32_t> out(grid);
    for (std::int64_t row = first.row; row <= last.row; ++row) {
        for (std::int64_t col = first.col; col <= last.col; ++col) {
            out[Cell{col, row}] = 1;
        }
    }
    return out;
}

/// '#' level, 'o' an outlet, '+' another channel.
std::vector<std::string> picture(FloodedLakes const& flooded) {
    Channels const& rivers = flooded.drawn.channels;
    std::vector<std::string> rows(static_cast<std::size_t>(rivers.grid.height),
                                  std::string(static_cast<std::size_t>(rivers.grid.width), '.'));
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        Cell const c = rivers.grid.at(rivers.cell[i]);
        rows[static_cast<std::size_t>(c.row)][static_cast<std::size_t>(c.col)] = rivers.level[i] != 0 ? '#' : '+';
    }
    for (network::Lake const& lake : flooded.lakes) {
        Cell const c = test::channel_cell(rivers, lake.outlet);
        rows[static_cast<std::size_t>(c.row)][static_cast<std::size_t>(c.col)] = 'o';
    }
    return rows;
}

std::vector<std::string> kinds(FloodedLakes const& flooded) {
    std::vector<std::string> out;
    for (Finding const& note : flooded.notes) {
        out.push_back(note.kind);
    }
    return out;
}

/// A river from the north to the south through the middle of eleven columns.
ChannelsOfArcs one_river(std::int64_t height) {
    auto const top = static_cast<double>(height);
    return channels(test::network_of({{5.5, 0.5}, {5.5, top - 0.5}}, {{1, 0}}), test::frame(11, height));
}

/// Laws of lakes in channels.
void require_lakes(FloodedLakes const& out, Raster<std::int32_t> const& labels) {
    Channels const& rivers = out.drawn.channels;
    test::require_law(rivers, test::Diagonals::may_cross);
    RC_ASSERT(rivers.level.size() == rivers.cell.size());
    std::map<std::int64_t, std::int64_t> number;
    std::vector<std::int64_t> outlet(rivers.cell.size(), -1); // by level cell, of its lake
    std::map<std::int64_t, std::int64_t> size;
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        number[rivers.cell[i]] = static_cast<std::int64_t>(i);
        if (rivers.level[i] != 0) {
            auto const to = static_cast<std::size_t>(rivers.receiver[i]);
            outlet[i] = rivers.level[to] != 0 ? outlet[to] : rivers.receiver[i];
            ++size[outlet[i]];
            RC_ASSERT(labels[rivers.cell[i]] > 0);
            RC_ASSERT(!rivers.grid.on_border(rivers.grid.at(rivers.cell[i])));
        }
    }
    RC_ASSERT(size.size() == out.lakes.size());
    for (network::Lake const& lake : out.lakes) {
        RC_ASSERT(size[lake.outlet] == lake.cells);
        RC_ASSERT(lake.cells >= 4);
        RC_ASSERT(labels[rivers.cell[static_cast<std::size_t>(lake.outlet)]] == lake.label);
    }
    auto const lake_below = [&](std::int64_t i, std::int64_t which) {
        for (; i >= 0; i = rivers.receiver[static_cast<std::size_t>(i)]) {
            if (i == which || outlet[static_cast<std::size_t>(i)] == which) {
                return true;
            }
        }
        return false;
    };
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        if (outlet[i] < 0) {
            continue;
        }
        Cell const c = rivers.grid.at(rivers.cell[i]);
        RC_ASSERT(labels[rivers.cell[i]] == labels[rivers.cell[static_cast<std::size_t>(outlet[i])]]);
        for (Cell const step : d8_steps) {
            auto const n = number.find(rivers.grid.index({c.col + step.col, c.row + step.row}));
            if (n != number.end() && n->second != outlet[i]) {
                RC_ASSERT(lake_below(n->second, outlet[i])); // no other way out
            }
        }
    }
}

ChannelsOfArcs river_of_one_arc() {
    return channels(test::network_of({{50.5, 0.5}, {50.5, 99.5}}, {{1, 0}}), test::frame(100, 100));
}

} // namespace

TEST(FloodLakes, RefusesWhatIsNotOnTheGrid) {
    EXPECT_THROW(flood_lakes(one_river(8), Raster<std::int32_t>(test::frame(3, 3))), BadInput);
    EXPECT_THROW(flood_lakes(one_river(8), Raster<std::int32_t>(test::frame(11, 8), -1)), BadInput);
}

TEST(FloodLakes, NoLakeChangesNothing) {
    FloodedLakes const out = flood_lakes(one_river(8), Raster<std::int32_t>(test::frame(11, 8)));
    EXPECT_EQ(out.drawn.channels.cell, one_river(8).channels.cell);
    EXPECT_EQ(out.drawn.channels.receiver, one_river(8).channels.receiver);
    EXPECT_EQ(out.drawn.of_arc, one_river(8).of_arc);
    EXPECT_TRUE(out.lakes.empty());
}

TEST(FloodLakes, ALakeOnARiver) {
    FloodedLakes const out = flood_lakes(one_river(8), labels_of({"...........", //
                                                                  "..11111....", //
                                                                  "..11111.2..", //
                                                                  "...111..22.", //
                                                                  "...111..22.", //
                                                                  "....1......", //
                                                                  "...........", //
                                                                  "..........."}));
    // The river leaves at the southern shore; a lake that no river reaches is left out.
    EXPECT_EQ(picture(out), (std::vector<std::string>{".....+.....", //
                                                      "..#####....", //
                                                      "..#####....", //
                                                      "...###.....", //
                                                      "...#.o.....", //
                                                      ".....+.....", //
                                                      ".....+.....", //
                                                      ".....+....."}));
    EXPECT_EQ(kinds(out), (std::vector<std::string>{"lake_cut", "lake_left_out"}));
    ASSERT_EQ(out.lakes.size(), 1U);
    EXPECT_EQ(out.lakes[0].cells, 14);
    EXPECT_EQ(out.drawn.of_arc[0].size(), 8U);
    test::require_law(out.drawn.channels, test::Diagonals::may_cross);
}

TEST(FloodLakes, OneOutletEvenWhereTwoRiversLeave) {
    // two rivers side by side, the eastern one with a tributary
    StreamNetwork const net = test::network_of(
        {{3.5, 0.5}, {3.5, 11.5}, {7.5, 0.5}, {7.5, 11.5}, {7.5, 9.5}, {9.5, 11.5}}, {{1, 0}, {4, 2}, {3, 4}, {5, 4}});
    Raster<std::int32_t> const lake = lake_between({2, 3}, {8, 7}, test::frame(11, 12));
    FloodedLakes const out = flood_lakes(channels(net, lake.grid()), lake);
    test::require_law(out.drawn.channels, test::Diagonals::may_cross);
    ASSERT_EQ(out.lakes.size(), 1U);
    EXPECT_EQ(test::channel_cell(out.drawn.channels, out.lakes[0].outlet), (Cell{7, 7}));
    std::vector<std::string> const rows = picture(out);
    EXPECT_EQ(rows[2], "...+...+...");
    EXPECT_EQ(rows[5], "..#######..");
    EXPECT_EQ(rows[8], ".......+..."); // the western river begins below the shore
    EXPECT_EQ(rows[9], "...+...+...");
    EXPECT_EQ(kinds(out), (std::vector<std::string>{"lake_cut", "lake_outlets"}));
}

TEST(FloodLakes, GivenHeightsAreRaisedToTheLake) {
    ChannelsOfArcs drawn = one_river(9);
    drawn.channels.z = {0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F};
    Raster<std::int32_t> const lake = lake_between({4, 2}, {6, 5}, test::frame(11, 9));
    FloodedLakes const out = flood_lakes(drawn, lake);
    Channels const& rivers = out.drawn.channels;
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        Cell const c = rivers.grid.at(rivers.cell[i]);
        EXPECT_EQ(rivers.z[i], rivers.level[i] != 0 ? 3.0F : static_cast<float>(8 - c.row));
    }
}

TEST(FloodLakes, WhateverIsDrawn) {
    ASSERT_TRUE(rc::check("channels keep their law, lakes have one way out", [] {
        auto const [seed, on_lattice, net, grid] = test::some_rivers();
        Raster<std::int32_t> labels(grid);
        auto const count = *rc::gen::inRange<std::int32_t>(1, 6);
        for (std::int32_t k = 1; k <= count; ++k) {
            Mask const blob = test::random_blob(seed + static_cast<std::uint64_t>(k), 40, 40, 2, 2 + k % 3);
            auto const by = static_cast<std::int64_t>(random_word(seed, 9, static_cast<std::uint64_t>(k)) % 1600);
            for (std::int64_t i = 0; i < grid.cells(); ++i) {
                if (blob[i] != 0) {
                    labels[(i + by) % grid.cells()] = k;
                }
            }
        }
        ChannelsOfArcs const drawn = channels(net, grid);
        FloodedLakes const out = flood_lakes(drawn, labels);
        require_lakes(out, labels);
        std::set<std::int64_t> const before(drawn.channels.cell.begin(), drawn.channels.cell.end());
        for (std::size_t i = 0; i < out.drawn.channels.cell.size(); ++i) {
            RC_ASSERT((out.drawn.channels.level[i] != 0 || before.contains(out.drawn.channels.cell[i])));
        }
        for (std::size_t a = 0; a < drawn.of_arc.size(); ++a) {
            std::set<std::int64_t> own;
            for (std::int64_t const i : drawn.of_arc[a]) {
                own.insert(drawn.channels.cell[static_cast<std::size_t>(i)]);
            }
            RC_ASSERT(out.drawn.of_arc[a].size() <= own.size());
            for (std::int64_t const i : out.drawn.of_arc[a]) {
                RC_ASSERT(own.contains(out.drawn.channels.cell[static_cast<std::size_t>(i)]));
            }
        }
    }));
}

TEST(ChooseLakes, RefusesBadParameters) {
    for (network::ChooseLakesParams const& wrong :
         std::vector<network::ChooseLakesParams>{{.share = 1.1}, {.min_area_cells = -1.0}, {.max_cells = 3}}) {
        EXPECT_THROW(choose_lakes(river_of_one_arc(), {1.0}, wrong), BadParameter);
    }
    EXPECT_THROW(choose_lakes(river_of_one_arc(), {}), BadInput);
}

TEST(ChooseLakes, NoShareAndNoAreaAreNoLake) {
    auto const count = [](Raster<std::int32_t> const& labels) {
        return std::count_if(labels.values().begin(), labels.values().end(), [](std::int32_t v) { return v != 0; });
    };
    EXPECT_EQ(count(choose_lakes(river_of_one_arc(), {1e5}, {.share = 0.0})), 0);
    EXPECT_EQ(count(choose_lakes(river_of_one_arc(), {1999.0}, {.share = 1.0})), 0);
    EXPECT_GE(count(choose_lakes(river_of_one_arc(), {2000.0}, {.share = 1.0})), 8);
}

TEST(ChooseLakes, AShareOfReaches) {
    ASSERT_TRUE(rc::check("lakes keep apart and from the edge, and can be flooded", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Grid const grid = test::frame(90, 90);
        ChannelsOfArcs const drawn = channels(test::random_skeleton(seed, 90), grid);
        std::vector<double> const areas(drawn.of_arc.size(), 5e4);
        auto const labels =
            choose_lakes(drawn, areas, {.share = *rc::gen::element(0.3, 1.0), .max_cells = 150, .seed = seed});
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (labels[i] == 0) {
                continue;
            }
            Cell const c = grid.at(i);
            RC_ASSERT(std::min({c.col, c.row, 89 - c.col, 89 - c.row}) >= 3);
            for (std::int64_t dr = -2; dr <= 2; ++dr) {
                for (std::int64_t dc = -2; dc <= 2; ++dc) {
                    std::int32_t const other = labels[Cell{c.col + dc, c.row + dr}];
                    RC_ASSERT((other == 0 || other == labels[i]));
                }
            }
        }
        network::FloodedLakes const flooded = network::flood_lakes(drawn, labels);
        std::int32_t const chosen = *std::max_element(labels.values().begin(), labels.values().end());
        RC_ASSERT(static_cast<std::int32_t>(flooded.lakes.size()) <= 2 * chosen);
        RC_ASSERT((chosen == 0) == (flooded.lakes.empty()));
        for (network::Lake const& lake : flooded.lakes) {
            RC_ASSERT(lake.cells <= 250);
        }
    }));
}

} // namespace lakes_test
