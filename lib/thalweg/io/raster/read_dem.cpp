// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/read_dem.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>
#include <gdal_priv.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/plausible.hpp>
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

namespace thalweg::io {

namespace {

Grid frame_of(GDALDataset& dataset, std::string const& what) {
    Grid grid;
    grid.width = dataset.GetRasterXSize();
    grid.height = dataset.GetRasterYSize();
    if (auto const* const reference = dataset.GetSpatialRef(); reference != nullptr && reference->IsEmpty() == 0) {
        grid.crs = name_of(*reference);
    }
    std::array<double, 6> place{};
    if (dataset.GetGeoTransform(place.data()) != CE_None) {
        grid.north = static_cast<double>(grid.height);
        return grid;
    }
    auto const [west, dx, skew_x, north, skew_y, dy] = place;
    if (skew_x != 0.0 || skew_y != 0.0) {
        throw BadInput(what + " is rotated: warp it to a north-up grid (gdalwarp)");
    }
    if (!(dx > 0.0) || !(dy < 0.0)) {
        throw BadInput(what + " is not north-up: warp it (gdalwarp)");
    }
    if (!are_squares(dx, -dy, dataset.GetRasterXSize(), dataset.GetRasterYSize())) {
        throw BadInput(
            fmt::format("{} has cells of {} x {}, not squares: warp it (gdalwarp -tr {} {})", what, dx, -dy, dx, dx));
    }
    grid.west = west;
    grid.north = north;
    grid.cell_m = dx;
    return grid;
}

void require_memory(Grid const& grid, std::string const& what) {
    double const needed = static_cast<double>(grid.cells()) * sizeof(float);
    double const there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (needed > there) {
        throw BadInput(fmt::format("{} of {} x {} cells is larger than memory", what, grid.width, grid.height));
    }
}

enum class Unit : std::uint8_t { metre, stored };

/// What became of cells that the file does not declare as no-data.
struct TakenAway {
    std::int64_t named = 0; ///< of the value that params names
    std::int64_t nan = 0;
};

void tell_of(TakenAway const& taken, ReadDemParams const& params, std::string const& path, Run const& run) {
    std::string const name = std::filesystem::path(path).filename().string();
    if (params.nodata && !std::isnan(*params.nodata)) {
        run.tell("note", fmt::format("{}: {} cells of {:g} are no-data", name, taken.named, *params.nodata));
    }
    if (taken.nan > 0) {
        run.tell("note", fmt::format("{}: {} cells are NaN and count as no-data", name, taken.nan));
    }
}

Raster<float> read(std::string const& path, Unit wanted, ReadDemParams const& params, Run const& run) {
    std::string const what = "io.read_dem: " + path;
    Driver const driver;
    Dataset const dataset = open_file(path, GDAL_OF_RASTER, what);
    if (dataset->GetRasterCount() != 1) {
        throw BadInput(fmt::format("{} has {} bands: a DEM has one", what, dataset->GetRasterCount()));
    }
    Grid const grid = frame_of(*dataset, what);
    require_memory(grid, what);
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    if (GDALDataTypeIsComplex(band.GetRasterDataType()) != 0) {
        throw BadInput(what + " holds complex numbers, not heights");
    }
    double const unit = wanted == Unit::metre ? height_unit_of(*dataset) : 1.0;
    double const scale = band.GetScale() * unit;
    double const offset = band.GetOffset() * unit;
    bool const scaled = scale != 1.0 || offset != 0.0;
    int const width = dataset->GetRasterXSize();

    Raster<float> dem(grid);
    std::vector<double> heights(static_cast<std::size_t>(width));
    std::vector<std::uint8_t> valid(static_cast<std::size_t>(width));
    UndeclaredNodata undeclared(width, params, declares_nodata(band));
    TakenAway taken;
    bool empty = true;
    for (int row = 0; row < dataset->GetRasterYSize(); ++row) {
        run.at(static_cast<double>(row) / static_cast<double>(grid.height), "read");
        auto const read_row = [&](GDALRasterBand& from, void* to, GDALDataType type) {
            if (from.RasterIO(GF_Read, 0, row, width, 1, to, width, 1, type, 0, 0, nullptr) != CE_None) {
                driver.check(what);
                throw IoError(fmt::format("{}: row {} cannot be read", what, row));
            }
        };
        read_row(band, heights.data(), GDT_Float64);
        read_row(*band.GetMaskBand(), valid.data(), GDT_Byte);
        for (std::size_t col = 0; float& z : dem.row(row)) {
            double const stored = heights[col];
            double const height = scaled ? stored * scale + offset : stored; // -0 stays -0
            bool const is_named = valid[col] != 0 && params.nodata && stands_for(stored, *params.nodata);
            bool const is_nan = valid[col] != 0 && std::isnan(height);
            bool const known = valid[col] != 0 && !is_nan && !is_named;
            taken.named += is_named ? 1 : 0;
            taken.nan += is_nan ? 1 : 0;
            if (known && !(std::fabs(height) <= implausible_height)) {
                throw BadInput(
                    fmt::format("{}: {}", what, implausible_words(static_cast<std::int64_t>(col), row, stored)));
            }
            heights[col] = known ? stored : std::numeric_limits<double>::quiet_NaN();
            z = known ? static_cast<float>(height) : std::numeric_limits<float>::quiet_NaN();
            empty = empty && !known;
            ++col;
        }
        undeclared.add_row(heights);
    }
    driver.check(what);
    if (empty) {
        throw BadInput(what + " holds no heights, only no-data");
    }
    undeclared.require_none(what, path);
    tell_of(taken, params, path, run);
    return dem;
}

} // namespace

Raster<float> read_dem(std::string const& path, ReadDemParams const& params, Run const& run) {
    return read(path, Unit::metre, params, run);
}

Raster<float> read_dem(std::string const& path, Run const& run) {
    return read(path, Unit::metre, {}, run);
}

Raster<float> read_stored_dem(std::string const& path, ReadDemParams const& params, Run const& run) {
    return read(path, Unit::stored, params, run);
}

bool has_square_cells(std::string const& path) {
    Driver const driver;
    Dataset const dataset = open_file(path, GDAL_OF_RASTER, "io.read_dem: " + path);
    std::array<double, 6> place{};
    bool const is_placed = dataset->GetGeoTransform(place.data()) == CE_None;
    auto const [west, dx, skew_x, north, skew_y, dy] = place;
    bool const is_north_up = skew_x == 0.0 && skew_y == 0.0 && dx > 0.0 && dy < 0.0;
    return !is_placed || !is_north_up || are_squares(dx, -dy, dataset->GetRasterXSize(), dataset->GetRasterYSize());
}

} // namespace thalweg::io
