// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/heightmap.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gdal_priv.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/internal/las_ply.hpp>
#include <thalweg/io/raster/internal/exr.hpp>

namespace thalweg::io {
namespace {

HeightmapScale scale_of(Raster<float> const& heights, std::string const& what) {
    for (std::int64_t i = 0; i < heights.cells(); ++i) {
        Cell const c = heights.grid().at(i);
        refuse_if<BadInput>(!std::isfinite(heights[i]), "{}: the sample at column {}, row {} has no height", what,
                            c.col, c.row);
    }
    auto const [low, high] = std::ranges::minmax_element(heights.values());
    double const min_m = *low;
    double const max_m = *high;
    return {min_m, max_m, (max_m - min_m) / 65535.0};
}

std::vector<std::uint16_t> in_16_bits(Raster<float> const& heights, HeightmapScale const& scale) {
    std::vector<std::uint16_t> numbers;
    numbers.reserve(heights.values().size());
    for (float const z : heights.values()) {
        double const share = scale.step_m > 0.0 ? (static_cast<double>(z) - scale.min_m) / scale.step_m : 0.0;
        numbers.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(share + 0.5), 0.0, 65535.0)));
    }
    return numbers;
}

void write_png16(std::vector<std::uint16_t>& numbers, Grid const& grid, std::string const& path,
                 std::string const& what, Run const& run) {
    require_size(grid, what);
    Driver const driver;
    MemoryFile const file;
    auto const require = [&](bool done) {
        if (!done) {
            driver.check(what);
            throw IoError(what + " could not be written");
        }
    };
    auto const width = static_cast<int>(grid.width);
    auto const height = static_cast<int>(grid.height);
    Dataset source(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", width, height, 1, GDT_UInt16, nullptr));
    require(source != nullptr);
    require(source->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, width, height, numbers.data(), width, height, GDT_UInt16,
                                               0, 0, nullptr) == CE_None);
    CPLStringList options;
    options.SetNameValue("ZLEVEL", "1"); // 6 takes twice the time for 3 % fewer bytes
    GdalProgress gdal_progress(run, "write");
    Dataset target(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
        file.path().c_str(), source.get(), TRUE, options.List(), &GdalProgress::step, &gdal_progress));
    gdal_progress.settle();
    require(target != nullptr);
    target.reset();
    source.reset();
    driver.check(what);
    write_text(path, file.bytes());
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

HeightmapScale write_heightmap(Raster<float> const& heights, std::string const& path, HeightmapFormat format,
                               Run const& run) {
    std::string const what = "io.write_heightmap: " + path;
    refuse_if<BadInput>(heights.cells() < 1, "{}: there are no heights", what);
    HeightmapScale scale = scale_of(heights, what);
    if (format == HeightmapFormat::r32 || format == HeightmapFormat::exr) {
        scale.step_m = 0.0;
        if (format == HeightmapFormat::r32) {
            write_raw<float>(heights.values(), path, run);
        } else {
            write_text(path, exr(heights, run));
        }
        return scale;
    }
    std::vector<std::uint16_t> numbers = in_16_bits(heights, scale);
    if (format == HeightmapFormat::r16) {
        write_raw<std::uint16_t>(numbers, path, run);
    } else {
        write_png16(numbers, heights.grid(), path, what, run);
    }
    return scale;
}

} // namespace thalweg::io
