// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/crossings.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <stop_token>
#include <tuple>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace crossings_test {

using thalweg::BadInput;
using thalweg::Vec2;
using thalweg::geometry::Crossing;
using thalweg::geometry::crossings;
using thalweg::geometry::EndNodes;
using thalweg::geometry::Meeting;
using thalweg::geometry::meetings;

namespace {

using Lines = std::vector<std::vector<Vec2>>;

// Line, segment, place and point of each entry.
using Entry = std::tuple<std::size_t, std::size_t, double, double, double>;

std::vector<Entry> entries(std::vector<Crossing> const& found) {
    std::vector<Entry> out;
    for (auto const& c : found) {
        out.emplace_back(c.line, c.segment, c.along, c.at.x, c.at.y);
    }
    return out;
}

// The oracle: all pairs, whole coordinates, fractions of 64-bit numbers; the division at the end rounds once.
struct Whole {
    std::int64_t x;
    std::int64_t y;
};

std::int64_t cross(Whole a, Whole b) {
    return a.x * b.y - a.y * b.x;
}

Whole operator-(Whole a, Whole b) {
    return {a.x - b.x, a.y - b.y};
}

std::vector<Entry> all_pairs(std::vector<std::vector<Whole>> const& lines) {
    std::set<Entry> out;
    auto const inside = [](Whole a, Whole b, Whole p) {
        Whole const d = b - a;
        Whole const q = p - a;
        std::int64_t const dot = d.x * q.x + d.y * q.y;
        return cross(d, q) == 0 && dot >= 0 && dot <= d.x * d.x + d.y * d.y;
    };
    auto const note = [&](std::size_t l, std::size_t i, Whole p) { // p lies on the segment
        Whole const d = lines[l][i + 1] - lines[l][i];
        Whole const q = p - lines[l][i];
        double const along = d.x != 0 ? static_cast<double>(q.x) / static_cast<double>(d.x)
                                      : static_cast<double>(q.y) / static_cast<double>(d.y);
        out.emplace(l, i, along, static_cast<double>(p.x), static_cast<double>(p.y));
    };
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::size_t i = 0; i + 1 < lines[l].size(); ++i) {
            for (std::size_t m = l; m < lines.size(); ++m) {
                for (std::size_t j = m == l ? i + 1 : 0; j + 1 < lines[m].size(); ++j) {
                    Whole const a = lines[l][i];
                    Whole const b = lines[l][i + 1];
                    Whole const c = lines[m][j];
                    Whole const d = lines[m][j + 1];
                    std::int64_t const area = cross(b - a, d - c);
                    if (l == m && j == i + 1 && !(area == 0 && (inside(a, b, d) || inside(c, d, a)))) {
                        continue; // neighbours that do not fold back
                    }
                    for (Whole const p : {a, b, c, d}) {
                        if (inside(a, b, p) && inside(c, d, p)) {
                            note(l, i, p);
                            note(m, j, p);
                        }
                    }
                    if (area == 0) {
                        continue;
                    }
                    // Place on ab: s / area, on cd: t / area, both strictly inside.
                    std::int64_t const sign = area > 0 ? 1 : -1;
                    std::int64_t const s = sign * cross(c - a, d - c);
                    std::int64_t const t = sign * cross(c - a, b - a);
                    std::int64_t const whole = sign * area;
                    if (s <= 0 || s >= whole || t <= 0 || t >= whole) {
                        continue;
                    }
                    auto const ratio = [&](std::int64_t n) {
                        return static_cast<double>(n) / static_cast<double>(whole);
                    };
                    double const x = ratio(a.x * whole + s * (b.x - a.x));
                    double const y = ratio(a.y * whole + s * (b.y - a.y));
                    out.emplace(l, i, ratio(s), x, y);
                    out.emplace(m, j, ratio(t), x, y);
                }
            }
        }
    }
    return {out.begin(), out.end()};
}

std::vector<Entry> sorted(std::vector<Entry> in) {
    std::ranges::sort(in);
    return in;
}

