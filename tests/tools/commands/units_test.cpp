// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rivers in feet or degrees, and terrain in feet.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace units_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr double foot = 0.3048;
std::string const walker = samples + "walker_nhdplus.gpkg";

json made(Workplace const& place, std::string const& arguments, std::string const& folder) {
    expect_run(place, "make " + arguments + " -o " + folder, 0);
    json const report = report_of(place / folder);
    expect_checks_hold(report, arguments);
    return report;
}

bool tells(json const& report, std::string const& words) {
    return std::ranges::any_of(report["repairs"], [&](json const& repair) {
        return bool(test::has(repair["text"].get<std::string>(), words));
    });
}

struct Dem {
    std::string unit;
    std::vector<float> z;
};

Dem dem_in(fs::path const& file) {
    auto const data = opened(file);
    GDALRasterBand* const band = data->GetRasterBand(1);
    Dem dem{band->GetUnitType(), std::vector<float>(static_cast<std::size_t>(data->GetRasterXSize()) *
                                                    static_cast<std::size_t>(data->GetRasterYSize()))};
    EXPECT_EQ(band->RasterIO(GF_Read, 0, 0, data->GetRasterXSize(), data->GetRasterYSize(), dem.z.data(),
                             data->GetRasterXSize(), data->GetRasterYSize(), GDT_Float32, 0, 0, nullptr),
              CE_None);
    return dem;
}

/// A column of numbers of a layer, and the Z of its vertices.
std::vector<double> column(fs::path const& file, char const* layer, char const* name) {
    auto const data = opened(file);
    std::vector<double> out;
    for (auto const& feature : *data->GetLayerByName(layer)) {
        if (std::string(name) != "Z") {
            out.push_back(feature->GetFieldAsDouble(name));
            continue;
        }
        OGRGeometry const* const shape = feature->GetGeometryRef();
        if (wkbFlatten(shape->getGeometryType()) == wkbPoint) {
            out.push_back(shape->toPoint()->getZ());
            continue;
        }
        for (OGRPoint const& p : *shape->toLineString()) {
            out.push_back(p.getZ());
        }
    }
    return out;
}

void expect_ratio(std::vector<double> const& metres, std::vector<double> const& feet, double unit,
                  std::string const& what) {
    ASSERT_EQ(metres.size(), feet.size()) << what;
    ASSERT_FALSE(metres.empty()) << what;
    for (std::size_t i = 0; i < metres.size(); ++i) {
        ASSERT_NEAR(feet[i] * unit, metres[i], 1e-6) << what << i;
    }
}

std::string text_in_run(fs::path const& file, std::string const& name) {
    auto const data = opened(file);
    for (auto const& row : *data->GetLayerByName("run")) {
        if (name == row->GetFieldAsString("name")) {
            return row->GetFieldAsString("value");
        }
    }
    return "";
}

} // namespace

TEST(Units, TerrainInFeetIsTheTerrainInMetres) {
    Workplace const place;
    std::string const rivers = walker + " --set grid.cell=60";
    json const metres = made(place, rivers, "m");
    json const feet = made(place, rivers + " --units ft", "ft");
    EXPECT_EQ(feet["recipe"]["output"]["units"], "ft");
    EXPECT_EQ(metres["dem"]["max"]["z"], feet["dem"]["max"]["z"]); // of the report always metres
    EXPECT_EQ(metres["network"]["length_m"], feet["network"]["length_m"]);

    Dem const m = dem_in(place / "m/dem.tif");
    Dem const ft = dem_in(place / "ft/dem.tif");
    EXPECT_EQ(m.unit, "m");
    EXPECT_EQ(ft.unit, "ft");
    ASSERT_EQ(m.z.size(), ft.z.size());
    for (std::size_t i = 0; i < m.z.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(ft.z[i]) * foot, static_cast<double>(m.z[i]), 1e-3) << i;
    }
    for (char const* file : {"network.gpkg", "network_arcs.shp"}) {
        std::string const arcs = file == std::string("network.gpkg") ? "arcs" : "network_arcs";
        for (char const* name : {"z_up", "z_down", "Z"}) {
            expect_ratio(column(place / "m" / file, arcs.c_str(), name),
                         column(place / "ft" / file, arcs.c_str(), name), foot, file);
        }
        for (char const* name : {"length", "length_3d", "straight", "dist_out", "slope", "us_area", "ds_area"}) {
            EXPECT_EQ(column(place / "m" / file, arcs.c_str(), name), column(place / "ft" / file, arcs.c_str(), name))
                << name;
        }
    }
    for (char const* name : {"z", "Z"}) {
        expect_ratio(column(place / "m/network.gpkg", "nodes", name), column(place / "ft/network.gpkg", "nodes", name),
                     foot, name);
    }
    EXPECT_EQ(text_in_run(place / "m/network.gpkg", "height_unit"), "m");
    EXPECT_EQ(text_in_run(place / "ft/network.gpkg", "height_unit"), "ft");
    for (double const z : column(place / "ft/contours.gpkg", "contours", "z")) {
        ASSERT_EQ(z, std::round(z / 10.0) * 10.0) << "round numbers of feet";
    }
    expect_run(place, "replay ft --verify", 0);
}

