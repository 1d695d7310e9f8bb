// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/write_dem.hpp>

#include <filesystem>

#include <fmt/format.h>
#include <gdal_priv.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/dataset.hpp>
#include <thalweg/io/driver.hpp>
#include <thalweg/io/watch.hpp>

namespace thalweg::io {

namespace {

void require_new(std::string const& path, std::string const& what) {
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) {
        throw IoError(what + " exists already");
    }
}

void require(bool done, Driver const& driver, std::string const& what) {
    if (!done) {
        driver.check(what);
        throw IoError(what + " could not be written");
    }
}

} // namespace

void write_dem(Raster<float> const& dem, std::string const& path, Run const& run) {
    std::string const what = "io.write_dem: " + path;
    require_new(path, what);
    Driver const driver;
    Dataset const source = in_memory(dem, what);
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("PREDICTOR", "FLOATING_POINT");
    options.SetNameValue("OVERVIEW_PREDICTOR", "FLOATING_POINT");
    options.SetNameValue("BLOCKSIZE", "512");
    options.SetNameValue("OVERVIEW_RESAMPLING", "AVERAGE");
    options.SetNameValue("NUM_THREADS", run.threads > 0 ? fmt::format("{}", run.threads).c_str() : "ALL_CPUS");
    Watch watch(run, "write dem.tif");
    Dataset target(GetGDALDriverManager()->GetDriverByName("COG")->CreateCopy(path.c_str(), source.get(), TRUE,
                                                                              options.List(), &Watch::step, &watch));
    watch.settle();
    require(target != nullptr, driver, what);
    target.reset();
    driver.check(what);
}

void write_mask(Mask const& mask, std::string const& path, Run const& run) {
    std::string const what = "io.write_mask: " + path;
    require_new(path, what);
    require_size(mask.grid(), what);
    Driver const driver;
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("TILED", "YES");
    Dataset target(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), static_cast<int>(mask.width()), static_cast<int>(mask.height()), 1, GDT_Byte, options.List()));
    require(target != nullptr, driver, what);
    set_frame(*target, mask.grid());
    GDALRasterIOExtraArg extra;
    INIT_RASTERIO_EXTRA_ARG(extra);
    Watch watch(run, "write mask");
    extra.pfnProgress = &Watch::step;
    extra.pProgressData = &watch;
    int const width = target->GetRasterXSize();
    int const height = target->GetRasterYSize();
    // GDAL's one call reads and writes and therefore takes no const buffer.
    void* const cells = const_cast<std::uint8_t*>(mask.values().data());
    CPLErr const error =
        target->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, width, height, cells, width, height, GDT_Byte, 0, 0, &extra);
    watch.settle();
    require(error == CE_None, driver, what);
    target.reset();
    driver.check(what);
}

} // namespace thalweg::io
