// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <make/ascii_grid.hpp>

/// A folder with one small file for each key that names a file. All lie on or over the two places where recipes without
/// `grid.origin` lie: south-east of (500000, 5000000), and around the rivers at (500900, 5000800).
class WalkFiles : public ScratchFolder {
public:
    WalkFiles() {
        using test::line;
        using test::polygon;
        std::string const upper = line("[500300,5001500],[500700,5001200],[500900,5000700]", R"("kind":"A","up":1)");
        std::string const other = line("[501500,5001600],[501200,5001100],[500910,5000700]", R"("kind":"B","up":1)");
        std::string const lower = line("[500900,5000700],[501000,5000010]", R"("kind":"C","up":2)");
        write("rivers.geojson", test::geojson(upper + "," + other + "," + lower));
        write("links.geojson",
              test::geojson(
                  line("[500300,5001500],[500700,5001200],[500900,5000700]", R"("own":1,"alias":3,"to":3,"back":0)") +
                  "," +
                  line("[501500,5001600],[501200,5001100],[500900,5000700]", R"("own":2,"alias":2,"to":3,"back":1)") +
                  "," + line("[500900,5000700],[501000,5000010]", R"("own":3,"alias":1,"to":0,"back":1)")));
        // Water runs against the lines.
        write("nodes.geojson",
              test::geojson(line("[500300,5001500],[500700,5001200],[500900,5000700]",
                                 R"("begin":3,"end":1,"blank":null,"part":1,"way":"in opposite direction")") +
                            "," +
                            line("[501500,5001600],[501200,5001100],[500900,5000700]",
                                 R"("begin":2,"end":3,"blank":null,"part":2,"way":"in direction")") +
                            "," +
                            line("[500900,5000700],[501000,5000010]",
                                 R"("begin":4,"end":3,"blank":null,"part":1,"way":"in opposite direction")")));
        write("second.geojson", test::geojson(upper + "," + lower));
        write("heights.geojson", test::geojson(line("[500300,5001500,90],[500700,5001200,60],[500900,5000700,30]") +
                                               "," + line("[500900,5000700,30],[501000,5000010,5]")));
        write("strokes.geojson", test::geojson(line("[501000,5000010],[501100,5001700]", R"("rosgen":"B")") + "," +
                                               line("[501050,5000900],[500200,5001500]", R"("rosgen":"A")")));
        write("one_stroke.geojson", test::geojson(line("[501000,5000010],[501100,5001700]")));
        write("region.geojson", test::geojson(polygon(square(500300, 5000300, 1300))));
        write("second_region.geojson", test::geojson(polygon(square(500300, 5000300, 1500))));
        write("loop.geojson",
              test::geojson(upper + "," + lower + "," + line("[500700,5001200],[500500,5000900],[500900,5000700]")));
        write("canal.geojson",
              test::geojson(upper + "," + lower + "," +
                            line("[501500,5001600],[501200,5001100],[500900,5000700]", R"("waterway":"canal")")));
        write("coast.geojson",
              test::geojson(upper + "," + lower + "," +
                            line("[499000,5000020],[501000,5000010],[503000,4999990]", R"("FTYPE":"Coastline")")));
        write("inland.geojson", test::geojson(line("[500300,5001500],[500700,5001200],[500900,5000700]")));
        write("outlets.csv", "x,y\n500000,4999000\n501900,4999500\n");
        write("lakes.geojson",
              test::geojson(polygon(square(500700, 5000500, 400)) + "," + polygon(square(500600, 4998600, 800))));
        write("points.csv", points(0.0));
        write("higher.csv", points(200.0));
        write("crests.geojson",
              test::geojson(line("[500300,4999300,700],[500900,4999400,650],[501400,4999000,700]", R"("crest":820)") +
                            "," + line("[501000,4998700],[501600,4998500]", R"("crest":800)")));
        write("patch_mask.geojson", test::geojson(polygon(square(500800, 4998900, 200))));
        raster("mask.asc", 64, 30, 500000, 4998080, [](int c, int r) { return c + r < 6 ? 0.0 : 1.0; });
        raster("uplift.asc", 100, 60, 498000, 4998000, [](int c, int) { return 1.0 + 0.05 * c; });
        raster("north.asc", 100, 60, 498000, 4998000, [](int, int r) { return 100.0 + 4.0 * r; }); // falls to it
        raster("erodibility.asc", 100, 60, 498000, 4998000, [](int c, int r) { return (c / 9 + r / 7) % 2 + 0.5; });
        auto const hills = [](int c, int r) { return 50.0 + 40.0 * std::sin(r / 4.0) * std::cos(c / 5.0); };
        raster("patch.asc", 24, 30, 500600, 4998700, hills);
        raster("hills.asc", 64, 30, 500000, 4998080, hills);
        raster("other_hills.asc", 64, 30, 500000, 4998080, [&](int c, int r) { return hills(r, c); });
        raster("valley.asc", 64, 30, 499980, 4999995, [&](int c, int r) { return hills(c, r) - 4.0 * r; });
        raster("other_patch.asc", 24, 30, 500600, 4998700, [&](int c, int r) { return 2.0 * hills(r, c); });
        two_layers("rivers.gpkg", "rivers", "second");
        two_layers("strokes.gpkg", "strokes", "one_stroke");
        add_layer("no_crs.gpkg", "rivers", {});
        take_crs("no_crs.gpkg");
    }
    std::string folder() const { return path().string(); }

private:
    using Value = std::function<double(int, int)>;

