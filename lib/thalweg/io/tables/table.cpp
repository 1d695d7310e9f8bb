// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/qgis/internal/qgis.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/tables/internal/layers.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;
using Shape = Table::Shape;

struct FileFormat {
    char const* function; // that writes such files, for errors
    char const* driver;   // as GDAL names it
    std::array<char const*, 3> options = {};
};

// In the order of LayerFormat.
constexpr ByEnum<LayerFormat, FileFormat, 6> file_formats{
    {{{"io.write_geopackage", "GPKG", {"GEOMETRY_NULLABLE=NO"}},
      {"io.write_shapefiles", "ESRI Shapefile", {"ENCODING=UTF-8", "DBF_DATE_LAST_UPDATE=2000-01-01"}},
      {"io.write_network", "FlatGeobuf"},
      {"io.write_network", "GeoJSON", {"RFC7946=YES", "COORDINATE_PRECISION=9", "SIGNIFICANT_FIGURES=17"}}, // 0.1 mm
      {"io.write_network", "GeoJSON", {"SIGNIFICANT_FIGURES=17"}}, // any double, bit for bit
      {"io.write_postgis", "PostgreSQL", {"GEOMETRY_NAME=geom", "FID=fid", "GEOMETRY_NULLABLE=NO"}}}}};

// In the order of Table::Shape.
constexpr ByEnum<Shape, OGRwkbGeometryType, 8> shape_types{
    {{wkbNone, wkbPoint25D, wkbLineString25D, wkbLineString, wkbPolygon25D, wkbMultiPolygon, wkbLineString25D,
      wkbPoint}}};

// A dBase field is text: its width holds what a reader takes for a 32-bit, a 64-bit and a real number. A user's columns
// have room for any such number, also for one that a reader takes for 64 bits.
struct FieldKind {
    OGRFieldType type;
    int width = 0;
    int users_width = 0;
};

// In the order of Column::Kind. Texts grow up to text_limit by themselves.
constexpr ByEnum<Kind, FieldKind, 7> field_kinds{{{{OFTInteger, 9, 11},
                                                   {OFTInteger64, 18, 20},
                                                   {OFTReal, 24, 24},
                                                   {OFTString, 32, 32},
                                                   {OFTDate},
                                                   {OFTTime},
                                                   {OFTDateTime}}}};
constexpr std::size_t text_limit = 254;

OGRLayer& create_layer(LayerTarget const& target, Table const& table) {
    CPLStringList options;
    for (char const* const option : file_formats[target.format].options) {
        if (option != nullptr) {
            options.AddString(option);
        }
    }
    if (!target.db_schema.empty()) {
        options.SetNameValue("SCHEMA", target.db_schema.c_str());
    }
    OGRLayer* const layer =
        target.dataset.CreateLayer(table.name.c_str(), table.shape == Shape::none ? nullptr : target.reference,
                                   shape_types[table.shape], options.List());
    target.require(layer != nullptr);
    for (Column const& column : table.columns) {
        FieldKind const& kind = field_kinds[column.kind];
        // FlatGeobuf has neither dates nor times of day, only both in one.
        bool const as_text =
            target.format == LayerFormat::flatgeobuf && (column.kind == Kind::date || column.kind == Kind::time);
        OGRFieldDefn field(column.name.c_str(), as_text ? OFTString : kind.type);
        if (target.format == LayerFormat::shapefile) {
            field.SetWidth(column.is_users ? kind.users_width : kind.width);
            field.SetPrecision(column.decimals);
        } else if (!column.is_users && !column.may_be_null) {
            field.SetNullable(FALSE);
        }
        target.require(layer->CreateField(&field) == OGRERR_NONE);
    }
    return *layer;
}

// The least power of ten that has too many digits for a column. Integers have it in every format, so that all hold the
// same.
double limit_of(Column const& column, LayerFormat format) {
    if (column.is_users || (column.kind != Kind::integer && format != LayerFormat::shapefile)) {
        return std::numeric_limits<double>::infinity();
    }
    int const width = field_kinds[column.kind].width;
    double power = 1.0;
    for (int digits = column.kind == Kind::real ? width - 2 - column.decimals : width - 1; digits > 0; --digits) {
        power *= 10.0;
    }
    return power;
}

