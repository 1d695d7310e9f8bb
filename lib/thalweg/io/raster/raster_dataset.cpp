// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/raster_dataset.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
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

void require_size(Grid const& grid, About const& about) {
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    refuse_if<BadInput>(grid.width < 1 || grid.height < 1 || grid.width > most || grid.height > most, about.where,
                        "{}a raster of {} x {} cells", about.beginning(), grid.width, grid.height);
}

namespace {

template <class T> Dataset framed(Grid const& grid, T no_data, RowPart<T> part) {
    Dataset dataset = rows_dataset(grid.width, grid.height, no_data, std::move(part));
    set_frame(*dataset, grid);
    return dataset;
}

} // namespace

Dataset dataset_of(Grid const& grid, float no_data, RowPart<float> part) {
    return framed(grid, no_data, std::move(part));
}

Dataset dataset_of(Grid const& grid, std::int32_t no_data, RowPart<std::int32_t> part) {
    return framed(grid, no_data, std::move(part));
}

Dataset dataset_of(Raster<float> const& dem, About const& about) {
    require_size(dem.grid(), about);
    auto const bad = std::ranges::find_if(dem.values(), [](float z) { return std::isinf(z) || z == nodata_height; });
    if (bad != dem.values().end()) {
        Cell const c = dem.grid().at(bad - dem.values().begin());
        throw BadInput(about.where,
                       fmt::format("{}the height at column {}, row {} is {}", about.beginning(), c.col, c.row, *bad));
    }
    return dataset_of(dem.grid(), nodata_height, [&dem](std::int64_t row, std::int64_t col, std::span<float> part) {
        auto const from = dem.row(row).subspan(static_cast<std::size_t>(col), part.size());
        std::ranges::transform(from, part.begin(), [](float z) { return std::isnan(z) ? nodata_height : z; });
    });
}

} // namespace thalweg::io
