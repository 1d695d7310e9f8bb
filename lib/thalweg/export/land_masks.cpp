// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/land_masks.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::exports {
namespace {

constexpr double degrees = 180.0 / portable::pi;
constexpr double least_tangent = 0.001; // of wetness: level land is not infinitely wet

/// The heights around a cell; where there are none, those of a plane through the opposite neighbour, or its own.
class Around {
public:
    Around(Raster<float> const& dem, Cell c) : dem_(dem), c_(c), z_(dem[c]) {}

    double operator()(std::int64_t east, std::int64_t south) const {
        if (double const z = at(east, south); !std::isnan(z)) {
            return z;
        }
        double const opposite = at(-east, -south);
        if (!std::isnan(opposite)) {
            return 2.0 * z_ - opposite;
        }
        return east == 0 || south == 0 ? z_ : (*this)(east, 0) + (*this)(0, south) - z_;
    }
    /// [m/m] by Horn's formula
    double tangent() const {
        double const scale = 1.0 / (8.0 * dem_.grid().cell_m);
        double const x = scale * ((*this)(1, -1) + 2.0 * (*this)(1, 0) + (*this)(1, 1) - (*this)(-1, -1) -
                                  2.0 * (*this)(-1, 0) - (*this)(-1, 1));
        double const y = scale * ((*this)(-1, 1) + 2.0 * (*this)(0, 1) + (*this)(1, 1) - (*this)(-1, -1) -
                                  2.0 * (*this)(0, -1) - (*this)(1, -1));
        return std::sqrt(x * x + y * y);
    }
    /// [1/m] of the mean of the eight neighbours, against the cell: positive on ridges
    double bend() const {
        double const cell_m = dem_.grid().cell_m;
        double const near = (*this)(1, 0) + (*this)(-1, 0) + (*this)(0, 1) + (*this)(0, -1) - 4.0 * z_;
        double const far = (*this)(1, 1) + (*this)(-1, 1) + (*this)(1, -1) + (*this)(-1, -1) - 4.0 * z_;
        return -(near + 0.5 * far) / (2.0 * cell_m * cell_m);
    }

private:
    double at(std::int64_t east, std::int64_t south) const {
        Cell const n{c_.col + east, c_.row + south};
        return dem_.grid().contains(n) ? dem_[n] : std::numeric_limits<double>::quiet_NaN();
    }

    Raster<float> const& dem_;
    Cell c_;
    double z_;
};

/// A number by cell with data; 0 elsewhere.
Raster<float> by_cell(Raster<float> const& dem, Run const& run, std::function<double(std::int64_t)> const& number) {
    Raster<float> out(dem.grid(), 0.0F);
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        for (std::int64_t i = begin * dem.width(); i < end * dem.width(); ++i) {
            if (!std::isnan(dem[i])) {
                out[i] = static_cast<float>(number(i));
            }
        }
    });
    return out;
}

/// The value below which this share of the numbers of cells with data lies.
double below(Raster<float> const& dem, Raster<float> const& values, double share) {
    std::vector<float> sorted;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(dem[i])) {
            sorted.push_back(values[i]);
        }
    }
    if (sorted.empty()) {
        return 0.0;
    }
    auto const place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::ranges::nth_element(sorted, sorted.begin() + place);
    return sorted[static_cast<std::size_t>(place)];
}

void stretch(Raster<float> const& dem, LandMaskMade& mask, float without_data = 0.0F) {
    double const range = mask.high - mask.low;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const share = range > 0.0 ? (mask.share[i] - mask.low) / range : 0.0;
        mask.share[i] = std::isnan(dem[i]) ? without_data : static_cast<float>(std::clamp(share, 0.0, 1.0));
    }
}

/// Contributing areas on a logarithmic scale.
LandMaskMade areas_in_logs(Raster<float> const& dem, flow::FlowField const& field, char const* meaning,
                           Run const& run) {
    double const cell_m2 = dem.grid().cell_m * dem.grid().cell_m;
    std::int64_t const most = std::max<std::int64_t>(2, *std::ranges::max_element(field.area_cells.values()));
    double const whole = portable::log(static_cast<double>(most));
    return {by_cell(dem, run,
                    [&](std::int64_t i) { return portable::log(static_cast<double>(field.area_cells[i])) / whole; }),
            cell_m2, static_cast<double>(most) * cell_m2, "m2, on a logarithmic scale", meaning};
}

