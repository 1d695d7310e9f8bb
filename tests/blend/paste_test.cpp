// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/paste.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "lands.hpp"
#include "oracle.hpp"

namespace paste_test {

using namespace thalweg;
using namespace thalweg::blend;

namespace {

using test::full_message_of;
using test::on_threads;

constexpr std::uint64_t any_seed = 1000000;

PasteParams tight() {
    PasteParams params;
    params.tolerance = 1e-12;
    return params;
}

/// Everything a patch can be: many parts and holes, cells to keep, land without data.
struct Drawn {
    Raster<float> target;
    Patch patch;
    PasteParams params;
};

Drawn drawn() {
    Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(1, 9).as("columns"),
                                  *rc::gen::inRange<std::int64_t>(1, 9).as("rows"));
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, any_seed).as("seed");
    double const share = *rc::gen::element(0.1, 0.5, 0.8, 0.95, 1.0).as("share of the mask");
    Drawn d{lands::by_chance(grid, seed, *rc::gen::element(0.0, 0.1, 0.4).as("target without data")),
            lands::patch_of(lands::by_chance(grid, seed + 1, *rc::gen::element(0.0, 0.0, 0.2).as("patch without data")),
                            lands::mask_by_chance(grid, seed, share)),
            tight()};
    d.params.relief = *rc::gen::element(Relief::source, Relief::mixed).as("relief");
    d.params.holes = *rc::gen::element(Holes::leave, Holes::fill).as("holes");
    d.params.feather_cells = *rc::gen::element(0.0, 0.0, 1.0, 2.5).as("feather");
    if (*rc::gen::arbitrary<bool>().as("some are kept")) {
        d.params.keep = lands::mask_by_chance(grid, seed + 2, 0.2);
    }
    return d;
}

std::string refused(Raster<float> const& source, Grid const& target, PlacePatchParams const& params) {
    return full_message_of<BadInput>([&] { place_patch(source, target, params); });
}

/// Cells without data at the edge, and those without data beside such, until there are no more.
Mask beyond_outline(Raster<float> const& source) {
    Grid const& grid = source.grid();
    Mask beyond(grid);
    for (std::int64_t round = 0; round < grid.cells(); ++round) {
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            Cell const c = grid.at(i);
            bool reaches = grid.on_border(c);
            for (Cell const n : oracle::around(grid, c)) {
                reaches = reaches || beyond[n] != 0;
            }
            if (reaches && std::isnan(source[i])) {
                beyond[i] = 1;
            }
        }
    }
    return beyond;
}

std::int64_t count(Mask const& mask) {
    std::int64_t cells = 0;
    for (std::uint8_t const m : mask.values()) {
        cells += m != 0 ? 1 : 0;
    }
    return cells;
}

} // namespace

