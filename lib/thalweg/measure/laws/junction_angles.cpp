// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/junction_angles.hpp>

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/laws/internal/mean_and_deviation.hpp>

namespace thalweg::measure {

namespace {

/// From the end of an arc to the place so far up its link; nothing where the link has not half of it.
std::optional<Vec2> chord_up(StreamNetwork const& network, std::size_t arc, double reach_m) {
    double left = reach_m;
    Vec2 const foot = network.node(network.to(arc)).at;
    Vec2 at = foot;
    for (std::size_t a = arc;;) {
        auto const& line = network.arc(a).line;
        for (std::size_t i = line.size() - 1; i-- > 0;) {
            double const step = distance(at, line[i]);
            if (step >= left) {
                double const share = left / step;
                return Vec2{at.x + share * (line[i].x - at.x) - foot.x, at.y + share * (line[i].y - at.y) - foot.y};
            }
            left -= step;
            at = line[i];
        }
        auto const& above = network.in(network.from(a));
        if (above.size() != 1) {
            break;
        }
        a = above.front();
    }
    return left > 0.5 * reach_m ? std::nullopt : std::optional(Vec2{at.x - foot.x, at.y - foot.y});
}

} // namespace

JunctionAngles junction_angles(StreamNetwork const& network, double reach_m) {
    if (!(reach_m > 0.0) || std::isinf(reach_m)) {
        throw BadParameter(fmt::format("measure.junction_angles: the reach is {} m; it must be above 0", reach_m));
    }
    JunctionAngles angles;
    angles.reach_m = reach_m;
    std::vector<double> degrees;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        auto const& above = network.in(n);
        if (above.size() < 2 || network.out(n) == no_arc) {
            continue;
        }
        auto const one = chord_up(network, above[0], reach_m);
        auto const other = chord_up(network, above[1], reach_m);
        auto const is_zero = [](Vec2 v) { return v == Vec2{}; };
        if (above.size() > 2 || !one || !other || is_zero(*one) || is_zero(*other)) {
            ++angles.left_out;
            continue;
        }
        double const cross = one->x * other->y - one->y * other->x;
        double const dot = one->x * other->x + one->y * other->y;
        degrees.push_back(portable::atan2(std::fabs(cross), dot) * (180.0 / portable::pi));
    }
    angles.junctions = static_cast<std::int64_t>(degrees.size());
    if (degrees.empty()) {
        return angles;
    }
    auto const [mean, deviation] = mean_and_deviation(degrees);
    angles.mean_deg = mean;
    angles.std_deg = deviation;
    return angles;
}

} // namespace thalweg::measure
