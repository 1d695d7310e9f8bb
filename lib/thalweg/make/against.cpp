// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/against.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

// Described in docs/rebuild.md.

namespace thalweg::make {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

Raster<float> only(Raster<float> const& dem, Mask const& compared) {
    Raster<float> part(dem.grid(), nothing);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        part[i] = compared[i] != 0 ? dem[i] : nothing;
    }
    return part;
}

ReliefShape shape_of(Raster<float> const& dem, Mask const& compared, Run const& run) {
    Raster<float> const part = only(dem, compared);
    measure::Slopes slopes = measure::slopes(part, run);
    measure::Hypsometry hypsometry = measure::hypsometry(part, run);
    return {slopes.mean_deg, hypsometry.integral, std::move(slopes.shares), std::move(hypsometry.points)};
}

/// base + gain x shape.
Raster<float> raised_by(Raster<float> const& base, Raster<float> const& shape, double gain) {
    Raster<float> sum(base.grid());
    for (std::int64_t i = 0; i < sum.cells(); ++i) {
        sum[i] = static_cast<float>(static_cast<double>(base[i]) + gain * static_cast<double>(shape[i]));
    }
    return sum;
}

/// base + gain x shape with this mean slope, where some gain gives it.
Raster<float> steepened(Raster<float> const& base, Raster<float> const& shape, double mean_slope_deg,
                        Mask const& compared, Run const& run) {
    constexpr int halvings = 14;
    constexpr double most_gain = 1e6;
    auto const slope = [&](double gain) {
        return measure::slopes(only(raised_by(base, shape, gain), compared), run).mean_deg;
    };
    double high = 0.5;
    while (slope(high) < mean_slope_deg && high < most_gain) {
        high *= 2.0;
    }
    double low = 0.0;
    for (int k = 0; k < halvings; ++k) {
        double const middle = (low + high) / 2.0;
        (slope(middle) < mean_slope_deg ? low : high) = middle;
    }
    return raised_by(base, shape, (low + high) / 2.0);
}

/// Height of the nearest river, and the distance to it.
struct NearRivers {
    Raster<float> z;
    Raster<float> distance_m;
};

NearRivers near_rivers_of(Valley const& valley, Run const& run) {
    Grid const& grid = valley.z.grid();
    Mask on_river(grid);
    std::ranges::transform(valley.z.values(), on_river.values().begin(), [](float z) { return std::isnan(z) ? 0 : 1; });
    Raster<std::int64_t> const nearest = nearest_cells(on_river, run);
    NearRivers near{Raster<float>(grid), Raster<float>(grid)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        near.z[i] = valley.z[nearest[i]];
        near.distance_m[i] = static_cast<float>(distance(grid.centre(grid.at(i)), grid.centre(grid.at(nearest[i]))));
    }
    return near;
}

/// A TIN of the rivers, and of the corners of the grid at the heights of their nearest rivers.
Raster<float> over_tin(ElevatedNetwork const& network, Raster<float> const& nearest_z, Run const& run) {
    Grid const& grid = nearest_z.grid();
    std::vector<Vec3> corners;
    for (Cell const c :
         {Cell{0, 0}, Cell{grid.width - 1, 0}, Cell{0, grid.height - 1}, Cell{grid.width - 1, grid.height - 1}}) {
        Vec2 const at = grid.centre(c);
        corners.push_back({at.x, at.y, static_cast<double>(nearest_z[c])});
    }
    std::vector<std::vector<Vec3>> lines;
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        std::vector<Vec2> const& plan = network.planform.arc(a).line;
        std::vector<Vec3>& line = lines.emplace_back();
        for (std::size_t v = 0; v < plan.size(); ++v) {
            line.push_back({plan[v].x, plan[v].y, network.arc_z[a][v]});
        }
    }
    return surface::rasterise_tin(geometry::triangulate(corners, lines, run).tin, grid,
                                  {surface::RasteriseTinParams::Outside::nearest}, run);
}

Raster<float> dilation(Valley const& valley, double mean_slope_deg, Mask const& compared, Run const& run) {
    Raster<float> const base = surface::harmonic(valley, run);
    surface::DilateParams params;
    params.relief_m = 1000.0;
    Raster<float> const dilated = surface::dilate_over(valley, base, params, run).dem;
    return steepened(base, raised_by(dilated, base, -1.0), mean_slope_deg, compared, run);
}

