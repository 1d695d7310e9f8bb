// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

/// The steps of check_topology, in order.
namespace thalweg::measure::topology_steps {

using FileArc = NetworkFile::FileArc;
using FileNode = NetworkFile::FileNode;
using Findings = std::vector<Finding>;

inline constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
inline constexpr double greatest_coordinate = 1e18;

inline bool is_number(double c) {
    return std::fabs(c) < greatest_coordinate;
}
inline Vec2 plan_of(Vec3 p) {
    return {p.x, p.y};
}

/// The file's own number of an arc.
inline std::int64_t number_of(NetworkFile const& file, FileArc const& arc) {
    return arc.id - file.id_shift;
}

/// A position for findings: the first vertex that is finite.
Vec2 start_of(FileArc const& arc);

/// Finds bad and repeated ids.
/// \return by arc: whether its id is ambiguous
std::vector<char> check_ids(NetworkFile const& file, Findings& findings);

/// Lines in plan by arc, without repeated vertices; empty: the line cannot be checked.
using Outlines = std::vector<std::vector<Vec2>>;

/// Finds lines with fewer than two vertices, with vertices that are not numbers, or of length 0, and repeated vertices.
Outlines check_shapes(NetworkFile const& file, Findings& findings);

/// Finds arcs with the vertices of an earlier one, in either direction.
/// \return by arc: whether it is such a copy
std::vector<char> check_copies(NetworkFile const& file, Outlines const& plans, Findings& findings);

/// Junctions: one for every node_id that a node, an arc or both use.
struct Junctions {
    std::vector<std::int64_t> ids; ///< ascending
    std::vector<std::size_t> node; ///< number of the first node with that id; none: no node has it
    std::vector<char> repeated;    ///< several nodes have the id
    std::size_t of(std::int64_t id) const;
};

/// The junctions at an arc's ends.
using Ends = std::array<std::size_t, 2>;

/// The arcs' ends.
struct Joints {
    Junctions junctions;
    std::vector<Ends> said;                  ///< from_node and to_node of the file, in the direction of flow
    std::vector<Ends> meant;                 ///< the same if they are right, otherwise where the line ends
    std::vector<std::array<char, 2>> faulty; ///< for from_node, to_node: a fault of this end has been reported
    std::vector<char> against;               ///< the line is drawn from meant[1] to meant[0]

    Vec2 place(std::size_t arc, std::size_t end, Outlines const& plans) const {
        auto const& line = plans[arc];
        return (end == 0) == (against[arc] == 0) ? line.front() : line.back();
    }
};

/// Finds ends without a node or off their node, arcs in the wrong direction, and dangling ends.
/// \param left_out by arc: whether its ends are not checked
Joints check_ends(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out,
                  std::vector<char> const& ambiguous, Findings& findings);
void check_near_ends(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out, double near_m,
                     Joints& joints, Findings& findings, Run const& run);

/// Finds arcs that rise in the direction of flow.
void check_heights(NetworkFile const& file, Outlines const& plans, std::vector<char> const& left_out,
                   Joints const& joints, Findings& findings);

/// The arcs at each junction, ascending.
class Incidence {
public:
    /// end: 0 or 1 of each arc's ends.
    Incidence(std::vector<Ends> const& ends, std::size_t end, std::vector<char> const& left_out, std::size_t junctions);
    std::span<std::size_t const> at(std::size_t junction) const {
        return {arcs_.data() + first_[junction], first_[junction + 1] - first_[junction]};
    }

private:
    std::vector<std::size_t> first_; // by junction, and one past the last
    std::vector<std::size_t> arcs_;
};

struct Graph {
    Graph(std::vector<Ends> const& arc_ends, std::vector<char> const& arcs_left_out, std::size_t junctions)
        : ends(arc_ends), left_out(arcs_left_out), in(arc_ends, 1, arcs_left_out, junctions),
          out(arc_ends, 0, arcs_left_out, junctions) {}

    std::vector<Ends> const& ends;
    std::vector<char> const& left_out;
    Incidence in;
    Incidence out;
};

/// Finds nodes with several outflows or without arcs, cycles, and parts without an outlet.
void check_trees(NetworkFile const& file, Joints const& joints, Graph const& said, Findings& findings);

/// Finds wrong ds_arc, orders and basins.
void check_numbers(NetworkFile const& file, Joints const& joints, Graph const& meant,
                   std::vector<char> const& ambiguous, Findings& findings);

/// Finds columns of arcs and nodes that contradict the lines and trees.
void check_columns(NetworkFile const& file, Joints const& joints, Graph const& meant, Findings& findings);

/// Finds spikes, arcs that touch themselves, and arcs that meet others away from common nodes.
void check_meetings(NetworkFile const& file, Outlines const& plans, Joints const& joints, double near_m,
                    Findings& findings, Run const& run);

} // namespace thalweg::measure::topology_steps