    static std::string square(int west, int south, int side) {
        auto const at = [](int x, int y) { return "[" + std::to_string(x) + "," + std::to_string(y) + "]"; };
        return at(west, south) + "," + at(west + side, south) + "," + at(west + side, south + side) + "," +
               at(west, south + side) + "," + at(west, south);
    }
    /// Points of a bumpy slope over both places.
    static std::string points(double lift) {
        std::string text = "x,y,z,top\n";
        for (int i = 0; i < 14; ++i) {
            for (int k = 0; k < 14; ++k) {
                double const x = 500010.0 + 140.0 * i + 17.0 * (k % 3);
                double const y = 4998100.0 + 140.0 * k + 23.0 * (i % 4);
                double const z = 100.0 + lift + 0.03 * (x - 500000.0) + 30.0 * std::sin(i * 1.3 + k * k * 0.7);
                text += std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "," +
                        std::to_string(z + 40.0 * (i % 3)) + "\n";
            }
        }
        return text;
    }
    void raster(std::string const& name, int side, int cell, int west, int south, Value const& value) const {
        write_ascii_grid(*this / name, {side, side, cell, west, south}, value);
    }
    /// A GeoPackage whose layers are two of the GeoJSON files.
    void two_layers(std::string const& name, std::string const& first, std::string const& second) const {
        add_layer(name, first, {});
        add_layer(name, second, {"-update"});
    }
    void take_crs(std::string const& name) const {
        GDALDatasetH data =
            GDALOpenEx((*this / name).c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, nullptr, nullptr, nullptr);
        for (char const* const table : {"gpkg_geometry_columns", "gpkg_contents"}) {
            std::string const sql = std::string("UPDATE ") + table + " SET srs_id = 0";
            GDALDatasetReleaseResultSet(data, GDALDatasetExecuteSQL(data, sql.c_str(), nullptr, nullptr));
        }
        GDALClose(data);
    }
    void add_layer(std::string const& name, std::string const& of, std::vector<std::string> more) const {
        GDALAllRegister();
        GDALDatasetH source =
            GDALOpenEx((*this / (of + ".geojson")).c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
        more.insert(more.begin(), {"-f", "GPKG", "-nln", of});
        std::vector<char*> words;
        for (std::string& word : more) {
            words.push_back(word.data());
        }
        words.push_back(nullptr);
        GDALVectorTranslateOptions* const options = GDALVectorTranslateOptionsNew(words.data(), nullptr);
        GDALDatasetH made = GDALVectorTranslate((*this / name).c_str(), nullptr, 1, &source, options, nullptr);
        GDALVectorTranslateOptionsFree(options);
        GDALClose(source);
        if (made == nullptr) {
            throw std::runtime_error("cannot write " + name);
        }
        GDALClose(made);
    }
};
