// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "by_hand.hpp"

#include <fmt/format.h>

#include <thalweg/flow/given_directions.hpp>

#include "records.hpp"

namespace thalweg::python {

namespace {

/// The types of exceptions live as long as the process: translators use them at any time.
struct ErrorTypes {
    py::handle error, bad_parameter, bad_input, not_converged, io_error, cancelled;
};
ErrorTypes types;

py::handle error_type(py::module_& module, char const* name, py::object const& bases, char const* words) {
    py::object const type = py::reinterpret_steal<py::object>(
        PyErr_NewExceptionWithDoc((std::string("thalweg.") + name).c_str(), words, bases.ptr(), nullptr));
    module.attr(name) = type;
    return type.inc_ref();
}

/// A function of the library by its name in Python.
std::string in_python(std::string_view function) {
    for (auto const& [module, name] : renamed) {
        if (function.starts_with(module) && function.substr(module.size()).starts_with('.')) {
            return std::string(name) + std::string(function.substr(module.size()));
        }
    }
    return std::string(function);
}

void set_error(py::handle type, Error const& error) {
    py::object const words = py::module_::import("thalweg._show").attr("in_python")(text_of(error.what()));
    py::object const raised = type(words);
    raised.attr("where") = text_of(in_python(error.where()));
    PyErr_SetObject(type.ptr(), raised.ptr());
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 takes a function of this type
void translate(std::exception_ptr fault) {
    try {
        if (fault) {
            std::rethrow_exception(fault);
        }
    } catch (BadParameter const& e) {
        set_error(types.bad_parameter, e);
    } catch (BadInput const& e) {
        set_error(types.bad_input, e);
    } catch (NotConverged const& e) {
        set_error(types.not_converged, e);
    } catch (IoError const& e) {
        set_error(types.io_error, e);
    } catch (Cancelled const& e) {
        set_error(types.cancelled, e);
    } catch (Error const& e) {
        set_error(types.error, e);
    }
}

template <class T, class Of> std::vector<T> by_arc(StreamNetwork const& network, Of const& of) {
    std::vector<T> values;
    for (Arc const& arc : network.arcs()) {
        values.push_back(of(arc));
    }
    return values;
}

StreamNetwork const& network_in(py::object const& self) {
    return self.cast<StreamNetwork const&>();
}

} // namespace

void declare_errors(py::module_& module) {
    auto const base = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
    types.error = error_type(module, "Error", base(PyExc_Exception),
                             "Base class of what thalweg raises; `where` names the function: 'surface.diffuse'.");
    auto const error = py::reinterpret_borrow<py::object>(types.error);
    types.bad_parameter = error_type(module, "BadParameter", py::make_tuple(error, base(PyExc_ValueError)),
                                     "A parameter is outside its range.");
    types.bad_input = error_type(module, "BadInput", py::make_tuple(error, base(PyExc_ValueError)),
                                 "The input cannot be used; the message names the feature and its position.");
    types.not_converged =
        error_type(module, "NotConverged", error, "An iteration stopped before it reached its tolerance.");
    types.io_error = error_type(module, "IoError", py::make_tuple(error, base(PyExc_OSError)),
                                "A file operation or a memory allocation failed.");
    types.cancelled = error_type(module, "Cancelled", error, "The work was stopped.");
    types.error.attr("where") = py::str("");
    py::register_exception_translator(&translate);
}

StreamNetwork Fields<StreamNetwork>::made(Args& in) {
    auto const nodes = python::take<std::vector<Vec2>>(in.required("nodes"), in.place("nodes"));
    auto const from = python::take<std::vector<std::int64_t>>(in.required("from_nodes"), in.place("from_nodes"));
    auto const to = python::take<std::vector<std::int64_t>>(in.required("to_nodes"), in.place("to_nodes"));
    std::optional<std::vector<std::vector<Vec2>>> lines;
    std::optional<std::vector<std::int64_t>> features;
    std::optional<std::vector<std::string>> rosgen;
    std::optional<std::vector<std::uint8_t>> is_input;
    std::optional<std::vector<double>> persistence;
    in.field("lines", lines);
    in.field("features", features);
    in.field("types", rosgen);
    in.field("is_input", is_input);
    in.field("persistence", persistence);
    in.done();
    auto const require_one_an_arc = [&](char const* name, std::size_t count) {
        if (count != from.size()) {
            throw BadInput("StreamNetwork", fmt::format("StreamNetwork: {} has {} entries, and there are {} arcs", name,
                                                        count, from.size()));
        }
    };
    require_one_an_arc("to_nodes", to.size());
    NetworkDraft draft;
    for (Vec2 const at : nodes) {
        draft.add_node(at);
    }
    auto const node = [&](std::int64_t number) {
        if (number < 0 || static_cast<std::size_t>(number) >= nodes.size()) {
            throw BadInput("StreamNetwork", fmt::format("StreamNetwork: an arc names node {}, and there are {} nodes",
                                                        number, nodes.size()));
        }
        return static_cast<NodeId>(number);
    };
    auto const of = [&](char const* name, auto const& values, std::size_t i, auto& target) {
        if (values) {
            require_one_an_arc(name, values->size());
            target = static_cast<std::remove_cvref_t<decltype(target)>>((*values)[i]);
        }
    };
    for (std::size_t i = 0; i < from.size(); ++i) {
        Arc arc;
        of("lines", lines, i, arc.line);
        of("features", features, i, arc.feature);
        of("types", rosgen, i, arc.type);
        of("is_input", is_input, i, arc.is_input);
        of("persistence", persistence, i, arc.persistence);
        draft.add_arc(node(from[i]), node(to[i]), std::move(arc));
    }
    return {std::move(draft)};
}

StreamNetwork Fields<StreamNetwork>::take(py::handle value, Place const& place) {
    if (py::isinstance<ElevatedNetwork>(value)) {
        return value.cast<ElevatedNetwork const&>().planform;
    }
    if (py::isinstance<flow::ExtractedStreams>(value)) {
        return value.cast<flow::ExtractedStreams const&>().network.planform;
    }
    return take_record<StreamNetwork>(value, place);
}

namespace {

/// \throws BadInput when a corner of a triangle is no vertex
template <class Triangles> void require_corners(Triangles const& triangles, std::size_t vertices, char const* what) {
    for (auto const& triangle : triangles) {
        for (auto const corner : triangle) {
            if (static_cast<std::uint64_t>(corner) >= vertices) {
                throw BadInput(what,
                               fmt::format("{}: a triangle names vertex {}, and there are {}", what, corner, vertices));
            }
        }
    }
}

} // namespace

void require_sound(Tin const& tin) {
    require_corners(tin.triangles, tin.vertices.size(), "Tin");
}

void require_sound(LatticeMesh const& mesh) {
    require_corners(mesh.triangles, mesh.vertices.size(), "LatticeMesh");
    if (!mesh.places.empty() && mesh.places.size() != mesh.vertices.size()) {
        throw BadInput("LatticeMesh", "LatticeMesh: places are one per vertex");
    }
}

void require_sound(Channels const& channels) {
    std::size_t const count = channels.cell.size();
    auto const fits = [&](std::size_t size) { return size == 0 || size == count; };
    if (channels.receiver.size() != count || !fits(channels.z.size()) || !fits(channels.level.size()) ||
        !fits(channels.lake_z.size())) {
        throw BadInput("Channels",
                       "Channels: receiver is one per cell, and so are z, level and lake_z where they are given");
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (channels.cell[i] < 0 || channels.cell[i] >= channels.grid.cells() || channels.receiver[i] < -1 ||
            channels.receiver[i] >= static_cast<ChannelId>(i)) {
            throw BadInput("Channels",
                           fmt::format("Channels: number {} has cell {} and receiver {}; cells lie in the grid, and a "
                                       "receiver stands before its cell",
                                       i, channels.cell[i], channels.receiver[i]));
        }
    }
}

void require_sound(network::ChannelsOfArcs const& drawn) {
    require_sound(drawn.channels);
    auto const count = static_cast<std::int64_t>(drawn.channels.cell.size());
    for (auto const& cells : drawn.of_arc) {
        for (std::int64_t const number : cells) {
            if (number < 0 || number >= count) {
                throw BadInput(
                    "network.ChannelsOfArcs",
                    fmt::format("ChannelsOfArcs: of_arc names channel cell {}, and there are {}", number, count));
            }
        }
    }
}

void require_sound(Grid const& grid) {
    constexpr std::int64_t most = std::int64_t{1} << 40;
    if (!(grid.cell_m > 0.0) || !std::isfinite(grid.cell_m) || !std::isfinite(grid.west) ||
        !std::isfinite(grid.north)) {
        throw BadInput("Grid",
                       fmt::format("Grid: cells of {} at ({}, {}); their side is a number above 0, and their place is "
                                   "finite",
                                   grid.cell_m, grid.west, grid.north));
    }
    if (grid.width < 0 || grid.height < 0 || (grid.height > 0 && grid.width > most / grid.height)) {
        throw BadInput(
            "Grid", fmt::format("Grid: {} x {} cells are no grid; it has at most 2^40 cells", grid.width, grid.height));
    }
}

void require_sound(ElevatedNetwork const& network) {
    StreamNetwork const& plan = network.planform;
    bool fits = network.node_z.size() == plan.node_count() && network.arc_z.size() == plan.arc_count();
    for (ArcId a = 0; fits && a < plan.arc_count(); ++a) {
        fits = network.arc_z[a].size() == plan.arc(a).line.size();
    }
    if (!fits) {
        throw BadInput("ElevatedNetwork", "ElevatedNetwork: heights are one per node, and one per vertex of each arc");
    }
}

void require_sound(RiverLine const& line) {
    if (line.vertices.size() < 2) {
        throw BadInput("RiverLine",
                       fmt::format("RiverLine: a line of {} vertices; it needs two", line.vertices.size()));
    }
}

void require_sound(flow::FlowField const& drainage) {
    Raster<flow::Direction> const& direction = drainage.direction;
    if (direction.cells() == 0 || !(drainage.area_cells.grid() == direction.grid())) {
        throw BadInput("flow.FlowField", "FlowField: direction and area_cells are rasters on one grid");
    }
    flow::follow(direction);
}

void require_sound(growth::TokunagaTree const& tree) {
    auto const count = static_cast<growth::LinkId>(tree.links.size());
    bool fits = count > 0;
    for (growth::LinkId i = 0; i < count; ++i) {
        growth::TreeLink const& link = tree.links[i];
        fits =
            fits && (i == 0 ? link.down == -1 : link.down >= 0 && link.down < i) && link.turn >= -2 && link.turn <= 2;
        for (growth::LinkId const up : link.up) {
            fits = fits && (up == -1 || (up > i && up < count));
        }
    }
    if (!fits) {
        throw BadInput("growth.TokunagaTree", "TokunagaTree: links are numbered from the outlet upstream, from 0");
    }
}

void require_sound(growth::LSystem const& system) {
    for (auto const& [sign, words] : system.rules) {
        if (words.empty()) {
            throw BadInput("growth.LSystem", fmt::format("LSystem: the sign {} has no rule", sign));
        }
    }
}

void declare_stream_network(py::module_& module) {
    auto type = add_record<StreamNetwork>(
        module, "StreamNetwork", R"words(An immutable river network in plan: nodes, and arcs directed downstream.

Ends of lines are the positions of their nodes. Networks from stages are forests: at most one arc leaves a node, each
basin is a tree with one outlet, and arcs meet only at shared nodes.

Parameters
----------
nodes : array_like, shape (n, 2)
    [m] positions
from_nodes, to_nodes : array_like of int, shape (m,)
    the numbers of the nodes of each arc, upstream and downstream
lines : sequence of array_like with shape (k, 2), optional
    [m] vertices of each arc; straight without
features, types, is_input, persistence : sequences of length m, optional
    id of the line in its file (0: none); river type (Rosgen) or ''; False for a side valley; [cells] largest pruning
    length that keeps the arc

Raises
------
BadInput
    when an arc names a node that does not exist, or a sequence has another length
)words",
        "thalweg._core");
    auto const add = [&](char const* name, char const* words, Getter getter) { add_getter(type, name, words, getter); };
    add("node_count", "Number of nodes.",
        [](py::object const& self) -> py::object { return py::int_(network_in(self).node_count()); });
    add("arc_count", "Number of arcs.",
        [](py::object const& self) -> py::object { return py::int_(network_in(self).arc_count()); });
    add("nodes", "[m] positions, shape (n, 2).", [](py::object const& self) {
        static_assert(sizeof(Node) == sizeof(Vec2));
        auto const& nodes = network_in(self).nodes();
        return py::object(
            array_of(py::dtype::of<double>(), {static_cast<py::ssize_t>(nodes.size()), 2}, nodes.data(), self));
    });
    add("from_nodes", "The upstream node of each arc.",
        [](py::object const& self) { return show(network_in(self).from(), self); });
    add("to_nodes", "The downstream node of each arc.",
        [](py::object const& self) { return show(network_in(self).to(), self); });
    add("length_m", "[m] length of each arc in plan.",
        [](py::object const& self) { return show(network_in(self).length_m(), self); });
    add("lines", "[m] vertices of each arc, arrays of shape (k, 2).", [](py::object const& self) {
        py::list lines;
        for (Arc const& arc : network_in(self).arcs()) {
            lines.append(show(arc.line, self));
        }
        return py::object(lines);
    });
    add("outlets", "Nodes with arcs in and none out, ascending.",
        [](py::object const& self) { return show(network_in(self).outlets(), self); });
    add("basin", "The basin of each node: 1, 2, ... in the order of outlets; 0: it reaches no outlet.",
        [](py::object const& self) { return show(network_in(self).basin(), self); });
    add("features", "Id of each arc's line in its file; 0: none.", [](py::object const& self) {
        return give(by_arc<std::int64_t>(network_in(self), [](Arc const& arc) { return arc.feature; }));
    });
    add("types", "River type (Rosgen) of each arc from its file, or ''.", [](py::object const& self) {
        return give(by_arc<std::string>(network_in(self), [](Arc const& arc) { return arc.type; }));
    });
    add("is_input", "1, or 0 for a side valley grown around the rivers.", [](py::object const& self) {
        return give(by_arc<std::uint8_t>(network_in(self), [](Arc const& arc) { return std::uint8_t{arc.is_input}; }));
    });
    add("persistence", "[cells] the largest pruning length that keeps each arc.", [](py::object const& self) {
        return give(by_arc<double>(network_in(self), [](Arc const& arc) { return arc.persistence; }));
    });
    finish_record(type, {"nodes", "from_nodes", "to_nodes", "lines", "features", "types", "is_input", "persistence"});
}

void declare_picture(py::module_& module) {
    auto type = add_record<draw::Picture>(module, "Picture",
                                          "A finished picture; a notebook shows it.\n\nAttributes\n----------\n"
                                          "bytes : bytes\n    the file\nformat : str\n    'png', 'svg' or 'pdf'\n",
                                          "thalweg.draw");
    auto const in_format = [](draw::Format format) {
        return [format](py::object const& self) -> py::object {
            auto const& picture = self.cast<draw::Picture const&>();
            return picture.format == format ? py::object(py::bytes(picture.bytes)) : py::object(py::none());
        };
    };
    add_getter(type, "bytes", "The file.",
               [](py::object const& self) -> py::object { return py::bytes(self.cast<draw::Picture const&>().bytes); });
    add_getter(type, "format", "'png', 'svg' or 'pdf'.",
               [](py::object const& self) { return show(self.cast<draw::Picture const&>().format, self); });
    finish_record(type, {"format"});
    type.def("_repr_png_", in_format(draw::Format::png));
    type.def("_repr_svg_", [](draw::Picture const& picture) -> py::object {
        return picture.format == draw::Format::svg ? py::object(py::str(picture.bytes)) : py::object(py::none());
    });
    add_method(type, "save", R"words(save(self, path)
--

Writes the picture to a file; one that exists is replaced.

Parameters
----------
path : str | path

Raises
------
IoError
    when the file cannot be written
)words",
               [](py::object const& self, py::args positional, py::kwargs named) -> py::object {
                   Args in("Picture.save", std::move(positional), std::move(named));
                   std::string const path = take<std::string>(in.required("path"), in.place("path"));
                   return in.call([&] {
                       io::OutputFile file(path, io::Existing::replace);
                       io::write_text(file.staging(), self.cast<draw::Picture const&>().bytes);
                       file.commit();
                   });
               });
}

