// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

namespace thalweg::measure::topology_steps {
namespace {

// The file's values of the trees: downstream arcs, orders, basins.

void check_downstream(NetworkFile const& file, Graph const& g, std::vector<char> const& ambiguous, Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (g.left_out[a] != 0) {
            continue;
        }
        FileArc const& arc = file.arcs[a];
        auto const next = g.out.at(g.ends[a][1]);
        std::int64_t const right = next.empty() ? 0 : file.arcs[next.front()].id;
        bool const agrees = next.empty() ? arc.ds_arc == 0 : std::any_of(next.begin(), next.end(), [&](std::size_t n) {
            return file.arcs[n].id == arc.ds_arc || ambiguous[n] != 0; // its id may be the wrong one of the two
        });
        if (!agrees) {
            findings.push_back({"ds_arc_mismatch", number_of(file, arc), start_of(arc),
                                static_cast<double>(right - file.id_shift),
                                fmt::format("arc {}: its ds_arc is {}, but arc {} leaves its to_node {} ({} for none)",
                                            number_of(file, arc), arc.ds_arc - file.id_shift, right - file.id_shift,
                                            arc.to_node, -file.id_shift)});
        }
    }
}

void check_order(NetworkFile const& file, FileArc const& arc, FindingKind kind, std::int64_t given, std::int64_t right,
                 Findings& findings) {
    if (given != right) {
        std::string_view const name = kind.name().substr(0, kind.name().find('_'));
        findings.push_back(
            {kind, number_of(file, arc), start_of(arc), static_cast<double>(right),
             fmt::format("arc {}: its {} is {} and should be {}", number_of(file, arc), name, given, right)});
    }
}

struct Orders {
    std::int64_t strahler = 1; ///< Strahler 1957
    std::int64_t shreve = 1;   ///< Shreve 1966
};

Orders orders_below(std::span<std::size_t const> in, std::vector<Orders> const& orders) {
    if (in.empty()) {
        return {};
    }
    Orders below{0, 0};
    std::int64_t of_highest = 0;
    for (std::size_t const a : in) {
        of_highest = orders[a].strahler > below.strahler ? 1 : of_highest + (orders[a].strahler == below.strahler);
        below.strahler = std::max(below.strahler, orders[a].strahler);
        below.shreve += orders[a].shreve;
    }
    below.strahler += of_highest > 1 ? 1 : 0;
    return below;
}

void check_orders(NetworkFile const& file, Graph const& g, std::size_t junctions, Findings& findings) {
    std::vector<Orders> orders(file.arcs.size(), Orders{0, 0}); // 0: unknown
    std::vector<std::size_t> awaited;                           // by junction
    std::vector<std::size_t> ready;
    for (std::size_t j = 0; j < junctions; ++j) {
        awaited.push_back(g.in.at(j).size());
        if (awaited[j] == 0) {
            ready.push_back(j);
        }
    }
    for (std::size_t i = 0; i < ready.size(); ++i) {
        auto const out = g.out.at(ready[i]);
        if (out.size() != 1) {
            continue; // an outlet, or a bifurcation
        }
        orders[out[0]] = orders_below(g.in.at(ready[i]), orders);
        if (std::size_t const to = g.ends[out[0]][1]; --awaited[to] == 0) {
            ready.push_back(to);
        }
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (orders[a].strahler == 0) {
            continue;
        }
        if (file.says.strahler) {
            check_order(file, file.arcs[a], "strahler_mismatch", file.arcs[a].strahler, orders[a].strahler, findings);
        }
        if (file.says.shreve) {
            check_order(file, file.arcs[a], "shreve_mismatch", file.arcs[a].shreve, orders[a].shreve, findings);
        }
    }
}

/// By arc: the junction of its outlet by paths without bifurcations, or none.
std::vector<std::size_t> outlets_of(std::vector<Ends> const& ends, Graph const& g, std::size_t junctions) {
    std::vector<std::size_t> outlet(ends.size(), none);
    for (std::size_t j = 0; j < junctions; ++j) {
        if (!g.out.at(j).empty()) {
            continue;
        }
        auto const mouths = g.in.at(j);
        std::vector<std::size_t> above(mouths.begin(), mouths.end());
        while (!above.empty()) {
            std::size_t const a = above.back();
            above.pop_back();
            outlet[a] = j;
            if (g.out.at(ends[a][0]).size() == 1) {
                auto const in = g.in.at(ends[a][0]);
                above.insert(above.end(), in.begin(), in.end());
            }
        }
    }
    return outlet;
}

void check_basins(NetworkFile const& file, Graph const& g, std::size_t junctions, Findings& findings) {
    if (std::all_of(file.arcs.begin(), file.arcs.end(), [](FileArc const& arc) { return arc.basin == 0; })) {
        return;
    }
    auto const outlet = outlets_of(g.ends, g, junctions);
    std::vector<std::tuple<std::size_t, std::int64_t, std::size_t>> arcs; // outlet, basin, arc
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (outlet[a] != none && g.left_out[a] == 0) {
            arcs.emplace_back(outlet[a], file.arcs[a].basin, a);
        }
    }
    std::sort(arcs.begin(), arcs.end());
    std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> basins; // basin of most arcs, its mouth, outlet
    for (std::size_t i = 0; i < arcs.size();) {
        std::size_t const of = std::get<0>(arcs[i]);
        std::size_t const mouth = g.in.at(of).front();
        std::int64_t const at_mouth = file.arcs[mouth].basin;
        std::int64_t most = 0;
        std::size_t count = 0;
        while (i < arcs.size() && std::get<0>(arcs[i]) == of) {
            std::size_t const first = i;
            std::int64_t const basin = std::get<1>(arcs[i]);
            while (i < arcs.size() && std::get<0>(arcs[i]) == of && std::get<1>(arcs[i]) == basin) {
                ++i;
            }
            if (i - first > count || (i - first == count && basin == at_mouth)) {
                most = basin;
                count = i - first;
            }
        }
        basins.emplace_back(most, mouth, of);
    }
    std::vector<std::int64_t> right(junctions, 0);
    for (auto const& [basin, mouth, of] : basins) {
        right[of] = basin;
    }
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        if (outlet[a] != none && g.left_out[a] == 0 && arc.basin != right[outlet[a]]) {
            findings.push_back({"basin_mismatch", number_of(file, arc), start_of(arc),
                                static_cast<double>(right[outlet[a]]),
                                fmt::format("arc {}: lies in basin {}, but the arcs with which it drains in basin {}",
                                            number_of(file, arc), arc.basin, right[outlet[a]])});
        }
    }
    std::sort(basins.begin(), basins.end());
    for (std::size_t i = 1; i < basins.size(); ++i) {
        auto const [basin, mouth, of] = basins[i];
        auto const [basin_before, mouth_before, of_before] = basins[i - 1];
        if (basin == basin_before) {
            FileArc const& arc = file.arcs[mouth];
            findings.push_back({"basin_mismatch", number_of(file, arc), start_of(arc), static_cast<double>(basin),
                                fmt::format("arc {}: ends in an outlet of its own but shares basin {} with arc {}",
                                            number_of(file, arc), basin, number_of(file, file.arcs[mouth_before]))});
        }
    }
}