void set_field(OGRFeature& feature, int index, Column const& column, std::size_t row, LayerTarget const& target,
               std::string const& table) {
    auto const value = column.at(row);
    double const limit = limit_of(column, target.format);
    if (std::holds_alternative<std::monostate>(value)) {
        feature.SetFieldNull(index);
    } else if (auto const* whole = std::get_if<std::int64_t>(&value)) {
        refuse_if<BadInput>(!(std::fabs(static_cast<double>(*whole)) < limit), target.about.where,
                            "{}: {} {} has {} = {}, more than the field holds", target.about.name, table, row + 1,
                            column.name, *whole);
        feature.SetField(index, static_cast<GIntBig>(*whole));
    } else if (auto const* real = std::get_if<double>(&value)) {
        refuse_if<BadInput>(!std::isfinite(*real) || !(std::fabs(*real) < limit), target.about.where,
                            "{}: {} {} has {} = {}, which cannot be written", target.about.name, table, row + 1,
                            column.name, *real);
        feature.SetField(index, *real);
    } else {
        auto const& text = std::get<std::string>(value);
        refuse_if<BadInput>(target.format == LayerFormat::shapefile && text.size() > text_limit, target.about.where,
                            "{}: {} {} has {} of more than {} bytes", target.about.name, table, row + 1, column.name,
                            text_limit);
        feature.SetField(index, text.c_str());
    }
}

std::unique_ptr<OGRGeometry> drawn_polygons(std::vector<Polygon> const& parts) {
    auto drawn = std::make_unique<OGRMultiPolygon>();
    for (Polygon const& part : parts) {
        OGRPolygon polygon;
        for (auto const& positions : part.rings) {
            OGRLinearRing ring;
            for (Vec2 const p : positions) {
                ring.addPoint(p.x, p.y);
            }
            ring.closeRings();
            polygon.addRing(&ring);
        }
        drawn->addGeometry(&polygon);
    }
    return drawn;
}

std::unique_ptr<OGRGeometry> drawn_shape(Table const& table, std::size_t row, About const& about) {
    if (table.shape == Shape::multi_polygon) {
        return drawn_polygons(table.parts_at(row));
    }
    std::vector<Vec3> const positions = table.shape_at(row);
    bool const needs_heights =
        table.shape != Shape::plan_line && table.shape != Shape::partly_line && table.shape != Shape::plan_point;
    for (Vec3 const& p : positions) {
        refuse_if<BadInput>(needs_heights ? !is_finite(p) : !is_finite(in_plan(p)), about.where,
                            "{}: {} {} has a vertex ({}, {}, {})", about.name, table.name, row + 1, p.x, p.y, p.z);
    }
    if (table.shape == Shape::point && positions.empty()) {
        return std::make_unique<OGRPoint>(); // empty
    }
    if (table.shape == Shape::plan_point) {
        return std::make_unique<OGRPoint>(positions.at(0).x, positions.at(0).y);
    }
    if (table.shape == Shape::point) {
        return std::make_unique<OGRPoint>(positions.at(0).x, positions.at(0).y, positions.at(0).z);
    }
    auto const draw = [&](OGRSimpleCurve& line) {
        line.setNumPoints(static_cast<int>(positions.size()));
        for (int i = 0; Vec3 const& p : positions) {
            line.setPoint(i++, p.x, p.y, p.z);
        }
    };
    if (table.shape == Shape::polygon) {
        OGRLinearRing ring;
        draw(ring);
        auto polygon = std::make_unique<OGRPolygon>();
        polygon->addRing(&ring);
        return polygon;
    }
    auto line = std::make_unique<OGRLineString>();
    draw(*line);
    if (table.shape == Shape::plan_line) {
        line->flattenTo2D();
    }
    return line;
}

