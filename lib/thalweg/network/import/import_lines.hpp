// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: A river file is a drawing: ends miss each other by centimetres, lines cross where no vertex
// is, some are drawn upstream, channels fork and meet again. The import makes a forest of it in
// steps, each of which reports what it did. Ends are snapped, duplicates dropped, lines cut at
// their exact crossings, gaps of a cell or so closed and rivers led through lakes, so that pieces
// meet at nodes only. Each piece gets a direction by the most trusted evidence that the file has,
// else by angles at confluences, the border, the drawing and a DEM together. At each divergence one
// branch stays and the others become secondary. Then every node has one way out, and pieces that
// follow one another are joined to arcs.
// Source: ours. Directions: docs/algorithms/river_directions.md; ends that nearly meet:
// docs/decisions/0035-ends-that-nearly-meet.md; attributes that count: docs/river_files.md.
// Cost: O(n log n) for n vertices where lines seldom cross (docs/performance.md: 0.3 us an arc for
// the crossings of 1000 arcs). Directions cost O(r log r) for a tree of r reaches; a part full of
// loops costs one search for each bridge that leaves it. One thread, but for the search for
// duplicates.
// Not for: networks that another program has checked, with ids, nodes and links (from_file.hpp
// keeps them); clipping, artificial channels (prepare_lines.hpp) and missing heights
// (river_heights.hpp), which come before. A group of lines gets one outlet: a delta is oriented to
// one of its mouths.
// Example:
//     ImportedNetwork const imported = import_lines(lines, {.cell_m = grid.cell_m, .dem = &dem});
//     run.report(imported.directions.doubts); // groups whose direction may be wrong
//     StreamNetwork const& rivers = imported.network;

