// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/read_dem.hpp>

#include <filesystem>
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
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {
namespace {

constexpr std::array<double, 4> no_terrain{-9999.0, -32767.0, -32768.0, -99999.0};
constexpr double deepest_sea = -12000.0;
constexpr std::int32_t block_side = 3;

std::string remedy(double stored, std::string const& path) {
    return fmt::format("declare it (gdal_edit.py -a_nodata {0:.9g} {1}), or use --nodata {0:.9g} where the command has "
                       "that option",
                       stored, path);
}

} // namespace

bool stands_for(double stored, double named) {
    constexpr double largest = 1e30; // matches 3.4e38 for 3.4028235e38
    return stored == named || static_cast<float>(stored) == static_cast<float>(named) ||
           (std::fabs(stored) > largest && std::fabs(named) > largest && (stored > 0.0) == (named > 0.0));
}

bool declares_nodata(GDALRasterBand& band) {
    return (band.GetMaskFlags() & GMF_ALL_VALID) == 0;
}

std::string implausible_words(std::int64_t col, std::int64_t row, double stored) {
    return fmt::format("the height at column {}, row {} is {}: is the file damaged? A value that stands for no-data "
                       "must be declared (gdal_edit.py -a_nodata {:.9g}) or named (--nodata {:.9g})",
                       col, row, stored, stored, stored);
}

UndeclaredNodata::UndeclaredNodata(int width, ReadDemParams const& params, bool is_declared)
    : searches_(!params.nodata), searches_blocks_(params.values == CellValues::heights && !is_declared) {
    low_.run.assign(static_cast<std::size_t>(width), 0);
    high_.run = low_.run;
    for (std::size_t i = 0; i < no_terrain.size(); ++i) {
        sentinels_[i].value = no_terrain[i];
    }
}

void UndeclaredNodata::Extreme::add(std::size_t col, double z) {
    if (z < value) {
        next = value;
        value = z;
        std::ranges::fill(run, 0);
        block.reset();
    } else if (z > value && z < next) {
        next = z;
    }
    run[col] = z == value ? run[col] + 1 : 0;
}

void UndeclaredNodata::Extreme::end_row(std::int64_t row) {
    std::int64_t wide = 0;
    for (std::size_t col = 0; col < run.size() && !block; ++col) {
        wide = run[col] >= block_side ? wide + 1 : 0;
        if (wide == block_side) {
            block = {static_cast<std::int64_t>(col) - 1, row - 1};
        }
    }
}

void UndeclaredNodata::note_sentinel(std::int64_t col, double z) {
    bool const is_sentinel = std::ranges::find(no_terrain, z) != no_terrain.end();
    for (Sentinel& s : sentinels_) {
        if (z == s.value) {
            s.first = s.count == 0 ? std::array{col, row_} : s.first;
            ++s.count;
        }
        s.is_depth = s.is_depth || (!is_sentinel && s.value > deepest_sea && z < s.value && z > deepest_sea);
    }
}

void UndeclaredNodata::add_row(std::span<double const> stored) {
    constexpr double deep = -9000.0;
    if (searches_) {
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double const z = stored[col];
            if (z < deep) {
                note_sentinel(static_cast<std::int64_t>(col), z);
            }
            if (searches_blocks_) { // NaN is skipped by both
                low_.add(col, z);
                high_.add(col, -z);
            }
        }
        if (searches_blocks_) {
            low_.end_row(row_);
            high_.end_row(row_);
        }
    }
    ++row_;
}

