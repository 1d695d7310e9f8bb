// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/tin.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/blend/internal/cut_tin.hpp>
#include <thalweg/blend/internal/region.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include "lands.hpp"

namespace tin_test {

using namespace thalweg;
using namespace thalweg::blend;
using geometry::Measured;

namespace {

using test::full_message_of;

using Height = std::function<double(Vec2)>;

/// A mesh of squares halved along either diagonal, from a corner on.
Tin squares(int cols, int rows, double side_m, Vec2 from, std::uint64_t seed, Height const& height) {
    Tin tin;
    for (int row = 0; row <= rows; ++row) {
        for (int col = 0; col <= cols; ++col) {
            Vec2 const p{from.x + side_m * col, from.y + side_m * row};
            tin.vertices.push_back({p.x, p.y, height(p)});
        }
    }
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            auto const sw = static_cast<std::uint32_t>(row * (cols + 1) + col);
            std::uint32_t const se = sw + 1;
            std::uint32_t const nw = sw + static_cast<std::uint32_t>(cols) + 1;
            std::uint32_t const ne = nw + 1;
            if (random_word(seed, sw) % 2 == 0) {
                tin.triangles.push_back({sw, se, nw});
                tin.triangles.push_back({se, ne, nw});
            } else {
                tin.triangles.push_back({sw, se, ne});
                tin.triangles.push_back({sw, ne, nw});
            }
        }
    }
    return tin;
}

double flat(Vec2 /*p*/) {
    return 0.0;
}

double sloping(Vec2 p) {
    return 100.0 + 0.25 * p.x - 0.5 * p.y;
}

double area(Tin const& tin) {
    double sum = 0.0;
    for (auto const& t : tin.triangles) {
        sum += 0.5 * cross(in_plan(tin.vertices[t[0]]), in_plan(tin.vertices[t[1]]), in_plan(tin.vertices[t[2]]));
    }
    return sum;
}

/// Turned about a place, then moved.
Tin placed(Tin tin, double angle, Vec2 about, Vec2 by) {
    for (Vec3& v : tin.vertices) {
        double const x = v.x - about.x;
        double const y = v.y - about.y;
        v.x = about.x + by.x + std::cos(angle) * x - std::sin(angle) * y;
        v.y = about.y + by.y + std::sin(angle) * x + std::cos(angle) * y;
    }
    return tin;
}

/// What is wrong with a mesh as a TIN that covers an area; "" for nothing.
std::string fault_of(Tin const& tin, double wanted_area) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<int> used(tin.vertices.size(), 0);
    for (auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (t[k] >= tin.vertices.size()) {
                return "a vertex that is not there";
            }
            used[t[k]] = 1;
            if (!edges.insert({t[k], t[(k + 1) % 3]}).second) {
                return "two triangles on one side of an edge";
            }
        }
        if (!(cross(in_plan(tin.vertices[t[0]]), in_plan(tin.vertices[t[1]]), in_plan(tin.vertices[t[2]])) > 0.0)) {
            return "a triangle without area or facing down";
        }
    }
    if (std::count(used.begin(), used.end(), 0) > 0) {
        return "a vertex in no triangle";
    }
    std::set<std::pair<double, double>> places;
    for (Vec3 const& v : tin.vertices) {
        if (!places.insert({v.x, v.y}).second) {
            return "two vertices at one place";
        }
    }
    // Whole and without overlaps: no edge but the target's rim lacks its twin, and the areas agree.
    return std::fabs(area(tin) - wanted_area) > 1e-9 * wanted_area ? "another area" : "";
}

double length_of_rim(Tin const& tin) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.insert({t[k], t[(k + 1) % 3]});
        }
    }
    double length = 0.0;
    for (auto const& [a, b] : edges) {
        length += edges.count({b, a}) == 0 ? distance(in_plan(tin.vertices[a]), in_plan(tin.vertices[b])) : 0.0;
    }
    return length;
}

