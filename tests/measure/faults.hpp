// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/measure/topology/topology.hpp>

#include "trees.hpp"

/// Networks without a fault, and every fault that can be put into one.
namespace faults {

using thalweg::NetworkFile;
using thalweg::Vec2;
using thalweg::Vec3;
using FileArc = NetworkFile::FileArc;

inline constexpr std::int64_t new_id = 900'000'007;
inline double const no_number = std::numeric_limits<double>::quiet_NaN();

inline NetworkFile clean(std::uint64_t seed, std::int64_t cols = 12, std::int64_t rows = 12) {
    thalweg::ElevatedNetwork const rivers = random_rivers(seed, cols, rows);
    return thalweg::measure::as_file(rivers, orders_of(rivers.planform));
}

/// The least square lattice's with so many arcs.
inline NetworkFile clean_of(std::size_t arcs, std::uint64_t seed) {
    auto side = static_cast<std::int64_t>(std::sqrt(1.9 * static_cast<double>(arcs)));
    NetworkFile file = clean(seed, side, side);
    while (file.arcs.size() < arcs) {
        ++side;
        file = clean(seed, side, side);
    }
    return file;
}

inline Vec3 between(Vec3 p, Vec3 q, double t) {
    return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
}
inline Vec3 moved(Vec3 p, double dx, double dy) {
    return {p.x + dx, p.y + dy, p.z};
}

/// [m] What check_topology takes for near by itself.
inline double near_of(NetworkFile const& file) {
    Vec3 low = file.nodes.front().at;
    Vec3 high = low;
    for (FileArc const& arc : file.arcs) {
        for (Vec3 const p : arc.line) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), 0.0};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), 0.0};
        }
    }
    return 1e-6 * thalweg::distance({low.x, low.y}, {high.x, high.y});
}

/// The first arc from the k-th on, round and round, of which the test is true.
template <class Test> std::optional<std::size_t> arc_where(NetworkFile const& f, std::size_t k, Test const& test) {
    for (std::size_t i = 0; i < f.arcs.size(); ++i) {
        std::size_t const a = (k + i) % f.arcs.size();
        if (test(f.arcs[a])) {
            return a;
        }
    }
    return std::nullopt;
}
inline auto const has_next = [](FileArc const& arc) { return arc.ds_arc != 0; };
inline auto const is_source_with_next = [](FileArc const& arc) { return arc.shreve == 1 && arc.ds_arc != 0; };

/// Nodes are numbered from 1 in the clean file.
inline NetworkFile::FileNode& node(NetworkFile& f, std::int64_t id) {
    return f.nodes[static_cast<std::size_t>(id - 1)];
}

/// A new arc of its own basin, from and to nodes of its own, level.
inline std::int64_t add_arc(NetworkFile& f, std::vector<Vec3> line) {
    for (Vec3& p : line) {
        p.z = line.front().z;
    }
    f.nodes.push_back({new_id, line.front()});
    f.nodes.push_back({new_id + 1, line.back()});
    f.arcs.push_back({.id = new_id,
                      .from_node = new_id,
                      .to_node = new_id + 1,
                      .ds_arc = 0,
                      .strahler = 1,
                      .shreve = 1,
                      .basin = new_id,
                      .line = std::move(line)});
    return new_id;
}

/// The features of which the finding may name any; none where the fault cannot be put there.
using Features = std::vector<std::int64_t>;

inline double length_of_plan(FileArc const& arc) {
    double sum = 0.0;
    for (std::size_t i = 1; i < arc.line.size(); ++i) {
        sum += thalweg::distance(in_plan(arc.line[i - 1]), in_plan(arc.line[i]));
    }
    return sum;
}

struct Fault {
    char const* kind;
    char const* what;
    std::function<Features(NetworkFile&, std::size_t k)> plant; ///< at arc k, or the next that will do
    std::set<std::string> besides = {};                         ///< kinds that it cannot help but cause as well
};

