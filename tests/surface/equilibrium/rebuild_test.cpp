// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/rebuild.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>

#include "channel_trees.hpp"

namespace rebuild_test {

using namespace thalweg;
using surface::Edge;
using surface::rebuild;
using surface::RebuildParams;
using surface::RebuiltTerrain;

namespace {

using test::has;
using test::message_of;
using test::on_threads;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// A DEM that drains, and the rivers in it where so many cells drain.
struct Land {
    Raster<float> dem;
    Channels rivers;
};

Land land(std::int64_t side, std::int64_t support_cells, std::uint64_t seed) {
    Grid const grid = test::frame(side, side, 30.0);
    Channels const trunk = channel_trees::grown(grid, {side / 2}, {}, side, channel_trees::Room::apart, seed);
    surface::EquilibriumParams params;
    params.edge = Edge::closed;
    params.seed = seed;
    Land out{surface::equilibrium(trunk, {}, params).dem, {}};
    flow::FlowField const drainage = flow::route(out.dem);
    out.rivers.grid = grid;
    std::vector<std::int64_t> number(static_cast<std::size_t>(grid.cells()), -1);
    std::vector<std::int64_t> cells;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (drainage.area_cells[i] >= support_cells) {
            cells.push_back(i);
        }
    }
    std::ranges::stable_sort(cells, [&](auto a, auto b) { return drainage.area_cells[a] > drainage.area_cells[b]; });
    for (std::int64_t const cell : cells) {
        std::int64_t const to = drainage.receiver(cell);
        number[static_cast<std::size_t>(cell)] = static_cast<std::int64_t>(out.rivers.cell.size());
        out.rivers.cell.push_back(cell);
        out.rivers.receiver.push_back(to < 0 ? -1 : number[static_cast<std::size_t>(to)]);
        out.rivers.z.push_back(out.dem[cell]);
    }
    return out;
}

/// The nearest river cell of each cell, and the way there [cells].
struct Nearest {
    std::int64_t cell;
    double far;
};
std::vector<Nearest> nearest(Channels const& rivers) {
    std::vector<Nearest> out;
    for (std::int64_t i = 0; i < rivers.grid.cells(); ++i) {
        Cell const at = rivers.grid.at(i);
        Nearest best{-1, 1e9};
        for (std::int64_t const river : rivers.cell) {
            Cell const to = rivers.grid.at(river);
            double const far = std::hypot(static_cast<double>(to.col - at.col), static_cast<double>(to.row - at.row));
            best = far < best.far ? Nearest{river, far} : best;
        }
        out.push_back(best);
    }
    return out;
}

double correlation(std::vector<double> const& a, std::vector<double> const& b) {
    double const n = static_cast<double>(a.size());
    double sa = 0.0;
    double sb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sa += a[i] / n;
        sb += b[i] / n;
    }
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - sa) * (b[i] - sb);
        aa += (a[i] - sa) * (a[i] - sa);
        bb += (b[i] - sb) * (b[i] - sb);
    }
    return ab / std::sqrt(aa * bb);
}

// What anyone could do with rivers alone: heights rise with the distance to them.
TEST(Rebuild, IsCloserToTheLandThanACone) {
    Land const truth = land(200, 1000, 5);
    std::vector<Nearest> const near = nearest(truth.rivers);
    Raster<float> const dem = rebuild(truth.rivers).terrain.dem;
    std::vector<double> real;
    std::vector<double> rebuilt;
    std::vector<double> cone;
    std::vector<double> whole;
    std::vector<double> rebuilt_whole;
    std::vector<double> cone_whole;
    constexpr double rise = 30.0 * 0.36; // the land's mean tangent
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Nearest const& n = near[static_cast<std::size_t>(i)];
        if (n.far > 3.0) {
            real.push_back(static_cast<double>(truth.dem[i]) - static_cast<double>(truth.dem[n.cell]));
            rebuilt.push_back(static_cast<double>(dem[i]) - static_cast<double>(dem[n.cell]));
            cone.push_back(n.far);
        }
        whole.push_back(static_cast<double>(truth.dem[i]));
        rebuilt_whole.push_back(static_cast<double>(dem[i]));
        cone_whole.push_back(static_cast<double>(truth.dem[n.cell]) + rise * n.far);
    }
    EXPECT_GT(correlation(real, rebuilt), correlation(real, cone) - 0.02); // its flanks are as even as a cone's
    EXPECT_GT(correlation(whole, rebuilt_whole), correlation(whole, cone_whole));
    EXPECT_GT(correlation(whole, rebuilt_whole), 0.97);
}

