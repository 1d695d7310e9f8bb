// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage/certificate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/drainage/internal/agreement.hpp>

#include "dems.hpp"

namespace certificate_test {

using namespace thalweg;
using flow::Reach;
using flow::route;
using measure::Agreements;
using measure::Certificate;
using measure::certify;

namespace {

/// A valley of 21 x 30 cells that falls to the south, its river in column 10 from row 2 to the border; a side river
/// comes in from the west along row 12.
struct Land {
    Raster<float> dem;
    std::vector<Reach> reaches; ///< 7: above the side river, 8: side river, 9: below it
};

Land valley() {
    Land land{Raster<float>(frame(21, 30)), {}};
    Grid const& grid = land.dem.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        auto const away = static_cast<double>(std::abs(c.col - 10));
        land.dem[i] = static_cast<float>(100.0 - static_cast<double>(c.row) + 2.0 * away);
    }
    for (std::int64_t col = 3; col < 10; ++col) { // the side river has cut in
        auto const away = static_cast<double>(10 - col);
        land.dem[{col, 12}] = static_cast<float>(88.0 + 0.5 * away);
    }
    Cell const mouth{10, 12};
    land.reaches = {{{{grid.centre({10, 2}), grid.centre(mouth)}}, 2, 7},
                    {{{grid.centre({3, 12}), grid.centre(mouth)}}, 2, 8},
                    {{{grid.centre(mouth), grid.centre({10, 29})}}, -1, 9}};
    return land;
}

Certificate certificate_of(Land const& land, std::vector<double> const& areas = {}) {
    return certify(land.dem, route(land.dem), land.reaches, {.ds_area_m2 = areas});
}

std::vector<Finding> of_kind(Certificate const& c, std::string const& kind) {
    std::vector<Finding> out;
    std::copy_if(c.findings.begin(), c.findings.end(), std::back_inserter(out),
                 [&](Finding const& f) { return f.kind == kind; });
    return out;
}

bool passes(Certificate const& c) {
    auto const checks = c.checks();
    return std::all_of(checks.begin(), checks.end(), [](Check const& check) { return check.ok; });
}

Cell at(Land const& land, Finding const& f) {
    return land.dem.grid().cell_of(f.where);
}

} // namespace

TEST(Certify, RefusesWhatDoesNotBelongTogether) {
    Land const land = valley();
    EXPECT_THROW(certify(land.dem, route(rough_dem(frame(3, 3), 1)), land.reaches), BadInput);
    EXPECT_THROW(certificate_of(land, {1.0}), BadInput);
}

TEST(Certify, AValleyThatDrainsByItsRiversPasses) {
    Certificate const c = certificate_of(valley());
    EXPECT_TRUE(passes(c));
    EXPECT_TRUE(c.findings.empty());
    EXPECT_EQ(c.depressions, 0);
    EXPECT_EQ(c.river_cells, 28 + 7);
    EXPECT_EQ(c.following_cells, c.river_cells);
    EXPECT_EQ(c.sources, 2);
    EXPECT_EQ(c.arriving_sources, 2);
    EXPECT_EQ(c.border_cells, 0);
    for (measure::Agreement const& a : c.traced) {
        EXPECT_EQ(a.f(), 1.0);
    }
    EXPECT_GT(c.threshold_cells, 0);
}

TEST(Certify, NoNetworkHasNoRiversToFollow) {
    Land land = valley();
    land.reaches.clear();
    Certificate const c = certificate_of(land);
    EXPECT_TRUE(passes(c));
    EXPECT_EQ(c.river_cells, 0);
    EXPECT_EQ(c.sources, 0);
}

TEST(Certify, FindsADugPit) {
    Land land = valley();
    land.dem[{16, 20}] -= 9.0F;
    Certificate const c = certificate_of(land);
    auto const found = of_kind(c, "depression");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(at(land, found[0]), (Cell{16, 20}));
    EXPECT_EQ(c.pit_cells, 1);
    EXPECT_EQ(c.max_depth_m, found[0].amount);
    EXPECT_FALSE(passes(c));
}

TEST(Certify, FindsARiverCellRaisedByTheLeastThatDams) {
    Land land = valley();
    float const above = land.dem[(Cell{10, 19})];
    land.dem[{10, 20}] = above; // level: no water stands
    EXPECT_EQ(certificate_of(land).depressions, 0);
    land.dem[{10, 20}] = std::nextafter(above, 1e9F);
    Certificate const c = certificate_of(land);
    auto const found = of_kind(c, "depression");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(at(land, found[0]), (Cell{10, 19}));
    EXPECT_FALSE(passes(c));
}

