// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/laws.hpp>

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/network/order/order.hpp>

namespace laws_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

LawRow const& row(std::vector<LawRow> const& rows, std::string_view key) {
    auto const at = std::find_if(rows.begin(), rows.end(), [&](LawRow const& r) { return r.key == key; });
    if (at == rows.end()) {
        throw std::out_of_range("no law " + std::string(key));
    }
    return *at;
}

double value(std::vector<LawRow> const& rows, std::string_view key) {
    return row(rows, key).value.value();
}

/// Within nature's range, or beside it by this share of it.
void near_nature(std::vector<LawRow> const& rows, std::string_view key, double share) {
    LawRow const& law = row(rows, key);
    ASSERT_NE(law.nature, nullptr) << key;
    double const margin = share * (law.nature->high - law.nature->low);
    EXPECT_GE(value(rows, key), law.nature->low - margin) << key;
    EXPECT_LE(value(rows, key), law.nature->high + margin) << key;
}

} // namespace

TEST(Laws, OfAnExactTokunagaTreeAreItsOwn) {
    for (int const order : {4, 6, 9}) {
        std::vector<std::int64_t> down;
        for (growth::TreeLink const& link : growth::grow_tokunaga({.generator = 2, .order = order}).links) {
            down.push_back(link.down);
        }
        auto const law = measure::tokunaga(network::count_streams(down).side);
        ASSERT_TRUE(law);
        EXPECT_NEAR(law->a, 1.0, 1e-12);
        EXPECT_NEAR(law->c, 2.0, 1e-12);
        EXPECT_EQ(law->terms, order - 1);
    }
}

TEST(Laws, ADemWithoutRiversHasRowsWithoutValues) {
    Raster<float> const level({4, 3, 10.0, 0.0, 0.0, "EPSG:32631"}, 5.0F);
    DemLaws const none = laws_of_dem(level, {.support_cells = 100});
    auto const rows = law_rows(none.laws);
    EXPECT_EQ(value(rows, "drainage_density"), 0.0);
    for (LawRow const& law : rows) {
        EXPECT_TRUE(law.key == "drainage_density" || !law.value) << law.key;
    }
    Raster<float> const empty(level.grid(), std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(laws_of_dem(empty), BadInput);
    EXPECT_THROW(laws_of_dem(level, {.support_cells = 0}), BadParameter);
}

TEST(Laws, EveryRangeOfNatureHasItsLaw) {
    auto const rows = law_rows({});
    for (measure::NaturalRange const& range : measure::natural_ranges()) {
        EXPECT_EQ(row(rows, range.law).nature, &range);
    }
}

/// Real mountains obey the laws that were found on maps of other rivers.
TEST(Laws, OfReferenceDemsLieInOrNearNature) {
    for (auto const& [file, support] : {std::pair("bigtujunga_srtm1.tif", 100), std::pair("bigtujunga_srtm1.tif", 200),
                                        std::pair("jacksboro_srtm3.tif", 100), std::pair("jacksboro_srtm3.tif", 200)}) {
        SCOPED_TRACE(file + std::string(", support ") + std::to_string(support));
        Raster<float> const dem = io::read_dem(std::string(THALWEG_SOURCE_DIR "/samples/") + file);
        auto const rows = law_rows(laws_of_dem(dem, {.support_cells = support}).laws);
        for (char const* within : {"bifurcation", "length", "area", "concavity", "drainage_density"}) {
            near_nature(rows, within, 0.1);
        }
        near_nature(rows, "hack", 0.5);
        near_nature(rows, "junction_angle", 0.5);
        near_nature(rows, "tokunaga_a", 1.0);
        near_nature(rows, "tokunaga_c", 0.5);
    }
}

TEST(Laws, OfScheideggersSurfaceAreTheirsWhereTheEdgeCutsNone) {
    // Water runs south-west or south-east, to the lower of two random heights; the cells between are ridges.
    Grid grid{400, 480, 10.0, 500000.0, 5000000.0, "EPSG:32632"};
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        double const noise = static_cast<double>(random_word(3, static_cast<std::uint64_t>(i)) >> 11U) * 0x1p-53;
        double const ridge = (c.col + c.row) % 2 == 0 ? 0.0 : 7.0;
        dem[i] = static_cast<float>(10.0 * static_cast<double>(grid.height - c.row) + 5.0 * noise + ridge);
    }
    DemLaws const found = laws_of_dem(dem, {.support_cells = 4});
    ASSERT_TRUE(found.inside.has_value());
    EXPECT_LT(found.arcs_inside, found.arcs);
    EXPECT_GT(found.arcs_inside, found.arcs / 2);
    // Dodds and Rothman (2000): h = 2/3, R_n = 5.2.
    EXPECT_NEAR(value(law_rows(*found.inside), "hack"), 2.0 / 3.0, 0.03);
    EXPECT_LT(value(law_rows(found.laws), "hack"), 0.645);
    EXPECT_NEAR(value(law_rows(found.laws), "bifurcation"), 5.2, 0.6);
}

TEST(Laws, HacksLengthsBeginAtTheDivide) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 160;
    recipe.grid.height = 120;
    recipe.network->dla.particles = 3000;
    Raster<float> const dem = make::make(recipe).terrain.ground.dem;
    flow::FlowField const drainage = flow::route(dem);
    flow::ExtractedStreams const streams = flow::extract_streams(drainage, dem, {.support_cells = 30});
    StreamNetwork const& plan = streams.network.planform;
    Raster<float> const lengths = flow::flow_lengths(drainage);
    measure::NetworkLawsParams params{.land_m2 = 1.0, .junction_reach_m = 100.0};
    for (NodeId n = 0; n < plan.node_count(); ++n) {
        params.head_m.push_back(static_cast<double>(lengths[dem.grid().cell_of(plan.node(n).at)]));
    }
    auto const wanted = measure::network_laws(streams.network, network::order(plan), streams.areas, params).hack;
    auto const found = laws_of_dem(dem, drainage, {.support_cells = 30}).laws.hack;
    ASSERT_TRUE(wanted && found);
    EXPECT_EQ(found->exponent, wanted->exponent); // to the bit
    EXPECT_EQ(found->coefficient, wanted->coefficient);
}

TEST(Laws, TheDemsRiversAreAsLongAsTheNetwork) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 160;
    recipe.grid.height = 120;
    recipe.network->dla.particles = 3000;
    recipe.network->prune_cells = 8.0;
    MakeResult const terrain = make::make(recipe);
    ASSERT_TRUE(terrain.assessment.laws.network && terrain.assessment.laws.dem);
    DemLaws const& dem = *terrain.assessment.laws.dem;
    EXPECT_TRUE(dem.as_dense);
    EXPECT_GE(dem.laws.drainage_density_m, terrain.assessment.laws.network->drainage_density_m);
    flow::FlowField const drainage = flow::route(terrain.terrain.ground.dem);
    auto const sparser = laws_of_dem(terrain.terrain.ground.dem, drainage, {.support_cells = dem.support_cells + 1});
    EXPECT_LT(sparser.laws.drainage_density_m, terrain.assessment.laws.network->drainage_density_m);
    EXPECT_FALSE(sparser.as_dense);
    EXPECT_EQ(dem.support_m2,
              static_cast<double>(dem.support_cells) * terrain.terrain.grid.cell_m * terrain.terrain.grid.cell_m);

    recipe.surface.reset();
    MakeResult const rivers = make::make(recipe);
    EXPECT_TRUE(rivers.assessment.laws.network);
    EXPECT_FALSE(rivers.assessment.laws.dem);
}

} // namespace laws_test
