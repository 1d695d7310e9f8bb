// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/read_drawable.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/internal/opened_heights.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/raster/internal/read_dem.hpp>

namespace thalweg::io {
namespace {

/// The projection in which a raster on the globe is drawn.
OGRSpatialReference projection_for(OpenedHeights const& source, About const& about) {
    OGRSpatialReference const& from = *source.reference();
    std::unique_ptr<OGRSpatialReference> const globe(from.CloneGeogCS());
    std::unique_ptr<OGRCoordinateTransformation> const turn(
        globe ? (globe->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER),
                 OGRCreateCoordinateTransformation(&from, globe.get()))
              : nullptr);
    if (!turn) {
        throw BadInput(about.where,
                       about.name +
                           ": its CRS leads to no longitude and latitude; assign another (gdal_edit.py -a_srs)");
    }
    CellFrame const& frame = source.frame();
    auto const place = [&](double col, double row) {
        double x = frame[0] + col * frame[1] + row * frame[2];
        double y = frame[3] + col * frame[4] + row * frame[5];
        refuse_if<BadInput>(turn->Transform(1, &x, &y) == 0 || !std::isfinite(x) || !std::isfinite(y), about.where,
                            "{} lies where its CRS has no longitude and latitude; check its position", about.name);
        return Vec2{x, y};
    };
    double const width = source.width();
    double const height = source.height();
    Vec2 const middle = place(0.5 * width, 0.5 * height);
    double wide_deg = 0.0;
    for (double const row : {0.0, 0.5 * height, height}) {
        double const off = std::fabs(place(width, row).x - place(0.0, row).x);
        wide_deg = std::max(wide_deg, off);
    }
    return read_reference(metric_crs_around(from, middle, wide_deg));
}

/// The same for a raster in metres with wrong lengths; nothing: no other projection is better.
std::optional<OGRSpatialReference> less_distorted_for(OpenedHeights const& source, About const& about) {
    OGRSpatialReference const& own = *source.reference();
    CellFrame const& frame = source.frame();
    double const wide = source.width();
    double const high = source.height();
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
        OGRSpatialReference other = projection_for(source, about);
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
    CellFrame frame{};
    double wide = 0.0; ///< [m], like the other lengths
    double high = 0.0;
    double finest = 0.0; ///< as suggested by GDAL
    double cell = 0.0;   ///< so that no side exceeds the limit
};

Squares squares_for(GDALDataset& source, Target target, std::int64_t most_side, About const& about,
                    Driver const& driver) {
    CPLStringList options;
    if (target != nullptr) {
        options.SetNameValue("DST_SRS", exported_wkt(*target).c_str());
    }
    std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> const transformer(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&source), nullptr, options.List()),
        &GDALDestroyGenImgProjTransformer);
    Squares squares;
    CellFrame& frame = squares.frame;
    int columns = 0;
    int rows = 0;
    if (!transformer || GDALSuggestedWarpOutput(GDALDataset::ToHandle(&source), GDALGenImgProjTransform,
                                                transformer.get(), frame.data(), &columns, &rows) != CE_None) {
        throw BadInput(about.where, fmt::format("{} cannot be warped to be drawn: {}", about.name, driver.take()));
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
    CellFrame const& frame = squares.frame;
    double const cell = squares.cell;
    add({"-of", "MEM", "-ot", "Float32", "-dstnodata", "nan", "-novshift"});
    add({"-r", cell > squares.finest ? "average" : "bilinear"});
    add({"-te", digits(frame[0]), digits(frame[3] - std::max(cell, squares.high)),
         digits(frame[0] + std::max(cell, squares.wide)), digits(frame[3]), "-tr", digits(cell), digits(cell)});
    if (target != nullptr) {
        add({"-t_srs", exported_wkt(*target)});
    }
    return arguments;
}

