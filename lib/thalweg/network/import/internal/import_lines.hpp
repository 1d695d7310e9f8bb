// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/import/import_lines.hpp>

/// The steps of import_lines, in their order.
namespace thalweg::network::import_steps {

/// [m] Points closer than this are the same point: the step to which coordinates are rounded when they are read.
inline constexpr double same_point_m = 1e-6;

/// Which of some things hang together; a set is named by its first.
class Sets {
public:
    explicit Sets(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), std::size_t{0}); }
    std::size_t of(std::size_t n) {
        while (root_[n] != n) {
            n = root_[n] = root_[root_[n]];
        }
        return n;
    }
    /// False when they were one already.
    bool join(std::size_t a, std::size_t b) {
        a = of(a);
        b = of(b);
        root_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<std::size_t> root_;
};

/// [m] of the box around all vertices.
double diagonal_of(std::vector<RiverLine> const& lines);

/// The plan of the lines.
std::vector<std::vector<Vec2>> plan_of(std::vector<RiverLine> const& lines);

/// A place on a segment, for a vertex to be added there.
struct Insertion {
    std::size_t line = 0;
    std::size_t segment = 0;
    double along = 0.0; ///< [0,1]
    Vec2 at;
};

/// Adds vertices, their heights interpolated. Insertions on one segment come in its order where `along` is equal.
void insert(std::vector<RiverLine>& lines, std::vector<Insertion> insertions);

/// Drops vertices that repeat the one before them; a line of one vertex is left over where all were the same.
/// Gives: how many were dropped, by line.
std::vector<std::int64_t> drop_repeats(std::vector<RiverLine>& lines);

/// What is not in the network, and why.
struct Left {
    std::vector<Finding>& repairs;
    std::vector<SecondaryLine>& secondary;
};

/// Drops every line whose vertices all lie within snap_m of those of an earlier one, in either direction.
void drop_copies(std::vector<RiverLine>& lines, double snap_m, Left& left, Run const& run);

/// Joins ends to other lines within snap_m, and drops what shrinks to a point.
void snap(std::vector<RiverLine>& lines, double snap_m, SnappedEnds snapped, Left& left, Run const& run);

/// Adds a vertex to every line wherever it meets another or itself, until lines meet in common vertices only.
/// Throws BadInput naming the place where that comes to no end.
void split(std::vector<RiverLine>& lines, Run const& run);

using PieceId = std::size_t; ///< place in Pieces::pieces
inline constexpr PieceId no_piece = std::numeric_limits<PieceId>::max();

/// A part of a line between two nodes, without nodes inside.
struct Piece {
    std::size_t line = 0;
    std::size_t first = 0; ///< its vertices are first ... last of the line
    std::size_t last = 0;
    std::size_t from = 0; ///< node of vertex first
    std::size_t to = 0;   ///< node of vertex last
    double length_m = 0.0;
};

/// Lines cut where they meet: pieces over the nodes.
struct Pieces {
    std::vector<Piece> pieces;
    std::vector<Vec2> nodes;
    std::vector<std::vector<std::size_t>> at_node; ///< pieces that end in the node, ascending
};

/// Drops ends of split lines that pass the river they meet by most_m or less: no slip of the hand is a river.
void drop_overshoots(std::vector<RiverLine>& lines, double most_m, Left& left);

/// Cuts split lines into pieces; what lies on an earlier line is dropped.
Pieces cut(std::vector<RiverLine> const& lines, Left& left);

/// Throws BadInput naming rivers and place when pieces form a cycle.
void refuse_cycles(Pieces const& pieces, std::vector<RiverLine> const& lines, std::string const& name);

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

/// Which pieces are not in the network, and what is known of the direction of all.
struct Divided {
    std::vector<char const*> reason; ///< by piece: why it is secondary; null where it is not
    std::vector<int> runs;           ///< by piece: 1 as drawn, -1 against it, 0 nobody knows
};

/// Keeps the main path wherever water could go more than one way, and takes the pieces of the others out of
/// pieces.at_node: what stays there is a forest.
/// evidence: the most trusted first. drawn: by piece, 1 or -1: how it runs where nobody says for certain.
Divided divide(Pieces& pieces, std::vector<RiverLine> const& lines, RiverLines const& file, Orientation orientation,
               std::vector<Evidence> const& evidence, std::vector<int> const& drawn, Run const& run);

/// The piece that leaves each node, by node; no_piece at outlets. The network flows along pieces towards them.
/// Takes: a forest; evidence and drawn as of divide(). Throws: BadInput naming rivers and place where two run away,
/// under Divergences::error.
std::vector<PieceId> orient(Pieces const& pieces, std::vector<RiverLine> const& lines, RiverLines const& file,
                            ImportParams const& params, std::vector<Evidence> const& evidence,
                            std::vector<int> const& drawn);

/// Takes out of the network what a minor channel fed alone: from there down to the next node where something else
/// flows in.
void drop_unfed(Pieces& pieces, Divided& divided, std::vector<PieceId>& leaves);

/// Tells of the lines that run against their drawn direction.
void report_turned(Pieces const& p, std::vector<RiverLine> const& lines, std::vector<PieceId> const& leaves,
                   std::vector<Finding>& repairs);

/// The secondary pieces as lines, each with a finding.
std::vector<SecondaryLine> secondary_lines(Pieces const& pieces, Divided const& divided,
                                           std::vector<RiverLine> const& lines, std::vector<Finding>& repairs);

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
