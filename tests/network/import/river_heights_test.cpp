// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/river_heights.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>

namespace river_heights_test {

using namespace thalweg;
using network::fill_heights;
using network::without_placeholders;
using test::lines_of;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> heights(RiverLines const& lines, std::size_t line) {
    std::vector<double> result;
    for (Vec3 const& v : lines.lines[line].vertices) {
        result.push_back(v.z);
    }
    return result;
}

TEST(FillHeights, NothingToFill) {
    EXPECT_EQ(fill_heights({}, 0.01).filled, 0);
    EXPECT_THROW(fill_heights({}, 0.0), BadParameter);
    auto const all = fill_heights(lines_of({{{0, 0, 5}, {10, 0, 4}}}), 0.01);
    EXPECT_EQ(all.filled, 0);
    auto const no_heights = fill_heights(lines_of({{{0, 0, none}, {10, 0, none}}}), 0.01);
    EXPECT_EQ(no_heights.filled, 0);
    EXPECT_FALSE(no_heights.lines.has_z);
    auto const zeros = fill_heights(lines_of({{{0, 0, 0}, {10, 0, 0}}, {{10, 0, none}, {20, 0, none}}}), 0.01);
    EXPECT_FALSE(zeros.lines.has_z) << "heights that are all 0 are none";
}

TEST(FillHeights, BetweenTwoKnownHeightsLinearByLength) {
    auto const filled = fill_heights(lines_of({{{0, 0, 100}, {100, 0, 90}},
                                               {{100, 0, none}, {130, 0, none}, {200, 0, none}},
                                               {{200, 0, 80}, {300, 0, 70}}}),
                                     0.01);
    EXPECT_EQ(filled.filled, 1);
    EXPECT_EQ(filled.first, 2);
    EXPECT_TRUE(filled.lines.has_z);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{90, 87, 80}));
    EXPECT_EQ(heights(filled.lines, 0), (std::vector<double>{100, 90}));
}

TEST(FillHeights, FreeEndsRiseUpstreamAndFallDownstream) {
    std::vector<std::vector<Vec3>> const drawn = {{{0, 0, 100}, {100, 0, 90}},
                                                  {{-100, 0, none}, {0, 0, none}},
                                                  {{100, 0, none}, {300, 0, none}},
                                                  {{300, 0, none}, {400, 0, none}}};
    auto const filled = fill_heights(lines_of(drawn), 0.1);
    EXPECT_EQ(filled.filled, 3);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{110, 100}));
    EXPECT_EQ(heights(filled.lines, 2), (std::vector<double>{90, 70}));
    EXPECT_EQ(heights(filled.lines, 3), (std::vector<double>{70, 60}));

    std::vector<std::vector<Vec3>> upstream = drawn;
    for (auto& line : upstream) {
        line = {line.rbegin(), line.rend()};
    }
    auto const turned = fill_heights(lines_of(upstream), 0.1);
    EXPECT_EQ(heights(turned.lines, 1), (std::vector<double>{100, 110}));
    EXPECT_EQ(heights(turned.lines, 3), (std::vector<double>{60, 70}));
}

TEST(FillHeights, OfHeightsThatMeetTheLowestCounts) {
    std::vector<Vec3> const high{{0, 0, 100}, {100, 0, 90}};
    std::vector<Vec3> const low{{0, 50, 95}, {100, 0, 80}};
    std::vector<Vec3> const open{{100, 0, none}, {200, 0, none}};
    for (auto const& drawn : {std::vector{high, low, open}, std::vector{low, high, open}}) {
        EXPECT_EQ(heights(fill_heights(lines_of(drawn), 0.1).lines, 2), (std::vector<double>{80, 70}));
    }
}

TEST(FillHeights, HeightsAtSomeVerticesStay) {
    auto const filled =
        fill_heights(lines_of({{{0, 0, none}, {50, 0, 100}, {75, 0, none}, {150, 0, 80}, {170, 0, none}},
                               {{170, 0, none}, {200, 0, none}, {300, 0, 70}},
                               {{75, 50, none}, {75, 0, none}}}),
                     0.1);
    EXPECT_EQ(filled.filled, 3);
    EXPECT_EQ(filled.partly, 2);
    EXPECT_EQ(filled.first, 1);
    double const joint = 70 + 10 * (130.0 / 150.0);
    EXPECT_EQ(heights(filled.lines, 0), (std::vector<double>{105, 100, 95, 80, joint}));
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{joint, joint - (joint - 70) * (30.0 / 130), 70}));
    EXPECT_EQ(heights(filled.lines, 2), (std::vector<double>{100, 95}));
}