/// Warps to north-up squares, in another projection if one is given.
/// \param frame of the heights' cells
Raster<float> warp(Raster<float> const& heights, CellFrame frame, OGRSpatialReference const* own, Target target,
                   std::int64_t most_side, About const& about, Run const& run) {
    Driver const driver;
    Dataset const source = dataset_of(heights, about);
    source->SetGeoTransform(frame.data());
    source->SetSpatialRef(own);
    Squares const squares = squares_for(*source, target, most_side, about, driver);
    CPLStringList arguments = warp_arguments(squares, target);
    GdalProgress gdal_progress(run, "warp");
    std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> const warp_options(
        GDALWarpAppOptionsNew(arguments.List(), nullptr), &GDALWarpAppOptionsFree);
    if (warp_options == nullptr) { // GDAL misread the arguments
        throw BadInput(
            about.where,
            fmt::format("{} cannot be warped to be drawn: its cells of {} are too small for its position: {}",
                        about.name, frame[1], driver.take()));
    }
    GDALWarpAppOptionsSetProgress(warp_options.get(), &GdalProgress::step, &gdal_progress);
    GDALDatasetH handle = GDALDataset::ToHandle(source.get());
    Dataset const made(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &handle, warp_options.get(), nullptr)));
    gdal_progress.settle();
    if (made == nullptr) {
        throw BadInput(about.where, fmt::format("{} cannot be warped to be drawn: {}", about.name, driver.take()));
    }
    CellFrame place{};
    made->GetGeoTransform(place.data());
    Grid grid;
    grid.width = made->GetRasterXSize();
    grid.height = made->GetRasterYSize();
    grid.west = place[0];
    grid.north = place[3];
    grid.cell_m = place[1];
    grid.crs = target != nullptr ? name_of(*target) : own != nullptr ? name_of(*own) : "";
    Raster<float> warped(grid);
    int const width = made->GetRasterXSize();
    refuse_if<IoError>(made->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, made->GetRasterYSize(),
                                                        warped.values().data(), width, made->GetRasterYSize(),
                                                        GDT_Float32, 0, 0, nullptr) != CE_None,
                       about.where, "{}: the warped heights cannot be read", about.name);
    driver.check(about.where, about.name);
    refuse_if<BadInput>(std::ranges::all_of(warped.values(), [](float z) { return std::isnan(z); }), about.where,
                        "{} holds no heights where it lies in {}", about.name, in_message(grid.crs));
    return warped;
}

/// Sums over heights, each with a weight, above the first one.
class HeightSums {
public:
    void add(double z, double weight) {
        if (own_.cells == 0) {
            datum_ = z;
            own_.min = z;
            own_.max = z;
        }
        ++own_.cells;
        own_.min = std::min(own_.min, z);
        own_.max = std::max(own_.max, z);
        double power = weight;
        for (CompensatedSum& sum : sums_) {
            sum.add(power);
            power *= z - datum_;
        }
    }
    void add_nodata() { ++own_.nodata; }

    OwnHeights value() const {
        OwnHeights own = own_;
        auto const moment = [&](std::size_t n) { return sums_[n].value() / sums_[0].value(); };
        double const m = moment(1);
        double const variance = std::max(0.0, moment(2) - m * m);
        own.mean = datum_ + m;
        own.std = std::sqrt(variance);
        double const third = moment(3) - 3.0 * m * moment(2) + 2.0 * m * m * m;
        double const fourth = moment(4) - 4.0 * m * moment(3) + 6.0 * m * m * moment(2) - 3.0 * m * m * m * m;
        bool const is_flat = !(own.min < own.max);
        own.skew = is_flat ? std::nan("") : third / (variance * own.std);
        own.kurtosis = is_flat ? std::nan("") : fourth / (variance * variance) - 3.0;
        return own;
    }

private:
    OwnHeights own_;
    double datum_ = 0.0;
    std::array<CompensatedSum, 5> sums_; ///< of weight times powers of the height from 0 to 4
};

