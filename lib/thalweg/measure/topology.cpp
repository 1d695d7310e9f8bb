// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/strong_components.hpp>
#include <fmt/format.h>

#include <thalweg/geometry/crossings.hpp>

namespace thalweg::measure {

namespace {

using FileArc = NetworkFile::FileArc;
using FileNode = NetworkFile::FileNode;
using Findings = std::vector<Finding>;

constexpr std::array kinds = {
    "empty",        "bad_arc_id",      "duplicate_arc_id",  "duplicate_node_id", "null_geometry",
    "nan",          "zero_length",     "repeated_vertex",   "z_rising",          "duplicate_geometry",
    "missing_node", "end_mismatch",    "several_outflows",  "isolated_node",     "cycle",
    "no_outlet",    "ds_arc_mismatch", "strahler_mismatch", "shreve_mismatch",   "basin_mismatch",
    "not_simple",   "crossing"};

constexpr double greatest_coordinate = 1e18;

/// The file's graph with places instead of ids: a junction for every node_id, whether a node, an arc or both name it.
struct Graph {
    std::vector<std::int64_t> ids;             ///< by junction: node_id, ascending
    std::vector<FileNode const*> nodes;        ///< by junction: the first node of that id, null for none
    std::vector<std::size_t> from;             ///< by arc: junction
    std::vector<std::size_t> to;               ///< by arc: junction
    std::vector<std::vector<std::size_t>> in;  ///< by junction: arcs, ascending
    std::vector<std::vector<std::size_t>> out; ///< by junction: arcs, ascending
};

Graph graph_of(NetworkFile const& file) {
    Graph g;
    for (FileNode const& node : file.nodes) {
        g.ids.push_back(node.id);
    }
    for (FileArc const& arc : file.arcs) {
        g.ids.push_back(arc.from_node);
        g.ids.push_back(arc.to_node);
    }
    std::sort(g.ids.begin(), g.ids.end());
    g.ids.erase(std::unique(g.ids.begin(), g.ids.end()), g.ids.end());
    auto const junction = [&](std::int64_t id) {
        return static_cast<std::size_t>(std::lower_bound(g.ids.begin(), g.ids.end(), id) - g.ids.begin());
    };
    g.nodes.resize(g.ids.size(), nullptr);
    g.in.resize(g.ids.size());
    g.out.resize(g.ids.size());
    for (FileNode const& node : file.nodes) {
        FileNode const*& known = g.nodes[junction(node.id)];
        known = known == nullptr ? &node : known;
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        g.from.push_back(junction(file.arcs[a].from_node));
        g.to.push_back(junction(file.arcs[a].to_node));
        g.out[g.from[a]].push_back(a);
        g.in[g.to[a]].push_back(a);
    }
    return g;
}

bool is_number(double c) {
    return std::fabs(c) < greatest_coordinate;
}
bool is_number(Vec3 p) {
    return is_number(p.x) && is_number(p.y) && is_number(p.z);
}
Vec2 plan(Vec3 p) {
    return {p.x, p.y};
}

/// A place to point at: the first vertex that is one.
Vec2 start_of(FileArc const& arc) {
    auto const p =
        std::find_if(arc.line.begin(), arc.line.end(), [](Vec3 v) { return is_number(v.x) && is_number(v.y); });
    return p == arc.line.end() ? Vec2{} : plan(*p);
}

/// No vertex at all, or one, or one that is no number: nothing more can be said of such a line.
bool is_usable(FileArc const& arc) {
    return arc.line.size() >= 2 && std::all_of(arc.line.begin(), arc.line.end(), [](Vec3 p) { return is_number(p); });
}

/// The line in plan, each vertex once in a row.
std::vector<Vec2> plan_of(FileArc const& arc) {
    std::vector<Vec2> line;
    for (Vec3 const p : arc.line) {
        if (line.empty() || !(line.back() == plan(p))) {
            line.push_back(plan(p));
        }
    }
    return line;
}

void find_repeated_ids(std::vector<std::pair<std::int64_t, Vec2>> features, char const* kind, char const* noun,
                       Findings& findings) {
    std::stable_sort(features.begin(), features.end(), [](auto const& p, auto const& q) { return p.first < q.first; });
    for (auto first = features.begin(); first != features.end();) {
        auto const last = std::find_if(first, features.end(), [&](auto const& p) { return p.first != first->first; });
        if (last - first > 1) {
            auto const again = std::next(first);
            findings.push_back({kind, first->first, again->second, static_cast<double>(last - first),
                                fmt::format("{} {}: {} {}s have this id, the second at ({}, {})", noun, first->first,
                                            last - first, noun, again->second.x, again->second.y)});
        }
        first = last;
    }
}

void check_ids(NetworkFile const& file, Findings& findings) {
    std::vector<std::pair<std::int64_t, Vec2>> arcs;
    for (FileArc const& arc : file.arcs) {
        arcs.emplace_back(arc.id, start_of(arc));
        if (arc.id < 1) {
            findings.push_back({"bad_arc_id", arc.id, start_of(arc), static_cast<double>(arc.id),
                                fmt::format("arc {}: ids of arcs start at 1", arc.id)});
        }
    }
    std::vector<std::pair<std::int64_t, Vec2>> nodes;
    for (FileNode const& node : file.nodes) {
        nodes.emplace_back(node.id, is_number(node.at) ? plan(node.at) : Vec2{});
    }
    find_repeated_ids(std::move(arcs), "duplicate_arc_id", "arc", findings);
    find_repeated_ids(std::move(nodes), "duplicate_node_id", "node", findings);
}

void check_vertices(FileArc const& arc, Findings& findings) {
    std::size_t repeated = 0;
    std::size_t first_repeated = 0;
    double greatest_rise = 0.0;
    std::size_t rises_at = 0;
    for (std::size_t i = 1; i < arc.line.size(); ++i) {
        if (plan(arc.line[i]) == plan(arc.line[i - 1])) {
            first_repeated = repeated == 0 ? i : first_repeated;
            ++repeated;
        }
        if (double const rise = arc.line[i].z - arc.line[i - 1].z; rise > greatest_rise) {
            greatest_rise = rise;
            rises_at = i;
        }
    }
    if (length_of(plan_of(arc)) <= 0.0) {
        findings.push_back({"zero_length", arc.id, start_of(arc), 0.0,
                            fmt::format("arc {}: has no length, its {} vertices lie at ({}, {})", arc.id,
                                        arc.line.size(), arc.line[0].x, arc.line[0].y)});
    } else if (repeated > 0) {
        Vec2 const at = plan(arc.line[first_repeated]);
        findings.push_back({"repeated_vertex", arc.id, at, static_cast<double>(repeated),
                            fmt::format("arc {}: vertex {} at ({}, {}) repeats the one before it ({} such)", arc.id,
                                        first_repeated, at.x, at.y, repeated)});
    }
    if (greatest_rise > 0.0) {
        Vec2 const at = plan(arc.line[rises_at]);
        findings.push_back({"z_rising", arc.id, at, greatest_rise,
                            fmt::format("arc {}: runs uphill by {} m to vertex {} at ({}, {})", arc.id, greatest_rise,
                                        rises_at, at.x, at.y)});
    }
}

void check_geometry(NetworkFile const& file, Findings& findings) {
    for (FileArc const& arc : file.arcs) {
        auto const bad = std::count_if(arc.line.begin(), arc.line.end(), [](Vec3 p) { return !is_number(p); });
        if (arc.line.size() < 2) {
            findings.push_back({"null_geometry", arc.id, start_of(arc), static_cast<double>(arc.line.size()),
                                fmt::format("arc {}: has no line ({} vertices)", arc.id, arc.line.size())});
        }
        if (bad > 0) {
            findings.push_back(
                {"nan", arc.id, start_of(arc), static_cast<double>(bad),
                 fmt::format("arc {}: {} of its {} vertices have coordinates that are no numbers below {}", arc.id, bad,
                             arc.line.size(), greatest_coordinate)});
        }
        if (is_usable(arc)) {
            check_vertices(arc, findings);
        }
    }
    for (FileNode const& node : file.nodes) {
        if (!is_number(node.at)) {
            findings.push_back({"nan",
                                node.id,
                                {},
                                1.0,
                                fmt::format("node {}: its coordinates ({}, {}, {}) are no numbers below {}", node.id,
                                            node.at.x, node.at.y, node.at.z, greatest_coordinate)});
        }
    }
}

/// By arc: whether it runs, either way, over the vertices of an earlier one.
std::vector<char> check_duplicates(NetworkFile const& file, Findings& findings) {
    struct Line {
        std::vector<std::pair<double, double>> vertices; ///< in the lesser of both directions
        std::size_t arc;
    };
    std::vector<Line> lines;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (!is_usable(file.arcs[a])) {
            continue;
        }
        std::vector<std::pair<double, double>> there;
        for (Vec2 const p : plan_of(file.arcs[a])) {
            there.emplace_back(p.x, p.y);
        }
        std::vector<std::pair<double, double>> back(there.rbegin(), there.rend());
        lines.push_back({std::min(std::move(there), std::move(back)), a});
    }
    std::sort(lines.begin(), lines.end(),
              [](Line const& p, Line const& q) { return std::tie(p.vertices, p.arc) < std::tie(q.vertices, q.arc); });
    std::vector<char> repeats(file.arcs.size(), 0);
    for (std::size_t i = 1, first = 0; i < lines.size(); ++i) {
        if (lines[i].vertices != lines[first].vertices) {
            first = i;
            continue;
        }
        FileArc const& arc = file.arcs[lines[i].arc];
        FileArc const& earlier = file.arcs[lines[first].arc];
        repeats[lines[i].arc] = 1;
        findings.push_back({"duplicate_geometry", arc.id, start_of(arc), static_cast<double>(earlier.id),
                            fmt::format("arc {}: lies on the vertices of arc {}, from ({}, {})", arc.id, earlier.id,
                                        start_of(arc).x, start_of(arc).y)});
    }
    return repeats;
}

bool same_bits(Vec3 p, Vec3 q) {
    return std::bit_cast<std::array<std::uint64_t, 3>>(p) == std::bit_cast<std::array<std::uint64_t, 3>>(q);
}

void check_end(FileArc const& arc, char const* which, Vec3 end, std::int64_t id, FileNode const* node,
               Findings& findings) {
    if (node == nullptr) {
        findings.push_back({"missing_node", arc.id, plan(end), static_cast<double>(id),
                            fmt::format("arc {}: its {} {} is not among the nodes", arc.id, which, id)});
    } else if (is_usable(arc) && is_number(node->at) && !same_bits(end, node->at)) {
        double const dz = end.z - node->at.z;
        double const flat = distance(plan(end), plan(node->at));
        double const apart = std::sqrt(flat * flat + dz * dz);
        findings.push_back({"end_mismatch", arc.id, plan(end), apart,
                            fmt::format("arc {}: its end at ({}, {}, {}) lies {} m from {} {} at ({}, {}, {})", arc.id,
                                        end.x, end.y, end.z, apart, which, id, node->at.x, node->at.y, node->at.z)});
    }
}

void check_ends(NetworkFile const& file, Graph const& g, Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        Vec2 const start = start_of(arc);
        Vec3 const place{start.x, start.y, 0.0};
        bool const usable = is_usable(arc);
        check_end(arc, "from_node", usable ? arc.line.front() : place, arc.from_node, g.nodes[g.from[a]], findings);
        check_end(arc, "to_node", usable ? arc.line.back() : place, arc.to_node, g.nodes[g.to[a]], findings);
    }
}

