// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 4: measuring a DEM, anybody's.
// Its slopes, where its water runs, the streams that follow, and what each of them drains.
//   build/release/bin/sample_measure samples/bigtujunga_srtm1.tif
#include <algorithm>
#include <cstdio>
#include <numeric>

#include <thalweg/core.hpp>
#include <thalweg/flow.hpp>
#include <thalweg/io.hpp>
#include <thalweg/measure.hpp>
#include <thalweg/network.hpp>

using namespace thalweg;

int main(int count, char** words) try {
    if (count < 2) {
        std::fprintf(stderr, "which DEM? sample_measure DEM.tif\n");
        return 1;
    }
    Raster<float> const dem = io::read_dem(words[1]);
    double const cell_km2 = dem.grid().cell_m * dem.grid().cell_m / 1e6;

    measure::Slopes const slopes = measure::slopes(dem);
    std::printf("mean slope %.2f degrees, median %.1f\n", slopes.mean_deg, slopes.percentile_deg[3]);

    //! [route]
    // Every cell drains to one neighbour (D8). Where pits are, the water leaves them by the lowest way out.
    flow::FlowField const drainage = flow::route(dem);
    std::printf("%lld cells in pits\n", static_cast<long long>(drainage.pits));

    // A stream runs where 500 cells drain through one.
    flow::ExtractedStreams const streams = flow::extract_streams(drainage, dem, {.support_cells = 500});
    NetworkOrders const orders = network::order(streams.network.planform);
    //! [route]
    std::printf("%zu arcs, highest order %d\n", streams.network.planform.arc_count(),
                *std::max_element(orders.strahler.begin(), orders.strahler.end()));
    measure::HortonLaws const laws = measure::horton(streams.network.planform, orders, streams.areas.ds_area_m2);
    if (laws.bifurcation) { // a short network may have none
        std::printf("bifurcation ratio %.2f\n", laws.bifurcation->ratio);
    }

    // Every cell belongs to the catchment of the first stream that its water meets.
    flow::Reaches const reaches = flow::reaches_of(streams.network.planform);
    flow::Catchments const catchments = flow::catchments(reaches, drainage);
    auto const largest = std::max_element(catchments.upstream.begin(), catchments.upstream.end());
    std::int64_t const drained = std::accumulate(catchments.cells.begin(), catchments.cells.end(), std::int64_t{0});
    std::printf("largest basin %.2f km2 of %.2f km2 drained; %.2f km2 meet no stream\n",
                static_cast<double>(*largest) * cell_km2, static_cast<double>(drained) * cell_km2,
                static_cast<double>(catchments.without) * cell_km2);
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
