// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 1: where rivers run. Understand this one first.
// Grows a cluster, draws its skeleton, and counts its streams by order (Horton 1945): each order has several times
// fewer streams than the one below.
#include <cstdio>
#include <map>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/recipe/frame.hpp>

using namespace thalweg;

int main() {
    //! [verb]
    // A verb takes its input and its parameters, and gives a value. What is left out has a default, where one is right
    // for all.
    growth::Cluster const cluster = growth::grow_dla({.particles = 20000, .sticking = 0.85, .visits = 3, .seed = 7});
    //! [verb]

    //! [network]
    // One arm of the cluster becomes a basin: its mouth is the seed of the cluster.
    growth::Branch const branch = growth::pick_branch(cluster, {growth::BranchChoice::largest});

    // Up to here there were cells of a lattice; a grid gives them a place on the ground, 30 m a cell unless told
    // otherwise.
    recipe::FramedBranch const framed = recipe::frame_branch(branch, {});

    // The skeleton is one cell wide; traced, it is a graph of arcs that run downstream.
    Mask const skeleton = network::thin(framed.mask);
    StreamNetwork const traced = network::trace(skeleton, {framed.mouth});

    // Short leaves are burrs of the skeleton: none under 300 m, ten cells, is left.
    network::PrunedNetwork const pruned = network::prune(traced, {.length_m = 300.0, .cell_m = 30.0});
    NetworkOrders const orders = network::order(pruned.network);
    //! [network]

    //! [walk]
    // A stream begins where no arc of its own order flows in.
    std::map<int, int> streams;
    for (std::size_t arc = 0; arc < pruned.network.arc_count(); ++arc) {
        bool begins = true;
        for (ArcId const above : pruned.network.in(pruned.network.from(arc))) {
            begins = begins && orders.strahler[above] != orders.strahler[arc];
        }
        streams[orders.strahler[arc]] += begins ? 1 : 0;
    }
    //! [walk]

    std::printf("%lld particles, %lld arcs traced, %zu kept\n", static_cast<long long>(cluster.cells.size()),
                static_cast<long long>(pruned.arcs_before), pruned.network.arc_count());
    for (auto const& [order, count] : streams) {
        std::printf("order %d: %d %s\n", order, count, count == 1 ? "stream" : "streams");
    }
}
