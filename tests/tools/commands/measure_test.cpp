// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"

namespace measure_test {

namespace fs = std::filesystem;

namespace {

std::unique_ptr<GDALDataset> open(fs::path const& path) {
    GDALAllRegister();
    return std::unique_ptr<GDALDataset>(
        GDALDataset::Open(path.string().c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR | GDAL_OF_VERBOSE_ERROR));
}

std::vector<double> values_of(fs::path const& path) {
    auto const dataset = open(path);
    int const width = dataset->GetRasterXSize();
    int const height = dataset->GetRasterYSize();
    std::vector<double> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width, height,
                                                  GDT_Float64, 0, 0, nullptr),
              CE_None);
    return values;
}

/// Exit 2, the words in the message, nothing written.
void refused(Workplace const& place, std::string const& arguments, std::string const& words) {
    expect_refused(place, "measure " + arguments, words);
}

/// A plane that falls by 2 to the east and 1 to the south, with a hole in its corner; and its river along the bottom.
void write_plane(Workplace const& place) {
    place.write("dem.asc", "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n"
                           "-9999 28 26 24\n29 27 25 23\n28 26 24 22\n");
    place.write("rivers.geojson",
                R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"EPSG:32631"}},"features":[)"
                R"({"type":"Feature","properties":{"line":7,"next":9},"geometry":{"type":"LineString",)"
                R"("coordinates":[[500005,4000005],[500025,4000005]]}},)"
                R"({"type":"Feature","properties":{"line":9,"next":0},"geometry":{"type":"LineString",)"
                R"("coordinates":[[500025,4000005],[500060,4000005]]}}]})");
}

} // namespace

TEST(Measure, AreasAndDirectionsOfADem) {
    Workplace const place;
    write_plane(place);
    Outcome const o = expect_run(place, "measure dem.asc --what d8,dinf,directions -o out --json", 0);
    auto const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["cells"], 11);
    EXPECT_EQ(json["area_m2"], 1100.0);
    EXPECT_EQ(json["files"].size(), 4U);
    // Each goes east down the steeper edge (2 a cell; the diagonal has 3 over 1.41).
    EXPECT_EQ(values_of(place / "out/direction_d8.tif"), (std::vector<double>{255, 2, 2, 4, 2, 2, 2, 4, 1, 1, 1, 0}));
    EXPECT_EQ(values_of(place / "out/area_d8.tif"),
              (std::vector<double>{-9999, 100, 100, 100, 100, 100, 200, 300, 100, 300, 500, 1100}));
    auto const angles = values_of(place / "out/direction_dinf.tif");
    double const pi = std::acos(-1.0);
    EXPECT_NEAR(angles[5], 2.0 * pi - std::atan(0.5), 1e-6);
    EXPECT_EQ(angles[11], -1.0);
    EXPECT_EQ(angles[0], -9999.0);
    EXPECT_NEAR(values_of(place / "out/area_dinf.tif")[11], 1100.0, 1e-6);
    EXPECT_EQ(json["d8"]["greatest_m2"], 1100.0);
}