// The columns of the network schema that follow from lines and trees.

constexpr double of_lengths = 1e-6; // [m] per vertex: files round coordinates to this
constexpr double of_values = 1e-9;  // relative: precision of a column's decimals

double tolerance(double right, double vertices) {
    return of_lengths * (1.0 + vertices) + of_values * std::fabs(right);
}

/// Values that follow from an arc's line.
struct LineMeasures {
    double length = 0.0;
    double length_3d = 0.0;
    double straight = 0.0;
    double vertices = 0.0;
};

LineMeasures measured(FileArc const& arc) {
    LineMeasures of;
    of.vertices = static_cast<double>(arc.line.size());
    for (std::size_t i = 1; i < arc.line.size(); ++i) {
        double const plan = distance(plan_of(arc.line[i - 1]), plan_of(arc.line[i]));
        double const rise = arc.line[i].z - arc.line[i - 1].z;
        of.length += plan;
        of.length_3d += std::sqrt(plan * plan + rise * rise);
    }
    of.straight = arc.line.empty() ? 0.0 : distance(plan_of(arc.line.front()), plan_of(arc.line.back()));
    return of;
}

/// Values that follow from the tree of an arc's outlet.
struct InTree {
    bool known = false;
    double steps = 0.0; ///< arcs to the outlet, itself included
    double below = 0.0; ///< [m] from its end to the outlet
    double vertices = 0.0;
};

