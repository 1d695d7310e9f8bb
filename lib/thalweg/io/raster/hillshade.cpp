// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/hillshade.hpp>

#include <memory>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {

Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor, Light light) {
    std::string const what = "io.hillshade";
    require_in(what, "z_factor", z_factor, Range::above(0.0).or_infinite());
    Driver const driver;
    Dataset const source = in_memory(dem, what);
    CPLStringList arguments;
    for (std::string const& argument : {std::string("-of"), std::string("MEM"), std::string("-compute_edges"),
                                        std::string("-z"), fmt::format("{}", z_factor)}) {
        arguments.AddString(argument.c_str());
    }
    if (light == Light::multidirectional) {
        arguments.AddString("-multidirectional");
    }
    std::unique_ptr<GDALDEMProcessingOptions, decltype(&GDALDEMProcessingOptionsFree)> const options(
        GDALDEMProcessingOptionsNew(arguments.List(), nullptr), &GDALDEMProcessingOptionsFree);
    Dataset const shaded(GDALDataset::FromHandle(
        GDALDEMProcessing("", GDALDataset::ToHandle(source.get()), "hillshade", nullptr, options.get(), nullptr)));
    Raster<std::uint8_t> shade(dem.grid());
    int const width = source->GetRasterXSize();
    int const height = source->GetRasterYSize();
    if (shaded == nullptr || shaded->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, shade.values().data(),
                                                                width, height, GDT_Byte, 0, 0, nullptr) != CE_None) {
        driver.check(what);
        throw IoError(what + " failed");
    }
    return shade;
}

} // namespace thalweg::io
