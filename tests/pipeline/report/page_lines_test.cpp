// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <pipeline/page_decoder.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace page_lines_test {

using namespace thalweg;
using pipeline::page_lines;
using pipeline::PageLines;

namespace {

using Line = std::vector<Vec2>;
using test::has;
using test::message_of;

PageLines page_of(std::vector<Line> const& lines, Grid const& grid) {
    std::vector<std::span<Vec2 const>> const spans(lines.begin(), lines.end());
    return page_lines(spans, grid);
}

Grid const grid{100, 80, 30.0, 500000.0, 4000000.0, ""};

Vec2 in_steps(Vec2 at, PageLines const& page, Grid const& frame) {
    double const step_m = page.step * frame.cell_m;
    return {(at.x - frame.west) / step_m, (frame.north - at.y) / step_m};
}

bool near(Vec2 a, Vec2 b) {
    constexpr double half = 0.5 + 1e-9;
    return std::fabs(a.x - b.x) <= half && std::fabs(a.y - b.y) <= half;
}

/// The direction of a way between whole steps, as short as it can be written.
std::pair<std::int64_t, std::int64_t> heading(Vec2 from, Vec2 to) {
    auto const dx = static_cast<std::int64_t>(to.x - from.x);
    auto const dy = static_cast<std::int64_t>(to.y - from.y);
    std::int64_t const common = std::gcd(dx, dy);
    return {dx / common, dy / common};
}

/// A line's vertices in whole steps without those that turn nothing.
Line turns_of(Line const& line, PageLines const& page, Grid const& frame) {
    Line distinct;
    for (Vec2 const vertex : line) {
        Vec2 const at = in_steps(vertex, page, frame);
        Vec2 const whole{std::floor(at.x + 0.5), std::floor(at.y + 0.5)};
        RC_ASSERT(near(whole, at));
        if (distinct.empty() || !(distinct.back() == whole)) {
            distinct.push_back(whole);
        }
    }
    if (distinct.size() == 1) {
        return {distinct[0], distinct[0]};
    }
    Line turns{distinct.front()};
    for (std::size_t i = 1; i + 1 < distinct.size(); ++i) {
        if (heading(distinct[i - 1], distinct[i]) != heading(distinct[i], distinct[i + 1])) {
            turns.push_back(distinct[i]);
        }
    }
    turns.push_back(distinct.back());
    return turns;
}

} // namespace

TEST(PageLines, NoLines) {
    PageLines const page = page_of({}, grid);
    EXPECT_TRUE(page.vertices.empty());
    EXPECT_TRUE(page.bytes.empty());
    EXPECT_EQ(page.step, 0.0625);
}

TEST(PageLines, RefusesWhatIsNoLineHere) {
    EXPECT_THROW(page_of({{}}, grid), BadInput);
    EXPECT_THROW(page_of({{{500000.0, 4000000.0}}}, grid), BadInput);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(page_of({{{500000.0, 4000000.0}, {nan, 4000000.0}}}, grid), BadInput);
    EXPECT_TRUE(
        has(message_of<BadInput>([&] {
                page_of({{{500000.0, 4000000.0}, {500001.0, 4000000.0}}, {{500000.0, 4000000.0}, {1e300, 0.0}}}, grid);
            }),
            "vertex 1 of line 2"));
}

TEST(PageLines, TwoVerticesStay) {
    PageLines const page = page_of({{{500030.0, 3999970.0}, {500030.1, 3999970.0}, {500030.0, 3999970.0}}}, grid);
    EXPECT_EQ(page.vertices, std::vector<std::int64_t>{2});
    EXPECT_EQ(page.bytes, (std::vector<std::uint8_t>{32, 32, 0, 0}));
}

TEST(PageLines, StraightWaysNeedNoVerticesAndTurnsDo) {
    Line line;
    for (int i = 0; i <= 10; ++i) {
        line.push_back({500000.0 + 30.0 * i, 4000000.0 - 60.0 * i});
    }
    line.push_back({500150.0, 3999700.0}); // straight back
    line.push_back({500150.0, 3999700.0});
    line.push_back({500150.0, 3999000.0});
    EXPECT_EQ(page_of({line}, grid).vertices, std::vector<std::int64_t>{4});
}

TEST(PageLines, BytesOfASmallOne) {
    PageLines const page =
        page_of({{{500000.0, 4000000.0}, {500007.5, 3999700.0}}, {{500000.0, 4000007.5}, {500000.0, 3999700.0}}}, grid);
    EXPECT_EQ(page.vertices, (std::vector<std::int64_t>{2, 2}));
    // 0 0, 4 160, -4 -164, 0 164
    EXPECT_EQ(page.bytes, (std::vector<std::uint8_t>{0, 0, 8, 0xC0, 2, 7, 0xC7, 2, 0, 0xC8, 2}));
}

TEST(PageLines, EveryVertexWithinHalfAStepAndNoDrift) {
    ASSERT_TRUE(rc::check("the decoded lines are the nearest whole steps, without what turns nothing", [] {
        Grid frame = grid;
        frame.width = *rc::gen::element(100, 3000, 20000);
        frame.height = *rc::gen::element(80, 4000);
        double const pace = *rc::gen::element(0.4, 7.0, 300.0, 20000.0);
        std::vector<Line> lines(*rc::gen::inRange<std::size_t>(1, 6));
        for (Line& line : lines) {
            auto const n = *rc::gen::inRange(2, 60);
            Vec2 at{500000.0 + *rc::gen::inRange(0, 3000), 4000000.0 - *rc::gen::inRange(0, 2400)};
            for (int i = 0; i < n; ++i) {
                line.push_back(at);
                at.x += pace * *rc::gen::inRange(-4, 9) / 4.0;
                at.y -= pace * *rc::gen::inRange(-4, 9) / 4.0;
            }
        }
        PageLines const page = page_of(lines, frame);
        RC_ASSERT(page.step == static_cast<double>(pipeline::page_cells(frame)) / 16.0);
        auto const decoded = page_decoder::lines(page.bytes, page.vertices);
        RC_ASSERT(decoded.size() == lines.size());
        for (std::size_t l = 0; l < lines.size(); ++l) {
            RC_ASSERT(decoded[l] == turns_of(lines[l], page, frame));
        }
    }));
}

} // namespace page_lines_test
