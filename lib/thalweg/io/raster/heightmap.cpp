// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/heightmap.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/put_number.hpp>
#include <thalweg/io/raster/internal/exr.hpp>
#include <thalweg/io/raster/internal/png.hpp>

namespace thalweg::io {
namespace {

std::vector<std::uint16_t> in_16_bits(Raster<float> const& heights, HeightmapScale const& scale) {
    std::vector<std::uint16_t> numbers;
    numbers.reserve(heights.values().size());
    for (float const z : heights.values()) {
        double const share = scale.step_m > 0.0 ? (static_cast<double>(z) - scale.min_m) / scale.step_m : 0.0;
        numbers.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(share + 0.5), 0.0, 65535.0)));
    }
    return numbers;
}

/// Numbers without a header.
template <class T> void write_raw(std::span<T const> numbers, std::string const& path, Run const& run) {
    std::string bytes;
    bytes.reserve(numbers.size_bytes());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i % cells_between_checks == 0) {
            run.at(static_cast<double>(i) / static_cast<double>(numbers.size()), "write");
        }
        put_number(bytes, numbers[i]);
    }
    write_text(path, bytes);
}

} // namespace

HeightmapScale heightmap_scale(Raster<float> const& heights) {
    refuse_if<BadInput>(heights.cells() < 1, "io.write_heightmap", "there are no heights");
    for (std::int64_t i = 0; i < heights.cells(); ++i) {
        Cell const c = heights.grid().at(i);
        refuse_if<BadInput>(!std::isfinite(heights[i]), "io.write_heightmap",
                            "the sample at column {}, row {} has no height", c.col, c.row);
    }
    auto const [low, high] = std::ranges::minmax_element(heights.values());
    double const min_m = *low;
    double const max_m = *high;
    return {min_m, max_m, (max_m - min_m) / 65535.0};
}

void write_heightmap(Raster<float> const& heights, std::string const& path, HeightmapFormat format,
                     HeightmapScale const& scale, Run const& run) {
    if (format == HeightmapFormat::r32) {
        write_raw<float>(heights.values(), path, run);
        return;
    }
    if (format == HeightmapFormat::exr) {
        write_text(path, exr(heights, run));
        return;
    }
    std::vector<std::uint16_t> numbers = in_16_bits(heights, scale);
    if (format == HeightmapFormat::r16) {
        write_raw<std::uint16_t>(numbers, path, run);
    } else {
        write_png(numbers, 1, heights.grid(), png_fast, path, run);
    }
}

HeightmapScale write_heightmap(Raster<float> const& heights, std::string const& path, HeightmapFormat format,
                               Run const& run) {
    HeightmapScale scale = heightmap_scale(heights);
    if (format == HeightmapFormat::r32 || format == HeightmapFormat::exr) {
        scale.step_m = 0.0;
    }
    write_heightmap(heights, path, format, scale, run);
    return scale;
}

void write_grey_png(Raster<float> const& shares, std::string const& path, int bits, Run const& run) {
    refuse_if<BadParameter>(bits != 8 && bits != 16, "io.write_grey_png", "a sample has 8 or 16 bits, not {}", bits);
    auto const in_numbers = [&]<class T>(std::vector<T> numbers) {
        double const most = sizeof(T) == 2 ? 65535.0 : 255.0;
        numbers.reserve(shares.values().size());
        for (float const share : shares.values()) {
            numbers.push_back(
                static_cast<T>(std::floor(std::clamp(static_cast<double>(share), 0.0, 1.0) * most + 0.5)));
        }
        write_png(numbers, 1, shares.grid(), png_fast, path, run);
    };
    if (bits == 8) {
        in_numbers(std::vector<std::uint8_t>());
    } else {
        in_numbers(std::vector<std::uint16_t>());
    }
}

void write_colour_png(Raster<std::uint32_t> const& colours, std::string const& path, Run const& run) {
    std::vector<std::uint8_t> numbers;
    numbers.reserve(3 * colours.values().size());
    for (std::uint32_t const colour : colours.values()) {
        for (unsigned const shift : {16U, 8U, 0U}) {
            numbers.push_back(static_cast<std::uint8_t>((colour >> shift) & 0xFFU));
        }
    }
    write_png(numbers, 3, colours.grid(), png_fast, path, run);
}

} // namespace thalweg::io
