// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/stream_network.hpp>

/// One step of meander. Private to this module.
namespace thalweg::network {

/// A river from its source to where a larger one takes its name, or its outlet, as points along it.
struct Stem {
    std::size_t begin = 0; ///< number of its first point
    std::size_t end = 0;   ///< after that of its last
    NodeId source = 0;
    NodeId mouth = 0; ///< node in which it ends: a point of the river it joins, or the outlet
    bool joins = false;
};

/// A network as points along its rivers, and back.
struct Stems {
    std::vector<Stem> stems;              ///< every one after that which it joins
    std::vector<Vec2> at;                 ///< [m] by point: vertices, and between them so that steps are a cell or less
    std::vector<double> way_m;            ///< [m] by point: from the stem's beginning
    std::vector<double> area_m2;          ///< [m2] by point: of its arc
    std::vector<std::size_t> stem_of;     ///< by point
    std::vector<std::size_t> first_point; ///< by arc
    std::vector<std::size_t> last_point;  ///< by arc
    std::vector<std::size_t> node_point;  ///< by node with arcs: its point on the largest river through it
};

/// Equal steps between two vertices, of one cell and a half at most: how many, and one of them.
struct EvenSteps {
    double count;
    Vec2 step;
};

EvenSteps steps_between(Vec2 from, Vec2 to, double step_m);

/// Takes: a forest, its index, by arc its area [m2], and the step [m]. At a node the river of the largest area goes on
/// (ties: the lower arc number).
Stems stems_of(StreamNetwork const& network, std::vector<double> const& area_m2, double step_m);

} // namespace thalweg::network
