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

/// The steps of import_lines, in order.
namespace thalweg::network::import_steps {

/// [m] Points closer than this are equal: the precision to which coordinates are rounded on reading.
inline constexpr double same_point_m = 1e-6;

/// Union-find; a set is identified by its first element.
class Sets {
public:
    explicit Sets(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), std::size_t{0}); }
    std::size_t of(std::size_t n) {
        while (root_[n] != n) {
            n = root_[n] = root_[root_[n]];
        }
        return n;
    }
    /// \return false: they were already in one set.
    bool join(std::size_t a, std::size_t b) {
        a = of(a);
        b = of(b);
        root_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::vector<std::size_t> root_;
};

/// [m] diagonal of the box around all vertices.
double diagonal_of(std::vector<RiverLine> const& lines);

/// [m] By how much the lines' heights may be off by noise.
double noise_of(std::vector<RiverLine> const& lines);

/// The plan of the lines.
std::vector<std::vector<Vec2>> plan_of(std::vector<RiverLine> const& lines);

/// A position on a segment where a vertex is to be inserted.
struct Insertion {
    std::size_t line = 0;
    std::size_t segment = 0;
    double along = 0.0; ///< [0,1]
    Vec2 at;
};

/// Inserts vertices with interpolated heights. Insertions on one segment keep their order if `along` is equal.
void insert(std::vector<RiverLine>& lines, std::vector<Insertion> insertions);

/// Drops vertices that repeat the previous one; a line whose vertices are all equal keeps one.
/// \return number dropped, by line
std::vector<std::int64_t> drop_repeats(std::vector<RiverLine>& lines);

/// The lines left out of the network, with reasons.
struct Left {
    std::vector<Finding>& repairs;
    std::vector<SecondaryLine>& secondary;
};

/// Drops every line whose vertices are all within snap_m of those of an earlier one, in either direction.
void drop_copies(std::vector<RiverLine>& lines, double snap_m, Left& left, Run const& run);

/// Removes the lines that are marked.
void erase_marked(std::vector<RiverLine>& lines, std::vector<char> const& is_gone);

/// Drops every line of four cells or more of which nine tenths lie within a quarter of a cell of other lines: the last
/// ones of the file first.
void drop_near_copies(std::vector<RiverLine>& lines, double cell_m, Left& left, Run const& run);

/// Joins ends to other lines within snap_m, and drops lines that collapse to a point.
void snap(std::vector<RiverLine>& lines, double snap_m, SnappedEnds snapped, Left& left, Run const& run);

/// The finding on an end that is moved onto another line.
Finding moved_onto(RiverLine const& line, bool is_start, Vec2 to, double moved_m, std::int64_t onto);

/// Joins open ends of lines to other connected parts of the network as ImportParams::cell_m says.
/// \param lines split
/// \return whether any may have been joined: then lines may meet anew
bool close_gaps(std::vector<RiverLine>& lines, RiverLines const& file, ImportParams const& params, Left& left,
                Run const& run);

/// Inserts a vertex wherever lines meet, until they meet at common vertices only.
/// \throws BadInput naming the position if splitting does not converge
void split(std::vector<RiverLine>& lines, Run const& run);

using PieceId = std::size_t; ///< index into Pieces::pieces
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

/// Lines split where they meet: pieces between nodes.
struct Pieces {
    std::vector<Piece> pieces;
    std::vector<Vec2> nodes;
    std::vector<std::vector<std::size_t>> at_node; ///< pieces that end in the node, ascending
};

/// Drops ends of split lines that pass the river they meet by at most most_m: drawing errors are not rivers.
void drop_overshoots(std::vector<RiverLine>& lines, double most_m, Left& left);

/// Cuts split lines into pieces; parts that coincide with an earlier line are dropped.
Pieces cut(std::vector<RiverLine> const& lines, Left& left);

/// \throws BadInput naming rivers and position when pieces form a cycle.
void refuse_cycles(Pieces const& pieces, std::vector<RiverLine> const& lines, std::string const& name);

using Votes = std::vector<int>; ///< by piece: 1: as drawn, -1: against it, 0: unknown

/// What the file states with certainty about the direction of pieces.
struct Evidence {
    enum class Kind : std::uint8_t { links, nodes, column, height, rank, drawn };
    Kind kind;
    Votes votes;
    char const* name;                       ///< "by NAME", for messages
    std::vector<std::int64_t> weights = {}; ///< by piece, of its vote; empty: weight()
};

/// An end of a line: 2 l is the first vertex of line l, 2 l + 1 its last.
Vec2 end_of(RiverLine const& line, std::size_t e);

/// How lines hang together.
struct Parts {
    std::vector<std::size_t> of_line; ///< its connected part
    std::vector<char> is_open;        ///< by end: it meets no other line
    std::size_t most = 0;             ///< numbers are less
};

Parts parts_of(Pieces const& pieces, std::vector<RiverLine> const& lines);

