// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/polygons.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/internal/polygons.hpp>
#include <thalweg/io/raster/internal/raster_dataset.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {
namespace {

[[noreturn]] void refuse_polygons(std::string const& text) {
    throw BadInput("io.read_polygons", text);
}

bool is_polygonal(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbSurface) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiSurface) != 0;
}

// For a layer of any geometry type the first feature decides.
std::vector<OGRLayer*> polygon_layers(GDALDataset& data) {
    std::vector<OGRLayer*> layers;
    for (auto* const layer : data.GetLayers()) {
        auto type = wkbFlatten(layer->GetGeomType());
        if (type == wkbUnknown) {
            OGRFeatureUniquePtr const first(layer->GetNextFeature());
            layer->ResetReading();
            if (first && first->GetGeometryRef() != nullptr) {
                type = wkbFlatten(first->GetGeometryRef()->getGeometryType());
            }
        }
        if (is_polygonal(type)) {
            layers.push_back(layer);
        }
    }
    return layers;
}

OGRLayer& choose_layer(GDALDataset& data, std::string const& name) {
    auto const layers = polygon_layers(data);
    if (layers.size() == 1) {
        return *layers.front();
    }
    std::string names;
    for (auto* const layer : data.GetLayers()) {
        names += (names.empty() ? "" : ", ") + std::string(layer->GetName());
    }
    if (layers.empty()) {
        refuse_polygons(fmt::format("{} has no layer of polygons{}", name, names.empty() ? "" : " (" + names + ")"));
    }
    refuse_polygons(fmt::format("{} has {} layers of polygons; extract the one you mean (ogr2ogr OUT {} LAYER; {})",
                                name, layers.size(), name, names));
}

void add_ring(OGRLinearRing const& drawn, Polygon& polygon, std::string const& name) {
    std::vector<Vec2> ring;
    for (int i = 0; i < drawn.getNumPoints(); ++i) {
        Vec2 const p{drawn.getX(i), drawn.getY(i)};
        if (!is_finite(p)) {
            refuse_polygons(fmt::format("vertex {} of feature {} of {} is not finite: ({}, {}); correct the file",
                                        i + 1, polygon.feature, name, p.x, p.y));
        }
        ring.push_back(p);
    }
    if (ring.size() > 1 && ring.front() == ring.back()) {
        ring.pop_back();
    }
    polygon.rings.push_back(std::move(ring));
}

// Adds one polygon for each part.
void add_parts(OGRGeometry const& geometry, std::int64_t feature, std::string const& name,
               std::vector<Polygon>& polygons) {
    auto const flat = wkbFlatten(geometry.getGeometryType());
    if (OGR_GT_IsSubClassOf(flat, wkbGeometryCollection) != 0) {
        for (auto const* const part : *geometry.toGeometryCollection()) {
            add_parts(*part, feature, name, polygons);
        }
        return;
    }
    if (flat != wkbPolygon && flat != wkbTriangle) {
        refuse_polygons(
            fmt::format("feature {} of {} is a {}, not a polygon", feature, name, OGRGeometryTypeToName(flat)));
    }
    Polygon polygon{feature, {}};
    for (auto const* const ring : *geometry.toPolygon()) {
        add_ring(*ring, polygon, name);
    }
    polygons.push_back(std::move(polygon));
}

enum class Values : std::uint8_t { required, optional };

/// A field of numbers from which polygons take their values.
struct ValueField {
    std::string name = {}; ///< in letters of any case; "": none, and values are 0
    Values values = Values::required;
};

bool holds_numbers(OGRFieldDefn const& field) {
    OGRFieldType const type = field.GetType();
    return type == OFTReal || type == OFTInteger || type == OFTInteger64;
}

/// The number of a field; -1: none. Throws if there is no numeric field where one is required.
int field_in(OGRLayer& layer, std::string const& name, ValueField const& field) {
    int const at = field.name.empty() ? -1 : layer.GetLayerDefn()->GetFieldIndex(field.name.c_str());
    bool const is_missing = at < 0 || !holds_numbers(*layer.GetLayerDefn()->GetFieldDefn(at));
    if (!field.name.empty() && field.values == Values::required && is_missing) {
        refuse_polygons(
            fmt::format("layer {} of {} has no field {} of numbers; add one", layer.GetName(), name, field.name));
    }
    return at;
}