/// A CRS that could not be written, such as the .prj of a shapefile, leaves only a file without one, and no error.
void require_crs(std::string const& path, OGRSpatialReference const& wanted, About const& about) {
    Dataset const written(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    refuse_if<IoError>(written == nullptr, about.where, "{} could not be read back", about.name);
    for (OGRLayer* const layer : written->GetLayers()) {
        OGRSpatialReference const* const found = layer->GetSpatialRef();
        bool const has_shape = layer->GetGeomType() != wkbNone;
        refuse_if<IoError>(has_shape && (found == nullptr || found->IsProjected() != wanted.IsProjected() ||
                                         found->IsGeographic() != wanted.IsGeographic()),
                           about.where, "{}: the CRS could not be written", about.name);
    }
}

/// Where GDAL writes a shapefile: in memory, since it is silent of a part that the disk did not take.
class Shapefile {
public:
    explicit Shapefile(std::string const& path) : path_(path) {
        static std::atomic<int> made{0};
        folder_ = fmt::format("/vsimem/thalweg-shapefile-{}", ++made);
    }
    ~Shapefile() { VSIRmdirRecursive(folder_.c_str()); }
    Shapefile(Shapefile const&) = delete;
    Shapefile& operator=(Shapefile const&) = delete;

    std::string path() const { return folder_ + "/" + std::filesystem::path(path_).filename().string(); }

    /// Writes its files.
    /// \throws IoError as write_text
    void copy_to_disk() const {
        CPLStringList const listed(VSIReadDir(folder_.c_str()), TRUE);
        std::vector<std::string> names(listed.List(), listed.List() + listed.size());
        std::stable_partition(names.begin(), names.end(),
                              [](std::string const& name) { return name.ends_with(".shp"); });
        for (std::string const& name : names) {
            vsi_l_offset size = 0;
            auto const* const bytes = VSIGetMemFileBuffer((folder_ + "/" + name).c_str(), &size, FALSE);
            write_text((std::filesystem::path(path_).parent_path() / name).string(),
                       {reinterpret_cast<char const*>(bytes), bytes == nullptr ? 0 : static_cast<std::size_t>(size)});
        }
    }

private:
    std::string path_;
    std::string folder_;
};

} // namespace

void LayerTarget::require(bool done) const {
    if (!done) {
        driver.check(about.where, about.name);
        throw IoError(about.where, about.name + " could not be written");
    }
}

void write_layer(LayerTarget const& target, Table const& table, Run const& run) {
    OGRLayer& layer = create_layer(target, table);
    OGRFeature feature(layer.GetLayerDefn());
    each_row(table, run, [&](std::size_t row) {
        for (int i = 0; Column const& column : table.columns) {
            set_field(feature, i++, column, row, target, table.name);
        }
        if (table.shape != Shape::none) {
            target.require(feature.SetGeometry(drawn_shape(table, row, target.about).get()) == OGRERR_NONE);
        }
        // A shapefile counts its features from 0 and would leave a gap; other formats than GeoPackage count themselves.
        auto const id = static_cast<GIntBig>(row);
        feature.SetFID(target.format == LayerFormat::geopackage  ? id + 1
                       : target.format == LayerFormat::shapefile ? id
                                                                 : OGRNullFID);
        target.require(layer.CreateFeature(&feature) == OGRERR_NONE);
    });
}

Table styles_table(std::span<Table const> tables) {
    auto const rows = std::make_shared<std::vector<std::pair<std::string, std::string>>>();
    for (Table const& table : tables) {
        if (!table.style.empty()) {
            rows->emplace_back(table.name, qml(table.style));
        }
    }
    using Kind = Column::Kind;
    auto const text = [](char const* name, auto value) {
        return Column{name, Kind::text, 0, [value](std::size_t row) { return Column::Value(std::string(value(row))); },
                      true};
    };
    auto const always = [](char const* word) { return [word](std::size_t) { return word; }; };
    Table out{styles_layer, Table::Shape::none, rows->size(), {}, {}};
    out.columns = {text("f_table_catalog", always("")),
                   text("f_table_schema", always("")),
                   text("f_table_name", [rows](std::size_t row) { return (*rows)[row].first; }),
                   text("f_geometry_column", always("geom")),
                   text("styleName", always("thalweg")),
                   text("styleQML", [rows](std::size_t row) { return (*rows)[row].second; }),
                   text("styleSLD", always("")),
                   {"useAsDefault", Kind::integer, 0, [](std::size_t) { return std::int64_t{1}; }, true},
                   text("description", always("thalweg")),
                   text("owner", always("")),
                   text("ui", always("")),
                   {"update_time", Kind::datetime, 0, [](std::size_t) { return std::string(fixed_date); }, true}};
    return out;
}

