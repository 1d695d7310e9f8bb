// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 5: a profile of one's own.
// How a hillside rises from its river is a function; any will do. Here: a terrace every ten cells.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <thalweg/core.hpp>
#include <thalweg/surface.hpp>

using namespace thalweg;

int main() try {
    // A straight river through the middle of 81 x 40 cells of 10 m; it falls 1 m a cell to the south.
    Grid const grid{81, 40, 10.0, 0.0, 400.0, ""};
    Valley valley{Raster<float>(grid, NAN)};
    for (std::int64_t row = 0; row < grid.height; ++row) {
        valley.z[Cell{40, row}] = static_cast<float>(grid.height - row);
    }

    //! [increment]
    // What the x-th cell from the river adds: a step of 5 m after each nine that are nearly level. A function may hold
    // whatever it needs, a table for one; it must give the same for the same x.
    double const step = 5.0;
    surface::IncrementParams terraces;
    terraces.function = [step](double x) { return std::fmod(x, 10.0) == 0.0 ? step : 0.125; };
    surface::DilatedDem const land = surface::dilate(valley, {.increment = terraces, .relief_m = 60.0});
    //! [increment]

    // Each terrace is a jump in the slope of all hillsides at once: the library says where.
    std::size_t const jumps = surface::increment_jumps(land.levels, terraces).size();
    std::printf("%lld cells from river to crest, %zu jumps, %.1f m of relief\n", static_cast<long long>(land.levels),
                jumps, land.rise_m);

    // The profile across the valley, from the river to the eastern edge.
    double steepest = 0.0;
    for (std::int64_t col = 41; col < grid.width; ++col) {
        double const rise = static_cast<double>(land.dem[Cell{col, 20}] - land.dem[Cell{col - 1, 20}]);
        steepest = std::max(steepest, rise);
        if (col % 10 == 0) {
            std::printf("%lld m from the river: %.2f m above it\n", static_cast<long long>(col - 40) * 10,
                        static_cast<double>(land.dem[Cell{col, 20}] - land.dem[Cell{40, 20}]));
        }
    }

    // The same as an expression, as a recipe would have it: to the last bit.
    surface::IncrementParams const written{.increment = "abs(x-10*rint(x/10))<0.5 ? 5 : 0.125"};
    surface::DilatedDem const same = surface::dilate(valley, {.increment = written, .relief_m = 60.0});
    auto const a = land.dem.values();
    auto const b = same.dem.values();
    std::printf("as an expression: %s\n", std::equal(a.begin(), a.end(), b.begin(), b.end()) ? "the same" : "another");
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