double value_in(OGRFeature const& feature, int at, ValueField const& field, std::string const& name) {
    bool const has_value = at >= 0 && feature.IsFieldSetAndNotNull(at) != 0;
    if (!has_value && (field.name.empty() || field.values == Values::optional)) {
        return field.name.empty() ? 0.0 : std::nan("");
    }
    bool const is_number = has_value && holds_numbers(*feature.GetFieldDefnRef(at));
    double const value = is_number ? feature.GetFieldAsDouble(at) : std::nan("");
    if (!std::isfinite(value)) {
        refuse_polygons(fmt::format("feature {} of {} has no finite value in the field {}", feature.GetFID(), name,
                                    feature.GetFieldDefnRef(at)->GetNameRef()));
    }
    return value;
}

std::vector<Polygon> take(OGRLayer& layer, std::string const& name, ValueField const& field, Run const& run) {
    std::vector<Polygon> polygons;
    int const valued = field_in(layer, name, field);
    for (auto const& feature : layer) {
        run.check();
        OGRGeometry const* const drawn = feature->GetGeometryRef();
        if (drawn == nullptr || drawn->IsEmpty() != 0) {
            refuse_polygons(fmt::format("feature {} of {} has no polygon; remove it", feature->GetFID(), name));
        }
        std::unique_ptr<OGRGeometry> const straight(drawn->getLinearGeometry());
        std::size_t const first = polygons.size();
        add_parts(*straight, feature->GetFID(), name, polygons);
        for (std::size_t p = first; p < polygons.size(); ++p) {
            polygons[p].value = value_in(*feature, valued, field, name);
        }
    }
    return polygons;
}

// PROJ's last bits differ between machines; rounding to a millionth of a unit hides that.
void reproject(std::vector<Polygon>& polygons, OGRSpatialReference const& from, std::string const& crs,
               std::string const& name, Driver const& driver) {
    OGRSpatialReference const to = read_reference(crs);
    std::unique_ptr<OGRCoordinateTransformation> const turn(OGRCreateCoordinateTransformation(&from, &to));
    if (!turn) {
        refuse_polygons(fmt::format("{} cannot be reprojected to {:.60}: {}", name, crs, driver.take()));
    }
    for (Polygon& polygon : polygons) {
        for (auto& ring : polygon.rings) {
            for (std::size_t i = 0; i < ring.size(); ++i) {
                Vec2 p = ring[i];
                if (turn->Transform(1, &p.x, &p.y) == 0 || !is_finite(p)) {
                    refuse_polygons(
                        fmt::format("vertex {} of feature {} of {}, ({}, {}), cannot be reprojected to {:.60}: {}",
                                    i + 1, polygon.feature, name, ring[i].x, ring[i].y, crs, driver.take()));
                }
                ring[i] = {rounded(p.x), rounded(p.y)};
            }
        }
    }
}

Polygons read_with(Source const& source, std::string const& crs, ValueField const& field, Run const& run) {
    auto const name = std::filesystem::path(source.path).filename().string();
    Driver const driver;
    Dataset const data = open_file(source, GDAL_OF_VECTOR, {"io.read_polygons", source.path});
    OGRLayer& layer = choose_layer(*data, name);
    Polygons read{take(layer, name, field, run), crs, name};
    driver.check("io.read_polygons", source.path);
    if (read.polygons.empty()) {
        refuse_polygons(fmt::format("layer {} of {} is empty", layer.GetName(), name));
    }
    OGRSpatialReference from = crs_of_layer(layer.GetSpatialRef(), "");
    from.StripVertical();
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    std::string const own_crs = from.IsEmpty() != 0 ? "" : name_of(from);
    About const about{"io.read_polygons", fmt::format("layer {} of {}", layer.GetName(), name)};
    if (!is_same_crs(own_crs, crs, about, "the grid")) {
        reproject(read.polygons, from, crs, name, driver);
    }
    return read;
}

