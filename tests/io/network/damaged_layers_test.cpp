// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL ends a layer where it cannot read on, as if there were no more features: what looks into one asks why.
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>

#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace damaged_layers_test {

using namespace thalweg;
using namespace thalweg::io;

namespace {

/// A GeoPackage whose page of features is overwritten.
std::string damaged(ScratchFolder const& folder, OGRwkbGeometryType type) {
    std::string const marker = "a feature of the damaged page";
    std::string const path = written(folder, "damaged.gpkg", "GPKG",
                                     {{.name = "rivers",
                                       .type = type,
                                       .fields = {{"z_unit", OFTString}},
                                       .rows = {{"LINESTRING Z (0 0 3,9 9 1)", {marker}}}}});
    std::string bytes = bytes_of(path);
    constexpr std::size_t page = 4096;
    std::size_t const at = bytes.find(marker);
    EXPECT_NE(at, std::string::npos);
    bytes.replace(at / page * page, page, std::string(page, '\x5a'));
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

using Data = std::unique_ptr<GDALDataset>;

Data opened(std::string const& path) {
    GDALAllRegister();
    return Data(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
}

} // namespace

TEST(DamagedLayers, AreNotTakenForEmptyOnes) {
    ScratchFolder const folder;
    std::string const path = damaged(folder, wkbUnknown);
    EXPECT_THROW(content_of(path), IoError);
    EXPECT_THROW(find_rivers(path), IoError);
    Data const data = opened(path);
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(require_lines(*data, "damaged.gpkg", "io.test"), IoError);
    EXPECT_THROW(rivers_layer(*data, "", "damaged.gpkg", "io.test"), IoError);
}

TEST(DamagedLayers, HeightsAreNotTakenForMetres) {
    ScratchFolder const folder;
    Data const data = opened(damaged(folder, wkbLineString25D));
    ASSERT_NE(data, nullptr);
    EXPECT_THROW(height_unit_of(*data->GetLayer(0)), IoError);
}

} // namespace damaged_layers_test
