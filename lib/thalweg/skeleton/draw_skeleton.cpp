// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/draw_skeleton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/skeleton/internal/perlin.hpp>

namespace thalweg::skeleton {
namespace {

constexpr std::uint64_t noise_stage = 0x6e6f697365616c31; // "noiseal1"
constexpr double sum_of_gains = 1.875;                    // of four octaves
constexpr double widest_shift = 256.0;                    // [wavelengths] period of libnoise's noise

void require(NoiseAlongParams const& params) {
    require_in("skeleton.noise_along", "amplitude_m", params.amplitude_m, Range::at_least(0.0));
    require_in("skeleton.noise_along", "wavelength_m", params.wavelength_m, Range::above(0.0));
}

/// A position in wavelengths from the origin.
Vec2 scaled(PlaceOnLine const& place, std::size_t number, Vec2 origin, double wavelength_m) {
    constexpr double farthest = 0x1p20; // libnoise wraps coordinates beyond 2^30, after three doublings
    Vec2 const at{(place.at.x - origin.x) / wavelength_m, (place.at.y - origin.y) / wavelength_m};
    refuse_if<BadInput>(!(std::fabs(at.x) <= farthest && std::fabs(at.y) <= farthest), "skeleton.noise_along",
                        "place {} at ({}, {}) is not within 2^20 wavelengths of {} m from ({}, {}); lengthen the wave",
                        number, place.at.x, place.at.y, wavelength_m, origin.x, origin.y);
    refuse_if<BadInput>(!(place.share >= 0.0 && place.share <= 1.0), "skeleton.noise_along",
                        "place {} at ({}, {}) has a share of {}; give one from 0 to 1", number, place.at.x, place.at.y,
                        place.share);
    return at;
}

/// Bits for the features that meet in a cell.
constexpr std::uint8_t river = 1;
constexpr std::uint8_t ridge = 2;
constexpr std::uint8_t point = 4;

/// Keeps the highest height of one kind of feature in each cell.
void raise(Raster<float>& z, std::int64_t cell, double height) {
    // -0 becomes 0, so that the order of equal heights does not matter
    auto const rounded = static_cast<float>(height) + 0.0F;
    if (std::isnan(z[cell]) || rounded > z[cell]) {
        z[cell] = rounded;
    }
}

void require_height(Vec3 const& p, std::string const& what) {
    constexpr double highest = std::numeric_limits<float>::max();
    refuse_if<BadInput>(!(std::fabs(p.z) <= highest), "skeleton.draw_skeleton",
                        "{} at ({:.3f}, {:.3f}) has a height of {}; give every vertex and point a number", what, p.x,
                        p.y, p.z);
}

std::vector<Cell> cells_of(std::vector<Vec3> const& line, Grid const& grid, std::string const& what) {
    std::vector<Cell> cells = cells_of_vertices(in_plan(line), grid, what);
    for (Vec3 const& p : line) {
        require_height(p, what);
    }
    return cells;
}

/// The cells of a ridge, before noise.
struct Trail {
    std::vector<std::int64_t> cells;
    std::vector<PlaceOnLine> places;
    std::vector<double> z;
};

Trail trail_of(std::vector<Vec3> const& line, std::vector<Cell> const& at, Grid const& grid) {
    std::vector<double> behind{0.0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        behind.push_back(behind.back() + distance({line[i - 1].x, line[i - 1].y}, {line[i].x, line[i].y}));
    }
    double const length = behind.back();
    auto const share = [length](double way) { return length > 0.0 ? std::clamp(way / length, 0.0, 1.0) : 0.0; };
    Trail trail;
    auto const put = [&](Cell c, Vec3 const& p, double way) {
        trail.cells.push_back(grid.index(c));
        trail.places.push_back({{p.x, p.y}, share(way)});
        trail.z.push_back(p.z);
    };
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const& a = line[i - 1];
        Vec3 const& b = line[i];
        walk_cells(at[i - 1], at[i], [&](Cell c, std::int64_t k, std::int64_t n) {
            if (k > 0 && k == n) {
                return; // the next segment begins there
            }
            double const t = n == 0 ? 0.0 : static_cast<double>(k) / static_cast<double>(n);
            double const z = std::clamp(a.z + t * (b.z - a.z), std::min(a.z, b.z), std::max(a.z, b.z));
            put(c, {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), z}, behind[i - 1] + t * (behind[i] - behind[i - 1]));
        });
    }
    put(at.back(), line.back(), length);
    return trail;
}