TEST(Paste, RefusesWhatCannotBePasted) {
    Grid const grid = test::frame(5, 4, 30.0);
    Raster<float> const target = lands::by_chance(grid, 1);
    Raster<float> const land = lands::by_chance(grid, 2);
    Mask const middle = lands::block(grid, {1, 1}, {3, 2});
    EXPECT_THROW(paste(Raster<float>{}, Patch{}), BadInput);
    EXPECT_THROW(paste(target, Patch{}), BadInput);
    EXPECT_THROW(paste(target, lands::patch_of(lands::by_chance(test::frame(5, 4, 10.0), 2), middle)), BadInput);
    for (double const feather : {-1.0, std::nan(""), 1e7}) {
        PasteParams params;
        params.feather_cells = feather;
        EXPECT_THROW(paste(target, lands::patch_of(land, middle), params), BadParameter);
    }
    PasteParams params;
    params.keep = Mask(test::frame(4, 5));
    EXPECT_THROW(paste(target, lands::patch_of(land, middle), params), BadInput);

    auto const refused = [&](Raster<float> const& onto, Patch const& patch, PasteParams const& how = {}) {
        return full_message_of<BadInput>([&] { paste(onto, patch, how); });
    };
    EXPECT_EQ(refused(target, lands::patch_of(land, Mask(grid))),
              "blend.paste: no cell of the target would change: take a mask that holds cells with heights");
    EXPECT_TRUE(test::has(refused(target, lands::patch_of(land, Mask(grid, 1))), "all 5 x 4 cells"));
    Raster<float> const nothing(grid, lands::nan);
    EXPECT_TRUE(test::has(refused(nothing, lands::patch_of(land, middle)), "6 cells at column 1, row 1"));
    EXPECT_TRUE(test::has(refused(target, lands::patch_of(nothing, middle)), "no cell of the target would change"));
    params.keep = middle;
    EXPECT_TRUE(test::has(refused(target, lands::patch_of(land, middle), params), "no cell"));
    Raster<float> endless = target;
    endless[{0, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(test::has(refused(endless, lands::patch_of(land, middle)), "column 0, row 1 is infinite"));
    EXPECT_TRUE(test::has(refused(target, lands::patch_of(endless, Mask(grid, 1))), "column 0, row 1 is infinite"));
    Grid const one = test::frame(1, 1);
    EXPECT_TRUE(
        test::has(refused(Raster<float>(one), lands::patch_of(Raster<float>(one), Mask(one, 1))), "all 1 x 1 cells"));
}

TEST(Paste, EqualsTheDenseOracle) {
    ASSERT_TRUE(rc::check("heights; refused where the oracle's matrix is singular", [] {
        Drawn const d = drawn();
        auto const truth = oracle::paste({d.target, d.patch, d.params});
        std::int64_t changing = 0;
        for (std::int64_t i = 0; i < d.target.cells(); ++i) {
            changing += oracle::Problem{d.target, d.patch, d.params}.changes(d.target.grid().at(i)) ? 1 : 0;
        }
        if (!truth || changing == 0) {
            RC_ASSERT_THROWS_AS(paste(d.target, d.patch, d.params), BadInput);
            return;
        }
        PastedDem const pasted = paste(d.target, d.patch, d.params);
        RC_ASSERT(pasted.cells == changing);
        for (std::int64_t i = 0; i < d.target.cells(); ++i) {
            if (std::isnan((*truth)[i])) {
                RC_ASSERT(std::isnan(pasted.dem[i]));
            } else {
                RC_ASSERT(std::fabs(pasted.dem[i] - (*truth)[i]) <= 1e-7 * (100.0 + std::fabs((*truth)[i])));
            }
        }
    }));
}

TEST(Paste, OutsideTheMaskAndInKeptCellsNothingChanges) {
    ASSERT_TRUE(rc::check("bit for bit", [] {
        Drawn const d = drawn();
        PastedDem pasted;
        try {
            pasted = paste(d.target, d.patch, d.params);
        } catch (BadInput const&) {
            RC_DISCARD("nothing to paste");
        }
        std::int64_t kept = 0;
        std::int64_t holes = 0;
        for (std::int64_t i = 0; i < d.target.cells(); ++i) {
            bool const keep = d.params.keep.cells() > 0 && d.params.keep[i] != 0;
            kept += d.patch.mask[i] != 0 && keep ? 1 : 0;
            holes += d.patch.mask[i] != 0 && std::isnan(d.patch.z[i]) ? 1 : 0;
            bool const left = std::isnan(d.patch.z[i]) && d.params.holes == Holes::leave;
            if (d.patch.mask[i] == 0 || keep || left) {
                RC_ASSERT(lands::same(pasted.dem[i], d.target[i]));
            } else {
                RC_ASSERT(std::isfinite(pasted.dem[i]));
            }
        }
        RC_ASSERT(pasted.kept == kept);
        RC_ASSERT(pasted.holes == holes);
    }));
}

TEST(Paste, ThePatchThatIsTheTargetGivesTheTarget) {
    ASSERT_TRUE(rc::check("bit for bit, at any level", [] {
        Drawn d = drawn();
        double const lift = *rc::gen::element(0.0, 1.0, -4096.0, 0.125).as("lift");
        // Multiples of 1/1024: with a lift the patch's differences are the target's still.
        for (float& z : d.target.values()) {
            z = std::floor(z * 1024.0F) / 1024.0F;
        }
        d.patch = lands::patch_of(d.target, d.patch.mask, lift);
        d.params.holes = Holes::leave; // into a hole of both, land would be made
        PastedDem pasted;
        try {
            pasted = paste(d.target, d.patch, d.params);
        } catch (BadInput const&) {
            RC_DISCARD("nothing to paste");
        }
        for (std::int64_t i = 0; i < d.target.cells(); ++i) {
            RC_ASSERT(lands::same(pasted.dem[i], d.target[i]) ||
                      (lift != 0.0 && std::fabs(pasted.dem[i] - d.target[i]) <= 1e-10));
        }
        RC_ASSERT(pasted.seam_max_m <= 1e-10);
        RC_ASSERT(pasted.seam_rms_m <= 1e-10);
    }));
}

TEST(Paste, TheSeamIsWhatTheDefinitionSays) {
    Grid const grid = test::frame(12, 9);
    Raster<float> const target = lands::by_chance(grid, 3);
    Patch const patch = lands::patch_of(lands::by_chance(grid, 4), lands::block(grid, {3, 0}, {8, 5}));
    auto const truth = *oracle::paste({target, patch, tight()});
    PastedDem const pasted = paste(target, patch, tight());
    double greatest = 0.0;
    double squares = 0.0;
    int pairs = 0;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        for (Cell const n : oracle::around(grid, grid.at(i))) {
            if (patch.mask[i] != 0 && patch.mask[n] == 0) {
                double const jump =
                    std::fabs(truth[i] - truth[n]) - std::fabs(static_cast<double>(target[i]) - target[n]);
                greatest = std::max(greatest, jump);
                squares += jump * jump;
                ++pairs;
            }
        }
    }
    EXPECT_NEAR(pasted.seam_max_m, greatest, 1e-8);
    EXPECT_NEAR(pasted.seam_rms_m, std::sqrt(squares / pairs), 1e-8);
}

TEST(Paste, TheSameBitsOnAnyNumberOfThreads) {
    Grid const grid = test::frame(70, 50);
    Raster<float> const target = lands::by_chance(grid, 8, 0.02);
    Patch const patch = lands::patch_of(lands::by_chance(grid, 9, 0.02), lands::block(grid, {4, 6}, {60, 49}));
    PasteParams params;
    params.relief = Relief::mixed;
    params.feather_cells = 3.0;
    Raster<float> const a = paste(target, patch, params, on_threads(1)).dem;
    Raster<float> const b = paste(target, patch, params, on_threads(4)).dem;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        ASSERT_TRUE(lands::same(a[i], b[i]));
    }
}