/// Leads rivers that end at a lake through it: from their open ends, within half a cell of its shore (two where water
/// arrives) or inside, to its outflow, or to the river that passes through it. Straight where that way is in the water,
/// else along the medial lines between the pieces of shore from one mouth to the next. The lines added have feature 0.
/// \param lines split
/// \return whether any were added
bool cross_lakes(std::vector<RiverLine>& lines, RiverLines const& file, ImportParams const& params, Left& left,
                 Run const& run);

/// Chooses the evidence to use, the most trusted first. Makes ranks fall downstream, unless these are asked for: where
/// links, areas or, together, meeting lines as they are drawn say that they rise, they are counted from the other end,
/// with a finding (turned_rank).
/// \throws BadInput when the file lacks requested data
std::vector<Evidence> evidence_of(Pieces const& p, std::vector<RiverLine>& lines, RiverLines const& file,
                                  Orientation asked, std::vector<Finding>& repairs);

/// The pieces that are not in the network, and the known directions of all.
struct DividedPieces {
    std::vector<char const*> reason; ///< by piece: why it is secondary; null: it is not
    std::vector<int> runs;           ///< by piece: 1: as drawn, -1: against it, 0: unknown
};

/// Keeps the main path at every bifurcation, and removes the pieces of other branches from pieces.at_node, which
/// becomes a forest. evidence: the most trusted first. drawn: by piece, 1 or -1: its direction if nothing is certain.
DividedPieces divide(Pieces& pieces, std::vector<RiverLine> const& lines, RiverLines const& file,
                     Orientation orientation, std::vector<Evidence> const& evidence, std::vector<int> const& drawn,
                     Run const& run);

/// Finds the piece that leaves each node; no_piece: an outlet. The network flows along pieces towards outlets. pieces:
/// a forest; evidence, drawn: as for divide().
/// \throws BadInput naming rivers and position of a bifurcation, under Divergences::error
std::vector<PieceId> orient(Pieces const& pieces, std::vector<RiverLine> const& lines, RiverLines const& file,
                            ImportParams const& params, std::vector<Evidence> const& evidence,
                            std::vector<int> const& drawn);

/// Removes parts of the network fed by a minor channel alone: from there down to the next node with another inflow.
void drop_unfed(Pieces& pieces, DividedPieces& divided, std::vector<PieceId>& leaves);

/// Reports the lines that run against their drawn direction.
void report_turned(Pieces const& p, std::vector<RiverLine> const& lines, std::vector<PieceId> const& leaves,
                   std::vector<Finding>& repairs);

/// The secondary pieces as lines, each with a finding.
std::vector<SecondaryLine> secondary_lines(Pieces const& pieces, DividedPieces const& divided,
                                           std::vector<RiverLine> const& lines, std::vector<Finding>& repairs);

std::size_t other_end(Piece const& piece, std::size_t node);

/// The pieces that lead to a root.
struct Tree {
    std::vector<std::size_t> nodes; ///< the component, each after the node from which it was reached
    std::vector<PieceId>& towards;  ///< by node: piece towards the root; no_piece: the root
};

/// Builds the tree of a component.
/// \param outlet its component is a tree
void root_at(Pieces const& p, std::size_t outlet, Tree& tree);

/// The length of a piece in whole micrometres: sums are exact in any order.
std::int64_t weight(Piece const& piece);

/// By index in tree.nodes: the weight of the pieces that vote against this node as the outlet. cost: a buffer with an
/// entry for every node. weights: as those of an Evidence.
std::vector<std::int64_t> against(Pieces const& p, Tree const& tree, Votes const& votes,
                                  std::vector<std::int64_t>& cost, std::vector<std::int64_t> const& weights = {});

/// [m] By node: distance to the border of the lines' box.
std::vector<double> border_distances(Pieces const& p, std::vector<RiverLine> const& lines);

/// The directions of pieces, determined before any is removed.
struct FoundDirections {
    std::vector<int> runs;                 ///< by piece: 1: as drawn, -1: against it
    std::vector<int> said;                 ///< by piece: the same by links, columns, heights or ranks; 0: unknown
    std::vector<char const*> by;           ///< by piece: the deciding evidence
    std::vector<char const*> contradicted; ///< evidence that contradicts itself in large part
    Directions report;                     ///< without turned
};

/// Determines directions under automatic and links: docs/algorithms/river_directions.md. Otherwise everything runs as
/// drawn. Removes a direction column that contradicts itself from the evidence.
FoundDirections find_directions(Pieces const& p, std::vector<RiverLine> const& lines, ImportParams const& params,
                                std::vector<Evidence>& evidence, Run const& run);

/// Whether the drawn direction, or its reverse, is that of the water.
bool is_drawing_sure(FoundDirections const& found);

/// By end: 1: water leaves the line there, -1: it begins there, 0: unknown.
/// \param runs by piece: 1: as drawn, -1: against it, 0: unknown
std::vector<int> flows_at_ends(Pieces const& pieces, std::vector<RiverLine> const& lines, std::vector<int> const& runs);

/// Adds up reversed lengths, and reports evidence that more than a tenth of the network contradicts.
Directions review_directions(Pieces const& p, std::vector<RiverLine> const& lines, FoundDirections const& found,
                             std::vector<PieceId> const& leaves);

} // namespace thalweg::network::import_steps