Raster<float> drawn_ridges(RidgeLines const& ridges, Grid const& grid, NoiseAlongParams const& params, Run const& run) {
    Raster<float> z(grid, std::numeric_limits<float>::quiet_NaN());
    noise_along({}, {}, params, run); // checks parameters even without ridges
    for (std::size_t number = 1; RidgeLine const& ridge_line : ridges.lines) {
        std::string const what = fmt::format("ridge {}", number++);
        std::vector<Vec3> const& line = ridge_line.line;
        refuse_if<BadInput>(line.empty(), "skeleton.draw_skeleton", "{} has no vertices; leave it out", what);
        Trail const trail = trail_of(line, cells_of(line, grid, what), grid);
        std::vector<double> const noise = noise_along(trail.places, {grid.west, grid.north}, params, run);
        for (std::size_t i = 0; i < trail.cells.size(); ++i) {
            raise(z, trail.cells[i], trail.z[i] + noise[i]);
        }
    }
    return z;
}

Raster<float> drawn_points(FeaturePoints const& points, Grid const& grid) {
    Raster<float> z(grid, std::numeric_limits<float>::quiet_NaN());
    refuse_if<BadInput>(!points.crs.empty() && !grid.crs.empty() && points.crs != grid.crs, "skeleton.draw_skeleton",
                        "the points are in {}, the valley in {}; reproject one of them", points.crs, grid.crs);
    for (std::size_t number = 1; Vec3 const& p : points.points) {
        raise(z, grid.index(cells_of({p}, grid, fmt::format("point {}", number++)).front()), p.z);
    }
    return z;
}

bool below_a_river(Cell c, Raster<float> const& z, Mask const& what) {
    for (std::int64_t row = c.row - 1; row <= c.row + 1; ++row) {
        for (std::int64_t col = c.col - 1; col <= c.col + 1; ++col) {
            Cell const other{col, row};
            if (z.grid().contains(other) && (what[other] & river) != 0 && z[c] < z[other]) {
                return true;
            }
        }
    }
    return false;
}

} // namespace

std::vector<double> noise_along(std::vector<PlaceOnLine> const& places, Vec2 origin, NoiseAlongParams const& params,
                                Run const& run) {
    require(params);
    run.check();
    auto const words = random_block(params.seed, noise_stage);
    // libnoise truncates its seed to 16 bits, and its noise is 0 at whole coordinates.
    double const shift_x = widest_shift * unit(words[1]);
    double const shift_y = widest_shift * unit(words[2]);
    double const level = unit(words[3]);
    std::vector<Vec3> shifted(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec2 const at = scaled(places[i], i, origin, params.wavelength_m);
        shifted[i] = {at.x + shift_x, at.y + shift_y, level};
    }
    std::vector<double> noise(places.size(), 0.0);
    if (!(params.amplitude_m > 0.0)) {
        return noise;
    }
    noise = perlin(shifted, static_cast<int>(words[0] >> 33U), run);
    for (std::size_t i = 0; i < places.size(); ++i) {
        // libnoise sometimes exceeds its nominal bound of 1.
        double const share = places[i].share;
        noise[i] = params.amplitude_m * std::clamp(noise[i] / sum_of_gains, -1.0, 1.0) * (4.0 * share * (1.0 - share));
    }
    return noise;
}

DrawnSkeleton draw_skeleton(Valley const& valley, RidgeLines const& ridges, FeaturePoints const& points,
                            DrawSkeletonParams const& params, Run const& run) {
    Grid const& grid = valley.z.grid();
    Raster<float> const ridge_z = drawn_ridges(ridges, grid, params.noise, run);
    Raster<float> const point_z = drawn_points(points, grid);
    DrawnSkeleton out;
    out.skeleton.z = valley.z;
    Raster<float>& z = out.skeleton.z;
    Mask what(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isinf(z[i])) {
            throw BadInput(
                "skeleton.draw_skeleton",
                fmt::format("infinite height in the valley at column {}, row {}; every river needs finite heights",
                            grid.at(i).col, grid.at(i).row));
        }
        bool const has_ridge = !std::isnan(ridge_z[i]);
        bool const has_point = !std::isnan(point_z[i]);
        if (!std::isnan(z[i])) {
            what[i] = river;
            ++out.river_cells;
            out.under_rivers += has_ridge || has_point ? 1 : 0;
        } else if (has_point) {
            what[i] = point;
            ++out.point_cells;
            z[i] = point_z[i];
        } else if (has_ridge) {
            what[i] = ridge;
            ++out.ridge_cells;
            z[i] = ridge_z[i];
        }
    }
    run.check();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (what[i] == ridge && below_a_river(grid.at(i), z, what)) {
            ++out.below_river;
        }
    }
    return out;
}

} // namespace thalweg::skeleton
