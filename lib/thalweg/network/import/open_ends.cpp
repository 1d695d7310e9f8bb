// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/open_ends.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>

namespace thalweg::network {
namespace {

/// [m] 0 outside the grid
double distance_to_border(Vec2 p, Grid const& grid) {
    return std::max(0.0, std::min({p.x - grid.west, grid.east() - p.x, p.y - grid.south(), grid.north - p.y}));
}

/// Whether a line is met by the straight way between two places, other than at these.
bool is_met_between(std::vector<Vec2> const& line, Vec2 from, Vec2 to) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        Vec2 const a = line[i];
        Vec2 const b = line[i + 1];
        if (a != from && b != from && a != to && b != to && (cross(from, to, a) > 0.0) != (cross(from, to, b) > 0.0) &&
            (cross(a, b, from) > 0.0) != (cross(a, b, to) > 0.0)) {
            return true;
        }
    }
    return false;
}

} // namespace

std::vector<GapBelow> gaps_below(StreamNetwork const& network, Grid const& grid, double most_cells, Run const& run) {
    double const small_m = 2.0 * grid.cell_m;
    double const most_m = most_cells * grid.cell_m;
    double const mouths_m = 5.0 * grid.cell_m;
    std::vector<std::vector<Vec2>> lines;
    for (Arc const& arc : network.arcs()) {
        lines.push_back(arc.line);
    }
    std::vector<NodeId> const& outlets = network.outlets();
    std::vector<Vec2> at;
    for (NodeId const outlet : outlets) {
        at.push_back(network.node(outlet).at);
    }
    auto const near = geometry::segments_near(at, lines, most_m, run);
    std::vector<GapBelow> gaps;
    for (std::size_t k = 0; k < outlets.size(); ++k) {
        double const border_m = distance_to_border(at[k], grid);
        std::optional<GapBelow> gap;
        for (geometry::NearSegment const& s : near[k]) {
            std::int64_t const basin = network.basin(network.to(s.line));
            Vec2 const mouth = network.node(outlets[static_cast<std::size_t>(basin - 1)]).at;
            auto const& line = lines[s.line];
            double const gap_m = distance(at[k], geometry::foot_on(line[s.segment], line[s.segment + 1], at[k]).at);
            bool const begins = network.in(network.from(s.line)).empty() && distance(line.front(), at[k]) == gap_m;
            if (basin != network.basin(outlets[k]) && gap_m < border_m && (gap_m <= small_m || begins) &&
                distance(mouth, at[k]) > mouths_m + gap_m && (!gap || gap_m < gap->gap_m)) {
                gap = GapBelow{outlets[k], gap_m};
            }
        }
        if (gap) {
            gaps.push_back(*gap);
        }
    }
    return gaps;
}

std::vector<Hollow> hollows(StreamNetwork const& network, Grid const& grid, Run const& run) {
    double const least_m = 2.0 * grid.cell_m; // nearer ones are gaps
    double const most_m = 50.0 * grid.cell_m;
    std::vector<NodeId> sources;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.in(n).empty() && network.out(n) != no_arc) {
            sources.push_back(n);
        }
    }
    std::map<NodeId, Hollow> found;
    for (NodeId const outlet : network.outlets()) {
        run.check();
        Vec2 const at = network.node(outlet).at;
        double const border_m = distance_to_border(at, grid);
        auto const& last = network.arc(network.in(outlet).front()).line;
        Vec2 const ahead = at - last[last.size() - 2];
        std::optional<NodeId> nearest;
        double nearest_m = border_m;
        for (NodeId const source : sources) {
            Vec2 const way = network.node(source).at - at;
            double const m = norm(way);
            auto const& first = network.arc(network.out(source)).line;
            bool const leads_on = dot(way, ahead) > 0.0 && dot(way, first[1] - first[0]) > 0.0;
            if (m > least_m && m < nearest_m && leads_on && network.basin(source) != network.basin(outlet)) {
                nearest = source;
                nearest_m = m;
            }
        }
        bool const is_seen = nearest && std::ranges::none_of(network.arcs(), [&](Arc const& arc) {
                                 return is_met_between(arc.line, at, network.node(*nearest).at);
                             });
        if (is_seen) {
            Hollow& hollow = found[*nearest];
            hollow.source = *nearest;
            hollow.ends.push_back(outlet);
            hollow.farthest_m = std::max(hollow.farthest_m, nearest_m);
        }
    }
    std::vector<Hollow> result;
    for (auto const& [source, hollow] : found) {
        if (hollow.ends.size() > 1 || hollow.farthest_m <= most_m) {
            result.push_back(hollow);
        }
    }
    return result;
}

double distance_to_lakes(Vec2 p, std::vector<Polygon> const& lakes) {
    double least_m = std::numeric_limits<double>::infinity();
    for (Polygon const& lake : lakes) {
        std::vector<Vec2> const& shore = lake.rings.front();
        for (std::size_t i = 0; i < shore.size(); ++i) {
            least_m = std::min(least_m, distance(p, geometry::foot_on(shore[i], shore[(i + 1) % shore.size()], p).at));
        }
        least_m = geometry::contains(shore, p) ? 0.0 : least_m;
    }
    return least_m;
}

} // namespace thalweg::network