void expect_lawful(Channels const& rivers, RebuiltTerrain const& out) {
    Raster<float> const& dem = out.terrain.dem;
    Mask is_river(rivers.grid, 0);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        is_river[rivers.cell[n]] = 1;
        if (std::int64_t const r = rivers.receiver[n]; r >= 0) {
            EXPECT_GT(dem[rivers.cell[n]], dem[rivers.cell[static_cast<std::size_t>(r)]]);
        }
    }
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (is_river[i] != 0 || std::isnan(dem[i])) {
            continue;
        }
        auto const beside = channel_trees::beside(rivers.grid, i);
        bool const drains =
            std::ranges::any_of(beside, [&](std::int64_t n) { return std::isnan(dem[n]) || dem[n] < dem[i]; });
        ASSERT_TRUE(drains) << "cell " << i;
        for (std::int64_t const n : beside) {
            ASSERT_FALSE(is_river[n] != 0 && dem[n] >= dem[i]) << "cell " << i;
        }
    }
}

TEST(Rebuild, KeepsHeightsAndDrains) {
    Land const truth = land(120, 100, 3);
    RebuiltTerrain const out = rebuild(truth.rivers);
    expect_lawful(truth.rivers, out);
    double most = 0.0;
    for (std::size_t n = 0; n < truth.rivers.cell.size(); ++n) {
        double const off =
            static_cast<double>(out.terrain.dem[truth.rivers.cell[n]]) - static_cast<double>(truth.rivers.z[n]);
        most = std::max(most, std::fabs(off));
    }
    EXPECT_LT(most, 0.1); // heights that fall by less than a centimetre a step are raised
    EXPECT_TRUE(out.terrain.walled.empty());
    EXPECT_GT(out.survey.spacing_m, 60.0);
    EXPECT_GT(out.survey.mean_slope_deg, 2.0);
}

TEST(Rebuild, ThreadsDoNotMatterSeedsDo) {
    Land const truth = land(150, 100, 7);
    auto const dem = [&](int threads, std::uint64_t seed) {
        RebuildParams params;
        params.seed = seed;
        return rebuild(truth.rivers, {}, params, on_threads(threads)).terrain.dem;
    };
    Raster<float> const one = dem(1, 1);
    EXPECT_TRUE(std::ranges::equal(one.values(), dem(2, 1).values()));
    EXPECT_TRUE(std::ranges::equal(one.values(), dem(4, 1).values()));
    EXPECT_FALSE(std::ranges::equal(one.values(), dem(1, 2).values()));
}

TEST(Rebuild, HasTheMeanSlopeOrReliefAsked) {
    Land const truth = land(120, 100, 3);
    for (double const deg : {22.0, 28.0}) {
        RebuildParams params;
        params.mean_slope_deg = deg;
        EXPECT_NEAR(rebuild(truth.rivers, {}, params).terrain.target_share, 1.0, 0.05) << deg;
    }
    RebuildParams params;
    auto const values = truth.dem.values();
    params.relief_m = static_cast<double>(*std::ranges::max_element(values) - *std::ranges::min_element(values));
    EXPECT_NEAR(rebuild(truth.rivers, {}, params).terrain.target_share, 1.0, 0.05);
}

// Smooth terrain of gentle land is gentle, whatever the constants in metres.
TEST(Rebuild, GentleLandStaysGentle) {
    Land truth = land(120, 100, 3);
    double const steep = rebuild(truth.rivers).survey.mean_slope_deg;
    for (float& z : truth.rivers.z) {
        z *= 0.05F;
    }
    RebuiltTerrain const out = rebuild(truth.rivers);
    EXPECT_LT(out.survey.mean_slope_deg, 0.2 * steep);
    expect_lawful(truth.rivers, out);
}

