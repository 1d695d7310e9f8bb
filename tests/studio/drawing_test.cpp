// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/drawing.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/studio/drawing_files.hpp>
#include <thalweg/studio/internal/messages.hpp>

#include "random_draw.hpp"

namespace drawing_test {

using namespace thalweg;
using namespace thalweg::studio;

namespace {

using nlohmann::json;

Grid const grid{80, 60, 10.0, 5000.0, 9000.0, "EPSG:32631"};

Drawing sheet() {
    Drawing drawing;
    drawing.grid = grid;
    return drawing;
}

/// A place in cells.
Vec2 at(double x, double y) {
    return {grid.west + x * grid.cell_m, grid.north - y * grid.cell_m};
}

DrawnLine line_of(std::vector<Vec2> const& cells) {
    DrawnLine line;
    for (Vec2 const p : cells) {
        line.push_back(at(p.x, p.y));
    }
    return line;
}

DrawResult after(Drawing drawing, DrawStep const& step) {
    return drawn(std::move(drawing), step);
}

Drawing with_river(Drawing drawing, std::vector<Vec2> const& cells) {
    return drawn(std::move(drawing), DrawRiver{line_of(cells)}).drawing;
}

/// A trunk to the southern border, and a tributary from the west.
Drawing two_rivers() {
    return with_river(with_river(sheet(), {{40, 5}, {40, 59.5}}), {{10, 10}, {39, 30}});
}

NotDrawn refusal(Drawing const& drawing, DrawStep const& step) {
    try {
        drawn(drawing, step);
    } catch (NotDrawn const& refused) {
        return refused;
    }
    return {"test.refusal", "nothing was refused"};
}

bool has(NotDrawn const& refused, std::string const& words) {
    return std::string(refused.what()).find(words) != std::string::npos;
}

/// The laws, by what reads the lines of files: one way down from everywhere, and nothing to be mended.
void expect_lawful(Drawing const& drawing) {
    RiverLines lines;
    lines.name = "drawing";
    for (DrawnRiver const& river : drawing.rivers) {
        ASSERT_GE(river.line.size(), 2U);
        RiverLine line;
        line.feature = static_cast<std::int64_t>(lines.lines.size()) + 1;
        for (Vec2 const p : river.line) {
            EXPECT_EQ(p, rounded(p));
            EXPECT_TRUE(p.x >= grid.west && p.x <= grid.east() && p.y >= grid.south() && p.y <= grid.north);
            line.vertices.push_back({p.x, p.y, std::nan("")});
        }
        EXPECT_EQ(std::ranges::adjacent_find(river.line), river.line.end());
        lines.lines.push_back(std::move(line));
    }
    for (DrawnLine const& coast : drawing.coasts) {
        ASSERT_GE(coast.size(), 2U);
        EXPECT_EQ(std::ranges::adjacent_find(coast), coast.end());
        EXPECT_TRUE(coast.front() != coast.back() || coast.size() > 3);
    }
    for (DrawnLake const& lake : drawing.lakes) {
        EXPECT_GE(lake.rings.front().size(), 3U);
        EXPECT_NE(lake.rings.front().front(), lake.rings.front().back());
    }
    for (DrawnRidge const& ridge : drawing.ridges) {
        ASSERT_GE(ridge.line.size(), 2U);
        ASSERT_EQ(ridge.heights_m.size(), ridge.line.size());
        EXPECT_EQ(std::ranges::adjacent_find(ridge.line), ridge.line.end());
    }
    if (lines.lines.empty()) {
        return;
    }
    network::ImportParams params;
    params.orientation = network::Orientation::as_drawn;
    params.divergences = network::Divergences::error;
    network::ImportedNetwork const imported = network::import_lines(lines, params);
    for (Finding const& repair : imported.repairs) {
        EXPECT_TRUE(repair.kind == "joined" || repair.kind == "split") << repair.kind.name() << ": " << repair.text;
        if (repair.kind == "split") { // where they meet, and nowhere else
            EXPECT_TRUE(std::ranges::any_of(drawing.rivers, [&](DrawnRiver const& river) {
                return distance(river.line.back(), repair.where) < 1e-5;
            })) << repair.text;
        }
    }
    EXPECT_TRUE(imported.secondary.empty());
    for (DrawnRiver const& river : drawing.rivers) {
        for (Vec2 const p : river.line) {
            bool const at_coast = std::ranges::any_of(drawing.coasts, [&](DrawnLine const& coast) {
                for (std::size_t i = 1; i < coast.size(); ++i) {
                    double const whole = distance(coast[i - 1], coast[i]);
                    if (distance(coast[i - 1], p) + distance(p, coast[i]) < whole + 1e-3) {
                        return true;
                    }
                }
                return false;
            });
            EXPECT_TRUE(is_land(drawing, p) || at_coast) << p.x << ' ' << p.y;
        }
    }
}

} // namespace

TEST(Drawing, ARiverIsSmoothedAndSnapsToWhatItMeets) {
    Drawing const one = with_river(sheet(), {{40, 5}, {40, 59.5}});
    EXPECT_EQ(one.rivers.front().line.front(), at(40, 5));
    EXPECT_EQ(one.rivers.front().line.back(), at(40, 60)) << "the border";
    EXPECT_EQ(one.rivers.front().line.size(), 2U) << "straight";
    Drawing const two = with_river(one, {{10, 10}, {39, 30}});
    ASSERT_EQ(two.rivers.front().line.size(), 3U);
    EXPECT_EQ(two.rivers.front().line[1], two.rivers.back().line.back());
    expect_lawful(two);

    DrawnLine wave;
    for (double t = 0.0; t <= 1.0; t += 0.004) { // with the tremor of a hand
        double const tremor = std::fmod(t * 1000.0, 8.0) < 4.0 ? 0.3 : -0.3;
        wave.push_back(at(5.0 + 70.0 * t, 30.0 + 15.0 * std::sin(9.0 * t) + tremor));
    }
    DrawnLine const smooth = after(sheet(), DrawRiver{wave}).drawing.rivers.front().line;
    EXPECT_LT(smooth.size(), 60U);
    double off_m = 0.0;
    for (Vec2 const p : smooth) {
        double nearest_m = 1e9;
        for (double t = 0.0; t <= 1.0; t += 0.0005) {
            nearest_m = std::min(nearest_m, distance(p, at(5.0 + 70.0 * t, 30.0 + 15.0 * std::sin(9.0 * t))));
        }
        off_m = std::max(off_m, nearest_m);
    }
    EXPECT_LT(off_m, 0.8 * grid.cell_m);
}

TEST(Drawing, TheBorderIsNeverCrossedByRounding) {
    Drawing drawing;
    drawing.grid = {40, 30, 1.0 / 3.0, 761899.1999999997, 4036556.2000000003, "EPSG:32616"};
    Grid const& odd = drawing.grid;
    for (auto const& [x, y] : std::vector<std::pair<double, double>>{{-1, 15}, {41, 15}, {20, -1}, {20, 31}}) {
        Vec2 const outlet = {odd.west + x * odd.cell_m, odd.north - y * odd.cell_m};
        Vec2 const middle = {odd.west + 20 * odd.cell_m, odd.north - 15 * odd.cell_m};
        Vec2 const end = drawn(drawing, DrawRiver{{middle, outlet}}).drawing.rivers.front().line.back();
        EXPECT_TRUE(end.x >= odd.west && end.x <= odd.east() && end.y >= odd.south() && end.y <= odd.north) << x << y;
        EXPECT_EQ(end, rounded(end));
    }
}

TEST(Drawing, WhatLiesBeyondTheGridIsLeftOutAndTold) {
    DrawResult const river = after(sheet(), DrawRiver{line_of({{40, 30}, {70, 30}, {110, 30}})});
    EXPECT_EQ(river.drawing.rivers.front().line.back().x, grid.east());
    ASSERT_EQ(river.said.size(), 1U);
    EXPECT_EQ(river.said.front(), "0.3 km beyond the grid were left out");
}

TEST(Drawing, ARiverRunsToWhereItMeetsOtherWater) {
    Drawing const trunk = with_river(sheet(), {{40, 5}, {40, 59.5}});
    DrawResult const against = after(trunk, DrawRiver{line_of({{41, 30}, {70, 10}})});
    EXPECT_EQ(against.drawing.rivers.back().line.front(), at(70, 10));
    EXPECT_FALSE(against.said.empty());
    EXPECT_EQ(with_river(sheet(), {{40, 5}, {40, 50}}).rivers.front().line.front(), at(40, 5)) << "as drawn";
    EXPECT_EQ(with_river(sheet(), {{40, 1}, {40, 40}}).rivers.front().line.back(), at(40, 0)) << "to the border";
    // Where a river ends within the grid another goes on.
    Drawing const inland = with_river(sheet(), {{10, 10}, {40, 30}});
    Drawing const longer = with_river(inland, {{41, 31}, {70, 40}});
    EXPECT_EQ(longer.rivers.back().line.front(), at(40, 30));
    expect_lawful(longer);
}

TEST(Drawing, RefusesWhatWaterCannotDo) {
    Drawing const rivers = two_rivers();
    NotDrawn const crossing = refusal(rivers, DrawRiver{line_of({{10, 45}, {70, 45}})});
    EXPECT_TRUE(has(crossing, "cross"));
    ASSERT_TRUE(crossing.at);
    EXPECT_LT(distance(*crossing.at, at(40, 45)), 1.0);
    EXPECT_TRUE(has(refusal(rivers, DrawRiver{line_of({{41, 10}, {41, 55}})}), "")) << "beside the trunk";
    EXPECT_TRUE(has(refusal(rivers, DrawRiver{line_of({{44, 10}, {41.2, 25}, {44, 40}, {60, 55}})}), "too near"));
    EXPECT_TRUE(has(refusal(rivers, DrawRiver{line_of({{10, 50}, {12, 50}})}), "shorter"));
    EXPECT_TRUE(has(refusal(rivers, DrawRiver{line_of({{50, 10}, {70, 10}, {70, 30}, {60, 30}, {60, 5}})}), "itself"));
    // From the middle of one river into another.
    EXPECT_TRUE(has(refusal(with_river(rivers, {{70, 5}, {70, 59}}), DrawRiver{line_of({{40, 20}, {70, 20}})}),
                    "flow out of another"));
    EXPECT_TRUE(has(refusal(rivers, JoinRiver{0, false, at(20, 17)}), "")) << "its outlet lies at the border";
    Drawing const inland = with_river(with_river(sheet(), {{40, 5}, {40, 50}}), {{10, 10}, {39, 30}});
    EXPECT_TRUE(has(refusal(inland, JoinRiver{0, false, at(20, 17)}), "circle"));
    EXPECT_TRUE(has(refusal(rivers, MoveVertex{{Part::Kind::river, 9}, 0, at(1, 1)}), "not there"));
    EXPECT_TRUE(has(refusal(rivers, MoveVertex{{Part::Kind::river, 0}, 99, at(1, 1)}), "no vertex"));
    EXPECT_THROW(drawn(rivers, SetType{{0}, "Z"}), BadParameter);
    EXPECT_THROW(drawn(rivers, SetLambda{{0}, 51}), BadParameter);
    EXPECT_THROW(drawn(rivers, DrawRiver{{at(1, 1), {std::nan(""), 0.0}}}), NotDrawn);
}

TEST(Drawing, MovesWhatMeetsTogether) {
    Drawing const rivers = two_rivers();
    Drawing const moved = after(rivers, MoveVertex{{Part::Kind::river, 0}, 1, at(44, 33), 0.0}).drawing;
    EXPECT_EQ(moved.rivers[0].line[1], at(44, 33));
    EXPECT_EQ(moved.rivers[1].line.back(), at(44, 33));
    expect_lawful(moved);
    Drawing const bent = with_river(with_river(sheet(), {{40, 5}, {40, 59.5}}), {{10, 10}, {20, 28}, {39, 30}});
    std::size_t const vertex = bent.rivers[1].line.size() / 2;
    EXPECT_TRUE(has(refusal(bent, MoveVertex{{Part::Kind::river, 1}, vertex, at(60, 20), 0.0}), "cross"));

    DrawnLine many;
    for (int i = 0; i <= 40; ++i) {
        many.push_back(at(20 + i, 10));
    }
    Drawing dense = sheet();
    dense.rivers.push_back({many});
    DrawnLine const soft =
        after(dense, MoveVertex{{Part::Kind::river, 0}, 20, at(40, 15), 100.0}).drawing.rivers.front().line;
    EXPECT_EQ(soft[20], at(40, 15));
    EXPECT_EQ(soft[10], many[10]);
    EXPECT_GT(distance(soft[15], many[15]), 0.5 * 50.0);
    EXPECT_LT(distance(soft[15], many[15]), 0.6 * 50.0);
}

TEST(Drawing, CutsAndJoins) {
    Drawing const rivers = two_rivers();
    DrawResult const cut = after(rivers, CutRiver{0, at(40, 15)});
    ASSERT_EQ(cut.drawing.rivers.size(), 3U);
    EXPECT_EQ(cut.drawing.rivers[0].line.front(), at(40, 15));
    EXPECT_EQ(cut.drawing.rivers[2].line.back(), at(40, 11)) << "four cells above";
    expect_lawful(cut.drawing);
    Drawing const again = after(cut.drawing, JoinRiver{2, false, at(40, 15)}).drawing;
    EXPECT_EQ(again.rivers[2].line.back(), again.rivers[0].line.front());
    expect_lawful(again);
    EXPECT_EQ(rivers_into(again, 0), (std::vector<std::size_t>{1, 2}));
    // Where the source of one is carried to the end of another, that one goes on in it.
    Drawing const from_below = after(cut.drawing, JoinRiver{0, true, at(40, 11)}).drawing;
    EXPECT_EQ(from_below.rivers[2].line.back(), at(40, 15));
    EXPECT_TRUE(has(refusal(rivers, JoinRiver{1, false, at(60, 20)}), "already"));
    EXPECT_TRUE(has(refusal(rivers, CutRiver{0, at(40, 59)}), "too near"));
    Drawing const elsewhere = after(cut.drawing, JoinRiver{2, false, at(70, 12)}).drawing;
    EXPECT_EQ(elsewhere.rivers[2].line.back(), at(70, 12)) << "carried on where nothing is";
}

TEST(Drawing, ReversesARiverAndAllBelow) {
    DrawResult const turned = after(two_rivers(), ReverseRiver{1});
    ASSERT_EQ(turned.drawing.rivers.size(), 3U);
    EXPECT_EQ(turned.drawing.rivers[1].line.back(), at(10, 10)) << "the outlet of all";
    EXPECT_EQ(turned.drawing.rivers[2].line.front(), at(40, 60));
    EXPECT_EQ(turned.drawing.rivers[0].line.front(), at(40, 5)) << "above where they meet nothing changes";
    EXPECT_EQ(rivers_into(turned.drawing, 1), (std::vector<std::size_t>{0, 2}));
    expect_lawful(turned.drawing);
    EXPECT_FALSE(turned.said.empty());
}

TEST(Drawing, ErasesWithAllThatFlowsInto) {
    Drawing const rivers = with_river(two_rivers(), {{70, 5}, {70, 59}});
    EXPECT_EQ(after(rivers, Erase{{Part::Kind::river, 0}}).drawing.rivers.size(), 1U);
    EXPECT_EQ(after(rivers, Erase{{Part::Kind::river, 0}, true}).drawing.rivers.size(), 2U);
    EXPECT_EQ(after(rivers, Erase{{Part::Kind::river, 1}}).drawing.rivers.size(), 2U);
}

TEST(Drawing, CoastsAreClosedOrReachTheBorderAndCutRivers) {
    std::vector<Vec2> ring;
    for (double turn = 0.0; turn < 6.2; turn += 0.2) {
        ring.push_back({40 + 25 * std::cos(turn), 30 + 25 * std::sin(turn)}); // clockwise on the map
    }
    Drawing const island = after(sheet(), DrawCoast{line_of(ring)}).drawing;
    EXPECT_EQ(island.coasts.front().front(), island.coasts.front().back());
    EXPECT_TRUE(is_land(island, at(40, 30)));
    EXPECT_FALSE(is_land(island, at(5, 5)));
    DrawResult const river = after(island, DrawRiver{line_of({{40, 30}, {40, 59}})});
    EXPECT_NEAR(river.drawing.rivers.front().line.back().y, at(40, 55).y, 5.0) << "at the coast";
    EXPECT_FALSE(river.said.empty());
    EXPECT_TRUE(has(refusal(island, DrawRiver{line_of({{2, 2}, {30, 2}})}), "in the sea"));
    DrawResult const sea = after(river.drawing, SwapSides{0});
    EXPECT_TRUE(sea.drawing.rivers.empty());
    EXPECT_FALSE(sea.said.empty());
    EXPECT_FALSE(is_land(sea.drawing, at(40, 30)));
    // Where rivers lie outside, a closed coast is that of a sea within.
    Drawing const outside = with_river(sheet(), {{2, 2}, {2, 59}});
    EXPECT_TRUE(is_land(after(outside, DrawCoast{line_of(ring)}).drawing, at(2, 30)));
    // An open one is carried to the border.
    Drawing const open = after(sheet(), DrawCoast{line_of({{10, 20}, {40, 30}, {70, 20}})}).drawing;
    EXPECT_EQ(open.coasts.front().front().x, grid.west);
    EXPECT_EQ(open.coasts.front().back().x, grid.east());
    EXPECT_NE(is_land(open, at(40, 5)), is_land(open, at(40, 55)));
    EXPECT_TRUE(has(refusal(open, DrawCoast{line_of({{40, 2}, {40, 58}})}), "cross"));
}

TEST(Drawing, ACoastTakesNothingFromRiversOnLand) {
    Drawing arcs = sheet();
    arcs.rivers = {{line_of({{40, 25}, {40, 28}})}, // shorter than what can be drawn
                   {line_of({{30, 20}, {40, 28}})},
                   {line_of({{40, 28}, {41, 30}})},
                   {line_of({{41, 30}, {40, 45}})}};
    std::vector<Vec2> ring;
    for (double turn = 0.0; turn < 6.2; turn += 0.2) {
        ring.push_back({40 + 25 * std::cos(turn), 30 + 25 * std::sin(turn)});
    }
    DrawResult const island = after(arcs, DrawCoast{line_of(ring)});
    EXPECT_EQ(island.drawing.rivers, arcs.rivers);
    EXPECT_TRUE(island.said.empty());
    // A source may be dragged to the coast, wherever rounding puts it.
    for (Vec2 const p : island.drawing.coasts.front()) {
        EXPECT_FALSE(has(refusal(island.drawing, MoveVertex{{Part::Kind::river, 1}, 0, p}), "sea"));
    }
}

TEST(Drawing, SmallOrFarStrokesAreRefused) {
    EXPECT_THROW(drawn(sheet(), DrawCoast{line_of({{10, 10}, {12, 10}, {12, 12}, {10.5, 12}})}), NotDrawn);
    EXPECT_NO_THROW(drawn(two_rivers(), CutRiver{0, at(40, 20)}));
    EXPECT_THROW(drawn(two_rivers(), CutRiver{0, {1e308, 0.0}}), NotDrawn);
}

TEST(Drawing, LakesHaveLevels) {
    DrawResult const lake = after(two_rivers(), DrawLake{line_of({{35, 40}, {45, 40}, {45, 50}, {35, 50}}), 120.0});
    EXPECT_TRUE(lake.said.empty()) << "a river runs through it";
    EXPECT_EQ(lake.drawing.lakes.front().level_m, 120.0);
    EXPECT_EQ(after(lake.drawing, SetLevel{0, std::nullopt}).drawing.lakes.front().level_m, std::nullopt);
    EXPECT_FALSE(after(two_rivers(), DrawLake{line_of({{60, 40}, {70, 40}, {70, 50}, {60, 50}}), {}}).said.empty());
    EXPECT_TRUE(has(refusal(sheet(), DrawLake{line_of({{60, 40}, {61, 40}, {61, 41}}), {}}), "fewer than"));
    EXPECT_THROW(drawn(lake.drawing, SetLevel{0, 1e6}), BadParameter);
}

TEST(Drawing, PinsStandOnLandBesideRivers) {
    DrawResult const one = after(two_rivers(), DrawPin{at(60.2, 20.7), 340.0});
    EXPECT_EQ(one.drawing.pins, (std::vector<DrawnPin>{{at(60.2, 20.7), 340.0}}));
    EXPECT_EQ(one.name, "a pin at 340 m");
    EXPECT_EQ(one.drawing.rivers, two_rivers().rivers);
    NotDrawn const wet = refusal(one.drawing, DrawPin{at(40.3, 20), 340.0});
    EXPECT_TRUE(has(wet, "a river runs here"));
    EXPECT_EQ(wet.at, at(40.3, 20));
    EXPECT_TRUE(has(refusal(one.drawing, DrawPin{at(60.8, 20.1), 300.0}), "in this cell already"));
    EXPECT_TRUE(has(refusal(one.drawing, DrawPin{{std::nan(""), 0.0}, 300.0}), "not a number"));
    EXPECT_THROW(drawn(one.drawing, DrawPin{at(5, 5), 1e6}), BadParameter);
    EXPECT_THROW(drawn(one.drawing, SetHeight{0, std::nan("")}), BadParameter);
    EXPECT_TRUE(has(refusal(one.drawing, SetHeight{1, 300.0}), "a pin with the number 1 is not there"));
    EXPECT_EQ(after(one.drawing, SetHeight{0, 90.5}).drawing.pins.front().height_m, 90.5);
    EXPECT_EQ(after(one.drawing, DrawPin{at(1e6, -1e6), 1.0}).drawing.pins.back().at, at(80, 0)) << "in the grid";

    Part const pin{Part::Kind::pin, 0};
    EXPECT_EQ(after(one.drawing, MoveVertex{pin, 0, at(60.7, 20.2)}).drawing.pins.front().at, at(60.7, 20.2));
    EXPECT_TRUE(has(refusal(one.drawing, MoveVertex{pin, 0, at(40, 20)}), "a river runs here"));
    EXPECT_TRUE(has(refusal(one.drawing, InsertVertex{pin, 0, at(5, 5)}), "no vertices"));
    EXPECT_TRUE(has(refusal(one.drawing, RemoveVertex{pin, 0}), "no vertices"));
    EXPECT_TRUE(after(one.drawing, Erase{pin}).drawing.pins.empty());
    EXPECT_TRUE(after(one.drawing, Clear{}).drawing.pins.empty());

    EXPECT_TRUE(after(one.drawing, DrawRiver{line_of({{70, 10}, {50, 40}})}).said.empty());
    DrawResult const over = after(one.drawing, DrawRiver{line_of({{70.2, 10.7}, {50.2, 30.7}})});
    ASSERT_EQ(over.said.size(), 1U);
    EXPECT_EQ(over.said.front(), "1 pin lies in the river now: the river's height decides there");
    Drawing const coast = after(one.drawing, DrawCoast{line_of({{2, 2}, {78, 2}})}).drawing;
    EXPECT_TRUE(has(refusal(coast, DrawPin{at(20, 1), 5.0}), "in the sea"));
}

TEST(Drawing, RidgesEndShortOfRivers) {
    DrawResult const free = after(two_rivers(), DrawRidge{line_of({{50, 10}, {70, 30}}), 500.0, std::nullopt});
    ASSERT_EQ(free.drawing.ridges.size(), 1U);
    EXPECT_TRUE(free.said.empty());
    EXPECT_EQ(free.drawing.ridges[0].line, line_of({{50, 10}, {70, 30}}));
    EXPECT_EQ(free.drawing.ridges[0].heights_m, (std::vector<std::optional<double>>{500.0, std::nullopt}));

    DrawResult const cut = after(two_rivers(), DrawRidge{line_of({{70, 20}, {39, 20}})});
    ASSERT_EQ(cut.drawing.ridges.size(), 1U);
    EXPECT_NEAR(cut.drawing.ridges[0].line.back().x, at(41.75, 20).x, 0.3 * grid.cell_m);
    EXPECT_EQ(cut.drawing.ridges[0].line.front(), at(70, 20));
    ASSERT_EQ(cut.said.size(), 1U);
    EXPECT_TRUE(cut.said[0].starts_with("the ridge ends short of the river"));
    NotDrawn const across = refusal(two_rivers(), DrawRidge{line_of({{60, 20}, {20, 20}})});
    EXPECT_TRUE(has(across, "cross or touch a river"));
    ASSERT_TRUE(across.at);
    EXPECT_LT(distance(*across.at, at(40, 20)), 2.0 * grid.cell_m);
    EXPECT_TRUE(has(refusal(two_rivers(), DrawRidge{line_of({{40.5, 10}, {40.5, 50}})}), "cross or touch a river"));
    EXPECT_TRUE(has(refusal(free.drawing, DrawRiver{line_of({{70, 15}, {50, 25}})}), "cross or touch a ridge"));
    EXPECT_TRUE(
        has(refusal(free.drawing, MoveVertex{{Part::Kind::ridge, 0}, 0, at(20, 40)}), "cross or touch a river"));

    Drawing const coast = after(two_rivers(), DrawCoast{line_of({{2, 2}, {78, 2}})}).drawing;
    DrawResult const land = after(coast, DrawRidge{line_of({{60, 20}, {60, 0.5}})});
    EXPECT_TRUE(test::has(land.said.at(0), "the ridge ends at the coast"));
    EXPECT_TRUE(has(refusal(coast, DrawRidge{line_of({{50, 1}, {70, 1}})}), "in the sea: ridges run on land"));
}

TEST(Drawing, RidgesHaveHeightsAtTheirEndsOrNone) {
    Part const ridge{Part::Kind::ridge, 0};
    using Heights = std::vector<std::optional<double>>;
    Drawing const one = after(two_rivers(), DrawRidge{line_of({{50, 10}, {70, 30}}), 500.0, 300.0}).drawing;
    Drawing bent = after(one, InsertVertex{ridge, 1, at(62, 18)}).drawing;
    EXPECT_EQ(bent.ridges[0].heights_m, (Heights{500.0, std::nullopt, 300.0}));
    EXPECT_TRUE(has(refusal(bent, InsertVertex{ridge, 0, at(45, 5)}), "between two others"));
    Drawing const moved = after(bent, MoveVertex{ridge, 1, at(65, 15), 5.0}).drawing;
    EXPECT_EQ(moved.ridges[0].line, line_of({{50, 10}, {65, 15}, {70, 30}}));
    EXPECT_EQ(moved.ridges[0].heights_m, bent.ridges[0].heights_m);
    Drawing const merged = after(bent, MoveVertex{ridge, 1, at(50, 10)}).drawing;
    EXPECT_EQ(merged.ridges[0].heights_m, (Heights{500.0, 300.0})) << "two vertices at one place are one";
    EXPECT_EQ(after(bent, RemoveVertex{ridge, 1}).drawing.ridges[0], one.ridges[0]);
    Drawing const shorter = after(bent, RemoveVertex{ridge, 2}).drawing;
    EXPECT_EQ(shorter.ridges[0].heights_m, (Heights{500.0, 300.0})) << "the height is the end's";
    EXPECT_TRUE(has(refusal(one, RemoveVertex{ridge, 0}), "erase it as a whole"));

    bent.ridges[0].heights_m[1] = 450.0; // as a file may say
    EXPECT_EQ(after(bent, SetRidgeHeights{0, 600.0, std::nullopt}).drawing.ridges[0].heights_m,
              (Heights{600.0, 450.0, std::nullopt}));
    EXPECT_EQ(after(bent, SetRidgeHeights{0, std::nullopt, std::nullopt}).drawing.ridges[0].heights_m, Heights(3));
    EXPECT_THROW(drawn(one, SetRidgeHeights{0, 1e6, std::nullopt}), BadParameter);
    EXPECT_TRUE(has(refusal(one, SetRidgeHeights{1, 1.0, 2.0}), "not there"));
    EXPECT_TRUE(after(one, Erase{ridge}).drawing.ridges.empty());
    EXPECT_TRUE(after(one, Clear{}).drawing.ridges.empty());
}

TEST(Drawing, SideStreamsGrowFromWholeRivers) {
    Drawing arcs = sheet();
    arcs.rivers = {{line_of({{10, 10}, {40, 20}})},
                   {line_of({{60, 10}, {40, 20}})},
                   {line_of({{40, 20}, {40, 40}})},
                   {line_of({{10, 40}, {40, 40}})},
                   {line_of({{40, 40}, {40, 60}})}};
    Drawing const streams = after(arcs, SetSideStreams{true}).drawing;
    ASSERT_EQ(streams.rivers.size(), 3U);
    EXPECT_TRUE(std::ranges::any_of(streams.rivers, [&](DrawnRiver const& r) {
        return r.line == line_of({{10, 10}, {40, 20}, {40, 40}, {40, 60}});
    })) << "the longest way";
    expect_lawful(streams);
    EXPECT_TRUE(has(refusal(streams, DrawCoast{line_of({{10, 20}, {70, 20}})}), "side streams"));
}

TEST(Drawing, CoastsOfAMaskSeparateLandFromSea) {
    Mask land(grid);
    std::mt19937_64 random(7);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        double const bay = 8.0 * std::sin(0.2 * static_cast<double>(c.row));
        bool const is_island = squared_cells(c, {65, 30}) < 64;
        land[i] = static_cast<double>(c.col) < 40.0 + bay || is_island ? 1 : 0;
    }
    Drawing drawing = sheet();
    drawing.coasts = coasts_of(land);
    EXPECT_EQ(drawing.coasts.size(), 2U);
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        wrong += is_land(drawing, grid.centre(grid.at(i))) != (land[i] != 0) ? 1 : 0;
    }
    EXPECT_LT(wrong, 60) << "within a cell of the coast";
    EXPECT_TRUE(coasts_of(Mask(grid, 1)).empty());
    EXPECT_TRUE(coasts_of(Mask()).empty());
}