void check_nodes(NetworkFile const& file, Graph const& g, Findings& findings) {
    for (std::size_t j = 0; j < g.ids.size(); ++j) {
        Vec2 const at = g.nodes[j] != nullptr && is_number(g.nodes[j]->at) ? plan(g.nodes[j]->at)
                        : g.out[j].empty()                                 ? Vec2{}
                                                                           : start_of(file.arcs[g.out[j].front()]);
        if (g.out[j].size() > 1) {
            findings.push_back(
                {"several_outflows", g.ids[j], at, static_cast<double>(g.out[j].size()),
                 fmt::format("node {}: {} arcs leave it at ({}, {}), among them {} and {}", g.ids[j], g.out[j].size(),
                             at.x, at.y, file.arcs[g.out[j][0]].id, file.arcs[g.out[j][1]].id)});
        }
        if (g.out[j].empty() && g.in[j].empty()) {
            findings.push_back(
                {"isolated_node", g.ids[j], at, 0.0,
                 fmt::format("node {}: no arc begins or ends in it, at ({}, {})", g.ids[j], at.x, at.y)});
        }
    }
}

/// One finding for each group of arcs: its first arc, and how many it has. part: by arc, the group or none.
void find_groups(NetworkFile const& file, std::vector<std::size_t> const& part, std::size_t parts, std::size_t none,
                 char const* kind, char const* what, Findings& findings) {
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
            findings.push_back(
                {kind, arc.id, at, static_cast<double>(size[part[a]]),
                 fmt::format("arc {}: {} ({} arcs, one at ({}, {}))", arc.id, what, size[part[a]], at.x, at.y)});
            size[part[a]] = 0;
        }
    }
}