namespace thalweg::network {

/// How the flow direction of a component, and so its outlet, is found.
enum class Orientation : std::uint8_t {
    /// by links if the file has any, else by its nodes, else by a direction column, else by height if every line has
    /// heights, else by rank if the file gives one, which is turned where links, areas or the drawn direction say that
    /// it rises downstream; where these are silent as drawn if that is free of contradictions, else by a DEM, angles at
    /// confluences, the border and the drawn direction together (docs/algorithms/river_directions.md)
    automatic,
    height,       ///< downhill
    rank,         ///< towards lower ranks
    as_drawn,     ///< in the file's direction
    links,        ///< by the file's links, nodes or direction column, else as automatic without heights and ranks
    least_turned, ///< to the end of the component for which the least length of lines is reversed
    topology      ///< to the end of the component nearest the border of the box
};

/// What happens at divergences.
enum class Divergences : std::uint8_t {
    main, ///< the main path is kept, other branches become secondary
    error
};

/// Which ends are joined to lines within the snapping distance.
enum class SnappedEnds : std::uint8_t {
    all,
    open ///< all within 1e-6 of the box's diagonal; farther those that meet no other line, and not to a line that
         ///< theirs meets at its other end: nothing collapses
};

/// Options of import_lines().
struct ImportParams {
    double snap_m = 0.0; ///< [m] >= 0, closer ends are joined; 0: 1e-6 of the box's diagonal
    Orientation orientation = Orientation::automatic;
    bool join = true; ///< lines that meet end to end become one arc
    Divergences divergences = Divergences::main;
    SnappedEnds snapped = SnappedEnds::all;
    /// [m] >= 0, 0: gaps stay. An end that meets nothing is joined to the nearest line of another connected part within
    /// half of it, or within two where the next candidate is five times as far; a line to the one that its link names
    /// over a tenth of the shorter of both. Springs, by evidence or a drawing without contradictions, are joined only
    /// to ends from which water comes. A line that steps back by less is straightened; one of four cells or more of
    /// which nine tenths lie within a quarter of a cell of others is their duplicate
    double cell_m = 0.0;
    Raster<float> const* dem = nullptr; ///< [m] heights for automatic and links, in the lines' CRS; null: none
    Grid const* frame = nullptr;        ///< ways through lakes stay two cells inside it; null: anywhere
    /// Rivers that end at a lake that none leaves run on together, to its shore nearest to the frame's border.
    bool drains_lakes = false;
};

/// How the directions of a file's lines were found; of automatic and links.
struct Directions {
    /// Length that runs against its drawn direction.
    struct Turned {
        std::string by;        ///< evidence, for readers: "angles at confluences"
        double length_m = 0.0; ///< > 0
    };
    std::vector<Turned> turned;    ///< the greatest length first
    double drawn_downstream = 0.5; ///< [0, 1] estimated share of reaches drawn downstream; 0.5: uninformative
    double uncertain_m = 0.0;      ///< length of groups of lines of which more than 5 % may be wrong
    double expected_wrong_m = 0.0; ///< of uncertain_m
    /// One a group: uncertain_direction [expected wrong share of its length], second_outlet [score gained],
    /// conflicting_direction [share of its length]; one an evidence: contradicted_direction [share of its length]
    std::vector<Finding> doubts;
};

/// What import_lines() returns.
struct ImportedNetwork {
    StreamNetwork network;
    /// [m] by arc, by vertex: the file's heights; empty: none. Where arcs meet, the lowest, but not below the next
    /// vertex downstream
    std::vector<std::vector<double>> arc_z;
    /// snapped [m], duplicate [m], removed [vertices], split [rivers that meet], reversed [m], joined [m], secondary
    /// [m], height [m between rivers that meet], cut [m that a river steps back or
    /// passes the one it meets]
    std::vector<Finding> repairs;
    std::vector<std::vector<Stretch>> stretches = {}; ///< by arc, downstream: the features it is made of
    std::vector<SecondaryLine> secondary = {}; ///< left out of the network: duplicates, lines too short, branches
    Directions directions = {};
};

/// Imports drawn lines as a network: snaps ends, splits at crossings (exact), drops duplicates, orients downstream,
/// joins lines that meet end to end. An end within snap_m of another line is joined to its nearest vertex there, else
/// to the nearest point of a segment. A joined arc has the feature of its longest piece; lines of different types are
/// not joined.
///
/// At a divergence (braids and loops too) the main path stays: the branch that the file marks as main, else that named
/// by a line upstream, else the same line, else the largest, else that of the same name, else of the least rank, else
/// the straightest (ties: by position). A cycle without an exit loses its smallest piece. Other branches become
/// secondary, down to where they rejoin or a stream with its own source joins. Two rivers that leave one place are a
/// divergence if links, heights or ranks say so, or under as_drawn; if only the drawn direction does and no loop is
/// closed, one is reversed. Drawn directions are ignored under topology and in a component with loops where over a
/// quarter of its length would be reversed: the tree of the largest, then shortest, paths to the outlet stays.
/// \param lines polylines [m]
/// \return a forest; every vertex of a kept line stays, in order and within 1e-6 m (snapped ends within snap_m, each
/// reported); only crossings are added, only tips where a line turns back onto itself or passes another are removed
/// ("cut")
/// \throws BadInput naming the feature and position: NaN; a line of length 0; heights or ranks by which a river runs
/// away from both ends; no line left; orientation by data that the file lacks; under Divergences::error a cycle or a
/// bifurcation (automatic: by height or rank only)
/// \throws BadParameter when a parameter is outside its range
ImportedNetwork import_lines(RiverLines const& lines, ImportParams const& params = {}, Run const& run = {});

/// Takes the file's heights as the network's.
/// \param imported as import_lines returns it
/// \param lines the lines it was made of
/// \return heights do not rise downstream
/// \throws BadInput when there are none, or a river runs uphill: "river 3 in F runs uphill between vertex 4 (12.1 m)
/// and 5 (12.9 m)"; vertices are counted from 1
ElevatedNetwork take_file_heights(ImportedNetwork const& imported, RiverLines const& lines);

} // namespace thalweg::network