/// The height of a mesh at a place, by looking at every triangle; NaN off it.
double height_at(Tin const& tin, Vec2 p) {
    for (auto const& t : tin.triangles) {
        Vec3 const& a = tin.vertices[t[0]];
        Vec3 const& b = tin.vertices[t[1]];
        Vec3 const& c = tin.vertices[t[2]];
        double const all = cross(in_plan(a), in_plan(b), in_plan(c));
        double const in_a = cross(in_plan(b), in_plan(c), p) / all;
        double const in_b = cross(in_plan(c), in_plan(a), p) / all;
        double const in_c = 1.0 - in_a - in_b;
        if (in_a > -1e-9 && in_b > -1e-9 && in_c > -1e-9) {
            return in_a * a.z + in_b * b.z + in_c * c.z;
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

std::string refusal(Tin const& target, Tin const& patch) {
    return full_message_of<BadInput>([&] { fuse_tin(target, patch); });
}

void expect_refused(Tin const& target, Tin const& patch, std::string const& words) {
    EXPECT_TRUE(test::has(refusal(target, patch), words));
}

/// The centres of a land's cells as a TIN, each square halved along either diagonal.
Tin tin_of(Raster<float> const& land, std::uint64_t seed) {
    Tin tin;
    Grid const& grid = land.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Vec2 const p = grid.centre(grid.at(i));
        tin.vertices.push_back({p.x, p.y, land[i]});
    }
    for (std::int64_t row = 0; row + 1 < grid.height; ++row) {
        for (std::int64_t col = 0; col + 1 < grid.width; ++col) {
            auto const nw = static_cast<std::uint32_t>(grid.index({col, row}));
            std::uint32_t const ne = nw + 1;
            auto const sw = static_cast<std::uint32_t>(grid.index({col, row + 1}));
            std::uint32_t const se = sw + 1;
            if (random_word(seed, nw) % 2 == 0) {
                tin.triangles.push_back({sw, ne, nw});
                tin.triangles.push_back({sw, se, ne});
            } else {
                tin.triangles.push_back({nw, sw, se});
                tin.triangles.push_back({nw, se, ne});
            }
        }
    }
    return tin;
}

std::vector<Vec3> with_heights(Tin const& tin, Raster<float> const& land) {
    std::vector<Vec3> places = tin.vertices;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].z = land[static_cast<std::int64_t>(i)];
    }
    return places;
}

} // namespace

TEST(FuseTin, OneTriangleInOneTriangle) {
    Tin const target{{{0, 0, 0}, {10, 0, 10}, {0, 10, 20}}, {{0, 1, 2}}};
    Tin const patch{{{2, 2, 7}, {4, 2, 9}, {2, 4, 7}}, {{0, 1, 2}}};
    FusedTin const fused = fuse_tin(target, patch);
    EXPECT_EQ(fault_of(fused.tin, 50.0), "");
    EXPECT_EQ(fused.tin.vertices.size(), 6U);
    EXPECT_EQ(fused.removed, 0);
    EXPECT_EQ(fused.inner, 0);
    EXPECT_EQ(fused.added, 3);
    for (Vec3 const& v : fused.tin.vertices) {
        EXPECT_NEAR(v.z, v.x + 2.0 * v.y, 1e-12);
    }
}