void UndeclaredNodata::require_none(std::string const& what, std::string const& path) const {
    for (Sentinel const& s : sentinels_) {
        if (s.count > 0 && !s.is_depth) {
            throw BadInput(fmt::format("{} has {} cells of {:g}, the first at column {}, row {}: no terrain has this "
                                       "height, and the file does not declare it as no-data. If it is, {}; --nodata "
                                       "nan takes it as a height",
                                       what, s.count, s.value, s.first[0], s.first[1], remedy(s.value, path)));
        }
    }
    double const gap_below = low_.next - low_.value;
    double const gap_above = high_.next - high_.value;
    double const range_above = -high_.value - low_.next;
    double const range_below = -high_.next - low_.value;
    auto const refuse = [&](Extreme const& e, double value, double gap, double range) {
        if (e.block && value != 0.0 && std::isfinite(gap) && range > 0.0 && gap > range) {
            throw BadInput(fmt::format("{} has a block of cells of {:.9g} around column {}, row {}, {:.6g} apart from "
                                       "every other value, and these differ by {:.6g} only: it looks like no-data "
                                       "that the file does not declare. If it is, {}; if it is terrain, use --nodata "
                                       "nan, or declare another value",
                                       what, value, (*e.block)[0], (*e.block)[1], gap, range, remedy(value, path)));
        }
    };
    refuse(low_, low_.value, gap_below, range_above);
    refuse(high_, -high_.value, gap_above, range_below);
}

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
    refuse_if<BadInput>(skew_x != 0.0 || skew_y != 0.0, "{} is rotated: warp it to a north-up grid (gdalwarp)", what);
    refuse_if<BadInput>(!(dx > 0.0) || !(dy < 0.0), "{} is not north-up: warp it (gdalwarp)", what);
    refuse_if<BadInput>(!are_squares(dx, -dy, dataset.GetRasterXSize(), dataset.GetRasterYSize()),
                        "{} has cells of {} x {}, not squares: warp it (gdalwarp -tr {} {})", what, dx, -dy, dx, dx);
    grid.west = west;
    grid.north = north;
    grid.cell_m = dx;
    return grid;
}

void require_memory(Grid const& grid, std::string const& what) {
    double const needed = static_cast<double>(grid.cells()) * sizeof(float);
    double const there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    refuse_if<BadInput>(needed > there, "{} of {} x {} cells is larger than memory", what, grid.width, grid.height);
}

enum class Unit : std::uint8_t { metre, stored };

/// Cells replaced by no data although the file does not declare them.
struct TakenAway {
    std::int64_t named = 0; ///< cells with the value that params names
    std::int64_t nan = 0;
};

std::vector<Finding> findings_of(TakenAway const& taken, ReadDemParams const& params, std::string const& path) {
    std::string const name = std::filesystem::path(path).filename().string();
    std::vector<Finding> findings;
    if (params.nodata && !std::isnan(*params.nodata)) {
        findings.push_back({.kind = "named_nodata",
                            .amount = static_cast<double>(taken.named),
                            .text = fmt::format("{}: {} cells of {:g} are no-data", name, taken.named, *params.nodata),
                            .layer = name});
    }
    if (taken.nan > 0) {
        findings.push_back({.kind = "nan_cells",
                            .amount = static_cast<double>(taken.nan),
                            .text = fmt::format("{}: {} cells are NaN and count as no-data", name, taken.nan),
                            .layer = name});
    }
    return findings;
}

DemFile read(Source const& source, Unit wanted, ReadDemParams const& params, Run const& run) {
    std::string const what = "io.read_dem: " + source.path;
    Driver const driver;
    Dataset const dataset = open_file(source, GDAL_OF_RASTER, what);
    refuse_if<BadInput>(dataset->GetRasterCount() != 1, "{} has {} bands: a DEM has one", what,
                        dataset->GetRasterCount());
    Grid const grid = frame_of(*dataset, what);
    require_memory(grid, what);
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    refuse_if<BadInput>(GDALDataTypeIsComplex(band.GetRasterDataType()) != 0, "{} holds complex numbers, not heights",
                        what);
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
    refuse_if<BadInput>(empty, "{} holds no heights, only no-data", what);
    undeclared.require_none(what, source.path);
    return {std::move(dem), findings_of(taken, params, source.path)};
}

} // namespace

DemFile read_dem_file(Source const& source, ReadDemParams const& params, Run const& run) {
    return read(source, Unit::metre, params, run);
}

Raster<float> read_dem(Source const& source, ReadDemParams const& params, Run const& run) {
    return read_dem_file(source, params, run).dem;
}

Raster<float> read_dem(Source const& source, Run const& run) {
    return read_dem_file(source, {}, run).dem;
}

Raster<float> read_stored_dem(Source const& source, ReadDemParams const& params, Run const& run) {
    return read(source, Unit::stored, params, run).dem;
}

