// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/content_of.hpp>

#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/read_points.hpp>

namespace thalweg::io {
namespace {

// Of a layer of any shapes the first feature decides.
OGRwkbGeometryType shape_of(OGRLayer& layer) {
    auto type = wkbFlatten(layer.GetGeomType());
    if (type == wkbUnknown) {
        OGRFeatureUniquePtr const first(layer.GetNextFeature());
        layer.ResetReading();
        if (first && first->GetGeometryRef() != nullptr) {
            type = wkbFlatten(first->GetGeometryRef()->getGeometryType());
        }
    }
    return type;
}

} // namespace

FileContent content_of(std::string const& path) {
    FileContent content;
    std::error_code ignored;
    content.path =
        std::filesystem::is_directory(path, ignored) ? (std::filesystem::path(path) / "network.gpkg").string() : path;
    std::string const what = "io.content_of: " + content.path;
    if (is_text_of_points(content.path) && std::filesystem::exists(content.path, ignored)) {
        content.kind = FileContent::Kind::points;
        return content;
    }
    Driver const driver;
    Dataset const data = open_file(content.path, GDAL_OF_RASTER | GDAL_OF_VECTOR, what);
    if (data->GetRasterCount() > 0) {
        return content;
    }
    bool has_points = false;
    bool has_lines = false;
    for (auto* const layer : data->GetLayers()) {
        auto const type = shape_of(*layer);
        driver.check(fmt::format("{}, layer {}", what, layer->GetName()));
        bool const is_line = OGR_GT_IsSubClassOf(type, wkbCurve) != 0 || OGR_GT_IsSubClassOf(type, wkbMultiCurve) != 0;
        has_lines = has_lines || is_line;
        has_points = has_points || type == wkbPoint || type == wkbMultiPoint;
        if (is_line && std::string(layer->GetName()) == "arcs") {
            content.layer = "arcs";
        }
    }
    if (!has_lines && !has_points) {
        throw BadInput(what + " holds neither heights, nor points, nor lines");
    }
    content.kind = has_lines ? FileContent::Kind::lines : FileContent::Kind::points;
    return content;
}

} // namespace thalweg::io