TEST(FuseTin, RefusesWhatCannotBePasted) {
    Tin const target = squares(8, 8, 10.0, {0, 0}, 1, flat);
    Tin const patch = squares(3, 3, 5.0, {22, 23}, 2, flat);
    expect_refused(target, squares(3, 3, 5.0, {500, 500}, 2, flat), "off the target");
    expect_refused(target, squares(3, 3, 5.0, {72, 30}, 2, flat), "leaves the target");
    expect_refused(target, squares(3, 3, 50.0, {-20, -20}, 2, flat), "leaves the target");
    expect_refused(target, Tin{}, "has no triangles");

    Tin holed = patch;
    holed.triangles.erase(holed.triangles.begin() + 8, holed.triangles.begin() + 10); // the middle square
    expect_refused(target, holed, "the patch has several boundaries");

    Tin two = squares(1, 1, 5.0, {20, 20}, 2, flat);
    Tin const second = squares(1, 1, 5.0, {40, 40}, 2, flat);
    for (auto const& t : second.triangles) {
        two.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    }
    two.vertices.insert(two.vertices.end(), second.vertices.begin(), second.vertices.end());
    expect_refused(target, two, "the patch has several boundaries");

    Tin folded = patch;
    std::swap(folded.triangles[3][0], folded.triangles[3][1]);
    expect_refused(target, folded, "the patch is folded in plan");
    expect_refused(folded, patch, "the target is folded in plan");

    Tin upright = patch;
    upright.vertices[0] = {27, 23, 9};
    upright.vertices[1] = {27, 23, 0};
    upright.triangles = {{0, 1, 4}};
    expect_refused(target, upright, "has no area in plan");

    Tin const touching{{{20, 20, 0}, {30, 20, 0}, {25, 25, 0}, {30, 30, 0}, {20, 30, 0}}, {{0, 1, 2}, {2, 3, 4}}};
    expect_refused(target, touching, "touches itself at (25, 25)");

    Tin broken = patch;
    broken.vertices[5].z = std::nan("");
    expect_refused(target, broken, "vertex 6 is not finite");
    broken.triangles[0][0] = 99;
    expect_refused(target, broken, "triangle 1 names a vertex that is not there");

    // A ramp that winds over itself has one boundary, which crosses itself in plan.
    Tin ramp;
    for (int i = 0; i <= 30; ++i) {
        double const turn = 0.25 * i;
        for (double const r : {4.0, 8.0 + 0.1 * i}) {
            ramp.vertices.push_back({40 + r * std::cos(turn), 40 + r * std::sin(turn), 1.0 * i});
        }
    }
    for (std::uint32_t i = 0; i < 30; ++i) {
        ramp.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        ramp.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
    }
    expect_refused(target, ramp, "meets itself in plan");

    Tin with_hole = target; // the target's own hole lies under the patch
    with_hole.triangles.erase(with_hole.triangles.begin() + 2 * (8 * 2 + 2),
                              with_hole.triangles.begin() + 2 * (8 * 2 + 3));
    expect_refused(with_hole, squares(1, 1, 30.0, {15, 15}, 2, flat), "over its holes");
}

TEST(FuseTin, APartOfTheTargetGivesItsHeightsBack) {
    Tin const target = squares(9, 8, 10.0, {500000, 4000000}, 3, [](Vec2 p) {
        return 100.0 * unit(random_word(5, static_cast<std::uint64_t>(p.x), static_cast<std::uint64_t>(p.y)));
    });
    Tin part = target;
    part.triangles.clear();
    for (auto const& t : target.triangles) {
        double const x = (target.vertices[t[0]].x + target.vertices[t[1]].x + target.vertices[t[2]].x) / 3.0;
        double const y = (target.vertices[t[0]].y + target.vertices[t[1]].y + target.vertices[t[2]].y) / 3.0;
        if (x > 500020 && x < 500062 && y > 4000013 && y < 4000055) {
            part.triangles.push_back(t);
        }
    }
    ASSERT_GT(part.triangles.size(), 20U);
    FusedTin const fused = fuse_tin(target, part); // vertices of the part in no triangle do not matter
    EXPECT_EQ(fault_of(fused.tin, area(target)), "");
    EXPECT_EQ(fused.added, 0);
    EXPECT_EQ(fused.removed, fused.inner);
    EXPECT_LT(fused.lift_max_m, 1e-12);
    ASSERT_EQ(fused.tin.vertices.size(), target.vertices.size());
    EXPECT_EQ(fused.tin.triangles.size(), target.triangles.size());
    std::map<std::pair<double, double>, double> heights;
    for (Vec3 const& v : target.vertices) {
        heights[{v.x, v.y}] = v.z;
    }
    for (Vec3 const& v : fused.tin.vertices) {
        EXPECT_NEAR(v.z, (heights.at({v.x, v.y})), 1e-10);
    }
    FusedTin const whole = fuse_tin(target, target); // outlines on one another
    EXPECT_EQ(fault_of(whole.tin, area(target)), "");
    EXPECT_EQ(whole.tin.vertices.size(), target.vertices.size());
}

