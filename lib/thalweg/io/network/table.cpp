// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/io/network/internal/table.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {
namespace {

// A dBase field is text: these widths hold what a reader takes for a 32-bit, a 64-bit and a real number.
constexpr int integer_width = 9;
constexpr int wide_integer_width = 18;
constexpr int real_width = 24;
constexpr int text_width = 32; // grows by itself up to text_limit
constexpr std::size_t text_limit = 254;

// Both formats stamp the day of writing unless told another.
constexpr char const* date = "2000-01-01";
constexpr char const* instant = "2000-01-01T00:00:00.000Z";

// Room for any number a user may have, one that a reader takes for 64 bits included.
int users_width(Column::Kind kind, int width) {
    constexpr int any_integer = 11;
    constexpr int any_wide_integer = 20;
    return kind == Column::Kind::integer ? any_integer : kind == Column::Kind::wide_integer ? any_wide_integer : width;
}

void add_field(LayerTarget const& target, OGRLayer& layer, Column const& column) {
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
    case Column::Kind::date:
        field.SetType(OFTDate);
        width = 0;
        break;
    case Column::Kind::time:
        field.SetType(OFTTime);
        width = 0;
        break;
    case Column::Kind::datetime:
        field.SetType(OFTDateTime);
        width = 0;
        break;
    }
    bool const is_part_of_moment = column.kind == Column::Kind::date || column.kind == Column::Kind::time;
    if (target.format == LayerFormat::flatgeobuf && is_part_of_moment) { // which has no other
        field.SetType(OFTString);
    }
    if (target.format == LayerFormat::shapefile) {
        field.SetWidth(column.is_users ? users_width(column.kind, width) : width);
        field.SetPrecision(column.decimals);
    } else if (!column.is_users) {
        field.SetNullable(FALSE);
    }
    target.require(layer.CreateField(&field) == OGRERR_NONE);
}

// Least power of ten that has too many digits for a field.
double limit_of(Column const& column, LayerFormat format) {
    auto const digits = [](int count) {
        double power = 1.0;
        for (int i = 0; i < count; ++i) {
            power *= 10.0;
        }
        return power;
    };
    if (column.kind == Column::Kind::integer) {
        return digits(integer_width - 1); // in every format, so that they hold the same
    }
    if (format != LayerFormat::shapefile) {
        return std::numeric_limits<double>::infinity();
    }
    return column.kind == Column::Kind::wide_integer ? digits(wide_integer_width - 1)
                                                     : digits(real_width - 2 - column.decimals);
}

CPLStringList options_of(LayerTarget const& target, bool has_shape) {
    CPLStringList options;
    switch (target.format) {
    case LayerFormat::geopackage:
        if (has_shape) {
            options.SetNameValue("GEOMETRY_NULLABLE", "NO");
        }
        break;
    case LayerFormat::shapefile:
        options.SetNameValue("ENCODING", "UTF-8");
        options.SetNameValue("DBF_DATE_LAST_UPDATE", date);
        break;
    case LayerFormat::flatgeobuf: break;
    case LayerFormat::geojson: options.SetNameValue("SIGNIFICANT_FIGURES", "17"); break; // any double, bit for bit
    case LayerFormat::postgresql:
        options.SetNameValue("GEOMETRY_NAME", "geom");
        options.SetNameValue("FID", "fid");
        options.SetNameValue("GEOMETRY_NULLABLE", "NO");
        if (!target.db_schema.empty()) {
            options.SetNameValue("SCHEMA", target.db_schema.c_str());
        }
        break;
    }
    return options;
}

OGRLayer& create_layer(LayerTarget const& target, Table const& table) {
    CPLStringList options = options_of(target, table.shape != Table::Shape::none);
    OGRwkbGeometryType type = wkbNone;
    if (table.shape != Table::Shape::none) {
        type = table.shape == Table::Shape::point       ? wkbPoint25D
               : table.shape == Table::Shape::line      ? wkbLineString25D
               : table.shape == Table::Shape::plan_line ? wkbLineString
               : table.shape == Table::Shape::polygon   ? wkbPolygon25D
                                                        : wkbMultiPolygon;
    }
    OGRLayer* const layer = target.dataset.CreateLayer(table.name.c_str(), type == wkbNone ? nullptr : target.reference,
                                                       type, options.List());
    target.require(layer != nullptr);
    for (Column const& column : table.columns) {
        add_field(target, *layer, column);
    }
    return *layer;
}

void set_field(OGRFeature& feature, int index, Column const& column, std::size_t row, LayerTarget const& target,
               std::string const& table) {
    auto const refuse = [&](std::string const& why) {
        throw BadInput(fmt::format("{}: {} {} has {} {}", target.what, table, row + 1, column.name, why));
    };
    auto const value = column.at(row);
    if (std::holds_alternative<std::monostate>(value)) {
        feature.SetFieldNull(index);
        return;
    }
    double const limit = column.is_users ? std::numeric_limits<double>::infinity() : limit_of(column, target.format);
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
        if (target.format == LayerFormat::shapefile && text.size() > text_limit) {
            refuse(fmt::format("of more than {} bytes", text_limit));
        }
        feature.SetField(index, text.c_str());
    }
}

