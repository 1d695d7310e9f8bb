// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/layers.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace layers_test {

namespace {

using namespace thalweg;
using surface::climb_through;
using surface::equilibrium;
using surface::EquilibriumFields;
using surface::EquilibriumParams;
using surface::EquilibriumTerrain;
using surface::height_in_layers;
using surface::LandBalance;
using surface::LevelLayer;
using surface::RockLayer;
using surface::Strata;

using test::has;
using test::message_of;
using test::on_threads;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Layers whose tops are some units apart.
std::vector<LevelLayer> stack(std::vector<double> const& tops, std::vector<double> const& strengths, double cap = 5.0) {
    std::vector<LevelLayer> out;
    for (std::size_t k = 0; k < strengths.size(); ++k) {
        out.push_back({k < tops.size() ? tops[k] : infinity, strengths[k], strengths[k], cap});
    }
    return out;
}

/// What climb_through() is the limit of: many short steps, each at the slope of the layer in which it begins. Where the
/// layers on both sides of a contact lead back to it, these steps go to and fro across it.
double by_short_steps(std::vector<LevelLayer> const& layers, double s, double bed_rise,
                      std::vector<double> const& rises) {
    constexpr int steps = 200'000;
    for (int step = 0; step < steps; ++step) {
        std::size_t k = 0;
        while (s >= layers[k].top) {
            ++k;
        }
        s += (rises[k] - bed_rise) / steps;
    }
    return s;
}

/// The height above a receiver by bisection: where uplift and creep are as much as is cut.
double by_bisection(std::vector<LevelLayer> const& layers, LandBalance const& balance, double below, double bed_below,
                    double bed) {
    auto const above = [&](double z) {
        return bed + climb_through(layers, below - bed_below, bed - bed_below, [&](std::size_t k) {
                   double const tangent = layers[k].strength * (balance.force - balance.creep * z) / balance.power;
                   return balance.length * std::max(std::min(tangent, layers[k].cap * balance.cap), balance.least);
               });
    };
    double low = below;
    double high = below + 1000.0;
    for (int k = 0; k < 200; ++k) {
        double const middle = 0.5 * (low + high);
        (above(middle) > middle ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

constexpr std::int64_t side = 192;
constexpr double cell_m = 20.0;

/// A river along the middle row of a square to its western border, and one from the north into it.
Channels two_rivers() {
    Channels rivers;
    rivers.grid = {side, side, cell_m, 0.0, 0.0, ""};
    for (std::int64_t col = 0; col < side * 9 / 10; ++col) {
        rivers.receiver.push_back(static_cast<std::int64_t>(rivers.cell.size()) - 1);
        rivers.cell.push_back(side / 2 * side + col);
    }
    std::int64_t below = side / 3;
    for (std::int64_t row = side / 2 - 1; row > side / 8; --row) {
        rivers.receiver.push_back(below);
        below = static_cast<std::int64_t>(rivers.cell.size());
        rivers.cell.push_back(row * side + side / 3);
    }
    return rivers;
}

struct Land {
    EquilibriumTerrain terrain;
    surface::Bed bed;
    std::vector<double> tops;

    double z(Cell c) const { return static_cast<double>(terrain.dem[c]); }
    /// [m] above the bed.
    double place(Cell c) const {
        double const east = (static_cast<double>(c.col) + 0.5 - 0.5 * static_cast<double>(side)) * cell_m;
        double const north = (0.5 * static_cast<double>(side) - static_cast<double>(c.row) - 0.5) * cell_m;
        return z(c) - (bed.height_m(east, north) - terrain.strata_shift_m);
    }
    double slope_deg(Cell c) const {
        double const east = z({c.col + 1, c.row}) - z({c.col - 1, c.row});
        double const south = z({c.col, c.row + 1}) - z({c.col, c.row - 1});
        return std::atan(std::hypot(east, south) / (2.0 * cell_m)) * 180.0 / M_PI;
    }
};

std::vector<double> tops_of(Strata const& strata) {
    std::vector<double> tops;
    for (surface::StackedLayer const& stacked : surface::stack_of(strata, -5000.0, 5000.0)) {
        tops.push_back(stacked.top_m);
    }
    tops.pop_back();
    return tops;
}

Land land_of(Strata const& strata, EquilibriumParams const& params, Run const& run = {}) {
    EquilibriumFields fields;
    fields.strata = strata;
    return {equilibrium(two_rivers(), fields, params, run), surface::Bed(strata), tops_of(strata)};
}

/// Calls visit(cell) for cells that have neighbours two steps away on all sides.
template <class Visit> void each_inside(Visit visit) {
    for (std::int64_t row = 2; row + 2 < side; ++row) {
        for (std::int64_t col = 2; col + 2 < side; ++col) {
            visit(Cell{col, row});
        }
    }
}

Strata canyon() {
    Strata strata;
    strata.layers = {{90.0, 0.5, 0.5}, {60.0, 8.0, 5.0}, {90.0, 0.35, 0.5}, {70.0, 8.0, 5.0}, {100.0, 0.05, 0.15}};
    strata.undulation_m = 15.0;
    return strata;
}

/// Soft and firm layers in turn, so thick that some firm ones crop out.
Strata tilted(double dip_deg, double soft = 0.2) {
    double const s = std::sin(dip_deg * M_PI / 180.0);
    double const c = std::cos(dip_deg * M_PI / 180.0);
    Strata strata;
    strata.layers = {{(700.0 * s + 60.0) * c, soft, 0.4}, {(100.0 * s + 25.0) * c, 10.0, 5.0}};
    strata.repeats = true;
    strata.dip_deg = dip_deg;
    strata.strike_deg = 20.0;
    return strata;
}

} // namespace

TEST(ClimbThrough, GoesOnInTheNextLayerAtItsSlope) {
    auto const layers = stack({10.0, 14.0}, {1.0, 1.0, 1.0});
    std::vector<double> const rises{8.0, 40.0, 1.0};
    auto const from = [&](double s) { return climb_through(layers, s, 0.0, [&](std::size_t k) { return rises[k]; }); };
    EXPECT_DOUBLE_EQ(from(0.0), 8.0);
    EXPECT_DOUBLE_EQ(from(6.0), 14.0 + 1.0 * (1.0 - 0.5 - 0.1)); // half of the way below, a tenth on the cliff
    EXPECT_DOUBLE_EQ(from(20.0), 21.0);
}

TEST(ClimbThrough, FollowsAContactThatItWouldLeaveOnNeitherSide) {
    auto const layers = stack({10.0}, {1.0, 1.0});
    std::vector<double> const rises{30.0, 2.0};
    auto const from = [&](double s, double bed_rise) {
        return climb_through(layers, s, bed_rise, [&](std::size_t k) { return rises[k]; });
    };
    EXPECT_EQ(from(10.0, 5.0), 10.0);
    EXPECT_EQ(from(10.00000001, 5.0), 10.0); // as floats have it
    EXPECT_EQ(from(9.0, 5.0), 10.0);
    EXPECT_EQ(from(11.0, 5.0), 10.0);
    EXPECT_EQ(from(16.0, 5.0), 13.0);
}

TEST(ClimbThrough, IsWhatShortStepsComeTo) {
    EXPECT_TRUE(rc::check("many short steps", [] {
        auto const count = *rc::gen::inRange<std::size_t>(1, 6).as("layers");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const number = [&](std::uint64_t what, std::uint64_t n) { return unit(random_word(seed, what, n)); };
        std::vector<double> tops;
        std::vector<double> rises;
        for (std::size_t k = 0; k < count; ++k) {
            tops.push_back((tops.empty() ? 0.0 : tops.back()) + 0.5 + 4.0 * number(1, k));
            rises.push_back(std::exp(6.0 * number(2, k) - 4.0));
        }
        tops.pop_back();
        auto const layers = stack(tops, std::vector<double>(count, 1.0));
        double const s = 12.0 * number(3, 0) - 3.0;
        double const bed_rise = 6.0 * number(4, 0) - 3.0;
        double const z = climb_through(layers, s, bed_rise, [&](std::size_t k) { return rises[k]; });
        RC_ASSERT(std::fabs(z - by_short_steps(layers, s, bed_rise, rises)) < 0.001);
    }));
}

// One layer of strength 1 is rock without layers, where the balance has a closed form.
TEST(HeightInLayers, OfOneLayerHasAClosedForm) {
    LandBalance const balance{.force = 9.0, .creep = 0.7, .power = 6.0, .length = 1.4, .least = 0.002, .cap = 0.5};
    double const cutting = balance.power / balance.length;
    double const z = (balance.force + cutting * 3.0) / (cutting + balance.creep);
    EXPECT_DOUBLE_EQ(height_in_layers(stack({}, {1.0}), balance, 3.0, 1.0, 2.0), z);
    EXPECT_DOUBLE_EQ(height_in_layers(stack({}, {1.0}, 0.5), balance, 3.0, 1.0, 2.0), 3.0 + 0.25 * 1.4);
    EXPECT_DOUBLE_EQ(height_in_layers(stack({}, {1e-9}), balance, 3.0, 1.0, 2.0), 3.0 + 0.002 * 1.4);
}

TEST(HeightInLayers, BalancesWhatEachLayerCuts) {
    EXPECT_TRUE(rc::check("bisection", [] {
        auto const count = *rc::gen::inRange<std::size_t>(1, 6).as("layers");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        auto const number = [&](std::uint64_t what, std::uint64_t n) { return unit(random_word(seed, what, n)); };
        std::vector<double> tops;
        std::vector<double> strengths;
        for (std::size_t k = 0; k < count; ++k) {
            tops.push_back((tops.empty() ? 0.0 : tops.back()) + 0.3 + 2.0 * number(1, k));
            strengths.push_back(std::exp(6.0 * number(2, k) - 3.0));
        }
        tops.pop_back();
        LandBalance const balance{.force = 6.0 * number(3, 0),
                                  .creep = *rc::gen::element(0.0, 0.05, 1.0).as("creep"),
                                  .power = 1.0 + 9.0 * number(4, 0),
                                  .length = 1.0 + number(5, 0),
                                  .least = 0.002,
                                  .cap = 0.2 + number(6, 0)};
        auto const layers = stack(tops, strengths);
        double const below = 8.0 * number(7, 0);
        double const bed_below = 3.0 * number(8, 0);
        double const bed = bed_below + 2.0 * number(9, 0) - 1.0;
        double const z = height_in_layers(layers, balance, below, bed_below, bed);
        double const exact = by_bisection(layers, balance, below, bed_below, bed);
        RC_LOG() << z << " for " << exact;
        RC_ASSERT(std::fabs(z - exact) < 0.02 * (exact - below) + 1e-4);
        RC_ASSERT(z >= below + balance.least * balance.length - 1e-12);
    }));
}

TEST(Strata, TheBedIsTiltedToTheRightOfTheStrike) {
    Strata strata;
    strata.layers = {{100.0, 1.0, 1.0}, {50.0, 1.0, 1.0}, {}};
    strata.base_m = 7.0;
    strata.dip_deg = 60.0;
    surface::Bed const north(strata);
    double const tangent = std::sqrt(3.0);
    EXPECT_NEAR(north.height_m(0.0, 0.0), 7.0, 1e-12);
    EXPECT_NEAR(north.height_m(100.0, 0.0), 7.0 - 100.0 * tangent, 1e-9); // dips to the east
    EXPECT_NEAR(north.height_m(0.0, 100.0), 7.0, 1e-9);
    strata.strike_deg = 90.0;
    EXPECT_NEAR(surface::Bed(strata).height_m(0.0, 100.0), 7.0 + 100.0 * tangent, 1e-9); // to the south
    auto const stack = surface::stack_of(strata, 0.0, 0.0);
    ASSERT_EQ(stack.size(), 3U);
    EXPECT_NEAR(stack[0].top_m, 200.0, 1e-9); // 100 m across the layer
    EXPECT_NEAR(stack[1].top_m, 300.0, 1e-9);
    EXPECT_EQ(stack[2].top_m, infinity);
}

TEST(Strata, AStackRepeatsAsFarAsThereIsLand) {
    Strata strata;
    strata.layers = {{100.0, 1.0, 1.0}, {50.0, 1.0, 1.0}};
    strata.repeats = true;
    auto const stack = surface::stack_of(strata, -160.0, 290.0);
    ASSERT_EQ(stack.size(), 8U); // from -300 to 300 m
    EXPECT_EQ(stack[0].top_m, -200.0);
    EXPECT_EQ(stack[3].top_m, 0.0);
    EXPECT_EQ(stack[3].layer, 1U);
    EXPECT_EQ(stack[7].top_m, infinity);
    EXPECT_TRUE(has(message_of<BadInput>([&] { surface::stack_of(strata, -1e9, 1e9); }), "make them thicker"));
}

TEST(Strata, DomesFaultsAndFoldsMoveTheBed) {
    Strata strata;
    strata.layers = {{}, {}};
    strata.domes = {{.east_m = 100.0, .north_m = 0.0, .height_m = 80.0, .radius_m = 500.0}};
    EXPECT_NEAR(surface::Bed(strata).height_m(100.0, 0.0), 80.0, 1e-9);
    EXPECT_NEAR(surface::Bed(strata).height_m(600.0, 0.0), 80.0 * std::exp(-0.5), 1e-9);
    strata.domes.clear();
    strata.faults = {{.east_m = 0.0, .north_m = 50.0, .strike_deg = 90.0, .throw_m = 30.0}};
    EXPECT_EQ(surface::Bed(strata).height_m(0.0, 60.0), 0.0);
    EXPECT_EQ(surface::Bed(strata).height_m(0.0, 40.0), -30.0); // to the right of the way east
    strata.faults.clear();
    strata.folds = {.amplitude_m = 200.0, .wavelength_m = 3000.0, .axis_deg = 0.0, .plunge_deg = 0.0};
    surface::Bed const folded(strata);
    double high = -infinity;
    double low = infinity;
    for (double east = -3000.0; east < 3000.0; east += 10.0) {
        high = std::max(high, folded.height_m(east, 0.0));
        low = std::min(low, folded.height_m(east, 0.0));
    }
    EXPECT_NEAR(high, 200.0, 0.1);
    EXPECT_NEAR(low, -200.0, 0.1);
}

TEST(EquilibriumInLayers, CliffsEndAtTheTopsOfFirmLayers) {
    EquilibriumParams params;
    params.relief_m = 450.0;
    Land const land = land_of(canyon(), params);
    double tops = 0.0;
    double near = 0.0;
    each_inside([&](Cell c) {
        // the last steep step of a climb
        auto const slope_of = [&](Cell at) { return flow::steepest_descent(land.terrain.dem, at).slope / cell_m; };
        Grid const& grid = land.terrain.dem.grid();
        double const slope = slope_of(c);
        double above = 0.0;
        for (Cell const step : d8_steps) {
            Cell const n{c.col + step.col, c.row + step.row};
            bool const drains_here = flow::receiver(land.terrain.direction, grid.index(n)) == grid.index(c);
            above = drains_here ? std::max(above, slope_of(n)) : above;
        }
        if (slope > 0.7 && above < 0.35 && above > 0.0) {
            double off = infinity;
            for (std::size_t k = 1; k < land.tops.size(); k += 2) {
                double const thickness = land.tops[k] - land.tops[k - 1];
                off = std::min(off, std::fabs(land.place(c) - land.tops[k]) / thickness);
            }
            tops += 1.0;
            near += off <= 0.1 ? 1.0 : 0.0;
        }
    });
    EXPECT_GT(tops, 100.0);
    EXPECT_GE(near, 0.95 * tops) << tops;
}

TEST(EquilibriumInLayers, DipSlopesHaveTheDip) {
    for (double const dip : {15.0, 25.0, 40.0}) {
        EquilibriumParams params;
        params.relief_m = 400.0;
        Land const land = land_of(tilted(dip), params);
        double stripped = 0.0;
        double at_dip = 0.0;
        each_inside([&](Cell c) {
            bool on_top = false;
            for (std::size_t k = 1; k < land.tops.size(); k += 2) {
                on_top = on_top || std::fabs(land.place(c) - land.tops[k]) < 1.0;
            }
            for (Cell const step : {Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                on_top = on_top && std::fabs(land.place({c.col + step.col, c.row + step.row}) - land.place(c)) < 2.0;
            }
            if (on_top) {
                stripped += 1.0;
                at_dip += std::fabs(land.slope_deg(c) - dip) < 2.0 ? 1.0 : 0.0;
            }
        });
        EXPECT_GT(stripped, 0.015 * static_cast<double>(side * side)) << dip;
        EXPECT_GE(at_dip, 0.95 * stripped) << dip << ": " << stripped;
    }
}

TEST(Strata, LayersAtTheSurfaceAreCountedFromTheLowest) {
    Strata strata;
    strata.layers = {{100.0, 1.0, 1.0}, {50.0, 1.0, 1.0}, {30.0, 1.0, 1.0}};
    strata.base_m = 10.0;
    Raster<float> dem({5, 1, 20.0, 0.0, 0.0, ""});
    std::vector<float> const heights{-40.0F, 111.0F, 160.0F, 900.0F, std::numeric_limits<float>::quiet_NaN()};
    std::copy(heights.begin(), heights.end(), dem.values().begin());
    auto const codes = [&](double shift_m) {
        Raster<std::uint8_t> const layers =
            surface::layers_at(dem, surface::bed_heights(dem.grid(), strata, shift_m), strata);
        return std::vector<int>(layers.values().begin(), layers.values().end());
    };
    EXPECT_EQ(codes(0.0), (std::vector<int>{1, 2, 2, 3, 0})); // 160 m is the bare top of the second
    EXPECT_EQ(codes(1.0), (std::vector<int>{1, 2, 3, 3, 0}));
    strata.repeats = true;
    EXPECT_EQ(codes(0.0), (std::vector<int>{2, 2, 2, 3, 0})); // 890 m: four times 180, and 170
}

// The cap rock is the upper of two firm layers; a tenth and two thirds of the land reach its bottom.
TEST(EquilibriumInLayers, ReachTheCapRockAsAsked) {
    for (double const share : {0.1, 0.4, 0.67}) {
        EquilibriumParams params;
        params.cap_share = share;
        Land const land = land_of(canyon(), params);
        EXPECT_NEAR(land.terrain.cap_share, share, 0.05);
        Raster<float> const bed = surface::bed_heights(land.terrain.dem.grid(), canyon(), land.terrain.strata_shift_m);
        std::int64_t reached = 0;
        for (std::int64_t i = 0; i < bed.cells(); ++i) {
            reached += land.terrain.dem[i] - bed[i] >= land.tops[2] ? 1 : 0;
        }
        EXPECT_NEAR(static_cast<double>(reached) / static_cast<double>(bed.cells()), land.terrain.cap_share, 1e-9);
    }
    EXPECT_EQ(surface::cap_rock(canyon()), 3U);
    Strata none = canyon();
    none.repeats = true;
    EXPECT_EQ(surface::cap_rock(none), std::nullopt);
    EquilibriumParams params;
    params.cap_share = 0.5;
    EXPECT_TRUE(has(message_of([&] { land_of(none, params); }), "cap rock"));
}

// Not every relief is met: it is the height of one cell and jumps by that of a cliff.
TEST(EquilibriumInLayers, HasTheReliefAsked) {
    EquilibriumParams params;
    for (double const relief : {300.0, 450.0}) {
        params.relief_m = relief;
        EXPECT_NEAR(land_of(canyon(), params).terrain.target_share, 1.0, 0.04) << relief;
    }
}

// A mean slope, or a greatest steepness of main stems, is that of rock without layers: a plateau has no such slope.
TEST(EquilibriumInLayers, WithoutAReliefHeightsHaveTheScaleOfRockWithoutLayers) {
    EquilibriumParams params;
    params.region = 1.0;
    params.mean_slope_deg = 20.0;
    EquilibriumTerrain const plain = equilibrium(two_rivers(), {}, params);
    EquilibriumTerrain const free = land_of(canyon(), params).terrain;
    EXPECT_NEAR(free.rise / plain.rise, 1.0, 0.25);
    EXPECT_FALSE(free.is_bounded);
    params.steepness = 0.5 * plain.steepness;
    EquilibriumTerrain const bounded = land_of(canyon(), params).terrain;
    EXPECT_TRUE(bounded.is_bounded);
    EXPECT_NEAR(bounded.rise / plain.rise, 0.5, 0.15);
    EXPECT_LT(bounded.target_share, 0.9);
}

TEST(EquilibriumInLayers, ThreadsDoNotMatter) {
    EquilibriumParams params;
    params.relief_m = 400.0;
    auto const bytes = [&](int threads) {
        Land const land = land_of(canyon(), params, on_threads(threads));
        std::vector<std::uint32_t> out;
        for (float const z : land.terrain.dem.values()) {
            out.push_back(std::bit_cast<std::uint32_t>(z));
        }
        return out;
    };
    auto const one = bytes(1);
    EXPECT_EQ(one, bytes(2));
    EXPECT_EQ(one, bytes(4));
}

TEST(EquilibriumInLayers, RefusesWhatItCannotDo) {
    Channels rivers = two_rivers();
    EquilibriumFields fields;
    fields.strata = canyon();
    EquilibriumParams params;
    auto const message = [&] { return message_of<BadInput>([&] { equilibrium(rivers, fields, params); }); };
    rivers.lake_z.assign(rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    rivers.lake_z[20] = 30.0F;
    EXPECT_TRUE(has(message(), "layers of rock cannot be combined with levels of lakes"));
    rivers.lake_z.clear();
    rivers.z.assign(rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    rivers.z[0] = 3.0F;
    params.heights = surface::RiverHeights::soft;
    EXPECT_TRUE(has(message(), "prescribed heights of rivers"));
    params.heights = surface::RiverHeights::graded;
    fields.features = {{0, 10.0F}};
    EXPECT_TRUE(has(message(), "known points and ridges"));
    fields.features.clear();
    fields.strata.layers[1].strength = -1.0;
    EXPECT_TRUE(has(message_of<BadParameter>([&] { equilibrium(rivers, fields, params); }), "layer 2 strength"));
}

} // namespace layers_test