TEST(Rebuild, TheSeaIsLowest) {
    Land const truth = land(100, 100, 3);
    Channels rivers = truth.rivers;
    surface::EquilibriumFields fields;
    fields.land = Mask(rivers.grid, 1);
    for (std::int64_t col = 0; col < rivers.grid.width; ++col) { // land ends a row of cells before the outlet's
        Cell const c{col, 0};
        fields.land[c] = 0;
    }
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        fields.land[rivers.cell[n]] = 1;
        rivers.z[n] += 5.0F;
    }
    RebuildParams params;
    params.edge = Edge::mainland;
    RebuiltTerrain const out = rebuild(rivers, fields, params);
    for (std::int64_t i = 0; i < rivers.grid.cells(); ++i) {
        ASSERT_EQ(std::isnan(out.terrain.dem[i]), fields.land[i] == 0);
        ASSERT_FALSE(out.terrain.dem[i] <= 0.0F);
    }
    expect_lawful(rivers, out);
}

TEST(Rebuild, LakesHaveTheirLevels) {
    Land const truth = land(100, 60, 3);
    Channels rivers = truth.rivers;
    rivers.level.assign(rivers.cell.size(), 0);
    rivers.lake_z.assign(rivers.cell.size(), unknown);
    std::size_t const outlet = 20;
    float const level = rivers.z[outlet] + 20.0F;
    rivers.lake_z[outlet] = level;
    for (std::size_t n = outlet + 1; n < rivers.cell.size(); ++n) {
        auto const r = static_cast<std::size_t>(rivers.receiver[n]);
        bool const near = rivers.z[n] < level && (r == outlet || rivers.level[r] != 0);
        rivers.level[n] = near ? 1 : 0;
    }
    ASSERT_GT(std::ranges::count(rivers.level, 1), 2);
    RebuiltTerrain const out = rebuild(rivers);
    EXPECT_EQ(out.terrain.dem[rivers.cell[outlet]], level);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.level[n] != 0) {
            EXPECT_EQ(out.terrain.dem[rivers.cell[n]], level);
        }
    }
}

/// Cells of a DEM higher than all others that are so many cells or fewer away.
std::vector<surface::FeatureCell> summits(Raster<float> const& dem, std::int64_t apart) {
    std::vector<surface::FeatureCell> out;
    Grid const& grid = dem.grid();
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = grid.at(i);
        bool highest = true;
        for (std::int64_t row = c.row - apart; row <= c.row + apart; ++row) {
            for (std::int64_t col = c.col - apart; col <= c.col + apart; ++col) {
                Cell const other{col, row};
                highest = highest && (!grid.contains(other) || other == c || dem[other] < dem[c]);
            }
        }
        if (highest) {
            out.push_back({i, dem[i]});
        }
    }
    return out;
}

std::vector<double> misses(Raster<float> const& dem, std::vector<surface::FeatureCell> const& asked) {
    std::vector<double> out;
    for (surface::FeatureCell const& feature : asked) {
        out.push_back(std::fabs(static_cast<double>(dem[feature.cell]) - static_cast<double>(feature.z)));
    }
    std::ranges::sort(out);
    return out;
}

TEST(Rebuild, ARiverMayEndInASink) {
    Channels rivers = channel_trees::grown(test::frame(80, 60, 30.0), {30 * 80 + 40, 10 * 80 + 8}, {}, 300,
                                           channel_trees::Room::apart, 3);
    rivers.z.assign(rivers.cell.size(), 0.0F);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        rivers.z[n] = r < 0 ? 50.0F : rivers.z[static_cast<std::size_t>(r)] + 2.0F;
    }
    RebuiltTerrain const out = rebuild(rivers);
    expect_lawful(rivers, out);
    flow::FlowField const drainage = flow::route(out.terrain.dem, std::vector<std::int64_t>{rivers.cell[0]});
    EXPECT_GT(drainage.area_cells[rivers.cell[0]], 1000) << "the land around drains to it";
    EXPECT_EQ(out.terrain.dem[rivers.cell[0]], 50.0F);
}

