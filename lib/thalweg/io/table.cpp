// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/table.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/driver.hpp>
#include <thalweg/io/spatial_reference.hpp>

namespace thalweg::io {

namespace {

enum class Format { geopackage, shapefile };

// A dBase field is text: these widths hold what a reader takes for a 32-bit, a 64-bit and a real number.
constexpr int integer_width = 9;
constexpr int wide_integer_width = 18;
constexpr int real_width = 24;
constexpr int text_width = 32; // grows by itself up to text_limit
constexpr std::size_t text_limit = 254;

// Both formats stamp the day of writing unless told another.
constexpr char const* date = "2000-01-01";
constexpr char const* instant = "2000-01-01T00:00:00.000Z";

struct Target {
    Format format;
    std::string what; // "io.write_geopackage: path", begins every message
    Driver const& driver;
    GDALDataset& dataset;
    OGRSpatialReference* reference; // null for none

    void require(bool done) const {
        if (!done) {
            driver.check(what);
            throw IoError(what + " could not be written");
        }
    }
};

struct Close {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};

class FixedDate {
public:
    FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", instant); }
    ~FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr); }
    FixedDate(FixedDate const&) = delete;
    FixedDate& operator=(FixedDate const&) = delete;
};

void add_field(Target const& target, OGRLayer& layer, Column const& column) {
    OGRFieldDefn field(column.name.c_str(), OFTInteger);
    int width = integer_width;
    switch (column.kind) {
    case Column::Kind::integer: break;
    case Column::Kind::wide_integer:
        field.SetType(OFTInteger64);
        width = wide_integer_width;
        break;
    case Column::Kind::real:
        field.SetType(OFTReal);
        width = real_width;
        break;
    case Column::Kind::text:
        field.SetType(OFTString);
        width = text_width;
        break;
    }
    if (target.format == Format::shapefile) {
        field.SetWidth(width);
        field.SetPrecision(column.decimals);
    } else {
        field.SetNullable(FALSE);
    }
    target.require(layer.CreateField(&field) == OGRERR_NONE);
}

// Least power of ten that has too many digits for a field.
double limit_of(Column const& column, Format format) {
    auto const digits = [](int count) {
        double power = 1.0;
        for (int i = 0; i < count; ++i) {
            power *= 10.0;
        }
        return power;
    };
    if (column.kind == Column::Kind::integer) {
        return digits(integer_width - 1); // in both formats, so that they hold the same
    }
    if (format == Format::geopackage) {
        return std::numeric_limits<double>::infinity();
    }
    return column.kind == Column::Kind::wide_integer ? digits(wide_integer_width - 1)
                                                     : digits(real_width - 2 - column.decimals);
}

OGRLayer& create_layer(Target const& target, Table const& table) {
    CPLStringList options;
    OGRwkbGeometryType type = wkbNone;
    if (table.shape != Table::Shape::none) {
        type = table.shape == Table::Shape::point     ? wkbPoint25D
               : table.shape == Table::Shape::line    ? wkbLineString25D
               : table.shape == Table::Shape::polygon ? wkbPolygon25D
                                                      : wkbMultiPolygon;
    }
    if (target.format == Format::shapefile) {
        options.SetNameValue("ENCODING", "UTF-8");
        options.SetNameValue("DBF_DATE_LAST_UPDATE", date);
    } else if (type != wkbNone) {
        options.SetNameValue("GEOMETRY_NULLABLE", "NO");
    }
    OGRLayer* const layer = target.dataset.CreateLayer(table.name.c_str(), type == wkbNone ? nullptr : target.reference,
                                                       type, options.List());
    target.require(layer != nullptr);
    for (Column const& column : table.columns) {
        add_field(target, *layer, column);
    }
    return *layer;
}

void set_field(OGRFeature& feature, int index, Column const& column, std::int64_t row, Target const& target,
               std::string const& table) {
    auto const refuse = [&](std::string const& why) {
        throw BadInput(fmt::format("{}: {} {} has {} {}", target.what, table, row + 1, column.name, why));
    };
    auto const value = column.at(row);
    double const limit = limit_of(column, target.format);
    if (auto const* whole = std::get_if<std::int64_t>(&value)) {
        if (!(std::fabs(static_cast<double>(*whole)) < limit)) {
            refuse(fmt::format("= {}, more than the field holds", *whole));
        }
        feature.SetField(index, static_cast<GIntBig>(*whole));
    } else if (auto const* real = std::get_if<double>(&value)) {
        if (!std::isfinite(*real) || !(std::fabs(*real) < limit)) {
            refuse(fmt::format("= {}, which cannot be written", *real));
        }
        feature.SetField(index, *real);
    } else {
        auto const& text = std::get<std::string>(value);
        if (target.format == Format::shapefile && text.size() > text_limit) {
            refuse(fmt::format("of more than {} bytes", text_limit));
        }
        feature.SetField(index, text.c_str());
    }
}

