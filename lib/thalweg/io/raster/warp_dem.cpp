// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <unistd.h>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>

namespace thalweg::io {
namespace {

std::string wkt_of(std::string const& crs) {
    if (crs.empty()) {
        return "";
    }
    OGRSpatialReference reference = read_reference(crs);
    reference.StripVertical();
    char* text = nullptr;
    reference.exportToWkt(&text);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

/// The cells of a grid's lattice that cover a data set.
Grid frame_for(GDALDataset& source, Grid const& grid, std::string const& wkt, About const& about,
               Driver const& driver) {
    CPLStringList options;
    if (!wkt.empty()) {
        options.SetNameValue("DST_SRS", wkt.c_str());
    }
    std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> const transformer(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&source), nullptr, options.List()),
        &GDALDestroyGenImgProjTransformer);
    std::array<double, 6> suggested{};
    std::array<double, 4> box{}; // west, south, east, north
    int columns = 0;
    int rows = 0;
    if (!transformer ||
        GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&source), GDALGenImgProjTransform, transformer.get(),
                                 suggested.data(), &columns, &rows, box.data(), 0) != CE_None) {
        throw BadInput(about.where,
                       fmt::format("{} cannot be reprojected to {:.60}: {}", about.name, grid.crs, driver.take()));
    }
    double const west = std::floor((box[0] - grid.west) / grid.cell_m);
    double const east = std::ceil((box[2] - grid.west) / grid.cell_m);
    double const north = std::floor((grid.north - box[3]) / grid.cell_m);
    double const south = std::ceil((grid.north - box[1]) / grid.cell_m);
    double const bytes = (east - west) * (south - north) * sizeof(float);
    double const there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    constexpr double most = std::numeric_limits<int>::max();
    refuse_if<BadInput>(!(bytes <= 0.5 * there && east - west <= most && south - north <= most), about.where,
                        "{} becomes {:.0f} x {:.0f} cells of {}, more than memory holds: cut a piece out of it first "
                        "(gdal_translate -srcwin)",
                        about.name, east - west, south - north, grid.cell_m);
    Grid frame = grid;
    frame.width = static_cast<std::int64_t>(std::max(east - west, 1.0));
    frame.height = static_cast<std::int64_t>(std::max(south - north, 1.0));
    frame.west = grid.west + west * grid.cell_m;
    frame.north = grid.north - north * grid.cell_m;
    return frame;
}

/// The cells of a grid that are cells of a DEM too.
Raster<float> cut(Raster<float> const& dem, Grid const& grid) {
    Raster<float> part(grid, std::numeric_limits<float>::quiet_NaN());
    Grid const& own = dem.grid();
    constexpr double far_away = 1e12; // [cells]
    auto const shift = [&](double m) { return std::llround(std::clamp(m / own.cell_m, -far_away, far_away)); };
    std::int64_t const east = shift(grid.west - own.west);
    std::int64_t const south = shift(own.north - grid.north);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const here = grid.at(i);
        Cell const there{here.col + east, here.row + south};
        part[i] = own.contains(there) ? dem[there] : part[i];
    }
    return part;
}

Raster<float> warped(Raster<float> const& dem, Grid const& frame, About const& about, Run const& run) {
    Driver const driver;
    Dataset const source = dataset_of(dem, about);
    std::string const wkt = wkt_of(frame.crs);
    CPLStringList words;
    auto const digits = [](double v) { return fmt::format("{:.17g}", v); };
    // Each position is transformed exactly (-et 0), not interpolated along a row.
    for (std::string const& word :
         {std::string("-of"), std::string("MEM"), std::string("-ot"), std::string("Float32"), std::string("-dstnodata"),
          std::string("nan"), std::string("-r"), std::string("bilinear"), std::string("-et"), std::string("0"),
          std::string("-novshift"), std::string("-te"), digits(frame.west), digits(frame.south()), digits(frame.east()),
          digits(frame.north), std::string("-ts"), fmt::format("{}", frame.width), fmt::format("{}", frame.height)}) {
        words.AddString(word.c_str());
    }
    if (!wkt.empty()) {
        words.AddString("-t_srs");
        words.AddString(wkt.c_str());
    }
    GdalProgress gdal_progress(run, "warp");
    std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> const options(
        GDALWarpAppOptionsNew(words.List(), nullptr), &GDALWarpAppOptionsFree);
    if (options == nullptr) {
        throw BadInput(about.where,
                       fmt::format("{} cannot be warped to cells of {}: {}", about.name, frame.cell_m, driver.take()));
    }
    GDALWarpAppOptionsSetProgress(options.get(), &GdalProgress::step, &gdal_progress);
    GDALDatasetH from = GDALDataset::ToHandle(source.get());
    Dataset const made(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, options.get(), nullptr)));
    gdal_progress.settle();
    if (made == nullptr) {
        throw BadInput(about.where,
                       fmt::format("{} cannot be reprojected to {:.60}: {}", about.name, frame.crs, driver.take()));
    }
    Raster<float> result(frame);
    int const width = made->GetRasterXSize();
    int const height = made->GetRasterYSize();
    refuse_if<IoError>(made->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, result.values().data(), width,
                                                        height, GDT_Float32, 0, 0, nullptr) != CE_None,
                       about.where, "{}: the warped heights cannot be read", about.name);
    driver.check(about.where, about.name);
    return result;
}

Grid frame_around(Raster<float> const& dem, Grid const& lattice, About const& about) {
    Driver const driver;
    return frame_for(*dataset_of(dem, about), lattice, wkt_of(lattice.crs), about, driver);
}

} // namespace

Grid grid_around(Raster<float> const& dem, Grid const& lattice, std::string const& what) {
    return frame_around(dem, lattice, {"io.grid_around", what});
}

Raster<float> resample(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run) {
    About const about{"io.resample", what};
    bool const is_same = is_same_crs(dem.grid().crs, grid.crs, about, "the grid");
    return is_same && same_lattice(dem.grid(), grid) ? cut(dem, grid) : warped(dem, grid, about, run);
}

Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run) {
    About const about{"io.warp_to_grid", what};
    bool const is_same = is_same_crs(dem.grid().crs, grid.crs, about, "the grid");
    return is_same && same_size(dem.grid(), grid) ? dem : warped(dem, frame_around(dem, grid, about), about, run);
}

} // namespace thalweg::io