double wetness_of(flow::FlowField const& field, Raster<float> const& dem, std::int64_t i) {
    double const tangent = std::max(Around(dem, dem.grid().at(i)).tangent(), least_tangent);
    return portable::log(static_cast<double>(field.area_cells[i]) * dem.grid().cell_m / tangent);
}

enum LandKindNumber : std::uint8_t {
    kind_none,
    kind_water,
    kind_shore,
    kind_wetland,
    kind_meadow,
    kind_forest,
    kind_alpine,
    kind_scree,
    kind_rock,
    kind_snow
};

/// What grows or lies at a place on land.
LandKindNumber kind_of(double z, double slope_deg, double wetness, double above_sea_m, double tree_line_m) {
    constexpr double snow_above_trees_m = 1000.0;
    if (slope_deg > 42.0) {
        return kind_rock;
    }
    if (z > tree_line_m + snow_above_trees_m) {
        return kind_snow;
    }
    if (slope_deg > (z > tree_line_m ? 30.0 : 36.0)) {
        return kind_scree;
    }
    if (z > tree_line_m) {
        return kind_alpine;
    }
    if (above_sea_m < 4.0 && slope_deg < 6.0) {
        return kind_shore;
    }
    if (wetness > 11.0 && slope_deg < 2.0) {
        return kind_wetland;
    }
    return slope_deg < 6.0 ? kind_meadow : kind_forest;
}

} // namespace

std::vector<LandMaskName> const& land_masks() {
    static std::vector<LandMaskName> const names{{LandMask::slope, "slope"},
                                                 {LandMask::flow, "flow"},
                                                 {LandMask::wetness, "wetness"},
                                                 {LandMask::curvature, "curvature"},
                                                 {LandMask::water, "water"},
                                                 {LandMask::river_distance, "river_distance"},
                                                 {LandMask::river_width, "river_width"},
                                                 {LandMask::ridge, "ridge"},
                                                 {LandMask::land_cover, "land_cover"}};
    return names;
}

std::vector<LandKind> const& land_kinds() {
    static std::vector<LandKind> const kinds{{"none", 0x000000, "no data"},
                                             {"water", 0x2f5f78, "sea, lakes, and rivers at least half a cell wide"},
                                             {"shore", 0xc9b98f, "less than 4 m above the sea, slope below 6 degrees"},
                                             {"wetland", 0x5f6f3f, "slope below 2 degrees, wetness above 11"},
                                             {"meadow", 0x7f8c50, "slope below 6 degrees"},
                                             {"forest", 0x4a5e33, "other slopes"},
                                             {"alpine", 0x93925f, "above the tree line"},
                                             {"scree", 0x9c948a, "slope above 36 degrees, above the tree line 30"},
                                             {"rock", 0x77716b, "slope above 42 degrees"},
                                             {"snow", 0xf2f4f6, "1000 m above the tree line and higher"}};
    return kinds;
}

flow::FlowField const& LandMasks::field(Run const& run) {
    if (!field_) {
        field_ = flow::route(*scene_.dem, run);
    }
    return *field_;
}

