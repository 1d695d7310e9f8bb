// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

// Ends that nearly meet something.
namespace thalweg::measure::topology_steps {

namespace {

/// A source or outlet, and the arc that ends there.
struct LooseEnd {
    std::size_t junction;
    std::size_t arc;
    std::size_t end;
};

/// Sources and outlets whose arcs' ends have no fault yet.
std::vector<LooseEnd> loose_ends(Joints const& joints, Plans const& plans, Graph const& graph) {
    std::vector<LooseEnd> loose;
    for (std::size_t j = 0; j < joints.junctions.ids.size(); ++j) {
        auto const in = graph.in.at(j);
        auto const out = graph.out.at(j);
        if (in.empty() == out.empty()) {
            continue;
        }
        LooseEnd const end{j, in.empty() ? out[0] : in[0], in.empty() ? 0U : 1U};
        if (!plans[end.arc].empty() && joints.faulty[end.arc][end.end] == 0) {
            loose.push_back(end);
        }
    }
    return loose;
}

/// What a loose end nearly meets.
struct Near {
    double apart = 0.0;
    std::size_t arc = none;      ///< the nearest
    std::size_t junction = none; ///< the nearest in which an arc ends, with its arc and distance
    std::size_t ending = none;
    double from_junction = 0.0;
    bool touches = false; ///< lies on a segment, or on a vertex
};

Near nearest(LooseEnd const& end, std::vector<geometry::NearSegment> const& segments, Joints const& joints,
             Plans const& plans, double near_m) {
    Vec2 const p = joints.place(end.arc, end.end, plans);
    std::size_t const far_end = joints.meant[end.arc][1 - end.end];
    Near near;
    for (auto const& s : segments) {
        Ends const ends = joints.meant[s.line];
        bool const next_to_it =
            std::any_of(ends.begin(), ends.end(), [&](std::size_t j) { return j == end.junction || j == far_end; });
        if (s.line == end.arc || next_to_it) {
            continue;
        }
        Vec2 const a = plans[s.line][s.segment];
        Vec2 const b = plans[s.line][s.segment + 1];
        double const apart = distance(p, geometry::foot_on(a, b, p).at);
        bool const on_it = geometry::side_of_line(a, b, p) == 0 && std::min(a.x, b.x) <= p.x &&
                           p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
        near.touches = near.touches || on_it;
        if (near.arc == none || apart < near.apart) {
            near.arc = s.line;
            near.apart = apart;
        }
        for (std::size_t const e : {0U, 1U}) {
            Vec2 const place = joints.place(s.line, e, plans);
            double const away = distance(p, place);
            bool const is_here = place == a || place == b;
            if (is_here && away <= near_m && (near.junction == none || away < near.from_junction)) {
                near.junction = ends[e];
                near.ending = s.line;
                near.from_junction = away;
            }
        }
    }
    return near;
}

} // namespace

void check_near_ends(NetworkFile const& file, Plans const& plans, std::vector<char> const& left_out, double near_m,
                     Joints& joints, Findings& findings, Run const& run) {
    std::size_t const junctions = joints.junctions.ids.size();
    auto const loose = loose_ends(joints, plans, Graph(joints.meant, left_out, junctions));
    std::vector<Vec2> places;
    places.reserve(loose.size());
    for (LooseEnd const& end : loose) {
        places.push_back(joints.place(end.arc, end.end, plans));
    }
    auto const segments = geometry::segments_near(places, plans, near_m, run);
    std::vector<std::size_t> same_as(junctions); // a forest: an end and what it nearly meets are one junction
    std::iota(same_as.begin(), same_as.end(), std::size_t{0});
    auto const root = [&](std::size_t j) {
        while (same_as[j] != j) {
            j = same_as[j] = same_as[same_as[j]];
        }
        return j;
    };
    for (std::size_t i = 0; i < loose.size(); ++i) {
        if (segments[i].size() < 2) {
            continue; // its own
        }
        LooseEnd const& end = loose[i];
        Near const near = nearest(end, segments[i], joints, plans, near_m);
        if (near.arc == none) {
            continue;
        }
        FileArc const& arc = file.arcs[end.arc];
        Vec2 const at = places[i];
        if (near.junction != none && near.from_junction == 0.0) {
            FileArc const& other = file.arcs[near.ending];
            findings.push_back({"touches", number_of(file, arc), at, static_cast<double>(number_of(file, other)),
                                fmt::format("arc {}: ends at ({}, {}), where arc {} does, but they have no common node",
                                            number_of(file, arc), at.x, at.y, number_of(file, other))});
        } else if (!near.touches) {
            std::size_t const towards = near.junction != none ? near.ending : near.arc;
            double const apart = near.junction != none ? near.from_junction : near.apart;
            findings.push_back(
                {"dangling_end", number_of(file, arc), at, apart,
                 fmt::format("arc {}: its end at ({}, {}) lies {} m from arc {} without meeting it",
                             number_of(file, arc), at.x, at.y, apart, number_of(file, file.arcs[towards]))});
        }
        joints.faulty[end.arc][end.end] = 1;
        if (near.junction != none) {
            auto const [least, other] = std::minmax({root(end.junction), root(near.junction)});
            same_as[other] = least;
        }
    }
    for (Ends& ends : joints.meant) {
        ends = {root(ends[0]), root(ends[1])};
    }
}

} // namespace thalweg::measure::topology_steps
