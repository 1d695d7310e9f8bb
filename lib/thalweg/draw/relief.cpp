// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/relief.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <cairo.h>

namespace thalweg::draw {
namespace {

/// Sage, straw, sand, clay, white: seven colours joined in OKLab and cut into equal lengths there, so that equal
/// differences of height look equally large. Light enough to be shaded.
constexpr std::array<std::array<double, 3>, 17> tints = {{{126, 166, 136},
                                                          {137, 173, 140},
                                                          {148, 181, 143},
                                                          {159, 189, 147},
                                                          {170, 196, 150},
                                                          {185, 202, 155},
                                                          {199, 208, 159},
                                                          {214, 214, 164},
                                                          {231, 210, 166},
                                                          {227, 201, 162},
                                                          {222, 193, 160},
                                                          {225, 201, 177},
                                                          {228, 209, 194},
                                                          {233, 218, 207},
                                                          {238, 227, 219},
                                                          {243, 237, 231},
                                                          {248, 246, 243}}};

constexpr int level_shade = 181; ///< GDAL's hillshade of level ground under a light 45 degrees high

Colour mix(Colour a, Colour b, double share) {
    auto const blend = [share](double p, double q) { return p + (q - p) * share; };
    return {blend(a.red, b.red), blend(a.green, b.green), blend(a.blue, b.blue), 1.0};
}

/// Slopes turned from the light are multiplied by a cool grey, those turned to it lightened.
Colour shade(Colour ground, double light) {
    if (light <= 0.0) {
        return mix(ground, {ground.red * 0.30, ground.green * 0.33, ground.blue * 0.45}, -light);
    }
    return mix(ground, {1.0, 1.0, 0.96}, 0.55 * light);
}

/// Light of every hillshade value, [-1, 1], 0 on level ground; stretched where the relief is faint.
std::array<double, 256> lights(Raster<float> const& dem, Raster<std::uint8_t> const& hillshade) {
    std::array<std::int64_t, 256> count{};
    std::int64_t all = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (std::isfinite(dem[i]) && hillshade[i] > 0) {
            ++count[hillshade[i]];
            ++all;
        }
    }
    std::size_t darkest = 1; // but for one cell in fifty
    for (std::int64_t below = count[1]; darkest < level_shade && below * 50 < all;) {
        below += count[++darkest];
    }
    double const depth = std::max(1.0, static_cast<double>(level_shade) - static_cast<double>(darkest));
    double const gain = std::clamp(130.0 / depth, 1.0, 2.5);
    std::array<double, 256> light{};
    for (std::size_t s = 1; s < 256; ++s) {
        double const off = gain * (static_cast<double>(s) - level_shade);
        light[s] = std::clamp(off < 0.0 ? off / 180.0 : off / 74.0, -1.0, 1.0);
    }
    return light;
}

std::uint32_t packed(double red, double green, double blue, double alpha) {
    auto const byte = [](double v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0, 1.0) * 255.0 + 0.5); };
    return byte(alpha) << 24U | byte(red) << 16U | byte(green) << 8U | byte(blue);
}

} // namespace

Colour tint(double share) {
    double const place = std::clamp(share, 0.0, 1.0) * static_cast<double>(tints.size() - 1);
    std::size_t const k = std::min(static_cast<std::size_t>(place), tints.size() - 2);
    double const part = place - static_cast<double>(k);
    auto const channel = [&](std::size_t c) { return (tints[k][c] + (tints[k + 1][c] - tints[k][c]) * part) / 255.0; };
    return {channel(0), channel(1), channel(2), 1.0};
}

Relief tinted_relief(Raster<float> const& dem, Raster<std::uint8_t> const& hillshade, double most_wide) {
    Relief relief;
    relief.low_m = std::numeric_limits<double>::infinity();
    relief.high_m = -relief.low_m;
    for (float const z : dem.values()) {
        if (std::isfinite(z)) {
            relief.low_m = std::min(relief.low_m, static_cast<double>(z));
            relief.high_m = std::max(relief.high_m, static_cast<double>(z));
        } else {
            ++relief.holes;
        }
    }
    double const span = relief.high_m - relief.low_m;
    std::array<double, 256> const light = lights(dem, hillshade);

    constexpr std::int64_t longest = 30000;
    std::int64_t const fine = static_cast<std::int64_t>(static_cast<double>(dem.width()) / std::max(1.0, most_wide));
    std::int64_t const block = std::max(
        {std::int64_t{1}, fine, (dem.width() + longest - 1) / longest, (dem.height() + longest - 1) / longest});
    std::int64_t const columns = (dem.width() + block - 1) / block;
    std::int64_t const rows = (dem.height() + block - 1) / block;
    relief.width = static_cast<int>(columns);
    relief.height = static_cast<int>(rows);
    relief.cells_a_pixel = static_cast<double>(block);
    relief.pixels.reserve(static_cast<std::size_t>(columns * rows));
    for (std::int64_t r = 0; r < rows; ++r) {
        for (std::int64_t c = 0; c < columns; ++c) {
            Colour sum{0.0, 0.0, 0.0, 0.0};
            std::int64_t const right = std::min(dem.width(), (c + 1) * block);
            std::int64_t const bottom = std::min(dem.height(), (r + 1) * block);
            for (std::int64_t row = r * block; row < bottom; ++row) {
                for (std::int64_t col = c * block; col < right; ++col) {
                    double const z = dem[Cell{col, row}];
                    if (!std::isfinite(z)) {
                        continue;
                    }
                    Colour const seen =
                        shade(tint(span > 0.0 ? (z - relief.low_m) / span : 0.4), light[hillshade[Cell{col, row}]]);
                    sum = {sum.red + seen.red, sum.green + seen.green, sum.blue + seen.blue, sum.alpha + 1.0};
                }
            }
            double const cells = static_cast<double>((right - c * block) * (bottom - r * block));
            relief.pixels.push_back(packed(sum.red / cells, sum.green / cells, sum.blue / cells, sum.alpha / cells));
        }
    }
    return relief;
}

void draw_relief(Cairo* sheet, Relief const& relief, Box where, double px_per_cell) {
    struct End {
        void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    };
    auto* const pixels = const_cast<std::uint32_t*>(relief.pixels.data()); // a source is only read
    std::unique_ptr<cairo_surface_t, End> const image(cairo_image_surface_create_for_data(
        reinterpret_cast<unsigned char*>(pixels), CAIRO_FORMAT_ARGB32, relief.width, relief.height, 4 * relief.width));
    double const scale = relief.cells_a_pixel * px_per_cell;
    cairo_save(sheet);
    cairo_rectangle(sheet, where.x, where.y, where.width, where.height);
    cairo_clip(sheet);
    cairo_translate(sheet, where.x, where.y);
    cairo_scale(sheet, scale, scale);
    cairo_set_source_surface(sheet, image.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(sheet), CAIRO_FILTER_BEST);
    bool const is_svg = cairo_surface_get_type(cairo_get_target(sheet)) == CAIRO_SURFACE_TYPE_SVG;
    if (!is_svg) { // which has no such extension: Cairo 1.18 writes every pixel instead
        cairo_pattern_set_extend(cairo_get_source(sheet), CAIRO_EXTEND_PAD);
    }
    cairo_paint(sheet);
    cairo_restore(sheet);
    cairo_surface_finish(image.get());
}

} // namespace thalweg::draw