TEST(Rebuild, GoesThroughKnownHeights) {
    Land const truth = land(200, 1000, 5);
    std::vector<surface::FeatureCell> const asked = summits(truth.dem, 4);
    ASSERT_GT(asked.size(), 30U);
    RebuiltTerrain const without = rebuild(truth.rivers);
    surface::EquilibriumFields fields;
    fields.features = asked;
    RebuiltTerrain const with = rebuild(truth.rivers, fields);
    expect_lawful(truth.rivers, with);
    std::vector<double> const far = misses(without.terrain.dem, asked);
    std::vector<double> const near = misses(with.terrain.dem, asked);
    EXPECT_GT(far[far.size() / 2], 20.0);
    EXPECT_LT(near[near.size() / 2], 0.5);
    EXPECT_LT(near[near.size() * 9 / 10], 0.1 * far[far.size() * 9 / 10]);
    std::vector<double> real;
    std::vector<double> one;
    std::vector<double> other;
    for (std::int64_t i = 0; i < truth.dem.cells(); ++i) {
        real.push_back(static_cast<double>(truth.dem[i]));
        one.push_back(static_cast<double>(without.terrain.dem[i]));
        other.push_back(static_cast<double>(with.terrain.dem[i]));
    }
    EXPECT_GT(correlation(real, other), correlation(real, one));
}

TEST(ThroughHeights, HasThemAndChangesNothingElsewhere) {
    Raster<float> plain(test::frame(60, 40, 10.0), 100.0F);
    plain[{5, 5}] = unknown;
    std::vector<std::int64_t> const rivers{plain.grid().index({30, 20})};
    std::vector<surface::FeatureCell> const asked{{plain.grid().index({5, 5}), 7.0F},
                                                  {plain.grid().index({40, 20}), 160.0F},
                                                  {plain.grid().index({30, 20}), 55.0F},
                                                  {plain.grid().index({24, 20}), unknown, true},
                                                  {plain.grid().index({24, 28}), 80.0F}};
    std::vector<surface::FeatureCell> sorted = asked;
    std::ranges::sort(sorted, {}, &surface::FeatureCell::cell);
    Raster<float> const dem = surface::through_heights(plain, rivers, sorted);
    EXPECT_EQ((dem[{40, 20}]), 160.0F);
    EXPECT_EQ((dem[{24, 28}]), 80.0F);
    EXPECT_EQ((dem[{30, 20}]), 100.0F) << "rivers keep theirs";
    EXPECT_TRUE(std::isnan(dem[{5, 5}]));
    EXPECT_EQ((dem[{51, 20}]), 100.0F) << "ten cells from the river, so ten cells far";
    EXPECT_GT((dem[{44, 20}]), (dem[{46, 20}]));
    EXPECT_GT((dem[{46, 20}]), 100.0F);
    EXPECT_TRUE(std::ranges::equal(surface::through_heights(plain, rivers, {}).values(), plain.values(),
                                   [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    EXPECT_TRUE(has(message_of<BadInput>([&] { surface::through_heights(plain, {}, sorted); }), "no rivers"));
    EXPECT_TRUE(has(message_of<BadInput>([&] { surface::through_heights(plain, rivers, asked); }), "in order"));
    EXPECT_TRUE(has(message_of<BadInput>([&] { surface::through_heights(plain, {-1}, sorted); }), "-1"));
}

TEST(Rebuild, NoWaterCrossesARidge) {
    constexpr std::int64_t side = 120;
    Channels rivers = channel_trees::parallel(test::frame(side, side, 30.0), {20, 100});
    for (std::int64_t const cell : rivers.cell) {
        rivers.z.push_back(static_cast<float>(3 * (side - rivers.grid.at(cell).row)));
    }
    for (std::int64_t const crest : {60, 40, 85}) {
        surface::EquilibriumFields fields;
        for (std::int64_t row = 0; row < side; ++row) {
            fields.features.push_back({rivers.grid.index({crest, row}), unknown, true});
        }
        RebuiltTerrain const out = rebuild(rivers, fields);
        expect_lawful(rivers, out);
        flow::FlowField const drainage = flow::route(out.terrain.dem);
        std::int64_t crossing = 0;
        std::int64_t lower = 0;
        for (std::int64_t i = 0; i < rivers.grid.cells(); ++i) {
            std::int64_t at = i;
            while (rivers.grid.at(at).col != 20 && rivers.grid.at(at).col != 100) {
                at = drainage.receiver(at);
            }
            std::int64_t const col = rivers.grid.at(i).col;
            crossing += (col < crest && rivers.grid.at(at).col == 100) || (col > crest && rivers.grid.at(at).col == 20);
            bool const beside = col == crest - 1 || col == crest + 1;
            lower += beside && out.terrain.dem[i] > out.terrain.dem[rivers.grid.index({crest, rivers.grid.at(i).row})];
        }
        EXPECT_LT(crossing, rivers.grid.cells() / 200);
        EXPECT_LT(lower, side / 5);
    }
}

TEST(Rebuild, AnyRiversAreRebuilt) {
    EXPECT_TRUE(rc::check("any rivers are rebuilt", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 60).as("width");
        auto const height = *rc::gen::inRange<std::int64_t>(1, 60).as("height");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        Grid const grid = test::frame(width, height, 10.0);
        Channels rivers = channel_trees::grown(grid, {0, grid.cells() - 1}, {}, grid.cells() / 8 + 1,
                                               channel_trees::Room::crowd, seed);
        rivers.z.assign(rivers.cell.size(), 0.0F);
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            std::int64_t const r = rivers.receiver[n];
            float const rise = static_cast<float>(random_word(seed, 51, n) % 5);
            rivers.z[n] = r < 0 ? 100.0F : rivers.z[static_cast<std::size_t>(r)] + rise;
        }
        Channels some = rivers;
        for (std::size_t n = 1; n < some.z.size(); ++n) {
            some.z[n] = random_word(seed, 52, n) % 3 == 0 ? some.z[n] : unknown;
        }
        for (Channels const& one : {rivers, some}) {
            surface::EquilibriumFields fields;
            fields.features = seed % 2 == 0 ? channel_trees::any_features(grid, seed) : fields.features;
            RebuiltTerrain const out = rebuild(one, fields);
            for (float const z : out.terrain.dem.values()) {
                RC_ASSERT(std::isfinite(z));
            }
            for (std::size_t n = 0; n < one.cell.size(); ++n) {
                RC_ASSERT(std::isnan(one.z[n]) || out.terrain.dem[one.cell[n]] >= one.z[n]);
                RC_ASSERT(one.receiver[n] < 0 ||
                          out.terrain.dem[one.cell[n]] >
                              out.terrain.dem[one.cell[static_cast<std::size_t>(one.receiver[n])]]);
            }
        }
    }));
}

