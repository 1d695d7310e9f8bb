// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/likeness/likeness.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>

// Described in docs/rebuild.md.

namespace thalweg::measure {
namespace {

constexpr std::int64_t border_cells = 8;
constexpr double off_river_cells = 3.0;      // beyond which heights above it count
constexpr double off_confluence_cells = 4.0; // beyond which divides do
constexpr std::int64_t within_cells = 3;     // of a divide

/// Sums of pairs of values.
struct Moments {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;

    void add(double a, double b) {
        n += 1.0;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    Moments& operator+=(Moments const& other) {
        n += other.n;
        x += other.x;
        y += other.y;
        xx += other.xx;
        yy += other.yy;
        xy += other.xy;
        return *this;
    }
    double correlation() const {
        double const spread = std::sqrt((n * xx - x * x) * (n * yy - y * y));
        return spread > 0.0 ? (n * xy - x * y) / spread : std::numeric_limits<double>::quiet_NaN();
    }
};

double part_of(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                     : std::numeric_limits<double>::quiet_NaN();
}

/// Shares of cells in classes of slopes, which are even in t / (1 + t) of the tangent t.
std::vector<std::int64_t> classes_of_slope(Raster<float> const& dem, Mask const& compared) {
    constexpr double classes = 8192.0;
    std::vector<std::int64_t> counts(static_cast<std::size_t>(classes));
    auto const around = d8_offsets(dem.grid());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const squared = compared[i] != 0 ? horn_squared(dem, i, around) : std::nan("");
        if (!std::isnan(squared)) {
            double const tangent = std::sqrt(squared);
            ++counts[static_cast<std::size_t>(classes * (tangent / (1.0 + tangent)))];
        }
    }
    return counts;
}

double largest_difference(std::vector<std::int64_t> const& one, std::vector<std::int64_t> const& other) {
    std::int64_t cells_of_one = 0;
    std::int64_t cells_of_other = 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
        cells_of_one += one[k];
        cells_of_other += other[k];
    }
    double most = cells_of_one > 0 && cells_of_other > 0 ? 0.0 : std::nan("");
    std::int64_t below_in_one = 0;
    std::int64_t below_in_other = 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
        below_in_one += one[k];
        below_in_other += other[k];
        double const difference =
            std::fabs(part_of(below_in_one, cells_of_one) - part_of(below_in_other, cells_of_other));
        most = difference > most ? difference : most;
    }
    return most;
}

/// Cells within a distance of marked ones.
Mask widened(Mask const& marked, std::int64_t within) {
    Grid const& grid = marked.grid();
    Mask wide(grid);
    for (std::int64_t i = 0; i < marked.cells(); ++i) {
        if (marked[i] == 0) {
            continue;
        }
        Cell const c = grid.at(i);
        for (std::int64_t y = -within; y <= within; ++y) {
            for (std::int64_t x = -within; x <= within; ++x) {
                Cell const near{c.col + x, c.row + y};
                if (x * x + y * y <= within * within && grid.contains(near)) {
                    wide[near] = 1;
                }
            }
        }
    }
    return wide;
}

/// The rivers that terrains are compared around.
struct RiverCells {
    Raster<std::int64_t> nearest; ///< cell of a river
    Raster<float> distance_cells; ///< to it
};

RiverCells near_rivers(flow::Reaches const& rivers, Grid const& grid, Run const& run) {
    Mask on_river(grid);
    for (flow::RiverCell const& river : flow::river_cells(rivers, grid, run)) {
        on_river[river.cell] = 1;
    }
    refuse_if<BadInput>(std::ranges::none_of(on_river.values(), [](std::uint8_t v) { return v != 0; }),
                        "measure.compare_terrains", "there are no rivers around which terrains could be compared");
    RiverCells found{nearest_cells(on_river, run), Raster<float>(grid)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const here = grid.at(i);
        Cell const there = grid.at(found.nearest[i]);
        auto const x = static_cast<double>(here.col - there.col);
        auto const y = static_cast<double>(here.row - there.row);
        found.distance_cells[i] = static_cast<float>(std::sqrt(x * x + y * y));
    }
    return found;
}

/// Cells on both sides of boundaries between catchments.
Mask divides_of(Raster<std::int32_t> const& reach, Raster<float> const& dem, Mask const& compared,
                RiverCells const& rivers) {
    Grid const& grid = dem.grid();
    Mask divides(grid);
    auto const mark = [&](std::int64_t i, std::int64_t j) {
        if (reach[i] != reach[j] && !std::isnan(dem[i]) && !std::isnan(dem[j])) {
            for (std::int64_t const k : {i, j}) {
                divides[k] =
                    compared[k] != 0 && static_cast<double>(rivers.distance_cells[k]) > off_confluence_cells ? 1 : 0;
            }
        }
    };
    for (std::int64_t row = 0; row < grid.height; ++row) {
        for (std::int64_t col = 0; col < grid.width; ++col) {
            std::int64_t const i = grid.index({col, row});
            if (col + 1 < grid.width) {
                mark(i, i + 1);
            }
            if (row + 1 < grid.height) {
                mark(i, i + grid.width);
            }
        }
    }
    return divides;
}

