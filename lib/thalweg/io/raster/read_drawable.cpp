// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/read_drawable.hpp>

#include <memory>
#include <utility>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>

namespace thalweg::io {

namespace {

using Frame = std::array<double, 6>;

constexpr double widest_zone_deg = 12.0;

OGRSpatialReference const* reference_of(GDALDataset& dataset) {
    OGRSpatialReference const* const reference = dataset.GetSpatialRef();
    return reference != nullptr && reference->IsEmpty() == 0 ? reference : nullptr;
}

std::optional<Frame> frame_of(GDALDataset& dataset) {
    Frame frame{};
    return dataset.GetGeoTransform(frame.data()) == CE_None ? std::optional(frame) : std::nullopt;
}

bool is_square_and_north_up(Frame const& frame, int width, int height) {
    return frame[2] == 0.0 && frame[4] == 0.0 && frame[1] > 0.0 && frame[5] < 0.0 &&
           are_squares(frame[1], -frame[5], width, height);
}

/// The projection in which a raster on the globe is drawn.
OGRSpatialReference projection_for(GDALDataset& dataset, Frame const& frame, std::string const& what) {
    OGRSpatialReference from(*reference_of(dataset));
    from.StripVertical();
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference const globe = read_reference("EPSG:4326");
    std::unique_ptr<OGRCoordinateTransformation> const turn(OGRCreateCoordinateTransformation(&from, &globe));
    if (!turn) {
        throw BadInput(what + ": its CRS leads to no longitude and latitude; assign another (gdal_edit.py -a_srs)");
    }
    auto const place = [&](double col, double row) {
        double x = frame[0] + col * frame[1] + row * frame[2];
        double y = frame[3] + col * frame[4] + row * frame[5];
        refuse_if<BadInput>(turn->Transform(1, &x, &y) == 0 || !std::isfinite(x) || !std::isfinite(y),
                            "{} lies where its CRS has no longitude and latitude; check its position", what);
        return Vec2{x, y};
    };
    double const width = dataset.GetRasterXSize();
    double const height = dataset.GetRasterYSize();
    Vec2 const middle = place(0.5 * width, 0.5 * height);
    double wide_deg = 0.0;
    for (double const row : {0.0, 0.5 * height, height}) {
        double const off = std::fabs(place(width, row).x - place(0.0, row).x);
        wide_deg = std::max(wide_deg, off);
    }
    if (wide_deg <= widest_zone_deg && middle.y > -80.0 && middle.y < 84.0) {
        return read_reference(utm_zone(middle.x, middle.y));
    }
    return equal_area_around(middle.x, middle.y);
}

/// The same for a raster in metres with wrong lengths; nothing: no other projection is better.
std::optional<OGRSpatialReference> less_distorted_for(GDALDataset& dataset, Frame const& frame,
                                                      std::string const& what) {
    OGRSpatialReference const& own = *reference_of(dataset);
    double const wide = dataset.GetRasterXSize();
    double const high = dataset.GetRasterYSize();
    auto const ends = [&](double at, double by_col, double by_row) {
        return std::minmax({at, at + wide * by_col, at + high * by_row, at + wide * by_col + high * by_row});
    };
    auto const [west, east] = ends(frame[0], frame[1], frame[2]);
    auto const [south, north] = ends(frame[3], frame[4], frame[5]);
    FileBox const box{{west, south}, {east, north}};
    if (!is_distorted(own, box)) {
        return std::nullopt;
    }
    try {
        OGRSpatialReference other = projection_for(dataset, frame, what);
        return is_better(other, own, box) ? std::optional(std::move(other)) : std::nullopt;
    } catch (BadInput const&) { // a corner is off the globe, as on world maps
        return std::nullopt;
    }
}

using Target = OGRSpatialReference const*; ///< the projection to warp to; null: only to north-up squares

std::string exported_wkt(OGRSpatialReference const& reference) {
    char* text = nullptr;
    reference.exportToWkt(&text);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

/// Squares that cover a raster after warping.
struct Squares {
    Frame frame{};
    double wide = 0.0; ///< [m], like the other lengths
    double high = 0.0;
    double finest = 0.0; ///< as suggested by GDAL
    double cell = 0.0;   ///< so that no side exceeds the limit
};

Squares squares_for(GDALDataset& source, Target target, std::int64_t most_side, std::string const& what,
                    Driver const& driver) {
    CPLStringList options;
    if (target != nullptr) {
        options.SetNameValue("DST_SRS", exported_wkt(*target).c_str());
    }
    std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> const transformer(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&source), nullptr, options.List()),
        &GDALDestroyGenImgProjTransformer);
    Squares squares;
    Frame& frame = squares.frame;
    int columns = 0;
    int rows = 0;
    if (!transformer || GDALSuggestedWarpOutput(GDALDataset::ToHandle(&source), GDALGenImgProjTransform,
                                                transformer.get(), frame.data(), &columns, &rows) != CE_None) {
        throw BadInput(fmt::format("{} cannot be warped to be drawn: {}", what, driver.take()));
    }
    squares.wide = frame[1] * columns;
    squares.high = -frame[5] * rows;
    squares.finest = std::min(frame[1], -frame[5]);
    squares.cell = std::max(squares.finest, std::max(squares.wide, squares.high) / static_cast<double>(most_side));
    return squares;
}

CPLStringList warp_arguments(Squares const& squares, Target target) {
    CPLStringList arguments;
    auto const add = [&](std::initializer_list<std::string> words) {
        for (std::string const& word : words) {
            arguments.AddString(word.c_str());
        }
    };
    auto const digits = [](double v) { return fmt::format("{:.17g}", v); };
    Frame const& frame = squares.frame;
    double const cell = squares.cell;
    add({"-of", "MEM", "-ot", "Float32", "-dstnodata", "nan", "-r", cell > squares.finest ? "average" : "bilinear"});
    add({"-te", digits(frame[0]), digits(frame[3] - std::max(cell, squares.high)),
         digits(frame[0] + std::max(cell, squares.wide)), digits(frame[3]), "-tr", digits(cell), digits(cell)});
    if (target != nullptr) {
        add({"-t_srs", exported_wkt(*target)});
    }
    return arguments;
}

/// Older GDAL warps every band: a virtual copy of the first one avoids that.
Dataset first_band_of(GDALDataset& source, std::string const& what, Driver const& driver,
                      std::vector<std::string> const& more = {}) {
    CPLStringList first;
    for (char const* word : {"-of", "VRT", "-b", "1"}) {
        first.AddString(word);
    }
    for (std::string const& word : more) {
        first.AddString(word.c_str());
    }
    std::unique_ptr<GDALTranslateOptions, decltype(&GDALTranslateOptionsFree)> const options(
        GDALTranslateOptionsNew(first.List(), nullptr), &GDALTranslateOptionsFree);
    Dataset band(GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&source), options.get(), nullptr)));
    if (band == nullptr) {
        throw IoError(fmt::format("{}: its first band cannot be taken: {}", what, driver.take()));
    }
    return band;
}

