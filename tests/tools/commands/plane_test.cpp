// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One plane in any unit, vertical CRS, orientation, registration and projection is one plane to every command.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "command.hpp"

namespace plane_test {

using nlohmann::json;

namespace {

constexpr double us_foot_m = 1200.0 / 3937.0;
constexpr int width = 60;
constexpr int height = 50;
constexpr int margin = 15; ///< [cells] around the patch of blend

struct Unit {
    char const* of_band;  ///< "": none
    char const* vertical; ///< part of the CRS, "": none
    double metres;
};
constexpr std::array<Unit, 6> units{{{"", "", 1.0},
                                     {"m", "", 1.0},
                                     {"ft", "", 0.3048},
                                     {"", "+6360", us_foot_m}, // NAVD88 height (ftUS)
                                     {"metre", "+6360", 1.0},
                                     {"US survey foot", "", us_foot_m}}};

struct Plan {
    char const* crs;
    double west;
    double north;
    double cell;
    double cell_m; ///< [m] on the ground, east and south
    double cell_m_south;
    bool is_metres;
};
constexpr std::array<Plan, 4> plans{
    {{"EPSG:26913", 350000.0, 3900000.0, 30.0, 30.0, 30.0, true},
     {"EPSG:6529", 1500000.0, 1500000.0, 100.0, 100.0 * us_foot_m, 100.0 * us_foot_m, false},
     {"EPSG:4269", -106.4, 35.2, 0.0003, 27.31, 33.29, false},
     {"EPSG:3857", -11840000.0, 4190000.0, 40.0, 32.73, 32.63, false}}};

/// A plane [m] over columns and rows from the north.
struct Plane {
    double at = 0.0;
    double east = 0.0;  ///< [m] by column
    double south = 0.0; ///< [m] by row

    double z(int col, int row) const { return at + east * col + south * row; }
    double lowest() const { return std::min({z(0, 0), z(width - 1, 0), z(0, height - 1), z(width - 1, height - 1)}); }
    double highest() const { return std::max({z(0, 0), z(width - 1, 0), z(0, height - 1), z(width - 1, height - 1)}); }
};

/// \param inset [cells] left out on each side
void write_dem(std::string const& path, Plane const& plane, Unit const& unit, Plan const& plan, bool from_south,
               bool is_point, int inset = 0) {
    GDALAllRegister();
    int const wide = width - 2 * inset;
    int const high = height - 2 * inset;
    GDALDatasetUniquePtr const data(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), wide, high, 1, GDT_Float64, nullptr));
    double const north = plan.north - inset * plan.cell;
    std::array<double, 6> frame{
        plan.west + inset * plan.cell,      plan.cell, 0.0, from_south ? north - high * plan.cell : north, 0.0,
        from_south ? plan.cell : -plan.cell};
    data->SetGeoTransform(frame.data());
    OGRSpatialReference reference;
    ASSERT_EQ(reference.SetFromUserInput((plan.crs + std::string(unit.vertical)).c_str()), OGRERR_NONE);
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    data->SetSpatialRef(&reference);
    if (is_point) {
        data->SetMetadataItem(GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT);
    }
    GDALRasterBand& band = *data->GetRasterBand(1);
    if (*unit.of_band != '\0') {
        band.SetUnitType(unit.of_band);
    }
    std::vector<double> row(static_cast<std::size_t>(wide));
    for (int r = 0; r < high; ++r) {
        for (int c = 0; c < wide; ++c) {
            row[static_cast<std::size_t>(c)] =
                plane.z(c + inset, inset + (from_south ? high - 1 - r : r)) / unit.metres;
        }
        ASSERT_EQ(band.RasterIO(GF_Write, 0, r, wide, 1, row.data(), wide, 1, GDT_Float64, 0, 0, nullptr), CE_None);
    }
}

std::array<double, 2> range_of(std::string const& path) {
    std::array<double, 2> range{1e9, -1e9};
    auto const dem = thalweg::io::read_dem(path);
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            range = {std::min(range[0], static_cast<double>(z)), std::max(range[1], static_cast<double>(z))};
        }
    }
    return range;
}

} // namespace