TEST(FillHeights, AnEndThatMeetsAKnownHeightTakesIt) {
    auto const filled = fill_heights(
        lines_of({{{0, 0, 100}, {100, 0, 90}}, {{100, 0, none}, {150, 0, none}, {200, 0, 60}, {300, 0, none}}}), 0.1);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{90, 75, 60, 50}));
}

TEST(FillHeights, ARiverOfItsOwnBeginsAtTheNearestHeight) {
    auto const filled = fill_heights(lines_of({{{0, 0, 100}, {100, 0, 90}}, {{90, 200, none}, {90, 100, none}}}), 0.1);
    EXPECT_EQ(heights(filled.lines, 1), (std::vector<double>{100, 90}));
}

TEST(FillHeights, AnEndWithoutHeightLiesBetweenTheLinesThatMeetThere) {
    // 900, 700, ? and ?, 300, 200; a tributary of 600 m whose end is missing as well
    auto const split = fill_heights(
        lines_of({{{0, 0, 900}, {100, 0, 700}, {200, 0, none}}, {{200, 0, none}, {300, 0, 300}, {400, 0, 200}}}), 9.0);
    EXPECT_EQ(heights(split.lines, 0), (std::vector<double>{900, 700, 500}));
    EXPECT_EQ(heights(split.lines, 1), (std::vector<double>{500, 300, 200}));
    auto const three = fill_heights(lines_of({{{0, 0, 900}, {100, 0, 700}, {200, 0, none}},
                                              {{200, 0, none}, {300, 0, 300}, {400, 0, 200}},
                                              {{200, 90, 600}, {200, 50, 500}, {200, 0, none}}}),
                                    9.0);
    double const node = 300 + 200 * (100.0 / 150.0);
    EXPECT_EQ(heights(three.lines, 0), (std::vector<double>{900, 700, node}));
    EXPECT_EQ(heights(three.lines, 1), (std::vector<double>{node, 300, 200}));
    EXPECT_EQ(heights(three.lines, 2), (std::vector<double>{600, 500, node}));
    // all fall to it, or from it
    auto const outlet = fill_heights(
        lines_of({{{0, 0, 90}, {100, 0, 70}, {200, 0, none}}, {{200, 0, none}, {300, 0, 40}, {400, 0, 50}}}), 0.1);
    EXPECT_EQ(heights(outlet.lines, 0).back(), 30.0);
    auto const source = fill_heights(
        lines_of({{{0, 0, 50}, {100, 0, 70}, {200, 0, none}}, {{200, 0, none}, {300, 0, 40}, {400, 0, 30}}}), 0.1);
    EXPECT_EQ(heights(source.lines, 0).back(), 80.0);
    // a line's own heights say how it runs
    auto const against = fill_heights(lines_of({{{0, 0, 90}, {100, 0, 80}},
                                                {{0, 50, 70}, {100, 50, 60}},
                                                {{0, 99, none}, {100, 99, 20}, {200, 99, 30}, {300, 99, none}}}),
                                      0.1);
    EXPECT_EQ(heights(against.lines, 2), (std::vector<double>{10, 20, 30, 40}));
}

TEST(FillHeights, OneKnownHeightIsThatOfAll) {
    auto const one = network::with_all_heights(
        lines_of({{{0, 0, none}, {1, 0, 7}, {2, 0, none}}, {{2, 0, none}, {3, 0, none}}}), 0.1);
    EXPECT_EQ(heights(one, 0), (std::vector<double>{7, 7, 7}));
    EXPECT_EQ(heights(one, 1), (std::vector<double>{7, 7}));
    auto const several = network::with_all_heights(lines_of({{{0, 0, 9}, {10, 0, none}, {20, 0, 7}}}), 0.1);
    EXPECT_EQ(heights(several, 0), (std::vector<double>{9, 8, 7}));
    EXPECT_TRUE(
        std::isnan(network::with_all_heights(lines_of({{{0, 0, none}, {1, 0, none}}}), 0.1).lines[0].vertices[0].z));
}