class Columns {
public:
    Columns(NetworkFile const& file, Joints const& joints, Graph const& g, Findings& findings)
        : file_(file), joints_(joints), g_(g), findings_(findings), tree_(file.arcs.size()) {
        for (FileArc const& arc : file.arcs) {
            measured_.push_back(measured(arc));
        }
    }

    void check() {
        walk_trees();
        find_longest();
        note_hack();
        for (std::size_t a = 0; a < file_.arcs.size(); ++a) {
            if (g_.left_out[a] == 0) {
                check_line(a);
                check_tree(a);
                check_areas(a);
            }
        }
        if (file_.says.nodes) {
            for (std::size_t j = 0; j < joints_.junctions.ids.size(); ++j) {
                check_node(j);
            }
        }
    }

private:
    /// From the outlets upstream, as far as there are no bifurcations.
    void walk_trees() {
        for (std::size_t j = 0; j < joints_.junctions.ids.size(); ++j) {
            if (!g_.out.at(j).empty()) {
                continue;
            }
            auto const mouths = g_.in.at(j);
            std::vector<std::size_t> ready(mouths.begin(), mouths.end());
            for (std::size_t const a : ready) {
                tree_[a] = {true, 1.0, 0.0, 0.0};
            }
            while (!ready.empty()) {
                std::size_t const a = ready.back();
                ready.pop_back();
                order_.push_back(a);
                std::size_t const from = g_.ends[a][0];
                if (g_.out.at(from).size() != 1) {
                    continue;
                }
                for (std::size_t const up : g_.in.at(from)) {
                    tree_[up] = {true, tree_[a].steps + 1.0, tree_[a].below + measured_[a].length,
                                 tree_[a].vertices + measured_[a].vertices};
                    ready.push_back(up);
                }
            }
        }
    }

    /// By arc: the longest path [m] from a source to its end, and Strahler's order.
    void find_longest() {
        longest_.assign(file_.arcs.size(), 0.0);
        strahler_.assign(file_.arcs.size(), 1.0);
        for (auto a = order_.rbegin(); a != order_.rend(); ++a) {
            double above = 0.0;
            double highest = 0.0;
            int of_highest = 0;
            for (std::size_t const up : g_.in.at(g_.ends[*a][0])) {
                above = std::max(above, tree_[up].known ? longest_[up] : 0.0);
                of_highest = strahler_[up] > highest ? 1 : of_highest + (strahler_[up] == highest ? 1 : 0);
                highest = std::max(highest, strahler_[up]);
            }
            longest_[*a] = above + measured_[*a].length;
            strahler_[*a] = std::max(1.0, highest + (of_highest > 1 ? 1.0 : 0.0));
        }
    }

    void compare(std::size_t a, char const* name, double told, double right, double slack) {
        if (std::isnan(told) || std::isnan(right) || std::fabs(told - right) <= slack) {
            return;
        }
        FileArc const& arc = file_.arcs[a];
        findings_.push_back(
            {"column_mismatch", number_of(file_, arc), start_of(arc), right,
             fmt::format("arc {}: its {} is {:.9g} and should be {:.9g}", number_of(file_, arc), name, told, right)});
    }

