// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/known_heights.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {
namespace {

double height_at(Raster<float> const& dem, Vec2 p) {
    Cell const cell = dem.grid().cell_of(p);
    float const z = dem.grid().contains(cell) ? dem[cell] : std::nanf("");
    refuse_if<BadInput>(
        !std::isfinite(z), "network.drape",
        "the DEM has no height at ({:.3f}, {:.3f}), where a river runs; give one that covers the network", p.x, p.y);
    return static_cast<double>(z);
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The nearest known height in one direction, and its distance.
struct KnownHeight {
    double z = unknown;
    double away_m = 0.0;
    Cell cell = {};
};

KnownHeight farther(KnownHeight at, double way_m) {
    return {at.z, at.away_m + way_m, at.cell};
}

double between(KnownHeight up, KnownHeight down) {
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
            throw BadInput(
                "network.elevate_from_dem",
                fmt::format(
                    "the land has no height at ({:.3f}, {:.3f}), where a river runs; let rivers end at the coast", at.x,
                    at.y));
        }
        return z;
    }

    /// Records heights given by the terrain. The last vertex of an arc is handled with its node.
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

    /// Whether a height adds no information to the one upstream: it is higher; or equal, in the same cell, to which
    /// lines may return from downstream, or off a lake, where the water took another path.
    bool adds_nothing(double z, Cell cell, KnownHeight above) const {
        return z > above.z || (z == above.z && (cell == above.cell || !lake_.contains(land_.grid().index(cell))));
    }

    /// Sources first: finds the nearest known height upstream of each vertex; of several arcs the lowest.
    void look_up() {
        std::vector<KnownHeight> above(network_.node_count());
        for (auto n = network_.upstream_order().rbegin(); n != network_.upstream_order().rend(); ++n) {
            if (network_.out(*n) == no_arc) {
                continue;
            }
            auto const a = network_.out(*n);
            KnownHeight at = above[*n];
            for (std::size_t i = 0; i < z_[a].size(); ++i) {
                at = farther(at, i == 0 ? 0.0 : distance(line(a)[i - 1], line(a)[i]));
                bool const is_outlet = i + 1 == z_[a].size() && network_.out(network_.to(a)) == no_arc;
                if (!is_outlet && adds_nothing(z_[a][i], cells_[a][i], at)) {
                    z_[a][i] = unknown;
                }
                at = std::isnan(z_[a][i]) ? at : KnownHeight{z_[a][i], 0.0, cells_[a][i]};
                up_[a].push_back(at);
            }
            KnownHeight& below = above[network_.to(a)];
            bool const is_lower = at.z < below.z || (at.z == below.z && at.away_m < below.away_m);
            below = std::isnan(below.z) || is_lower ? at : below;
        }
    }