std::vector<EndNodes> apart(Lines const& lines) {
    std::vector<EndNodes> nodes;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        nodes.push_back({2 * l, 2 * l + 1});
    }
    return nodes;
}

} // namespace

TEST(Crossings, NothingGivesNothing) {
    EXPECT_TRUE(crossings({}).empty());
    EXPECT_TRUE(crossings({{}, {}}).empty());
    EXPECT_TRUE(crossings({{{1, 1}}, {{1, 1}}}).empty());
    EXPECT_TRUE(crossings({{{0, 0}, {1, 0}, {2, 1}}}).empty());
}

TEST(Crossings, RefusesWhatIsNotFinite) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(crossings({{{0, 0}, {nan, 1}}}), BadInput);
    EXPECT_THROW(crossings({{{0, 0}, {1, inf}}}), BadInput);
}

TEST(Crossings, OneRepeatedPoint) {
    EXPECT_TRUE(crossings({{{1, 1}, {1, 1}, {1, 1}}}).empty());
    auto const found = entries(crossings({{{1, 1}, {1, 1}}, {{0, 0}, {4, 4}}}));
    EXPECT_EQ(found, (std::vector<Entry>{{0, 0, 0.0, 1, 1}, {1, 0, 0.25, 1, 1}}));
}

TEST(Crossings, RepeatedVertexIsNoCrossing) {
    EXPECT_TRUE(crossings({{{0, 0}, {1, 0}, {1, 0}, {1, 0}, {2, 1}}}).empty());
    auto const found = entries(crossings({{{0, 0}, {0, 0}, {2, 0}}, {{1, -1}, {1, 1}, {1, 1}}}));
    EXPECT_EQ(found, (std::vector<Entry>{{0, 1, 0.5, 1, 0}, {1, 0, 0.5, 1, 0}}));
}

TEST(Crossings, NearMissIsNoCrossing) {
    // The end is one unit in the last place off the line: floating-point areas would call it collinear.
    double const above = std::nextafter(0.5, 1.0);
    EXPECT_TRUE(crossings({{{0, 0}, {1, 1}}, {{0, 1}, {0.5, above}}}).empty());
    EXPECT_EQ(crossings({{{0, 0}, {1, 1}}, {{0, 1}, {0.5, 0.5}}}).size(), 2U);
}

TEST(Crossings, ThreeLinesThroughOnePointShareItsBits) {
    // (1/3, 1/3) is no double; three different pairs must round it alike.
    auto const found = crossings({{{0, 0}, {1, 1}}, {{0, 1}, {0.5, 0}}, {{1, 0}, {0, 0.5}}});
    ASSERT_EQ(found.size(), 3U);
    for (auto const& c : found) {
        EXPECT_EQ(c.at, found.front().at);
        EXPECT_EQ(c.at.x, 1.0 / 3.0);
    }
}

TEST(Crossings, StopsWhenAsked) {
    Lines comb(2);
    for (int i = 0; i < 400; ++i) {
        comb[0].push_back({i % 2 == 0 ? 0.0 : 100.0, static_cast<double>(i)});
        comb[1].push_back({static_cast<double>(i), i % 2 == 0 ? 0.0 : 400.0});
    }
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(crossings(comb, run), thalweg::Cancelled);
}

// Law: the same entries as the oracle over all pairs, on grids so small that every degeneracy occurs.
TEST(Crossings, EqualsAllPairs) {
    for (int const span : {3, 6, 30, 1000}) {
        bool const ok = rc::check("span " + std::to_string(span), [span] {
            auto const point = rc::gen::construct<Whole>(rc::gen::inRange<std::int64_t>(0, span),
                                                         rc::gen::inRange<std::int64_t>(0, span));
            auto whole = *rc::gen::container<std::vector<std::vector<Whole>>>(
                5, rc::gen::mapcat(rc::gen::inRange<std::size_t>(0, 8),
                                   [&](std::size_t n) { return rc::gen::container<std::vector<Whole>>(n, point); }));
            Lines lines;
            for (auto& line : whole) {
                auto const same = [](Whole a, Whole b) { return a.x == b.x && a.y == b.y; };
                line.erase(std::unique(line.begin(), line.end(), same), line.end());
                lines.emplace_back();
                for (auto const p : line) {
                    lines.back().push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
                }
            }
            RC_ASSERT(sorted(entries(crossings(lines))) == all_pairs(whole));
        });
        ASSERT_TRUE(ok);
    }
}

