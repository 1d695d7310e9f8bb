// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// fastscapelib, uplift and stream power with n = 1 from flat ground, until mean heights change by less than 0.01 % in a
// step; parameters of its example "mountain", of which theta is ours: fastscapelib SIDE
#include <cmath>

#if __has_include(<xtensor/containers/xarray.hpp>)
#include <xtensor/containers/xarray.hpp>
#include <xtensor/generators/xrandom.hpp>
#else
#include <xtensor/xarray.hpp>
#include <xtensor/xrandom.hpp>
#endif

#include <fastscapelib/eroders/spl.hpp>
#include <fastscapelib/flow/flow_graph.hpp>
#include <fastscapelib/flow/flow_router.hpp>
#include <fastscapelib/flow/sink_resolver.hpp>
#include <fastscapelib/grid/raster_grid.hpp>

#include "peer.hpp"

namespace fs = fastscapelib;

int main(int, char** words) {
    std::size_t const side = peer::size_of(words[1]);
    int steps = 0;
    peer::measure(
        "fastscapelib", side, 1, [] { return 0; },
        [&](int) {
            using Grid = fs::raster_grid<>;
            Grid grid({side, side}, {30.0, 30.0}, fs::raster_boundary_status(fs::node_status::fixed_value));
            fs::flow_graph<Grid> graph(grid, {fs::single_flow_router(), fs::mst_sink_resolver()});
            auto eroder = fs::make_spl_eroder(graph, 2e-4, 0.38, 1, 1e-5);
            xt::xarray<double> heights = xt::random::rand<double>(grid.shape());
            xt::xarray<double> area(heights.shape());
            double const step_a = 2e4;
            double before = 0.0;
            for (double mean = 1.0; std::fabs(mean - before) > 1e-4 * mean && steps < 1000; ++steps) {
                for (std::size_t r = 1; r + 1 < side; ++r) {
                    for (std::size_t c = 1; c + 1 < side; ++c) {
                        heights(r, c) += step_a * 1e-3;
                    }
                }
                graph.update_routes(heights);
                graph.accumulate(area, 1.0);
                heights -= eroder.erode(heights, area, step_a);
                before = mean;
                mean = 0.0;
                for (double const z : heights) {
                    mean += z / static_cast<double>(side * side);
                }
            }
        });
    std::printf("fastscapelib_steps/%zu %d\n", side, steps);
}