void check_cycles(NetworkFile const& file, Graph const& g, Findings& findings) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::size_t const junctions = g.ids.size();
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> directed(junctions);
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> undirected(junctions);
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        boost::add_edge(g.from[a], g.to[a], directed);
        boost::add_edge(g.from[a], g.to[a], undirected);
    }
    std::vector<std::size_t> part(junctions);
    auto const part_map = boost::make_iterator_property_map(part.begin(), boost::get(boost::vertex_index, directed));
    std::vector<std::size_t> arc_part(file.arcs.size());

    // Every arc inside a strong component lies on a cycle.
    std::size_t const strong = boost::strong_components(directed, part_map);
    for (std::size_t a = 0; a < arc_part.size(); ++a) {
        arc_part[a] = part[g.from[a]] == part[g.to[a]] ? part[g.from[a]] : none;
    }
    find_groups(file, arc_part, strong, none, "cycle", "runs in a circle", findings);

    std::size_t const weak = boost::connected_components(undirected, part_map);
    std::vector<char> drained(weak, 0);
    for (std::size_t j = 0; j < junctions; ++j) {
        if (g.out[j].empty()) {
            drained[part[j]] = 1;
        }
    }
    for (std::size_t a = 0; a < arc_part.size(); ++a) {
        arc_part[a] = drained[part[g.from[a]]] != 0 ? none : part[g.from[a]];
    }
    find_groups(file, arc_part, weak, none, "no_outlet", "belongs to a part of the network that has no outlet",
                findings);
}