struct Warped {
    Dataset dataset;
    double cell = 1.0;
};

/// Warps to north-up squares, in another projection if one is given.
Warped warp(GDALDataset& source, Target target, std::int64_t most_side, std::string const& what, Driver const& driver,
            Run const& run) {
    double const own_cell = frame_of(source).value_or(Frame{})[1];
    Squares const squares = squares_for(source, target, most_side, what, driver);
    CPLStringList arguments = warp_arguments(squares, target);
    Dataset const band_one = first_band_of(source, what, driver);
    GdalProgress gdal_progress(run, "warp");
    std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> const warp_options(
        GDALWarpAppOptionsNew(arguments.List(), nullptr), &GDALWarpAppOptionsFree);
    if (warp_options == nullptr) { // GDAL misread the arguments
        throw BadInput(
            fmt::format("{} cannot be warped to be drawn: its cells of {} are too small for its position: {}", what,
                        own_cell, driver.take()));
    }
    GDALWarpAppOptionsSetProgress(warp_options.get(), &GdalProgress::step, &gdal_progress);
    GDALDatasetH from = GDALDataset::ToHandle(band_one.get());
    Dataset warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, warp_options.get(), nullptr)));
    gdal_progress.settle();
    if (warped == nullptr) {
        throw BadInput(fmt::format("{} cannot be warped to be drawn: {}", what, driver.take()));
    }
    driver.check(what);
    return {std::move(warped), squares.cell};
}