TEST(PlacePatch, RefusesWhatCannotBePlaced) {
    Grid const grid = test::frame(6, 5, 10.0);
    Raster<float> const source = lands::by_chance(grid, 1);
    double const inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(place_patch(source, grid, {.rotate_deg = std::nan("")}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.rotate_deg = 361.0}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.scale = 0.0}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.scale = inf}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.gain = inf}), BadParameter);
    EXPECT_THROW(place_patch(source, grid, {.at = Vec2{inf, 0.0}}), BadParameter);
    for (SourceWindow const& w :
         {SourceWindow{0, 0, 7, 5}, SourceWindow{-1, 0, 3, 3}, SourceWindow{4, 0, 3, 3}, SourceWindow{0, 3, 3, 3},
          SourceWindow{0, 0, 0, 3}, SourceWindow{std::numeric_limits<std::int64_t>::max(), 0, 2, 2}}) {
        EXPECT_TRUE(test::has(refused(source, grid, {.window = w}), "of a source of 6 x 5 cells"));
    }
    EXPECT_TRUE(test::has(refused(Raster<float>{}, grid, {}), "a window of 0 x 0"));
    EXPECT_TRUE(test::has(refused(source, grid, {.part = Mask(test::frame(5, 6, 10.0), 1)}), "they share a grid"));
    EXPECT_EQ(refused(source, grid, {.part = Mask(grid)}), "blend.place_patch: the mask holds no cell of the target");
    EXPECT_TRUE(test::has(refused(source, grid, {.at = Vec2{500.0, 25.0}}), "(470.000, 50.000)"));
    EXPECT_TRUE(test::has(refused(source, grid, {.at = Vec2{1e300, -1e300}}), "covers no cell"));
    EXPECT_TRUE(test::has(refused(source, Grid{}, {}), "covers no cell"));
    // A source of one cell has no neighbours.
    EXPECT_TRUE(
        test::has(refused(lands::by_chance(test::frame(1, 1, 10.0), 1), grid, {.at = Vec2{35.0, 25.0}}), "1 x 1"));
    Grid const one = test::frame(1, 1, 10.0);
    Patch const alone = place_patch(lands::by_chance(one, 1), one);
    EXPECT_EQ(alone.mask[0], 1); // all its neighbours there are
}