void check_downstream(NetworkFile const& file, Graph const& g, Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        auto const& next = g.out[g.to[a]];
        std::int64_t const right = next.empty() ? 0 : file.arcs[next.front()].id;
        bool const agrees = next.empty() ? arc.ds_arc == 0 : std::any_of(next.begin(), next.end(), [&](std::size_t n) {
            return file.arcs[n].id == arc.ds_arc;
        });
        if (!agrees) {
            findings.push_back({"ds_arc_mismatch", arc.id, start_of(arc), static_cast<double>(right),
                                fmt::format("arc {}: its ds_arc is {}, but arc {} leaves its to_node {} (0 for none)",
                                            arc.id, arc.ds_arc, right, arc.to_node)});
        }
    }
}

void check_order(FileArc const& arc, char const* name, std::int64_t given, std::int64_t right, Findings& findings) {
    if (given != right) {
        findings.push_back({fmt::format("{}_mismatch", name), arc.id, start_of(arc), static_cast<double>(right),
                            fmt::format("arc {}: its {} is {} and should be {}", arc.id, name, given, right)});
    }
}

void check_orders(NetworkFile const& file, Graph const& g, Findings& findings) {
    struct Orders {
        std::int64_t strahler = 1;
        std::int64_t shreve = 1;
    };
    std::vector<Orders> orders(file.arcs.size()); // known for arcs that leave a junction in ready
    std::vector<std::size_t> awaited;             // by junction
    std::vector<std::size_t> ready;
    for (std::size_t j = 0; j < g.ids.size(); ++j) {
        awaited.push_back(g.in[j].size());
        if (awaited[j] == 0) {
            ready.push_back(j);
        }
    }
    std::vector<char> known(file.arcs.size(), 0);
    for (std::size_t i = 0; i < ready.size(); ++i) {
        std::size_t const j = ready[i];
        Orders here;
        if (!g.in[j].empty()) {
            here = {0, 0};
            std::int64_t of_highest = 0;
            for (std::size_t const a : g.in[j]) {
                of_highest =
                    orders[a].strahler > here.strahler ? 1 : of_highest + (orders[a].strahler == here.strahler);
                here.strahler = std::max(here.strahler, orders[a].strahler);
                // Rivers that part again and again would count their sources beyond any number.
                here.shreve += std::min(orders[a].shreve, std::numeric_limits<std::int64_t>::max() - here.shreve);
            }
            here.strahler += of_highest > 1 ? 1 : 0;
        }
        for (std::size_t const a : g.out[j]) {
            orders[a] = here;
            known[a] = 1;
            if (--awaited[g.to[a]] == 0) {
                ready.push_back(g.to[a]);
            }
        }
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (known[a] != 0) {
            check_order(file.arcs[a], "strahler", file.arcs[a].strahler, orders[a].strahler, findings);
            check_order(file.arcs[a], "shreve", file.arcs[a].shreve, orders[a].shreve, findings);
        }
    }
}