LandMasks::Beside const& LandMasks::beside(Run const& run) {
    if (beside_) {
        return *beside_;
    }
    Grid const& grid = scene_.dem->grid();
    Mask marked(grid, 0);
    Raster<float> widths(grid, 0.0F);
    for (RiverSpline const& river : rivers_) {
        for (std::size_t i = 1; i < river.line.size(); ++i) {
            Vec2 const a = in_plan(river.line[i - 1]);
            Vec2 const b = in_plan(river.line[i]);
            double const steps = std::floor(2.0 * distance(a, b) / grid.cell_m) + 1.0;
            for (double k = 0.0; k <= steps; ++k) {
                Cell c = grid.cell_of(a + (k / steps) * (b - a));
                if (c.col < -1 || c.row < -1 || c.col > grid.width || c.row > grid.height) {
                    continue; // outside; an outlet on the border is in its cell
                }
                c.col = std::clamp<std::int64_t>(c.col, 0, grid.width - 1);
                c.row = std::clamp<std::int64_t>(c.row, 0, grid.height - 1);
                double const width = river.width_m[i - 1] + (k / steps) * (river.width_m[i] - river.width_m[i - 1]);
                marked[c] = 1;
                widths[c] = std::max(widths[c], static_cast<float>(width));
            }
        }
    }
    refuse_if<BadInput>(std::ranges::find(marked.values(), 1) == marked.values().end(), "export.run_export",
                        "there are no rivers: masks river_distance and river_width need a folder written by make");
    beside_ = Beside{nearest_cells(marked, run), std::move(widths)};
    return *beside_;
}

LandMaskMade LandMasks::slope(Run const& run) const {
    Raster<float> const& dem = *scene_.dem;
    return {by_cell(dem, run,
                    [&](std::int64_t i) {
                        return portable::atan2(Around(dem, dem.grid().at(i)).tangent(), 1.0) * degrees / 90.0;
                    }),
            0.0, 90.0, "degrees", "slope by Horn's formula"};
}

LandMaskMade LandMasks::contributing(Run const& run) {
    return areas_in_logs(*scene_.dem, field(run), "contributing area by D8", run);
}

LandMaskMade LandMasks::ridge(Run const& run) const {
    Raster<float> upside_down = *scene_.dem;
    for (float& z : upside_down.values()) {
        z = -z;
    }
    std::vector<std::int64_t> summits; // where water ends, or it would flood all land between two of them
    for (std::int64_t i = 0; i < upside_down.cells(); ++i) {
        Around const z(upside_down, upside_down.grid().at(i));
        bool has_lower = std::isnan(upside_down[i]);
        for (int k = 0; k < 9 && !has_lower; ++k) {
            has_lower = z(k % 3 - 1, k / 3 - 1) < upside_down[i];
        }
        if (!has_lower) {
            summits.push_back(i);
        }
    }
    return areas_in_logs(*scene_.dem, flow::route(upside_down, summits, run),
                         "contributing area of the terrain upside down: bright along ridges", run);
}

LandMaskMade LandMasks::wetness(Run const& run) {
    Raster<float> const& dem = *scene_.dem;
    flow::FlowField const& drainage = field(run);
    LandMaskMade mask{by_cell(dem, run, [&](std::int64_t i) { return wetness_of(drainage, dem, i); }), 0.0, 0.0,
                      "ln(m)", "topographic wetness: logarithm of contributing area per width over slope"};
    mask.low = below(dem, mask.share, 0.02);
    mask.high = below(dem, mask.share, 0.98);
    stretch(dem, mask);
    return mask;
}

LandMaskMade LandMasks::curvature(Run const& run) const {
    Raster<float> const& dem = *scene_.dem;
    LandMaskMade mask{by_cell(dem, run, [&](std::int64_t i) { return Around(dem, dem.grid().at(i)).bend(); }), 0.0, 0.0,
                      "1/m", "curvature: the middle grey is plane, ridges are brighter, hollows darker"};
    constexpr double least_range = 1e-9; // a plane is in the middle
    mask.high = std::max({-below(dem, mask.share, 0.02), below(dem, mask.share, 0.98), least_range});
    mask.low = -mask.high;
    stretch(dem, mask, 0.5F);
    return mask;
}

