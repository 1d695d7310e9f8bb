// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/comparison.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour lower{0.13, 0.40, 0.67};
constexpr Colour higher{0.70, 0.09, 0.17};
constexpr Colour level{0.97, 0.97, 0.96};
constexpr Colour divide_of_both{0.05, 0.05, 0.06};
constexpr Colour divide_of_dem{0.91, 0.64, 0.0};
constexpr Colour divide_of_terrain{0.48, 0.25, 0.69};
constexpr double level_light = 181.0; // GDAL's hillshade of level ground

Colour colour_of(double difference_m, double limit_m) {
    return mix(level, difference_m < 0.0 ? lower : higher, std::min(1.0, std::fabs(difference_m) / limit_m));
}

void require_sheet(ComparisonSheet const& sheet, char const* who) {
    Grid const& grid = sheet.difference.grid();
    auto const is_other = [&](Grid const& other) { return other.width != grid.width || other.height != grid.height; };
    refuse_if<BadInput>(grid.cells() < 1 || is_other(sheet.shade_of_dem.grid()) || is_other(sheet.shade.grid()) ||
                            is_other(sheet.divides_of_dem.grid()) || is_other(sheet.divides.grid()),
                        who, "the rasters of a sheet of {}x{} cells differ in size or have no cells", grid.width,
                        grid.height);
}

/// Pixels that stand for squares of cells.
template <class ColourOf> Relief pixels_of(Grid const& grid, std::int64_t block, ColourOf const& colour_of_block) {
    Relief relief;
    relief.width = static_cast<int>((grid.width + block - 1) / block);
    relief.height = static_cast<int>((grid.height + block - 1) / block);
    relief.cells_a_pixel = static_cast<double>(block);
    relief.pixels.reserve(static_cast<std::size_t>(relief.width) * static_cast<std::size_t>(relief.height));
    for (std::int64_t top = 0; top < grid.height; top += block) {
        for (std::int64_t left = 0; left < grid.width; left += block) {
            Colour const c = colour_of_block(
                Cell{left, top}, Cell{std::min(left + block, grid.width), std::min(top + block, grid.height)});
            relief.pixels.push_back(packed(c.red, c.green, c.blue, 1.0));
        }
    }
    return relief;
}

template <class Visit> void each_cell(Cell from, Cell to, Visit const& visit) {
    for (Cell c = from; c.row < to.row; ++c.row) {
        for (c.col = from.col; c.col < to.col; ++c.col) {
            visit(c);
        }
    }
}

Relief grey_relief(Raster<std::uint8_t> const& shade, std::int64_t block) {
    return pixels_of(shade.grid(), block, [&](Cell from, Cell to) {
        double sum = 0.0;
        double cells = 0.0;
        each_cell(from, to, [&](Cell c) {
            sum += static_cast<double>(shade[c]);
            cells += shade[c] > 0 ? 1.0 : 0.0;
        });
        double const light = cells > 0.0 ? sum / cells / 255.0 : 0.9;
        return Colour{light, light, light};
    });
}

double limit_of(ComparisonSheet const& sheet) {
    return sheet.limit_m ? *sheet.limit_m : limit_of_differences(sheet.difference);
}

Relief difference_relief(ComparisonSheet const& sheet, std::int64_t block) {
    double const limit_m = limit_of(sheet);
    return pixels_of(sheet.difference.grid(), block, [&](Cell from, Cell to) {
        double sum = 0.0;
        double light = 0.0;
        double cells = 0.0;
        bool in_dem = false;
        bool in_terrain = false;
        each_cell(from, to, [&](Cell c) {
            auto const z = static_cast<double>(sheet.difference[c]);
            if (!std::isnan(z)) {
                sum += z;
                light += static_cast<double>(sheet.shade[c]);
                cells += 1.0;
            }
            in_dem = in_dem || sheet.divides_of_dem[c] != 0;
            in_terrain = in_terrain || sheet.divides[c] != 0;
        });
        if (in_dem || in_terrain) {
            return in_dem && in_terrain ? divide_of_both : in_dem ? divide_of_dem : divide_of_terrain;
        }
        if (cells == 0.0) {
            return no_data;
        }
        Colour const flat = colour_of(sum / cells, limit_m);
        double const lit = 0.7 + 0.3 * std::min(1.2, light / cells / level_light);
        return Colour{std::min(1.0, flat.red * lit), std::min(1.0, flat.green * lit), std::min(1.0, flat.blue * lit)};
    });
}

std::int64_t block_for(Grid const& grid, double width_px) {
    return std::max<std::int64_t>(1,
                                  static_cast<std::int64_t>(static_cast<double>(grid.width) / std::max(1.0, width_px)));
}

constexpr double units_a_px = 0.0085; ///< of the sheet's width

double panel_of(double width, double gap) {
    return (width - 4.0 * gap) / 3.0;
}

/// Samples of colours with words, in a row.
class Legend {
public:
    Legend(Cairo* sheet, Vec2 at, double unit) : sheet_(sheet), at_(at), unit_(unit) {}

