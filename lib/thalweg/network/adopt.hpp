// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

enum class Orientation : std::uint8_t {
    automatic, ///< by height where every line has Z, else by rank where the file gives one, else as_drawn if that is a tree, else topology
    height,    ///< downstream is down
    rank,      ///< downstream is where the rank falls
    as_drawn,  ///< the file's direction
    topology   ///< away from the sources towards each component's outlet (its end nearest the border of the box)
};

struct AdoptParams {
    double snap_m = 0.0; ///< [m] ends closer than this are joined; 0 takes 1e-6 of the box's diagonal
    Orientation orientation = Orientation::automatic;
};

struct Adopted {
    StreamNetwork network;
    std::vector<std::vector<double>> arc_z; ///< [m] the file's heights by arc number and vertex; empty without Z
    std::vector<Finding> repairs;           ///< snapped, split, duplicate, reversed, removed
};

/// Makes a network of lines somebody drew: snaps ends, splits at crossings (exact), drops duplicates, orients downstream.
/// Gives: trees; every vertex of every kept line stays, in its order and within 1e-6 m (snapped ends within snap_m,
/// each reported); only crossings are added.
/// Throws: BadInput naming the feature and its place: NaN, a line of no length, a cycle of rivers, a bifurcation.
Adopted adopt(RiverLines const& lines, AdoptParams const& params = {}, Run const& run = {});

/// The heights the file gave, as those of the network.
/// Throws: BadInput when a river runs uphill: "river 3 in F runs uphill between vertex 4 (12.1 m) and 5 (12.9 m)".
RaisedNetwork take_file_heights(Adopted const& adopted, RiverLines const& lines);

} // namespace thalweg::network
