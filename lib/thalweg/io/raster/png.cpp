// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/png.hpp>

#include <gdal_priv.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>

namespace thalweg::io {
namespace {

template <class T>
void write_numbers(std::vector<T>& numbers, int bands, Grid const& grid, int level, std::string const& path,
                   Run const& run) {
    About const about{"io.write_png", path};
    constexpr GDALDataType type = sizeof(T) == 2 ? GDT_UInt16 : GDT_Byte;
    require_size(grid, about);
    Driver const driver;
    MemoryFile const file;
    auto const require = [&](bool done) {
        if (!done) {
            driver.check(about.where, about.name);
            throw IoError(about.where, about.name + " could not be written");
        }
    };
    auto const width = static_cast<int>(grid.width);
    auto const height = static_cast<int>(grid.height);
    Dataset source(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", width, height, bands, type, nullptr));
    require(source != nullptr);
    auto const pixel = static_cast<GSpacing>(sizeof(T)) * bands;
    require(source->RasterIO(GF_Write, 0, 0, width, height, numbers.data(), width, height, type, bands, nullptr, pixel,
                             pixel * width, static_cast<GSpacing>(sizeof(T)), nullptr) == CE_None);
    CPLStringList options;
    options.SetNameValue("ZLEVEL", std::to_string(level).c_str());
    GdalProgress gdal_progress(run, "write");
    Dataset target(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
        file.path().c_str(), source.get(), TRUE, options.List(), &GdalProgress::step, &gdal_progress));
    gdal_progress.settle();
    require(target != nullptr);
    target.reset();
    source.reset();
    driver.check(about.where, about.name);
    write_text(path, file.bytes());
}

} // namespace

void write_png(std::vector<std::uint8_t>& numbers, int bands, Grid const& grid, int level, std::string const& path,
               Run const& run) {
    write_numbers(numbers, bands, grid, level, path, run);
}

void write_png(std::vector<std::uint16_t>& numbers, int bands, Grid const& grid, int level, std::string const& path,
               Run const& run) {
    write_numbers(numbers, bands, grid, level, path, run);
}

} // namespace thalweg::io