TEST(PlacePatch, WholeStepsTakeHeightsAsTheyStand) {
    ASSERT_TRUE(rc::check("shifted by cells, in coordinates of millions", [] {
        double const cell_m = *rc::gen::element(1.0, 30.0, 0.1, 29.7).as("cell");
        Grid target = test::frame(14, 11, cell_m);
        target.west = *rc::gen::element(0.0, 500000.3).as("west");
        target.north = *rc::gen::element(0.0, 4649776.22).as("north");
        auto const dx = *rc::gen::inRange<std::int64_t>(-8, 12).as("columns");
        auto const dy = *rc::gen::inRange<std::int64_t>(-8, 12).as("rows");
        Grid frame = target;
        frame.width = 7;
        frame.height = 6;
        frame.west += static_cast<double>(dx) * cell_m;
        frame.north -= static_cast<double>(dy) * cell_m;
        Raster<float> const source = lands::by_chance(frame, *rc::gen::inRange<std::uint64_t>(0, 1000).as("seed"), 0.1);
        Mask const beyond = beyond_outline(source);
        double const gain = *rc::gen::element(1.0, -2.0).as("gain");
        Mask covered(target);
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            Cell const c = target.at(i);
            auto const there = [&](std::int64_t x, std::int64_t y) {
                Cell const n{c.col + x, c.row + y};
                Cell const from{n.col - dx, n.row - dy};
                return !target.contains(n) || (frame.contains(from) && beyond[from] == 0);
            };
            covered[i] = there(0, 0) && there(1, 0) && there(-1, 0) && there(0, 1) && there(0, -1) ? 1 : 0;
        }
        if (count(covered) == 0) {
            RC_ASSERT_THROWS_AS(place_patch(source, target, {.gain = gain}), BadInput);
            return;
        }
        Patch const patch = place_patch(source, target, {.gain = gain});
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            Cell const own{target.at(i).col - dx, target.at(i).row - dy};
            RC_ASSERT(patch.mask[i] == covered[i]);
            if (frame.contains(own) && !std::isnan(source[own])) {
                RC_ASSERT(patch.z[i] == gain * static_cast<double>(source[own]));
            } else {
                RC_ASSERT(std::isnan(patch.z[i]));
            }
        }
    }));
}

TEST(PlacePatch, QuarterTurnsMoveCells) {
    Grid const grid = test::frame(9, 9, 30.0);
    Raster<float> const source = lands::by_chance(grid, 3);
    Patch const quarter = place_patch(source, grid, {.rotate_deg = 90.0});
    Patch const half = place_patch(source, grid, {.rotate_deg = -180.0});
    Patch const whole = place_patch(source, grid, {.rotate_deg = 360.0});
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        // What lay in the east lies in the north.
        ASSERT_EQ(quarter.z[i], (source[{8 - c.row, c.col}]));
        ASSERT_EQ(half.z[i], (source[{8 - c.col, 8 - c.row}]));
        ASSERT_EQ(whole.z[i], source[i]);
        ASSERT_EQ(quarter.mask[i], 1);
    }
}

