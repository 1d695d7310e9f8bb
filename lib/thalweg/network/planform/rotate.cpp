// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/rotate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t turn_stage = 0x7475726e; // "turn"

struct Extent {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    void enlarge(Vec2 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    Vec2 middle() const { return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}; }
};

/// Calls change for every position in a network.
template <class Change> void each_position(NetworkDraft& network, Change change) {
    for (Node& node : network.nodes) {
        change(node.at);
    }
    for (DraftArc& drawn : network.arcs) {
        for (Vec2& p : drawn.arc.line) {
            change(p);
        }
    }
}

Extent extent_of(NetworkDraft& network) {
    Extent box;
    each_position(network, [&](Vec2 const& p) { box.enlarge(p); });
    return box;
}

/// The grid around a box of cells if the frame has no size.
Grid grid_around(Grid grid, double wide_cells, double high_cells) {
    double const margin = std::max(2.0, std::ceil(std::max(wide_cells, high_cells) / 20.0));
    auto const side = [&](double cells) { return static_cast<std::int64_t>(std::ceil(cells + 2.0 * margin)); };
    grid.width = grid.width > 0 ? grid.width : side(wide_cells);
    grid.height = grid.height > 0 ? grid.height : side(high_cells);
    return grid;
}

} // namespace

double random_turn(std::uint64_t seed) {
    auto const words = random_block(seed, turn_stage);
    double const turn = 12.0 + 21.0 * unit(words[0]);
    return words[1] % 2 == 0 ? turn : -turn;
}

RotatedNetwork rotate(StreamNetwork const& network, Grid const& frame, RotateParams const& params) {
    require_in("network.rotate", "turn_deg", params.turn_deg, Range::between(-180.0, 180.0));
    refuse_if<BadInput>(network.arc_count() == 0, "network.rotate",
                        "the network has no arcs; trace or read some rivers first");
    require_trees(network, "network.rotate");
    RotatedNetwork out{{}, frame};
    NetworkDraft turned = network.draft();
    Vec2 const about = extent_of(turned).middle();
    double const turn = params.turn_deg / 180.0 * portable::pi;
    double const c = params.turn_deg == 0.0 ? 1.0 : portable::cos(turn);
    double const s = params.turn_deg == 0.0 ? 0.0 : portable::sin(turn);
    each_position(turned, [&](Vec2& p) {
        Vec2 const from{p.x - about.x, p.y - about.y};
        p = {c * from.x - s * from.y, s * from.x + c * from.y};
    });
    Extent const box = extent_of(turned);
    double const wide = (box.high.x - box.low.x) / frame.cell_m;
    double const high = (box.high.y - box.low.y) / frame.cell_m;
    out.grid = grid_around(frame, wide, high);
    refuse_if<BadInput>(wide > static_cast<double>(out.grid.width) || high > static_cast<double>(out.grid.height),
                        "network.rotate",
                        "the network is {:.1f} x {:.1f} cells when turned by {} degrees, the grid {} x {}; enlarge it, "
                        "or leave out width and height",
                        wide, high, params.turn_deg, out.grid.width, out.grid.height);
    Vec2 const middle{0.5 * (out.grid.west + out.grid.east()), 0.5 * (out.grid.north + out.grid.south())};
    each_position(turned, [&](Vec2& p) {
        p = {rounded(p.x - box.middle().x + middle.x), rounded(p.y - box.middle().y + middle.y)};
    });
    out.network = std::move(turned);
    return out;
}

} // namespace thalweg::network
