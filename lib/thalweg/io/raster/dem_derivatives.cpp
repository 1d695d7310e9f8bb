// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/dem_derivatives.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {

Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor, Light light) {
    require_in("io.hillshade", "z_factor", z_factor, Range::above(0.0).or_infinite());
    Driver const driver;
    Dataset const source = dataset_of(dem, {"io.hillshade", ""});
    CPLStringList arguments;
    for (std::string const& argument : {std::string("-of"), std::string("MEM"), std::string("-compute_edges"),
                                        std::string("-z"), fmt::format("{}", z_factor)}) {
        arguments.AddString(argument.c_str());
    }
    if (light == Light::multidirectional) {
        arguments.AddString("-multidirectional");
    }
    std::unique_ptr<GDALDEMProcessingOptions, decltype(&GDALDEMProcessingOptionsFree)> const options(
        GDALDEMProcessingOptionsNew(arguments.List(), nullptr), &GDALDEMProcessingOptionsFree);
    Dataset const shaded(GDALDataset::FromHandle(
        GDALDEMProcessing("", GDALDataset::ToHandle(source.get()), "hillshade", nullptr, options.get(), nullptr)));
    Raster<std::uint8_t> shade(dem.grid());
    int const width = source->GetRasterXSize();
    int const height = source->GetRasterYSize();
    if (shaded == nullptr || shaded->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, shade.values().data(),
                                                                width, height, GDT_Byte, 0, 0, nullptr) != CE_None) {
        driver.check("io.hillshade");
        throw IoError("io.hillshade", "io.hillshade failed");
    }
    return shade;
}

namespace {

void require_few_levels(Raster<float> const& dem, double interval_m) {
    constexpr double most_levels = 10000.0;
    require_in("io.contours", "interval", interval_m, Range::above(0.0).or_infinite(), "m");
    double low = 0.0;
    double high = 0.0;
    bool first = true;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            low = first ? static_cast<double>(z) : std::min(low, static_cast<double>(z));
            high = first ? static_cast<double>(z) : std::max(high, static_cast<double>(z));
            first = false;
        }
    }
    refuse_if<BadParameter>((high - low) / interval_m > most_levels, "io.contours",
                            "an interval of {} m in a relief of {} m gives more than {} levels: give a larger one",
                            interval_m, high - low, most_levels);
}

/// Simplifies contours, except for those that would then cross themselves or others.
std::vector<ContourLine> simplified(std::vector<ContourLine> lines, double tolerance_m, Run const& run) {
    std::vector<std::vector<Vec2>> few;
    std::vector<geometry::EndNodes> ends;
    for (ContourLine const& line : lines) {
        few.push_back(geometry::simplify(line.line, tolerance_m));
        bool const is_closed = line.line.front() == line.line.back();
        if (is_closed && few.back().size() <= 3) { // the smallest rings would be points
            few.back() = line.line;
        }
        std::size_t const node = 2 * ends.size();
        ends.push_back({node, is_closed ? node : node + 1});
    }
    for (bool again = true; again;) {
        again = false;
        for (geometry::Meeting const& meeting : geometry::meetings(few, ends, run)) {
            bool const closes_ring = meeting.line == meeting.other && meeting.segment == 0 &&
                                     meeting.other_segment + 2 == few[meeting.line].size() && !meeting.is_stretch() &&
                                     meeting.at == few[meeting.line].back();
            if (closes_ring) {
                continue;
            }
            for (std::size_t const i : {meeting.line, meeting.other}) {
                again = again || few[i].size() != lines[i].line.size();
                few[i] = lines[i].line;
            }
        }
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
        lines[i].line = std::move(few[i]);
    }
    return lines;
}

/// Whether a ring lies within a square of this size, as around a cell whose height is that of the contour.
bool is_dot(std::vector<Vec2> const& line, double size_m) {
    auto const [west, east] = std::ranges::minmax(line, {}, &Vec2::x);
    auto const [south, north] = std::ranges::minmax(line, {}, &Vec2::y);
    return line.front() == line.back() && east.x - west.x < size_m && north.y - south.y < size_m;
}