// Law: turning a line round mirrors its entries; the points stay the same bits.
TEST(Crossings, CrowdsFarApartAreAsEachAlone) {
    // Alone a grid's cells hold few segments each. Together both crowds are in two cells, and the grid is not used.
    bool const ok = rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        thalweg::RandomStream words(seed, 1, 0);
        auto const below = [&](std::uint64_t n) { return static_cast<std::int64_t>(words.word() % n); };
        std::vector<std::vector<Whole>> whole;
        Lines alone;
        for (int l = 0; l < 100; ++l) {
            Whole at{below(100), below(100)};
            auto& line = whole.emplace_back();
            auto& drawn = alone.emplace_back();
            for (int v = 0; v < 3; ++v) {
                line.push_back(at);
                drawn.push_back({static_cast<double>(at.x), static_cast<double>(at.y)});
                at = {at.x + below(4) + 1, at.y + below(7) - 3};
            }
        }
        Lines together = alone;
        for (auto const& line : alone) {
            auto& moved = together.emplace_back(line);
            for (Vec2& p : moved) {
                p = p + Vec2{1e6, -1e6};
            }
        }
        std::vector<Crossing> const expected = crossings(alone);
        RC_ASSERT(sorted(entries(expected)) == all_pairs(whole));
        std::vector<Crossing> const found = crossings(together);
        RC_ASSERT(found.size() == 2 * expected.size());
        for (std::size_t k = 0; k < expected.size(); ++k) {
            RC_ASSERT(found[k] == expected[k]);
            Crossing const& other = found[k + expected.size()];
            RC_ASSERT(other.line == expected[k].line + alone.size());
            RC_ASSERT(other.segment == expected[k].segment);
            RC_ASSERT(other.along == expected[k].along);
        }
    });
    EXPECT_TRUE(ok);
}

TEST(Crossings, ManySegmentsAreAsFew) {
    // Copies one above another, so many that they are taken in bands, whose borders cut upright lines.
    constexpr std::size_t copies = 1500;
    constexpr double apart = 1000.0;
    thalweg::RandomStream words(7, 1, 0);
    auto const below = [&](std::uint64_t n) { return static_cast<double>(words.word() % n); };
    Lines alone{{{500.0, 0.0}, {501.0, 950.0}, {502.0, 1.0}}};
    for (int l = 0; l < 99; ++l) {
        Vec2 const at{below(900), below(900)};
        alone.push_back({at, at + Vec2{below(50), below(90) - 45.0}, at + Vec2{60.0, below(90) - 45.0}});
    }
    Lines many;
    for (std::size_t k = 0; k < copies; ++k) {
        for (auto line : alone) {
            for (Vec2& p : line) {
                p.y += apart * static_cast<double>(k);
            }
            many.push_back(std::move(line));
        }
    }
    std::vector<Crossing> const expected = crossings(alone);
    std::vector<Crossing> const found = crossings(many);
    ASSERT_GT(expected.size(), 10U);
    ASSERT_EQ(found.size(), copies * expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        Crossing const& one = expected[k % expected.size()];
        ASSERT_EQ(found[k].line % alone.size(), one.line);
        ASSERT_EQ(found[k].segment, one.segment);
        ASSERT_NEAR(found[k].along, one.along, 1e-9);
    }
}