TEST(Planes, EveryCommandSeesTheSameHeightsAndSlope) {
    Workplace const place;
    for (std::uint64_t draw = 0; draw < 12; ++draw) {
        auto const chance = [&](std::uint64_t what) { return thalweg::unit(thalweg::random_word(77, draw, what)); };
        Plan const& plan = plans[draw % plans.size()];
        Unit const& unit = units[static_cast<std::size_t>(chance(0) * 6.0)];
        bool const from_south = chance(1) < 0.4;
        Plane const plane{800.0 + 900.0 * chance(2), 6.0 * chance(3) - 3.0, 6.0 * chance(4) - 3.0};
        std::string const what = std::string(plan.crs) + unit.vertical + " in '" + unit.of_band + "', " +
                                 (from_south ? "from the south" : "from the north");
        std::string const path = (place / "dem.tif").string();
        write_dem(path, plane, unit, plan, from_south, chance(5) < 0.5);

        // stats: the file's own cells, to the centimetre; the slope of the metric grid.
        json const stats = expect_run(place, "stats dem.tif --json", 0).json();
        double const mean = 0.5 * (plane.lowest() + plane.highest());
        EXPECT_NEAR(stats["mean"].get<double>(), mean, 0.01) << what;
        EXPECT_NEAR(stats["min"]["z"].get<double>(), plane.lowest(), 0.01) << what;
        EXPECT_NEAR(stats["max"]["z"].get<double>(), plane.highest(), 0.01) << what;
        double const slope =
            std::atan(std::hypot(plane.east / plan.cell_m, plane.south / plan.cell_m_south)) * 180.0 / 3.14159265358979;
        EXPECT_NEAR(stats["slope_true_deg"].get<double>(), slope, plan.is_metres ? 1e-3 : 0.01 + 0.01 * slope) << what;

        // The others: no height outside the plane's, and all of them but at most two cells at the rim of a warp.
        double const rim = plan.is_metres ? 0.01 : 2.0 * (std::fabs(plane.east) + std::fabs(plane.south)) + 0.01;
        auto const expect_range = [&](double low, double high, char const* command) {
            EXPECT_GE(low, plane.lowest() - 0.02) << command << " " << what;
            EXPECT_LE(high, plane.highest() + 0.02) << command << " " << what;
            EXPECT_LE(low, plane.lowest() + rim) << command << " " << what;
            EXPECT_GE(high, plane.highest() - rim) << command << " " << what;
        };
        expect_run(place, "export dem.tif -o heights.png --overwrite -q", 0);
        json const heights = json::parse(file_bytes(place / "heights.png.json"));
        expect_range(heights["min_m"].get<double>(), heights["max_m"].get<double>(), "export");
        expect_run(place, "make dem.tif -o out --overwrite -q", 0);
        auto const made = range_of((place / "out/dem.tif").string());
        expect_range(made[0], made[1], "make");
        expect_run(place, "draw dem.tif -o map.png --what map --overwrite -q", 0);
        expect_run(place, "measure dem.tif -o measures --what hand,twi --support 3 --overwrite -q", 0);
        if (plan.is_metres) {
            write_dem((place / "patch.tif").string(), plane, unit, plan, !from_south, false, margin);
            expect_run(place, "blend dem.tif patch.tif -o same.tif --overwrite -q", 0);
            auto const same = range_of((place / "same.tif").string());
            expect_range(same[0], same[1], "blend");
            expect_run(place, "tin dem.tif --error 0.01 -o tin.ply --overwrite -q", 0);
            expect_run(place, "points dem.tif -o points.xyz --overwrite -q", 0);
        } else {
            for (std::string const command : {"tin dem.tif -o tin.ply", "points dem.tif -o points.xyz"}) {
                expect_run(place, command + " --overwrite", 2, "gdalwarp -novshift -t_srs");
            }
        }
    }
}

TEST(Planes, EveryCommandChoosesTheSameMetres) {
    Workplace const place;
    auto const write = [&](double west, double north, double cell) {
        Plan const plan{"EPSG:4326", west, north, cell, 0.0, 0.0, false};
        write_dem((place / "dem.tif").string(), {800.0, 2.0, 1.0}, units[0], plan, false, false);
    };
    // 6, 36 and 72 degrees wide, and around a pole.
    for (auto const& [west, north, cell] : {std::array{7.0, 48.0, 0.1}, std::array{-20.0, 40.0, 0.6},
                                            std::array{-30.0, 50.0, 1.2}, std::array{20.0, 89.9, 0.1}}) {
        write(west, north, cell);
        std::string const drawn = thalweg::io::read_drawable((place / "dem.tif").string()).dem.grid().crs;
        expect_run(place, "make dem.tif -o out --overwrite -q", 0);
        std::string const made = thalweg::io::read_dem((place / "out/dem.tif").string()).grid().crs;
        EXPECT_EQ(made, drawn);
        EXPECT_EQ(made.starts_with("EPSG:326"), cell < 0.5 && north < 84.0) << made;
        bool const says_zone = expect_run(place, "stats dem.tif", 0).err.find("UTM zone") != std::string::npos;
        EXPECT_EQ(says_zone, cell < 0.5 && north < 84.0);
    }
    write(-100.0, 88.0, 3.5);
    expect_run(place, "make dem.tif -o out --overwrite", 2, "210 degrees of longitude", "-projwin");
    expect_run(place, "stats dem.tif", 0, "210 degrees of longitude");
}

TEST(Planes, WhatHasNoPlaneIsRefusedInWords) {
    Workplace const place;
    Plan const plan{"EPSG:4326", 7.0, 95.0, 0.01, 0.0, 0.0, false};
    write_dem((place / "dem.tif").string(), {800.0, 2.0, 1.0}, units[0], plan, false, false);
    for (char const* const command : {"stats dem.tif", "make dem.tif -o out", "export dem.tif -o heights.png",
                                      "draw dem.tif -o map.png", "tin dem.tif -o tin.ply"}) {
        expect_run(place, command, 2, "beyond a pole");
    }
    write_dem((place / "dem.tif").string(), {800.0, 2.0, 1.0}, units[0], plans[0], false, false);
    expect_run(place, "stats dem.tif --band ''", 2, "--band", "a number or a name");
}

} // namespace plane_test