/// A river to the south along a column.
Channels column(std::int64_t cells) {
    Channels rivers{test::frame(9, cells, 100.0), {}, {}, {}, {}};
    for (std::int64_t n = 0; n < cells; ++n) {
        rivers.cell.push_back(rivers.grid.index({4, cells - 1 - n}));
        rivers.receiver.push_back(n - 1);
    }
    return rivers;
}

TEST(WithHeights, AreBetweenTheKnownOnes) {
    Channels rivers = column(40);
    rivers.z.assign(40, unknown);
    rivers.z[5] = 10.0F;
    rivers.z[20] = 40.0F;
    Channels const known = surface::with_heights(rivers);
    EXPECT_EQ(known.z[5], 10.0F);
    EXPECT_EQ(known.z[20], 40.0F);
    for (std::size_t n = 1; n < 40; ++n) {
        EXPECT_GT(known.z[n], known.z[n - 1]);
    }
    // Slopes grow upstream, where areas are smaller.
    EXPECT_GT(known.z[20] - known.z[15], known.z[10] - known.z[5]);
}

TEST(WithHeights, RiversWithoutAnyEndAtTheNearest) {
    Channels rivers = column(20);
    auto const first = static_cast<std::int64_t>(rivers.cell.size());
    for (std::int64_t n = 0; n < 5; ++n) {
        rivers.cell.push_back(rivers.grid.index({7, 10 - n}));
        rivers.receiver.push_back(n == 0 ? -1 : first + n - 1);
    }
    rivers.z.assign(rivers.cell.size(), unknown);
    for (std::size_t n = 0; n < 20; ++n) {
        rivers.z[n] = static_cast<float>(n);
    }
    Channels const known = surface::with_heights(rivers);
    EXPECT_EQ(known.z[20], 9.0F);
    EXPECT_GT(known.z[24], known.z[20]);
    rivers.z.assign(rivers.cell.size(), unknown);
    EXPECT_TRUE(has(message_of<BadInput>([&] { surface::with_heights(rivers); }), "no river cell has a height"));
}