inline std::vector<Fault> const& all() {
    static std::vector<Fault> const faults = {
        {"bad_arc_id", "below 1", [](NetworkFile& f, std::size_t k) { return Features{f.arcs[k].id = -new_id}; }},
        {"duplicate_arc_id", "of the next",
         [](NetworkFile& f, std::size_t k) { return Features{f.arcs[k].id = f.arcs[(k + 1) % f.arcs.size()].id}; }},
        {"duplicate_node_id", "a node twice",
         [](NetworkFile& f, std::size_t k) {
             f.nodes.push_back(f.nodes[k % f.nodes.size()]);
             return Features{f.nodes.back().id};
         }},
        {"duplicate_node_id", "a node under the name of another",
         [](NetworkFile& f, std::size_t k) {
             std::size_t const n = k % (f.nodes.size() - 1);
             return Features{f.nodes[n].id = f.nodes[n + 1].id};
         }},
        {"null_geometry", "no vertex",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.clear();
             return Features{f.arcs[k].id};
         }},
        {"null_geometry", "one vertex",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.resize(1);
             return Features{f.arcs[k].id};
         }},
        {"nan", "a height",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line[1].z = no_number;
             return Features{f.arcs[k].id};
         }},
        {"nan", "infinite",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line[0].x = -std::numeric_limits<double>::infinity();
             return Features{f.arcs[k].id};
         }},
        {"nan", "a node beyond any map",
         [](NetworkFile& f, std::size_t k) {
             auto& n = f.nodes[k % f.nodes.size()];
             n.at.y = 1e18;
             return Features{n.id};
         }},
        {"zero_length", "between two nodes",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line = {f.arcs[k].line[0], f.arcs[k].line[0]};
             return Features{f.arcs[k].id};
         }},
        {"zero_length", "in a node",
         [](NetworkFile& f, std::size_t k) {
             FileArc arc = f.arcs[k];
             arc.id = new_id;
             arc.to_node = arc.from_node;
             arc.line = {arc.line[0], arc.line[0]};
             f.arcs.push_back(arc);
             return Features{new_id};
         }},
        {"repeated_vertex", "the second",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.insert(f.arcs[k].line.begin() + 1, f.arcs[k].line[1]);
             return Features{f.arcs[k].id};
         }},
        {"z_rising", "by a bit",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 high = between(line[0], line[1], 0.5);
             high.z = std::nextafter(line[0].z, 1e300);
             line.insert(line.begin() + 1, high);
             return Features{f.arcs[k].id};
         }},
        {"z_rising", "to its end",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 low = between(line[0], line[1], 0.5);
             low.z = line.back().z - 3.0;
             line.insert(line.begin() + 1, low);
             return Features{f.arcs[k].id};
         }},
        {"duplicate_geometry", "a copy",
         [](NetworkFile& f, std::size_t k) {
             f.arcs.push_back(f.arcs[k]);
             return Features{f.arcs.back().id = new_id};
         }},
        {"duplicate_geometry", "a copy with its id",
         [](NetworkFile& f, std::size_t k) {
             f.arcs.push_back(f.arcs[k]);
             return Features{f.arcs[k].id};
         },
         {"duplicate_arc_id"}},
        {"duplicate_geometry", "the way back",
         [](NetworkFile& f, std::size_t k) {
             FileArc back = f.arcs[k];
             std::reverse(back.line.begin(), back.line.end());
             std::swap(back.from_node, back.to_node);
             back.id = new_id;
             f.arcs.push_back(back);
             return Features{new_id};
         }},
        {"missing_node", "of a source",
         [](NetworkFile& f, std::size_t k) {
             auto const source = arc_where(f, k, [](FileArc const& arc) { return arc.shreve == 1; });
             std::erase_if(f.nodes, [&](auto const& n) { return n.id == f.arcs[*source].from_node; });
             return Features{f.arcs[*source].id};
         }},
        {"missing_node", "to one that is not there",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].to_node = new_id;
             return Features{f.arcs[k].id};
         }},
        {"end_mismatch", "a bit in height",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.back().z = std::nextafter(f.arcs[k].line.back().z, -1.0);
             return Features{f.arcs[k].id};
         }},
        {"end_mismatch", "a bit to the east",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.front().x = std::nextafter(f.arcs[k].line.front().x, 1e9);
             return Features{f.arcs[k].id};
         }},
        {"end_mismatch", "beside its node",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].line.back() = moved(f.arcs[k].line.back(), 0.04, 0.02);
             return Features{f.arcs[k].id};
         },
         {"crossing"}},
        {"end_mismatch", "another node's name",
         [](NetworkFile& f, std::size_t k) {
             auto const other = arc_where(f, k + 1, is_source_with_next);
             if (!other || f.arcs[*other].from_node == f.arcs[k].from_node) {
                 return Features{};
             }
             f.arcs[k].from_node = f.arcs[*other].from_node;
             return Features{f.arcs[k].id};
         },
         {"several_outflows", "cycle", "no_outlet"}},
        {"wrong_direction", "drawn upstream",
         [](NetworkFile& f, std::size_t k) {
             std::reverse(f.arcs[k].line.begin(), f.arcs[k].line.end());
             return Features{f.arcs[k].id};
         }},
        {"wrong_direction", "named upstream",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             std::swap(f.arcs[*a].from_node, f.arcs[*a].to_node);
             return Features{f.arcs[*a].id};
         }},
        {"wrong_direction", "drawn and named upstream",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             std::swap(f.arcs[*a].from_node, f.arcs[*a].to_node);
             std::reverse(f.arcs[*a].line.begin(), f.arcs[*a].line.end());
             return Features{f.arcs[*a].id};
         }},
        {"dangling_end", "short of its confluence",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             f.arcs[*a].line.back() = moved(f.arcs[*a].line.back(), 0.3 * near_of(f), 0.1 * near_of(f));
             f.arcs[*a].to_node = new_id;
             f.nodes.push_back({new_id, f.arcs[*a].line.back()});
             return Features{f.arcs[*a].id, f.arcs[*a].ds_arc};
         }},
        {"dangling_end", "short of a river's side",
         [](NetworkFile& f, std::size_t k) {
             auto const& line = f.arcs[k].line;
             Vec3 const joint = between(line[0], line[1], 0.5);
             return Features{add_arc(f, {moved(joint, 0.05, 0.0), moved(joint, 0.5 * near_of(f), 0.0)})};
         }},
        {"several_outflows", "a second way out",
         [](NetworkFile& f, std::size_t k) {
             FileArc const& arc = f.arcs[k];
             Vec3 const start = arc.line[0];
             std::int64_t const from = arc.from_node;
             add_arc(f, {start, moved(start, 0.03, 0.1)});
             std::erase_if(f.nodes, [](auto const& n) { return n.id == new_id; });
             f.arcs.back().from_node = from;
             return Features{from};
         }},
        {"isolated_node", "outside",
         [](NetworkFile& f, std::size_t k) {
             f.nodes.push_back({new_id, {-7.0, -7.0 - static_cast<double>(k), 0.0}});
             return Features{new_id};
         }},
        {"cycle", "of names",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].to_node = f.arcs[k].from_node;
             return Features{f.arcs[k].id};
         },
         {"no_outlet", "end_mismatch"}},
        {"cycle", "drawn",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, [](FileArc const& arc) { return arc.line.size() == 2 && arc.ds_arc != 0; });
             if (!a) {
                 return Features{};
             }
             FileArc back = f.arcs[*a];
             Vec3 const up = back.line[0];
             Vec3 const down = back.line[1];
             std::swap(back.from_node, back.to_node);
             back.line = {down, moved(between(down, up, 0.5), 0.02, 0.0), up};
             back.ds_arc = back.id;
             back.id = new_id;
             f.arcs.push_back(back);
             return Features{new_id, f.arcs[*a].id};
         },
         {"several_outflows", "z_rising", "no_outlet"}},
        {"no_outlet", "the last arc runs back",
         [](NetworkFile& f, std::size_t k) {
             auto const mouth = arc_where(f, k, [](FileArc const& arc) { return arc.ds_arc == 0; });
             std::int64_t const basin = f.arcs[*mouth].basin;
             f.arcs[*mouth].to_node = f.arcs[*mouth].from_node;
             Features part;
             for (FileArc const& arc : f.arcs) {
                 if (arc.basin == basin) {
                     part.push_back(arc.id);
                 }
             }
             return std::count_if(f.arcs.begin(), f.arcs.end(),
                                  [&](FileArc const& arc) { return arc.to_node == f.arcs[*mouth].to_node; }) > 0
                        ? part
                        : Features{};
         },
         {"cycle", "end_mismatch"}},
        {"ds_arc_mismatch", "one that is not there",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].ds_arc = new_id;
             return Features{f.arcs[k].id};
         }},
        {"ds_arc_mismatch", "none",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             f.arcs[*a].ds_arc = 0;
             return Features{f.arcs[*a].id};
         }},
        {"strahler_mismatch", "one more",
         [](NetworkFile& f, std::size_t k) {
             ++f.arcs[k].strahler;
             return Features{f.arcs[k].id};
         }},
        {"shreve_mismatch", "below any",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].shreve = -new_id;
             return Features{f.arcs[k].id};
         }},
        {"basin_mismatch", "of its own",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             f.arcs[*a].basin = new_id;
             return Features{f.arcs[*a].id};
         }},
        {"spike", "to the side and back",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 const m = between(line[0], line[1], 0.5);
             line.insert(line.begin() + 1, {m, moved(m, 0.05, 0.0), m});
             return Features{f.arcs[k].id};
         }},
        {"spike", "back along itself",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 const there = between(line[0], line[1], 0.5);
             Vec3 back = between(line[0], line[1], 0.25);
             back.z = there.z;
             line.insert(line.begin() + 1, {there, back});
             return Features{f.arcs[k].id};
         }},
        {"spike", "to the side and nearly back",
         [](NetworkFile& f, std::size_t k) {
             double const little = 0.3 * near_of(f);
             auto& line = f.arcs[k].line;
             Vec3 const m = between(line[0], line[1], 0.5);
             line.insert(line.begin() + 1, {m, moved(m, 0.05, -0.5 * little), moved(m, 0.0, -little)});
             return Features{f.arcs[k].id};
         }},
        {"self_touching", "a loop",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 const m = between(line[0], line[1], 0.5);
             line.insert(line.begin() + 1, {m, moved(m, 0.06, 0.0), moved(m, 0.06, 0.05), moved(m, -0.08, 0.05),
                                            moved(m, -0.08, -0.02)});
             return Features{f.arcs[k].id};
         }},
        {"self_touching", "a vertex visited twice",
         [](NetworkFile& f, std::size_t k) {
             auto& line = f.arcs[k].line;
             Vec3 const m = between(line[0], line[1], 0.5);
             line.insert(line.begin() + 1, {m, moved(m, 0.06, 0.01), moved(m, 0.06, -0.01), m});
             return Features{f.arcs[k].id};
         }},
        {"touches", "a tributary without a node",
         [](NetworkFile& f, std::size_t k) {
             auto const& line = f.arcs[k].line;
             Vec3 const joint = between(line[0], line[1], 0.5); // exactly: coordinates are quarters
             return Features{add_arc(f, {moved(joint, 0.0625, 0.0), joint})};
         }},
        {"touches", "a node beside the node",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             f.nodes.push_back({new_id, f.arcs[*a].line.back()});
             f.arcs[*a].to_node = new_id;
             return Features{f.arcs[*a].id, f.arcs[*a].ds_arc};
         }},
        {"touches", "through another's end",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, has_next);
             if (!a) {
                 return Features{};
             }
             Vec3 const at = f.arcs[*a].line.back();
             return Features{add_arc(f, {moved(at, 0.05, 0.01), at, moved(at, 0.05, -0.01)})};
         }},
        {"overlap", "along a river for a while",
         [](NetworkFile& f, std::size_t k) {
             auto const& line = f.arcs[k].line;
             Vec3 const from = between(line[0], line[1], 0.25);
             Vec3 const to = between(line[0], line[1], 0.75);
             std::int64_t const other = f.arcs[k].id;
             return Features{add_arc(f, {moved(from, 0.0625, 0.03125), from, to, moved(to, 0.0625, 0.0)}), other};
         }},
        {"column_mismatch", "length",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.length_m = 1e-3 + length_of_plan(f.arcs[k]);
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "straight",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.straight_m = 2.0 * length_of_plan(f.arcs[k]);
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "z_up",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.z_up_m = f.arcs[k].line.front().z + 1e-3;
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "z_down",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.z_down_m = f.arcs[k].line.back().z - 1e-3;
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "slope",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.slope =
                 1e-3 + (f.arcs[k].line.front().z - f.arcs[k].line.back().z) / length_of_plan(f.arcs[k]);
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "n_up, topo_ord and hack",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.n_up = 17.0;
             f.arcs[k].columns.topo_ord = 1e6;
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "dist_out",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].columns.dist_out_m = 1e7;
             return Features{f.arcs[k].id};
         }},
        {"column_mismatch", "us_area",
         [](NetworkFile& f, std::size_t k) {
             f.arcs[k].us_area_m2 = 2.0;
             f.arcs[k].ds_area_m2 = 1.0;
             return Features{f.arcs[k].id};
         }},
        {"node_column_mismatch", "kind",
         [](NetworkFile& f, std::size_t k) {
             auto& node = f.nodes[k % f.nodes.size()];
             node.columns.kind = "spring";
             return Features{node.id};
         }},
        {"node_column_mismatch", "deg_in, z and dist_out",
         [](NetworkFile& f, std::size_t k) {
             auto& node = f.nodes[k % f.nodes.size()];
             node.columns.deg_in = 40.0;
             node.columns.z_m = node.at.z + 1.0;
             node.columns.dist_out_m = 1e7;
             return Features{node.id};
         }},
        {"crossing", "a line across",
         [](NetworkFile& f, std::size_t k) {
             auto const& line = f.arcs[k].line;
             Vec3 const middle = between(line[0], line[1], 0.4);
             std::int64_t const other = f.arcs[k].id;
             return Features{add_arc(f, {moved(middle, -0.05, 0.0), moved(middle, 0.05, 0.0)}), other};
         }},
        {"crossing", "a vertex beyond a neighbour",
         [](NetworkFile& f, std::size_t k) {
             auto const a = arc_where(f, k, [&](FileArc const& arc) {
                 return std::count_if(f.arcs.begin(), f.arcs.end(),
                                      [&](FileArc const& o) { return o.to_node == arc.to_node; }) > 1;
             });
             if (!a) {
                 return Features{};
             }
             auto const b = arc_where(f, *a + 1, [&](FileArc const& o) { return o.to_node == f.arcs[*a].to_node; });
             auto& line = f.arcs[*a].line;
             auto const& other = f.arcs[*b].line;
             Vec3 const on = between(other.back(), other[other.size() - 2], 0.3);
             Vec3 const own = between(line.back(), line[line.size() - 2], 0.3);
             Vec3 beyond = between(own, on, 1.1);
             beyond.z = line.back().z;
             line.insert(line.end() - 1, beyond);
             return Features{f.arcs[*a].id, f.arcs[*b].id};
         }},
    };
    return faults;
}

} // namespace faults