TEST(Drawing, AnyStepsKeepTheLaws) {
    std::size_t accepted = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937_64 random(seed);
        Drawing drawing = sheet();
        for (int i = 0; i < 60; ++i) {
            json const verb = random_draw(drawing, random);
            SCOPED_TRACE(verb.dump());
            try {
                drawing = drawn(drawing, draw_step(verb.dump(), grid)).drawing;
                ++accepted;
            } catch (NotDrawn const& refused) {
                EXPECT_FALSE(std::string(refused.what()).empty());
                continue;
            }
            ASSERT_NO_THROW(expect_lawful(drawing)) << drawing_message(drawing, 0, true);
            if (testing::Test::HasFailure()) {
                return;
            }
        }
    }
    EXPECT_GT(accepted, 200U);
}

TEST(Drawing, FilesHoldItBitForBit) {
    io::TemporaryFolder const folder("drawing");
    Drawing drawing = two_rivers();
    drawing.rivers[1].type = "C";
    drawing.rivers[1].lambda = 3;
    drawing = after(drawing, DrawCoast{line_of({{2, 2}, {78, 2}})}).drawing;
    write_drawing(drawing, (folder.path() / "drawing.gpkg").string());
    recipe::Recipe recipe = recipe::default_recipe_on(80, 60);
    recipe.folder = folder.path().string();
    recipe.network->source = recipe::Source::lines;
    recipe.network->lines.path = "drawing.gpkg";
    ASSERT_TRUE(is_drawn(recipe));
    Drawing const read = read_drawing(recipe, grid);
    ASSERT_EQ(read.rivers.size(), drawing.rivers.size());
    for (std::size_t r = 0; r < read.rivers.size(); ++r) {
        EXPECT_EQ(read.rivers[r].line, drawing.rivers[r].line);
        EXPECT_EQ(read.rivers[r].type, drawing.rivers[r].type);
        EXPECT_EQ(read.rivers[r].lambda, drawing.rivers[r].lambda);
    }
    EXPECT_EQ(read.coasts, drawing.coasts);
}