HeightPairs pairs_of(Raster<float> const& dem, Raster<float> const& terrain, Mask const& compared) {
    HeightPairs pairs;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (compared[i] != 0 && !std::isnan(terrain[i])) {
            low = std::min({low, static_cast<double>(dem[i]), static_cast<double>(terrain[i])});
            high = std::max({high, static_cast<double>(dem[i]), static_cast<double>(terrain[i])});
        }
    }
    pairs.counts.assign(static_cast<std::size_t>(pairs.side * pairs.side), 0);
    if (!(low < high)) {
        return pairs;
    }
    pairs.low_m = low;
    pairs.high_m = high;
    auto const number = [&](float z) {
        double const share = (static_cast<double>(z) - low) / (high - low);
        return std::min(pairs.side - 1, static_cast<std::int64_t>(share * static_cast<double>(pairs.side)));
    };
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (compared[i] != 0 && !std::isnan(terrain[i])) {
            ++pairs.counts[static_cast<std::size_t>(number(terrain[i]) * pairs.side + number(dem[i]))];
        }
    }
    return pairs;
}

} // namespace

Against compare_with_dem(Raster<float> const& of_file, std::string const& name, Terrain const& terrain,
                         Run const& run) {
    constexpr std::int64_t least_cells = 100;
    Raster<float> const& own = terrain.ground.dem;
    Grid const& grid = own.grid();
    Raster<float> const dem = io::resample(of_file, grid, fmt::format("output.against = \"{}\"", name), run);
    Mask compared = measure::compared_cells(dem);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        compared[i] = std::isnan(own[i]) ? 0 : compared[i];
    }
    Against found;
    found.dem = std::filesystem::path(name).filename().string();
    found.cells = std::ranges::count(compared.values(), 1);
    refuse_if<BadInput>(found.cells < least_cells, "make.compare_with_dem",
                        "output.against = \"{}\" has heights in {} cells of the grid that lie eight cells or more from "
                        "its border: {} are needed to compare with. Take a DEM of the same place",
                        name, found.cells, least_cells);
    found.real = shape_of(dem, compared, run);
    double const slope_deg = found.real.mean_slope_deg;
    Valley const valley{terrain.bed.valley.raster()};
    NearRivers const near = near_rivers_of(valley, run);
    std::vector<Raster<float>> terrains{own, steepened(near.z, near.distance_m, slope_deg, compared, run),
                                        over_tin(terrain.rivers.network, near.z, run),
                                        dilation(valley, slope_deg, compared, run)};
    for (Raster<float>& one : terrains) { // all have the DEM's gaps, where water leaves
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            one[i] = std::isnan(dem[i]) ? nothing : one[i];
        }
    }
    measure::ComparedTerrains measured =
        measure::compare_terrains(dem, terrains, flow::reaches_of(terrain.rivers.network.planform), run);
    std::vector<std::pair<char const*, char const*>> const names{
        {"terrain", "this terrain"}, {"cone", "cone"}, {"tin", "TIN"}, {"dilation", "dilation"}};
    for (std::size_t k = 0; k < terrains.size(); ++k) {
        found.terrains.push_back(
            {names[k].first, names[k].second, shape_of(terrains[k], compared, run), measured.terrains[k]});
    }
    found.pairs = pairs_of(dem, own, compared);
    found.difference = raised_by(own, dem, -1.0);
    found.divides_of_dem = std::move(measured.divides[0]);
    found.divides = std::move(measured.divides[1]);
    return found;
}

std::string line_of(Against const& against) {
    measure::Likeness const& own = against.terrains[0].like;
    measure::Likeness const& cone = against.terrains[1].like;
    return fmt::format(
        "{}: r {:.3f} (cone {:.3f}), above rivers {:.2f} ({:.2f}), same reach {:.1f} % ({:.1f}), divides "
        "{:.2f}/{:.2f} ({:.2f}/{:.2f}), mean slope {:.1f} of {:.1f} degrees",
        against.dem, own.correlation, cone.correlation, own.correlation_above_river, cone.correlation_above_river,
        100.0 * own.same_reach, 100.0 * cone.same_reach, own.divides_found, own.divides_right, cone.divides_found,
        cone.divides_right, against.terrains[0].shape.mean_slope_deg, against.real.mean_slope_deg);
}

} // namespace thalweg::make