/// The area of cells by row, in any unit: 1, or in degrees that on the ellipsoid.
class CellAreas {
public:
    explicit CellAreas(OpenedHeights const& source) : frame_(source.frame()) {
        OGRSpatialReference const* const reference = source.reference();
        if (reference != nullptr && reference->IsGeographic() != 0 && frame_[4] == 0.0) {
            unit_rad_ = reference->GetAngularUnits(nullptr);
            double const inverse = reference->GetInvFlattening();
            double const flattening = inverse > 0.0 ? 1.0 / inverse : 0.0;
            eccentricity_ = std::sqrt(flattening * (2.0 - flattening));
        }
    }
    double at(int row) const {
        return unit_rad_ > 0.0
                   ? std::fabs(below(frame_[3] + row * frame_[5]) - below(frame_[3] + (row + 1) * frame_[5]))
                   : 1.0;
    }

private:
    /// The area between the equator and a latitude, but for a factor. Source: \cite snyder1987, eq. 3-12.
    double below(double latitude) const {
        double const quarter = 0.5 * portable::pi;
        double const sine = portable::sin(std::clamp(latitude * unit_rad_, -quarter, quarter));
        double const e = eccentricity_;
        if (!(e > 0.0)) {
            return 2.0 * sine;
        }
        double const w = e * sine;
        return (1.0 - e * e) * (sine / (1.0 - w * w) + portable::log((1.0 + w) / (1.0 - w)) / (2.0 * e));
    }

    CellFrame frame_;
    double unit_rad_ = 0.0;
    double eccentricity_ = 0.0;
};

/// The grid of means of k x k cells; incomplete blocks at the east and south are dropped.
Grid grid_of_means(OpenedHeights const& source, std::int64_t k) {
    CellFrame const& frame = source.frame();
    Grid grid;
    grid.width = std::max<std::int64_t>(1, source.width() / k);
    grid.height = std::max<std::int64_t>(1, source.height() / k);
    grid.west = frame[0];
    grid.cell_m = frame[1] * static_cast<double>(k);
    grid.north = source.is_placed() ? frame[3] : static_cast<double>(grid.height * k);
    grid.crs = source.crs();
    return grid;
}

Raster<float> read_means(OpenedHeights& source, std::int64_t k, HeightSums* sums_of_own, About const& about,
                         Run const& run) {
    Grid const grid = grid_of_means(source, k);
    require_memory(grid, about);
    Raster<float> means(grid);
    std::vector<double> sums(static_cast<std::size_t>(grid.width), 0.0);
    std::vector<std::int64_t> counts(sums.size(), 0);
    CellAreas const areas(source);
    source.read(
        [&](int row, std::span<float const> heights) {
            if (sums_of_own != nullptr) {
                double const weight = areas.at(row);
                for (float const z : heights) {
                    std::isnan(z) ? sums_of_own->add_nodata() : sums_of_own->add(static_cast<double>(z), weight);
                }
            }
            std::int64_t const block = row / k;
            if (block >= grid.height) {
                return;
            }
            if (k == 1) {
                std::ranges::copy(heights, means.row(block).begin());
                return;
            }
            for (std::size_t col = 0; col < heights.size(); ++col) {
                std::size_t const at = col / static_cast<std::size_t>(k);
                if (at < sums.size() && !std::isnan(heights[col])) {
                    sums[at] += static_cast<double>(heights[col]);
                    ++counts[at];
                }
            }
            bool const is_last = row + 1 == source.height() || (row + 1) % k == 0;
            for (std::size_t at = 0; is_last && at < sums.size(); ++at) {
                means.row(block)[at] = counts[at] > 0 ? static_cast<float>(sums[at] / static_cast<double>(counts[at]))
                                                      : std::numeric_limits<float>::quiet_NaN();
                sums[at] = 0.0;
                counts[at] = 0;
            }
        },
        run);
    return means;
}

/// The projection to warp to; nothing: the raster's own is fine.
std::optional<OGRSpatialReference> target_for(OpenedHeights const& source, ReadDrawableParams const& params,
                                              About const& about) {
    OGRSpatialReference const* const own = source.reference();
    if (own == nullptr) {
        return std::nullopt;
    }
    if (!is_projected_in_metres(*own)) {
        return projection_for(source, about);
    }
    return params.metres == MetresOf::the_ground ? less_distorted_for(source, about) : std::nullopt;
}

/// The longitudes that a raster in degrees covers; 0: it is in other units.
double degrees_wide(OpenedHeights const& source) {
    OGRSpatialReference const* const own = source.reference();
    bool const in_degrees = own != nullptr && own->IsGeographic() != 0;
    return in_degrees ? source.width() * source.frame()[1] * own->GetAngularUnits(nullptr) * 180.0 / portable::pi : 0.0;
}

