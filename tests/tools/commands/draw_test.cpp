// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <functional>
#include <string>
#include <sys/resource.h>
#include <vector>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <io/tiff.hpp>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace draw_test {

namespace fs = std::filesystem;

namespace {

double hill(int x, int y) {
    return 300.0 - 0.4 * ((x - 20.0) * (x - 20.0) + (y - 15.0) * (y - 15.0));
}

Tiff const metres{.epsg = 32631, .nodata = NAN};

void make_dem(Workplace const& place, std::string const& name, Tiff const& frame = metres,
              std::function<double(int, int)> const& z = hill) {
    written((place / name).string(), frame, z);
}

/// The names in a folder, sorted.
std::string names_in(fs::path const& folder) {
    std::string text;
    for (auto const& [name, bytes] : content(folder)) {
        text += (text.empty() ? "" : " ") + name;
    }
    return text;
}

std::string const dilated = small.substr(0, small.size() - 3) + "--set surface.method=dilate -o ";

/// A picture is what its ending says.
void expect_well_formed(fs::path const& path) {
    std::string const bytes = file_bytes(path);
    std::string const ending = path.extension().string();
    if (ending == ".png") {
        EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n") << path;
        auto const data = opened(path);
        ASSERT_TRUE(data) << path;
        EXPECT_GT(GDALChecksumImage(data->GetRasterBand(1), 0, 0, data->GetRasterXSize(), data->GetRasterYSize()), 0);
    } else if (ending == ".svg") {
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
    expect_run(place, dilated + "made", 0);
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
    expect_run(place, dilated + "made", 0);
    for (std::string const what : {"map", "profile", "curve", "hypsometry", "sections", "wireframe"}) {
        Outcome const o = expect_run(place, "draw made -q -o one/" + what + "_x.svg --what " + what, 0);
        EXPECT_EQ(o.out, "one/" + what + "_x.svg\n");
        EXPECT_EQ(o.err, "");
        expect_well_formed(place / ("one/" + what + "_x.svg"));
    }
    // The same as make drew it.
    expect_run(place, "draw made -o again --what curve,profile,wireframe,sections,map --format svg,png", 0);
    for (std::string const name : {"curve.svg", "profile.svg", "wireframe.svg", "sections.svg", "map.png"}) {
        EXPECT_TRUE(file_bytes(place / ("again/" + name)) == file_bytes(place / ("made/" + name))) << name;
    }
}

TEST(Draw, OfARasterWhatNeedsNoRivers) {
    Workplace const place;
    make_dem(place, "hill.tif");
    auto const said = expect_run(place, "draw hill.tif -o out --json", 0).json();
    EXPECT_EQ(said["files"].size(), 4U);
    EXPECT_EQ(names_in(place / "out"), "hypsometry.png map.png sections.png wireframe.png");
    EXPECT_TRUE(said["notes"].empty());
    expect_run(place, "draw hill.tif -o wide.png --width 333", 0);
    EXPECT_EQ(opened(place / "wide.png")->GetRasterXSize(), 333);
}

TEST(Draw, RiversFromAnyLineFile) {
    Workplace const place;
    make_dem(place, "hill.tif");
    place.write("rivers.geojson", test::geojson(test::line("[500600,4999500],[500600,4990000]")));
    expect_run(place, "draw hill.tif --network rivers.geojson -o out", 0);
    EXPECT_EQ(names_in(place / "out"), "hypsometry.png map.png profile.png sections.png wireframe.png");
    Tiff far = metres; // no river runs there
    far.frame[0] = 600000.0;
    make_dem(place, "far.tif", far);
    expect_run(place, "draw far.tif --network rivers.geojson -o far", 0);
    EXPECT_FALSE(fs::exists(place / "far/profile.png"));
    expect_refused(place, "draw far.tif --network rivers.geojson", {"--what profile -o p"});
}

TEST(Draw, AReportPageOfAnyRaster) {
    Workplace const place;
    make_dem(place, "it's.tif");
    Outcome const o = expect_run(place, "draw \"it's.tif\" -o hill.html --json", 0);
    EXPECT_EQ(o.json()["files"][0], "hill.html");
    std::string const page = file_bytes(place / "hill.html");
    EXPECT_TRUE(test::has(page, R"("command":"thalweg draw 'it'\\''s.tif' -o hill.html --what page")"));
    EXPECT_FALSE(test::has(page, "@@"));

    expect_run(place, dilated + "made", 0);
    expect_run(place, "draw made -o made --what page,map", 2); // map.png is there
    expect_run(place, "draw made -o made --what page", 0);
    EXPECT_TRUE(test::has(file_bytes(place / "made/page.html"), "\"strahler\":["));
    place.write("r.toml", "[network]\nprune = 6\n[network.dla]\nparticles = 3000\n");
    expect_run(place, "make r.toml -o bare -q", 0);
    expect_refused(place, "draw",
                   {"made -o made --what page", "made -o x.html --what map", "made -o x.png --what page",
                    "made -o x --what pag", "bare -o x.html", "bare -o map.png"});
    expect_run(place, "draw bare -o out", 0); // without a surface it has its profile
    EXPECT_EQ(names_in(place / "out"), "profile.png");
}

TEST(Draw, LandThatIsHardlyLand) {
    Workplace const place;
    make_dem(place, "holes.tif", metres, [](int x, int y) { return (x + y) % 7 == 0 || x > 30 ? NAN : hill(x, y); });
    make_dem(place, "cell.tif", {.width = 1, .height = 1, .epsg = 32631}, [](int, int) { return 12.0; });
    make_dem(place, "row.tif", {.width = 50, .height = 1, .epsg = 32631}, [](int x, int) { return 3.0 * x; });
    make_dem(place, "level.tif", metres, [](int, int) { return 8848.0; });
    for (std::string const name : {"holes", "cell", "row", "level"}) {
        expect_run(place, "draw " + name + ".tif -o " + name + " --format svg,png", 0);
        for (std::string const what : {"map", "hypsometry", "sections", "wireframe"}) {
            expect_well_formed(place / (name + "/" + what + ".svg"));
            expect_well_formed(place / (name + "/" + what + ".png"));
        }
    }
    make_dem(place, "nothing.tif", metres, [](int, int) { return NAN; });
    expect_refused(place, "draw nothing.tif", {"-o nothing"});
}

TEST(Draw, LargeRastersAreDecimatedWithinMemory) {
    Workplace const place;
    make_dem(place, "hill.tif");
    place.write("large.vrt",
                "<VRTDataset rasterXSize='20000' rasterYSize='20000'><SRS>EPSG:32631</SRS>"
                "<GeoTransform>500000, 2, 0, 5000000, 0, -2</GeoTransform><VRTRasterBand dataType='Float32' band='1'>"
                "<SimpleSource><SourceFilename relativeToVRT='1'>hill.tif</SourceFilename><SourceBand>1</SourceBand>"
                "<SrcRect xOff='0' yOff='0' xSize='40' ySize='30'/><DstRect xOff='0' yOff='0' xSize='20000' "
                "ySize='20000'/></SimpleSource></VRTRasterBand></VRTDataset>");
    expect_run(place, "draw large.vrt --what map -o out", 0);
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    EXPECT_LT(used.ru_maxrss, 2L << 20) << "kilobytes";
}

TEST(Draw, BadInputIsRefused) {
    Workplace const place;
    make_dem(place, "hill.tif");
    fs::create_directory(place / "empty");
    place.write("text.tif", "no raster");
    expect_refused(place, "draw",
                   {"hill.tif", "nowhere.tif -o out", "text.tif -o out", "empty -o out",
                    "hill.tif -o map.png --what map,sections", "hill.tif -o map.png --format svg",
                    "hill.tif -o hill.tif"});
    expect_refused(place, "draw hill.tif -o out",
                   {"--what wirefram", "--format pngg", "--what curve", "--what profile", "--width 20",
                    "--elevation 90", "--network nowhere.gpkg", "--titel x"});
}

TEST(Draw, NothingIsOverwrittenUnasked) {
    Workplace const place;
    make_dem(place, "hill.tif");
    fs::create_directory(place / "out");
    place.write("out/map.png", "mine");
    place.write("out/letter.txt", "mine");
    expect_refused(place, "draw hill.tif -o", {"out", "out/map.png"});
    EXPECT_EQ(names_in(place / "out"), "letter.txt map.png");
    Outcome const o = expect_run(place, "draw hill.tif -o out --what map,wireframe --overwrite", 0);
    expect_well_formed(place / "out/map.png");
    EXPECT_EQ(file_bytes(place / "out/letter.txt"), "mine");
    EXPECT_EQ(names_in(place / "out"), "letter.txt map.png wireframe.png");
    expect_run(place, "draw hill.tif -o out --what sections", 0); // a folder may hold other things
    fs::create_directory(place / "out/hypsometry.png");
    expect_refused(place, "draw hill.tif -o out", {"--what hypsometry --overwrite"});
}

} // namespace draw_test
