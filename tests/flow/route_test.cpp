// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/route.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/internal/condition.hpp>

#include "filled_slowly.hpp"

namespace route_test {

using namespace thalweg;
using flow::dinf_leaves;
using flow::DinfFlow;
using flow::Direction;
using flow::FlowField;
using flow::route;
using flow::route_dinf;

namespace {

using test::on_threads;

std::vector<Direction> directions(FlowField const& d) {
    return {d.direction.values().begin(), d.direction.values().end()};
}

std::vector<std::int64_t> areas(FlowField const& d) {
    return {d.area_cells.values().begin(), d.area_cells.values().end()};
}

Cell next_of(Cell c, Direction direction) {
    Cell const step = d8_steps[index_of(direction)];
    return {c.col + step.col, c.row + step.row};
}

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

TEST(Route, RefusesNoCellsAndInfiniteHeights) {
    EXPECT_THROW(route(Raster<float>{}), BadInput);
    EXPECT_THROW(route(dem_of(2, {1, -std::numeric_limits<float>::infinity()})), BadInput);
    constexpr std::int64_t side = 1 << 16;
    auto const vast = Raster<float>::view_of(frame(side, side), {}, nullptr); // of which nothing is read
    EXPECT_THROW(route(vast), BadInput);
}

TEST(Route, OneCellLeaves) {
    FlowField const d = route(dem_of(1, {3}));
    EXPECT_EQ(directions(d), std::vector<Direction>{Direction::leaves});
    EXPECT_EQ(areas(d), std::vector<std::int64_t>{1});
    EXPECT_EQ(d.pits, 0);
}

TEST(Route, NoDataOnly) {
    FlowField const d = route(Raster<float>(frame(3, 2), hole));
    EXPECT_EQ(directions(d), std::vector<Direction>(6, Direction::no_data));
    EXPECT_EQ(areas(d), std::vector<std::int64_t>(6, 0));
}

TEST(Route, PitIsFilledToWhereItSpills) {
    Raster<float> dem(frame(5, 5), 10.0F);
    dem[{2, 2}] = 1.0F;
    dem[{1, 2}] = 2.0F;
    dem[{4, 1}] = 7.0F; // beside {3, 1}, which is 8
    dem[{3, 1}] = 8.0F;
    FlowField const d = route(dem);
    EXPECT_EQ(d.pits, 2);
    EXPECT_EQ(d.pit_volume_m3, 7.0 + 6.0);
    EXPECT_EQ(d.direction[(Cell{1, 2})], Direction::east);
    EXPECT_EQ(d.direction[(Cell{2, 2})], Direction::north_east);
    EXPECT_EQ(d.direction[(Cell{3, 1})], Direction::east);
    EXPECT_EQ(d.direction[(Cell{4, 1})], Direction::leaves);
    EXPECT_GE(d.area_cells[(Cell{2, 2})], 2);
    Grid grid = dem.grid();
    grid.cell_m = 10.0;
    Raster<float> wide(grid);
    std::copy(dem.values().begin(), dem.values().end(), wide.values().begin());
    EXPECT_EQ(route(wide).pit_volume_m3, 1300.0);
}

TEST(Route, BothZerosAreLevel) {
    Raster<float> dem(frame(7, 7), 0.0F);
    for (std::int64_t i = 0; i < dem.cells(); i += 2) {
        dem[i] = -0.0F;
    }
    EXPECT_EQ(directions(route(dem)), directions(route(Raster<float>(frame(7, 7), 0.0F))));
}

TEST(Route, LandThatDrainsIsRoutedAsBesideABowl) {
    // Alone, each cell has a lower neighbour or is an outlet, and nothing is flooded; the bowl needs a flood.
    ASSERT_TRUE(rc::check("the same directions and areas, with sinks or without", [] {
        Raster<float> const rough = *gen_dem(9, 30);
        Valley ends{Raster<float>(rough.grid(), hole)};
        std::vector<std::int64_t> sinks;
        for (int k = *rc::gen::inRange(0, 4).as("sinks"); k > 0; --k) {
            auto const cell = *rc::gen::inRange<std::int64_t>(0, rough.cells());
            if (!std::isnan(rough[cell])) {
                ends.z[cell] = rough[cell];
                sinks.push_back(cell);
            }
        }
        Raster<float> const dem = flow::fill(rough, ends);
        std::int64_t const width = dem.width();
        Raster<float> const both =
            test::raster_of(frame(width + 4, std::max<std::int64_t>(dem.height(), 3)), [&](Cell c) {
                bool const in_bowl = c.col > width && c.row < 3;
                float const bowl = c.col == width + 2 && c.row == 1 ? 0.0F : 9.0F;
                return c.col < width && c.row < dem.height() ? dem[c] : in_bowl ? bowl : hole;
            });
        std::vector<std::int64_t> sinks_of_both;
        for (std::int64_t const sink : sinks) {
            sinks_of_both.push_back(both.grid().index(dem.grid().at(sink)));
        }
        FlowField const alone = route(dem, sinks);
        FlowField const beside = route(both, sinks_of_both);
        RC_ASSERT(alone.pits == 0);
        RC_ASSERT(alone.pit_volume_m3 == 0.0);
        RC_ASSERT(alone.depressions.empty());
        RC_ASSERT(beside.pits == 1);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            RC_ASSERT(alone.direction[i] == beside.direction[dem.grid().at(i)]);
            RC_ASSERT(alone.area_cells[i] == beside.area_cells[dem.grid().at(i)]);
        }
    }));
}

TEST(Route, LawsOnAnyDem) {
    ASSERT_TRUE(rc::check("every cell drains out, as counted by walking", [] {
        Raster<float> const dem = *gen_dem(9, 30);
        Grid const& grid = dem.grid();
        FlowField const d = route(dem);
        auto const level = filled_slowly(dem);

        Raster<std::int64_t> walked(grid);
        std::int64_t with_data = 0;
        std::int64_t leaving = 0;
        std::int64_t raised = 0;
        double volume = 0.0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT((d.direction[i] == Direction::no_data) == static_cast<bool>(std::isnan(dem[i])));
            if (std::isnan(dem[i])) {
                continue;
            }
            ++with_data;
            double const here = level[static_cast<std::size_t>(i)];
            raised += here > dem[i] ? 1 : 0;
            volume += here - dem[i];

            // Steepest descent on the filled DEM; level only where nothing is lower, and out only from the rim.
            double steepest = 0.0;
            int best = -1;
            bool rim = false;
            for (std::size_t k = 0; k < 8; ++k) {
                Cell const n = next_of(grid.at(i), flow::direction_of(k));
                if (!grid.contains(n) || std::isnan(dem[n])) {
                    rim = true;
                    continue;
                }
                double const drop = here - level[static_cast<std::size_t>(grid.index(n))];
                double const slope = k % 2 == 0 ? drop : drop / std::sqrt(2.0);
                if (slope > steepest) {
                    steepest = slope;
                    best = static_cast<int>(k);
                }
            }
            if (best >= 0) {
                RC_ASSERT(static_cast<int>(d.direction[i]) == best);
            } else if (d.direction[i] == Direction::leaves) {
                RC_ASSERT(rim);
            } else {
                Cell const n = next_of(grid.at(i), d.direction[i]);
                RC_ASSERT((grid.contains(n) && level[static_cast<std::size_t>(grid.index(n))] == here));
            }

            std::int64_t steps = 0;
            Cell c = grid.at(i);
            for (;; c = next_of(c, d.direction[c])) {
                ++walked[c];
                RC_ASSERT(++steps <= grid.cells());
                if (!goes_on(d.direction[c])) {
                    break;
                }
            }
            RC_ASSERT(d.direction[c] == Direction::leaves);
        }
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT(walked[i] == d.area_cells[i]);
            leaving += d.direction[i] == Direction::leaves ? d.area_cells[i] : 0;
        }
        RC_ASSERT(leaving == with_data);
        RC_ASSERT(d.pits == raised);
        RC_ASSERT(d.pit_volume_m3 == volume); // whole heights
    }));
}

TEST(Route, SameForAnyNumberOfThreads) {
    Raster<float> dem = rough_dem(frame(900, 700), 3);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const three = on_threads(3);
    FlowField const a = route(dem, one);
    FlowField const b = route(dem, three);
    EXPECT_EQ(directions(a), directions(b));
    EXPECT_EQ(areas(a), areas(b));
    EXPECT_EQ(a.pit_volume_m3, b.pit_volume_m3);
    EXPECT_GT(a.pits, 100'000);
}

TEST(Route, StopsWhenAsked) {
    thalweg::Run run;
    run.progress = [](double, char const*, void*) { return 0; };
    EXPECT_THROW(route(rough_dem(frame(1000, 1000), 3), run), Cancelled);
}

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

} // namespace route_test