TEST(Drawing, RiversMeanderThatAreDrawnOnAnEmptySheet) {
    std::int64_t count = 0;
    PutInput const put = [&](std::string const& key, std::string const& name, auto const&) {
        return TakeInput{key, fmt::format("inputs/{}/{}", ++count, name)};
    };
    auto const cleared = [&](Document const& document) {
        return apply(document, empty_sheet(document, grid, put)).document;
    };
    auto const with_a_river = [&](Document const& document, Drawing const& before) {
        DrawResult const after = drawn(before, DrawRiver{line_of({{70, 5}, {70, 50}})});
        return apply(document, edit_between(document, before, after, put)).document;
    };
    auto const with = [&](Document const& document, char const* meander) {
        return apply(document, {"", {SetKey{"network.meander", meander}}}).document;
    };
    Document const grown = document_of(recipe::write_recipe(recipe::default_recipe_on(80, 60)));
    Document const empty = cleared(grown);
    ASSERT_EQ(empty.recipe.network->meander, 1.0);
    EXPECT_EQ(with_a_river(empty, sheet()).recipe.network->meander, 1.0);
    EXPECT_EQ(cleared(with(grown, "0.5")).recipe.network->meander, 0.5) << "the recipe says how much";

    Document const straight = with(empty, "0");
    EXPECT_EQ(with_a_river(straight, sheet()).recipe.network->meander, 0.0) << "who switched it off has it so";
    EXPECT_EQ(cleared(with_a_river(straight, sheet())).recipe.network->meander, 0.0);
    Document const usual = apply(empty, {"", {UnsetKey{"network.meander"}}}).document;
    EXPECT_EQ(with_a_river(usual, sheet()).recipe.network->meander, std::nullopt) << "likewise by the default of lines";
    EXPECT_EQ(cleared(with(grown, "0")).recipe.network->meander, 0.0);

    Document const changed = with_a_river(with(grown, "1"), two_rivers());
    EXPECT_EQ(changed.recipe.network->meander, std::nullopt) << "rivers that grew have their bends";
    Document const diffused = apply(grown, {"", {SetKey{"surface.method", "diffuse"}}}).document;
    EXPECT_EQ(cleared(diffused).recipe.network->meander, std::nullopt) << "as for rivers that grow";
}