TEST(FuseTin, AHillOnFlatLandIsTheHill) {
    auto const hill = [](Vec2 p) {
        double const r = std::hypot(p.x - 40.3, p.y - 39.1) / 20.0;
        return std::max(0.0, 30.0 * (1.0 - r * r));
    };
    Tin const target = squares(8, 8, 10.0, {0, 0}, 1, flat);
    Tin patch = squares(20, 20, 2.2, {18, 17}, 2, hill);
    for (std::uint32_t const v : outline_of(patch, "the patch")) {
        ASSERT_EQ(patch.vertices[v].z, 0.0);
    }
    FusedTin const fused = fuse_tin(target, patch);
    EXPECT_EQ(fault_of(fused.tin, 6400.0), "");
    EXPECT_EQ(fused.lift_max_m, 0.0);
    std::size_t high = 0;
    for (Vec3 const& v : fused.tin.vertices) {
        EXPECT_NEAR(v.z, hill(in_plan(v)), 1e-9) << v.x << ", " << v.y;
        high += v.z > 1.0 ? 1U : 0U;
    }
    EXPECT_GT(high, 200U);
    for (auto& t : patch.triangles) { // all facing down: turned over
        std::swap(t[0], t[1]);
    }
    EXPECT_EQ(fuse_tin(target, patch).tin.vertices, fused.tin.vertices);
    for (Vec3& v : patch.vertices) { // lifted as a whole, it is let down again
        v.z += 500.0;
    }
    FusedTin const lowered = fuse_tin(target, patch);
    EXPECT_NEAR(lowered.lift_max_m, 500.0, 1e-9);
    for (Vec3 const& v : lowered.tin.vertices) {
        EXPECT_NEAR(v.z, hill(in_plan(v)), 1e-9);
    }
}

TEST(FuseTin, AnywhereItIsWholeAndFollowsTheTargetOnItsOutline) {
    ASSERT_TRUE(rc::check("placed at random", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>().as("seed");
        auto const by_chance = [&](double most, std::uint64_t place) {
            return most * unit(random_word(seed, 7, place));
        };
        bool const planes = *rc::gen::arbitrary<bool>().as("planes");
        Height const rough = [&](Vec2 p) {
            return planes ? sloping(p)
                          : 50.0 * unit(random_word(seed, static_cast<std::uint64_t>(1e6 + 4.0 * p.x),
                                                    static_cast<std::uint64_t>(1e6 + 4.0 * p.y)));
        };
        Tin const target = squares(7, 6, 10.0, {0, 0}, seed, rough);
        int const cols = *rc::gen::inRange(1, 6).as("columns");
        // Whole numbers put vertices on vertices and edges on edges.
        bool const on_lattice = *rc::gen::arbitrary<bool>().as("on the lattice");
        double const side = on_lattice ? *rc::gen::element(2.5, 5.0, 10.0).as("side") : 3.0 + by_chance(3.0, 1);
        Tin patch = squares(cols, 2, side, {0, 0}, seed + 1, planes ? Height(flat) : rough);
        Vec2 const by = on_lattice
                            ? Vec2{5.0 * *rc::gen::inRange(0, 5).as("east"), 5.0 * *rc::gen::inRange(0, 9).as("north")}
                            : Vec2{20.0 + by_chance(10.0, 2), 20.0 + by_chance(10.0, 3)};
        patch = placed(patch, on_lattice ? 0.0 : by_chance(6.0, 4), {0, 0}, by);
        if (planes) {
            for (Vec3& v : patch.vertices) {
                v.z = sloping(in_plan(v)) + 17.0;
            }
        }
        bool const within = std::all_of(patch.vertices.begin(), patch.vertices.end(), [](Vec3 const& v) {
            return v.x >= 0.0 && v.x <= 70.0 && v.y >= 0.0 && v.y <= 60.0;
        });
        if (!within) {
            RC_ASSERT(refusal(target, patch).find("leaves the target") != std::string::npos);
            return;
        }
        FusedTin const fused = fuse_tin(target, patch);
        RC_ASSERT(fault_of(fused.tin, 4200.0) == "");
        RC_ASSERT(std::fabs(length_of_rim(fused.tin) - 260.0) < 1e-9);
        Tin const region = facing_up(patch, "the patch");
        for (Vec3 const& v : fused.tin.vertices) {
            bool const inside = !std::isnan(height_at(region, in_plan(v)));
            if (planes) {
                RC_ASSERT(std::fabs(v.z - sloping(in_plan(v))) < 1e-9);
            } else if (!inside) {
                RC_ASSERT(v.z == rough(in_plan(v))); // the target's own vertices alone
            }
        }
        for (std::uint32_t const v : outline_of(region, "the patch")) {
            Vec2 const p = in_plan(region.vertices[v]);
            RC_ASSERT(std::fabs(height_at(fused.tin, p) - height_at(target, p)) < 1e-6);
        }
        // Beyond the outline the surface is the target's, triangles cut or not.
        for (std::uint64_t i = 0; i < 50; ++i) {
            Vec2 const p{by_chance(70.0, 100 + 2 * i), by_chance(60.0, 101 + 2 * i)};
            if (std::isnan(height_at(region, p))) {
                RC_ASSERT(std::fabs(height_at(fused.tin, p) - height_at(target, p)) < 1e-6);
            }
        }
    }));
}

