// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/raster_dataset.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gdal_priv.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>

namespace thalweg::io {

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
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1 || grid.width > most || grid.height > most,
                        "{}: a raster of {} x {} cells", what, grid.width, grid.height);
}

Dataset in_memory(Raster<float> const& dem, std::string const& what) {
    require_size(dem.grid(), what);
    Dataset dataset(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
        "", static_cast<int>(dem.width()), static_cast<int>(dem.height()), 1, GDT_Float32, nullptr));
    refuse_if<IoError>(dataset == nullptr, "{}: no memory for {} x {} cells", what, dem.width(), dem.height());
    set_frame(*dataset, dem.grid());
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    band.SetNoDataValue(static_cast<double>(nodata_height));
    std::vector<float> line(static_cast<std::size_t>(dem.width()));
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::size_t col = 0; float const z : dem.row(row)) {
            refuse_if<BadInput>(std::isinf(z) || z == nodata_height, "{}: the height at column {}, row {} is {}", what,
                                col, row, z);
            line[col++] = std::isnan(z) ? nodata_height : z;
        }
        refuse_if<IoError>(band.RasterIO(GF_Write, 0, static_cast<int>(row), static_cast<int>(dem.width()), 1,
                                         line.data(), static_cast<int>(dem.width()), 1, GDT_Float32, 0, 0,
                                         nullptr) != CE_None,
                           "{}: no copy in memory", what);
    }
    return dataset;
}

} // namespace thalweg::io