TEST(Measure, CatchmentsOfAnyonesRivers) {
    Workplace const place;
    write_plane(place);
    ASSERT_EQ(std::system(
                  ("cd " + place.path().string() + " && gdal_translate -q -a_srs EPSG:32631 dem.asc dem.tif").c_str()),
              0);
    Outcome const o = expect_run(place,
                                 "measure dem.tif rivers.geojson --field arc_id=line --field ds_arc=next --what "
                                 "catchments -o out --json",
                                 0);
    auto const json = nlohmann::json::parse(o.out)["catchments"];
    EXPECT_EQ(json["count"], 2);
    EXPECT_EQ(json["arcs_cut"], 1);
    EXPECT_EQ(json["basins"], 1);
    EXPECT_EQ(json["cells_without"], 0);
    auto const file = open(place / "out/catchments.gpkg");
    std::map<int, std::vector<double>> rows;
    for (auto const& feature : *file->GetLayerByName("catchments")) {
        rows[feature->GetFieldAsInteger("arc_id")] = {
            feature->GetFieldAsDouble("ds_arc"), feature->GetFieldAsDouble("area"),
            feature->GetFieldAsDouble("ds_area"), feature->GetGeometryRef()->toMultiPolygon()->get_Area()};
    }
    EXPECT_EQ(rows[7], (std::vector<double>{9, 300, 300, 300}));
    EXPECT_EQ(rows[9], (std::vector<double>{0, 800, 1100, 800}));
    // In another projection they are brought into the DEM's.
    ASSERT_EQ(
        std::system(
            ("cd " + place.path().string() + " && ogr2ogr -t_srs EPSG:3857 mercator.gpkg rivers.geojson").c_str()),
        0);
    Outcome const far = expect_run(place,
                                   "measure dem.tif mercator.gpkg --field arc_id=line --field ds_arc=next --what "
                                   "catchments -o far --json",
                                   0);
    EXPECT_EQ(nlohmann::json::parse(far.out)["catchments"], json);
    EXPECT_TRUE(test::has(nlohmann::json::parse(far.out)["notes"].dump(), "were reprojected from"));
}

TEST(Measure, CatchmentsOfAFolderAreThoseThatMakeLeft) {
    Workplace const place;
    expect_run(place,
               "make -q --set grid.width=64 --set grid.height=64 --set "
               "network.dla.particles=400 --set network.prune=4 --set output.accumulation=true "
               "-o land",
               0);
    Outcome const o = expect_run(place, "measure land -o out", 0);
    EXPECT_EQ(o.out, "out/area_d8.tif\nout/area_dinf.tif\nout/catchments.gpkg\n");
    for (std::string const name : {"area_d8.tif", "area_dinf.tif", "catchments.gpkg"}) {
        EXPECT_TRUE(file_bytes(place / ("land/" + name)) == file_bytes(place / ("out/" + name))) << name;
    }
    std::map<int, double> ds_area;
    auto const network = open(place / "land/network.gpkg");
    for (auto const& arc : *network->GetLayerByName("arcs")) {
        ds_area[arc->GetFieldAsInteger("arc_id")] = arc->GetFieldAsDouble("ds_area");
    }
    auto const file = open(place / "out/catchments.gpkg");
    for (auto const& feature : *file->GetLayerByName("catchments")) {
        EXPECT_EQ(feature->GetFieldAsDouble("ds_area"), ds_area.at(feature->GetFieldAsInteger("arc_id")));
    }
    Outcome const without =
        thalweg_run("make -q --set grid.width=64 --set grid.height=64 --set network.dla.particles=400 --set "
                    "network.prune=5 --set output.catchments=false -o plain",
                    place.path());
    ASSERT_EQ(without.code, 0) << without.err;
    EXPECT_FALSE(fs::exists(place / "plain/catchments.gpkg"));
    EXPECT_FALSE(fs::exists(place / "plain/area_d8.tif"));
}

TEST(Measure, RefusesWhatItCannotMeasure) {
    Workplace const place;
    write_plane(place);
    refused(place, "dem.asc -o out --what d9", "Did you mean 'd8'?");
    refused(place, "dem.asc -o out --what catchments", "name a network");
    refused(place, "none.tif -o out", "none.tif");
    refused(place, "dem.asc rivers.geojson -o out", "schema");
    refused(place, "dem.asc rivers.geojson -o out --field arc_id", "QUANTITY=NAME");
    refused(place, "dem.asc rivers.geojson --field arc_id=line --field ds_arc=next -o out", "CRS");
    ASSERT_EQ(thalweg_run("measure dem.asc -o out --what d8", place.path()).code, 0);
    place.write("out/mine.txt", "mine");
    refused(place, "dem.asc -o out --what d8", "--overwrite");
    ASSERT_EQ(thalweg_run("measure dem.asc -o out --what d8,dinf --overwrite", place.path()).code, 0);
    EXPECT_TRUE(fs::exists(place / "out/mine.txt"));
}

} // namespace measure_test
