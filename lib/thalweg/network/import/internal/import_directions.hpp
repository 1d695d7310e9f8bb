// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/network/import/internal/import_lines.hpp>

/// Which way pieces run where the file does not say. Private to this module.
namespace thalweg::network::import_steps {

/// The directions of pieces, found before any is left out.
struct FoundDirections {
    std::vector<int> runs;       ///< by piece: 1 as drawn, -1 against it
    std::vector<int> said;       ///< by piece: the same by links, columns, heights or ranks; 0: they do not say
    std::vector<char const*> by; ///< by piece: what decides
    std::vector<char const*> contradicted; ///< evidence that much of itself contradicts
    Directions report;                     ///< without turned
};

/// Under automatic and links: docs/algorithms/river_directions.md. Else everything runs as drawn. Takes a direction
/// column that contradicts itself out of the evidence.
FoundDirections find_directions(Pieces const& p, std::vector<RiverLine> const& lines, ImportParams const& params,
                                std::vector<Evidence>& evidence, Run const& run);

/// Adds up what was turned, and doubts evidence that more than a tenth of the network contradicts.
Directions review_directions(Pieces const& p, std::vector<RiverLine> const& lines, FoundDirections const& found,
                             std::vector<PieceId> const& leaves);

} // namespace thalweg::network::import_steps