TEST(FillHeights, ALineByItself) {
    EXPECT_EQ(network::with_heights_between({{0, 0, none}, {1, 0, 4}, {2, 0, none}, {4, 0, 10}, {9, 0, none}}),
              (std::vector<Vec3>{{0, 0, 4}, {1, 0, 4}, {2, 0, 6}, {4, 0, 10}, {9, 0, 10}}));
    EXPECT_TRUE(std::isnan(network::with_heights_between({{0, 0, none}, {1, 0, none}}).front().z));
    EXPECT_TRUE(network::with_heights_between({}).empty());
}

/// Lines along x, each from where the one before ended, with these heights.
RiverLines chain(std::vector<std::vector<double>> const& heights, double step_m = 1000.0) {
    std::vector<std::vector<Vec3>> lines;
    double x = 0.0;
    for (auto const& of : heights) {
        auto& line = lines.emplace_back();
        for (std::size_t i = 0; i < of.size(); ++i) {
            x += i > 0 ? step_m : 0.0;
            line.push_back({x, 0.0, of[i]});
        }
    }
    return lines_of(lines);
}

/// By vertex, lines after another: whether its height counts as missing.
std::string taken(RiverLines const& given) {
    auto const checked = without_placeholders(given);
    std::string result;
    std::int64_t missing = 0;
    for (std::size_t l = 0; l < given.lines.size(); ++l) {
        result += l > 0 ? " " : "";
        for (std::size_t v = 0; v < given.lines[l].vertices.size(); ++v) {
            bool const is_missing = std::isnan(checked.lines.lines[l].vertices[v].z);
            missing += is_missing ? 1 : 0;
            result += is_missing ? 'x' : '.';
        }
    }
    EXPECT_EQ(checked.vertices, missing);
    return result;
}

TEST(Placeholders, AtAnEndWhereOthersAreHigher) {
    EXPECT_EQ(taken(chain({{900, 700, 0}, {0, 300, 200}})), "..x x..") << "two lines rise from it";
    EXPECT_EQ(taken(chain({{900, 700, 0}, {500, 300, 200}})), "..x ...") << "another line has a height";
    EXPECT_EQ(taken(chain({{0, 700, 0}})), "x.x") << "it is higher between";
    EXPECT_EQ(taken(chain({{0, 700, 0}, {0, 300, 0}})), "x.x x.x");
    EXPECT_EQ(taken(chain({{0, 700, 500}})), "x..") << "the rest falls away";
    EXPECT_EQ(taken(chain({{900, 700, 500}, {0, 0, 0}})), "... xxx") << "a line without heights";
    EXPECT_EQ(taken(lines_of({{{0, 0, 900}, {9, 0, 700}, {20, 0, 0}},
                              {{20, 0, 0}, {30, 0, 300}},
                              {{20, 9, 800}, {20, 5, 600}, {20, 0, 500}}})),
              "..x x. ...");
    auto const checked = without_placeholders(chain({{900, 700, 0}, {0, 300, 200}}));
    EXPECT_EQ(checked.zeros, 2);
    EXPECT_EQ(checked.first, 1);
    EXPECT_EQ(checked.at, (Vec2{2000, 0}));
}