/// The contours as GDAL traces them.
std::vector<ContourLine> drawn(Raster<float> const& dem, double interval_m, Run const& run) {
    Driver const driver;
    Dataset const source = dataset_of(dem, {"io.contours", ""});
    if (std::ranges::all_of(dem.values(), [](float z) { return std::isnan(z); })) {
        return {}; // GDAL 3.9 rejects such a raster
    }
    Dataset const memory(GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* const layer = memory->CreateLayer("contours", nullptr, wkbLineString, nullptr);
    OGRFieldDefn z_field("z", OFTReal);
    layer->CreateField(&z_field);
    CPLStringList options;
    options.SetNameValue("LEVEL_INTERVAL", fmt::format("{}", interval_m).c_str());
    options.SetNameValue("ELEV_FIELD", "0");
    options.SetNameValue("NODATA", fmt::format("{}", nodata_height).c_str());
    GdalProgress gdal_progress(run, "contours");
    CPLErr const error =
        GDALContourGenerateEx(GDALRasterBand::ToHandle(source->GetRasterBand(1)), OGRLayer::ToHandle(layer),
                              options.List(), &GdalProgress::step, &gdal_progress);
    gdal_progress.settle();
    driver.check("io.contours");
    refuse_if<IoError>(error != CE_None, "io.contours", "io.contours failed");
    std::vector<ContourLine> lines;
    for (auto const& feature : *layer) {
        OGRLineString const& drawn_line = *feature->GetGeometryRef()->toLineString();
        ContourLine line{feature->GetFieldAsDouble(0), {}};
        for (OGRPoint const& p : drawn_line) {
            if (Vec2 const at{p.getX(), p.getY()}; line.line.empty() || line.line.back() != at) {
                line.line.push_back(at);
            }
        }
        lines.push_back(std::move(line));
    }
    driver.check("io.contours"); // a failed allocation also ends the loop
    refuse_if<IoError>(static_cast<GIntBig>(lines.size()) != layer->GetFeatureCount(), "io.contours",
                       "contours are missing: free memory");
    return lines;
}

} // namespace

std::vector<ContourLine> contours(Raster<float> const& dem, double interval_m, Run const& run) {
    constexpr double tolerance_cells = 0.1;
    double const tolerance_m = tolerance_cells * dem.grid().cell_m;
    require_few_levels(dem, interval_m);
    std::vector<ContourLine> lines = simplified(drawn(dem, interval_m, run), tolerance_m, run);
    std::erase_if(lines, [&](ContourLine const& line) { return is_dot(line.line, tolerance_m); });
    return lines;
}

void write_contours(std::vector<ContourLine> const& lines, double interval_m, std::string const& crs,
                    std::string const& path, Run const& run) {
    write_contours(lines, interval_m, crs, path, HeightUnit::metre, run);
}

void write_contours(std::vector<ContourLine> const& lines, double interval, std::string const& crs,
                    std::string const& path, HeightUnit unit, Run const& run) {
    constexpr double index_every = 5.0;
    auto const line_at = [&lines](std::size_t row) -> ContourLine const& { return lines[row]; };
    Table table{"contours", Table::Shape::line, lines.size(), {}, {}};
    table.columns = {
        {"z", Column::Kind::real, 0, [=](std::size_t row) { return line_at(row).z; }},
        {"is_index", Column::Kind::integer, 0,
         [=](std::size_t row) {
             double const level = std::floor(line_at(row).z / interval + 0.5);
             return static_cast<std::int64_t>(level == index_every * std::floor(level / index_every));
         }},
    };
    table.shape_at = [=](std::size_t row) {
        std::vector<Vec3> line;
        for (Vec2 const p : line_at(row).line) {
            line.push_back({p.x, p.y, line_at(row).z});
        }
        return line;
    };
    if (unit != HeightUnit::metre) {
        table.columns.push_back(
            {"z_unit", Column::Kind::text, 0, [unit](std::size_t) { return std::string(name_of(unit)); }});
    }
    table.style = contour_style();
    write_tables({table}, crs, path, run);
}

} // namespace thalweg::io