void define_io_by_hand(py::module_& module) {
    add_function(
        module, "write_geopackage",
        R"words(write_geopackage(network, path, *, orders=None, areas=None, crs='', threads=0, progress=None, log=None, device='cpu')
--

Writes a network as a new GeoPackage with the layers arcs and nodes, in thalweg's own schema.

Parameters
----------
network : ElevatedNetwork
    a forest
path : str | path
    .gpkg is added where it is missing
orders : NetworkOrders, optional
    of this network; computed without
areas : flow.ContributingAreas, optional
    of this network; unknown (-1) without
crs : str, default ''
    'EPSG:n' or WKT; '': none
threads, progress, log, device
    How the work runs, as for `thalweg.make`; the result is the same.

Returns
-------
None

Raises
------
BadInput
    naming the arc or node when the values do not belong to the network, or a number is not finite
IoError
    also when the file exists
)words",
        [](Args& in) {
            Held<ElevatedNetwork> const network(in.required("network"), in.place("network"));
            auto const path = take<std::string>(in.required("path"), in.place("path"));
            std::optional<NetworkOrders> orders;
            std::optional<flow::ContributingAreas> areas;
            std::string crs;
            in.option("orders", orders);
            in.option("areas", areas);
            in.option("crs", crs);
            return in.run([&](Run const& run) {
                StreamNetwork const& plan = (*network).planform;
                NetworkOrders const known = orders ? *orders : network::order(plan);
                flow::ContributingAreas unknown;
                unknown.us_area_m2.assign(plan.arc_count(), -1.0);
                unknown.ds_area_m2 = unknown.us_area_m2;
                unknown.node_m2.assign(plan.node_count(), -1.0);
                flow::ContributingAreas const& of = areas ? *areas : unknown;
                io::write_geopackage({*network, known, of.us_area_m2, of.ds_area_m2, of.node_m2, crs, {}}, path, run);
            });
        });
}