std::unique_ptr<OGRGeometry> shape_of(Polygon const& polygon) {
    auto shape = std::make_unique<OGRPolygon>();
    for (std::vector<Vec2> const& ring : polygon.rings) {
        if (ring.size() < 3) {
            continue;
        }
        auto* const closed = new OGRLinearRing; // the polygon owns it
        for (Vec2 const p : ring) {
            closed->addPoint(p.x, p.y);
        }
        closed->closeRings();
        shape->addRingDirectly(closed);
    }
    return shape;
}

/// By polygon: the first of those whose boxes overlap, directly or through others.
std::vector<std::size_t> groups_by_box(std::vector<OGREnvelope> const& boxes) {
    std::vector<std::size_t> order(boxes.size());
    std::vector<std::size_t> root(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        order[i] = root[i] = i;
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(boxes[i].MinX, i); });
    auto const of = [&](std::size_t i) {
        while (root[i] != i) {
            i = root[i] = root[root[i]];
        }
        return i;
    };
    for (std::size_t a = 0; a < order.size(); ++a) {
        for (std::size_t b = a + 1; b < order.size() && boxes[order[b]].MinX <= boxes[order[a]].MaxX; ++b) {
            if (boxes[order[a]].Intersects(boxes[order[b]]) != 0) {
                std::size_t const one = of(order[a]);
                std::size_t const other = of(order[b]);
                root[std::max(one, other)] = std::min(one, other);
            }
        }
    }
    for (std::size_t i = 0; i < root.size(); ++i) {
        root[i] = of(i);
    }
    return root;
}

OGREnvelope widened(OGREnvelope box, double by) {
    box.MinX -= by;
    box.MinY -= by;
    box.MaxX += by;
    box.MaxY += by;
    return box;
}

int parts_in(OGRGeometry const& shape) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    return flat == wkbMultiPolygon ? shape.toMultiPolygon()->getNumGeometries() : 1;
}

/// The shape with gaps up to a width closed, where that joins parts.
std::unique_ptr<OGRGeometry> closed(std::unique_ptr<OGRGeometry> shape, double gap_m) {
    constexpr int segments = 2; // of a quarter of a circle
    if (shape == nullptr || !(gap_m > 0.0) || parts_in(*shape) < 2) {
        return shape;
    }
    double const half_m = 0.51 * gap_m;
    std::unique_ptr<OGRGeometry> const wide(shape->Buffer(half_m, segments));
    std::unique_ptr<OGRGeometry> narrow(wide == nullptr ? nullptr : wide->Buffer(-half_m, segments));
    return narrow != nullptr && narrow->IsEmpty() == 0 && parts_in(*narrow) < parts_in(*shape) ? std::move(narrow)
                                                                                               : std::move(shape);
}

void take_parts(OGRGeometry const& shape, std::int64_t feature, std::vector<Polygon>& polygons) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    if (OGR_GT_IsSubClassOf(flat, wkbGeometryCollection) != 0) {
        for (auto const* const part : *shape.toGeometryCollection()) {
            take_parts(*part, feature, polygons);
        }
    } else if (flat == wkbPolygon && shape.IsEmpty() == 0) {
        Polygon& polygon = polygons.emplace_back(Polygon{feature, {}});
        for (auto const* const ring : *shape.toPolygon()) {
            add_ring(*ring, polygon, "united");
        }
    }
}

constexpr std::int32_t none = -1;

void require_numbers(Raster<std::int32_t> const& numbers, std::int64_t count, About const& about) {
    auto const values = numbers.values();
    auto const beyond = std::find_if(values.begin(), values.end(), [&](std::int32_t n) { return n >= count; });
    if (beyond != values.end()) {
        Cell const c = numbers.grid().at(beyond - values.begin());
        throw BadInput(about.where, fmt::format("{}{} at column {}, row {} is not one of {}", about.beginning(),
                                                *beyond, c.col, c.row, count));
    }
}

