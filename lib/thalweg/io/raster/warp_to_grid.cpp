// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/warp_to_grid.hpp>

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

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

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

/// The lattice cells of a grid that hold all of a data set.
Grid frame_for(GDALDataset& source, Grid const& grid, std::string const& wkt, std::string const& what,
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
        throw BadInput(fmt::format("{} cannot be reprojected to {:.60}: {}", what, grid.crs, driver.take()));
    }
    double const west = std::floor((box[0] - grid.west) / grid.cell_m);
    double const east = std::ceil((box[2] - grid.west) / grid.cell_m);
    double const north = std::floor((grid.north - box[3]) / grid.cell_m);
    double const south = std::ceil((grid.north - box[1]) / grid.cell_m);
    double const bytes = (east - west) * (south - north) * sizeof(float);
    double const there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    constexpr double most = std::numeric_limits<int>::max();
    if (!(bytes <= 0.5 * there && east - west <= most && south - north <= most)) {
        throw BadInput(fmt::format("{} becomes {:.0f} x {:.0f} cells of {}, more than memory holds: cut a piece out "
                                   "of it first (gdal_translate -srcwin)",
                                   what, east - west, south - north, grid.cell_m));
    }
    Grid frame = grid;
    frame.width = static_cast<std::int64_t>(std::max(east - west, 1.0));
    frame.height = static_cast<std::int64_t>(std::max(south - north, 1.0));
    frame.west = grid.west + west * grid.cell_m;
    frame.north = grid.north - north * grid.cell_m;
    return frame;
}

} // namespace

Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run) {
    if (same_crs(dem.grid().crs, grid.crs, what, "the grid") && same_size(dem.grid(), grid)) {
        return dem;
    }
    Driver const driver;
    Dataset const source = in_memory(dem, what);
    std::string const wkt = wkt_of(grid.crs);
    Grid const frame = frame_for(*source, grid, wkt, what, driver);
    CPLStringList words;
    auto const digits = [](double v) { return fmt::format("{:.17g}", v); };
    // Each place is transformed by itself (-et 0), not between some along a row.
    for (std::string const& word :
         {std::string("-of"), std::string("MEM"), std::string("-ot"), std::string("Float32"), std::string("-dstnodata"),
          std::string("nan"), std::string("-r"), std::string("bilinear"), std::string("-et"), std::string("0"),
          std::string("-te"), digits(frame.west), digits(frame.south()), digits(frame.east()), digits(frame.north),
          std::string("-ts"), fmt::format("{}", frame.width), fmt::format("{}", frame.height)}) {
        words.AddString(word.c_str());
    }
    if (!wkt.empty()) {
        words.AddString("-t_srs");
        words.AddString(wkt.c_str());
    }
    Watch watch(run, "warp");
    std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> const options(
        GDALWarpAppOptionsNew(words.List(), nullptr), &GDALWarpAppOptionsFree);
    if (options == nullptr) {
        throw BadInput(fmt::format("{} cannot be warped to cells of {}: {}", what, grid.cell_m, driver.take()));
    }
    GDALWarpAppOptionsSetProgress(options.get(), &Watch::step, &watch);
    GDALDatasetH from = GDALDataset::ToHandle(source.get());
    Dataset const warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, options.get(), nullptr)));
    watch.settle();
    if (warped == nullptr) {
        throw BadInput(fmt::format("{} cannot be reprojected to {:.60}: {}", what, grid.crs, driver.take()));
    }
    Raster<float> result(frame);
    int const width = warped->GetRasterXSize();
    int const height = warped->GetRasterYSize();
    if (warped->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, result.values().data(), width, height,
                                           GDT_Float32, 0, 0, nullptr) != CE_None) {
        throw IoError(what + ": the warped heights cannot be read");
    }
    driver.check(what);
    return result;
}

} // namespace thalweg::io
