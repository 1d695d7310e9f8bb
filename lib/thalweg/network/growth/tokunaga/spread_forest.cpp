// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

#include <algorithm>
#include <utility>

#include <thalweg/network/growth/tokunaga/internal/forest_layout.hpp>

namespace thalweg::network {

namespace {

// Sweeps after each order. The lowest comes last and holds most of the links; no other stream is placed by its courses.
constexpr int sweeps_of_an_order = 60;
constexpr int sweeps_of_the_last = 40;

int highest_order(Forest const& forest) {
    int highest = 1;
    for (ForestLink const& link : forest.links) {
        highest = std::max(highest, link.order);
    }
    return highest;
}

} // namespace

std::vector<Vec2> spread_forest(Forest const& forest, Run const& run) {
    ForestLayout layout(forest);
    for (int order = highest_order(forest); order >= 1; --order) {
        admit_streams(layout, order);
        int const sweeps = order == 1 ? sweeps_of_the_last : sweeps_of_an_order;
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            run.check();
            relax_nodes(layout, order, sweep, static_cast<double>(sweep) / sweeps);
        }
    }
    layout.at.resize(layout.links);
    return std::move(layout.at);
}

} // namespace thalweg::network
