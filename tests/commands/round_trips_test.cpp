// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `thalweg export` writes, the readers of tin, deform and blend read back.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/export/export.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>

namespace round_trips_test {

using namespace thalweg;
using namespace thalweg::exports;

namespace {

Raster<float> random_dem() {
    Grid grid = test::frame(*rc::gen::inRange<std::int64_t>(3, 24), *rc::gen::inRange<std::int64_t>(3, 24),
                            static_cast<double>(*rc::gen::inRange(1, 200)) / 4.0);
    grid.crs = "EPSG:32631";
    grid.west = 500000.0 + 0.25 * *rc::gen::inRange(-4000, 4000);
    grid.north = 4500000.0;
    int const base = *rc::gen::inRange(-400, 4000);
    int const relief = *rc::gen::inRange(1, 3000);
    Raster<float> dem(grid);
    for (float& z : dem.values()) {
        z = static_cast<float>(base) + static_cast<float>(*rc::gen::inRange(0, 8 * relief)) / 8.0F;
    }
    return dem;
}

double relief_of(Raster<float> const& dem) {
    auto const [low, high] = std::ranges::minmax_element(dem.values());
    return static_cast<double>(*high) - static_cast<double>(*low);
}

/// The largest difference of heights, where frames agree.
double worst_of(Raster<float> const& a, Raster<float> const& b) {
    EXPECT_EQ(a.grid().crs, b.grid().crs);
    EXPECT_EQ(a.width(), b.width());
    EXPECT_EQ(a.height(), b.height());
    EXPECT_NEAR(a.grid().west, b.grid().west, 1e-6);
    EXPECT_NEAR(a.grid().north, b.grid().north, 1e-6);
    EXPECT_NEAR(a.grid().cell_m, b.grid().cell_m, 1e-9);
    double worst = a.cells() == b.cells() ? 0.0 : HUGE_VAL;
    for (std::int64_t i = 0; i < std::min(a.cells(), b.cells()); ++i) {
        worst = std::max(worst, std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    return worst;
}

ExportParams export_to(std::string const& source, std::string const& output, std::string const& preset = "") {
    ExportParams params;
    params.source = source;
    params.output = output;
    params.preset = preset;
    return params;
}

} // namespace

RC_GTEST_PROP(RoundTrips, HeightmapsAreReadBackWithinHalfAStep, ()) {
    Raster<float> const dem = random_dem();
    ScratchFolder const folder;
    io::write_dem(dem, folder / "dem.tif");
    double const half = 0.5 * relief_of(dem) / 65535.0 * (1.0 + 1e-6) + 1e-3 * std::ldexp(1.0, -10) + 2.5e-4;
    for (std::string const ending : {"png", "r16", "raw", "r32"}) {
        std::string const file = folder / ("a." + ending);
        run_export(export_to(folder / "dem.tif", file));
        io::DemFile const read = io::read_dem_file(file);
        RC_ASSERT(worst_of(read.dem, dem) <= (ending == "r32" ? 0.0 : half));
        RC_ASSERT(io::content_of(file).kind == io::FileContent::Kind::raster);
    }
}

RC_GTEST_PROP(RoundTrips, MeshesAreReadBackAtTheirPlaceWithoutExaggeration, ()) {
    Raster<float> const dem = random_dem();
    ScratchFolder const folder;
    io::write_dem(dem, folder / "dem.tif");
    for (std::string const ending : {"obj", "glb"}) {
        ExportParams params = export_to(folder / "dem.tif", folder / ("a." + ending));
        params.exaggeration = *rc::gen::element(1.0, 1.5, 3.0);
        run_export(params);
        io::TinFile const read = io::read_tin(params.output);
        RC_ASSERT(static_cast<std::int64_t>(read.tin.vertices.size()) == dem.cells());
        for (Vec3 const& v : read.tin.vertices) {
            Cell const c = dem.grid().cell_of({v.x, v.y});
            RC_ASSERT(dem.grid().contains(c));
            RC_ASSERT(distance(dem.grid().centre(c), {v.x, v.y}) < 2e-3);
            RC_ASSERT(std::fabs(v.z - static_cast<double>(dem[c])) < 2e-3);
        }
    }
}

TEST(RoundTrips, TilesOfProgramsAreReadAtTheirPlaces) {
    Grid grid = test::frame(65, 65, 10.0);
    grid.crs = "EPSG:32631";
    Raster<float> const dem =
        test::raster_of(grid, [](Cell c) { return static_cast<float>(100 + 3 * c.col + (c.row * c.row) % 17); });
    ScratchFolder const folder;
    io::write_dem(dem, folder / "dem.tif");
    ExportParams params = export_to(folder / "dem.tif", folder / "unity", "unity");
    params.masks = {"none"};
    params.tiles_across = params.tiles_down = 2;
    params.width = params.height = 33;
    run_export(params);
    for (std::int64_t const x : {0, 1}) {
        for (std::int64_t const y : {0, 1}) {
            Raster<float> const tile =
                io::read_dem(folder / ("unity/height_x" + std::to_string(x) + "_y" + std::to_string(y) + ".raw"));
            ASSERT_EQ(tile.cells(), 33 * 33);
            EXPECT_NEAR(tile.grid().west, grid.west + 320.0 * static_cast<double>(x), 1e-6);
            EXPECT_NEAR(tile.grid().north, grid.north - 320.0 * static_cast<double>(y), 1e-6);
            for (std::int64_t i = 0; i < tile.cells(); ++i) {
                Cell const c = tile.grid().at(i);
                EXPECT_NEAR(tile[i], (dem[Cell{c.col + 32 * x, c.row + 32 * y}]), 0.01);
            }
        }
    }
}

TEST(RoundTrips, AnExrIsReadBackBitForBit) {
    Grid grid = test::frame(7, 5, 10.0);
    grid.crs = "EPSG:32631";
    Raster<float> const dem =
        test::raster_of(grid, [](Cell c) { return 0.1F * static_cast<float>(c.col - 3 * c.row); });
    ScratchFolder const folder;
    io::write_dem(dem, folder / "dem.tif");
    try {
        run_export(export_to(folder / "dem.tif", folder / "a.exr"));
    } catch (BadParameter const& absent) { // a build without OpenEXR refuses both ways
        EXPECT_TRUE(test::has(absent.what(), "OpenEXR"));
        return;
    }
    EXPECT_EQ(worst_of(io::read_dem(folder / "a.exr"), dem), 0.0);
    EXPECT_EQ(io::content_of(folder / "a.exr").kind, io::FileContent::Kind::raster);
}

} // namespace round_trips_test
