// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/read_polygons.hpp>

#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {
namespace {

[[noreturn]] void refuse_polygons(std::string const& text) {
    throw BadInput("io.read_polygons: " + text);
}

bool is_polygonal(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbSurface) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiSurface) != 0;
}

// Of a layer of any shapes the first feature decides.
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
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
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

// One polygon for each part.
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

/// Number of a field by name in any case; -1 for "". Throws where there is none of numbers.
int field_in(OGRLayer& layer, std::string const& name, std::string const& field) {
    int const at = field.empty() ? -1 : layer.GetLayerDefn()->GetFieldIndex(field.c_str());
    if (field.empty()) {
        return at;
    }
    OGRFieldType const type = at < 0 ? OFTString : layer.GetLayerDefn()->GetFieldDefn(at)->GetType();
    if (type != OFTReal && type != OFTInteger && type != OFTInteger64) {
        refuse_polygons(
            fmt::format("layer {} of {} has no field {} of numbers; add one", layer.GetName(), name, field));
    }
    return at;
}

double value_in(OGRFeature const& feature, int field, std::string const& name) {
    if (field < 0) {
        return 0.0;
    }
    double const value = feature.IsFieldSetAndNotNull(field) ? feature.GetFieldAsDouble(field) : std::nan("");
    if (!std::isfinite(value)) {
        refuse_polygons(fmt::format("feature {} of {} has no finite value in the field {}", feature.GetFID(), name,
                                    feature.GetFieldDefnRef(field)->GetNameRef()));
    }
    return value;
}

std::vector<Polygon> take(OGRLayer& layer, std::string const& name, std::string const& field, Run const& run) {
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
            polygons[p].value = value_in(*feature, valued, name);
        }
    }
    return polygons;
}

// PROJ's last bits differ between machines: a millionth of a unit does not.
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
                if (turn->Transform(1, &p.x, &p.y) == 0 || !std::isfinite(p.x) || !std::isfinite(p.y)) {
                    refuse_polygons(
                        fmt::format("vertex {} of feature {} of {}, ({}, {}), cannot be reprojected to {:.60}: {}",
                                    i + 1, polygon.feature, name, ring[i].x, ring[i].y, crs, driver.take()));
                }
                ring[i] = {rounded(p.x), rounded(p.y)};
            }
        }
    }
}

} // namespace

bool holds_polygons(std::string const& path) {
    Driver const driver;
    Dataset const data = open_file(path, GDAL_OF_RASTER | GDAL_OF_VECTOR, "io.holds_polygons: " + path);
    return data->GetRasterCount() == 0 && !polygon_layers(*data).empty();
}

std::string crs_for_polygons(std::string const& path) {
    auto const name = std::filesystem::path(path).filename().string();
    Driver const driver;
    Dataset const data = open_file(path, GDAL_OF_VECTOR, "io.read_polygons: " + path);
    OGRLayer& layer = choose_layer(*data, name);
    OGREnvelope box;
    if (is_missing(layer.GetSpatialRef()) || layer.GetExtent(&box) != OGRERR_NONE) {
        refuse_polygons(fmt::format("layer {} of {} has no CRS or no polygons; assign one (ogr2ogr -a_srs EPSG:n)",
                                    layer.GetName(), name));
    }
    return IntoMetres(*layer.GetSpatialRef(), "", {{box.MinX, box.MinY}, {box.MaxX, box.MaxY}}, name).crs();
}

PolygonsCrs crs_of_polygons(std::string const& path) {
    auto const name = std::filesystem::path(path).filename().string();
    Driver const driver;
    Dataset const data = open_file(path, GDAL_OF_VECTOR, "io.read_polygons: " + path);
    OGRSpatialReference own = crs_of_layer(choose_layer(*data, name).GetSpatialRef(), "");
    own.StripVertical();
    return own.IsEmpty() != 0 ? PolygonsCrs() : PolygonsCrs{name_of(own), is_projected_in_metres(own)};
}

Polygons read_polygons(std::string const& path, std::string const& crs, Run const& run) {
    return read_polygons(path, crs, "", run);
}

Polygons read_polygons(std::string const& path, std::string const& crs, std::string const& field, Run const& run) {
    auto const name = std::filesystem::path(path).filename().string();
    Driver const driver;
    Dataset const data = open_file(path, GDAL_OF_VECTOR, "io.read_polygons: " + path);
    OGRLayer& layer = choose_layer(*data, name);
    Polygons read{take(layer, name, field, run), crs, name};
    driver.check("io.read_polygons: " + path);
    if (read.polygons.empty()) {
        refuse_polygons(fmt::format("layer {} of {} is empty", layer.GetName(), name));
    }
    OGRSpatialReference from = crs_of_layer(layer.GetSpatialRef(), "");
    from.StripVertical();
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    std::string const own_crs = from.IsEmpty() != 0 ? "" : name_of(from);
    std::string const whose = fmt::format("io.read_polygons: layer {} of {}", layer.GetName(), name);
    if (!same_crs(own_crs, crs, whose, "the grid")) {
        reproject(read.polygons, from, crs, name, driver);
    }
    return read;
}

} // namespace thalweg::io
