// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/strong_components.hpp>
#include <fmt/format.h>

#include <thalweg/measure/topology/internal/topology_steps.hpp>

// Whether the network is a forest.
namespace thalweg::measure::topology_steps {

namespace {

/// One finding for each group of arcs: its first arc, and how many it has. part: by arc, the group or none.
void find_groups(NetworkFile const& file, std::vector<std::size_t> const& part, std::size_t parts, char const* kind,
                 char const* what, Findings& findings) {
    std::vector<std::int64_t> size(parts, 0);
    for (std::size_t const p : part) {
        if (p != none) {
            ++size[p];
        }
    }
    for (std::size_t a = 0; a < part.size(); ++a) {
        if (part[a] != none && size[part[a]] > 0) {
            FileArc const& arc = file.arcs[a];
            Vec2 const at = start_of(arc);
            findings.push_back({kind, number_of(file, arc), at, static_cast<double>(size[part[a]]),
                                fmt::format("arc {}: {} ({} arcs, one at ({}, {}))", number_of(file, arc), what,
                                            size[part[a]], at.x, at.y)});
            size[part[a]] = 0;
        }
    }
}

/// Whether arcs remain when again and again the sources are taken away.
bool has_cycle(Graph const& graph, std::size_t junctions) {
    std::vector<std::size_t> awaited(junctions);
    std::vector<std::size_t> ready;
    for (std::size_t j = 0; j < junctions; ++j) {
        awaited[j] = graph.in.at(j).size();
        if (awaited[j] == 0) {
            ready.push_back(j);
        }
    }
    for (std::size_t i = 0; i < ready.size(); ++i) {
        for (std::size_t const a : graph.out.at(ready[i])) {
            if (--awaited[graph.ends[a][1]] == 0) {
                ready.push_back(graph.ends[a][1]);
            }
        }
    }
    return ready.size() < junctions;
}

void check_cycles(NetworkFile const& file, Graph const& graph, std::size_t junctions, Findings& findings) {
    if (!has_cycle(graph, junctions)) {
        return; // and every way down ends in an outlet
    }
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> directed(junctions);
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> undirected(junctions);
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (graph.left_out[a] == 0) {
            boost::add_edge(graph.ends[a][0], graph.ends[a][1], directed);
            boost::add_edge(graph.ends[a][0], graph.ends[a][1], undirected);
        }
    }
    std::vector<std::size_t> part(junctions);
    auto const part_map = boost::make_iterator_property_map(part.begin(), boost::get(boost::vertex_index, directed));
    std::vector<std::size_t> arc_part(file.arcs.size(), none);

    // Every arc inside a strong component lies on a cycle.
    std::size_t const strong = boost::strong_components(directed, part_map);
    for (std::size_t a = 0; a < arc_part.size(); ++a) {
        auto const [from, to] = graph.ends[a];
        arc_part[a] = graph.left_out[a] == 0 && part[from] == part[to] ? part[from] : none;
    }
    find_groups(file, arc_part, strong, "cycle", "runs in a circle", findings);

    std::size_t const weak = boost::connected_components(undirected, part_map);
    std::vector<char> drained(weak, 0);
    for (std::size_t j = 0; j < junctions; ++j) {
        if (graph.out.at(j).empty()) {
            drained[part[j]] = 1;
        }
    }
    for (std::size_t a = 0; a < arc_part.size(); ++a) {
        std::size_t const p = part[graph.ends[a][0]];
        arc_part[a] = graph.left_out[a] == 0 && drained[p] == 0 ? p : none;
    }
    find_groups(file, arc_part, weak, "no_outlet", "belongs to a part of the network that has no outlet", findings);
}

} // namespace

Incidence::Incidence(std::vector<Ends> const& ends, std::size_t end, std::vector<char> const& left_out,
                     std::size_t junctions)
    : first_(junctions + 1, 0) {
    for (std::size_t a = 0; a < ends.size(); ++a) {
        if (left_out[a] == 0) {
            ++first_[ends[a][end] + 1];
        }
    }
    for (std::size_t j = 0; j < junctions; ++j) {
        first_[j + 1] += first_[j];
    }
    arcs_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t a = 0; a < ends.size(); ++a) {
        if (left_out[a] == 0) {
            arcs_[next[ends[a][end]]++] = a;
        }
    }
}

void check_trees(NetworkFile const& file, Joints const& joints, Graph const& said, Findings& findings) {
    std::size_t const junctions = joints.junctions.ids.size();
    std::vector<char> has_arc(junctions, 0);
    for (auto const* ends : {&joints.said, &joints.meant}) {
        for (auto const [from, to] : *ends) {
            has_arc[from] = has_arc[to] = 1;
        }
    }
    for (std::size_t j = 0; j < junctions; ++j) {
        std::int64_t const id = joints.junctions.ids[j];
        std::size_t const n = joints.junctions.node[j];
        auto const out = said.out.at(j);
        Vec3 const node = n == none ? Vec3{} : file.nodes[n].at;
        Vec2 const at = n != none && is_number(node.x) && is_number(node.y) ? plan_of(node)
                        : out.empty()                                       ? Vec2{}
                                                                            : start_of(file.arcs[out.front()]);
        if (out.size() > 1) {
            findings.push_back(
                {"several_outflows", id, at, static_cast<double>(out.size()),
                 fmt::format("node {}: {} arcs leave it at ({}, {}), among them {} and {}", id, out.size(), at.x, at.y,
                             number_of(file, file.arcs[out[0]]), number_of(file, file.arcs[out[1]]))});
        }
        if (has_arc[j] == 0) {
            findings.push_back({"isolated_node", id, at, 0.0,
                                fmt::format("node {}: no arc begins or ends in it, at ({}, {})", id, at.x, at.y)});
        }
    }
    check_cycles(file, said, junctions, findings);
}

} // namespace thalweg::measure::topology_steps
