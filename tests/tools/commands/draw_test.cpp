// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <sys/resource.h>
#include <vector>

#include <cpl_minixml.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <ogr_spatialref.h>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"

namespace draw_test {

namespace fs = std::filesystem;

namespace {

std::string const small = "make --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 "
                          "--set network.prune=4 --set surface.method=dilate -q -o made";

struct Heights {
    int width = 40;
    int height = 30;
    int epsg = 32631;
    double cell = 30.0;
    double west = 500000.0;
    double north = 5000000.0;
};

/// A raster of heights in a place; nan is no-data.
template <class Z> void make_dem(Workplace const& place, std::string const& name, Heights const& frame, Z const& z) {
    GDALAllRegister();
    GDALDatasetUniquePtr const data(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        (place / name).string().c_str(), frame.width, frame.height, 1, GDT_Float32, nullptr));
    double place_of[6] = {frame.west, frame.cell, 0.0, frame.north, 0.0, -frame.cell};
    data->SetGeoTransform(place_of);
    if (frame.epsg > 0) {
        OGRSpatialReference reference;
        reference.importFromEPSG(frame.epsg);
        data->SetSpatialRef(&reference);
    }
    data->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
    std::vector<float> row(static_cast<std::size_t>(frame.width));
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            row[static_cast<std::size_t>(x)] = static_cast<float>(z(x, y));
        }
        ASSERT_EQ(data->GetRasterBand(1)->RasterIO(GF_Write, 0, y, frame.width, 1, row.data(), frame.width, 1,
                                                   GDT_Float32, 0, 0, nullptr),
                  CE_None);
    }
}

double hill(int x, int y) {
    return 300.0 - 0.4 * ((x - 20.0) * (x - 20.0) + (y - 15.0) * (y - 15.0));
}