TEST(Certify, FindsWhereWaterLeavesTheRiver) {
    Land land = valley();
    // A ditch from the bank at row 17 down the eastern side of the valley to the border.
    for (std::int64_t row = 17; row < 30; ++row) {
        land.dem[{11 + std::min<std::int64_t>(row - 17, 4), row}] = static_cast<float>(80.0 - static_cast<double>(row));
    }
    Certificate const c = certificate_of(land);
    auto const found = of_kind(c, "water_leaves");
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].feature, 9);
    EXPECT_EQ(at(land, found[0]), (Cell{10, 16}));
    EXPECT_LT(c.following_cells, c.river_cells);
    EXPECT_EQ(c.arriving_sources, 0);
    auto const astray = of_kind(c, "source_astray");
    ASSERT_EQ(astray.size(), 2U);
    EXPECT_EQ(astray[0].feature, 7);
    EXPECT_EQ(astray[1].feature, 8);
    EXPECT_EQ(at(land, astray[1]), (Cell{3, 12}));
    EXPECT_LT(c.traced[1].recall, 0.95);
    EXPECT_FALSE(passes(c));
}

TEST(Certify, FindsARiverAlongTheBorder) {
    Land land = valley();
    Grid const& grid = land.dem.grid();
    land.reaches.push_back({{{grid.centre({0, 20}), grid.centre({0, 24})}}, -1, 10});
    Certificate const c = certificate_of(land);
    EXPECT_EQ(c.border_cells, 3); // its ends may lie there
    EXPECT_EQ(of_kind(c, "border_cell").size(), 3U);
    EXPECT_FALSE(passes(c));
}

TEST(Certify, FindsReachesOutsideTheData) {
    Land land = valley();
    land.dem[{10, 4}] = hole;
    land.dem[{10, 5}] = hole;
    Certificate const c = certificate_of(land);
    auto const found = of_kind(c, "outside_dem");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].feature, 7);
    EXPECT_EQ(found[0].amount, 2.0);
    EXPECT_EQ(at(land, found[0]), (Cell{10, 4}));
    EXPECT_EQ(c.river_cells, 28 + 7 - 2);
}

TEST(Certify, NothingIsTracedWhereRiversStand) {
    Raster<float> const flat(frame(9, 9), 3.0F);
    Grid const& grid = flat.grid();
    std::vector<Reach> const river = {{{{grid.centre({4, 2}), grid.centre({4, 8})}}, -1, 1}};
    Mask still(grid);
    still[{4, 5}] = 1;
    Certificate const lake = certify(flat, route(flat), river, {.still = still});
    EXPECT_EQ(lake.lake_cells, 7);
    EXPECT_EQ(lake.traced[0].f(), 1.0);
    EXPECT_EQ(certify(flat, route(flat), river).lake_cells, 0) << "level cells alone are no lake";
}

TEST(Certify, ALakeEndsWhereTheLevelDoes) {
    Land land = valley();
    for (std::int64_t row = 15; row < 20; ++row) {
        land.dem[{10, row}] = land.dem[{10, 19}];
    }
    Mask still(land.dem.grid());
    still[{10, 17}] = 1;
    Certificate const c = certify(land.dem, route(land.dem), land.reaches, {.still = still});
    EXPECT_EQ(c.lake_cells, 5);
    EXPECT_TRUE(passes(c));
}

TEST(Certify, WaterEndsInASink) {
    Land land = valley();
    for (std::int64_t row = 20; row < 30; ++row) { // a bar across the mouth
        for (std::int64_t col = 0; col < 21; ++col) {
            land.dem[{col, row}] += 2.0F * static_cast<float>(row - 19);
        }
    }
    Grid const& grid = land.dem.grid();
    land.reaches[2].lines = {{grid.centre({10, 12}), grid.centre({10, 19})}};
    EXPECT_FALSE(passes(certificate_of(land)));
    flow::FlowField const drainage = route(land.dem, std::vector<std::int64_t>{grid.index({10, 19})});
    EXPECT_TRUE(drainage.depressions.empty());
    EXPECT_EQ(drainage.direction[(Cell{10, 19})], flow::Direction::leaves);
    EXPECT_TRUE(passes(certify(land.dem, drainage, land.reaches)));
    EXPECT_THROW(route(land.dem, std::vector<std::int64_t>{grid.cells()}), BadInput);
    EXPECT_THROW(route(land.dem, std::vector<std::int64_t>{-1}), BadInput);
}

