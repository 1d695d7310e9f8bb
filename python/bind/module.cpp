// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "by_hand.hpp"

#include <thalweg/io/gdal/access.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::python {

#define THALWEG_OF_MODULE(NAME)                                                                                        \
    void declare_##NAME(py::module_& module);                                                                          \
    void define_##NAME(py::module_& module);
THALWEG_OF_MODULE(core)
THALWEG_OF_MODULE(geometry)
THALWEG_OF_MODULE(solver)
THALWEG_OF_MODULE(flow)
THALWEG_OF_MODULE(growth)
THALWEG_OF_MODULE(network)
THALWEG_OF_MODULE(skeleton)
THALWEG_OF_MODULE(surface)
THALWEG_OF_MODULE(fractal)
THALWEG_OF_MODULE(blend)
THALWEG_OF_MODULE(measure)
THALWEG_OF_MODULE(draw)
THALWEG_OF_MODULE(io)
THALWEG_OF_MODULE(recipe)
THALWEG_OF_MODULE(make)
THALWEG_OF_MODULE(report)
THALWEG_OF_MODULE(exports)
THALWEG_OF_MODULE(ensemble)
THALWEG_OF_MODULE(commands)
#undef THALWEG_OF_MODULE

namespace {

struct Module {
    char const* name;
    char const* words;
    void (*declare)(py::module_&);
    void (*define)(py::module_&);
};

constexpr std::array<Module, 18> modules = {{
    {"geometry", "Lines and points: intersections, TINs, Voronoi diagrams, medial lines.", declare_geometry,
     define_geometry},
    {"solver", "Values of the solvers that stages take.", declare_solver, define_solver},
    {"flow", "A DEM: flow directions, conditioning, catchments, streams.", declare_flow, define_flow},
    {"growth", "River networks grown from nothing, in a region or along drawn strokes.", declare_growth, define_growth},
    {"network", "River networks: imported, traced, pruned, bent, ordered, with heights.", declare_network,
     define_network},
    {"skeleton", "Heights that a surface must pass through: random fields and points, ridges, regression.",
     declare_skeleton, define_skeleton},
    {"surface", "A height for every cell, from rivers and a skeleton.", declare_surface, define_surface},
    {"fractal", "Fractal detail, and DEMs with given statistics.", declare_fractal, define_fractal},
    {"blend", "A DEM or mesh and a part of another, without a seam.", declare_blend, define_blend},
    {"measure", "Reports on DEMs and networks.", declare_measure, define_measure},
    {"draw", "Pictures.", declare_draw, define_draw},
    {"io", "Files.", declare_io, define_io},
    {"recipe", "Recipes, their files, and what they set.", declare_recipe, define_recipe},
    {"terrain", "The stages of a terrain: its rivers, their heights, the surface, its water, what is measured of it.",
     declare_make, define_make},
    {"report", "The folder of a terrain: files, report and pictures.", declare_report, define_report},
    {"export", "Files for game engines, 3D programs, printers and the web.", declare_exports, define_exports},
    {"members", "Many terrains by one recipe.", declare_ensemble, define_ensemble},
    {"commands", "The commands of the program.", declare_commands, define_commands},
}};

} // namespace

} // namespace thalweg::python

PYBIND11_MODULE(_core, module) {
    using namespace thalweg::python;
    module.doc() = "The library of thalweg; use the package thalweg.";
    py::options words;
    words.disable_function_signatures();
    thalweg::io::share_gdal();
    py::module_::import("atexit").attr("register")(py::cpp_function(stop_all_calls));
    declare_errors(module);
    declare_stream_network(module);
    declare_core(module);
    define_core(module);
    add_function(module, "version", "version()\n--\n\nGives the version of thalweg.\n\nReturns\n-------\nstr\n",
                 [](Args& in) { return in.call([] { return thalweg::report::version(); }); });
    py::list names;
    std::vector<py::module_> made;
    for (Module const& one : modules) {
        py::module_ sub = module.def_submodule(one.name, one.words);
        sub.attr("__name__") = std::string("thalweg.") + one.name;
        one.declare(sub);
        if (std::string_view(one.name) == "draw") {
            declare_picture(sub);
        }
        names.append(one.name);
        made.push_back(std::move(sub));
    }
    for (std::size_t i = 0; i < modules.size(); ++i) {
        modules[i].define(made[i]);
    }
    define_io_by_hand(made[11]);
    define_recipe_by_hand(made[12]);
    define_report_by_hand(made[14]);
    module.attr("MODULES") = py::tuple(names);
    py::list values;
    for (auto const& [name, value] : module.attr("__dict__").cast<py::dict>()) {
        if (PyCallable_Check(value.ptr()) != 0 && name.cast<std::string>() != "version" &&
            name.cast<std::string>()[0] != '_') {
            values.append(name);
        }
    }
    values.attr("sort")();
    module.attr("__all__") = values;
    module.attr("VALUES") = py::tuple(values);
}