Polygon taken(OGRPolygon const& drawn, std::int64_t number) {
    Polygon polygon{number, {}};
    for (auto const* const ring : drawn) {
        std::vector<Vec2> positions;
        for (int i = 0; i + 1 < ring->getNumPoints(); ++i) { // the last vertex equals the first
            positions.push_back({ring->getX(i), ring->getY(i)});
        }
        polygon.rings.push_back(std::move(positions));
    }
    return polygon;
}

/// As polygonise(), of the numbers that number_of gives for those of the cells.
template <class NumberOf>
std::vector<std::vector<Polygon>> outlines_of(Raster<std::int32_t> const& cells, std::int64_t count,
                                              NumberOf const& number_of, Run const& run) {
    constexpr char const* where = "io.polygonise";
    Driver const driver;
    RowPart<std::int32_t> const part = [&](std::int64_t row, std::int64_t col, std::span<std::int32_t> to) {
        auto const from = cells.row(row).subspan(static_cast<std::size_t>(col), to.size());
        std::ranges::transform(from, to.begin(), number_of);
    };
    Dataset const source = dataset_of(cells.grid(), none, part);
    Dataset const drawn(GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* const layer = drawn->CreateLayer("polygons", nullptr, wkbPolygon, nullptr);
    OGRFieldDefn field("number", OFTInteger);
    layer->CreateField(&field);
    GDALRasterBand& band = *source->GetRasterBand(1);
    GdalProgress gdal_progress(run, "outline");
    CPLErr const error = GDALPolygonize(GDALRasterBand::ToHandle(&band), GDALRasterBand::ToHandle(band.GetMaskBand()),
                                        OGRLayer::ToHandle(layer), 0, nullptr, &GdalProgress::step, &gdal_progress);
    gdal_progress.settle();
    driver.check(where);
    refuse_if<IoError>(error != CE_None, where, "io.polygonise failed");
    std::vector<std::vector<Polygon>> polygons(count);
    for (auto const& feature : *layer) {
        auto const number = feature->GetFieldAsInteger64(0);
        polygons[number].push_back(taken(*feature->GetGeometryRef()->toPolygon(), number));
    }
    driver.check(where); // a failed allocation also ends the loop
    return polygons;
}

using Kind = Column::Kind;

/// The catchments that share an outlet.
struct Basin {
    std::int64_t id = 0;
    std::int64_t arcs = 0;
    std::int64_t cells = 0;
};

void require_counted(CatchmentTables const& tables, About const& about) {
    std::vector<std::int64_t> counted(tables.rows.size(), 0);
    for (std::int32_t const number : tables.number.values()) {
        if (number >= 0 && number < std::ssize(counted)) {
            ++counted[number];
        }
    }
    for (std::size_t i = 0; i < counted.size(); ++i) {
        if (counted[i] != tables.rows[i].cells) {
            throw BadInput(about.where,
                           fmt::format("{}: the catchment of arc {} has {} cells, its row says {}", about.name,
                                       tables.rows[i].arc_id, counted[i], tables.rows[i].cells));
        }
    }
}

/// Basins by id, and by row the index of its basin.
std::vector<Basin> basins_of(std::vector<CatchmentRow> const& rows, std::vector<std::int32_t>& basin_of_row) {
    std::map<std::int64_t, Basin> by_id;
    for (CatchmentRow const& row : rows) {
        if (row.cells > 0) {
            Basin& basin = by_id[row.basin_id];
            basin.id = row.basin_id;
            ++basin.arcs;
            basin.cells += row.cells;
        }
    }
    std::vector<Basin> basins;
    std::map<std::int64_t, std::int32_t> place;
    for (auto const& [id, basin] : by_id) {
        place[id] = static_cast<std::int32_t>(basins.size());
        basins.push_back(basin);
    }
    for (CatchmentRow const& row : rows) {
        basin_of_row.push_back(row.cells > 0 ? place[row.basin_id] : -1);
    }
    return basins;
}

Raster<std::int32_t> numbered(Raster<std::int32_t> const& rows, std::vector<std::int32_t> const& basin_of_row) {
    Raster<std::int32_t> basin_number(rows.grid(), none);
    for (std::int64_t i = 0; i < rows.cells(); ++i) {
        if (rows[i] >= 0) {
            basin_number[i] = basin_of_row[static_cast<std::size_t>(rows[i])];
        }
    }
    return basin_number;
}

/// Columns that are asked by row of a table, from ones that are asked by another number.
void add_columns(Table& table, std::vector<Column> const& columns,
                 std::function<std::size_t(std::size_t row)> const& number_of) {
    for (Column column : columns) {
        column.at = [at = column.at, number_of](std::size_t row) { return at(number_of(row)); };
        table.columns.push_back(std::move(column));
    }
}

} // namespace