void check_basins(NetworkFile const& file, Graph const& g, Findings& findings) {
    if (std::all_of(file.arcs.begin(), file.arcs.end(), [](FileArc const& arc) { return arc.basin == 0; })) {
        return;
    }
    std::vector<std::tuple<std::int64_t, std::size_t>> mouths; // basin, arc: one for each outlet
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        std::size_t const j = g.to[a];
        if (g.out[j].empty() && a == g.in[j].front()) {
            mouths.emplace_back(file.arcs[a].basin, a);
            continue;
        }
        FileArc const& arc = file.arcs[a];
        FileArc const& next = file.arcs[g.out[j].empty() ? g.in[j].front() : g.out[j].front()];
        if (arc.basin != next.basin) {
            findings.push_back({"basin_mismatch", arc.id, start_of(arc), static_cast<double>(next.basin),
                                fmt::format("arc {}: lies in basin {}, but arc {}, with which it drains, in basin {}",
                                            arc.id, arc.basin, next.id, next.basin)});
        }
    }
    std::sort(mouths.begin(), mouths.end());
    for (std::size_t i = 1; i < mouths.size(); ++i) {
        auto const [basin, a] = mouths[i];
        auto const [basin_before, before] = mouths[i - 1];
        if (basin == basin_before) {
            FileArc const& arc = file.arcs[a];
            findings.push_back({"basin_mismatch", arc.id, start_of(arc), static_cast<double>(basin),
                                fmt::format("arc {}: ends in an outlet of its own but shares basin {} with arc {}",
                                            arc.id, basin, file.arcs[before].id)});
        }
    }
}

/// A place where lines meet, and one of them there.
struct Visit {
    Vec2 at;
    std::size_t arc = 0;
    std::size_t place = 0; ///< twice the number of a vertex, or of a segment and 1
};

std::vector<Visit> visits_of(std::vector<std::vector<Vec2>> const& lines, std::vector<std::size_t> const& arcs,
                             Run const& run) {
    std::vector<Visit> visits;
    for (geometry::Crossing const& c : geometry::crossings(lines, run)) {
        auto const& line = lines[c.line];
        std::size_t const place = c.at == line[c.segment]       ? 2 * c.segment
                                  : c.at == line[c.segment + 1] ? 2 * c.segment + 2
                                                                : 2 * c.segment + 1;
        visits.push_back({c.at, arcs[c.line], place});
    }
    std::sort(visits.begin(), visits.end(), [](Visit const& p, Visit const& q) {
        return std::tie(p.at.x, p.at.y, p.arc, p.place) < std::tie(q.at.x, q.at.y, q.arc, q.place);
    });
    return visits;
}