TEST(Crossings, PointsDoNotDependOnDirection) {
    bool const ok = rc::check([] {
        auto const coordinate = rc::gen::map(rc::gen::inRange(-1000000, 1000000), [](int i) { return i * 1e-3; });
        auto const point = rc::gen::construct<Vec2>(coordinate, coordinate);
        auto const line = rc::gen::container<std::vector<Vec2>>(6, point);
        Lines lines = *rc::gen::container<Lines>(3, line);
        std::set<std::pair<double, double>> drawn;
        std::set<std::pair<double, double>> turned;
        for (auto const& c : crossings(lines)) {
            drawn.emplace(c.at.x, c.at.y);
        }
        std::ranges::reverse(lines[1]);
        std::ranges::reverse(lines);
        for (auto const& c : crossings(lines)) {
            turned.emplace(c.at.x, c.at.y);
        }
        RC_ASSERT(drawn == turned);
    });
    ASSERT_TRUE(ok);
}

TEST(Meetings, NothingGivesNothing) {
    EXPECT_TRUE(meetings({}, {}).empty());
    EXPECT_TRUE(meetings({{}, {{1, 1}}}, {{0, 1}, {2, 3}}).empty());
    EXPECT_TRUE(meetings({{{0, 0}, {1, 0}, {2, 1}}}, {{0, 1}}).empty());
}

TEST(Meetings, RefusesWhatDoesNotBelongTogether) {
    EXPECT_THROW(meetings({{{0, 0}, {1, 0}}}, {}), BadInput);
    EXPECT_THROW(meetings({{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}}}, {{0, 1}}), BadInput);
}

TEST(Meetings, ACommonNodeIsNone) {
    Lines const lines{{{0, 2}, {1, 1}}, {{2, 2}, {1, 1}}, {{1, 1}, {1, 0}}};
    EXPECT_TRUE(meetings(lines, {{1, 4}, {2, 4}, {4, 5}}).empty());
    // The second has a node of its own in the same place.
    EXPECT_EQ(meetings(lines, {{1, 4}, {2, 3}, {4, 5}}),
              (std::vector<Meeting>{{0, 1, 0, 0, {1, 1}, {1, 1}}, {1, 2, 0, 0, {1, 1}, {1, 1}}}));
}

TEST(Meetings, AFoldIsOneOfALineWithItself) {
    EXPECT_EQ(meetings({{{0, 0}, {4, 0}, {3, 0}, {3, -1}}}, {{0, 1}}),
              (std::vector<Meeting>{{0, 0, 0, 1, {3, 0}, {4, 0}}, {0, 0, 0, 2, {3, 0}, {3, 0}}}));
}

TEST(Meetings, ARingMeetsItself) {
    Lines const ring{{{0, 0}, {1, 0}, {1, 1}, {0, 0}}};
    EXPECT_EQ(meetings(ring, {{0, 1}}), (std::vector<Meeting>{{0, 0, 0, 2, {0, 0}, {0, 0}}}));
}

TEST(Meetings, AreWhereCrossingsAre) {
    ASSERT_TRUE(rc::check("the places are those of crossings", [] {
        auto const whole = [](int beyond) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, beyond)); };
        Lines lines(static_cast<std::size_t>(whole(5)));
        for (auto& line : lines) {
            line.resize(static_cast<std::size_t>(whole(6)));
            for (Vec2& p : line) {
                p = {static_cast<double>(whole(6)), static_cast<double>(whole(6))};
            }
        }
        for (auto& line : lines) {
            line.erase(std::unique(line.begin(), line.end()), line.end());
        }
        using Place = std::tuple<std::size_t, std::size_t, double, double>; // line, segment
        std::set<Place> met;
        for (Meeting const& m : meetings(lines, apart(lines))) {
            for (Vec2 const p : {m.at, m.until}) {
                met.emplace(m.line, m.segment, p.x, p.y);
                met.emplace(m.other, m.other_segment, p.x, p.y);
            }
        }
        std::set<Place> crossed;
        for (auto const& c : thalweg::geometry::crossings(lines)) {
            crossed.emplace(c.line, c.segment, c.at.x, c.at.y);
        }
        RC_ASSERT(met == crossed);
    }));
}

} // namespace crossings_test