TEST(Drawing, FilesHoldLevelsAndHolesOfMasks) {
    io::TemporaryFolder const folder("drawing");
    Document document = document_of(recipe::write_recipe(recipe::default_recipe_on(80, 60)));
    Drawing const before = two_rivers();
    Drawing now = before;
    now.lakes = {{{line_of({{35, 40}, {45, 40}, {45, 50}}), line_of({{41, 42}, {44, 42}, {44, 45}})}, 120.5},
                 {{line_of({{5, 40}, {15, 40}, {15, 50}})}, std::nullopt}};
    now.masks = {line_of({{1, 1}, {79, 1}, {79, 59}, {1, 59}})};
    now.mask_islands = {{line_of({{5, 5}, {9, 5}, {9, 9}})}};
    Edit const edit =
        edit_between(document, before, {now, "", {}}, [&](auto const& key, auto const& name, auto const& write) {
            std::filesystem::create_directories(folder.path() / "inputs/1");
            write((folder.path() / "inputs/1" / name).string());
            return TakeInput{key, "inputs/1/" + name};
        });
    EXPECT_EQ(edit.steps.size(), 3U) << "rivers are as they were; no lakes are chosen beside those drawn";
    document = apply(document, edit).document;
    document.recipe.folder = folder.path().string();
    Drawing const read = read_drawing(document.recipe, grid);
    ASSERT_EQ(read.lakes.size(), 2U);
    EXPECT_EQ(read.lakes[0].level_m, 120.5);
    EXPECT_EQ(read.lakes[0].rings.size(), 2U);
    EXPECT_EQ(read.lakes[1].level_m, std::nullopt);
    ASSERT_EQ(read.mask_islands.size(), 1U);
    EXPECT_EQ(read.mask_islands[0].size(), 1U);
}

