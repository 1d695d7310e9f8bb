// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/river_files.hpp>

#include "scratch_folder.hpp"

/// A layer as somebody else may have written it: fields and values in their own words, "" for NULL.
struct ForeignLayer {
    std::string name;
    OGRwkbGeometryType type = wkbLineString;
    int epsg = 32631; ///< 0 for no CRS
    std::vector<std::pair<std::string, OGRFieldType>> fields;
    std::vector<std::pair<std::string, std::vector<std::string>>> rows; ///< WKT ("" for none) and values
};

inline void add_layer(GDALDataset& dataset, ForeignLayer const& wanted) {
    OGRSpatialReference reference;
    if (wanted.epsg != 0) {
        reference.importFromEPSG(wanted.epsg);
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    OGRLayer* const layer =
        dataset.CreateLayer(wanted.name.c_str(), wanted.epsg != 0 ? &reference : nullptr, wanted.type, nullptr);
    ASSERT_NE(layer, nullptr);
    for (auto const& [name, type] : wanted.fields) {
        OGRFieldDefn field(name.c_str(), type);
        ASSERT_EQ(layer->CreateField(&field), OGRERR_NONE);
    }
    for (auto const& [wkt, values] : wanted.rows) {
        OGRFeature feature(layer->GetLayerDefn());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i].empty()) {
                feature.SetFieldNull(static_cast<int>(i));
            } else {
                feature.SetField(static_cast<int>(i), values[i].c_str());
            }
        }
        if (!wkt.empty()) {
            OGRGeometry* shape = nullptr;
            ASSERT_EQ(OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &shape), OGRERR_NONE) << wkt;
            feature.SetGeometryDirectly(shape);
        }
        ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    }
}

/// Writes layers as a file of one of GDAL's drivers. Gives its path.
inline std::string written(ScratchFolder const& folder, std::string const& name, char const* driver,
                           std::vector<ForeignLayer> const& layers) {
    GDALAllRegister();
    std::string path = folder / name;
    std::unique_ptr<GDALDataset> const dataset(
        GetGDALDriverManager()->GetDriverByName(driver)->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    EXPECT_NE(dataset, nullptr);
    for (auto const& layer : layers) {
        add_layer(*dataset, layer);
    }
    return path;
}

/// How often a kind of finding comes up.
inline std::ptrdiff_t count_of(thalweg::NetworkFile const& file, std::string const& kind) {
    return std::ranges::count(file.findings, kind, &thalweg::Finding::kind);
}

/// The first finding of a kind; an empty one when there is none.
inline thalweg::Finding finding_of(thalweg::NetworkFile const& file, std::string const& kind) {
    auto const found = std::ranges::find(file.findings, kind, &thalweg::Finding::kind);
    return found == file.findings.end() ? thalweg::Finding{} : *found;
}

/// Every file of a folder with its bytes and the time it was last written.
inline std::map<std::string, std::pair<std::string, std::filesystem::file_time_type>>
state_of(ScratchFolder const& folder) {
    std::map<std::string, std::pair<std::string, std::filesystem::file_time_type>> state;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
        std::string const path = entry.path().string();
        state[path] = {entry.is_regular_file() ? bytes_of(path) : "", entry.last_write_time()};
    }
    return state;
}
