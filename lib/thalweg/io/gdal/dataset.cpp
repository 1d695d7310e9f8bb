// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/dataset.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/archive.hpp>
#include <thalweg/io/gdal/internal/gdal_guard.hpp>
#include <thalweg/io/gdal/internal/recipe_formats.hpp>
#include <thalweg/io/gdal/internal/undisturbed.hpp>

namespace thalweg::io {

void CloseDataset::operator()(GDALDataset* dataset) const {
    GDALClose(dataset);
}

namespace {

constexpr std::array<char const*, 2> databases{"PostgreSQL", nullptr};

bool is_postgres(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postg");
}

// What one data set needs as long as it is open, in this order.
struct Held {
    std::unique_ptr<Connection const> connection = {};
    std::unique_ptr<Undisturbed const> file = {};
    std::unique_ptr<WithNetcdf const> netcdf = {};
    std::unique_ptr<Confined const> folder = {};
    std::unique_ptr<Confined const> folder_of_copy = {};
};

// shown: the name in messages.
Dataset opened(std::string const& path, unsigned kinds, char const* const* drivers, std::shared_ptr<Held const> held,
               std::string const& shown) {
    char const* const* const options = held->file ? held->file->options() : nullptr;
    take_refusal();
    Dataset data(GDALDataset::Open(path.c_str(), kinds | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers, options),
                 {std::move(held)});
    throw_refusal(take_refusal(), "io.open_undisturbed: " + shown);
    return data;
}

Dataset open_connection(std::string const& path, unsigned kinds) {
    auto held = std::make_shared<Held>();
    held->connection = std::make_unique<Connection const>();
    std::vector<char const*> const files = recipe_drivers();
    return opened(path, kinds, is_postgres(path) ? databases.data() : files.data(), held, path);
}

Dataset open_recipe_file(std::string const& path, unsigned kinds) {
    require_allowed(path);
    auto held = std::make_shared<Held>();
    held->file = std::make_unique<Undisturbed const>(path);
    held->folder = std::make_unique<Confined const>(path);
    held->folder_of_copy = std::make_unique<Confined const>(held->file->path());
    std::string const name = inside_archive(held->file->path());
    std::vector<char const*> const drivers = recipe_drivers();
    Dataset data = opened(name, kinds, drivers.data(), held, path);
    if (data == nullptr) {
        refuse_other_format(name, path);
    }
    if (data != nullptr && data->GetDriver() != nullptr && EQUAL(data->GetDriver()->GetDescription(), "GPKG")) {
        require_own_tables(*data, path);
    }
    return data;
}

} // namespace

Dataset open_undisturbed(std::string const& path, unsigned kinds) {
    if (reads_recipe_files()) {
        return open_recipe_file(path, kinds);
    }
    if (names_connection(path)) {
        return open_connection(path, kinds);
    }
    auto held = std::make_shared<Held>();
    held->file = std::make_unique<Undisturbed const>(path);
    held->netcdf = std::make_unique<WithNetcdf const>(path);
    std::string const name = inside_archive(held->file->path());
    return opened(name, kinds, nullptr, held, path);
}

bool is_recipe_file(std::string const& path) {
    Driver const driver;
    RecipeFiles const strictly;
    try {
        bool const opens = open_undisturbed(path, GDAL_OF_RASTER | GDAL_OF_VECTOR) != nullptr;
        driver.take();
        return opens;
    } catch (BadInput const&) {
        driver.take();
        return false;
    }
}

Dataset open_file(std::string const& path, unsigned kinds, std::string const& what) {
    // GDAL takes addresses and connection strings for file names.
    if (std::error_code ignored; !std::filesystem::exists(path, ignored)) {
        throw BadInput(what + " does not exist");
    }
    CPLErrorReset();
    Dataset dataset = open_undisturbed(path, kinds);
    if (dataset == nullptr) {
        std::string const words = CPLGetLastErrorMsg();
        throw BadInput(fmt::format("{} cannot be read: {}", what, words.empty() ? "its format is not known" : words));
    }
    return dataset;
}

MemoryFile::MemoryFile() {
    static std::atomic<int> made{0};
    path_ = fmt::format("/vsimem/thalweg{}/file", ++made);
}

MemoryFile::~MemoryFile() {
    VSIRmdirRecursive(path_.substr(0, path_.rfind('/')).c_str());
}

std::string_view MemoryFile::bytes() const {
    vsi_l_offset size = 0;
    auto const* const data = reinterpret_cast<char const*>(VSIGetMemFileBuffer(path_.c_str(), &size, FALSE));
    return data == nullptr ? std::string_view() : std::string_view(data, size);
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