void write_file(std::span<Table const> tables, std::string const& crs, std::string const& path, LayerFormat format,
                Run const& run) {
    FileFormat const& file_format = file_formats[format];
    About const about{file_format.function, path};
    std::error_code ignored;
    refuse_if<IoError>(std::filesystem::exists(path, ignored), about.where, "{} exists already", about.name);
    Driver const driver;
    CPLConfigOptionSetter const date(date_option, fixed_date, false);
    // What is written aside goes to the disk when it is whole, and not step by step.
    CPLConfigOptionSetter const unhurried("OGR_SQLITE_SYNCHRONOUS", "OFF", true);
    // Nor has it a file of what to undo, made and removed for each table: a broken one is removed as a whole.
    CPLConfigOptionSetter const without_journal("OGR_SQLITE_JOURNAL", "MEMORY", true);
    // A GeoPackage needs no function of SpatiaLite, which takes as long as a small network to start.
    CPLConfigOptionSetter const without_spatialite("SPATIALITE_LOAD", "NO", true);
    OGRSpatialReference reference = crs.empty() ? OGRSpatialReference() : read_reference(crs);
    refuse_if<BadInput>(format == LayerFormat::geojson && crs.empty(), about.where,
                        "{}: GeoJSON is in degrees (RFC 7946), and the network has no CRS to bring it there: assign "
                        "one, or write FlatGeobuf",
                        about.name);
    refuse_if<BadInput>(format == LayerFormat::geojson2008 &&
                            (crs.empty() || reference.GetAuthorityCode(nullptr) == nullptr),
                        about.where,
                        "{}: GeoJSON of 2008 names a CRS by its EPSG code, which the network's has not: write GeoJSON "
                        "in degrees (--format geojson) or FlatGeobuf",
                        about.name);
    GDALDriver* const writer = GetGDALDriverManager()->GetDriverByName(file_format.driver);
    std::optional<Shapefile> shapefile;
    if (format == LayerFormat::shapefile) {
        shapefile.emplace(path);
    }
    std::string const written = shapefile ? shapefile->path() : path;
    Dataset dataset(writer == nullptr ? nullptr : writer->Create(written.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    if (dataset == nullptr) {
        driver.check(about.where, about.name);
        throw IoError(about.where, about.name + " could not be created");
    }
    LayerTarget const target{format, about, driver, *dataset, crs.empty() ? nullptr : &reference};
    bool const transactions = format == LayerFormat::geopackage;
    target.require(!transactions || dataset->StartTransaction() == OGRERR_NONE);
    for (Table const& table : tables) {
        write_layer(target, table, run);
    }
    if (format == LayerFormat::geopackage) {
        if (Table const styles = styles_table(tables); styles.rows > 0) {
            write_layer(target, styles, run);
        }
    }
    target.require(!transactions || dataset->CommitTransaction() == OGRERR_NONE);
    dataset.reset();
    driver.check(about.where, about.name);
    if (!crs.empty()) {
        bool const in_degrees = format == LayerFormat::geojson;
        require_crs(written, in_degrees ? read_reference("EPSG:4326") : reference, about);
        driver.check(about.where, about.name);
    }
    if (shapefile) {
        shapefile->copy_to_disk();
    }
}

void write_tables(std::vector<Table> const& tables, std::string const& crs, std::string const& path, Run const& run) {
    write_file(tables, crs, path, LayerFormat::geopackage, run);
}

} // namespace thalweg::io