void set_parts(OGRFeature& feature, Table const& table, std::int64_t row, Target const& target) {
    OGRMultiPolygon parts;
    for (Polygon const& part : table.parts_at(row)) {
        OGRPolygon drawn;
        for (auto const& positions : part.rings) {
            OGRLinearRing ring;
            ring.setNumPoints(static_cast<int>(positions.size()));
            for (int i = 0; Vec2 const p : positions) {
                ring.setPoint(i++, p.x, p.y);
            }
            ring.closeRings();
            target.require(drawn.addRing(&ring) == OGRERR_NONE);
        }
        target.require(parts.addGeometry(&drawn) == OGRERR_NONE);
    }
    target.require(feature.SetGeometry(&parts) == OGRERR_NONE);
}

void set_shape(OGRFeature& feature, Table const& table, std::int64_t row, Target const& target) {
    if (table.shape == Table::Shape::multi_polygon) {
        set_parts(feature, table, row, target);
        return;
    }
    std::vector<Vec3> const positions = table.shape_at(row);
    for (Vec3 const& p : positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw BadInput(
                fmt::format("{}: {} {} has a vertex ({}, {}, {})", target.what, table.name, row + 1, p.x, p.y, p.z));
        }
    }
    if (table.shape == Table::Shape::point) {
        OGRPoint const point(positions.at(0).x, positions.at(0).y, positions.at(0).z);
        target.require(feature.SetGeometry(&point) == OGRERR_NONE);
        return;
    }
    auto const draw = [&](OGRSimpleCurve& line) {
        line.setNumPoints(static_cast<int>(positions.size()));
        for (int i = 0; Vec3 const& p : positions) {
            line.setPoint(i++, p.x, p.y, p.z);
        }
    };
    if (table.shape == Table::Shape::line) {
        OGRLineString line;
        draw(line);
        target.require(feature.SetGeometry(&line) == OGRERR_NONE);
        return;
    }
    OGRLinearRing ring;
    draw(ring);
    OGRPolygon polygon;
    target.require(polygon.addRing(&ring) == OGRERR_NONE && feature.SetGeometry(&polygon) == OGRERR_NONE);
}

void write(Target const& target, Table const& table, Run const& run) {
    constexpr std::int64_t rows_between_reports = 1024;
    OGRLayer& layer = create_layer(target, table);
    OGRFeature feature(layer.GetLayerDefn());
    for (std::int64_t row = 0; row < table.rows; ++row) {
        if (row % rows_between_reports == 0) {
            run.at(static_cast<double>(row) / static_cast<double>(table.rows), "write");
        }
        for (int i = 0; Column const& column : table.columns) {
            set_field(feature, i++, column, row, target, table.name);
        }
        if (table.shape != Table::Shape::none) {
            set_shape(feature, table, row, target);
        }
        // A shapefile counts its features from 0 and would leave a gap.
        feature.SetFID(target.format == Format::geopackage ? row + 1 : row);
        target.require(layer.CreateFeature(&feature) == OGRERR_NONE);
    }
}

void write_file(std::vector<Table const*> const& tables, std::string const& crs, std::string const& path, Format format,
                Run const& run) {
    bool const shapefile = format == Format::shapefile;
    std::string const what = fmt::format("io.write_{}: {}", shapefile ? "shapefile" : "geopackage", path);
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) {
        throw IoError(what + " exists already");
    }
    Driver const driver;
    FixedDate const fixed_date;
    OGRSpatialReference reference;
    if (!crs.empty()) {
        reference = read_reference(crs);
    }
    GDALDriver* const writer = GetGDALDriverManager()->GetDriverByName(shapefile ? "ESRI Shapefile" : "GPKG");
    std::unique_ptr<GDALDataset, Close> dataset(
        writer == nullptr ? nullptr : writer->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (dataset == nullptr) {
        driver.check(what);
        throw IoError(what + " could not be made");
    }
    Target const target{format, what, driver, *dataset, crs.empty() ? nullptr : &reference};
    if (!shapefile) {
        target.require(dataset->StartTransaction() == OGRERR_NONE);
    }
    for (Table const* const table : tables) {
        write(target, *table, run);
    }
    if (!shapefile) {
        target.require(dataset->CommitTransaction() == OGRERR_NONE);
    }
    dataset.reset();
    driver.check(what);
}

} // namespace

void write_tables(std::vector<Table> const& tables, std::string const& crs, std::string const& path, Run const& run) {
    std::vector<Table const*> all;
    for (Table const& table : tables) {
        all.push_back(&table);
    }
    write_file(all, crs, path, Format::geopackage, run);
}

void write_shapefile(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, Format::shapefile, run);
}

} // namespace thalweg::io
