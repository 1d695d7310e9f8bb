// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/elevate_from_dem.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/lower_rises.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The nearest known height in one direction, and how far away it is.
struct Known {
    double z = unknown;
    double away_m = 0.0;
    Cell cell = {};
};

Known farther(Known at, double way_m) {
    return {at.z, at.away_m + way_m, at.cell};
}

double between(Known up, Known down) {
    if (std::isnan(up.z)) {
        return down.z;
    }
    double const way = up.away_m + down.away_m;
    return way > 0.0 ? down.z + (up.z - down.z) * (down.away_m / way) : down.z;
}

class Heights {
public:
    Heights(StreamNetwork const& network, Channels const& channels, Raster<float> const& land)
        : network_(network), land_(land), z_(network.arc_count()), up_(network.arc_count()) {
        Mask is_channel(channels.grid, 0);
        for (std::int64_t const cell : channels.cell) {
            is_channel[cell] = 1;
        }
        for (std::size_t i = 0; i < channels.level.size(); ++i) {
            if (channels.level[i] != 0) {
                lake_.insert(channels.cell[i]);
                lake_.insert(channels.cell[channels.receiver[i]]);
            }
        }
        for (std::size_t a = 0; a < network.arc_count(); ++a) {
            cells_.push_back(cells_of_vertices(line(a), channels.grid, fmt::format("arc {}", a + 1)));
        }
        for (std::size_t a = 0; a < network.arc_count(); ++a) {
            know(a, is_channel);
        }
    }

    std::vector<std::vector<double>> filled() {
        look_up();
        look_down();
        return std::move(z_);
    }

private:
    std::vector<Vec2> const& line(std::size_t a) const { return network_.arc(a).line; }

    double height(Cell cell) const {
        auto const z = static_cast<double>(land_[cell]);
        if (!std::isfinite(z)) {
            Vec2 const at = land_.grid().centre(cell);
            throw BadInput(fmt::format("network.elevate_from_dem: the land has no height at ({:.3f}, {:.3f}), where a "
                                       "river runs; let rivers end at the coast",
                                       at.x, at.y));
        }
        return z;
    }

    /// The heights that the land says itself. The last vertex of an arc is its node's business.
    void know(std::size_t a, Mask const& is_channel) {
        auto const& cells = cells_[a];
        bool const is_source = network_.in(network_.from(a)).empty();
        bool const is_last = network_.out(network_.to(a)) == no_arc;
        z_[a].assign(cells.size(), unknown);
        for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
            bool const in_last_cell = is_last && cells[i] == cells.back();
            if ((is_channel[cells[i]] != 0 && !in_last_cell) || (i == 0 && is_source)) {
                z_[a][i] = height(cells[i]);
            }
        }
        if (is_last) {
            z_[a].back() = height(cells.back());
        }
    }

    /// Whether a height says nothing beside the one above it: it is higher; or as high, of the same cell, to which
    /// lines may come back from below, or off a lake, where the water took another way.
    bool says_nothing(double z, Cell cell, Known above) const {
        return z > above.z || (z == above.z && (cell == above.cell || !lake_.contains(land_.grid().index(cell))));
    }

    /// Sources first: the nearest known height above each vertex; of several arcs' the lowest.
    void look_up() {
        std::vector<Known> above(network_.node_count());
        for (auto n = network_.upstream_order().rbegin(); n != network_.upstream_order().rend(); ++n) {
            if (network_.out(*n) == no_arc) {
                continue;
            }
            auto const a = network_.out(*n);
            Known at = above[*n];
            for (std::size_t i = 0; i < z_[a].size(); ++i) {
                at = farther(at, i == 0 ? 0.0 : distance(line(a)[i - 1], line(a)[i]));
                bool const is_outlet = i + 1 == z_[a].size() && network_.out(network_.to(a)) == no_arc;
                if (!is_outlet && says_nothing(z_[a][i], cells_[a][i], at)) {
                    z_[a][i] = unknown;
                }
                at = std::isnan(z_[a][i]) ? at : Known{z_[a][i], 0.0, cells_[a][i]};
                up_[a].push_back(at);
            }
            Known& below = above[network_.to(a)];
            bool const is_lower = at.z < below.z || (at.z == below.z && at.away_m < below.away_m);
            below = std::isnan(below.z) || is_lower ? at : below;
        }
    }

    /// Outlets first: what is not known lies between the heights above and below it.
    void look_down() {
        struct Node {
            Known below; ///< itself included
            double z = unknown;
        };
        std::vector<Node> nodes(network_.node_count());
        for (NodeId const n : network_.upstream_order()) {
            if (network_.out(n) == no_arc) {
                continue;
            }
            auto const a = network_.out(n);
            Known at =
                std::isnan(z_[a].back()) ? nodes[network_.to(a)].below : Known{z_[a].back(), 0.0, cells_[a].back()};
            if (std::isnan(z_[a].back())) {
                z_[a].back() = nodes[network_.to(a)].z;
            }
            for (std::size_t i = z_[a].size() - 1; i-- > 0;) {
                at = farther(at, distance(line(a)[i], line(a)[i + 1]));
                if (std::isnan(z_[a][i])) {
                    // At a node the arcs above agree on the lowest of what is known above them.
                    z_[a][i] = between(up_[a][i], at);
                } else {
                    at = {z_[a][i], 0.0, cells_[a][i]};
                }
            }
            nodes[n] = {at, z_[a].front()};
        }
    }

    StreamNetwork const& network_;
    Raster<float> const& land_;
    std::unordered_set<std::int64_t> lake_; ///< cells of lakes and of their outlets
    std::vector<std::vector<Cell>> cells_;  ///< by arc and vertex
    std::vector<std::vector<double>> z_;    ///< likewise
    std::vector<std::vector<Known>> up_;    ///< likewise: the nearest known height above, itself included
};

} // namespace

ElevatedNetwork elevate_from_dem(StreamNetwork const& network, Channels const& channels, Raster<float> const& land) {
    require_trees(network, "network.elevate_from_dem");
    if (land.grid() != channels.grid) {
        throw BadInput("network.elevate_from_dem: the land is not on the grid of the channels; give the land that was "
                       "made around them");
    }
    return lower_rises(network, Heights(network, channels, land).filled()).network;
}

} // namespace thalweg::network
