// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 6: rivers by a rule of one's own.
// Whoever can say which place drains to which has a network; from there on the library does the rest. The rule is
// Scheidegger's (1967): from every place of a lattice water runs south-west or south-east, as a coin falls.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <thalweg/core.hpp>
#include <thalweg/flow.hpp>
#include <thalweg/measure.hpp>
#include <thalweg/network.hpp>
#include <thalweg/surface.hpp>

using namespace thalweg;

//! [generator]
/// Places stand in rows, each shifted by half a step against the next, so that no two ways cross.
StreamNetwork scheidegger(std::int64_t columns, std::int64_t rows, double step_m, std::uint64_t seed) {
    NetworkDraft draft;
    std::vector<NodeId> above;
    for (std::int64_t row = 0; row < rows; ++row) {
        bool const shifted = row % 2 != 0;
        std::vector<NodeId> here;
        for (std::int64_t column = 0; column < columns; ++column) {
            double const x = (static_cast<double>(column) + (shifted ? 1.0 : 0.5)) * step_m;
            here.push_back(draft.add_node({x, static_cast<double>(rows - row) * step_m}));
        }
        // Chance is a hash of seed and place: no generator that has to be passed around.
        for (std::int64_t column = 0; column < static_cast<std::int64_t>(above.size()); ++column) {
            std::int64_t const west = shifted ? column - 1 : column;
            bool const east =
                unit(random_word(seed, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(column))) < 0.5;
            std::int64_t const to = std::clamp<std::int64_t>(west + (east ? 1 : 0), 0, columns - 1);
            draft.add_arc(above[static_cast<std::size_t>(column)], here[static_cast<std::size_t>(to)]);
        }
        above = here;
    }
    return draft;
}
//! [generator]

int main() try {
    double const step_m = 300.0;
    StreamNetwork const grown = scheidegger(120, 200, step_m, 7);
    // Springs of less than four steps are no rivers; what joins end to end becomes one arc.
    StreamNetwork const plan = network::prune(grown, {.length_m = 4.0 * step_m, .cell_m = 30.0}).network;
    std::printf("%zu places, %zu arcs, %zu outlets\n", grown.node_count(), plan.arc_count(), plan.outlets().size());

    Grid const grid{1230, 2000, 30.0, -300.0, 60300.0, ""}; // the outlets lie on its southern edge
    NetworkOrders const orders = network::order(plan);
    flow::ContributingAreas const areas = flow::areas_nearest(plan, grid);
    measure::HortonLaws const laws = measure::horton(plan, orders, areas.ds_area_m2);
    std::printf("bifurcation ratio %.2f, length ratio %.2f\n", laws.bifurcation.value().ratio,
                laws.length.value().ratio);

    // Heights that are graded: the more a river drains, the flatter it runs. Then the land around it.
    network::GradedNetwork const raised =
        network::set_heights_graded(plan, areas.us_area_m2, areas.ds_area_m2, {.slope = 0.01, .least_area_m2 = 900.0});
    Valley const valley = network::rasterise(raised.network, grid).valley;
    surface::DilatedDem const land = surface::dilate(valley, {.relief_m = 300.0});
    std::printf("%.0f m of relief above the rivers, %lld cells in pits\n", land.rise_m,
                static_cast<long long>(flow::route(land.dem).pits));
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