/// Whether two arcs have a common node where they meet.
bool share_node(NetworkFile const& file, std::size_t p, std::size_t q, Vec2 at) {
    auto const ends_in = [&](FileArc const& arc, std::int64_t node) {
        return (arc.from_node == node && plan(arc.line.front()) == at) ||
               (arc.to_node == node && plan(arc.line.back()) == at);
    };
    FileArc const& arc = file.arcs[p];
    return (ends_in(arc, arc.from_node) && ends_in(file.arcs[q], arc.from_node)) ||
           (ends_in(arc, arc.to_node) && ends_in(file.arcs[q], arc.to_node));
}

void check_meetings(NetworkFile const& file, std::vector<char> const& repeats, Findings& findings, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    std::vector<std::size_t> arcs;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (is_usable(file.arcs[a]) && repeats[a] == 0) {
            if (auto line = plan_of(file.arcs[a]); line.size() > 1) {
                lines.push_back(std::move(line));
                arcs.push_back(a);
            }
        }
    }
    auto const visits = visits_of(lines, arcs, run);
    Findings crossings;
    std::vector<std::vector<Vec2>> touches(file.arcs.size());
    for (std::size_t first = 0, last = 0; first < visits.size(); first = last) {
        Vec2 const at = visits[first].at;
        for (last = first + 1; last < visits.size() && visits[last].at == at; ++last) {
            Visit const& v = visits[last];
            Visit const& before = visits[last - 1];
            if (v.arc == before.arc) {
                if (v.place != before.place) {
                    touches[v.arc].push_back(at);
                }
            } else if (!share_node(file, visits[first].arc, v.arc, at)) {
                FileArc const& arc = file.arcs[v.arc];
                FileArc const& other = file.arcs[visits[first].arc];
                crossings.push_back({"crossing", arc.id, at, static_cast<double>(other.id),
                                     fmt::format("arc {}: meets arc {} at ({}, {}), where they share no node", arc.id,
                                                 other.id, at.x, at.y)});
            }
        }
    }
    for (std::size_t a = 0; a < touches.size(); ++a) {
        if (!touches[a].empty()) {
            FileArc const& arc = file.arcs[a];
            Vec2 const at = touches[a].front();
            findings.push_back({"not_simple", arc.id, at, static_cast<double>(touches[a].size()),
                                fmt::format("arc {}: touches or crosses itself at ({}, {}) ({} such places)", arc.id,
                                            at.x, at.y, touches[a].size())});
        }
    }
    findings.insert(findings.end(), crossings.begin(), crossings.end());
}

} // namespace

TopologyReport check_topology(NetworkFile const& file, Run const& run) {
    TopologyReport report;
    Findings& findings = report.findings;
    if (file.arcs.empty()) {
        findings.push_back({"empty", 0, {}, 0.0, "the file holds no arcs"});
    }
    Graph const graph = graph_of(file);
    check_ids(file, findings);
    check_geometry(file, findings);
    auto const repeats = check_duplicates(file, findings);
    run.at(0.1, "check");
    check_ends(file, graph, findings);
    check_nodes(file, graph, findings);
    check_cycles(file, graph, findings);
    check_downstream(file, graph, findings);
    check_orders(file, graph, findings);
    check_basins(file, graph, findings);
    run.at(0.2, "check");
    check_meetings(file, repeats, findings, run);
    for (char const* kind : kinds) {
        auto const found =
            std::count_if(findings.begin(), findings.end(), [&](Finding const& f) { return f.kind == kind; });
        report.checks.push_back({kind, static_cast<double>(found), 0.0, found == 0});
    }
    return report;
}

} // namespace thalweg::measure