    void check_line(std::size_t a) {
        FileArc const& arc = file_.arcs[a];
        NetworkFile::ArcColumns const& told = arc.columns;
        LineMeasures const& of = measured_[a];
        if (arc.line.size() < 2) {
            return; // reported elsewhere
        }
        double const slack = tolerance(of.length, of.vertices);
        compare(a, "length", told.length_m, of.length, slack);
        compare(a, "straight", told.straight_m, of.straight, slack);
        if (!file_.says.heights) {
            return;
        }
        compare(a, "length_3d", told.length_3d_m, of.length_3d, tolerance(of.length_3d, of.vertices));
        if (joints_.against[a] == 0) {
            double const high = arc.line.front().z;
            double const low = arc.line.back().z;
            compare(a, "z_up", told.z_up_m, high, tolerance(high, 1.0));
            compare(a, "z_down", told.z_down_m, low, tolerance(low, 1.0));
            double const slope = (high - low) / of.length;
            compare(a, "slope", told.slope, slope, (2.0 * tolerance(high, 1.0) + std::fabs(slope) * slack) / of.length);
        }
    }

    void check_tree(std::size_t a) {
        NetworkFile::ArcColumns const& told = file_.arcs[a].columns;
        if (!tree_[a].known) {
            return;
        }
        if (g_.out.at(g_.ends[a][0]).size() == 1) {
            compare(a, "n_up", told.n_up, static_cast<double>(g_.in.at(g_.ends[a][0]).size()), 0.0);
        }
        compare(a, "topo_ord", told.topo_ord, tree_[a].steps, 0.0);
        compare(a, "dist_out", told.dist_out_m, tree_[a].below, tolerance(tree_[a].below, tree_[a].vertices));
        check_hack(a);
    }

    /// Reference values for the Hack orders of a node's arcs.
    struct AtNode {
        double below = 1.0;    ///< the order of the arc that leaves
        double longest = 0.0;  ///< [m] of the paths that end here
        std::size_t mains = 0; ///< number of arcs that end here with the downstream order
    };

    /// Computed per node, since a node may have any number of arcs.
    void note_hack() {
        at_node_.resize(joints_.junctions.ids.size());
        for (std::size_t j = 0; j < at_node_.size(); ++j) {
            AtNode& at = at_node_[j];
            auto const out = g_.out.at(j);
            at.below = out.empty() ? 1.0 : file_.arcs[out.front()].columns.hack;
            for (std::size_t const a : g_.in.at(j)) {
                at.longest = std::max(at.longest, longest_[a]);
                at.mains += file_.arcs[a].columns.hack == at.below ? 1 : 0;
            }
        }
    }

    /// At a node one arc, the main one, keeps the downstream order; the others have one more. Where none or several do,
    /// the one on the longest path is right.
    void check_hack(std::size_t a) {
        auto const [below, most, mains] = at_node_[g_.ends[a][1]];
        double const told = file_.arcs[a].columns.hack;
        if (std::isnan(below) || (mains == 1 && (told == below || told == below + 1.0))) {
            return;
        }
        bool const may_be_main = longest_[a] >= most - tolerance(most, 2.0 * tree_[a].vertices + 1000.0);
        compare(a, "hack", told, below + (mains != 1 && may_be_main ? 0.0 : 1.0), 0.0);
    }

    /// Areas must not decrease downstream. The sum of two that meet is no bound: rivers that divided above count common
    /// water in both.
    void check_areas(std::size_t a) {
        FileArc const& arc = file_.arcs[a];
        if (!file_.says.areas || !file_.says.downstream || file_.schema != "native") {
            return;
        }
        double arriving = 0.0;
        auto const in = g_.in.at(g_.ends[a][0]);
        if (g_.out.at(g_.ends[a][0]).size() == 1) {
            for (std::size_t const up : in) {
                arriving = std::max(arriving, file_.arcs[up].ds_area_m2); // NaN, the second, is left out
            }
        }
        auto const at_least = [&](char const* name, double told, double least) {
            if (told >= 0.0 && told < least) { // NaN: unknown
                compare(a, name, told, least, 1e-3 + of_values * least);
            }
        };
        at_least("us_area", arc.us_area_m2, arriving);
        at_least("ds_area", arc.ds_area_m2, arc.us_area_m2);
    }

    void compare_node(FileNode const& node, char const* name, double told, double right, double slack) {
        if (std::isnan(told) || std::isnan(right) || std::fabs(told - right) <= slack) {
            return;
        }
        findings_.push_back(
            {"node_column_mismatch", node.id, plan_of(node.at), right,
             fmt::format("node {}: its {} is {:.9g} and should be {:.9g}", node.id, name, told, right)});
    }