TEST(Certify, WhatIsNotHonouredIsNotAsked) {
    Land land = valley();
    for (std::int64_t col = 2; col < 8; ++col) { // a hill across the side river
        land.dem[{col, 12}] += 30.0F;
    }
    EXPECT_FALSE(passes(certificate_of(land)));
    Mask honoured(land.dem.grid(), 1);
    for (std::int64_t col = 3; col < 8; ++col) {
        honoured[{col, 12}] = 0;
    }
    Certificate const c = certify(land.dem, route(land.dem), land.reaches, {.honoured = honoured});
    EXPECT_TRUE(passes(c));
    EXPECT_EQ(c.waived_cells, 5);
    EXPECT_EQ(c.sources, 2) << "the side river begins again at column 8";
    honoured[{8, 12}] = honoured[{9, 12}] = 0;
    Certificate const none = certify(land.dem, route(land.dem), land.reaches, {.honoured = honoured});
    EXPECT_EQ(none.sources, 1);
    EXPECT_EQ(none.waived_cells, 7);
    EXPECT_TRUE(passes(none));
}

TEST(Certify, WaterMayCutACorner) {
    Raster<float> dem(frame(20, 20));
    for (std::int64_t i = 0; i < dem.cells(); ++i) { // falls to the south-east
        Cell const c = dem.grid().at(i);
        dem[i] = static_cast<float>(100 - c.col - c.row + 2 * std::abs(c.col - c.row));
    }
    Grid const& grid = dem.grid();
    std::vector<Vec2> stairs;
    for (std::int64_t k = 2; k < 20; ++k) {
        stairs.push_back(grid.centre({k, k}));
        if (k + 1 < 20) {
            stairs.push_back(grid.centre({k + 1, k}));
        }
    }
    Certificate const c = certify(dem, route(dem), {{{stairs}, -1, 1}});
    EXPECT_EQ(c.river_cells, 18);
    EXPECT_EQ(c.traced[0].f(), 1.0);
}

TEST(Certify, ATraceBesideTheRiverFails) {
    Land land = valley();
    Grid const& grid = land.dem.grid();
    land.reaches = {{{{grid.centre({11, 2}), grid.centre({11, 29})}}, -1, 7}}; // one cell beside the valley's line
    Certificate const c = certificate_of(land);
    EXPECT_EQ(c.arriving_sources, 1);
    EXPECT_GE(c.traced[1].recall, 0.95);
    EXPECT_LT(c.traced[0].f(), 0.98);
    EXPECT_FALSE(passes(c));
}