bool holds_polygons(Source const& source) {
    Driver const driver;
    Dataset const data = open_file(source, GDAL_OF_RASTER | GDAL_OF_VECTOR, {"io.holds_polygons", source.path});
    return data->GetRasterCount() == 0 && !polygon_layers(*data).empty();
}

std::string crs_for_polygons(Source const& source) {
    auto const name = std::filesystem::path(source.path).filename().string();
    Driver const driver;
    Dataset const data = open_file(source, GDAL_OF_VECTOR, {"io.read_polygons", source.path});
    OGRLayer& layer = choose_layer(*data, name);
    OGREnvelope box;
    if (is_missing(layer.GetSpatialRef()) || layer.GetExtent(&box) != OGRERR_NONE) {
        refuse_polygons(fmt::format("layer {} of {} has no CRS or no polygons; assign one (ogr2ogr -a_srs EPSG:n)",
                                    layer.GetName(), name));
    }
    return IntoMetres(*layer.GetSpatialRef(), "", {{box.MinX, box.MinY}, {box.MaxX, box.MaxY}}, name).crs();
}

PolygonsCrs crs_of_polygons(Source const& source) {
    auto const name = std::filesystem::path(source.path).filename().string();
    Driver const driver;
    Dataset const data = open_file(source, GDAL_OF_VECTOR, {"io.read_polygons", source.path});
    OGRSpatialReference own = crs_of_layer(choose_layer(*data, name).GetSpatialRef(), "");
    own.StripVertical();
    return own.IsEmpty() != 0 ? PolygonsCrs() : PolygonsCrs{name_of(own), is_projected_in_metres(own)};
}

Polygons read_polygons(Source const& source, std::string const& crs, Run const& run) {
    return read_with(source, crs, {}, run);
}

Polygons read_polygons(Source const& source, std::string const& crs, std::string const& field, Run const& run) {
    return read_with(source, crs, {field}, run);
}

Polygons read_polygons_valued(Source const& source, std::string const& crs, std::string const& field, Run const& run) {
    return read_with(source, crs, {field, Values::optional}, run);
}

std::vector<Polygon> united(std::vector<Polygon> polygons, double gap_m) {
    Driver const driver;
    std::vector<std::unique_ptr<OGRGeometry>> shapes;
    std::vector<OGREnvelope> boxes(polygons.size());
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        shapes.push_back(shape_of(polygons[i]));
        shapes[i]->getEnvelope(&boxes[i]);
        if (boxes[i].IsInit() != 0) {
            boxes[i] = widened(boxes[i], 0.5 * gap_m);
        }
    }
    std::vector<std::size_t> const group = groups_by_box(boxes);
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < group.size(); ++i) {
        members[group[i]].push_back(i);
    }
    std::vector<Polygon> result;
    for (auto const& [first, of] : members) {
        if (of.size() == 1 && shapes[first]->IsValid() != 0) {
            take_parts(*shapes[first], polygons[first].feature, result);
            continue;
        }
        OGRMultiPolygon all;
        for (std::size_t const i : of) {
            std::unique_ptr<OGRGeometry> const mended(shapes[i]->IsValid() != 0 ? shapes[i]->clone()
                                                                                : shapes[i]->MakeValid());
            std::vector<Polygon> parts;
            if (mended != nullptr) {
                take_parts(*mended, polygons[i].feature, parts);
            }
            for (Polygon const& part : parts) {
                all.addGeometryDirectly(shape_of(part).release());
            }
        }
        std::unique_ptr<OGRGeometry> const whole = closed(std::unique_ptr<OGRGeometry>(all.UnionCascaded()), gap_m);
        if (whole == nullptr) {
            continue;
        }
        std::vector<Polygon> parts;
        take_parts(*whole, polygons[first].feature, parts);
        for (Polygon& part : parts) { // the first feature in it
            std::unique_ptr<OGRGeometry> const shape = shape_of(part);
            auto const own =
                std::ranges::find_if(of, [&](std::size_t i) { return shape->Intersects(shapes[i].get()) != 0; });
            part.feature = own == of.end() ? part.feature : polygons[*own].feature;
            result.push_back(std::move(part));
        }
    }
    return result;
}

