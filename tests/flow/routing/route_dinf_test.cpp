// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/route.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "filled_slowly.hpp"

namespace route_dinf_test {

using namespace thalweg;
using flow::dinf_leaves;
using flow::DinfFlow;
using flow::FlowField;
using flow::route;
using flow::route_dinf;

namespace {

using test::on_threads;

constexpr double pi = 3.14159265358979323846;

/// Tarboton's table 1: the two neighbours of each facet as (row, column) steps, and the numbers of its equation 6.
struct Facet {
    Cell e1;
    Cell e2;
    double ac;
    double af;
};
constexpr std::array<Facet, 8> facets = {{{{1, 0}, {1, -1}, 0, 1},
                                          {{0, -1}, {1, -1}, 1, -1},
                                          {{0, -1}, {-1, -1}, 1, 1},
                                          {{-1, 0}, {-1, -1}, 2, -1},
                                          {{-1, 0}, {-1, 1}, 2, 1},
                                          {{0, 1}, {-1, 1}, 3, -1},
                                          {{0, 1}, {1, 1}, 3, 1},
                                          {{1, 0}, {1, 1}, 4, -1}}};

struct Steepest {
    double slope = 0.0;
    double angle = 0.0; ///< [rad] counterclockwise from the east
};

/// The steepest descent on each facet as the paper has it; on one with a corner without data, down its other edge.
std::vector<Steepest> descents(std::vector<double> const& level, Raster<float> const& dem, Cell c) {
    auto const at = [&](Cell step) -> std::optional<double> {
        Cell const n{c.col + step.col, c.row + step.row};
        bool const data = dem.grid().contains(n) && !std::isnan(dem[n]);
        return data ? std::optional(level[static_cast<std::size_t>(dem.grid().index(n))]) : std::nullopt;
    };
    double const e0 = *at({0, 0});
    std::vector<Steepest> found;
    for (Facet const& f : facets) {
        auto const e1 = at(f.e1);
        auto const e2 = at(f.e2);
        if (!e1 && !e2) {
            continue;
        }
        double r = 0.0;
        double s = 0.0;
        if (e1 && e2) {
            double const s1 = e0 - *e1;
            double const s2 = *e1 - *e2;
            r = std::atan2(s2, s1);
            s = std::sqrt(s1 * s1 + s2 * s2);
            if (r < 0.0) {
                r = 0.0;
                s = s1;
            } else if (r > pi / 4.0) {
                r = pi / 4.0;
                s = (e0 - *e2) / std::sqrt(2.0);
            }
        } else {
            r = e1 ? 0.0 : pi / 4.0;
            s = e1 ? e0 - *e1 : (e0 - *e2) / std::sqrt(2.0);
        }
        found.push_back({s, f.af * r + f.ac * pi / 2.0});
    }
    return found;
}

double angle_of(float bearing) {
    return bearing == 0.0F ? 0.0 : (8.0 - static_cast<double>(bearing)) * pi / 4.0;
}

double apart(double a, double b) {
    double const turn = std::fabs(a - b);
    return std::min(turn, std::fabs(2.0 * pi - turn));
}

/// Where a cell's water goes, and how much of it: at most two neighbours.
std::map<std::int64_t, double> shares_of(DinfFlow const& d, std::int64_t i) {
    std::map<std::int64_t, double> shares;
    float const bearing = d.bearing[i];
    if (!(bearing >= 0.0F)) {
        return shares;
    }
    Grid const& grid = d.bearing.grid();
    double const share = static_cast<double>(bearing) - std::floor(static_cast<double>(bearing));
    auto const k = static_cast<std::size_t>(bearing);
    auto const beside = [&](std::size_t way) {
        return grid.index({grid.at(i).col + d8_steps[way].col, grid.at(i).row + d8_steps[way].row});
    };
    shares[beside(k)] = 1.0 - share;
    if (share > 0.0) {
        shares[beside((k + 1) % 8)] = share;
    }
    return shares;
}

Raster<float> plane(double east, double south) {
    return test::raster_of(frame(9, 9), [&](Cell c) {
        return 100.0 - east * static_cast<double>(c.col) - south * static_cast<double>(c.row);
    });
}

} // namespace

TEST(RouteDinf, RefusesTheDrainageOfAnotherDem) {
    Raster<float> const dem = plane(1.0, 0.5);
    EXPECT_THROW(route_dinf(dem, route(rough_dem(frame(9, 8), 1))), BadInput);
    Raster<float> holed = dem;
    holed[{3, 3}] = hole;
    EXPECT_THROW(route_dinf(dem, route(holed)), BadInput);
    EXPECT_THROW(route_dinf(holed, route(dem)), BadInput);
    FlowField circle = route(dem);
    circle.direction[{3, 3}] = flow::Direction::east;
    circle.direction[{4, 3}] = flow::Direction::west;
    EXPECT_THROW(route_dinf(dem, circle), BadInput);
    FlowField into_hole = route(holed);
    into_hole.direction[{2, 3}] = flow::Direction::east;
    EXPECT_THROW(route_dinf(holed, into_hole), BadInput);
    FlowField off = route(dem);
    off.direction[{0, 0}] = flow::Direction::west;
    EXPECT_THROW(route_dinf(dem, off), BadInput);
    off.direction[{0, 0}] = flow::direction_of(8);
    EXPECT_THROW(route_dinf(dem, off), BadInput);
}

TEST(RouteDinf, OneCellAndNoData) {
    Raster<float> const one = dem_of(1, {3});
    EXPECT_EQ(route_dinf(one, route(one)).bearing[0], dinf_leaves);
    EXPECT_EQ(route_dinf(one, route(one)).area_cells[0], 1.0);
    Raster<float> const none(frame(3, 2), hole);
    EXPECT_TRUE(std::isnan(route_dinf(none, route(none)).bearing[4]));
    EXPECT_EQ(route_dinf(none, route(none)).area_cells[4], 0.0);
}

TEST(RouteDinf, PlanesDrainAlongTheirSlope) {
    // tan of the angle below the east: 0, 1/2, 1, 2, and the same turned by a half.
    for (auto const& [east, south, turn] : {std::tuple{1.0, 0.0, 0.0},
                                            {1.0, 0.5, std::atan(0.5)},
                                            {1.0, 1.0, pi / 4.0},
                                            {0.5, 1.0, std::atan(2.0)},
                                            {-1.0, -0.5, pi + std::atan(0.5)}}) {
        Raster<float> const dem = plane(east, south);
        DinfFlow const d = route_dinf(dem, route(dem));
        EXPECT_NEAR(static_cast<double>(d.bearing[Cell{4, 4}]), turn / (pi / 4.0), 1e-6) << east << " " << south;
    }
}

TEST(RouteDinf, WaterPartsByAngle) {
    // Two rows of a plane to the east-south-east: a quarter of each cell's turn.
    double const quarter = std::tan(pi / 16.0);
    Raster<float> const dem = plane(1.0, quarter);
    DinfFlow const d = route_dinf(dem, route(dem));
    EXPECT_NEAR(static_cast<double>(d.bearing[Cell{1, 1}]), 0.25, 1e-5);
    // The north-western cell gives three parts to the east and one to the south-east; each goes on likewise.
    EXPECT_NEAR((d.area_cells[Cell{1, 0}]), 1.75, 1e-5);
    EXPECT_NEAR((d.area_cells[Cell{1, 1}]), 1.0 + 0.75 * 1.0 + 0.25 * 1.0, 1e-5);
}

TEST(RouteDinf, LawsOnAnyDem) {
    ASSERT_TRUE(rc::check("steepest facets of the filled DEM, water kept, no circle", [] {
        Raster<float> const dem = *gen_dem(9, 30);
        FlowField const d8 = route(dem);
        DinfFlow const d = route_dinf(dem, d8);
        std::vector<double> const level = filled_slowly(dem);
        std::vector<std::map<std::int64_t, double>> shares;
        double data = 0.0;
        double leaving = 0.0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            shares.push_back(shares_of(d, i));
            RC_ASSERT(std::isnan(dem[i]) == std::isnan(d.bearing[i]));
            if (std::isnan(dem[i])) {
                RC_ASSERT(d.area_cells[i] == 0.0);
                continue;
            }
            data += 1.0;
            auto const facets_here = descents(level, dem, dem.grid().at(i));
            double best = 0.0;
            for (Steepest const& s : facets_here) {
                best = std::max(best, s.slope);
            }
            if (best > 0.0) {
                RC_ASSERT(std::any_of(facets_here.begin(), facets_here.end(), [&](Steepest const& s) {
                    return s.slope >= best * (1.0 - 1e-12) && apart(s.angle, angle_of(d.bearing[i])) < 1e-6;
                }));
                for (auto const& [to, share] : shares.back()) {
                    RC_ASSERT(level[static_cast<std::size_t>(to)] < level[static_cast<std::size_t>(i)]);
                }
            } else if (goes_on(d8.direction[i])) {
                RC_ASSERT(d.bearing[i] == static_cast<float>(index_of(d8.direction[i])));
            } else {
                RC_ASSERT(d.bearing[i] == dinf_leaves);
                leaving += d.area_cells[i];
            }
        }
        RC_ASSERT(std::fabs(leaving - data) <= 1e-9 * data);

        // The definition, cell by cell from above; a circle would not end.
        std::vector<double> area(shares.size(), -1.0);
        std::function<double(std::int64_t, std::int64_t)> const area_of = [&](std::int64_t i, std::int64_t depth) {
            RC_ASSERT(depth <= dem.cells());
            double& here = area[static_cast<std::size_t>(i)];
            if (here < 0.0) {
                double sum = std::isnan(dem[i]) ? 0.0 : 1.0;
                for (std::int64_t from = 0; from < dem.cells(); ++from) {
                    auto const share = shares[static_cast<std::size_t>(from)].find(i);
                    if (share != shares[static_cast<std::size_t>(from)].end()) {
                        sum += share->second * area_of(from, depth + 1);
                    }
                }
                here = sum;
            }
            return here;
        };
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            RC_ASSERT(std::fabs(area_of(i, 0) - d.area_cells[i]) <= 1e-9 * data);
        }
    }));
}

TEST(RouteDinf, SameBytesForAnyThreadsAndNoWaterLost) {
    Raster<float> dem = rough_dem(frame(700, 600), 5);
    for (std::int64_t i = 0; i < dem.cells(); i += 97) {
        dem[i] = hole;
    }
    thalweg::Run const one = on_threads(1);
    thalweg::Run const many = on_threads(4);
    FlowField const d8 = route(dem);
    DinfFlow const a = route_dinf(dem, d8, one);
    DinfFlow const b = route_dinf(dem, d8, many);
    double data = 0.0;
    double leaving = 0.0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        ASSERT_EQ(a.bearing[i] == b.bearing[i], !std::isnan(dem[i]));
        ASSERT_EQ(a.area_cells[i], b.area_cells[i]);
        data += std::isnan(dem[i]) ? 0.0 : 1.0;
        leaving += a.bearing[i] == dinf_leaves ? a.area_cells[i] : 0.0;
    }
    EXPECT_NEAR(leaving / data, 1.0, 1e-9);
}

} // namespace route_dinf_test
