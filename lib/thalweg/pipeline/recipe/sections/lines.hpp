// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/network/import/import_lines.hpp>

namespace thalweg::pipeline {

/// What coastlines among the lines of a file are to the land.
enum class Coastlines : std::uint8_t {
    sea, ///< its coast
    none ///< nothing
};

/// The keys of section [network] for drawn lines.
struct LinesRecipe {
    std::string path;
    std::string layer;
    std::string source_crs; ///< of a file that has none
    std::string type_field = "rosgen";
    std::string rank_field;
    std::string id_field;   ///< of a line, and
    std::string down_field; ///< of the line downstream; both or none
    double snap_m = 0.0;    ///< [m] 0 takes 1e-6 of the box's diagonal
    network::Orientation orientation = network::Orientation::automatic;
    std::string dem; ///< heights that lines are oriented by; "" for none
    network::Divergences divergences = network::Divergences::main;
    io::LineFilter filter = io::LineFilter::natural;
    Coastlines coastlines = Coastlines::sea;
    double keep = 0.99; ///< [0, 1] least share of the given length that must be in the network
};

} // namespace thalweg::pipeline
