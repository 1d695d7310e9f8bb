// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// NetCDF files as models write them: axes without a CRS, several variables, depths.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "scratch_folder.hpp"

namespace netcdf_axes_test {

using namespace thalweg;
using test::error_of;
using test::has;

namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;

constexpr std::size_t width = 5;
constexpr std::size_t height = 4;

/// 100 in the north-west, 1 more by column and 10 more by row.
double sloped(std::size_t col, std::size_t row) {
    return 100.0 + static_cast<double>(col) + 10.0 * static_cast<double>(row);
}

struct Model {
    Attributes x = {};
    Attributes y = {};
    std::vector<std::pair<std::string, Attributes>> variables = {{"elevation", {}}};
    bool from_north = true;
    double bend = 0.0; ///< of the last x
    int epsg = 0;      ///< 0: no CRS
};

void describe(GDALMDArray& array, Attributes const& attributes) {
    for (auto const& [name, value] : attributes) {
        auto const attribute = array.CreateAttribute(name, {}, GDALExtendedDataType::CreateString());
        ASSERT_TRUE(attribute->Write(value.c_str()));
    }
}

void fill(GDALMDArray& array, std::vector<double> const& values) {
    std::vector<std::size_t> counts;
    for (auto const& dimension : array.GetDimensions()) {
        counts.push_back(dimension->GetSize());
    }
    std::array<GUInt64, 2> const from{};
    ASSERT_TRUE(array.Write(from.data(), counts.data(), nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                            values.data()));
}

/// Cells of 2 x 2, the north-western one centred on (500, 4003). Variables after the first hold 1 more.
std::string write(ScratchFolder const& folder, Model const& model) {
    GDALAllRegister();
    std::string const path = folder / "model.nc";
    VSIUnlink(path.c_str());
    auto const real = GDALExtendedDataType::Create(GDT_Float64);
    std::unique_ptr<GDALDataset> const data(
        GetGDALDriverManager()->GetDriverByName("netCDF")->CreateMultiDimensional(path.c_str(), nullptr, nullptr));
    auto const root = data->GetRootGroup();
    auto const rows = root->CreateDimension("y", "", "", height);
    auto const columns = root->CreateDimension("x", "", "", width);
    auto const x = root->CreateMDArray("x", {columns}, real);
    auto const y = root->CreateMDArray("y", {rows}, real);
    fill(*x, {500.0, 502.0, 504.0, 506.0, 508.0 + model.bend});
    fill(*y,
         model.from_north ? std::vector{4003.0, 4001.0, 3999.0, 3997.0} : std::vector{3997.0, 3999.0, 4001.0, 4003.0});
    describe(*x, model.x);
    describe(*y, model.y);
    if (model.epsg != 0) {
        OGRSpatialReference reference;
        EXPECT_EQ(reference.importFromEPSG(model.epsg), OGRERR_NONE);
        char* text = nullptr;
        reference.exportToWkt(&text);
        std::string const wkt = text;
        CPLFree(text);
        describe(*root->CreateMDArray("crs", {}, GDALExtendedDataType::Create(GDT_Int32)), {{"spatial_ref", wkt}});
    }
    double more = 0.0;
    for (auto const& [name, attributes] : model.variables) {
        auto const variable = root->CreateMDArray(name, {rows, columns}, real);
        std::vector<double> values;
        for (std::size_t row = 0; row < height; ++row) {
            for (std::size_t col = 0; col < width; ++col) {
                values.push_back(sloped(col, model.from_north ? row : height - 1 - row) + more);
            }
        }
        fill(*variable, values);
        describe(*variable, attributes);
        if (model.epsg != 0) {
            describe(*variable, {{"grid_mapping", "crs"}});
        }
        more += 1.0;
    }
    return path;
}

Finding const* found(std::vector<Finding> const& findings, FindingKind kind) {
    auto const at = std::ranges::find(findings, kind, &Finding::kind);
    return at == findings.end() ? nullptr : &*at;
}

void expect_sloped(Raster<float> const& dem, double sign = 1.0) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        EXPECT_EQ(static_cast<double>(dem[i]),
                  sign * sloped(static_cast<std::size_t>(c.col), static_cast<std::size_t>(c.row)));
    }
}

} // namespace

TEST(NetcdfAxes, PlaceTheCellsWithAndWithoutAStandardName) {
    ScratchFolder const folder;
    for (bool const from_north : {true, false}) {
        for (bool const is_named : {true, false}) {
            Model model{.from_north = from_north};
            if (is_named) {
                model.x = {{"standard_name", "projection_x_coordinate"}};
                model.y = {{"standard_name", "projection_y_coordinate"}};
            }
            Raster<float> const dem = io::read_dem(write(folder, model));
            EXPECT_EQ(dem.grid(), (Grid{width, height, 2.0, 499.0, 4004.0, ""})) << from_north << is_named;
            expect_sloped(dem);
        }
    }
    // Cells that are not evenly spaced have no frame.
    EXPECT_EQ(io::read_dem(write(folder, {.bend = 1.0})).grid().cell_m, 1.0);
}