/// What became of a raster's position.
std::vector<Finding> conversions_in(OpenedHeights const& source, std::int64_t k, Target target, bool is_warped,
                                    Grid const& grid, std::string const& name) {
    std::vector<Finding> findings;
    auto const find = [&](FindingKind kind, double amount, std::string const& text) {
        findings.push_back({.kind = kind, .amount = amount, .text = name + ": " + text, .layer = name});
    };
    auto const name_or = [](OGRSpatialReference const& crs, char const* other) {
        return crs.GetName() == nullptr ? other : crs.GetName();
    };
    CellFrame const& frame = source.frame();
    double const cell = grid.cell_m;
    double const wide_deg = degrees_wide(source);
    if (constexpr double half_a_globe = 180.0; wide_deg > half_a_globe) {
        double const quarter = std::min(0.25 * wide_deg, 85.0) * portable::pi / 180.0; // Snyder 1987, eq. 24-2
        find("stretched", 1.0 / portable::cos(quarter) - 1.0,
             fmt::format("it reaches over {:.0f} degrees of longitude: far from its middle lengths and slopes are not "
                         "those of the ground",
                         wide_deg));
        findings.back().remedy = "Cut a part out (gdal_translate -projwin).";
    }
    if (k > 1) {
        find("reduced", static_cast<double>(grid_of_means(source, k).cells()),
             fmt::format("reduced to means of {}x{} cells", k, k));
    }
    if (target != nullptr) {
        find("dem_reprojected", cell,
             fmt::format("warped from {} into {}, cells of {:.4g} m", name_or(*source.reference(), "its CRS"),
                         name_or(*target, "metres"), cell));
    } else if (is_warped && (frame[2] != 0.0 || frame[4] != 0.0)) {
        find("turned_raster", cell, fmt::format("turned north-up, cells of {:.6g} m", cell));
    } else if (is_warped) {
        find("turned_raster", cell,
             fmt::format("cells of {:.6g} x {:.6g} made squares of {:.6g} m", frame[1], -frame[5], cell));
    }
    if (source.reference() == nullptr) {
        find("no_crs", 0.0,
             source.is_placed() ? "it has no CRS: its coordinates count as metres"
                                : "it has no position: its cells count as 1 m");
    }
    return findings;
}

} // namespace

Drawable read_drawable(Source const& file, ReadDrawableParams const& params, Run const& run) {
    About const about{"io.read_drawable", file.path};
    std::string const name = std::filesystem::path(file.path).filename().string();
    std::int64_t const most_side = params.most_side;
    require_in("io.read_drawable", "most_side", most_side, Range::between(16, 1000000));
    OpenedHeights source(file, params.reading, HeightsIn::metres, about);
    source.take_metres();
    constexpr double most_cells = 1e11; // read row by row, in minutes
    refuse_if<BadInput>(1.0 * source.width() * source.height() > most_cells, about.where,
                        "{} has {} x {} cells, too many to draw; take a part of it (gdal_translate -projwin) or larger "
                        "cells (gdalwarp -novshift -tr)",
                        about.name, source.width(), source.height());
    std::optional<OGRSpatialReference> const target = target_for(source, params, about);
    bool const is_warped = target || !source.is_grid();
    auto const longest = static_cast<double>(std::max(source.width(), source.height()));
    double const times = longest / static_cast<double>(most_side);
    auto const k = std::max<std::int64_t>(1, std::llround(is_warped ? std::floor(times) : std::ceil(times)));
    HeightSums own_heights;
    bool const summarises = params.summarises && (is_warped || k > 1);
    Raster<float> means = read_means(source, k, summarises ? &own_heights : nullptr, about, run);
    Drawable out{{}, source.take_findings(), {}};
    if (summarises) {
        out.own = own_heights.value();
    }
    if (is_warped) {
        CellFrame reduced = source.frame();
        for (std::size_t const i : {1U, 2U, 4U, 5U}) {
            reduced[i] *= static_cast<double>(k);
        }
        out.dem = warp(means, reduced, source.reference(), target ? &*target : nullptr, most_side, about, run);
    } else {
        out.dem = std::move(means);
    }
    std::ranges::copy(conversions_in(source, k, target ? &*target : nullptr, is_warped, out.dem.grid(), name),
                      std::back_inserter(out.findings));
    return out;
}

} // namespace thalweg::io