namespace {

/// Edits a document as a studio does, its files in a folder.
class Sheets {
public:
    explicit Sheets(std::string const& toml) : document(document_of(toml)) { follow(); }

    void become(Drawing const& now) {
        Edit const edit =
            edit_between(document, drawing, {now, "", {}}, [&](auto const& key, auto const& name, auto const& write) {
                std::string const file = "inputs/" + std::to_string(++files_) + "/" + name;
                std::filesystem::create_directories((folder_.path() / file).parent_path());
                write((folder_.path() / file).string());
                return TakeInput{key, file};
            });
        document = apply(document, edit).document;
        follow();
    }

    Document document;
    Drawing drawing;

private:
    void follow() {
        document.recipe.folder = folder_.path().string();
        drawing = read_drawing(document.recipe, grid);
    }

    io::TemporaryFolder folder_{"drawing"};
    int files_ = 0;
};

} // namespace

TEST(Drawing, FilesHoldPinsAndRidges) {
    Sheets sheets(recipe::write_recipe(recipe::default_recipe_on(80, 60)));
    std::string const first = sheets.document.toml;
    Drawing now = sheets.drawing;
    now.pins = {{at(60.25, 20.7), 340.5}, {at(5, 5), -3.25}};
    sheets.become(now);
    EXPECT_EQ(sheets.drawing.pins, now.pins);
    EXPECT_TRUE(sheets.drawing.ridges.empty());
    EXPECT_TRUE(test::has(sheets.document.toml, "[skeleton]\npoints = 'inputs/1/points.gpkg'\n"));

    now.ridges = {{line_of({{50, 10}, {60, 12}, {70, 30}}), {std::nullopt, std::nullopt, std::nullopt}}};
    sheets.become(now);
    EXPECT_EQ(sheets.drawing.ridges, now.ridges) << "all without heights";
    now.ridges.push_back({line_of({{20, 50}, {30, 50}, {30, 55}}), {500.0, std::nullopt, 300.25}});
    now.ridges.push_back({line_of({{10, 50}, {15, 50}}), {std::nullopt, 70.0}});
    sheets.become(now);
    EXPECT_EQ(sheets.drawing.ridges, now.ridges) << "some with heights";
    EXPECT_EQ(sheets.drawing.pins, now.pins);

    now.pins.clear();
    sheets.become(now);
    EXPECT_TRUE(test::has(sheets.document.toml, "[skeleton]\npoints = ''\nridge_lines = 'inputs/"));
    now.ridges.clear();
    sheets.become(now);
    EXPECT_EQ(sheets.document.toml, first) << "the section goes with the last one";
}

