// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace measure_test {

namespace fs = std::filesystem;

namespace {

std::vector<double> values_of(fs::path const& path) {
    auto const dataset = opened(path);
    int const width = dataset->GetRasterXSize();
    int const height = dataset->GetRasterYSize();
    std::vector<double> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width, height,
                                                  GDT_Float64, 0, 0, nullptr),
              CE_None);
    return values;
}

/// A plane that falls by 2 to the east and 1 to the south, with a hole in its corner; and its river along the bottom.
void write_plane(Workplace const& place) {
    place.write("dem.asc", "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\nNODATA_value -9999\n"
                           "-9999 28 26 24\n29 27 25 23\n28 26 24 22\n");
    place.write("rivers.geojson",
                test::geojson(test::line("[500005,4000005],[500025,4000005]", R"("line":7,"next":9)") + "," +
                              test::line("[500025,4000005],[500060,4000005]", R"("line":9,"next":0)")));
}

} // namespace

TEST(Measure, AreasAndDirectionsOfADem) {
    Workplace const place;
    write_plane(place);
    auto const json = expect_run(place, "measure dem.asc --what d8,dinf,directions -o out --json", 0).json();
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
    place.shell("gdal_translate -a_srs EPSG:32631 dem.asc dem.tif && ogr2ogr -t_srs EPSG:3857 far.gpkg rivers.geojson");
    std::string const rest = " --field arc_id=line --field ds_arc=next --what catchments --json -o ";
    auto const json = expect_run(place, "measure dem.tif rivers.geojson" + rest + "out", 0).json()["catchments"];
    EXPECT_EQ(json["count"], 2);
    EXPECT_EQ(json["arcs_cut"], 1);
    EXPECT_EQ(json["basins"], 1);
    EXPECT_EQ(json["cells_without"], 0);
    auto const file = opened(place / "out/catchments.gpkg");
    std::map<int, std::vector<double>> rows;
    for (auto const& feature : *file->GetLayerByName("catchments")) {
        rows[feature->GetFieldAsInteger("arc_id")] = {
            feature->GetFieldAsDouble("ds_arc"), feature->GetFieldAsDouble("area"),
            feature->GetFieldAsDouble("ds_area"), feature->GetGeometryRef()->toMultiPolygon()->get_Area()};
    }
    EXPECT_EQ(rows[7], (std::vector<double>{9, 300, 300, 300}));
    EXPECT_EQ(rows[9], (std::vector<double>{0, 800, 1100, 800}));
    // In another projection they are reprojected to the DEM's.
    EXPECT_EQ(expect_run(place, "measure dem.tif far.gpkg" + rest + "far", 0).json()["catchments"], json);
}

TEST(Measure, CatchmentsOfAFolderAreThoseThatMakeLeft) {
    Workplace const place;
    expect_run(place, small + "land --set output.accumulation=true", 0);
    Outcome const o = expect_run(place, "measure land -o out", 0);
    EXPECT_EQ(o.out, "out/area_d8.tif\nout/area_dinf.tif\nout/catchments.gpkg\n");
    for (std::string const name : {"area_d8.tif", "area_dinf.tif", "area_d8.qml", "area_dinf.qml"}) {
        EXPECT_TRUE(file_bytes(place / ("land/" + name)) == file_bytes(place / ("out/" + name))) << name;
    }
    std::map<int, double> ds_area;
    auto const network = opened(place / "land/network.gpkg");
    for (auto const& arc : *network->GetLayerByName("arcs")) {
        ds_area[arc->GetFieldAsInteger("arc_id")] = arc->GetFieldAsDouble("ds_area");
    }
    auto const made = opened(place / "land/catchments.gpkg");
    auto const file = opened(place / "out/catchments.gpkg"); // with more columns
    for (char const* name : {"catchments", "basins"}) {
        OGRLayer& layer = *file->GetLayerByName(name);
        OGRLayer& ours = *made->GetLayerByName(name);
        ASSERT_EQ(layer.GetFeatureCount(), ours.GetFeatureCount());
        for (auto const& feature : ours) {
            OGRFeatureUniquePtr const same(layer.GetFeature(feature->GetFID()));
            EXPECT_TRUE(same->GetGeometryRef()->Equals(feature->GetGeometryRef()));
            for (int i = 0; i < feature->GetFieldCount(); ++i) {
                EXPECT_STREQ(same->GetFieldAsString(same->GetFieldIndex(feature->GetFieldDefnRef(i)->GetNameRef())),
                             feature->GetFieldAsString(i));
            }
        }
    }
    for (auto const& feature : *file->GetLayerByName("catchments")) {
        EXPECT_EQ(feature->GetFieldAsDouble("ds_area"), ds_area.at(feature->GetFieldAsInteger("arc_id")));
    }
    expect_run(place, small + "plain --set output.catchments=false", 0);
    EXPECT_FALSE(fs::exists(place / "plain/catchments.gpkg"));
    EXPECT_FALSE(fs::exists(place / "plain/area_d8.tif"));
}

