// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 2: land around rivers that somebody drew.
// Three lines become a network with heights, the network cells, the cells a surface, and the surface a file.
//   build/release/bin/sample_terrain [dem.tif]
#include <cmath>
#include <cstdio>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

using namespace thalweg;

int main(int count, char** words) try {
    char const* const path = count > 1 ? words[1] : "dem.tif";

    // The frame: 200 x 160 cells of 30 m. Everything below lies in it.
    Grid const grid{200, 160, 30.0, 500000.0, 4804800.0, "EPSG:32631"};

    // The rivers, in metres east and north of the grid's south-west corner; no heights, so z is NaN.
    auto const at = [&](double x, double y) { return Vec3{grid.west + x, grid.south() + y, NAN}; };
    RiverLines drawn;
    drawn.crs = grid.crs;
    drawn.name = "by hand";
    drawn.lines = {
        {1, {at(5200, 4500), at(4100, 3600), at(3000, 2400)}, "", 0}, // from the north-east to the confluence
        {2, {at(700, 4300), at(1500, 3100), at(3000, 2400)}, "", 0},  // from the north-west
        {3, {at(3000, 2400), at(3300, 1200), at(3015, 15)}, "", 0},   // on to the south border
    };

    //! [stages]
    // Lines become arcs of a tree. Whatever had to be mended is told; here nothing is.
    network::ImportedNetwork const imported =
        network::import_lines(drawn, {.orientation = network::Orientation::as_drawn});
    for (Finding const& repair : imported.repairs) {
        std::printf("%s: %s\n", std::string(repair.kind).c_str(), repair.text.c_str());
    }

    // The valleys rise 2 m in 100 m from the outlet; a network with heights is another type than one without.
    network::NetworkWithHeights const raised = network::set_heights(imported.network, {.slope = 0.02});

    // The rivers' cells, and the land that rises from them: 400 m from the valley floor to the farthest crest.
    Valley const valley = network::rasterise(raised.network, grid).valley;
    surface::DilatedDem const land =
        surface::dilate(valley, {.increment = {.increment = "rise_fall"}, .relief_m = 400.0});
    //! [stages]

    io::write_dem(land.dem, path);
    measure::Statistics const is = measure::statistics(land.dem);
    std::printf("%s: %lld x %lld cells, %.1f to %.1f m, mean %.1f m\n", path, static_cast<long long>(grid.width),
                static_cast<long long>(grid.height), is.min.z, is.max.z, is.mean);
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
