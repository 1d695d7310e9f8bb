// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// What says which way the rivers of a component run: which of its ends is the outlet.
enum class Orientation : std::uint8_t {
    automatic, ///< by the file's links where there are any, else by height where every line has Z, else by rank where
               ///< the file gives one, else the end of the component that turns the least length of the drawn direction
               ///< round (ties: as topology)
    height,    ///< downstream is down
    rank,      ///< downstream is where the rank falls
    as_drawn,  ///< the file's direction
    links,     ///< as the file's links say, else as least_turned
    least_turned, ///< the end of the component that turns the least length of the drawn direction round
    topology      ///< towards the end of the component nearest the border of the box
};

/// What is done where water could go more than one way.
enum class Divergences : std::uint8_t {
    main, ///< the main path is kept, the other branches are secondary
    error
};

/// Options of adopt().
struct ImportParams {
    double snap_m = 0.0; ///< [m] >= 0, ends closer than this are joined; 0 takes 1e-6 of the box's diagonal
    Orientation orientation = Orientation::automatic;
    bool join = true; ///< lines that meet end to end become one arc
    Divergences divergences = Divergences::main;
};

/// What adopt() returns.
struct Imported {
    StreamNetwork network;
    std::vector<std::vector<double>> arc_z; ///< [m] the file's heights by arc number and vertex; empty without Z.
                                            ///< Arcs that meet agree: the lowest of their heights, but not below the
                                            ///< next vertex downstream
    std::vector<Finding> repairs; ///< snapped [m moved], duplicate [m], removed [vertices], split [rivers that meet],
                                  ///< reversed [m], joined [m], secondary [m], height [m between
                                  ///< rivers that meet]
    std::vector<std::vector<Stretch>> stretches = {}; ///< by arc number, downstream: the features it is made of
    std::vector<SecondaryLine> secondary = {}; ///< what is not in the network: duplicates, lines too short, branches
};

/// Makes a network of lines somebody drew: snaps ends, splits at crossings (exact), drops duplicates, orients
/// downstream. An end within snap_m of another line is joined to its nearest vertex there, else to the nearest place of
/// its segment. Lines that meet end to end become one arc (join), of the feature of its longest piece, unless their
/// types differ. Where water could go more than one way (a divergence, a braid, a loop) the main path stays: at each
/// such place the branch that the file marks as main, else the one that a line upstream names as the next, else the one
/// that goes on as the same line, else the largest, else that of the same name, else that of the least rank, else the
/// one that turns least (ties: by place). Of a circle that has no way out the smallest piece goes. The other branches
/// are secondary, each down to where it rejoins or a stream with a source of its own joins it. Two rivers that run away
/// from one place are a divergence where the file's links, heights or ranks say so, or under as_drawn; where only the
/// drawn direction does, and no loop is closed, one of them is turned round. In a component with loops of which the
/// drawn directions contradict one another (more than a quarter of its length would be turned), or under topology, they
/// say nothing: the tree of the largest, then shortest ways to the outlet stays.
/// \param lines the polylines
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return trees; every vertex of every kept line stays, in its order and within 1e-6 m (snapped ends within snap_m,
/// each reported); only crossings are added.
/// \throws BadInput naming the feature and its place: NaN, a line of no length; heights or ranks by which a river runs
/// away from both its ends into places that nothing leaves; when there is no line, none is left, or what orientation
/// asks for is not in the file; under Divergences::error a cycle of rivers or a bifurcation (under automatic by height
/// or rank only)
/// \throws BadParameter
/// \throws Cancelled
Imported import_lines(RiverLines const& lines, ImportParams const& params = {}, Run const& run = {});

/// \param imported the imported network
/// \param lines the polylines
/// \return the heights the file gave, as those of the network.
/// \throws BadInput when there are none, or a river runs uphill: "river 3 in F runs uphill between vertex 4 (12.1 m)
/// and 5 (12.9 m)"; vertices are counted from 1
ElevatedNetwork take_file_heights(Imported const& imported, RiverLines const& lines);

} // namespace thalweg::network
