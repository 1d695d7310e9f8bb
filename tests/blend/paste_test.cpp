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
    EXPECT_EQ(refused(target, lands::patch_of(land, Mask(grid, 1))),
              "blend.paste: all 5 x 4 cells of the target would change: leave at least one that keeps its height");
    Raster<float> const nothing(grid, lands::nan);
    EXPECT_EQ(refused(nothing, lands::patch_of(land, middle)),
              "blend.paste: the part of 6 cells at column 1, row 1 (45.000, 75.000) has no neighbour with a height to "
              "join: take a part that reaches one");
    EXPECT_NE(refused(target, lands::patch_of(nothing, middle)).find("no cell of the target would change"),
              std::string::npos);
    params.keep = middle;
    EXPECT_NE(refused(target, lands::patch_of(land, middle), params).find("no cell"), std::string::npos);
    Raster<float> endless = target;
    endless[{0, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_NE(refused(endless, lands::patch_of(land, middle)).find("column 0, row 1 is infinite"), std::string::npos);
    EXPECT_NE(refused(target, lands::patch_of(endless, Mask(grid, 1))).find("column 0, row 1 is infinite"),
              std::string::npos);
    Grid const one = test::frame(1, 1);
    EXPECT_NE(refused(Raster<float>(one), lands::patch_of(Raster<float>(one), Mask(one, 1))).find("all 1 x 1 cells"),
              std::string::npos);
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
        Pasted const pasted = paste(d.target, d.patch, d.params);
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
        Pasted pasted;
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
        Pasted pasted;
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

TEST(Paste, EdgesOfTheTargetLetNothingThrough) {
    // One row: the patch hangs on its west end only and keeps its own steps.
    Grid const grid = test::frame(5, 1);
    Raster<float> target(grid, 7.0F);
    Raster<float> land(grid);
    for (std::int64_t i = 0; i < 5; ++i) {
        land[i] = static_cast<float>(100 + 3 * i * i);
    }
    Pasted const pasted = paste(target, lands::patch_of(land, lands::block(grid, {1, 0}, {4, 0})), tight());
    for (std::int64_t i = 0; i < 5; ++i) {
        EXPECT_FLOAT_EQ(pasted.dem[i], static_cast<float>(7 + 3 * i * i));
    }
    EXPECT_EQ(pasted.cells, 4);
    EXPECT_NEAR(pasted.seam_max_m, 3.0, 1e-9); // the patch rises by 3 there, the target not at all
    EXPECT_NEAR(pasted.seam_rms_m, 3.0, 1e-9);
}

TEST(Paste, TheSeamIsWhatTheDefinitionSays) {
    Grid const grid = test::frame(12, 9);
    Raster<float> const target = lands::by_chance(grid, 3);
    Patch const patch = lands::patch_of(lands::by_chance(grid, 4), lands::block(grid, {3, 0}, {8, 5}));
    auto const truth = *oracle::paste({target, patch, tight()});
    Pasted const pasted = paste(target, patch, tight());
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

TEST(Paste, FeatherGivesTheEdgeTheTargetsRelief) {
    Grid const grid = test::frame(40, 40);
    Raster<float> const target(grid, 50.0F);
    Patch const patch = lands::patch_of(lands::by_chance(grid, 6), lands::block(grid, {5, 5}, {34, 34}));
    double before = std::numeric_limits<double>::infinity();
    for (double const feather : {0.0, 2.0, 6.0}) {
        PasteParams params;
        params.feather_cells = feather;
        double const seam = paste(target, patch, params).seam_rms_m;
        EXPECT_LT(seam, 0.5 * before);
        before = seam;
    }
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

TEST(Paste, Golden) {
    Grid const grid = test::frame(4, 3);
    Raster<float> target(grid, 0.0F);
    Raster<float> land(grid, 0.0F);
    land[{1, 1}] = 15.0F;
    land[{2, 1}] = 30.0F;
    // 4 f1 - f2 = 4 * 15 - 30, 4 f2 - f1 = 4 * 30 - 15.
    Pasted const pasted = paste(target, lands::patch_of(land, lands::block(grid, {1, 1}, {2, 1}), -900.0), tight());
    EXPECT_FLOAT_EQ((pasted.dem[{1, 1}]), 15.0F);
    EXPECT_FLOAT_EQ((pasted.dem[{2, 1}]), 30.0F);
    target[{0, 1}] = 15.0F; // lifts what it touches by 4, and that its other neighbour by 1
    Pasted const lifted = paste(target, lands::patch_of(land, lands::block(grid, {1, 1}, {2, 1}), 33.0), tight());
    EXPECT_FLOAT_EQ((lifted.dem[{1, 1}]), 19.0F);
    EXPECT_FLOAT_EQ((lifted.dem[{2, 1}]), 31.0F);
}

} // namespace paste_test
