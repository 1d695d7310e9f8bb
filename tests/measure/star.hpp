// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/measure/topology/internal/topology_steps.hpp>

namespace faults {

namespace steps = thalweg::measure::topology_steps;

/// Many arcs that end in one node and one from there to the outlet, checked as far as their columns.
struct Star {
    explicit Star(int arcs)
        : file(file_of(arcs)), joints(joints_of(file, before)), left_out(file.arcs.size(), 0),
          graph(joints.meant, left_out, joints.junctions.ids.size()) {}

    steps::Findings check_columns() const {
        steps::Findings found;
        steps::check_columns(file, joints, graph, found);
        return found;
    }

    steps::Findings before; ///< of the steps before
    thalweg::NetworkFile file;
    steps::Joints joints;
    std::vector<char> left_out;
    steps::Graph graph; ///< refers to them

private:
    static thalweg::NetworkFile file_of(int arcs) {
        thalweg::NetworkFile file;
        file.nodes = {{1, {0.0, 0.0, 0.0}}, {2, {0.0, -1.0, -1.0}}};
        file.arcs.push_back({1, 1, 2, 0, 1, arcs, 1, {{0.0, 0.0, 0.0}, {0.0, -1.0, -1.0}}});
        file.arcs[0].columns.hack = 1.0;
        for (int i = 0; i < arcs; ++i) {
            thalweg::Vec3 const at{static_cast<double>(i), 2.0 * arcs, 1.0};
            file.nodes.push_back({i + 3, at});
            file.arcs.push_back({i + 2, i + 3, 1, 1, 1, 1, 1, {at, {0.0, 0.0, 0.0}}});
            file.arcs.back().columns.hack = i == arcs - 1 ? 1.0 : 2.0;
        }
        return file;
    }
    static steps::Joints joints_of(thalweg::NetworkFile const& file, steps::Findings& found) {
        auto const ambiguous = steps::check_ids(file, found);
        auto const plans = steps::check_shapes(file, found);
        return steps::check_ends(file, plans, std::vector<char>(file.arcs.size(), 0), ambiguous, found);
    }
};

} // namespace faults