/// The names in a folder, sorted.
std::string names_in(fs::path const& folder) {
    std::set<std::string> names;
    for (auto const& entry : fs::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    std::string text;
    for (std::string const& name : names) {
        text += (text.empty() ? "" : " ") + name;
    }
    return text;
}

/// A picture is what its ending says.
void expect_well_formed(fs::path const& path) {
    std::string const bytes = file_bytes(path);
    std::string const ending = path.extension().string();
    if (ending == ".png") {
        GDALAllRegister();
        EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n") << path;
        GDALDatasetUniquePtr const data(GDALDataset::Open(path.string().c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
        ASSERT_TRUE(data) << path;
        EXPECT_GT(GDALChecksumImage(data->GetRasterBand(1), 0, 0, data->GetRasterXSize(), data->GetRasterYSize()), 0);
    } else if (ending == ".svg") {
        CPLXMLNode* const tree = CPLParseXMLString(bytes.c_str());
        EXPECT_NE(tree, nullptr) << path;
        CPLDestroyXMLNode(tree);
        EXPECT_LT(bytes.size(), 2000000U) << path;
        std::string const parse =
            "/usr/bin/python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' '" + path.string() + "'";
        EXPECT_EQ(std::system(parse.c_str()), 0) << path;
    } else {
        EXPECT_EQ(bytes.substr(0, 5), "%PDF-") << path;
        EXPECT_NE(bytes.find("%%EOF", bytes.size() - 16), std::string::npos) << path;
    }
}

} // namespace

TEST(Draw, AFolderThatMakeLeftInEveryFormat) {
    Workplace const place;
    ASSERT_EQ(thalweg_run(small, place.path()).code, 0);
    Outcome const o = expect_run(place, "draw made -o out --format png,svg,pdf --title '谷 & <valley>'", 0);
    std::string lines;
    for (std::string const what : {"map", "profile", "curve", "hypsometry", "sections", "wireframe"}) {
        for (std::string const ending : {"png", "svg", "pdf"}) {
            expect_well_formed(place / ("out/" + what + "." + ending));
            lines += "out/" + what + "." + ending + "\n";
        }
    }
    EXPECT_EQ(o.out, lines) << "stdout names the files and nothing else";
    EXPECT_EQ(std::distance(fs::directory_iterator(place / "out"), {}), 18);
}

TEST(Draw, EachPictureByItself) {
    Workplace const place;
    ASSERT_EQ(thalweg_run(small, place.path()).code, 0);
    for (std::string const what : {"map", "profile", "curve", "hypsometry", "sections", "wireframe"}) {
        Outcome const o = expect_run(place, "draw made -q -o one/" + what + "_x.svg --what " + what, 0);
        EXPECT_EQ(o.out, "one/" + what + "_x.svg\n");
        EXPECT_EQ(o.err, "");
        expect_well_formed(place / ("one/" + what + "_x.svg"));
    }
    // The same as make drew it.
    ASSERT_EQ(
        thalweg_run("draw made -o again --what curve,profile,wireframe,sections,map --format svg,png", place.path())
            .code,
        0);
    for (std::string const name : {"curve.svg", "profile.svg", "wireframe.svg", "sections.svg", "map.png"}) {
        EXPECT_TRUE(file_bytes(place / ("again/" + name)) == file_bytes(place / ("made/" + name))) << name;
    }
}

TEST(Draw, OfARasterWhatNeedsNoRivers) {
    Workplace const place;
    make_dem(place, "hill.tif", {}, hill);
    Outcome const o = expect_run(place, "draw hill.tif -o out --json", 0);
    auto const said = nlohmann::json::parse(o.out);
    EXPECT_EQ(said["files"].size(), 4U);
    EXPECT_EQ(names_in(place / "out"), "hypsometry.png map.png sections.png wireframe.png");
    EXPECT_TRUE(said["notes"].empty());
    ASSERT_EQ(thalweg_run("draw hill.tif -o wide.png --width 333", place.path()).code, 0);
    GDALDatasetUniquePtr const data(GDALDataset::Open((place / "wide.png").string().c_str(), GDAL_OF_RASTER));
    ASSERT_TRUE(data);
    EXPECT_EQ(data->GetRasterXSize(), 333);
}

TEST(Draw, RiversFromAnyLineFile) {
    Workplace const place;
    make_dem(place, "hill.tif", {}, hill);
    place.write(
        "rivers.geojson",
        R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32631"}},)"
        R"("features":[{"type":"Feature","id":1,"properties":{},"geometry":{"type":"LineString",)"
        R"("coordinates":[[500600,4999500],[500600,4990000]]}}]})");
    Outcome const o = expect_run(place, "draw hill.tif --network rivers.geojson -o out", 0);
    EXPECT_EQ(names_in(place / "out"), "hypsometry.png map.png profile.png sections.png wireframe.png");
    make_dem(place, "far.tif", {40, 30, 32631, 30.0, 600000.0, 5000000.0}, hill);
    Outcome const far = expect_run(place, "draw far.tif --network rivers.geojson -o far", 0,
                                   "no river of rivers.geojson runs on the DEM");
    EXPECT_FALSE(fs::exists(place / "far/profile.png"));
    expect_refused(place, "draw far.tif --network rivers.geojson --what profile -o p", "no profile can be drawn");
}

TEST(Draw, AReportPageOfAnyRaster) {
    Workplace const place;
    make_dem(place, "it's.tif", {}, hill);
    Outcome const o = expect_run(place, "draw \"it's.tif\" -o hill.html --json", 0);
    EXPECT_EQ(nlohmann::json::parse(o.out)["files"][0], "hill.html");
    std::string const page = file_bytes(place / "hill.html");
    EXPECT_TRUE(test::has(page, R"("command":"thalweg draw 'it'\\''s.tif' -o hill.html --what page")"));
    EXPECT_FALSE(test::has(page, "@@"));

    ASSERT_EQ(thalweg_run(small, place.path()).code, 0);
    ASSERT_EQ(thalweg_run("draw made -o made --what page,map", place.path()).code, 2); // map.png is there
    ASSERT_EQ(thalweg_run("draw made -o made --what page", place.path()).code, 0);
    EXPECT_TRUE(test::has(file_bytes(place / "made/page.html"), "\"strahler\":["));
    expect_refused(place, "draw made -o made --what page", "already exists");
    expect_refused(place, "draw made -o x.html --what map", "name of a page");
    expect_refused(place, "draw made -o x.png --what page", "name of one picture");
    expect_refused(place, "draw made -o x --what pag", "Did you mean 'page'?");
    place.write("r.toml", "[network]\nprune = 6\n[network.dla]\nparticles = 3000\n");
    ASSERT_EQ(thalweg_run("make r.toml -o bare -q", place.path()).code, 0);
    expect_refused(place, "draw bare -o x.html", "no DEM");
}

TEST(Draw, LandThatIsHardlyLand) {
    Workplace const place;
    make_dem(place, "holes.tif", {}, [](int x, int y) { return (x + y) % 7 == 0 || x > 30 ? NAN : hill(x, y); });
    make_dem(place, "cell.tif", {1, 1}, [](int, int) { return 12.0; });
    make_dem(place, "row.tif", {50, 1}, [](int x, int) { return 3.0 * x; });
    make_dem(place, "level.tif", {}, [](int, int) { return 8848.0; });
    for (std::string const name : {"holes", "cell", "row", "level"}) {
        expect_run(place, "draw " + name + ".tif -o " + name + " --format svg,png", 0);
        for (std::string const what : {"map", "hypsometry", "sections", "wireframe"}) {
            expect_well_formed(place / (name + "/" + what + ".svg"));
            expect_well_formed(place / (name + "/" + what + ".png"));
        }
    }
    make_dem(place, "nothing.tif", {}, [](int, int) { return NAN; });
    expect_refused(place, "draw nothing.tif -o nothing", "holds no heights");
}

TEST(Draw, GeographicRastersAreWarpedAndItIsSaid) {
    Workplace const place;
    make_dem(place, "globe.tif", {40, 30, 4326, 0.001, 3.0, 45.0}, hill);
    Outcome const o = expect_run(place, "draw globe.tif -o out", 0, "UTM zone 31N");
    make_dem(place, "plain.tif", {40, 30, 0}, hill);
    expect_run(place, "draw plain.tif -o plain", 0, "drawn as metres");
}

TEST(Draw, LargeRastersAreDecimatedWithinMemory) {
    Workplace const place;
    make_dem(place, "hill.tif", {}, hill);
    place.write("large.vrt",
                "<VRTDataset rasterXSize='20000' rasterYSize='20000'><SRS>EPSG:32631</SRS>"
                "<GeoTransform>500000, 2, 0, 5000000, 0, -2</GeoTransform><VRTRasterBand dataType='Float32' band='1'>"
                "<SimpleSource><SourceFilename relativeToVRT='1'>hill.tif</SourceFilename><SourceBand>1</SourceBand>"
                "<SrcRect xOff='0' yOff='0' xSize='40' ySize='30'/><DstRect xOff='0' yOff='0' xSize='20000' "
                "ySize='20000'/></SimpleSource></VRTRasterBand></VRTDataset>");
    expect_run(place, "draw large.vrt --what map -o out", 0, "means of 5x5 cells");
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    EXPECT_LT(used.ru_maxrss, 2L << 20) << "kilobytes";
}

TEST(Draw, RefusesInWords) {
    Workplace const place;
    make_dem(place, "hill.tif", {}, hill);
    fs::create_directory(place / "empty");
    place.write("text.tif", "no raster");
    expect_refused(place, "draw hill.tif", "--output");
    expect_refused(place, "draw nowhere.tif -o out", "does not exist");
    expect_refused(place, "draw text.tif -o out", "text.tif");
    expect_refused(place, "draw empty -o out", "holds neither dem.tif nor network.gpkg");
    expect_refused(place, "draw hill.tif -o out --what wirefram", "Did you mean 'wireframe'?");
    expect_refused(place, "draw hill.tif -o out --format pngg", "Did you mean 'png'?");
    expect_refused(place, "draw hill.tif -o out --what curve", "no curve can be drawn");
    expect_refused(place, "draw hill.tif -o out --what profile", "no profile can be drawn");
    expect_refused(place, "draw hill.tif -o map.png --what map,sections", "name of one picture");
    expect_refused(place, "draw hill.tif -o map.png --format svg", "name of one picture");
    expect_refused(place, "draw hill.tif -o out --width 20", "--width");
    expect_refused(place, "draw hill.tif -o out --elevation 90", "--elevation");
    expect_refused(place, "draw hill.tif -o out --network nowhere.gpkg", "nowhere.gpkg");
    expect_refused(place, "draw hill.tif -o hill.tif", "hill.tif");
    expect_refused(place, "draw hill.tif -o out --titel x", "Did you mean '--title'?");
}

TEST(Draw, NothingIsOverwrittenUnasked) {
    Workplace const place;
    make_dem(place, "hill.tif", {}, hill);
    fs::create_directory(place / "out");
    place.write("out/map.png", "mine");
    place.write("out/letter.txt", "mine");
    expect_refused(place, "draw hill.tif -o out", "already exists");
    expect_refused(place, "draw hill.tif -o out/map.png", "already exists");
    EXPECT_EQ(names_in(place / "out"), "letter.txt map.png");
    Outcome const o = expect_run(place, "draw hill.tif -o out --what map,wireframe --overwrite", 0);
    expect_well_formed(place / "out/map.png");
    EXPECT_EQ(file_bytes(place / "out/letter.txt"), "mine");
    EXPECT_EQ(names_in(place / "out"), "letter.txt map.png wireframe.png");
    ASSERT_EQ(thalweg_run("draw hill.tif -o out --what sections", place.path()).code, 0)
        << "a folder may hold other things";
    fs::create_directory(place / "out/hypsometry.png");
    expect_refused(place, "draw hill.tif -o out --what hypsometry --overwrite", "hypsometry.png");
}

TEST(Draw, AFolderWithoutASurfaceHasItsProfile) {
    Workplace const place;
    place.write("r.toml", "[network]\nprune = 4\n[network.dla]\nparticles = 400\n");
    ASSERT_EQ(thalweg_run("make r.toml -q -o made", place.path()).code, 0);
    Outcome const o = expect_run(place, "draw made -o out", 0);
    EXPECT_EQ(names_in(place / "out"), "profile.png");
    expect_refused(place, "draw made -o map.png", "there is no DEM");
}

} // namespace draw_test