    /// Outlets first: interpolates unknown heights between those upstream and downstream.
    void look_down() {
        struct Node {
            KnownHeight below; ///< the vertex itself included
            double z = unknown;
        };
        std::vector<Node> nodes(network_.node_count());
        for (NodeId const n : network_.upstream_order()) {
            if (network_.out(n) == no_arc) {
                continue;
            }
            auto const a = network_.out(n);
            KnownHeight at = std::isnan(z_[a].back()) ? nodes[network_.to(a)].below
                                                      : KnownHeight{z_[a].back(), 0.0, cells_[a].back()};
            if (std::isnan(z_[a].back())) {
                z_[a].back() = nodes[network_.to(a)].z;
            }
            for (std::size_t i = z_[a].size() - 1; i-- > 0;) {
                at = farther(at, distance(line(a)[i], line(a)[i + 1]));
                if (std::isnan(z_[a][i])) {
                    // At a node the arcs upstream share the lowest of their known heights.
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
    std::vector<std::vector<Cell>> cells_;  ///< by arc, by vertex
    std::vector<std::vector<double>> z_;    ///< by arc, by vertex
    std::vector<std::vector<KnownHeight>>
        up_; ///< by arc, by vertex: the nearest known height upstream, itself included
};

/// Tracks the slope of a river over its last stretch of known heights, downstream.
class OwnSlope {
public:
    explicit OwnSlope(double slope) : slope_(slope) {}

    void know(double z, double way_m) {
        stretch_.push_back({z, way_m});
        length_m_ += way_m;
        while (stretch_.size() > 2 && length_m_ - stretch_[1].way_m >= long_enough_m) {
            length_m_ -= stretch_[1].way_m;
            stretch_.pop_front();
        }
        if (stretch_.size() > 1) {
            slope_ = std::max((stretch_.front().z - z) / length_m_, 0.0);
        } else {
            length_m_ = 0.0;
        }
    }
    double value() const { return slope_; }

private:
    static constexpr double long_enough_m = 1000.0; // shorter stretches are dominated by noise
    struct KnownHeight {
        double z;
        double way_m; ///< from the previous one
    };
    std::deque<KnownHeight> stretch_;
    double length_m_ = 0.0;
    double slope_;
};

} // namespace

double noise_of_heights(double low_m, double high_m) {
    constexpr double least_m = 20.0;
    constexpr double share = 0.05;
    return std::max(least_m, share * (high_m - low_m));
}

LoweredNetwork lower_rises(StreamNetwork const& network, std::vector<std::vector<double>> const& arc_z) {
    require_trees(network, "network.lower_rises");
    bool whole = arc_z.size() == network.arc_count();
    for (std::size_t a = 0; whole && a < arc_z.size(); ++a) {
        whole = arc_z[a].size() == network.arc(a).line.size() && !arc_z[a].empty();
    }
    refuse_if<BadInput>(!whole, "network.lower_rises", "heights are not one for each vertex of {} arcs",
                        network.arc_count());
    LoweredNetwork lowered{{network, {}, arc_z}, std::vector<double>(arc_z.size(), 0.0)};
    auto& node_z = lowered.network.node_z;
    node_z.assign(network.node_count(), std::numeric_limits<double>::infinity());
    for (auto node = network.upstream_order().rbegin(); node != network.upstream_order().rend(); ++node) {
        ArcId const a = network.out(*node);
        if (a == no_arc) {
            continue;
        }
        auto& z = lowered.network.arc_z[a];
        double low = std::min(node_z[*node], z.front());
        node_z[*node] = low;
        for (double& vertex : z) {
            low = std::min(low, vertex);
            lowered.by_m[a] = std::max(lowered.by_m[a], vertex - low);
            vertex = low;
        }
        double& below = node_z[network.to(a)];
        below = std::min(below, low);
    }
    // The last vertex of an arc takes the common height of its node.
    for (std::size_t a = 0; a < arc_z.size(); ++a) {
        double& last = lowered.network.arc_z[a].back();
        double const z = node_z[network.to(a)];
        lowered.by_m[a] = std::max(lowered.by_m[a], last - z);
        last = z;
    }
    for (double& z : node_z) {
        z = z == std::numeric_limits<double>::infinity() ? 0.0 : z; // a node without arcs
    }
    return lowered;
}

ElevatedNetwork drape(StreamNetwork const& network, Raster<float> const& dem) {
    require_trees(network, "network.drape");
    ElevatedNetwork raised{network, {}, {}};
    raised.arc_z.resize(network.arc_count());
    for (NodeId n = 0; n < network.node_count(); ++n) {
        raised.node_z.push_back(height_at(dem, network.node(n).at));
    }
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) { // sources first
        ArcId const a = network.out(*n);
        if (a == no_arc) {
            continue;
        }
        double z = raised.node_z[*n];
        for (Vec2 const p : network.arc(a).line) {
            z = std::min(z, height_at(dem, p));
            raised.arc_z[a].push_back(z);
        }
        double& end = raised.node_z[network.to(a)];
        end = std::min(end, z);
    }
    for (std::size_t a = 0; a < network.arc_count(); ++a) { // another arc may be lower at the node
        raised.arc_z[a].back() = raised.node_z[network.to(a)];
    }
    return raised;
}

ElevatedNetwork elevate_from_dem(StreamNetwork const& network, Channels const& channels, Raster<float> const& land) {
    require_trees(network, "network.elevate_from_dem");
    require_same_grid(land.grid(), channels.grid, "network.elevate_from_dem", "the land and the channels",
                      "give the land that was made around them");
    return lower_rises(network, Heights(network, channels, land).filled()).network;
}

ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known) {
    std::map<std::pair<double, double>, double> height;
    for (std::size_t a = 0; a < known.planform.arc_count(); ++a) {
        auto const& line = known.planform.arc(a).line;
        for (std::size_t i = 0; i < line.size(); ++i) {
            height[{line[i].x, line[i].y}] = known.arc_z[a][i];
        }
    }
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    auto const height_at = [&](Vec2 p) {
        auto const at = height.find({p.x, p.y});
        return at == height.end() ? none : at->second;
    };

    ElevatedNetwork out;
    out.planform = network;
    out.arc_z.resize(network.arc_count());
    for (NodeId n = 0; n < network.node_count(); ++n) {
        out.node_z.push_back(height_at(network.node(n).at));
    }
    std::vector<double> slope_above(network.node_count(), 0.0); // of the lowest river that arrives
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) { // sources first
        ArcId const a = network.out(*n);
        if (a == no_arc) {
            continue;
        }
        auto const& line = network.arc(a).line;
        auto& z = out.arc_z[a];
        z.push_back(out.node_z[*n]);
        OwnSlope slope(slope_above[*n]);
        slope.know(z.back(), 0.0);
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const way_m = distance(line[i - 1], line[i]);
            double const given = height_at(line[i]);
            if (std::isnan(given)) {
                z.push_back(z.back() - slope.value() * way_m);
            } else {
                z.push_back(given);
                slope.know(given, way_m);
            }
        }
        refuse_if<BadInput>(
            std::isnan(z.back()), "network.keep_heights",
            "a river has no height at its source; give the lines Z, or choose another [network] heights");
        double& end = out.node_z[network.to(a)];
        if (std::isnan(end) || z.back() <= end) {
            end = z.back();
            slope_above[network.to(a)] = slope.value();
        }
    }
    // several arcs may be extended to one node: the lowest counts
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        out.arc_z[a].back() = out.node_z[network.to(a)];
    }
    return out;
}

} // namespace thalweg::network
