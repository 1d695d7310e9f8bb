// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/dataset.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/archive.hpp>
#include <thalweg/io/spatial_reference.hpp>
#include <thalweg/io/undisturbed.hpp>

namespace thalweg::io {

void CloseDataset::operator()(GDALDataset* dataset) const {
    GDALClose(dataset);
}

Dataset open_undisturbed(std::string const& path, unsigned kinds, char const* const* drivers) {
    auto const file = std::make_shared<Undisturbed const>(path);
    return Dataset(GDALDataset::Open(inside_archive(file->path()).c_str(),
                                     kinds | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers, file->options()),
                   {file});
}

Dataset open_file(std::string const& path, unsigned kinds, char const* const* drivers, std::string const& what) {
    // GDAL takes addresses and connection strings for file names.
    if (std::error_code ignored; !std::filesystem::exists(path, ignored)) {
        throw BadInput(what + " does not exist");
    }
    CPLErrorReset();
    Dataset dataset = open_undisturbed(path, kinds, drivers);
    if (dataset == nullptr) {
        throw BadInput(fmt::format("{} cannot be read: {}", what, CPLGetLastErrorMsg()));
    }
    return dataset;
}

void set_frame(GDALDataset& dataset, Grid const& grid) {
    std::array<double, 6> frame{grid.west, grid.cell_m, 0.0, grid.north, 0.0, -grid.cell_m};
    dataset.SetGeoTransform(frame.data());
    if (!grid.crs.empty()) {
        OGRSpatialReference const reference = read_reference(grid.crs);
        dataset.SetSpatialRef(&reference);
    }
}

void require_size(Grid const& grid, std::string const& what) {
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    if (grid.width < 1 || grid.height < 1 || grid.width > most || grid.height > most) {
        throw BadInput(fmt::format("{}: a raster of {} x {} cells", what, grid.width, grid.height));
    }
}

Dataset in_memory(Raster<float> const& dem, std::string const& what) {
    require_size(dem.grid(), what);
    Dataset dataset(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
        "", static_cast<int>(dem.width()), static_cast<int>(dem.height()), 1, GDT_Float32, nullptr));
    if (dataset == nullptr) {
        throw IoError(fmt::format("{}: no memory for {} x {} cells", what, dem.width(), dem.height()));
    }
    set_frame(*dataset, dem.grid());
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    band.SetNoDataValue(static_cast<double>(nodata_height));
    std::vector<float> line(static_cast<std::size_t>(dem.width()));
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::size_t col = 0; float const z : dem.row(row)) {
            if (std::isinf(z) || z == nodata_height) {
                throw BadInput(fmt::format("{}: the height at column {}, row {} is {}", what, col, row, z));
            }
            line[col++] = std::isnan(z) ? nodata_height : z;
        }
        if (band.RasterIO(GF_Write, 0, static_cast<int>(row), static_cast<int>(dem.width()), 1, line.data(),
                          static_cast<int>(dem.width()), 1, GDT_Float32, 0, 0, nullptr) != CE_None) {
            throw IoError(what + ": no copy in memory");
        }
    }
    return dataset;
}

} // namespace thalweg::io