TEST(Placeholders, AMouthMayLieAtZero) {
    EXPECT_EQ(taken(chain({{9, 4, 0}})), "...");
    EXPECT_EQ(taken(chain({{900, 700, 0}})), "...") << "in a file without zeros that are none";
    EXPECT_EQ(taken(chain({{0, 4, 9}})), "...") << "drawn upstream";
    EXPECT_EQ(taken(chain({{0, 7}})), "..");
    EXPECT_EQ(taken(chain({{9, 5, 3, 0, 0, 0}})), "......") << "a tidal river";
    EXPECT_EQ(taken(chain({{9, 5, 3, 0, 0}, {0, 0, 0}})), "..... ...");
    EXPECT_EQ(taken(chain({{0, 0, 0}})), "...");
    EXPECT_EQ(taken(lines_of({{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 0, 0}}, {{0, 0, 40}, {-9, 0, 50}}})), ".... ..")
        << "a shore that a river reaches from above";
    EXPECT_EQ(taken(chain({{9, 5, 0}, {0, -2, -3}})), "... ...") << "land below the sea";
    EXPECT_EQ(taken(lines_of({{{0, 0, 90}, {9, 0, 40}, {20, 0, 0}}, {{20, 20, 80}, {20, 9, 30}, {20, 0, 0}}})),
              "... ...")
        << "two rivers with one mouth";
    EXPECT_EQ(taken(lines_of({{{0, 0, 90}, {20, 0, 0}}, {{20, 20, 80}, {20, 0, 0}}})), ".. ..") << "drawn alike";
    EXPECT_EQ(taken(lines_of({{{0, 0, 900}, {9, 0, 850}, {20, 0, 0}}, {{20, 20, 800}, {20, 0, 0}}})), "... ..");
    EXPECT_EQ(taken(lines_of({{{0, 0, 90}, {20, 0, 0}}, {{20, 0, 0}, {20, 20, 80}}})), ".x x.") << "one leaves";
    EXPECT_EQ(taken(chain({{900, 700, 0}, {0, 300, 200, 0}})), "..x x...") << "a mouth beyond a cut";
    EXPECT_EQ(taken(chain({{900, 700, 0}, {0, 402, 401, 400, 0}})), "..x x...x") << "not a mouth, but a cut";
    EXPECT_EQ(taken(chain({{900, 700, 0}, {0, 402, 401}, {401, 390, 380, 0}})), "..x x.. ...x") << "likewise";
    EXPECT_EQ(taken(chain({{900, 700, 0}, {0, 402, 401}, {401, 0}})), "..x x.. ..") << "which nothing says";
}

TEST(Placeholders, BetweenHigherVertices) {
    EXPECT_EQ(
        taken(lines_of({{{0, 0, 9}, {1, 0, 0}, {2, 0, 5}, {3, 0, 3}}, {{9, 9, 0}, {9, 8, 7}, {9, 7, 0}, {9, 6, 8}}})),
        ".x.. ..x.");
    EXPECT_EQ(taken(lines_of({{{0, 0, 9}, {1, 0, 0}, {2, 0, 5}, {3, 0, 0}}, {{9, 9, 0}, {9, 8, 0}}})), ".x.. xx");
    EXPECT_EQ(taken(lines_of({{{0, 0, -9999}, {1, 0, 4}, {2, 0, 0}}})), "x..");
    RiverLines with_channel = chain({{900, 700, 0}});
    with_channel.channels = lines_of({{{2000, 0, 0}, {3000, 0, 300}, {4000, 0, 200}}}).lines;
    auto const checked = without_placeholders(with_channel);
    EXPECT_EQ(checked.vertices, 2) << "channels count too";
    EXPECT_TRUE(std::isnan(checked.lines.channels[0].vertices[0].z));
}

RC_GTEST_PROP(Placeholders, OfACutRiverAreFoundAndFilledBetweenItsNeighbours, ()) {
    auto const falls =
        *rc::gen::resize(30, rc::gen::suchThat(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 90)),
                                               [](std::vector<int> const& all) { return all.size() >= 7; }));
    std::vector<double> river{*rc::gen::inRange(1, 500) + 0.0};
    for (int const fall : falls) {
        river.insert(river.begin(), river.front() + fall);
    }
    std::vector<std::vector<double>> pieces{{river.front()}};
    for (std::size_t i = 1; i < river.size(); ++i) {
        pieces.back().push_back(river[i]);
        if (i + 3 < river.size() && pieces.back().size() > 2 && *rc::gen::inRange(0, 3) == 0) {
            pieces.back().back() = 0.0;
            pieces.push_back({0.0});
        }
    }
    RC_PRE(pieces.size() > 1);
    auto const filled = fill_heights(without_placeholders(chain(pieces)).lines, 0.087).lines;
    double before = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < pieces.size(); ++l) {
        for (std::size_t v = 0; v < pieces[l].size(); ++v) {
            double const z = filled.lines[l].vertices[v].z;
            bool const is_joint = v == 0 && l > 0;
            bool const runs_down = is_joint ? z == before : z < before;
            RC_ASSERT(runs_down);
            bool const stays = pieces[l][v] == 0.0 || z == pieces[l][v];
            RC_ASSERT(stays);
            before = z;
        }
    }
}

} // namespace

} // namespace river_heights_test