/// A river along a parallel, with a tributary, in degrees.
std::string along_parallel(double west, double east) {
    json file{{"type", "FeatureCollection"}, {"features", json::array()}};
    auto const add = [&](json const& coordinates) {
        file["features"].push_back({{"type", "Feature"},
                                    {"properties", json::object()},
                                    {"geometry", {{"type", "LineString"}, {"coordinates", coordinates}}}});
    };
    double const middle = 0.5 * (west + east);
    add({{west, 46.0}, {0.5 * (west + middle), 46.4}, {middle, 46.1}});
    add({{middle, 46.1}, {0.5 * (middle + east), 46.5}, {east, 46.0}});
    add({{middle - 1.0, 49.0}, {middle, 46.1}});
    return file.dump();
}

TEST(Units, WideExtentsAreWarnedOfOrGetAnotherProjection) {
    Workplace const place;
    place.write("narrow.geojson", along_parallel(6.0, 12.0));
    place.write("wide.geojson", along_parallel(0.0, 20.0));
    place.write("wider.geojson", along_parallel(-10.0, 40.0));
    for (std::string const name : {"narrow", "wide", "wider"}) {
        std::string const zone = name == "wide" ? " --crs EPSG:32632" : ""; // as users may ask for
        json const report = made(place, name + ".geojson --set grid.cell=10000" + zone, name);
        EXPECT_EQ(tells(report, "too long there"), name == "wide");
        EXPECT_EQ(test::has(report["recipe"]["grid"]["crs"].get<std::string>(), "Equal area"), name == "wider");
        expect_run(place, "check " + name + " --dem " + name + "/dem.tif", 0);
        expect_run(place, "replay " + name + " --verify", 0);
    }
    // The folder's own rivers make the same terrain, and other formats hold the projection.
    expect_run(place, "make wider -o again --set grid.cell=10000", 0);
    expect_run(place, "convert wider -o wider.shp --schema hydrorivers", 0);
    expect_run(place, "check wider.shp", 0);
}

TEST(Units, WhatIsInFeetIsReadAsSuch) {
    Workplace const place;
    std::string const rivers = walker + " --set grid.cell=60 -q";
    made(place, rivers, "m");
    made(place, rivers + " --units ft", "ft");
    for (std::string const network : {"ft", "ft/network_arcs.shp"}) {
        json const found = expect_run(place, "check " + network + " --dem ft/dem.tif --json", 0).json();
        json const other = expect_run(place, "check m --dem m/dem.tif --json", 0).json();
        EXPECT_EQ(found["certificate"]["traced"][1], other["certificate"]["traced"][1]) << network;
        EXPECT_GE(found["certificate"]["traced"][0]["f"], 0.98) << network; // of a folder with its network.tif
        EXPECT_EQ(found["certificate"]["depressions"]["count"], 0) << network;
    }
    auto const stats = [&](std::string const& folder) {
        return expect_run(place, "stats " + folder + "/dem.tif --json", 0).json();
    };
    EXPECT_NEAR(stats("ft")["max"]["z"].get<double>(), stats("m")["max"]["z"].get<double>(), 1e-3);
    EXPECT_NEAR(stats("ft")["slope_rad"].get<double>(), stats("m")["slope_rad"].get<double>(), 1e-5);

    expect_run(place, "convert ft -o back.gpkg", 0);
    expect_ratio(column(place / "m/network.gpkg", "arcs", "Z"), column(place / "back.gpkg", "arcs", "Z"), 1.0, "back");
    expect_run(place, "draw ft -o ft.svg --what profile", 0);
    expect_run(place, "draw m -o m.svg --what profile", 0);

    // The rivers of a folder in feet keep their heights, but for what is lowered where they would stand on walls.
    json const again = made(place, "ft --set grid.cell=60", "again");
    EXPECT_TRUE(tells(again, "network.gpkg: heights in feet are converted into metres"));
    auto const highest = [&](std::string const& folder) {
        auto const z = column(place / folder / "network.gpkg", "arcs", "z_up");
        return *std::max_element(z.begin(), z.end());
    };
    EXPECT_NEAR(highest("again"), highest("m"), 0.05 * highest("m"));
}