TEST(NetcdfAxes, AreInTheirUnit) {
    ScratchFolder const folder;
    auto const in = [&](char const* unit, bool is_named) {
        Attributes of_x{{"units", unit}};
        Attributes of_y{{"units", unit}};
        if (is_named) {
            of_x.emplace_back("standard_name", "projection_x_coordinate");
            of_y.emplace_back("standard_name", "projection_y_coordinate");
        }
        return io::read_dem_file(write(folder, {.x = of_x, .y = of_y}));
    };
    for (bool const is_named : {true, false}) {
        io::DemFile const km = in("km", is_named);
        EXPECT_EQ(km.dem.grid(), (Grid{width, height, 2000.0, 499000.0, 4004000.0, ""}));
        ASSERT_NE(found(km.findings, "site_grid"), nullptr);
        EXPECT_EQ(found(km.findings, "site_grid")->amount, 1000.0);
        EXPECT_NEAR(in("feet", is_named).dem.grid().cell_m, 0.6096, 1e-12);
        io::DemFile const plain = in("m", is_named);
        EXPECT_EQ(found(plain.findings, "site_grid"), nullptr);
        EXPECT_EQ(found(plain.findings, "unknown_unit"), nullptr);
        io::DemFile const odd = in("furlongs", is_named);
        EXPECT_EQ(odd.dem.grid().cell_m, 2.0);
        EXPECT_NE(found(odd.findings, "unknown_unit"), nullptr);
    }
}

TEST(NetcdfAxes, InAnotherUnitThanTheirCrsAreConverted) {
    ScratchFolder const folder;
    for (bool const is_named : {true, false}) {
        Model model{.x = {{"units", "km"}}, .y = {{"units", "km"}}, .epsg = 32632};
        if (is_named) {
            model.x.emplace_back("standard_name", "projection_x_coordinate");
            model.y.emplace_back("standard_name", "projection_y_coordinate");
        }
        io::DemFile const file = io::read_dem_file(write(folder, model));
        EXPECT_EQ(file.dem.grid(), (Grid{width, height, 2000.0, 499000.0, 4004000.0, "EPSG:32632"})) << is_named;
        EXPECT_NE(found(file.findings, "dem_reprojected"), nullptr);
    }
}

TEST(NetcdfDepths, AreLeftForTheHeightsBesideThem) {
    ScratchFolder const folder;
    io::DemFile const both = io::read_dem_file(write(folder, {.variables = {{"elevation", {}}, {"depth", {}}}}));
    expect_sloped(both.dem);
    ASSERT_NE(found(both.findings, "bands"), nullptr);
    EXPECT_TRUE(has(error_of([&] {
                        io::read_dem(write(folder, {.variables = {{"elevation", {}}, {"dem", {}}, {"depth", {}}}}));
                    }),
                    "BadInput", "3 variables", "--band"));
}

TEST(NetcdfDepths, WhatIsNotClearIsSaid) {
    ScratchFolder const folder;
    auto const read = [&](std::string const& name, Attributes const& attributes) {
        return io::read_dem_file(write(folder, {.variables = {{name, attributes}}}));
    };
    auto const doubts = [](io::DemFile const& file) { return found(file.findings, "doubtful_direction") != nullptr; };
    // Named depths, with positive numbers and no word on their direction.
    for (char const* const name : {"depth", "bathymetry"}) {
        io::DemFile const bare = read(name, {});
        EXPECT_TRUE(doubts(bare)) << name;
        expect_sloped(bare.dem);
        EXPECT_FALSE(doubts(read(name, {{"positive", "up"}})));
        io::DemFile const down = read(name, {{"positive", "down"}});
        EXPECT_FALSE(doubts(down));
        expect_sloped(down.dem, -1.0);
    }
    EXPECT_EQ(found(read("depth", {}).findings, "doubtful_direction")->severity(), Severity::warning);
    // The attribute is believed against a name, not against CF's meaning of a standard name.
    io::DemFile const named = read("elevation", {{"positive", "down"}});
    EXPECT_TRUE(doubts(named));
    expect_sloped(named.dem, -1.0);
    for (char const* const standard : {"surface_altitude", "height_above_reference_ellipsoid"}) {
        io::DemFile const height = read("z", {{"positive", "down"}, {"standard_name", standard}});
        EXPECT_TRUE(doubts(height)) << standard;
        expect_sloped(height.dem);
    }
    EXPECT_FALSE(doubts(read("elevation", {})));
}

} // namespace netcdf_axes_test
