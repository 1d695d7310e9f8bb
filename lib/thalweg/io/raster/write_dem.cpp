// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/gdal/internal/written_file.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

namespace {

void require_new(std::string const& path, About const& about) {
    require_geotiff_name(path);
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) {
        throw IoError(about.where, about.name + " exists already");
    }
}

void require(bool done, Driver const& driver, WrittenFile const& file, About const& about) {
    file.check(); // GDAL knows no reason
    if (!done) {
        driver.check(about.where, about.name);
        throw IoError(about.where, about.name + " could not be written");
    }
}

/// Writes a new tiled GeoTIFF of one band.
template <class T>
void write_tiled(Raster<T> const& raster, GDALDataType type, std::optional<double> no_data, char const* where,
                 std::string const& path, Run const& run) {
    About const about{where, path};
    require_new(path, about);
    require_size(raster.grid(), about);
    Driver const driver;
    WrittenFile file(path, about);
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("TILED", "YES");
    if (std::is_floating_point_v<T>) {
        options.SetNameValue("PREDICTOR", "3");
        options.SetNameValue("BIGTIFF", "IF_SAFER");
        options.SetNameValue("NUM_THREADS", run.threads > 0 ? fmt::format("{}", run.threads).c_str() : "ALL_CPUS");
    }
    Dataset target(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.name().c_str(), static_cast<int>(raster.width()), static_cast<int>(raster.height()), 1, type,
        options.List()));
    require(target != nullptr, driver, file, about);
    set_frame(*target, raster.grid());
    if (no_data) {
        target->GetRasterBand(1)->SetNoDataValue(*no_data);
    }
    int const width = target->GetRasterXSize();
    int const height = target->GetRasterYSize();
    int tile_width = 0;
    int tile_height = 0;
    target->GetRasterBand(1)->GetBlockSize(&tile_width, &tile_height);
    std::vector<T> strip;
    for (int row = 0; row < height; row += tile_height) {
        run.at(static_cast<double>(row) / height, "write");
        int const rows = std::min(tile_height, height - row);
        auto const cells = raster.values().subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(width),
                                                   static_cast<std::size_t>(rows) * static_cast<std::size_t>(width));
        strip.assign(cells.begin(), cells.end());
        if constexpr (std::is_floating_point_v<T>) {
            std::ranges::replace_if(
                strip, [](T v) { return std::isnan(v); }, static_cast<T>(no_data.value_or(0.0)));
        }
        require(target->GetRasterBand(1)->RasterIO(GF_Write, 0, row, width, rows, strip.data(), width, rows, type, 0, 0,
                                                   nullptr) == CE_None,
                driver, file, about);
    }
    target.reset();
    file.check();
    driver.check(about.where, about.name);
    file.close();
}

} // namespace

void require_geotiff_name(std::string const& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    refuse_if<BadParameter>(!ending.empty() && ending != ".tif" && ending != ".tiff", "io.write_dem",
                            "{}: a GeoTIFF is written, whose name ends in .tif, not {}; other formats come from "
                            "gdal_translate, heightmaps of 16 bits from thalweg export",
                            path, ending);
}

void write_dem(Raster<float> const& dem, std::string const& path, Run const& run) {
    write_dem(dem, path, DemLabel{}, run);
}

void write_dem(Raster<float> const& dem, std::string const& path, HeightUnit unit, Run const& run) {
    write_dem(dem, path, DemLabel{unit, ""}, run);
}

void write_dem(Raster<float> const& dem, std::string const& path, DemLabel const& label, Run const& run) {
    About const about{"io.write_dem", path};
    require_new(path, about);
    Driver const driver;
    WrittenFile file(path, about);
    Dataset source = dataset_of(dem, about);
    source->GetRasterBand(1)->SetUnitType(name_of(label.unit));
    if (!label.remark.empty()) {
        source->SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", label.remark.c_str());
    }
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("PREDICTOR", "FLOATING_POINT");
    options.SetNameValue("OVERVIEW_PREDICTOR", "FLOATING_POINT");
    options.SetNameValue("BLOCKSIZE", "512");
    options.SetNameValue("OVERVIEW_RESAMPLING", "AVERAGE");
    options.SetNameValue("NUM_THREADS", run.threads > 0 ? fmt::format("{}", run.threads).c_str() : "ALL_CPUS");
    GdalProgress gdal_progress(run, "write dem.tif");
    Dataset target(GetGDALDriverManager()->GetDriverByName("COG")->CreateCopy(
        file.name().c_str(), source.get(), TRUE, options.List(), &GdalProgress::step, &gdal_progress));
    gdal_progress.settle();
    require(target != nullptr, driver, file, about);
    target.reset();
    source.reset();
    file.check();
    driver.check(about.where, about.name);
    file.close();
}

void write_mask(Mask const& mask, std::string const& path, Run const& run) {
    write_tiled(mask, GDT_Byte, {}, "io.write_mask", path, run);
}

void write_codes(Raster<std::uint8_t> const& codes, std::string const& path, Run const& run) {
    write_tiled(codes, GDT_Byte, no_code, "io.write_codes", path, run);
}

void write_field(Raster<double> const& field, std::string const& path, Run const& run) {
    constexpr auto no_data = static_cast<double>(nodata_height);
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        if (std::isinf(field[i]) || field[i] == no_data) {
            Cell const c = field.grid().at(i);
            throw BadInput("io.write_field",
                           fmt::format("{}: the number at column {}, row {} is {}", path, c.col, c.row, field[i]));
        }
    }
    write_tiled(field, GDT_Float64, no_data, "io.write_field", path, run);
}

} // namespace thalweg::io