TEST(Certify, ComparesAreasWithThoseOfTheFile) {
    Land const land = valley();
    flow::FlowField const d = route(land.dem);
    std::vector<double> areas = {static_cast<double>(d.area_cells[(Cell{10, 11})]),
                                 static_cast<double>(d.area_cells[(Cell{9, 12})]),
                                 static_cast<double>(d.area_cells[(Cell{10, 29})])};
    EXPECT_EQ(certificate_of(land, areas).compared_areas, 3);
    EXPECT_EQ(certificate_of(land, areas).max_area_difference, 0.0);
    areas[1] *= 2.0;
    areas[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(certificate_of(land, areas).compared_areas, 2);
    EXPECT_EQ(certificate_of(land, areas).max_area_difference, 0.5);
    EXPECT_EQ(certificate_of(land, areas).close_areas, 1);
}

TEST(Certify, ListsAThousandOfAKind) {
    Raster<float> dem(frame(151, 151), 1.0F);
    std::int64_t pits = 0;
    for (std::int64_t row = 1; row < 150; row += 2) {
        for (std::int64_t col = 1; col < 150; col += 2, ++pits) {
            dem[{col, row}] = 0.0F;
        }
    }
    Certificate const c = certify(dem, route(dem), {});
    EXPECT_EQ(c.depressions, pits);
    EXPECT_EQ(c.findings.size(), 1000U);
}

TEST(Certify, RiversTracedOnADemPassOnIt) {
    ASSERT_TRUE(rc::check("reaches along the DEM's own ways", [] {
        Raster<float> const dem = *gen_dem(14, 10);
        flow::FlowField const d = route(dem);
        auto const sources = *rc::gen::inRange(0, 4);
        Mask passed(dem.grid());
        std::vector<Reach> reaches;
        for (int k = 0; k < sources; ++k) {
            std::int64_t i = *evenly<std::int64_t>(0, dem.cells());
            if (std::isnan(dem[i]) || passed[i] != 0) {
                continue;
            }
            std::vector<Vec2> line;
            bool joins = false;
            for (;;) {
                line.push_back(dem.grid().centre(dem.grid().at(i)));
                joins = passed[i] != 0;
                passed[i] = 1;
                if (joins || !goes_on(d.direction[i])) {
                    break;
                }
                Cell const step = d8_steps[index_of(d.direction[i])];
                i += step.row * dem.width() + step.col;
            }
            if (joins) {
                return; // reaches would have to be split there
            }
            reaches.push_back({{line}, -1, k + 1});
        }
        Certificate const c = certify(dem, d, reaches);
        RC_ASSERT(c.following_cells == c.river_cells);
        RC_ASSERT(c.arriving_sources == c.sources);
        if (!reaches.empty()) {
            RC_ASSERT(c.traced[0].f() == 1.0);
        }
    }));
}

TEST(Certify, DepressionsAddUpToTheCellsBelowTheirSpill) {
    ASSERT_TRUE(rc::check("depressions", [] {
        Raster<float> const dem = *gen_dem(12, 10);
        flow::FlowField const d = route(dem);
        std::int64_t cells = 0;
        double volume = 0.0;
        for (flow::Depression const& p : d.depressions) {
            cells += p.cells;
            volume += p.volume_m3;
            RC_ASSERT(p.max_depth_m > 0.0);
        }
        RC_ASSERT(cells == d.pits);
        RC_ASSERT(std::abs(volume - d.pit_volume_m3) <= 1e-9 * (1.0 + volume));
    }));
}

namespace {

/// Shares by distances between centres, every pair.
Agreements slow_agreement(std::vector<std::int64_t> const& found, std::vector<std::int64_t> const& rivers,
                          Grid const& grid) {
    double const reach[3] = {0.5, 1.5, 2.9};
    auto const share = [&](std::vector<std::int64_t> const& of, std::vector<std::int64_t> const& to, double within) {
        std::int64_t hits = 0;
        for (std::int64_t const a : of) {
            hits += std::any_of(to.begin(), to.end(), [&](std::int64_t b) {
                Cell const p = grid.at(a);
                Cell const q = grid.at(b);
                return std::sqrt(static_cast<double>((p.col - q.col) * (p.col - q.col) +
                                                     (p.row - q.row) * (p.row - q.row))) <= within;
            });
        }
        return of.empty() ? 0.0 : static_cast<double>(hits) / static_cast<double>(of.size());
    };
    Agreements out;
    for (std::size_t k = 0; k < 3; ++k) {
        out[k] = {share(found, rivers, reach[k]), share(rivers, found, reach[k])};
    }
    return out;
}

std::vector<std::int64_t> some_cells(Grid const& grid) {
    auto const percent = *rc::gen::element(0, 2, 10, 50);
    std::vector<std::int64_t> cells;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (*evenly(0, 100) < percent) {
            cells.push_back(i);
        }
    }
    return cells;
}

bool same(Agreements const& a, Agreements const& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](measure::Agreement const& p, measure::Agreement const& q) {
        return p.precision == q.precision && p.recall == q.recall;
    });
}

} // namespace

TEST(Agreement, IsThatOfEveryPairOfCentres) {
    ASSERT_TRUE(rc::check("agreement", [] {
        Grid const grid = frame(*evenly<std::int64_t>(1, 16), *evenly<std::int64_t>(1, 16));
        auto const found = some_cells(grid);
        auto const rivers = some_cells(grid);
        RC_ASSERT(same(measure::agreement(found, rivers, grid), slow_agreement(found, rivers, grid)));
    }));
}

TEST(Agreement, BestThresholdIsTheBestOfAll) {
    ASSERT_TRUE(rc::check("best_threshold", [] {
        Grid const grid = frame(*evenly<std::int64_t>(1, 14), *evenly<std::int64_t>(1, 14));
        Raster<flow::CellCount> area(grid);
        for (flow::CellCount& a : area.values()) {
            a = *evenly<flow::CellCount>(1, 200);
        }
        auto const rivers = some_cells(grid);
        auto const [threshold, best] = measure::best_threshold(area, rivers, {});
        double most = -1.0;
        std::int64_t at = 0;
        for (std::int64_t const t : {16, 24, 32, 48, 64, 96, 128, 192}) {
            std::vector<std::int64_t> found;
            for (std::int64_t i = 0; i < grid.cells(); ++i) {
                if (area[i] >= t) {
                    found.push_back(i);
                }
            }
            Agreements const here = slow_agreement(found, rivers, grid);
            if (!found.empty() && here[1].f() > most) {
                most = here[1].f();
                at = t;
            }
        }
        RC_ASSERT(threshold == at);
        if (at > 0) {
            RC_ASSERT(best[1].f() == most);
        }
    }));
}

} // namespace certificate_test
