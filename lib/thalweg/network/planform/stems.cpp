// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/meander.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::network {

namespace {

/// By node the arc whose river goes on below it, no_arc at sources.
std::vector<ArcId> main_arcs(StreamNetwork const& network, std::vector<double> const& area_m2) {
    std::vector<ArcId> out(network.node_count(), no_arc);
    for (NodeId n = 0; n < out.size(); ++n) {
        for (ArcId const a : network.in(n)) {
            if (out[n] == no_arc || area_m2[a] > area_m2[out[n]]) {
                out[n] = a;
            }
        }
    }
    return out;
}

void add_point(Stems& out, Vec2 at, double area_m2) {
    bool const first = out.at.size() == out.stems.back().begin;
    out.way_m.push_back(first ? 0.0 : out.way_m.back() + distance(out.at.back(), at));
    out.at.push_back(at);
    out.area_m2.push_back(area_m2);
    out.stem_of.push_back(out.stems.size() - 1);
}

/// Adds an arc's points; its first is there already where the stem goes on.
void add_arc_points(Stems& out, std::vector<Vec2> const& line, double area_m2, double step_m) {
    if (out.at.size() == out.stems.back().begin) {
        add_point(out, line.front(), area_m2);
    }
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (line[i] == line[i - 1]) {
            continue;
        }
        auto const [count, step] = steps_between(line[i - 1], line[i], step_m);
        for (double k = 1.0; k < count; k += 1.0) {
            add_point(out, {line[i - 1].x + k * step.x, line[i - 1].y + k * step.y}, area_m2);
        }
        add_point(out, line[i], area_m2);
    }
}

} // namespace

EvenSteps steps_between(Vec2 from, Vec2 to, double step_m) {
    // A lattice's diagonal steps stay whole.
    double const count = std::ceil(distance(from, to) / (1.5 * step_m));
    return {count, {(to.x - from.x) / count, (to.y - from.y) / count}};
}

Stems stems_of(StreamNetwork const& network, std::vector<double> const& area_m2, double step_m) {
    Stems out;
    out.first_point.resize(network.arc_count());
    out.last_point.resize(network.arc_count());
    out.node_point.resize(network.node_count());
    std::vector<ArcId> const main = main_arcs(network, area_m2);
    for (NodeId const mouth : network.upstream_order()) { // every stem after what it joins
        bool const is_outlet = network.out(mouth) == no_arc;
        std::vector<ArcId> arriving(network.in(mouth).begin(), network.in(mouth).end());
        std::stable_partition(arriving.begin(), arriving.end(), [&](ArcId a) { return a == main[mouth]; });
        for (ArcId const last : arriving) {
            if (!is_outlet && last == main[mouth]) {
                continue; // it is the middle of a stem
            }
            std::vector<ArcId> arcs;
            for (ArcId a = last; a != no_arc; a = main[network.from(a)]) {
                arcs.push_back(a);
            }
            std::reverse(arcs.begin(), arcs.end());
            bool const owns_mouth = is_outlet && last == main[mouth];
            out.stems.push_back({out.at.size(), 0, network.from(arcs.front()), mouth, !owns_mouth});
            for (std::size_t const a : arcs) {
                add_arc_points(out, network.arc(a).line, area_m2[a], step_m);
                out.last_point[a] = out.at.size() - 1;
                out.first_point[a] = a == arcs.front() ? out.stems.back().begin : out.node_point[network.from(a)];
                out.node_point[network.from(a)] = out.first_point[a];
                if (a != arcs.back() || owns_mouth) {
                    out.node_point[network.to(a)] = out.last_point[a];
                }
            }
            out.stems.back().end = out.at.size();
        }
    }
    return out;
}

} // namespace thalweg::network
