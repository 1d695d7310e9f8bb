// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "glue.hpp"

#include <thalweg/core/channels.hpp>
#include <thalweg/core/lattice.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/growth/tokunaga/lsystem.hpp>
#include <thalweg/network/channels/channels.hpp>

/// What bind.py does not read from the headers: exceptions, classes, functions that change their arguments.
namespace thalweg::python {

template <> struct Fields<StreamNetwork> {
    static constexpr bool can_be_made = true;
    static constexpr bool is_raster = false;
    static constexpr char const* name = "StreamNetwork";
    static constexpr char const* signature = "__init__(self, nodes, from_nodes, to_nodes, lines=None, features=None, "
                                             "types=None, is_input=None, persistence=None)\n--\n\n";
    static StreamNetwork made(Args& in);
    /// Also of what has one: a network with heights, extracted streams.
    static StreamNetwork take(py::handle value, Place const& place);
};

template <> struct Fields<draw::Picture> {
    static constexpr bool can_be_made = false;
    static constexpr bool is_raster = false;
    static constexpr char const* name = "Picture";
    static constexpr char const* signature = "";
    static draw::Picture take(py::handle value, Place const& place) { return take_record<draw::Picture>(value, place); }
};

void require_sound(Grid const& grid);
void require_sound(Tin const& tin);
void require_sound(LatticeMesh const& mesh);
void require_sound(Channels const& channels);
void require_sound(network::ChannelsOfArcs const& drawn);
void require_sound(ElevatedNetwork const& network);
void require_sound(RiverLine const& line);
void require_sound(flow::FlowField const& drainage);
void require_sound(growth::TokunagaTree const& tree);
void require_sound(growth::LSystem const& system);

/// The exceptions of the library, and how they become those of Python.
void declare_errors(py::module_& module);
/// StreamNetwork.
void declare_stream_network(py::module_& module);
/// draw.Picture.
void declare_picture(py::module_& module);
/// io.write_geopackage
void define_io_by_hand(py::module_& module);
/// recipe.set_key, unset_key
void define_recipe_by_hand(py::module_& module);

/// report.report_json
void define_report_by_hand(py::module_& module);

} // namespace thalweg::python
