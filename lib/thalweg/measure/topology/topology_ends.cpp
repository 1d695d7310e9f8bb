// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/strong_components.hpp>
#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

namespace thalweg::measure::topology_steps {
namespace {

// Arcs and their nodes: the file's ids, the positions, and the direction of flow.

Junctions junctions_of(NetworkFile const& file) {
    Junctions j;
    j.ids.reserve(file.nodes.size() + 2 * file.arcs.size());
    for (FileNode const& node : file.nodes) {
        j.ids.push_back(node.id);
    }
    for (FileArc const& arc : file.arcs) {
        j.ids.push_back(arc.from_node);
        j.ids.push_back(arc.to_node);
    }
    std::sort(j.ids.begin(), j.ids.end());
    j.ids.erase(std::unique(j.ids.begin(), j.ids.end()), j.ids.end());
    j.ids.shrink_to_fit();
    j.node.assign(j.ids.size(), none);
    j.repeated.assign(j.ids.size(), 0);
    for (std::size_t n = 0; n < file.nodes.size(); ++n) {
        std::size_t const at = j.of(file.nodes[n].id);
        j.repeated[at] = j.node[at] != none ? 1 : 0;
        j.node[at] = std::min(j.node[at], n);
    }
    return j;
}

/// Nodes by position; built only when the file's ids are wrong.
class NodePlaces {
public:
    NodePlaces(NetworkFile const& file, Junctions const& junctions) : file_(file), junctions_(junctions) {}