TEST(PlacePatch, APlaneStaysAPlane) {
    ASSERT_TRUE(rc::check("moved, turned and scaled as the formula says", [] {
        Grid const frame{30, 25, 10.0, 1000.0, 2000.0, ""};
        Raster<float> source(frame);
        for (std::int64_t i = 0; i < source.cells(); ++i) {
            Vec2 const p = frame.centre(frame.at(i));
            source[i] = static_cast<float>(0.5 * p.x - 0.25 * p.y);
        }
        Grid const target{40, 40, *rc::gen::element(4.0, 10.0, 17.0).as("cell"), -300.0, 300.0, ""};
        double const angle = *rc::gen::inRange(-360, 361).as("degrees");
        double const scale = *rc::gen::element(0.5, 1.0, 2.3).as("scale");
        Vec2 const at{-300.0 + 20.0 * target.cell_m + 1.7, 300.0 - 20.0 * target.cell_m - 3.3};
        Patch const patch = place_patch(source, target, {.at = at, .rotate_deg = angle, .scale = scale, .gain = 3.0});
        std::int64_t covered = 0;
        for (std::int64_t i = 0; i < target.cells(); ++i) {
            if (std::isnan(patch.z[i])) {
                continue;
            }
            ++covered;
            Vec2 const p = target.centre(target.at(i));
            double const turn = -angle * 3.14159265358979323846 / 180.0;
            double const x = 1150.0 + (std::cos(turn) * (p.x - at.x) - std::sin(turn) * (p.y - at.y)) / scale;
            double const y = 1875.0 + (std::sin(turn) * (p.x - at.x) + std::cos(turn) * (p.y - at.y)) / scale;
            RC_ASSERT(std::fabs(patch.z[i] - 3.0 * (0.5 * x - 0.25 * y)) <= 1e-3);
        }
        double const area = 290.0 * 240.0 * scale * scale / (target.cell_m * target.cell_m);
        RC_ASSERT((covered > 20 && static_cast<double>(covered) < 1.2 * area + 50.0));
    }));
}

TEST(PlacePatch, BetweenCentresNextToNoDataNothingIsKnown) {
    Grid const frame = test::frame(4, 3);
    Raster<float> source = lands::by_chance(frame, 2);
    source[{2, 1}] = lands::nan;
    Grid target = frame;
    target.west += 0.25;
    Patch const patch = place_patch(source, target);
    for (std::int64_t i = 0; i < target.cells(); ++i) {
        Cell const c = target.at(i);
        bool const known = c.col < 3 && !(c.row == 1 && (c.col == 1 || c.col == 2));
        ASSERT_EQ(std::isnan(patch.z[i]), !known) << c.col << " " << c.row;
        if (known) {
            double const z = source[i];
            ASSERT_EQ(patch.z[i], z + 0.25 * (static_cast<double>(source[i + 1]) - z));
        }
        ASSERT_EQ(patch.mask[i], c.col < 2 ? 1 : 0); // a hole is part of the mask, the lattice's edge is not
    }
}

TEST(PlacePatch, WindowAndPartSayWhatIsCovered) {
    Grid const grid = test::frame(20, 16, 30.0);
    Raster<float> const source = lands::by_chance(grid, 4);
    Patch const patch = place_patch(source, grid, {.window = SourceWindow{3, 2, 5, 4}});
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        ASSERT_EQ(patch.mask[i], c.col >= 3 && c.col < 8 && c.row >= 2 && c.row < 6 ? 1 : 0);
        if (c.col >= 2 && c.col <= 8 && c.row >= 1 && c.row <= 6) {
            ASSERT_EQ(patch.z[i], source[i]); // beside the window there is land too
        }
    }
    // Its centre comes to lie where it is asked for.
    Patch const moved = place_patch(
        source, grid, {.at = Vec2{30.0 * 12.5, grid.north - 30.0 * 8.0}, .window = SourceWindow{3, 2, 5, 4}});
    EXPECT_EQ(count(moved.mask), 20);
    EXPECT_EQ((moved.z[{10, 6}]), (source[{3, 2}]));
    EXPECT_EQ((moved.mask[{10, 6}]), 1);
    EXPECT_EQ((moved.mask[{14, 9}]), 1);
    Patch const part =
        place_patch(source, grid, {.window = SourceWindow{3, 2, 5, 4}, .part = lands::block(grid, {6, 0}, {9, 3})});
    EXPECT_EQ(count(part.mask), 4);
    EXPECT_EQ(part.outside, 12);
}

TEST(PlacePatch, TheSameBitsOnAnyNumberOfThreads) {
    Raster<float> const source = lands::by_chance(test::frame(60, 50, 3.0), 4);
    Grid const target = test::frame(90, 80, 2.0);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const four = on_threads(4);
    PlacePatchParams const params{.rotate_deg = 33.0};
    Patch const a = place_patch(source, target, params, one);
    Patch const b = place_patch(source, target, params, four);
    for (std::int64_t i = 0; i < target.cells(); ++i) {
        ASSERT_TRUE(a.z[i] == b.z[i] || (std::isnan(a.z[i]) && std::isnan(b.z[i])));
        ASSERT_EQ(a.mask[i], b.mask[i]);
    }
}

} // namespace paste_test