/// Reads the first band, k x k cells in one.
Raster<float> read_means(GDALDataset& dataset, Grid const& grid, std::int64_t k, double scale, double offset,
                         std::string const& what, Driver const& driver, Run const& run) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    int has_nodata = 0;
    double const nodata = band.GetNoDataValue(&has_nodata);
    bool const float_nodata = band.GetRasterDataType() == GDT_Float32;
    bool const masked = (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
    GDALRasterIOExtraArg average;
    INIT_RASTERIO_EXTRA_ARG(average);
    average.eResampleAlg = GRIORA_Average;
    GDALRasterIOExtraArg* const how = k > 1 ? &average : nullptr;
    int const width = static_cast<int>(grid.width);
    int const wide = static_cast<int>(std::min<std::int64_t>(grid.width * k, dataset.GetRasterXSize()));
    constexpr std::int64_t rows_at_once = 64; // few enough to stop soon, enough to read a row of tiles once or twice
    Raster<float> dem(grid);
    std::vector<double> heights;
    std::vector<std::uint8_t> valid;
    bool empty = true;
    for (std::int64_t row = 0; row < grid.height; row += rows_at_once) {
        run.at(static_cast<double>(row) / static_cast<double>(grid.height), "read");
        std::int64_t const rows = std::min(rows_at_once, grid.height - row);
        int const high = static_cast<int>(std::min(rows * k, dataset.GetRasterYSize() - row * k));
        auto const read = [&](GDALRasterBand& from, void* to, GDALDataType type, GDALRasterIOExtraArg* extra) {
            if (from.RasterIO(GF_Read, 0, static_cast<int>(row * k), wide, high, to, width, static_cast<int>(rows),
                              type, 0, 0, extra) != CE_None) {
                driver.check(what);
                throw IoError(fmt::format("{}: rows from {} on cannot be read", what, row * k));
            }
        };
        heights.resize(static_cast<std::size_t>(rows * grid.width));
        read(band, heights.data(), GDT_Float64, how);
        if (masked) {
            valid.resize(heights.size());
            read(*band.GetMaskBand(), valid.data(), GDT_Byte, how);
        }
        for (std::size_t i = 0; i < heights.size(); ++i) {
            double const raw = heights[i];
            bool const is_nodata =
                has_nodata != 0 &&
                (raw == nodata || (float_nodata && static_cast<float>(raw) == static_cast<float>(nodata)));
            double const z = raw * scale + offset;
            bool const known = !is_nodata && !(masked && valid[i] == 0) && !std::isnan(z);
            if (known && !(std::fabs(z) <= implausible_height)) {
                throw BadInput(
                    fmt::format("{}: {}", what,
                                implausible_words(static_cast<std::int64_t>(i) % grid.width * k,
                                                  (row + static_cast<std::int64_t>(i) / grid.width) * k, raw)));
            }
            dem[row * grid.width + static_cast<std::int64_t>(i)] =
                known ? static_cast<float>(z) : std::numeric_limits<float>::quiet_NaN();
            empty = empty && !known;
        }
    }
    driver.check(what);
    refuse_if<BadInput>(empty, "{} holds no heights, only no-data", what);
    return dem;
}

/// Cells of the first band that the file does not declare as no-data.
struct StoredNodata {
    std::int64_t named = 0;      ///< cells with the value that params names
    std::optional<double> value; ///< this value as stored
    std::int64_t nan = 0;
};