TEST(FuseTin, InsideGradientsDifferFromThePatchsByAHarmonicPart) {
    // Of a patch raised along its outline by a linear function the inside rises by the same function.
    Tin const target = squares(8, 8, 10.0, {0, 0}, 1, sloping);
    auto const waves = [](Vec2 p) { return 3.0 * std::sin(p.x) * std::cos(1.3 * p.y); };
    Tin patch = squares(10, 9, 3.0, {21.5, 22.5}, 2, waves);
    std::vector<std::uint32_t> const ring = outline_of(patch, "the patch");
    for (std::uint32_t const v : ring) {
        patch.vertices[v].z = 0.0;
    }
    FusedTin const fused = fuse_tin(target, patch);
    EXPECT_EQ(fault_of(fused.tin, 6400.0), "");
    std::map<std::pair<double, double>, double> own;
    for (Vec3 const& v : patch.vertices) {
        own[{v.x, v.y}] = v.z;
    }
    std::size_t met = 0;
    for (Vec3 const& v : fused.tin.vertices) {
        if (auto const at = own.find({v.x, v.y}); at != own.end()) {
            EXPECT_NEAR(v.z, at->second + sloping(in_plan(v)), 1e-9);
            ++met;
        }
    }
    EXPECT_EQ(met, own.size());
}

TEST(PasteTin, RefusesWhatCannotBePutTogether) {
    Tin const tin{{{0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}, {9, 9, 9}},
                  {{0, 1, 2}, {3, 4, 5}}};
    auto const own = gradients_of(tin, tin.vertices);
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] {
                              paste_tin(tin, {}, {{0, {0, 0, 1}}});
                          }),
                          "guidance for 0 triangles"));
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { paste_tin(tin, own, {{0, {0, 0, 1}}}); }), "vertex 4"));
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { paste_tin(tin, own, {{7, {}}}); }), "vertex 8 of 7"));
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] {
                              paste_tin(tin, own, {{0, {0, 0, 1}}, {0, {0, 0, 2}}});
                          }),
                          "give one of them"));
    auto wrong = own;
    wrong[1].z.x = std::nan("");
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] {
                              paste_tin(tin, wrong, {{0, {0, 0, 1}}});
                          }),
                          "triangle 2 is not finite"));
    Tin flat = tin;
    flat.vertices[2] = {2, 0, 9};
    EXPECT_TRUE(
        test::has(full_message_of<BadInput>([&] { gradients_of(flat, flat.vertices); }), "has no area in plan"));
    EXPECT_TRUE(test::has(full_message_of<BadInput>([&] { gradients_of(tin, {}); }), "0 places"));
    EXPECT_THROW(rotation({0, 0, 0}, 10.0), BadParameter);
    EXPECT_THROW(rotation({0, 0, 1}, std::nan("")), BadParameter);
    EXPECT_EQ(paste_tin({}, {}, {}).tin.vertices.size(), 0U);
    // A vertex in no triangle stays.
    PastedTin const pasted = paste_tin(tin, own, {{0, {0, 0, 1}}, {3, {5, 5, 4}}});
    EXPECT_EQ(pasted.tin.vertices[6], tin.vertices[6]);
    EXPECT_NEAR(pasted.tin.vertices[5].z, 4.0, 1e-12);
}

