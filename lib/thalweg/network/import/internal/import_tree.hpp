// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/network/import/internal/import_lines.hpp>

/// Trees of pieces and what votes for their direction. Private to this module.
namespace thalweg::network::import_steps {

using Votes = std::vector<int>; ///< by piece: 1 runs as drawn, -1 against it, 0 does not say

/// What the file says for certain about the direction of pieces.
struct Evidence {
    enum class Kind : std::uint8_t { links, column, height, rank, drawn };
    Kind kind;
    Votes votes;
    char const* name; ///< "by NAME", for messages
};

/// The evidence to use, the most trusted first. Throws: BadInput when the file lacks what is asked for.
std::vector<Evidence> evidence_of(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                                  Orientation asked);

std::size_t other_end(Piece const& piece, std::size_t node);

/// The pieces that lead to a root.
struct Tree {
    std::vector<std::size_t> nodes; ///< the component, each after the one it was reached from
    std::vector<PieceId>& towards;  ///< by node: piece towards the first of them, no_piece for it
};

/// Takes: pieces whose component at `outlet` is a tree.
void root_at(Pieces const& p, std::size_t outlet, Tree& tree);

/// The length of a piece in whole micrometres: sums of them are exact in any order.
std::int64_t weight(Piece const& piece);

/// By place in tree.nodes: the weight of the pieces that vote against this node as the outlet. cost: room for every
/// node.
std::vector<std::int64_t> against(Pieces const& p, Tree const& tree, Votes const& votes,
                                  std::vector<std::int64_t>& cost);

/// [m] By node: distance to the border of the lines' box.
std::vector<double> border_distances(Pieces const& p, std::vector<RiverLine> const& lines);

} // namespace thalweg::network::import_steps