/// What is compared of one terrain.
struct ComparedTerrain {
    Raster<std::int32_t> reach;
    Mask divides;
    Mask near_divides;
    std::vector<std::int64_t> slopes;
};

ComparedTerrain drained(Raster<float> const& dem, Mask const& compared, flow::Reaches const& reaches,
                        RiverCells const& rivers, Run const& run) {
    ComparedTerrain found;
    found.reach = flow::catchments(reaches, flow::route(dem, run), run).reach;
    found.divides = divides_of(found.reach, dem, compared, rivers);
    found.near_divides = widened(found.divides, within_cells);
    found.slopes = classes_of_slope(dem, compared);
    return found;
}

double share_near(Mask const& divides, Mask const& near) {
    std::int64_t all = 0;
    std::int64_t close = 0;
    for (std::int64_t i = 0; i < divides.cells(); ++i) {
        all += divides[i];
        close += divides[i] != 0 && near[i] != 0 ? 1 : 0;
    }
    return part_of(close, all);
}

/// Correlations and differences of heights.
void compare_heights(Raster<float> const& dem, Raster<float> const& terrain, Mask const& compared,
                     RiverCells const& rivers, Likeness& found, Run const& run) {
    struct Sums {
        Moments heights;
        Moments above;
        double difference = 0.0;
        double squared = 0.0;
        Sums& operator+=(Sums const& other) {
            heights += other.heights;
            above += other.above;
            difference += other.difference;
            squared += other.squared;
            return *this;
        }
    };
    auto const origin = static_cast<double>(dem[std::ranges::find(compared.values(), 1) - compared.values().begin()]);
    std::int64_t const width = dem.width();
    Sums const sums = sum_rows(run, dem.height(), [&](std::int64_t row) {
        Sums here;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            auto const a = static_cast<double>(dem[i]);
            auto const b = static_cast<double>(terrain[i]);
            if (compared[i] == 0 || std::isnan(b)) {
                continue;
            }
            here.heights.add(a - origin, b - origin); // large common heights would cost digits
            here.difference += b - a;
            here.squared += (b - a) * (b - a);
            std::int64_t const river = rivers.nearest[i];
            double const above = a - static_cast<double>(dem[river]);
            double const above_in_terrain = b - static_cast<double>(terrain[river]);
            if (static_cast<double>(rivers.distance_cells[i]) > off_river_cells && !std::isnan(above) &&
                !std::isnan(above_in_terrain)) {
                here.above.add(above, above_in_terrain);
            }
        }
        return here;
    });
    if (sums.heights.n > 0.0) {
        found.correlation = sums.heights.correlation();
        found.correlation_above_river = sums.above.correlation();
        found.bias_m = sums.difference / sums.heights.n;
        found.rmse_m = std::sqrt(sums.squared / sums.heights.n);
    }
}

} // namespace

Mask compared_cells(Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    Mask compared(grid);
    for (std::int64_t row = border_cells; row + border_cells < grid.height; ++row) {
        for (std::int64_t col = border_cells; col + border_cells < grid.width; ++col) {
            compared[Cell{col, row}] = std::isnan(dem[Cell{col, row}]) ? 0 : 1;
        }
    }
    return compared;
}

ComparedTerrains compare_terrains(Raster<float> const& dem, std::vector<Raster<float>> const& terrains,
                                  flow::Reaches const& rivers, Run const& run) {
    for (Raster<float> const& terrain : terrains) {
        require_same_grid(terrain.grid(), dem.grid(), "measure.compare_terrains", "a terrain and the DEM",
                          "make both on one grid");
    }
    Mask const compared = compared_cells(dem);
    RiverCells const near = near_rivers(rivers, dem.grid(), run);
    ComparedTerrain const real = drained(dem, compared, rivers, near, run);
    ComparedTerrains found;
    found.cells = std::ranges::count(compared.values(), 1);
    found.divides.push_back(real.divides);
    for (Raster<float> const& terrain : terrains) {
        Likeness& like = found.terrains.emplace_back();
        if (found.cells == 0) {
            found.divides.emplace_back(dem.grid());
            continue;
        }
        ComparedTerrain made = drained(terrain, compared, rivers, near, run);
        compare_heights(dem, terrain, compared, near, like, run);
        std::int64_t drains = 0;
        std::int64_t same = 0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (compared[i] != 0 && real.reach[i] >= 0) {
                ++drains;
                same += real.reach[i] == made.reach[i] ? 1 : 0;
            }
        }
        like.same_reach = part_of(same, drains);
        like.divides_found = share_near(real.divides, made.near_divides);
        like.divides_right = share_near(made.divides, real.near_divides);
        like.slopes_difference = largest_difference(real.slopes, made.slopes);
        found.divides.push_back(std::move(made.divides));
    }
    return found;
}

} // namespace thalweg::measure