void define_recipe_by_hand(py::module_& module) {
    add_function(module, "set_key", R"words(set_key(recipe, path, text)
--

Sets one key of a recipe, as --set does.

Parameters
----------
recipe : Recipe
path : str
    'section.key', 'patch.2.key'
text : str
    the value as it stands after "="

Returns
-------
Recipe
    another one, with the key

Raises
------
BadParameter
    for an unknown key, or a value outside its range
)words",
                 [](Args& in) {
                     Held<recipe::Recipe> const recipe(in.required("recipe"), in.place("recipe"));
                     auto const path = take<std::string>(in.required("path"), in.place("path"));
                     auto const text = take<std::string>(in.required("text"), in.place("text"));
                     return in.call([&] {
                         recipe::Recipe changed = *recipe;
                         recipe::set_key(changed, path, text);
                         return changed;
                     });
                 });
    add_function(module, "unset_key", R"words(unset_key(recipe, path)
--

Takes a key back to its default, or a section ("detail") or patch ("patch.2") out of a recipe.

Parameters
----------
recipe : Recipe
path : str
    of a key or section

Returns
-------
Recipe
    another one, without it

Raises
------
BadParameter
    when there is no such key or section, or a recipe cannot be without it
)words",
                 [](Args& in) {
                     Held<recipe::Recipe> const recipe(in.required("recipe"), in.place("recipe"));
                     auto const path = take<std::string>(in.required("path"), in.place("path"));
                     return in.call([&] {
                         recipe::Recipe changed = *recipe;
                         recipe::unset_key(changed, path);
                         return changed;
                     });
                 });
}

void define_report_by_hand(py::module_& module) {
    add_function(module, "report_json", R"words(report_json(made)
--

Gives report.json of a terrain, as `thalweg make` writes it, without the files.

Parameters
----------
made : MakeResult

Returns
-------
str
    one JSON object
)words",
                 [](Args& in) {
                     Held<make::MakeResult> const made(in.required("made"), in.place("made"));
                     return in.call([&] { return report::write_report(*made, {}); });
                 });
}

} // namespace thalweg::python
