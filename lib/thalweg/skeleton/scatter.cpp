// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/skeleton/internal/place_points.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t height_stage = 0x7363617474657233; // "scatter3"

bool inside(Grid const& grid, Vec2 p) {
    return p.x >= grid.west && p.x < grid.east() && p.y <= grid.north && p.y > grid.south();
}

double normal(std::uint64_t seed, std::uint64_t place) {
    auto const words = random_block(seed, height_stage, place);
    double const u = 1.0 - unit(words[0]); // (0, 1]
    return std::sqrt(-2.0 * portable::log(u)) * portable::cos(2.0 * portable::pi * unit(words[1]));
}

/// Numbers by the law: uniform in [-1, 1), or normal.
std::vector<double> drawn(std::size_t count, ScatterParams const& params) {
    std::vector<double> z(count);
    for (std::size_t i = 0; i < count; ++i) {
        z[i] = params.law == HeightLaw::normal ? normal(params.seed, i)
                                               : 2.0 * unit(random_word(params.seed, height_stage, i)) - 1.0;
    }
    return z;
}

/// Brings numbers to mean 0. Gives: their deviation.
double centre(std::vector<double>& z) {
    auto const count = static_cast<double>(z.size());
    double mean = 0.0;
    for (double const v : z) {
        mean += v / count;
    }
    double square = 0.0;
    for (double& v : z) {
        v -= mean;
        square += v * v / count;
    }
    return std::sqrt(square);
}

std::vector<double> heights(std::size_t count, ScatterParams const& params) {
    std::vector<double> z = drawn(count, params);
    double scale = params.std_m;
    if (params.deviation == Deviation::exact) {
        double const deviation = centre(z);
        scale = deviation > 0.0 ? params.std_m / deviation : 0.0;
    }
    for (double& v : z) {
        v = params.mean_m + v * scale;
    }
    return z;
}

void demand(Grid const& grid, ScatterParams const& p, double spacing_m) {
    auto const refuse = [](std::string const& what) { throw BadParameter("skeleton.scatter: " + what); };
    if (grid.cells() <= 0 || !(grid.cell_m > 0.0)) {
        refuse("the grid has no cells");
    }
    std::int64_t const extremes = (p.highest ? 1 : 0) + (p.lowest ? 1 : 0);
    if (p.count < std::max<std::int64_t>(1, extremes)) {
        refuse(fmt::format("{} points with {} extremes: give 1 or more, the extremes included", p.count, extremes));
    }
    require_in("skeleton.scatter", "spacing", p.spacing_cells, Range::at_least(0.0), "cells");
    require_in("skeleton.scatter", "reach", p.reach_cells, Range::at_least(0.0), "cells");
    require_in("skeleton.scatter", "deviation", p.std_m, Range::at_least(0.0), "m");
    require_in("skeleton.scatter", "mean", p.mean_m, Range::finite(), "m");
    for (auto const& extreme : {p.highest, p.lowest}) {
        if (extreme && !(inside(grid, {extreme->x, extreme->y}) && std::isfinite(extreme->z))) {
            refuse(fmt::format("the extreme at ({}, {}) with {} m does not lie on the grid", extreme->x, extreme->y,
                               extreme->z));
        }
    }
    if (p.highest && p.lowest) {
        double const apart = distance({p.highest->x, p.highest->y}, {p.lowest->x, p.lowest->y});
        if (apart == 0.0 || apart < spacing_m) {
            refuse(fmt::format("highest and lowest are {} m apart, the spacing is {} m", apart, spacing_m));
        }
    }
    double const top = p.highest ? p.highest->z : std::numeric_limits<double>::max();
    double const bottom = p.lowest ? p.lowest->z : std::numeric_limits<double>::lowest();
    if (!(bottom < p.mean_m && p.mean_m < top)) {
        refuse(fmt::format("the mean {} m does not lie between the lowest {} m and the highest {} m", p.mean_m, bottom,
                           top));
    }
}

/// Equation 10: draws a height to an extreme, the whole way at its place, at the reach by 1/e as printed, or not at
/// all.
void attract(Vec3& point, Vec3 const& extreme, double reach_m, Falloff falloff) {
    double const away = distance({point.x, point.y}, {extreme.x, extreme.y});
    if (away <= reach_m) {
        double const share = away / reach_m;
        double const at_reach = falloff == Falloff::literal ? 0.0 : portable::exp(-1.0);
        point.z += (portable::exp(-share * share) - at_reach) / (1.0 - at_reach) * (extreme.z - point.z);
    }
}

} // namespace

Scattered scatter(Grid const& grid, ScatterParams const& params, Run const& run) {
    double const spacing_m = params.spacing_cells * grid.cell_m;
    demand(grid, params, spacing_m);
    std::vector<Vec3> extremes;
    PlacePointsParams placing{params.seed, params.count, params.spacing_cells};
    for (auto const& extreme : {params.highest, params.lowest}) {
        if (extreme) {
            extremes.push_back(*extreme);
            placing.standing.push_back({extreme->x, extreme->y});
        }
    }
    PlacedPoints const placed = place_points(grid, {}, placing, run);
    std::vector<Vec2> const& places = placed.places;
    Scattered result;
    result.points.crs = grid.crs;
    result.missing = placed.missing;
    result.density = placed.density;

    std::vector<double> const z = heights(places.size(), params);
    result.points.points = extremes;
    double const top = params.highest ? params.highest->z : std::numeric_limits<double>::max();
    double const bottom = params.lowest ? params.lowest->z : std::numeric_limits<double>::lowest();
    double const hair = params.highest && params.lowest ? 1e-6 * (top - bottom) : 1e-6;
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec3 point{places[i].x, places[i].y, z[i]};
        for (Vec3 const& extreme : extremes) {
            if (params.reach_cells > 0.0) {
                attract(point, extreme, params.reach_cells * grid.cell_m, params.falloff);
            }
        }
        point.z = std::clamp(point.z, bottom + hair, top - hair);
        result.points.points.push_back(point);
    }
    return result;
}

} // namespace thalweg::skeleton
