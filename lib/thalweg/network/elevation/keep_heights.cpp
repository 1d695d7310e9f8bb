// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/keep_heights.hpp>

#include <thalweg/core/run/error.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <utility>

namespace thalweg::network {

namespace {

/// How a river falls over its last stretch of known heights, while it is followed downstream.
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
    static constexpr double long_enough_m = 1000.0; // noise of heights does not count
    struct Known {
        double z;
        double way_m; ///< from the one before
    };
    std::deque<Known> stretch_;
    double length_m_ = 0.0;
    double slope_;
};

} // namespace

ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known) {
    std::map<std::pair<double, double>, double> height;
    for (std::size_t a = 0; a < known.plan.arc_count(); ++a) {
        auto const& line = known.plan.arc(a).line;
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
    out.plan = network;
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
        if (std::isnan(z.back())) {
            throw BadInput("network.keep_heights: a river has no height at its source; give the lines Z, or choose "
                           "another [network] heights");
        }
        double& end = out.node_z[network.to(a)];
        if (std::isnan(end) || z.back() <= end) {
            end = z.back();
            slope_above[network.to(a)] = slope.value();
        }
    }
    for (std::size_t a = 0; a < network.arc_count(); ++a) { // several arcs may carry on to one node: its lowest counts
        out.arc_z[a].back() = out.node_z[network.to(a)];
    }
    return out;
}

} // namespace thalweg::network