LandMaskMade LandMasks::water(Run const& run) {
    Raster<float> const& dem = *scene_.dem;
    Grid const& grid = dem.grid();
    LandMaskMade mask{Raster<float>(grid, 0.0F), 0.0, 1.0, "share of a cell", "sea, lakes and rivers"};
    Beside const* const rivers = rivers_.empty() ? nullptr : &beside(run);
    bool const has_lakes = scene_.lakes.cells() == dem.cells();
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if ((has_lakes && scene_.lakes[i] != 0) || (scene_.sea && std::isnan(dem[i]))) {
            mask.share[i] = 1.0F;
        } else if (rivers != nullptr && !std::isnan(dem[i])) {
            std::int64_t const river = rivers->nearest[i];
            double const away = std::sqrt(static_cast<double>(squared_cells(grid.at(i), grid.at(river))));
            double const half = 0.5 * rivers->width_m[river] / grid.cell_m;
            mask.share[i] = static_cast<float>(std::clamp(std::min(half + 0.5 - away, 2.0 * half), 0.0, 1.0));
        }
    }
    return mask;
}

LandMaskMade LandMasks::river_distance(Run const& run) {
    Grid const& grid = scene_.dem->grid();
    Raster<std::int64_t> const& nearest = beside(run).nearest;
    LandMaskMade mask{Raster<float>(grid), 0.0, 0.0, "m", "distance to the nearest river"};
    for (std::int64_t i = 0; i < nearest.cells(); ++i) {
        double const away = std::sqrt(static_cast<double>(squared_cells(grid.at(i), grid.at(nearest[i]))));
        mask.share[i] = static_cast<float>(grid.cell_m * away);
    }
    mask.high = *std::ranges::max_element(mask.share.values());
    for (float& away : mask.share.values()) {
        away = mask.high > 0.0 ? static_cast<float>(away / mask.high) : 0.0F;
    }
    return mask;
}

LandMaskMade LandMasks::river_width(Run const& run) {
    Grid const& grid = scene_.dem->grid();
    Beside const& rivers = beside(run);
    LandMaskMade mask{by_cell(*scene_.dem, run,
                              [&](std::int64_t i) {
                                  std::int64_t const river = rivers.nearest[i];
                                  double const away =
                                      grid.cell_m *
                                      std::sqrt(static_cast<double>(squared_cells(grid.at(i), grid.at(river))));
                                  float const width = rivers.width_m[river];
                                  return i == river || away <= 0.5 * width ? width : 0.0F;
                              }),
                      0.0, 0.0, "m", "width of the river here"};
    mask.high = *std::ranges::max_element(mask.share.values());
    stretch(*scene_.dem, mask);
    return mask;
}

Raster<std::uint8_t> const& LandMasks::kinds(Run const& run) {
    if (kinds_) {
        return *kinds_;
    }
    Raster<float> const& dem = *scene_.dem;
    Raster<float> const wet = water(run).share;
    flow::FlowField const& drainage = field(run);
    Raster<std::uint8_t> out(dem.grid(), kind_none);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (wet[i] >= 0.5F) {
            out[i] = kind_water;
        } else if (!std::isnan(dem[i])) {
            double const tangent = Around(dem, dem.grid().at(i)).tangent();
            double const above_sea_m = scene_.sea ? dem[i] - scene_.sea->level_m : std::numeric_limits<double>::max();
            out[i] = kind_of(dem[i], portable::atan2(tangent, 1.0) * degrees, wetness_of(drainage, dem, i), above_sea_m,
                             tree_line_m_);
        }
    }
    kinds_ = std::move(out);
    return *kinds_;
}

LandMaskMade LandMasks::made(LandMask mask, Run const& run) {
    switch (mask) {
    case LandMask::slope: return slope(run);
    case LandMask::flow: return contributing(run);
    case LandMask::wetness: return wetness(run);
    case LandMask::curvature: return curvature(run);
    case LandMask::water: return water(run);
    case LandMask::river_distance: return river_distance(run);
    case LandMask::river_width: return river_width(run);
    case LandMask::ridge: return ridge(run);
    case LandMask::land_cover: break;
    }
    LandMaskMade cover{Raster<float>(scene_.dem->grid()), 0.0, 255.0, "", "a guess of what grows or lies there"};
    Raster<std::uint8_t> const& kind = kinds(run);
    for (std::int64_t i = 0; i < kind.cells(); ++i) {
        cover.share[i] = static_cast<float>(kind[i]) / 255.0F;
    }
    return cover;
}

} // namespace thalweg::exports
