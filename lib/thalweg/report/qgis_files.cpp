// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/draw/map.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/io/qgis/project.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/ground.hpp>
#include <thalweg/report/internal/qgis_files.hpp>
#include <thalweg/report/landmarks.hpp>

namespace thalweg::report {

namespace {

namespace fs = std::filesystem;

constexpr char const* sea_colour = "#c1dcec";

/// Hypsometric tints from the lowest to the highest height, at least a unit apart.
io::Tints tints_of(std::pair<double, double> heights) {
    std::vector<std::string> const colours = draw::tint_colours();
    double const span = std::max(heights.second - heights.first, 1.0);
    io::Tints tints;
    for (std::size_t k = 0; k < colours.size(); ++k) {
        double const share = static_cast<double>(k) / static_cast<double>(colours.size() - 1);
        tints.emplace_back(heights.first + share * span, colours[k]);
    }
    return tints;
}

std::pair<double, double> heights_of(Tin const& tin) {
    auto const [low, high] = std::ranges::minmax(tin.vertices, {}, &Vec3::z);
    return {low.z, high.z};
}

double greatest(Raster<double> const& areas) {
    double most = 0.0;
    for (double const area : areas.values()) {
        most = std::max(most, area); // NaN stays behind
    }
    return most;
}

/// A project from the files of a folder: those that are there become layers, the first ones on top.
class Layers {
public:
    explicit Layers(io::OutputFolder const& out) : out_(out) {}

    bool has(std::string const& file) const { return fs::exists(fs::path(out_.staging()) / file); }

    /// A layer of a GeoPackage, with the style that it has there.
    void vector(std::string const& title, std::string const& file, std::string const& layer, bool is_shown = true,
                bool is_expanded = false) {
        if (!styles_.contains(file)) {
            styles_[file] = has(file) ? io::styles_of(out_.path(file)) : std::map<std::string, io::QgisStyle>{};
        }
        auto const& styles = styles_[file];
        if (auto const found = styles.find(layer); found != styles.end()) {
            layers_.push_back({io::QgisLayer::Kind::vector, title, file, layer, found->second, is_shown, is_expanded});
        }
    }

    /// A raster or a mesh, with its style in QML beside it.
    void styled(io::QgisLayer::Kind kind, std::string const& title, std::string const& file, io::QgisStyle const& style,
                bool is_shown, bool is_expanded = false, std::string const& legend = {}) {
        io::write_text(out_.path(fs::path(file).replace_extension(".qml").string()), io::qml(style));
        add(kind, title, file, style, is_shown, is_expanded, legend);
    }

    void add(io::QgisLayer::Kind kind, std::string const& title, std::string const& file, io::QgisStyle const& style,
             bool is_shown, bool is_expanded = false, std::string const& legend = {}) {
        layers_.push_back({kind, title, file, "", style, is_shown, is_expanded, legend});
    }

    std::vector<io::QgisLayer> take() { return std::move(layers_); }

private:
    io::OutputFolder const& out_;
    std::map<std::string, std::map<std::string, io::QgisStyle>> styles_;
    std::vector<io::QgisLayer> layers_;
};

} // namespace

void write_qgis_files(make::MakeResult const& made, std::string const& title, io::OutputFolder const& out) {
    using Kind = io::QgisLayer::Kind;
    HeightUnit const unit = made.recipe.output.units;
    std::string const unit_name = name_of(unit);
    bool const has_sea = made.terrain.has_surface() && sea_of(made.terrain);
    Layers layers(out);
    layers.vector("Nodes", "network.gpkg", "nodes");
    layers.vector("Rivers", "network.gpkg", "arcs", true, true);
    layers.vector("Lines not in the network", "network.gpkg", "secondary");
    layers.vector("Ridges", "network.gpkg", "ridges");
    if (layers.has("lakes.tif")) {
        layers.styled(Kind::raster, "Lakes", "lakes.tif", io::mask_style("Lake", "#9fc4e0"), true);
    }
    layers.vector("Basins", "catchments.gpkg", "basins", false);
    layers.vector("Catchments", "catchments.gpkg", "catchments", false);
    layers.vector("Contours", "contours.gpkg", "contours");
    if (layers.has("tin.2dm")) {
        Tin const tin = make::in_unit(made.terrain.ground.tin, unit);
        layers.styled(Kind::mesh, "TIN", "tin.2dm", io::mesh_style(tints_of(heights_of(tin)), unit_name),
                      !made.terrain.has_surface(), true, "Height");
    }
    if (layers.has("area_d8.tif")) {
        double const cell_m2 = made.terrain.grid.cell_m * made.terrain.grid.cell_m;
        auto const& areas_of = *made.assessment.water_areas;
        for (auto const& [name, file, areas] :
             {std::tuple{"Contributing area (D8)", "area_d8.tif", &areas_of.d8},
              std::tuple{"Contributing area (D-infinity)", "area_dinf.tif", &areas_of.dinf}}) {
            layers.styled(Kind::raster, name, file, io::area_style(cell_m2, std::max(greatest(*areas), cell_m2)), false,
                          false, "Area drained");
        }
    }
    if (layers.has("strata.tif")) {
        std::vector<io::ClassOfCells> classes;
        for (surface::RockLayer const& layer : made.recipe.layers) {
            classes.push_back({static_cast<int>(classes.size()) + 1,
                               fmt::format("{}: strength {:.3g}", classes.size() + 1, layer.strength),
                               draw::layer_colour(layer.strength)});
        }
        layers.styled(Kind::raster, "Rock at the surface", "strata.tif", io::classes_style(classes), false, false,
                      "Layer");
    }
    if (layers.has("dem.tif")) {
        if (auto heights = height_range(made.terrain.ground.dem)) {
            double const metres = metres_in(unit);
            heights->first /= metres;
            heights->second /= metres;
            // Alone the DEM has the colour of the sea; in the project the background has it.
            io::Tints const tints = tints_of(*heights);
            io::write_text(out.path("dem.qml"), io::qml(io::tint_style(tints, unit_name, has_sea ? sea_colour : "")));
            layers.add(Kind::raster, "Heights", "dem.tif", io::tint_style(tints, unit_name), true, true, "Height");
            layers.add(Kind::raster, "Hillshade", "dem.tif", io::hillshade_style(metres), true);
        }
    }
    io::QgisProject project;
    project.title =
        make::heights_are_invented(made.recipe) ? fmt::format("{} ({})", title, make::invented_heights) : title;
    project.layers = layers.take();
    project.extent = made.terrain.grid;
    project.background = has_sea ? sea_colour : "#ffffff";
    io::write_qgis_project(project, out.path("project.qgz"));
}

} // namespace thalweg::report