bool has_square_cells(Source const& source) {
    Driver const driver;
    Dataset const dataset = open_file(source, GDAL_OF_RASTER, "io.read_dem: " + source.path);
    std::array<double, 6> place{};
    bool const is_placed = dataset->GetGeoTransform(place.data()) == CE_None;
    auto const [west, dx, skew_x, north, skew_y, dy] = place;
    bool const is_north_up = skew_x == 0.0 && skew_y == 0.0 && dx > 0.0 && dy < 0.0;
    return !is_placed || !is_north_up || are_squares(dx, -dy, dataset->GetRasterXSize(), dataset->GetRasterYSize());
}

Mask read_mask(Source const& source, Grid const& grid, Run const& run) {
    Raster<float> const values = read_dem(source, {.values = CellValues::numbers}, run);
    std::string const what = "io.read_mask: " + source.path;
    Grid const& own = values.grid();
    refuse_if<BadInput>(!same_cells(own, grid),
                        "{} has {} x {} cells of {} from ({}, {}), the grid {} x {} of {} from ({}, {}): a mask has "
                        "the grid's cells (gdalwarp -te ... -ts ...)",
                        what, own.width, own.height, own.cell_m, own.west, own.north, grid.width, grid.height,
                        grid.cell_m, grid.west, grid.north);
    refuse_if<BadInput>(!same_crs(own.crs, grid.crs, what, "the grid"),
                        "{} is in {:.60}, the grid in {:.60}: warp it (gdalwarp -t_srs)", what, own.crs, grid.crs);
    Mask mask(grid);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        mask[i] = !std::isnan(values[i]) && values[i] != 0.0F ? 1 : 0;
    }
    return mask;
}

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
    refuse_if<BadInput>(!(bytes <= 0.5 * there && east - west <= most && south - north <= most),
                        "{} becomes {:.0f} x {:.0f} cells of {}, more than memory holds: cut a piece out of it first "
                        "(gdal_translate -srcwin)",
                        what, east - west, south - north, grid.cell_m);
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

Raster<float> warped(Raster<float> const& dem, Grid const& frame, std::string const& what, Run const& run) {
    Driver const driver;
    Dataset const source = in_memory(dem, what);
    std::string const wkt = wkt_of(frame.crs);
    CPLStringList words;
    auto const digits = [](double v) { return fmt::format("{:.17g}", v); };
    // Each position is transformed exactly (-et 0), not interpolated along a row.
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
    GdalProgress gdal_progress(run, "warp");
    std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> const options(
        GDALWarpAppOptionsNew(words.List(), nullptr), &GDALWarpAppOptionsFree);
    if (options == nullptr) {
        throw BadInput(fmt::format("{} cannot be warped to cells of {}: {}", what, frame.cell_m, driver.take()));
    }
    GDALWarpAppOptionsSetProgress(options.get(), &GdalProgress::step, &gdal_progress);
    GDALDatasetH from = GDALDataset::ToHandle(source.get());
    Dataset const made(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, options.get(), nullptr)));
    gdal_progress.settle();
    if (made == nullptr) {
        throw BadInput(fmt::format("{} cannot be reprojected to {:.60}: {}", what, frame.crs, driver.take()));
    }
    Raster<float> result(frame);
    int const width = made->GetRasterXSize();
    int const height = made->GetRasterYSize();
    refuse_if<IoError>(made->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, result.values().data(), width,
                                                        height, GDT_Float32, 0, 0, nullptr) != CE_None,
                       "{}: the warped heights cannot be read", what);
    driver.check(what);
    return result;
}

} // namespace

Grid grid_around(Raster<float> const& dem, Grid const& lattice, std::string const& what) {
    Driver const driver;
    return frame_for(*in_memory(dem, what), lattice, wkt_of(lattice.crs), what, driver);
}

Raster<float> resample(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run) {
    bool const is_same = same_crs(dem.grid().crs, grid.crs, what, "the grid");
    return is_same && same_lattice(dem.grid(), grid) ? cut(dem, grid) : warped(dem, grid, what, run);
}

Raster<float> warp_to_grid(Raster<float> const& dem, Grid const& grid, std::string const& what, Run const& run) {
    bool const is_same = same_crs(dem.grid().crs, grid.crs, what, "the grid");
    return is_same && same_size(dem.grid(), grid) ? dem : warped(dem, grid_around(dem, grid, what), what, run);
}

} // namespace thalweg::io
