// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The solver on skeletons as the pipeline makes them and as land has them.
#include <thalweg/solver/grid/poisson.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/flow/route.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/surface/diffusion/internal/diffusion.hpp>

namespace skeletons_test {

using namespace thalweg;
using namespace thalweg::solver;

namespace {

/// A Tokunaga network of 1024 x 1024 cells, and the ridges between its streams.
Raster<float> rivers_and_ridges(skeleton::RidgesParams::Method method) {
    Grid const grid{1024, 1024, 30.0, 0.0, 30720.0, ""};
    network::EmbedParams embedding;
    embedding.region = {{600, 600}, {30120, 600}, {30120, 30120}, {600, 30120}};
    embedding.mouth = {15360, 600};
    auto const tree = network::grow_tokunaga({.generator = 2, .order = 6});
    StreamNetwork const plan = network::embed_tree(tree, embedding).network;
    ElevatedNetwork const rivers = network::set_heights(plan, {network::HeightMode::along_stream, 0.02}).network;
    skeleton::RidgesParams params;
    params.method = method;
    RidgeLines const ridges = skeleton::ridges(rivers, network::streams(plan, network::order(plan)), grid, params);
    return skeleton::draw_skeleton(network::rasterise(rivers, grid).valley, ridges, {}).skeleton.z;
}

/// The rivers of a DEM: its cells through which the water of a hundred others runs.
Raster<float> streams_of_land() {
    Raster<float> dem = io::read_dem(THALWEG_SOURCE_DIR "/samples/jacksboro_srtm3.tif");
    flow::FlowField const drainage = flow::route(dem);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = drainage.area_cells[i] >= 100 ? dem[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return dem;
}

void expect_solved(Raster<float> const& z, int most_iterations) {
    GridProblem const problem = surface::problem_through(z, {}, "test", {});
    float least = std::numeric_limits<float>::infinity();
    float greatest = -least;
    std::int64_t fixed = 0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (!std::isnan(z[i])) {
            ++fixed;
            least = std::min(least, z[i]);
            greatest = std::max(greatest, z[i]);
        }
    }
    GridSolution const quick = solve_poisson(problem, {1e-6, 1000});
    GridSolution const exact = solve_poisson(problem, {1e-12, 1000});
    double most = 0.0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        most = std::max(most, std::fabs(quick.value[i] - exact.value[i]));
        ASSERT_TRUE(quick.value[i] >= least && quick.value[i] <= greatest);
        ASSERT_TRUE(std::isnan(z[i]) || quick.value[i] == static_cast<double>(z[i]));
    }
    std::printf("%lld x %lld cells, %.2f %% fixed, %.0f to %.0f m: %d iterations to 1e-6, %d to 1e-12, error %.2g m\n",
                static_cast<long long>(z.width()), static_cast<long long>(z.height()),
                100.0 * static_cast<double>(fixed) / static_cast<double>(z.cells()), least, greatest, quick.iterations,
                exact.iterations, most);
    EXPECT_LE(most, 1e-3);
    EXPECT_LE(quick.iterations, most_iterations);
}

TEST(PoissonOnSkeletons, RiversAndRidges) {
    expect_solved(rivers_and_ridges(skeleton::RidgesParams::Method::voronoi), 25);
    expect_solved(rivers_and_ridges(skeleton::RidgesParams::Method::segments), 25);
}

TEST(PoissonOnSkeletons, StreamsOfLand) {
    expect_solved(streams_of_land(), 25);
}

} // namespace

} // namespace skeletons_test