TEST(Units, RiversInSurveyFeetWithHeightsInSurveyFeet) {
    Workplace const place;
    // A main stem and a tributary near Oakland.
    place.write("m.geojson",
                test::geojson(test::line("[560000,4180000,300],[562000,4181000,200],[565000,4180500,100]") + "," +
                              test::line("[561500,4184000,400],[562000,4181000,200]")));
    place.shell("ogr2ogr -a_srs EPSG:32610 utm.gpkg m.geojson && ogr2ogr -t_srs EPSG:2227 plan.gpkg utm.gpkg && "
                "ogr2ogr -a_srs EPSG:2227+6360 ft.gpkg plan.gpkg"); // GDAL leaves Z alone
    json const report = made(place, "ft.gpkg --set grid.cell=20", "out");
    EXPECT_EQ(report["recipe"]["grid"]["crs"], "EPSG:32610");
    EXPECT_EQ(report["recipe"]["network"]["heights"], "file");
    EXPECT_TRUE(tells(report, "reprojected into EPSG:32610")) << report["repairs"];
    auto const z = column(place / "out/network.gpkg", "arcs", "z_up");
    EXPECT_NEAR(*std::max_element(z.begin(), z.end()), 400.0 * 1200.0 / 3937.0, 1.0);

    // Without a vertical CRS nothing says what its heights are in: they are taken for metres, and that is reported.
    json const plan = made(place, "plan.gpkg --set grid.cell=20", "plan");
    EXPECT_TRUE(tells(plan, "treated as metres")) << plan["repairs"];
}

TEST(Units, ADemInFeetIsReadInMetres) {
    Workplace const place;
    place.shell("gdal_translate " + samples +
                "bigtujunga_srtm1_utm11.tif piece.tif && gdal_edit.py -units ft piece.tif");
    Dem const piece = dem_in(place / "piece.tif");
    EXPECT_EQ(piece.unit, "ft");
    json const stats = expect_run(place, "stats piece.tif --json", 0).json();
    EXPECT_NEAR(stats["max"]["z"].get<double>(), foot * static_cast<double>(std::ranges::max(piece.z)), 0.1);
}

TEST(Units, MetresOfWebMercatorAreNone) {
    Workplace const place;
    place.shell("ogr2ogr -t_srs EPSG:3857 w.gpkg " + walker);
    expect_run(place, "make w.gpkg --set grid.cell=90 -o out", 0);
    double const length = made(place, walker + " --set grid.cell=90", "own")["network"]["length_m"];
    EXPECT_NEAR(report_of(place / "out")["network"]["length_m"].get<double>(), length, 0.03 * length);
    // A CRS that is named stays, with a warning, and the folder is read as it was made.
    expect_run(place, "make w.gpkg --crs EPSG:3857 --set grid.cell=115 -o named", 0, "warning: ");
    expect_run(place, "check named --dem named/dem.tif", 0);
    expect_run(place, "replay named --verify", 0);
    expect_run(place, "draw named -o pictures", 0);

    // A DEM is warped where the cells are not returned, else refused.
    place.shell("gdalwarp -t_srs EPSG:3857 -dstnodata -9999 out/dem.tif w.tif");
    double const slope = expect_run(place, "stats out/dem.tif --json", 0).json()["slope_true_deg"];
    EXPECT_NEAR(expect_run(place, "stats w.tif --json", 0).json()["slope_true_deg"].get<double>(), slope, 0.15 * slope);
    EXPECT_FALSE(test::has(expect_run(place, "stats w.tif --recipe", 0).out, "3857"));
    EXPECT_EQ(expect_run(place, "measure w.tif -o m --json", 0).json()["findings"][0]["kind"], "dem_reprojected");
    // PastedDem it is warped to the target, which tells where it lies; laid elsewhere its size would be unknown.
    expect_run(place, "blend out/dem.tif w.tif -o b.tif --window 20,20,30,30", 0);
    expect_refused(place, "",
                   {"points w.tif -o p.xyz", "tin w.tif -o t.obj", "check out --dem w.tif",
                    "blend w.tif " + samples + "bigtujunga_srtm1_utm11.tif -o c.tif"});
}

TEST(Units, ACrsWithoutACodeIsKeptWithoutAWord) {
    Workplace const place;
    // Albers as R writes it: no code, and a transformation to WGS 84 beside it.
    place.shell("ogr2ogr -t_srs '+proj=aea +lat_0=37 +lon_0=-122 +lat_1=34 +lat_2=41 +ellps=GRS80 +towgs84=0,0,0 "
                "+units=m' albers.gpkg " +
                walker);
    json const report = made(place, "albers.gpkg --set grid.cell=80", "out");
    EXPECT_FALSE(tells(report, "reprojected"));
    EXPECT_TRUE(test::has(report["recipe"]["grid"]["crs"].get<std::string>(), "Albers"));
    json const utm = made(place, "albers.gpkg --set grid.cell=80 --crs EPSG:32610", "utm");
    EXPECT_TRUE(tells(utm, "are reprojected into EPSG:32610"));
}

} // namespace units_test