/// Reads all of the first band: means and warped heights no longer show undeclared no-data.
StoredNodata stored_nodata_in(GDALDataset& source, ReadDrawableParams const& params, std::string const& path,
                              std::string const& what, Driver const& driver, Run const& run) {
    GDALRasterBand& band = *source.GetRasterBand(1);
    int const width = source.GetRasterXSize();
    UndeclaredNodata undeclared(width, {.nodata = params.nodata}, declares_nodata(band));
    StoredNodata found;
    std::vector<double> stored(static_cast<std::size_t>(width));
    std::vector<std::uint8_t> valid(stored.size());
    for (int row = 0; row < source.GetRasterYSize(); ++row) {
        run.at(static_cast<double>(row) / source.GetRasterYSize(), "read");
        if (band.RasterIO(GF_Read, 0, row, width, 1, stored.data(), width, 1, GDT_Float64, 0, 0, nullptr) != CE_None ||
            band.GetMaskBand()->RasterIO(GF_Read, 0, row, width, 1, valid.data(), width, 1, GDT_Byte, 0, 0, nullptr) !=
                CE_None) {
            driver.check(what);
            throw IoError(fmt::format("{}: row {} cannot be read", what, row));
        }
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double& z = stored[col];
            bool const is_named = valid[col] != 0 && params.nodata && stands_for(z, *params.nodata);
            if (is_named) {
                found.value = found.value.value_or(z);
                ++found.named;
            }
            found.nan += valid[col] != 0 && std::isnan(z) ? 1 : 0;
            z = valid[col] != 0 && !is_named ? z : std::numeric_limits<double>::quiet_NaN();
            if (std::fabs(z) > implausible_height) {
                throw BadInput(fmt::format("{}: {}", what, implausible_words(static_cast<std::int64_t>(col), row, z)));
            }
        }
        undeclared.add_row(stored);
    }
    driver.check(what);
    undeclared.require_none(what, path);
    return found;
}

/// The same raster with a no-data value of the first band.
Dataset with_nodata(GDALDataset& source, double stored, std::string const& what, Driver const& driver) {
    int is_declared = 0;
    double const declared = source.GetRasterBand(1)->GetNoDataValue(&is_declared);
    refuse_if<BadInput>(is_declared != 0 && declared != stored,
                        "{}: the file declares {:g} as no-data, --nodata names {:g}: draw takes one of them. Join them "
                        "first (gdal_calc.py, gdalwarp -srcnodata)",
                        what, declared, stored);
    return first_band_of(source, what, driver, {"-a_nodata", fmt::format("{:.17g}", stored)});
}

void require_heights(GDALDataset& source, std::string const& what) {
    refuse_if<BadInput>(source.GetRasterCount() < 1,
                        "{} has no bands of its own: name one of its subdatasets (gdalinfo lists them)", what);
    refuse_if<BadInput>(GDALDataTypeIsComplex(source.GetRasterBand(1)->GetRasterDataType()) != 0,
                        "{} holds complex numbers, not heights", what);
}

/// Converts the raster to north-up squares of metres; null: it is that already. Records the changes.
Dataset made_drawable(GDALDataset& source, ReadDrawableParams const& params, std::vector<Finding>& findings,
                      std::string const& what, Driver const& driver, Run const& run) {
    std::int64_t const most_side = params.most_side;
    std::optional<Frame> const placed = frame_of(source);
    OGRSpatialReference const* const reference = placed ? reference_of(source) : nullptr;
    Dataset warped;
    std::optional<OGRSpatialReference> target;
    if (placed && reference != nullptr && !is_projected_in_metres(*reference)) {
        target = projection_for(source, *placed, what);
    } else if (placed && reference != nullptr && params.metres == MetresOf::the_ground) {
        target = less_distorted_for(source, *placed, what);
    }
    if (target) {
        Warped done = warp(source, &*target, most_side, what, driver, run);
        char const* const name = target->GetName();
        findings.push_back({.kind = "dem_reprojected",
                            .amount = done.cell,
                            .text = fmt::format("warped from {} into {}, cells of {:.4g} m",
                                                reference->GetName() == nullptr ? "its CRS" : reference->GetName(),
                                                name == nullptr ? "metres" : name, done.cell)});
        warped = std::move(done.dataset);
    } else if (placed && !is_square_and_north_up(*placed, source.GetRasterXSize(), source.GetRasterYSize())) {
        Frame const& f = *placed;
        Warped done = warp(source, nullptr, most_side, what, driver, run);
        bool const turned = f[2] != 0.0 || f[4] != 0.0 || f[1] < 0.0 || f[5] > 0.0;
        findings.push_back({.kind = "turned_raster",
                            .amount = done.cell,
                            .text = turned ? fmt::format("turned north-up, cells of {:.6g} m", done.cell)
                                           : fmt::format("cells of {:.6g} x {:.6g} made squares of {:.6g} m", f[1],
                                                         -f[5], done.cell)});
        warped = std::move(done.dataset);
    }
    if (reference == nullptr) {
        findings.push_back({.kind = "no_crs",
                            .text = placed ? "it has no CRS: its coordinates are drawn as metres"
                                           : "it has no position: its cells are drawn as 1 m"});
    }
    return warped;
}