    void check_node(std::size_t j) {
        if (joints_.junctions.node[j] == none || joints_.junctions.repeated[j] != 0) {
            return;
        }
        FileNode const& node = file_.nodes[joints_.junctions.node[j]];
        auto const in = g_.in.at(j);
        auto const out = g_.out.at(j);
        if (in.empty() && out.empty()) {
            return; // reported elsewhere
        }
        compare_node(node, "deg_in", node.columns.deg_in, static_cast<double>(in.size()), 0.0);
        compare_node(node, "deg_out", node.columns.deg_out, static_cast<double>(out.size()), 0.0);
        check_kind(node, in.size(), out.size());
        if (file_.says.heights) {
            compare_node(node, "z", node.columns.z_m, node.at.z, tolerance(node.at.z, 1.0));
        }
        std::size_t const of = out.size() == 1 ? out.front() : out.empty() ? in.front() : none;
        if (of == none || !tree_[of].known) {
            return;
        }
        FileArc const& arc = file_.arcs[of];
        double const reach = out.empty() ? 0.0 : tree_[of].below + measured_[of].length;
        compare_node(node, "dist_out", node.columns.dist_out_m, reach,
                     tolerance(reach, tree_[of].vertices + measured_[of].vertices));
        if (file_.says.basin) { // of any arc here: a wrong one among them is reported elsewhere
            auto const has = [&](std::size_t b) {
                return static_cast<double>(file_.arcs[b].basin) == node.columns.basin_id;
            };
            if (std::none_of(in.begin(), in.end(), has) && std::none_of(out.begin(), out.end(), has)) {
                compare_node(node, "basin_id", node.columns.basin_id, static_cast<double>(arc.basin), 0.0);
            }
        }
        double order = 0.0;
        for (std::size_t const a : out.empty() ? in : out) {
            order = std::max(order, strahler_[a]);
        }
        compare_node(node, "strahler", node.columns.strahler, order, 0.0);
        if (file_.says.areas) {
            double area = arc.us_area_m2;
            if (out.empty()) {
                area = 0.0;
                for (std::size_t const a : in) {
                    area += file_.arcs[a].ds_area_m2;
                }
            }
            compare_node(node, "area", node.columns.area_m2, area, 1e-3 + of_values * area);
        }
    }

    void check_kind(FileNode const& node, std::size_t in, std::size_t out) {
        NodeKind const right = out == 0  ? NodeKind::outlet
                               : in == 0 ? NodeKind::source
                               : in == 1 ? NodeKind::pseudo
                                         : NodeKind::confluence;
        bool const is_sink = out == 0 && node.columns.kind == name_of(NodeKind::sink);
        if (!node.columns.kind.empty() && node.columns.kind != name_of(right) && !is_sink) {
            findings_.push_back(
                {"node_column_mismatch", node.id, plan_of(node.at), 0.0,
                 fmt::format("node {}: its kind is {} and should be {}", node.id, node.columns.kind, name_of(right))});
        }
    }

    NetworkFile const& file_;
    Joints const& joints_;
    Graph const& g_;
    Findings& findings_;
    std::vector<LineMeasures> measured_; ///< by arc
    std::vector<InTree> tree_;           ///< by arc
    std::vector<double> longest_;        ///< by arc
    std::vector<double> strahler_;       ///< by arc
    std::vector<AtNode> at_node_;        ///< by node
    std::vector<std::size_t> order_;     ///< arcs of trees in upstream order
};

} // namespace

void check_numbers(NetworkFile const& file, Joints const& joints, Graph const& meant,
                   std::vector<char> const& ambiguous, Findings& findings) {
    std::size_t const junctions = joints.junctions.ids.size();
    if (file.says.downstream) {
        check_downstream(file, meant, ambiguous, findings);
    }
    check_orders(file, meant, junctions, findings);
    if (file.says.basin) {
        check_basins(file, meant, junctions, findings);
    }
}

void check_columns(NetworkFile const& file, Joints const& joints, Graph const& meant, Findings& findings) {
    Columns(file, joints, meant, findings).check();
}

} // namespace thalweg::measure::topology_steps
