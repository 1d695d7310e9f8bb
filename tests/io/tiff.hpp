// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

/// A GeoTIFF of 32-bit floats that another program wrote.
struct Tiff {
    int width = 40;
    int height = 30;
    int bands = 1;
    int epsg = 32632;                                                      ///< 0 for no CRS
    std::vector<double> frame{500000.0, 30.0, 0.0, 5000000.0, 0.0, -30.0}; ///< as in GDAL; empty: no position
    std::optional<double> nodata = {};
    double scale = 1.0;
    double offset = 0.0;
};

/// Writes value(column, row) into every band. Gives the path.
inline std::string written(std::string const& path, Tiff const& wanted, std::function<double(int, int)> const& value) {
    GDALAllRegister();
    GDALDatasetUniquePtr const data(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), wanted.width, wanted.height, wanted.bands, GDT_Float32, nullptr));
    if (!wanted.frame.empty()) {
        std::vector<double> frame = wanted.frame;
        data->SetGeoTransform(frame.data());
    }
    if (wanted.epsg != 0) {
        OGRSpatialReference reference;
        reference.importFromEPSG(wanted.epsg);
        data->SetSpatialRef(&reference);
    }
    std::vector<double> row(static_cast<std::size_t>(wanted.width));
    for (int b = 1; b <= wanted.bands; ++b) {
        GDALRasterBand& band = *data->GetRasterBand(b);
        if (wanted.nodata) {
            band.SetNoDataValue(*wanted.nodata);
        }
        if (wanted.scale != 1.0) {
            band.SetScale(wanted.scale);
            band.SetOffset(wanted.offset);
        }
        for (int r = 0; r < wanted.height; ++r) {
            for (int c = 0; c < wanted.width; ++c) {
                row[static_cast<std::size_t>(c)] = value(c, r);
            }
            EXPECT_EQ(
                band.RasterIO(GF_Write, 0, r, wanted.width, 1, row.data(), wanted.width, 1, GDT_Float64, 0, 0, nullptr),
                CE_None);
        }
    }
    return path;
}
