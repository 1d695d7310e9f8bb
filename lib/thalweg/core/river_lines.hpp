// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// What a file says of a line at a bifurcation.
enum class Channel : std::uint8_t { unknown, main, minor };

/// A river line of a file, in the grid's coordinates.
struct RiverLine {
    std::int64_t feature = 0;   ///< number in its layer, from 1
    std::vector<Vec3> vertices; ///< [m], coordinates rounded to 1e-6 m; z is NaN where the file has none
    std::string type;           ///< river type (Rosgen) from the type field, or ""
    std::int64_t rank = 0;      ///< flow rank from the direction field, decreasing downstream; 0: none
    int lambda = 0;             ///< generator of the network that grows from a stroke; 0: none
    std::int64_t down = 0;      ///< feature of the line downstream, by the file's links; 0: none
    /// Areas, discharge, orders, classes by the fields of the file, the most reliable first: larger for larger rivers,
    /// 0: unknown. The same fields for all lines of a file; compared one after another.
    std::vector<double> size = {};
    Channel channel = Channel::unknown;
    std::string name = {};       ///< the river's name, or ""
    std::string artificial = {}; ///< what kind of artificial channel it is ("waterway canal"), or ""
    std::int64_t id_shift = 0;   ///< feature is the file's own number and this: networks whose ids begin at 0
    int runs = 0;                ///< by a direction column: 1 as drawn, -1 against it, 0: it does not say
    double area_m2 = 0.0;        ///< drainage area at its lower end by the file; 0: unknown

    /// The number by which the file itself calls it.
    std::int64_t number() const { return feature - id_shift; }
};

/// Why a line is left out of the network.
enum class LeftOut : std::uint8_t {
    filter,     ///< by its fields no natural watercourse
    coast,      ///< a coastline by its fields
    grid,       ///< beyond the grid
    duplicate,  ///< another runs there
    too_short,  ///< shorter than the distance at which ends are joined
    divergence, ///< water runs another way
    pruned,     ///< shorter than the recipe wants
    head        ///< above where the river begins in the terrain
};

/// A line, or part of one, that is left out of the network.
struct SecondaryLine {
    std::int64_t feature = 0;
    std::vector<Vec3> vertices; ///< [m] as RiverLine
    std::string reason;         ///< "minor channel", "FTYPE Coastline", ...
    std::int64_t record = 0;    ///< of its attributes, from 1; 0: none
    LeftOut cause = LeftOut::divergence;
};

/// The river lines of a file.
struct RiverLines {
    std::vector<RiverLine> lines;
    std::string crs;                           ///< of the coordinates
    std::string name;                          ///< file (and layer), for messages
    bool has_z = false;                        ///< every vertex has a height
    std::vector<RiverLine> channels = {};      ///< artificial ones, see network::keep_connectors
    std::vector<SecondaryLine> secondary = {}; ///< other lines that are not natural watercourses
    std::vector<Finding> findings = {}; ///< left_out [vertices]: features without a line; not_a_line [shapes], by type
    AttributeTable attributes = {};     ///< of the features, record = feature
};

} // namespace thalweg