TEST(Measure, EveryMeasureOfADem) {
    Workplace const place;
    write_plane(place);
    auto const json = expect_run(place, "measure dem.asc --what all --support 3 --theta 0.5 -o out --json", 0).json();
    EXPECT_EQ(json["files"].size(), 14U); // all but catchments, which need rivers
    double const none = -9999.0;
    double const side = std::sqrt(200.0);
    auto const near = [&](std::string const& name, std::vector<double> const& wanted) {
        std::vector<double> const values = values_of(place / ("out/" + name));
        ASSERT_EQ(values.size(), wanted.size()) << name;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_NEAR(values[i], wanted[i], 1e-5) << name << " " << i;
        }
    };
    // Rivers: the cells of 3, 3, 5 and 11 cells, which are 7, 9, 10 and 11.
    near("length_up.tif", {none, 0, 0, 0, 0, 0, side, side, 0, side, side + 10, side + 20});
    near("length_down.tif", {none, 2 * side, side + 10, 20, side + 20, side + 10, side, 10, 30, 20, 10, 0});
    near("hand.tif", {none, 6, 3, 1, 3, 3, 3, 0, 2, 0, 0, 0});
    near("strahler.tif", {255, 255, 255, 255, 255, 255, 255, 1, 255, 1, 1, 2});
    near("shreve.tif", {none, none, none, none, none, none, none, 1, none, 1, 1, 2});
    near("edge.tif", {255, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    double const step = 10.0 / std::sqrt(500.0);
    near("chi.tif", {none, none, none, none, none, none, none, 10.0 / std::sqrt(300.0), none,
                     step + 10.0 / std::sqrt(300.0), step, 0});
    EXPECT_EQ(json["edge_cells"], 11);
    EXPECT_EQ(json["streams"]["theta"], 0.5);
    EXPECT_EQ(json["streams"]["arcs"], 2);
    EXPECT_FALSE(json["streams"].contains("theta_r2"));
    auto const file = opened(place / "out/streams.gpkg");
    std::map<std::string, double> main_arc;
    for (auto const& arc : *file->GetLayerByName("arcs")) {
        if (arc->GetFieldAsDouble("length") == 20.0) {
            for (std::string const name : {"strahler", "sinuosity", "ds_area", "z_up", "z_down", "edge", "chi_up"}) {
                main_arc[name] = arc->GetFieldAsDouble(name.c_str());
            }
        }
    }
    EXPECT_EQ(main_arc["sinuosity"], 1.0);
    EXPECT_EQ(main_arc["ds_area"], 500.0);
    EXPECT_EQ(main_arc["z_up"], 26.0);
    EXPECT_EQ(main_arc["z_down"], 22.0);
    EXPECT_EQ(main_arc["edge"], 1.0);
    EXPECT_NEAR(main_arc["chi_up"], step + 10.0 / std::sqrt(300.0), 1e-9);
    EXPECT_EQ(file->GetLayerByName("knickpoints")->GetFeatureCount(), 0);
}

TEST(Measure, CatchmentsOfLinesThatNothingJoins) {
    Workplace const place;
    std::string const samples = std::string(THALWEG_SOURCE_DIR) + "/samples/";
    auto const json = expect_run(place,
                                 "measure " + samples + "jacksboro_utm16.tif " + samples +
                                     "jacksboro_rivers.fgb --what catchments,streams,hand --theta fit "
                                     "-o out --json",
                                 0)
                          .json();
    EXPECT_EQ(json["catchments"]["count"], 52);
    EXPECT_EQ(json["findings"][0]["kind"], "by_feature");
    EXPECT_GT(json["streams"]["theta_r2"], 0.5);
    auto const file = opened(place / "out/catchments.gpkg");
    for (auto const& basin : *file->GetLayerByName("basins")) {
        double const hypsometric = basin->GetFieldAsDouble("hypsometric");
        double const low = basin->GetFieldAsDouble("z_min");
        double const high = basin->GetFieldAsDouble("z_max");
        double const area = basin->GetFieldAsDouble("area");
        EXPECT_NEAR(hypsometric, (basin->GetFieldAsDouble("z_mean") - low) / (high - low), 1e-9);
        EXPECT_NEAR(basin->GetFieldAsDouble("melton"), (high - low) / std::sqrt(area), 1e-9);
        double const length = basin->GetFieldAsDouble("flow_length");
        EXPECT_NEAR(basin->GetFieldAsDouble("form_factor"), area / (length * length), 1e-9);
    }
    std::set<std::string> codes;
    for (auto const& catchment : *file->GetLayerByName("catchments")) {
        codes.insert(catchment->GetFieldAsString("pfafstetter"));
    }
    EXPECT_GT(codes.size(), 10U);
}

TEST(Measure, StreamsAreANetworkThatOthersRead) {
    Workplace const place;
    std::string const samples = std::string(THALWEG_SOURCE_DIR) + "/samples/";
    // Of the DEM; of lines over cells that warping left without data; and of lines that leave the DEM and come back.
    expect_run(place, "measure " + samples + "jacksboro_utm16.tif --what streams -o dem", 0);
    std::string const rivers = samples + "jacksboro_rivers.fgb --what streams";
    expect_run(place, "measure " + samples + "jacksboro_srtm3.tif " + rivers + " -o degrees", 0);
    place.shell("gdal_translate -q -srcwin 60 60 150 150 " + samples + "jacksboro_utm16.tif part.tif");
    expect_run(place, "measure part.tif " + rivers + " -o part", 0, "lie outside it");
    for (std::string const name : {"dem", "degrees", "part"}) {
        std::string const file = name + "/streams.gpkg";
        EXPECT_NE(thalweg_run("check " + file, place.path()).code, 2) << name;
        expect_run(place, "convert " + file + " -o " + name + ".gpkg", 0);
        auto const made = opened(place / file);
        for (auto const& arc : *made->GetLayerByName("arcs")) {
            EXPECT_TRUE(arc->IsFieldNull(arc->GetFieldIndex("sinuosity")) ||
                        arc->GetFieldAsDouble("sinuosity") >= 1.0 - 1e-9);
            OGRLineString const& line = *arc->GetGeometryRef()->toLineString();
            for (auto const& vertex : line) {
                EXPECT_TRUE(std::isfinite(vertex.getZ()));
            }
        }
    }
    auto const json = expect_run(place, "measure part.tif --what streams --support 1000000 -o none --json", 0).json();
    EXPECT_EQ(json["findings"].back()["kind"], "no_rivers");
}

TEST(Measure, ADemInDegreesIsWarpedAndSaysSo) {
    Workplace const place;
    std::string const samples = std::string(THALWEG_SOURCE_DIR) + "/samples/";
    auto const json = expect_run(place, "measure " + samples + "jacksboro_srtm3.tif --what d8 -o out --json", 0).json();
    EXPECT_EQ(json["findings"][0]["kind"], "dem_reprojected");
    auto const utm = expect_run(place, "measure " + samples + "jacksboro_utm16.tif --what d8 -o utm --json", 0).json();
    double const degrees_m2 = json["d8"]["greatest_m2"];
    double const utm_m2 = utm["d8"]["greatest_m2"];
    EXPECT_NEAR(degrees_m2 / utm_m2, 1.0, 0.01);
}

TEST(Measure, RefusesWhatItCannotMeasure) {
    Workplace const place;
    write_plane(place);
    expect_refused(place, "measure -o out",
                   {"dem.asc --what d9", "dem.asc --what chi --theta 3", "dem.asc --what chi --theta x",
                    "dem.asc --what orders --support 0", "dem.asc --what chi --knick-drop -1",
                    "dem.asc --what catchments", "none.tif", "dem.asc rivers.geojson",
                    "dem.asc rivers.geojson --field arc_id",
                    "dem.asc rivers.geojson --field arc_id=line --field ds_arc=next"}); // has no CRS
    expect_run(place, "measure dem.asc -o out --what d8", 0);
    place.write("out/mine.txt", "mine");
    expect_refused(place, "measure dem.asc -o out --what d8", {""});
    expect_run(place, "measure dem.asc -o out --what d8,dinf --overwrite", 0);
    EXPECT_TRUE(fs::exists(place / "out/mine.txt"));
}

} // namespace measure_test
