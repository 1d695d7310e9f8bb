// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// thalweg_instructions                         lists the kernels
// thalweg_instructions KERNEL                  runs one once, on one thread, within thalweg_counted(), for callgrind;
//                                              prints the compiler and the vector instructions
// thalweg_instructions --write INPUT SIDE FILE writes an input as raw floats, for the programs in bench/peers
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/run/lanes.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/growth/forest/grow_forest.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>
#include <thalweg/network/planform/meander.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/solver/grid/poisson.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

#include "../tests/network/masks.hpp"
#include "../tests/solver/winding_lines.hpp"
#include "../tests/surface/channel_trees.hpp"
#include "inputs.hpp"

/// What callgrind counts: noipa keeps the call and its name.
extern "C" [[gnu::noipa]] void thalweg_counted(std::function<void()> const& kernel) {
    kernel();
}

namespace {

using namespace thalweg;

Run const run = [] {
    Run one;
    one.threads = 1;
    return one;
}();

Grid square(std::int64_t side) {
    return {side, side, 10.0, 0.0, 10.0 * static_cast<double>(side), ""};
}

growth::PlantedForest forest(std::int64_t side, std::int64_t step) {
    Mask const land(square(side), 1);
    auto const outlets = growth::spread_outlets(land, growth::coast_cells(land));
    return growth::plant_forest(land, outlets, {.step_cells = step}, run);
}

Valley no_rivers(Grid const& grid) {
    return {Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
}

flow::ConditionedDem conditioned(Raster<float> const& dem, flow::Conditioning method) {
    return flow::condition(dem, no_rivers(dem.grid()), {method}, run);
}

/// Prepares what a kernel needs and gives what is counted.
using Prepare = std::function<std::function<void()>()>;

struct Kernel {
    std::string_view name;
    Prepare prepare;
};

std::vector<Kernel> const kernels{
    {"grow_dla", [] { return [] { growth::grow_dla({.particles = 10'000, .sticking = 1.0, .visits = 1}, run); }; }},
    {"plant_forest", [] { return [] { forest(192, 5); }; }},
    {"meander",
     [] {
         auto const rivers = forest(512, 20).network;
         auto const areas = flow::areas_nearest(rivers, square(512), run).ds_area_m2;
         return [=] { network::meander(rivers, square(512), areas, {}, run); };
     }},
    {"thin",
     [] {
         Mask const mask = test::random_blob(7, 512, 512, 64, 7);
         return [=] { network::thin(mask, run); };
     }},
    {"dilate",
     [] {
         Valley valley = no_rivers(square(512));
         solver::GridProblem const lines = test::winding_lines(512, 0.035);
         for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
             valley.z[i] = lines.kind[i] == solver::fixed_cell ? static_cast<float>(lines.value[i]) : valley.z[i];
         }
         return [=] { surface::dilate(valley, {{"uniform"}, surface::Metric::cityblock, 300.0}, run); };
     }},
    {"solve_poisson",
     [] {
         solver::GridProblem const problem = test::winding_lines(256, 0.035);
         return [=] { solver::solve_poisson(problem, {1e-6, 200}, run); };
     }},
    {"equilibrium",
     [] {
         Grid const grid{128, 128, 30.0, 0.0, 0.0, ""};
         Channels const rivers =
             channel_trees::grown(grid, {grid.index({64, 127})}, {}, grid.cells() / 100, channel_trees::Room::apart, 1);
         return [=] { surface::equilibrium(rivers, {}, {}, run); };
     }},
    {"fill",
     [] {
         Raster<float> const dem = inputs::relief(256);
         return [=] { conditioned(dem, flow::Conditioning::fill); };
     }},
    {"carve",
     [] {
         Raster<float> const dem = inputs::relief(256);
         return [=] { conditioned(dem, flow::Conditioning::carve); };
     }},
    {"route",
     [] {
         Raster<float> const dem = inputs::relief(256);
         return [=] { flow::route(dem, run); };
     }},
    {"route_drained",
     [] {
         Raster<float> const dem = conditioned(inputs::relief(256), flow::Conditioning::fill).dem;
         return [=] { flow::route(dem, run); };
     }},
    {"tin_of_dem",
     [] {
         Raster<float> const dem = inputs::mountains(3);
         return [=] { geometry::tin_of_dem(dem, {5.0}, run); };
     }},
    {"midpoint",
     [] {
         Raster<float> const coarse = inputs::mountains(0);
         fractal::MidpointParams params;
         params.levels = 5;
         params.width = params.height = 512;
         return [=] { fractal::midpoint(coarse, params, run); };
     }},
    {"contours",
     [] {
         io::contours(inputs::mountains(0), 100.0, run); // GDAL registers its drivers once
         Raster<float> const dem = inputs::mountains(3);
         return [=] { io::contours(dem, 20.0, run); };
     }},
};

/// NaN: a free cell.
Raster<float> laplace(std::int64_t side) {
    solver::GridProblem const problem = test::winding_lines(side, 0.035);
    Raster<float> values = no_rivers(problem.kind.grid()).z;
    for (std::int64_t i = 0; i < values.cells(); ++i) {
        values[i] = problem.kind[i] == solver::fixed_cell ? static_cast<float>(problem.value[i]) : values[i];
    }
    return values;
}

Raster<float> input(std::string_view name, std::int64_t side) {
    if (name == "relief") {
        return inputs::relief(side);
    }
    if (name == "drained") {
        return conditioned(inputs::relief(side), flow::Conditioning::fill).dem;
    }
    if (name == "laplace") {
        return laplace(side);
    }
    int levels = 0;
    while ((std::int64_t{32} << levels) < side) {
        ++levels;
    }
    return inputs::mountains(levels);
}

} // namespace

int main(int count, char** words) {
    std::vector<std::string_view> const arguments(words + 1, words + count);
    if (arguments.size() == 4 && arguments[0] == "--write") {
        Raster<float> const values = input(arguments[1], std::atoll(words[3]));
        std::ofstream out(words[4], std::ios::binary);
        out.write(reinterpret_cast<char const*>(values.values().data()),
                  static_cast<std::streamsize>(values.values().size_bytes()));
        return out.flush() ? EXIT_SUCCESS : EXIT_FAILURE;
    }
    for (Kernel const& kernel : kernels) {
        if (arguments.empty()) {
            std::cout << kernel.name << '\n';
        } else if (arguments[0] == kernel.name) {
            thalweg_counted(kernel.prepare());
#ifdef __clang__
            std::cout << "clang++ " << __clang_major__;
#else
            std::cout << "g++ " << __GNUC__;
#endif
            std::cout << (widest_lanes() == Lanes::avx2 ? " avx2\n" : " plain\n");
            return EXIT_SUCCESS;
        }
    }
    return arguments.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
}
