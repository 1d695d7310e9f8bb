// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/flow/route.hpp>

namespace thalweg::flow {
namespace {

constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

[[noreturn]] void refuse(std::string const& why) {
    throw BadInput("flow.route_dinf", fmt::format("{}; take the drainage of this DEM", why));
}

/// Computes the filled levels of the framed DEM from the outlets upstream.
Raster<float> levels(Raster<float> const& dem, Raster<Direction> const& direction, Run const& run) {
    auto const offsets = d8_offsets(dem.grid());
    Raster<float> level(dem.grid(), no_height);
    std::vector<std::int64_t> way;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        way.clear();
        std::int64_t at = i;
        while (direction[at] != Direction::no_data && std::isnan(level[at])) {
            way.push_back(at);
            if (direction[at] == Direction::leaves) {
                break;
            }
            at += offsets[index_of(direction[at])];
            if (direction[at] == Direction::no_data) {
                refuse("a direction leads to no data");
            }
            if (static_cast<std::int64_t>(way.size()) > dem.cells()) {
                refuse("the directions lead in a circle");
            }
        }
        float below = way.empty() || way.back() == at ? -std::numeric_limits<float>::infinity() : level[at];
        for (auto cell = way.rbegin(); cell != way.rend(); ++cell) {
            below = std::max(dem[*cell], below);
            level[*cell] = below;
        }
    }
    return level;
}

/// Finds the bearing of the steepest facet; dinf_leaves: no neighbour is lower. drop: to each neighbour, NaN where it
/// has no data.
float steepest(std::array<double, 8> const& drop, std::array<double, 8> const& height) {
    constexpr double eighth_turn = portable::pi / 4.0;
    double best = 0.0; // square of the slope
    std::size_t facet = drop.size();
    double along = 0.0; // slopes of the best facet: towards its direct neighbour, and from there to the diagonal one
    double across = 0.0;
    for (std::size_t k = 0; k < drop.size(); ++k) {
        std::size_t const next = (k + 1) % drop.size();
        std::size_t const direct = k % 2 == 0 ? k : next;
        std::size_t const diagonal = k % 2 == 0 ? next : k;
        double s1 = drop[direct];
        double s2 = height[direct] - height[diagonal];
        if (!(s2 > 0.0)) { // down the edge to the direct neighbour, also beside a diagonal one without data
            s2 = 0.0;
        } else if (!(s1 > s2)) { // down the diagonal
            s1 = s2 = 0.5 * drop[diagonal];
        }
        if (std::isnan(s1) && drop[diagonal] > 0.0) {
            s1 = s2 = 0.5 * drop[diagonal];
        }
        if (double const slope = s1 * s1 + s2 * s2; s1 > 0.0 && slope > best) {
            best = slope;
            facet = k;
            along = s1;
            across = s2;
        }
    }
    if (facet == drop.size()) {
        return dinf_leaves;
    }
    double const turn = across == 0.0 ? 0.0 : across == along ? 1.0 : portable::atan2(across, along) / eighth_turn;
    auto const bearing = static_cast<float>(static_cast<double>(facet) + (facet % 2 == 0 ? turn : 1.0 - turn));
    return bearing < 8.0F ? bearing : 0.0F;
}

Raster<float> bearings(Raster<float> const& level, Raster<Direction> const& direction, Run const& run) {
    auto const offsets = d8_offsets(level.grid());
    Raster<float> bearing(level.grid(), no_height);
    parallel_ranges(run, level.cells(), cells_between_checks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (direction[i] == Direction::no_data) {
                continue;
            }
            std::array<double, 8> height{};
            std::array<double, 8> drop{};
            for (std::size_t k = 0; k < offsets.size(); ++k) {
                height[k] = static_cast<double>(level[i + offsets[k]]);
                drop[k] = static_cast<double>(level[i]) - height[k];
            }
            bearing[i] = steepest(drop, height);
            if (bearing[i] == dinf_leaves && goes_on(direction[i])) {
                bearing[i] = static_cast<float>(index_of(direction[i]));
            }
        }
    });
    return bearing;
}

/// The two receivers of a cell, as index offsets, and the share of the second.
struct FlowSplit {
    std::int64_t first;
    std::int64_t second;
    double share;
};

FlowSplit flow_split(float bearing, std::array<std::int64_t, 8> const& offsets) {
    auto const k = static_cast<std::size_t>(bearing);
    return {offsets[k], offsets[(k + 1) % offsets.size()], static_cast<double>(bearing) - static_cast<double>(k)};
}

Raster<double> accumulate(Raster<float> const& bearing, Run const& run) {
    auto const offsets = d8_offsets(bearing.grid());
    Raster<double> area(bearing.grid());
    Raster<std::uint8_t> awaited(bearing.grid()); // neighbours whose water has not arrived yet
    std::int64_t left = 0;
    for (std::int64_t i = 0; i < bearing.cells(); ++i) {
        if (std::isnan(bearing[i])) {
            continue;
        }
        area[i] = 1.0;
        ++left;
        if (bearing[i] >= 0.0F) {
            FlowSplit const p = flow_split(bearing[i], offsets);
            ++awaited[i + p.first];
            if (p.share > 0.0) {
                ++awaited[i + p.second];
            }
        }
    }
    std::vector<std::int64_t> ready;
    auto const arrive = [&](std::int64_t at, double water) {
        area[at] += water;
        if (--awaited[at] == 0) {
            ready.push_back(at);
        }
    };
    constexpr std::uint8_t done = 255;
    for (std::int64_t i = 0; i < bearing.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (std::isnan(bearing[i]) || awaited[i] != 0) {
            continue;
        }
        ready.push_back(i);
        while (!ready.empty()) {
            std::int64_t const at = ready.back();
            ready.pop_back();
            awaited[at] = done;
            --left;
            if (bearing[at] < 0.0F) {
                continue;
            }
            FlowSplit const p = flow_split(bearing[at], offsets);
            double const second = p.share * area[at];
            arrive(at + p.first, area[at] - second);
            if (p.share > 0.0) {
                arrive(at + p.second, second);
            }
        }
    }
    if (left != 0) {
        refuse(fmt::format("water of {} cells runs in a circle", left));
    }
    return area;
}

} // namespace

DinfFlow route_dinf(Raster<float> const& dem, FlowField const& d8, Run const& run) {
    Grid const& grid = dem.grid();
    require_same_grid(grid, d8.direction.grid(), "flow.route_dinf", "the DEM and its directions", "route this DEM");
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Direction const way = d8.direction[i];
        bool const any = way == Direction::leaves || goes_on(way);
        if (std::isnan(dem[i]) ? way != Direction::no_data : !any) {
            Cell const cell = grid.at(i);
            refuse(fmt::format("the direction at column {}, row {} is {}", cell.col, cell.row, static_cast<int>(way)));
        }
    }
    auto const direction = framed(d8.direction, Direction::no_data);
    Raster<float> bearing = bearings(levels(framed(dem, no_height), direction, run), direction, run);
    DinfFlow result;
    result.area_cells = unframed(accumulate(bearing, run), grid);
    result.bearing = unframed(bearing, grid);
    return result;
}

} // namespace thalweg::flow