TEST(Drawing, OtherKeysOfTheSkeletonStay) {
    recipe::Recipe recipe = recipe::default_recipe_on(80, 60);
    recipe.surface->method = recipe::Method::diffuse;
    recipe.skeleton.emplace().ridges = recipe::Ridges::voronoi;
    Sheets sheets(recipe::write_recipe(recipe));
    std::string const first = sheets.document.toml;
    Drawing now = sheets.drawing;
    now.pins = {{at(60.25, 20.7), 340.5}};
    sheets.become(now);
    EXPECT_NE(sheets.document.toml, first);
    now.pins.clear();
    sheets.become(now);
    EXPECT_EQ(sheets.document.toml, first);
    EXPECT_TRUE(test::has(first, "ridges = 'voronoi'"));
}

TEST(Drawing, PointsOfAUsersFileArePins) {
    io::TemporaryFolder const folder("drawing");
    std::string csv = "x,y,z\n";
    for (int i = 0; i < 10000; ++i) {
        csv += std::to_string(5000 + i % 100 * 7.5) + "," + std::to_string(8400 + i / 100 * 5.5) + "," +
               std::to_string(100 + i) + "\n";
    }
    test::write((folder.path() / "points.csv").string(), csv);
    recipe::Recipe recipe = recipe::default_recipe_on(80, 60);
    recipe.folder = folder.path().string();
    recipe.skeleton.emplace().points = "points.csv";
    Drawing const read = read_drawing(recipe, grid);
    ASSERT_EQ(read.pins.size(), 10000U);
    EXPECT_EQ(read.pins[101], (DrawnPin{{5007.5, 8405.5}, 201.0}));
    EXPECT_EQ(after(read, SetHeight{101, 7.0}).drawing.pins[101].height_m, 7.0);
}