/// The grid of a raster read in blocks of k x k cells. is_placed: whether it has a position.
Grid grid_of_means(GDALDataset& ready, std::int64_t k, bool is_placed) {
    std::int64_t const width = ready.GetRasterXSize();
    std::int64_t const height = ready.GetRasterYSize();
    Grid grid;
    grid.width = std::max<std::int64_t>(1, width / k);
    grid.height = std::max<std::int64_t>(1, height / k);
    if (std::optional<Frame> const frame = frame_of(ready)) {
        grid.west = (*frame)[0];
        grid.north = (*frame)[3];
        grid.cell_m = (*frame)[1] * static_cast<double>(k);
    } else {
        grid.cell_m = static_cast<double>(k);
        grid.north = static_cast<double>(grid.height * k);
    }
    if (OGRSpatialReference const* const own = reference_of(ready); own != nullptr && is_placed) {
        grid.crs = name_of(*own);
    }
    return grid;
}

} // namespace

Drawable read_drawable(std::string const& path, ReadDrawableParams const& params, Run const& run) {
    std::string const what = "io.read_drawable: " + path;
    std::int64_t const most_side = params.most_side;
    require_in("io.read_drawable", "most_side", most_side, Range::between(16, 30000));
    Driver const driver;
    Dataset source = open_file(path, GDAL_OF_RASTER, what);
    require_heights(*source, what);
    constexpr double most_cells = 1e11; // read row by row, in minutes
    refuse_if<BadInput>(1.0 * source->GetRasterXSize() * source->GetRasterYSize() > most_cells,
                        "{} has {} x {} cells, too many to draw; take a part of it (gdal_translate -projwin) or larger "
                        "cells (gdalwarp -tr)",
                        what, source->GetRasterXSize(), source->GetRasterYSize());
    Drawable out;
    if (source->GetRasterCount() > 1) {
        out.findings.push_back({.kind = "bands",
                                .amount = static_cast<double>(source->GetRasterCount()),
                                .text = fmt::format("drawn from the first of {} bands", source->GetRasterCount())});
    }
    double const unit = height_unit_of(*source);
    if (unit != 1.0) {
        out.findings.push_back({.kind = "heights_in_metres",
                                .amount = unit,
                                .text = fmt::format("its heights, in {}, are drawn in metres", words_for_unit(unit))});
    }
    GDALRasterBand& band = *source->GetRasterBand(1);
    double const scale = band.GetScale() * unit;
    double const offset = band.GetOffset() * unit;
    StoredNodata const found = stored_nodata_in(*source, params, path, what, driver, run);
    if (params.nodata && !std::isnan(*params.nodata)) {
        out.findings.push_back({.kind = "named_nodata",
                                .amount = static_cast<double>(found.named),
                                .text = fmt::format("{} cells of {:g} are no-data", found.named, *params.nodata)});
    }
    if (found.nan > 0) {
        out.findings.push_back({.kind = "nan_cells",
                                .amount = static_cast<double>(found.nan),
                                .text = fmt::format("{} cells are NaN and count as no-data", found.nan)});
    }
    Dataset const declared = found.value ? with_nodata(*source, *found.value, what, driver) : nullptr;
    GDALDataset& known = declared ? *declared : *source;
    Dataset const warped = made_drawable(known, params, out.findings, what, driver, run);
    GDALDataset& ready = warped ? *warped : known;
    std::int64_t const longest = std::max(ready.GetRasterXSize(), ready.GetRasterYSize());
    std::int64_t const k = (longest + most_side - 1) / most_side;
    Grid const grid = grid_of_means(ready, k, frame_of(*source).has_value());
    if (k > 1) {
        out.findings.push_back({.kind = "reduced",
                                .amount = static_cast<double>(grid.cells()),
                                .text = fmt::format("drawn from means of {}x{} cells", k, k)});
    }
    out.dem = read_means(ready, grid, k, scale, offset, what, driver, run);
    return out;
}

} // namespace thalweg::io