void set_parts(OGRFeature& feature, Table const& table, std::size_t row, LayerTarget const& target) {
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

void set_shape(OGRFeature& feature, Table const& table, std::size_t row, LayerTarget const& target) {
    if (table.shape == Table::Shape::multi_polygon) {
        set_parts(feature, table, row, target);
        return;
    }
    std::vector<Vec3> const positions = table.shape_at(row);
    for (Vec3 const& p : positions) {
        refuse_if<BadInput>(!is_finite(p), "{}: {} {} has a vertex ({}, {}, {})", target.what, table.name, row + 1, p.x,
                            p.y, p.z);
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
    if (table.shape == Table::Shape::line || table.shape == Table::Shape::plan_line) {
        OGRLineString line;
        draw(line);
        if (table.shape == Table::Shape::plan_line) {
            line.flattenTo2D();
        }
        target.require(feature.SetGeometry(&line) == OGRERR_NONE);
        return;
    }
    OGRLinearRing ring;
    draw(ring);
    OGRPolygon polygon;
    target.require(polygon.addRing(&ring) == OGRERR_NONE && feature.SetGeometry(&polygon) == OGRERR_NONE);
}

GIntBig id_of(GIntBig row, LayerFormat format) {
    // A shapefile counts its features from 0 and would leave a gap; the others count by themselves.
    return format == LayerFormat::geopackage ? row + 1 : format == LayerFormat::shapefile ? row : OGRNullFID;
}

} // namespace

FixedDate::FixedDate() {
    CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", instant);
}
FixedDate::~FixedDate() {
    CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr);
}

void LayerTarget::require(bool done) const {
    if (!done) {
        driver.check(what);
        throw IoError(what + " could not be written");
    }
}

void write_layer(LayerTarget const& target, Table const& table, Run const& run) {
    constexpr std::size_t rows_between_reports = 1024;
    OGRLayer& layer = create_layer(target, table);
    OGRFeature feature(layer.GetLayerDefn());
    for (std::size_t row = 0; row < table.rows; ++row) {
        if (row % rows_between_reports == 0) {
            run.at(static_cast<double>(row) / static_cast<double>(table.rows), "write");
        }
        for (int i = 0; Column const& column : table.columns) {
            set_field(feature, i++, column, row, target, table.name);
        }
        if (table.shape != Table::Shape::none) {
            set_shape(feature, table, row, target);
        }
        feature.SetFID(id_of(static_cast<GIntBig>(row), target.format));
        target.require(layer.CreateFeature(&feature) == OGRERR_NONE);
    }
}

namespace {

struct FileFormat {
    char const* word;   // as messages name it
    char const* driver; // as GDAL does
};

// In the order of LayerFormat.
constexpr ByEnum<LayerFormat, FileFormat, 4> file_formats{
    {{{"geopackage", "GPKG"}, {"shapefile", "ESRI Shapefile"}, {"flatgeobuf", "FlatGeobuf"}, {"geojson", "GeoJSON"}}}};

void require_code(OGRSpatialReference const* reference, std::string const& what) {
    refuse_if<BadInput>(reference == nullptr || reference->GetAuthorityCode(nullptr) == nullptr,
                        "{}: GeoJSON takes coordinates without an EPSG code for degrees: bring the network into a CRS "
                        "that has one, or write FlatGeobuf",
                        what);
}

/// A CRS that could not be written, such as the .prj of a shapefile, leaves only a file without one, and no error.
void require_crs(std::string const& path, OGRSpatialReference const& wanted, std::string const& what) {
    Dataset const written(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    refuse_if<IoError>(written == nullptr, "{} could not be read back", what);
    for (OGRLayer* const layer : written->GetLayers()) {
        OGRSpatialReference const* const found = layer->GetSpatialRef();
        bool const has_shape = layer->GetGeomType() != wkbNone;
        refuse_if<IoError>(has_shape && (found == nullptr || found->IsProjected() != wanted.IsProjected() ||
                                         found->IsGeographic() != wanted.IsGeographic()),
                           "{}: the CRS could not be written", what);
    }
}

void write_file(std::vector<Table const*> const& tables, std::string const& crs, std::string const& path,
                LayerFormat format, Run const& run) {
    FileFormat const& file_format = file_formats[format];
    std::string const what = fmt::format("io.write_{}: {}", file_format.word, path);
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) {
        throw IoError(what + " exists already");
    }
    Driver const driver;
    FixedDate const fixed_date;
    OGRSpatialReference reference;
    if (!crs.empty()) {
        reference = read_reference(crs);
    }
    OGRSpatialReference* const used = crs.empty() ? nullptr : &reference;
    if (format == LayerFormat::geojson) {
        require_code(used, what);
    }
    GDALDriver* const writer = GetGDALDriverManager()->GetDriverByName(file_format.driver);
    Dataset dataset(writer == nullptr ? nullptr : writer->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (dataset == nullptr) {
        driver.check(what);
        throw IoError(what + " could not be created");
    }
    LayerTarget const target{format, what, driver, *dataset, used};
    bool const transactions = format == LayerFormat::geopackage;
    if (transactions) {
        target.require(dataset->StartTransaction() == OGRERR_NONE);
    }
    for (Table const* const table : tables) {
        write_layer(target, *table, run);
    }
    if (transactions) {
        target.require(dataset->CommitTransaction() == OGRERR_NONE);
    }
    dataset.reset();
    driver.check(what);
    if (used != nullptr) {
        require_crs(path, *used, what);
        driver.check(what);
    }
}

} // namespace

void write_tables(std::vector<Table> const& tables, std::string const& crs, std::string const& path, Run const& run) {
    std::vector<Table const*> all;
    for (Table const& table : tables) {
        all.push_back(&table);
    }
    write_file(all, crs, path, LayerFormat::geopackage, run);
}

void write_shapefile(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::shapefile, run);
}

void write_flatgeobuf(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::flatgeobuf, run);
}

void write_geojson(Table const& table, std::string const& crs, std::string const& path, Run const& run) {
    write_file({&table}, crs, path, LayerFormat::geojson, run);
}

} // namespace thalweg::io
