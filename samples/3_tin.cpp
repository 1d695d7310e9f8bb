// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 3: terrain as triangles.
// Points that somebody surveyed and the line of a stream become a TIN, the TIN cells, and the cells a smaller TIN.
//   build/release/bin/sample_tin [tin.gpkg]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <thalweg/core.hpp>
#include <thalweg/geometry.hpp>
#include <thalweg/io.hpp>
#include <thalweg/surface.hpp>

using namespace thalweg;

/// The land that was surveyed: two planes that meet in a stream, x = 500 m, which falls to the south.
double height_at(double x, double y) {
    return 100.0 + 0.05 * y + 0.2 * std::fabs(x - 500.0);
}

int main(int count, char** words) try {
    char const* const path = count > 1 ? words[1] : "tin.gpkg";

    // Places chosen at random: words that depend on the seed and the point's number alone, on any machine.
    auto const surveyed = [](double x, double y) { return Vec3{x, y, height_at(x, y)}; };
    std::vector<Vec3> points = {surveyed(0, 0), surveyed(1000, 0), surveyed(0, 800), surveyed(1000, 800)};
    for (std::uint64_t i = 0; i < 200; ++i) {
        auto const word = random_block(7, i);
        points.push_back(surveyed(std::floor(unit(word[0]) * 1000.0), std::floor(unit(word[1]) * 800.0)));
    }
    std::vector<Vec3> const stream = {surveyed(500, 800), surveyed(500, 300), surveyed(500, 0)};

    //! [triangulate]
    // Without the breakline, triangles would span the valley floor and dam the stream.
    Tin const dammed = geometry::triangulate(points).tin;
    geometry::Triangulation const made = geometry::triangulate(points, {stream});
    std::printf("%zu vertices, %zu triangles, %zu edges along the stream\n", made.tin.vertices.size(),
                made.tin.triangles.size(), made.chains[0].size() - 1);
    //! [triangulate]

    // Heights of the cells under the stream, against those that were surveyed.
    Grid const grid{101, 81, 10.0, -5.0, 805.0, "EPSG:32631"};
    for (Tin const* const tin : {&dammed, &made.tin}) {
        Raster<float> const dem = surface::rasterise_tin(*tin, grid);
        double dam_m = 0.0;
        for (std::int64_t row = 0; row < grid.height; ++row) {
            Vec2 const at = grid.centre({50, row});
            dam_m = std::max(dam_m, static_cast<double>(dem[Cell{50, row}]) - height_at(at.x, at.y));
        }
        std::printf("the highest dam is %.1f m\n", dam_m);
    }

    // The other way round: of all cells those that are needed to keep the land within half a metre.
    Raster<float> const dem = surface::rasterise_tin(made.tin, grid);
    geometry::SimplifiedDem const small = geometry::tin_of_dem(dem, {.error_m = 0.5});
    std::printf("%lld cells are %zu triangles within %.2f m\n", static_cast<long long>(grid.cells()),
                small.tin.triangles.size(), small.error_m);
    io::write_tin(made.tin, grid.crs, path, io::tin_format("", path));
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
