// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <support.hpp>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/order/order.hpp>

namespace test {

/// Two rivers that meet in the middle of 48 x 48 cells of 10 m and leave to the south, in a V-shaped land.
struct SmallLand {
    thalweg::Raster<float> dem;
    thalweg::Raster<std::uint8_t> hillshade;
    thalweg::ElevatedNetwork network;
    thalweg::NetworkOrders orders;
};

inline thalweg::Raster<float> slopes(thalweg::Grid const& grid) {
    return raster_of(grid, [&](Cell c) { return 4 * (grid.height - c.row) + 3 * std::abs(2 * c.col - grid.width); });
}

inline thalweg::Raster<std::uint8_t> shade(thalweg::Raster<float> const& dem) {
    thalweg::Raster<std::uint8_t> out(dem.grid());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        bool const west = 2 * dem.grid().at(i).col < dem.width();
        out[i] = static_cast<std::uint8_t>(std::isnan(dem[i]) ? 0 : west ? 130 : 220);
    }
    return out;
}

inline SmallLand small_land() {
    using namespace thalweg;
    SmallLand land;
    land.dem = slopes({48, 48, 10.0, 500000.0, 4500000.0, "EPSG:32631"});
    land.hillshade = shade(land.dem);
    NetworkDraft net;
    for (Vec2 const at : {Vec2{500065, 4499935}, Vec2{500415, 4499925}, Vec2{500235, 4499765}, Vec2{500235, 4499525}}) {
        net.add_node(at);
    }
    net.add_arc(0, 2);
    net.add_arc(1, 2);
    net.add_arc(2, 3);
    land.network.planform = std::move(net);
    land.network.node_z = {160, 150, 100, 4};
    land.network.arc_z = {{160, 100}, {150, 100}, {100, 4}};
    land.orders = network::order(land.network.planform);
    return land;
}

} // namespace test