TEST(SurveyRivers, FindsTheConcavityOfAProfile) {
    Land truth = land(200, 100, 3);
    Channels const& rivers = truth.rivers;
    std::vector<double> area(rivers.cell.size(), 0.0);
    std::vector<Nearest> const near = nearest(rivers);
    std::vector<std::size_t> number(static_cast<std::size_t>(rivers.grid.cells()));
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        number[static_cast<std::size_t>(rivers.cell[n])] = n;
    }
    for (Nearest const& n : near) {
        area[number[static_cast<std::size_t>(n.cell)]] += 0.0009;
    }
    for (std::size_t n = area.size(); n-- > 0;) {
        if (rivers.receiver[n] >= 0) {
            area[static_cast<std::size_t>(rivers.receiver[n])] += area[n];
        }
    }
    Channels drawn = rivers;
    for (std::size_t n = 0; n < drawn.cell.size(); ++n) {
        drawn.z[n] = 0.0F;
        if (std::int64_t const r = drawn.receiver[n]; r >= 0) {
            drawn.z[n] = drawn.z[static_cast<std::size_t>(r)] + static_cast<float>(1.2 * std::pow(area[n], -0.6));
        }
    }
    surface::RiverSurvey const survey = surface::survey_rivers(drawn);
    EXPECT_NEAR(survey.concavity, 0.6, 0.12); // slopes are means over reaches
    for (float const factor : survey.steepness.values()) {
        EXPECT_GT(factor, 0.6F);
        EXPECT_LT(factor, 1.7F);
    }
}

TEST(Blur, IsTheMeanOfSquares) {
    constexpr std::int64_t width = 23;
    constexpr std::int64_t height = 17;
    constexpr std::int64_t reach = 4;
    std::vector<float> values(static_cast<std::size_t>(width * height));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<float>(random_word(1, 2, i) % 1000);
    }
    std::vector<float> out = values;
    surface::blur(out.data(), {width, height, width}, {reach, 1}, {});
    for (std::int64_t row = 0; row < height; ++row) {
        for (std::int64_t col = 0; col < width; ++col) {
            double sum = 0.0;
            for (std::int64_t r = row - reach; r <= row + reach; ++r) {
                for (std::int64_t c = col - reach; c <= col + reach; ++c) {
                    sum += static_cast<double>(
                        values[static_cast<std::size_t>(std::clamp<std::int64_t>(r, 0, height - 1) * width +
                                                        std::clamp<std::int64_t>(c, 0, width - 1))]);
                }
            }
            EXPECT_NEAR(out[static_cast<std::size_t>(row * width + col)], sum / 81.0, 1e-3);
        }
    }
}

TEST(MeanSlope, IsThatOfAPlane) {
    surface::TerrainLevel level;
    level.width = 40;
    level.height = 30;
    level.side = 2.0F;
    level.z.resize(40 * 30);
    for (std::size_t i = 0; i < level.z.size(); ++i) {
        level.z[i] = 2.0F * 0.3F * static_cast<float>(i % 40) + 2.0F * 0.4F * static_cast<float>(i / 40);
    }
    EXPECT_NEAR(surface::mean_slope_deg(level, {}), 26.565, 0.01);
}

TEST(Rebuild, RefusesWhatCannotBe) {
    Channels rivers = column(20);
    EXPECT_TRUE(has(message_of<BadInput>([&] { rebuild(rivers); }), "no river cell has a height"));
    rivers.z.assign(20, 1.0F);
    rivers.z[3] = 5.0F;
    EXPECT_TRUE(has(message_of<BadInput>([&] { rebuild(rivers); }), "rises downstream"));
    rivers.z.assign(20, 1.0F);
    RebuildParams params;
    params.theta = 2.0;
    EXPECT_TRUE(has(message_of<BadParameter>([&] { rebuild(rivers, {}, params); }), "theta"));
}

} // namespace

} // namespace rebuild_test
