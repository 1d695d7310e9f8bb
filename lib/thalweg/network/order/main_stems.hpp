// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// By what the main one of several arcs that end in a node is told.
enum class MainBy : std::uint8_t {
    file,    ///< level path, name, class, area, as far as the file has them
    name,    ///< the name of the arc downstream
    area,    ///< largest contributing area
    length,  ///< longest flow path from a source
    arbolate ///< greatest sum of the lengths of all arcs upstream
};

/// What a file says of arcs that tells main stems.
struct StemClues {
    /// Of an arc.
    struct OfArc {
        std::int64_t path = 0;         ///< its level path: the same along one stem; 0: unknown
        double level = 0.0;            ///< class or level of its stem: greater for lesser ones; 0: unknown
        std::string name = {};         ///< of its river; "": none
        double area_m2 = 0.0;          ///< contributing area at its lower end; 0: unknown
        std::vector<double> size = {}; ///< as RiverLine
    };
    std::vector<OfArc> arcs; ///< by arc
};

/// Chooses the arc by which the main stem goes on upstream of each node. A clue decides between the arcs that the clues
/// before it leave: those of the level path of the arc downstream; those of its name; those of the lowest level or, at
/// an outlet too, the largest size; the longest flow path; the lowest arc number.
/// \param network a forest
/// \param clues of this network; without arcs: none
/// \param by which clues count: file all of them, name and area that one; the length is the last in each case
/// \return by node; no_arc where none ends
/// \throws BadInput for clues of another network or a network that is not a forest
///
/// Source: NHDPlus Version 2 User Guide (level paths); \cite hack1957.
std::vector<ArcId> main_inflows(StreamNetwork const& network, StemClues const& clues, MainBy by = MainBy::file);

} // namespace thalweg::network
