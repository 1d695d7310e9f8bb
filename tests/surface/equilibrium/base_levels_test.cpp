// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/equilibrium.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>

namespace {

using namespace thalweg;
using surface::Edge;
using surface::equilibrium;
using surface::EquilibriumFields;
using surface::EquilibriumParams;
using surface::EquilibriumTerrain;
using surface::Heads;

constexpr std::int64_t coast = 140; // first row of the sea
constexpr std::int64_t inland = 60; // row of the river, 6 km from the sea

/// A river of 33 km that runs along a coast before it turns to it.
Channels along_a_coast() {
    Channels rivers;
    rivers.grid = {400, 160, 75.0, 0.0, 0.0, {}};
    auto const put = [&](std::int64_t col, std::int64_t row) {
        rivers.receiver.push_back(static_cast<ChannelId>(rivers.cell.size()) - 1);
        rivers.cell.push_back(rivers.grid.index({col, row}));
    };
    for (std::int64_t row = coast - 1; row > inland; --row) {
        put(20, row);
    }
    for (std::int64_t col = 20; col < 380; ++col) {
        put(col, inland);
    }
    return rivers;
}

EquilibriumTerrain land_of(Channels const& rivers, Run const& run = {}) {
    EquilibriumFields fields;
    fields.land = Mask(rivers.grid);
    for (std::int64_t i = 0; i < rivers.grid.cells(); ++i) {
        fields.land[i] = rivers.grid.at(i).row < coast ? 1 : 0;
    }
    EquilibriumParams params;
    params.edge = Edge::mainland;
    params.heads = Heads::kept;
    params.inflow = false;
    return equilibrium(rivers, fields, params, run);
}

/// By land cell, the largest fall to cells 1 km away along rows and columns [m].
std::vector<float> falls(Raster<float> const& dem) {
    constexpr std::int64_t far = 13; // cells of 75 m
    std::vector<float> out;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        float most = 0.0F;
        for (Cell const step : {Cell{far, 0}, Cell{-far, 0}, Cell{0, far}, Cell{0, -far}}) {
            Cell const c = dem.grid().at(i);
            Cell const other{c.col + step.col, c.row + step.row};
            if (dem.grid().contains(other) && dem[other] < dem[i]) { // false at sea
                most = std::max(most, dem[i] - dem[other]);
            }
        }
        if (!std::isnan(dem[i])) {
            out.push_back(most);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

// Land between a long river and the sea holds it at the usual slopes: the river is less steep, no range stands there.
TEST(BaseLevels, RiverAlongACoastHasNoWall) {
    Channels const rivers = along_a_coast();
    EquilibriumTerrain const land = land_of(rivers);
    EXPECT_TRUE(land.walled.empty());
    EXPECT_TRUE(land.shortened.empty());
    std::vector<float> const fall = falls(land.dem);
    float const usual = fall[fall.size() * 9 / 10];
    float const steep = fall[fall.size() * 999 / 1000];
    float const head = land.dem[rivers.cell.back()];
    RecordProperty("head_m", static_cast<int>(head));
    RecordProperty("steep_per_mille", static_cast<int>(1000.0F * steep / usual));
    EXPECT_LE(head, 700.0F);
    EXPECT_LE(steep, 1.8F * usual);
    for (std::size_t n = 1; n < rivers.cell.size(); ++n) {
        EXPECT_GT(land.dem[rivers.cell[n]], land.dem[rivers.cell[n - 1]]);
    }
}

TEST(BaseLevels, ThreadsDoNotMatter) {
    Channels const rivers = along_a_coast();
    auto const one = land_of(rivers, test::on_threads(1));
    auto const four = land_of(rivers, test::on_threads(4));
    EXPECT_TRUE(
        std::equal(one.dem.values().begin(), one.dem.values().end(), four.dem.values().begin(), [](float a, float b) {
            return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
        }));
}
