// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/river_files.hpp>

#include "scratch_folder.hpp"

/// A layer as another program may have written it.
struct ForeignLayer {
    using Field = std::pair<std::string, OGRFieldType>;

    /// "arc_id name:s length:r": integers, unless a letter names another type.
    struct Fields : std::vector<Field> {
        Fields() = default;
        Fields(char const* names) {
            std::map<char, OGRFieldType> const types{{'l', OFTInteger64},     {'r', OFTReal},     {'s', OFTString},
                                                     {'d', OFTDate},          {'t', OFTTime},     {'m', OFTDateTime},
                                                     {'I', OFTIntegerList},   {'R', OFTRealList}, {'S', OFTStringList},
                                                     {'L', OFTInteger64List}, {'i', OFTInteger}};
            std::istringstream words(names);
            for (std::string word; words >> word;) {
                std::size_t const colon = word.find(':');
                emplace_back(word.substr(0, colon), types.at(colon == std::string::npos ? 'i' : word[colon + 1]));
            }
        }
    };

    /// A feature: well-known text ("" for no shape) and its values "1|2|x", "" for NULL.
    struct Row {
        std::string wkt;
        std::vector<std::string> values = {};

        Row(std::string shape, std::string const& texts = "") : wkt(std::move(shape)) {
            for (std::size_t at = 0; !texts.empty() && at != std::string::npos;) {
                std::size_t const end = texts.find('|', at);
                values.push_back(texts.substr(at, end - at));
                at = end == std::string::npos ? end : end + 1;
            }
        }
    };

    std::string name = "rivers";
    OGRwkbGeometryType type = wkbLineString;
    int epsg = 32631; ///< 0 for no CRS
    Fields fields = {};
    std::vector<Row> rows = {};
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

/// Writes layers as a file of the driver that its ending names. Gives its path.
inline std::string written(ScratchFolder const& folder, std::string const& name,
                           std::vector<ForeignLayer> const& layers) {
    std::map<std::string, char const*> const drivers{
        {".gpkg", "GPKG"}, {".shp", "ESRI Shapefile"}, {".fgb", "FlatGeobuf"}, {".geojson", "GeoJSON"}};
    GDALAllRegister();
    std::string path = folder / name;
    std::unique_ptr<GDALDataset> const dataset(GetGDALDriverManager()
                                                   ->GetDriverByName(drivers.at(name.substr(name.rfind('.'))))
                                                   ->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    EXPECT_NE(dataset, nullptr);
    for (auto const& layer : layers) {
        add_layer(*dataset, layer);
    }
    return path;
}

/// A dataset opened by GDAL alone.
inline std::unique_ptr<GDALDataset> opened(std::string const& path, unsigned how = GDAL_OF_VECTOR | GDAL_OF_RASTER) {
    GDALAllRegister();
    return std::unique_ptr<GDALDataset>(GDALDataset::Open(path.c_str(), how));
}

/// A vector file opened to be changed, and SQL to change it.
inline std::unique_ptr<GDALDataset> opened_to_change(std::string const& path) {
    return opened(path, GDAL_OF_VECTOR | GDAL_OF_UPDATE);
}

inline void execute(GDALDataset& dataset, std::string const& sql) {
    dataset.ReleaseResultSet(dataset.ExecuteSQL(sql.c_str(), nullptr, nullptr));
}

/// How often a kind of finding comes up.
inline std::ptrdiff_t count_of(thalweg::NetworkFile const& file, std::string const& kind) {
    return std::ranges::count(file.findings, kind, &thalweg::Finding::kind);
}

/// The first finding of a kind; an empty one when there is none.
inline thalweg::Finding finding_of(thalweg::NetworkFile const& file, std::string const& kind) {
    auto const found = std::ranges::find(file.findings, kind, &thalweg::Finding::kind);
    return found == file.findings.end() ? thalweg::Finding{"left_out"} : *found;
}
