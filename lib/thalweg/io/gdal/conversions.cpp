// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/conversions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/ground_scale.hpp>
#include <thalweg/io/frame/internal/into_metres.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>
#include <thalweg/io/frame/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/read_points.hpp>
#include <thalweg/io/network/internal/rivers_layer.hpp>

namespace thalweg::io {

namespace {

struct Units {
    OGRSpatialReference crs;
    double height_m = 1.0;
    bool names_height = false; ///< the file says what its heights are in
    bool has_heights = false;
    std::optional<FileBox> box; ///< of what has a place
};

std::optional<FileBox> placed_box(GDALDataset& data) {
    std::array<double, 6> place{};
    if (data.GetGeoTransform(place.data()) != CE_None) {
        return std::nullopt;
    }
    double const east = place[0] + data.GetRasterXSize() * place[1];
    double const south = place[3] + data.GetRasterYSize() * place[5];
    return FileBox{{std::min(place[0], east), std::min(place[3], south)},
                   {std::max(place[0], east), std::max(place[3], south)}};
}

std::optional<FileBox> placed_box(OGRLayer& layer) {
    OGREnvelope box;
    return layer.GetExtent(&box) == OGRERR_NONE ? std::optional(FileBox{{box.MinX, box.MinY}, {box.MaxX, box.MaxY}})
                                                : std::nullopt;
}

OGRLayer* layer_of(GDALDataset& data, std::string const& wanted, std::string const& path) {
    if (!wanted.empty()) {
        return data.GetLayerByName(wanted.c_str());
    }
    try {
        return &rivers_layer(data, "", path, "io.conversions_of");
    } catch (BadInput const&) { // of points or polygons
        return data.GetLayerCount() > 0 ? data.GetLayer(0) : nullptr;
    }
}

Units units_of(GDALDataset& data, std::string const& wanted, std::string const& path, std::string const& source_crs) {
    Units units;
    if (data.GetRasterCount() > 0) {
        units.crs = crs_of_layer(data.GetSpatialRef(), "");
        units.height_m = height_unit_of(data);
        units.names_height = unit_named(data.GetRasterBand(1)->GetUnitType()).has_value();
        units.has_heights = true;
        units.box = placed_box(data);
    } else if (OGRLayer* const layer = layer_of(data, wanted, path)) {
        units.crs = crs_of_layer(layer->GetSpatialRef(), source_crs);
        units.height_m = height_unit_of(*layer, source_crs);
        units.names_height = layer->GetLayerDefn()->GetFieldIndex("z_unit") >= 0;
        units.has_heights = OGR_GT_HasZ(layer->GetGeomType()) != 0;
        units.box = placed_box(*layer);
    }
    units.names_height = units.names_height || has_vertical_unit(&units.crs);
    return units;
}

std::string unit_in_plan(OGRSpatialReference const& crs, std::optional<FileBox> const& box) {
    if (box && is_distorted(crs, *box)) {
        Vec2 const middle{0.5 * (box->low.x + box->high.x), 0.5 * (box->low.y + box->high.y)};
        auto const scale = GroundScale(crs).at(middle);
        return scale ? fmt::format("metres of {:.3g} m on the ground", scale->side_m) : "metres";
    }
    return crs.IsGeographic() != 0 ? "degrees" : words_for_unit(crs.GetLinearUnits());
}

} // namespace

std::vector<std::string> conversions_of(std::string const& path, std::string const& layer, std::string const& crs,
                                        std::string const& source_crs) {
    if (is_text_of_points(path) || crs.empty()) {
        return {};
    }
    Driver const driver;
    Dataset const data = open_undisturbed(path, GDAL_OF_RASTER | GDAL_OF_VECTOR);
    std::string const ignored = driver.take();
    if (!data) {
        return {};
    }
    Units const units = units_of(*data, layer, path, source_crs);
    std::string const name = std::filesystem::path(path).filename().string();
    std::vector<std::string> said;
    bool in_feet = false;
    if (units.crs.IsEmpty() == 0) {
        OGRSpatialReference plan(units.crs);
        plan.StripVertical();
        in_feet = plan.IsProjected() != 0 && std::fabs(plan.GetLinearUnits() - 1.0) > 1e-9;
        OGRSpatialReference target = read_reference(crs);
        target.StripVertical();
        if (name_of(plan) != name_of(target) && plan.IsSame(&target) == 0) {
            bool const is_code = crs.size() < 40; // EPSG:32631; else the whole WKT
            said.push_back(fmt::format("{}: coordinates in {} ({}) are reprojected into {}", name,
                                       plan.GetName() == nullptr ? "its CRS" : plan.GetName(),
                                       unit_in_plan(plan, units.box),
                                       is_code || target.GetName() == nullptr ? crs : target.GetName()));
        }
    }
    if (std::fabs(units.height_m - 1.0) > 1e-9 && units.has_heights) {
        said.push_back(
            fmt::format("{}: heights in {} are converted into metres", name, words_for_unit(units.height_m)));
    } else if (in_feet && units.has_heights && !units.names_height) {
        said.push_back(fmt::format("{}: heights are treated as metres: no vertical CRS or unit says otherwise", name));
    }
    return said;
}

} // namespace thalweg::io