TEST(Drawing, StepsAreReadFromWordsOfThePage) {
    auto const fault = [](std::string const& what) { return test::message_of<Error>([&] { draw_step(what, grid); }); };
    EXPECT_NE(fault("[]"), "");
    EXPECT_NE(fault(R"({"verb":"fly"})").find("verb is one of river"), std::string::npos);
    EXPECT_NE(fault(R"({"verb":"river","points":[1,2,3]})").find("points"), std::string::npos);
    EXPECT_NE(fault(R"({"verb":"river","points":["a","b"]})").find("numbers"), std::string::npos);
    EXPECT_NE(fault(R"({"verb":"move","of":{"hill":1},"vertex":0,"to":[1,2]})").find("part"), std::string::npos);
    EXPECT_NE(fault(R"({"verb":"move","of":{"river":-1},"vertex":0,"to":[1,2]})").find("number from 0"),
              std::string::npos);
    EXPECT_NE(fault(R"({"verb":"cut","river":0,"at":[1]})").find("place"), std::string::npos);
    auto const river =
        std::get<DrawRiver>(draw_step(R"({"verb":"river","points":[0,0,1,2],"type":"C","lambda":2})", grid));
    EXPECT_EQ(river.points, (DrawnLine{at(0, 0), at(1, 2)}));
    EXPECT_EQ(river.lambda, 2);
    EXPECT_EQ(std::get<SetLevel>(draw_step(R"({"verb":"level","lake":2,"level":null})", grid)).level_m, std::nullopt);
    auto const pin = std::get<DrawPin>(draw_step(R"({"verb":"pin","at":[1,2],"height":-3.5})", grid));
    EXPECT_EQ(pin.at, at(1, 2));
    EXPECT_EQ(pin.height_m, -3.5);
    EXPECT_NE(fault(R"({"verb":"pin","at":[1,2]})").find("height must be a number [m]"), std::string::npos);
    EXPECT_NE(fault(R"({"verb":"height","pin":0,"height":"high"})").find("height must be"), std::string::npos);
    auto const ridge = std::get<DrawRidge>(draw_step(R"({"verb":"ridge","points":[0,0,1,2],"to":9})", grid));
    EXPECT_EQ(ridge.points, (DrawnLine{at(0, 0), at(1, 2)}));
    EXPECT_EQ(ridge.from_m, std::nullopt);
    EXPECT_EQ(ridge.to_m, 9.0);
    EXPECT_EQ(std::get<SetRidgeHeights>(draw_step(R"({"verb":"heights","ridge":1,"from":5,"to":null})", grid)).from_m,
              5.0);
    EXPECT_EQ(std::get<Erase>(draw_step(R"({"verb":"erase","pin":3})", grid)).of.kind, Part::Kind::pin);
    auto const move = draw_step(R"({"verb":"move","of":{"ridge":0},"vertex":1,"to":[1,2]})", grid);
    EXPECT_EQ(std::get<MoveVertex>(move).of.kind, Part::Kind::ridge);
}

} // namespace drawing_test