TEST(PasteTin, OnAGridItIsTheFivePointForm) {
    ASSERT_TRUE(rc::check("to 1e-8, whichever way the squares are halved", [] {
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(3, 20).as("columns"),
                                      *rc::gen::inRange<std::int64_t>(3, 20).as("rows"), 30.0);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Raster<float> const target = lands::by_chance(grid, seed);
        Raster<float> const source = lands::by_chance(grid, seed + 1);
        Mask const pins = lands::mask_by_chance(grid, seed + 2, 0.05);
        Tin const tin = tin_of(target, seed + 3);
        std::vector<FixedVertex> fixed;
        Raster<std::uint8_t> kind(grid, static_cast<std::uint8_t>(solver::CellKind::free));
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (grid.on_border(grid.at(i)) || pins[i] != 0) {
                kind[i] = static_cast<std::uint8_t>(solver::CellKind::fixed);
                fixed.push_back({static_cast<std::uint32_t>(i), tin.vertices[static_cast<std::size_t>(i)]});
            }
        }
        solver::PoissonParams tight;
        tight.tolerance = 1e-12;
        auto const on_grid =
            solve_guided(kind, lands::patch_of(target, pins).z, lands::patch_of(source, pins).z, {}, tight);
        PastedTin const on_tin = paste_tin(tin, gradients_of(tin, with_heights(tin, source)), fixed);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            auto const& v = on_tin.tin.vertices[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(v.z - on_grid.value[i]) <= 1e-8);
            RC_ASSERT((v.x == grid.centre(grid.at(i)).x && v.y == grid.centre(grid.at(i)).y));
        }
        RC_ASSERT(on_tin.residual <= 1e-10);
    }));
}

TEST(PasteTin, ItsOwnGradientsGiveTheMeshBitForBit) {
    Grid const grid = test::frame(9, 7, 0.3);
    Tin const tin = tin_of(lands::by_chance(grid, 5), 6);
    for (Measured const measured : {Measured::in_plan, Measured::on_surface}) {
        auto const own = gradients_of(tin, tin.vertices, measured);
        PastedTin const pasted = paste_tin(tin, own, {{11, tin.vertices[11]}, {40, tin.vertices[40]}}, measured);
        EXPECT_EQ(pasted.tin.vertices, tin.vertices);
        EXPECT_EQ(pasted.tin.triangles, tin.triangles);
        EXPECT_EQ(pasted.residual, 0.0);
    }
}

TEST(PasteTin, GuidanceThatIsTurnedAndScaledTurnsAndScalesTheMesh) {
    ASSERT_TRUE(rc::check("about the fixed vertex, to 1e-9", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Tin const tin = tin_of(lands::by_chance(test::frame(11, 9, 10.0), seed), seed);
        double const angle = *rc::gen::inRange(-180, 181).as("degrees");
        double const scale = *rc::gen::element(1.0, 0.5, 3.0).as("scale");
        bool const upright = *rc::gen::arbitrary<bool>().as("about z");
        Vec3 const axis = upright ? Vec3{0, 0, 2} : Vec3{1, -2, 0.5};
        auto guidance = gradients_of(tin, tin.vertices, Measured::on_surface);
        LinearMap const map = rotation(axis, angle, scale);
        for (CoordinateGradients& g : guidance) {
            g = mapped(map, g);
        }
        Vec3 const hub = tin.vertices[17];
        PastedTin const pasted = paste_tin(tin, guidance, {{17, hub}}, Measured::on_surface);
        double const c = std::cos(angle * 3.14159265358979323846 / 180.0);
        double const s = std::sin(angle * 3.14159265358979323846 / 180.0);
        for (std::size_t i = 0; i < tin.vertices.size(); ++i) {
            Vec3 const& p = tin.vertices[i];
            Vec3 const& q = pasted.tin.vertices[i];
            Vec3 const before{p.x - hub.x, p.y - hub.y, p.z - hub.z};
            Vec3 const after{q.x - hub.x, q.y - hub.y, q.z - hub.z};
            if (upright) {
                RC_ASSERT(std::fabs(after.x - scale * (c * before.x - s * before.y)) <= 1e-9);
                RC_ASSERT(std::fabs(after.y - scale * (s * before.x + c * before.y)) <= 1e-9);
                RC_ASSERT(std::fabs(after.z - scale * before.z) <= 1e-9);
            } else {
                auto const square = [](Vec3 const& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
                auto const along = [&](Vec3 const& v) { return v.x * axis.x + v.y * axis.y + v.z * axis.z; };
                RC_ASSERT(std::fabs(square(after) - scale * scale * square(before)) <= 1e-8 * (1.0 + square(before)));
                RC_ASSERT(std::fabs(along(after) - scale * along(before)) <= 1e-8);
            }
        }
    }));
}

} // namespace tin_test