    /// The junction of a node exactly there, or none; of several, `preferred` if it is one of them.
    std::size_t at(Vec2 p, std::size_t preferred) {
        if (by_place_.empty()) {
            for (FileNode const& node : file_.nodes) {
                if (is_number(node.at.x) && is_number(node.at.y)) {
                    by_place_.emplace_back(node.at.x, node.at.y, junctions_.of(node.id));
                }
            }
            std::sort(by_place_.begin(), by_place_.end());
        }
        std::size_t found = none;
        for (auto i = std::lower_bound(by_place_.begin(), by_place_.end(), std::tuple(p.x, p.y, std::size_t{0}));
             i != by_place_.end() && std::get<0>(*i) == p.x && std::get<1>(*i) == p.y; ++i) {
            found = found == none || std::get<2>(*i) == preferred ? std::get<2>(*i) : found;
        }
        return found;
    }

private:
    NetworkFile const& file_;
    Junctions const& junctions_;
    std::vector<std::tuple<double, double, std::size_t>> by_place_;
};

bool same_bits(Vec3 p, Vec3 q, bool heights) {
    auto const same = [](double a, double b) {
        return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    return same(p.x, q.x) && same(p.y, q.y) && (!heights || same(p.z, q.z));
}

class EndCheck {
public:
    EndCheck(NetworkFile const& file, Joints& joints, Findings& findings)
        : file_(file), joints_(joints), findings_(findings), places_(file, joints.junctions) {}

    void look(std::size_t a, bool has_line) {
        FileArc const& arc = file_.arcs[a];
        bool const against = has_line && is_against(arc, joints_.said[a]);
        joints_.against[a] = against ? 1 : 0;
        for (std::size_t const end : {0U, 1U}) {
            bool const first = (end == 0) != against;
            Vec2 const start = start_of(arc);
            Vec3 const place = !has_line ? Vec3{start.x, start.y, 0.0} : first ? arc.line.front() : arc.line.back();
            joints_.meant[a][end] = look(a, end, place, has_line);
        }
    }

private:
    FileNode const* node(std::size_t junction) const {
        std::size_t const n = joints_.junctions.node[junction];
        return n == none ? nullptr : &file_.nodes[n];
    }

    bool is_against(FileArc const& arc, Ends ends) const {
        FileNode const* const from = node(ends[0]);
        FileNode const* const to = node(ends[1]);
        return from != nullptr && to != nullptr && plan_of(from->at) != plan_of(to->at) &&
               plan_of(arc.line.front()) == plan_of(to->at) && plan_of(arc.line.back()) == plan_of(from->at);
    }

    /// The junction that the end most likely belongs to.
    std::size_t look(std::size_t a, std::size_t end, Vec3 place, bool has_line) {
        FileArc const& arc = file_.arcs[a];
        std::size_t const said = joints_.said[a][end];
        std::int64_t const id = joints_.junctions.ids[said];
        char const* const which = end == 0 ? "from_node" : "to_node";
        FileNode const* const there = node(said);
        if (there == nullptr) {
            std::size_t const meant = has_line ? places_.at(plan_of(place), said) : none;
            bool const named_already = meant != none && joints_.junctions.repeated[meant] != 0;
            joints_.faulty[a][end] = 1;
            if (named_already) {
                return said; // the arcs of a node with a wrong id still agree on it
            }
            findings_.push_back(
                {"missing_node", number_of(file_, arc), plan_of(place), static_cast<double>(id),
                 fmt::format("arc {}: its {} {} is not among the nodes", number_of(file_, arc), which, id)});
            return meant == none ? said : meant;
        }
        if (!has_line || !is_number(there->at.x) || !is_number(there->at.y) ||
            (file_.says.heights && !is_number(there->at.z)) || same_bits(place, there->at, file_.says.heights)) {
            return said;
        }
        std::size_t const meant = places_.at(plan_of(place), said);
        if (meant == said && joints_.junctions.repeated[said] != 0) {
            return said;
        }
        double const dz = file_.says.heights ? place.z - there->at.z : 0.0;
        double const flat = distance(plan_of(place), plan_of(there->at));
        double const apart = std::sqrt(flat * flat + dz * dz);
        joints_.faulty[a][end] = 1;
        findings_.push_back(
            {"end_mismatch", number_of(file_, arc), plan_of(place), apart,
             fmt::format("arc {}: its end at ({}, {}, {}) lies {} m from {} {} at ({}, {}, {})", number_of(file_, arc),
                         place.x, place.y, place.z, apart, which, id, there->at.x, there->at.y, there->at.z)});
        return meant == none ? said : meant;
    }

    NetworkFile const& file_;
    Joints& joints_;
    Findings& findings_;
    NodePlaces places_;
};

/// By arc: whether all arcs linked to it by ds_arc indicate flow from its meant[1] to its meant[0].
std::vector<char> turned_by_links(NetworkFile const& file, std::vector<Ends> const& meant,
                                  std::vector<char> const& left_out, std::vector<char> const& ambiguous) {
    std::vector<char> turned(file.arcs.size(), 0);
    if (!file.says.downstream) {
        return turned;
    }
    std::vector<std::pair<std::int64_t, std::size_t>> ids;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (ambiguous[a] == 0 && left_out[a] == 0) {
            ids.emplace_back(file.arcs[a].id, a);
        }
    }
    std::sort(ids.begin(), ids.end());
    std::vector<std::array<bool, 2>> votes(file.arcs.size(), {false, false}); // as in the file, against it
    for (std::size_t up = 0; up < file.arcs.size(); ++up) {
        auto const next = std::lower_bound(ids.begin(), ids.end(), std::pair(file.arcs[up].ds_arc, std::size_t{0}));
        if (left_out[up] != 0 || next == ids.end() || next->first != file.arcs[up].ds_arc || next->second == up) {
            continue;
        }
        std::size_t const down = next->second;
        auto const touches = [&](std::size_t arc, std::size_t junction) {
            return meant[arc][0] == junction || meant[arc][1] == junction;
        };
        bool const up_by_its_end = touches(down, meant[up][1]);
        bool const up_by_its_start = touches(down, meant[up][0]);
        if (up_by_its_end != up_by_its_start) {
            votes[up][up_by_its_end ? 0 : 1] = true;
        }
        bool const down_by_its_start = touches(up, meant[down][0]);
        bool const down_by_its_end = touches(up, meant[down][1]);
        if (down_by_its_start != down_by_its_end) {
            votes[down][down_by_its_start ? 0 : 1] = true;
        }
    }
    for (std::size_t a = 0; a < turned.size(); ++a) {
        turned[a] = votes[a][1] && !votes[a][0] ? 1 : 0;
    }
    return turned;
}

// Ends that nearly meet something.

/// A source or outlet, and the arc that ends there.
struct LooseEnd {
    std::size_t junction;
    std::size_t arc;
    std::size_t end;
};

/// Sources and outlets whose arcs' ends have no reported fault.
std::vector<LooseEnd> loose_ends(Joints const& joints, Outlines const& plans, Graph const& graph) {
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

/// The feature that a loose end nearly meets.
struct Near {
    double apart = 0.0;
    std::size_t arc = none;      ///< the nearest
    std::size_t junction = none; ///< the nearest junction where an arc ends, with its arc and distance
    std::size_t ending = none;
    double from_junction = 0.0;
    bool touches = false; ///< lies on a segment or a vertex
};

Near nearest(LooseEnd const& end, std::vector<geometry::NearSegment> const& segments, Joints const& joints,
             Outlines const& plans, double near_m) {
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

// Whether the network is a forest.

/// Reports one finding for each group of arcs: its first arc and its size. part: by arc, the group or none.
void find_groups(NetworkFile const& file, std::vector<std::size_t> const& part, std::size_t parts, FindingKind kind,
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

/// Whether arcs remain after sources are removed repeatedly.
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
        return; // every path downstream ends at an outlet
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

    // Every arc inside a strongly connected component lies on a cycle.
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

std::size_t Junctions::of(std::int64_t id) const {
    return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

Joints check_ends(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out,
                  std::vector<char> const& ambiguous, Findings& findings) {
    std::size_t const arcs = file.arcs.size();
    Joints joints{junctions_of(file), {}, {}, std::vector<std::array<char, 2>>(arcs, {0, 0}), std::vector<char>(arcs)};
    joints.said.reserve(arcs);
    for (FileArc const& arc : file.arcs) {
        joints.said.push_back({joints.junctions.of(arc.from_node), joints.junctions.of(arc.to_node)});
    }
    joints.meant = joints.said;
    EndCheck check(file, joints, findings);
    for (std::size_t a = 0; a < arcs; ++a) {
        check.look(a, !plans[a].empty());
    }
    auto const turned = turned_by_links(file, joints.meant, left_out, ambiguous);
    for (std::size_t a = 0; a < arcs; ++a) {
        if (left_out[a] == 0 && (turned[a] != 0 || joints.against[a] != 0)) {
            FileArc const& arc = file.arcs[a];
            findings.push_back({"wrong_direction", number_of(file, arc), start_of(arc), length_of(plans[a]),
                                turned[a] == 0
                                    ? fmt::format("arc {}: is drawn from its to_node {} to its from_node {}",
                                                  number_of(file, arc), arc.to_node, arc.from_node)
                                    : fmt::format("arc {}: is said to run from node {} to {}, against the arcs that "
                                                  "ds_arc links it to",
                                                  number_of(file, arc), arc.from_node, arc.to_node)});
        }
        if (turned[a] != 0) {
            std::swap(joints.said[a][0], joints.said[a][1]);
            std::swap(joints.meant[a][0], joints.meant[a][1]);
            std::swap(joints.faulty[a][0], joints.faulty[a][1]);
            joints.against[a] = joints.against[a] == 0 ? 1 : 0;
        }
    }
    return joints;
}

void check_heights(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out,
                   Joints const& joints, Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (!file.says.heights || left_out[a] != 0 || plans[a].empty()) {
            continue;
        }
        auto const& line = file.arcs[a].line;
        double greatest_rise = 0.0;
        std::size_t rises_at = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const rise = joints.against[a] == 0 ? line[i].z - line[i - 1].z : line[i - 1].z - line[i].z;
            if (rise > greatest_rise) {
                greatest_rise = rise;
                rises_at = joints.against[a] == 0 ? i : i - 1;
            }
        }
        if (greatest_rise > 0.0) {
            Vec2 const at = plan_of(line[rises_at]);
            findings.push_back({"z_rising", number_of(file, file.arcs[a]), at, greatest_rise,
                                fmt::format("arc {}: runs uphill by {} m to vertex {} at ({}, {})",
                                            number_of(file, file.arcs[a]), greatest_rise, rises_at, at.x, at.y)});
        }
    }
}

void check_near_ends(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out, double near_m,
                     Joints& joints, Findings& findings, Run const& run) {
    std::size_t const junctions = joints.junctions.ids.size();
    auto const loose = loose_ends(joints, plans, Graph(joints.meant, left_out, junctions));
    std::vector<Vec2> places;
    places.reserve(loose.size());
    for (LooseEnd const& end : loose) {
        places.push_back(joints.place(end.arc, end.end, plans));
    }
    auto const segments = geometry::segments_near(places, plans, near_m, run);
    // a union-find forest: an end and the junction it nearly meets become one
    std::vector<std::size_t> same_as(junctions);
    std::iota(same_as.begin(), same_as.end(), std::size_t{0});
    auto const root = [&](std::size_t j) {
        while (same_as[j] != j) {
            j = same_as[j] = same_as[same_as[j]];
        }
        return j;
    };
    for (std::size_t i = 0; i < loose.size(); ++i) {
        if (segments[i].size() < 2) {
            continue; // its own junction
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