    void bar(double limit_m) {
        constexpr int steps = 60;
        TextStyle const style{unit_};
        std::string const low = fmt::format("{} m", number(-limit_m, decimals_of(limit_m)));
        std::string const high = fmt::format("+{} m", number(limit_m, decimals_of(limit_m)));
        draw_text(sheet_, at_, low, style);
        double const left = at_.x + text_width(sheet_, low, style) + 0.5 * unit_;
        double const wide = 12.0 * unit_;
        for (int k = 0; k < steps; ++k) {
            double const z = limit_m * (2.0 * (k + 0.5) / steps - 1.0);
            fill_box(sheet_, {left + wide * k / steps, at_.y - 0.8 * unit_, wide / steps + 0.5, unit_},
                     colour_of(z, limit_m));
        }
        draw_text(sheet_, {left + wide + 0.5 * unit_, at_.y}, high, style);
        at_.x = left + wide + 2.5 * unit_ + text_width(sheet_, high, style);
    }
    void sample(Colour colour, char const* words) {
        TextStyle const style{unit_};
        fill_box(sheet_, {at_.x, at_.y - 0.55 * unit_, 1.6 * unit_, 0.3 * unit_}, colour);
        draw_text(sheet_, {at_.x + 2.2 * unit_, at_.y}, words, style);
        at_.x += 4.2 * unit_ + text_width(sheet_, words, style);
    }

private:
    Cairo* sheet_;
    Vec2 at_;
    double unit_;
};

/// The 98th percentile of sizes, 0 where there are none: by the upper half of the bits, which grow with the number,
/// then by the lower half.
float size_of_most(Raster<float> const& difference) {
    constexpr double most = 0.98;
    constexpr std::uint32_t half = 1U << 16U;
    auto const counted = [&](std::uint32_t upper) {
        std::vector<std::int64_t> counts(half);
        for (float const z : difference.values()) {
            auto const bits = std::bit_cast<std::uint32_t>(std::fabs(z));
            if (std::isfinite(z) && (upper == half || bits / half == upper)) {
                ++counts[upper == half ? bits / half : bits % half];
            }
        }
        return counts;
    };
    auto const reached = [](std::vector<std::int64_t> const& counts, std::int64_t& rank) {
        std::uint32_t k = 0;
        for (; rank >= counts[k]; ++k) {
            rank -= counts[k];
        }
        return k;
    };
    std::vector<std::int64_t> const by_upper = counted(half);
    std::int64_t const all = std::accumulate(by_upper.begin(), by_upper.end(), std::int64_t{0});
    if (all == 0) {
        return 0.0F;
    }
    auto rank = static_cast<std::int64_t>(most * static_cast<double>(all - 1));
    std::uint32_t const upper = reached(by_upper, rank);
    std::uint32_t const rest = reached(counted(upper), rank);
    return std::bit_cast<float>(upper * half + rest);
}

} // namespace

double limit_of_differences(Raster<float> const& difference) {
    auto const value = static_cast<double>(size_of_most(difference));
    if (!(value > 0.0)) {
        return 1.0;
    }
    double const below = round_down(value);
    for (double const factor : {1.0, 2.0}) {
        double const round = below * factor;
        if (round >= value && std::fabs(round_down(round * 1.000001) - round) < 1e-6 * round) {
            return round;
        }
    }
    return 2.5 * below;
}

Picture differences(ComparisonSheet const& sheet, ComparisonParams const& params) {
    require_in("draw.differences", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_sheet(sheet, "draw.differences");
    Grid const& grid = sheet.difference.grid();
    std::int64_t const block = block_for(grid, params.width_px);
    Relief const relief = difference_relief(sheet, block);
    double const scale = std::max(1.0, std::floor(params.width_px / static_cast<double>(relief.width)));
    double const width = scale * relief.width;
    double const height = scale * relief.height;
    return paint(width, height, params.format, [&](Cairo* canvas) {
        draw_relief(canvas, relief, {0.0, 0.0, width, height}, scale / static_cast<double>(block));
    });
}

std::int64_t columns_of_comparison(ComparisonParams const& params) {
    double const width = params.width_px;
    return static_cast<std::int64_t>(std::ceil(panel_of(width, units_a_px * width) - 1e-6));
}

Picture comparison(ComparisonSheet const& sheet, ComparisonParams const& params) {
    require_in("draw.comparison", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_sheet(sheet, "draw.comparison");
    Grid const& grid = sheet.difference.grid();
    double const width = params.width_px;
    double const unit = units_a_px * width;
    double const gap = unit;
    double const panel = panel_of(width, gap);
    double const px_per_cell = panel / static_cast<double>(grid.width);
    double const panel_height = px_per_cell * static_cast<double>(grid.height);
    double const top = params.title.empty() ? 2.6 * unit : 5.0 * unit;
    double const height = std::clamp(top + panel_height + 4.0 * unit, 200.0, 32000.0);
    std::int64_t const block = block_for(grid, panel);
    std::array<std::pair<std::string, Relief>, 3> const panels{
        {{params.dem.empty() ? "DEM" : params.dem, grey_relief(sheet.shade_of_dem, block)},
         {"this terrain", grey_relief(sheet.shade, block)},
         {"this terrain minus the DEM", difference_relief(sheet, block)}}};
    return paint(width, height, params.format, [&](Cairo* canvas) {
        if (!params.title.empty()) {
            draw_text_within(canvas, {gap, 2.4 * unit}, params.title, {1.35 * unit, ink, Weight::bold},
                             width - 2.0 * gap);
        }
        double left = gap;
        for (auto const& [name, relief] : panels) {
            Box const box{left, top, panel, panel_height};
            draw_text_within(canvas, {left, top - 0.7 * unit}, name, {unit}, panel);
            draw_relief(canvas, relief, box, px_per_cell);
            frame_box(canvas, box, 0.08 * unit, faint_ink);
            left += panel + gap;
        }
        Legend legend(canvas, {gap, top + panel_height + 2.4 * unit}, unit);
        legend.bar(limit_of(sheet));
        legend.sample(divide_of_both, "divides of both");
        legend.sample(divide_of_dem, "of the DEM alone");
        legend.sample(divide_of_terrain, "of this terrain alone");
    });
}

} // namespace thalweg::draw