std::vector<std::vector<Polygon>> polygonise(Raster<std::int32_t> const& numbers, std::int64_t count, Run const& run) {
    About const about{"io.polygonise", ""};
    require_numbers(numbers, count, about);
    require_size(numbers.grid(), about);
    return outlines_of(
        numbers, count, [](std::int32_t n) { return std::max(n, none); }, run);
}

Raster<std::int32_t> basins_by_cell(CatchmentTables const& tables) {
    std::vector<std::int32_t> basin_of_row;
    basins_of(tables.rows, basin_of_row);
    return numbered(tables.number, basin_of_row);
}

CatchmentCount write_catchments(CatchmentTables const& tables, std::string const& path, Run const& run) {
    Grid const& grid = tables.number.grid();
    double const cell_m2 = grid.cell_m * grid.cell_m;
    require_counted(tables, {"io.write_catchments", path});

    auto const outlines = polygonise(tables.number, static_cast<std::int64_t>(tables.rows.size()), run);
    std::vector<std::size_t> drawn; // rows with cells
    CatchmentCount count;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        if (!outlines[i].empty()) {
            drawn.push_back(i);
            count.parts += static_cast<std::int64_t>(outlines[i].size());
        }
    }
    std::vector<std::int32_t> basin_of_row;
    auto const basins = basins_of(tables.rows, basin_of_row);
    auto const basin_of = [&](std::int32_t row) {
        return row < 0 ? none : basin_of_row[static_cast<std::size_t>(row)];
    };
    auto const shores = outlines_of(tables.number, static_cast<std::int64_t>(basins.size()), basin_of, run);
    count.catchments = static_cast<std::int64_t>(drawn.size());
    count.basins = static_cast<std::int64_t>(basins.size());

    auto const row_at = [&](std::size_t row) -> CatchmentRow const& { return tables.rows[drawn[row]]; };
    auto const area = [cell_m2](std::int64_t cells) { return static_cast<double>(cells) * cell_m2; };
    Table catchments{"catchments", Table::Shape::multi_polygon, drawn.size(), {}, {}};
    catchments.columns = {
        {"arc_id", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).arc_id; }},
        {"ds_arc", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).ds_arc; }},
        {"basin_id", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).basin_id; }},
        {"cells", Kind::wide_integer, 0, [=](std::size_t row) { return row_at(row).cells; }},
        {"area", Kind::real, 0, [=](std::size_t row) { return area(row_at(row).cells); }},
        {"ds_area", Kind::real, 0, [=](std::size_t row) { return area(row_at(row).upstream_cells); }},
    };
    add_columns(catchments, tables.columns, [&](std::size_t row) { return drawn[row]; });
    catchments.parts_at = [&](std::size_t row) { return outlines[drawn[row]]; };
    catchments.style = catchment_style(false);

    auto const basin_at = [&](std::size_t row) -> Basin const& { return basins[row]; };
    Table whole{"basins", Table::Shape::multi_polygon, basins.size(), {}, {}};
    whole.columns = {
        {"basin_id", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).id; }},
        {"arcs", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).arcs; }},
        {"cells", Kind::wide_integer, 0, [=](std::size_t row) { return basin_at(row).cells; }},
        {"area", Kind::real, 0, [=](std::size_t row) { return area(basin_at(row).cells); }},
    };
    add_columns(whole, tables.basin_columns, [](std::size_t row) { return row; });
    whole.parts_at = [&](std::size_t row) { return shores[row]; };
    whole.style = catchment_style(true);
    write_tables({std::move(catchments), std::move(whole)}, grid.crs, path, run);
    return count;
}

} // namespace thalweg::io
