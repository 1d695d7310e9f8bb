// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <memory>
#include <set>
#include <string>

#include <cpl_minixml.h>
#include <cpl_vsi.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/qgis/project.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/dem_derivatives.hpp>

#include "../sample_networks.hpp"
#include "../scratch_folder.hpp"
#include "../vector_files.hpp"

namespace qgis_test {

using namespace thalweg;

namespace {

struct FreeXml {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, FreeXml>;

Xml xml(std::string const& text) {
    Xml parsed(CPLParseXMLString(text.c_str()));
    EXPECT_NE(parsed, nullptr) << text.substr(0, 300);
    return parsed;
}

/// Calls visit(node) for a node, its children and its siblings.
template <class Visit> void walk(CPLXMLNode const* node, Visit const& visit) {
    for (; node != nullptr; node = node->psNext) {
        visit(*node);
        walk(node->psChild, visit);
    }
}

/// The texts of all elements of this name.
std::vector<std::string> texts(Xml const& parsed, std::string const& name) {
    std::vector<std::string> found;
    walk(parsed.get(), [&](CPLXMLNode const& node) {
        if (node.eType == CXT_Element && name == node.pszValue) {
            found.emplace_back(CPLGetXMLValue(&node, "", ""));
        }
    });
    return found;
}

/// The values of an attribute in all elements of this name.
std::vector<std::string> attributes(Xml const& parsed, std::string const& element, char const* attribute) {
    std::vector<std::string> found;
    walk(parsed.get(), [&](CPLXMLNode const& node) {
        if (node.eType == CXT_Element && element == node.pszValue) {
            found.emplace_back(CPLGetXMLValue(&node, attribute, ""));
        }
    });
    return found;
}

io::Tints tints() {
    return {{-1.5, "#7ea688"}, {10.0, "#e7d2a6"}, {100.25, "#f8f6f3"}};
}

std::string project_in(std::string const& path) {
    std::string const inside = "/vsizip/{" + path + "}/project.qgs";
    VSILFILE* const file = VSIFOpenL(inside.c_str(), "rb");
    EXPECT_NE(file, nullptr);
    if (file == nullptr) {
        return "";
    }
    std::string text(1 << 20, '\0');
    text.resize(VSIFReadL(text.data(), 1, text.size(), file));
    VSIFCloseL(file);
    return text;
}

io::QgisProject hostile_project() {
    io::QgisProject project;
    project.title = "A <title> & \"quotes\" ümlaut \x01";
    project.extent = {64, 48, 30.0, 500000.0, 5000000.0, "EPSG:32631"};
    project.background = "#c1dcec";
    using Kind = io::QgisLayer::Kind;
    project.layers = {
        {Kind::vector, "Rivers & <more>", "network.gpkg", "arcs", io::river_style("strahler", 3, {}), true, true},
        {Kind::mesh, "TIN", "tin.2dm", "", io::mesh_style(tints(), "m"), false},
        {Kind::raster, "Heights", "dem.tif", "", io::tint_style(tints(), "m")},
        {Kind::raster, "Heights", "dem.tif", "", io::hillshade_style()}};
    return project;
}

} // namespace

TEST(QgisStyles, EachIsWellFormed) {
    std::string const hostile = "a<b>&\"c\"";
    std::map<std::string, io::QgisStyle> const styles{{"rivers", io::river_style("strahler", 7, {"ds_area", 1.5e8})},
                                                      {"named rivers", io::river_style(hostile, 1, {hostile, 3.0})},
                                                      {"plain rivers", io::river_style("", 1, {})},
                                                      {"nodes", io::node_style()},
                                                      {"ridges", io::ridge_style()},
                                                      {"secondary", io::secondary_style()},
                                                      {"contours", io::contour_style()},
                                                      {"catchments", io::catchment_style(false)},
                                                      {"basins", io::catchment_style(true)},
                                                      {"findings", io::finding_style({"cycle", hostile})},
                                                      {"polygons", io::polygon_style()},
                                                      {"water", io::water_style()},
                                                      {"tints", io::tint_style(tints(), hostile, "#c1dcec")},
                                                      {"hillshade", io::hillshade_style(0.3048)},
                                                      {"mask", io::mask_style(hostile, "#9fc4e0")},
                                                      {"areas", io::area_style(900.0, 9e8)},
                                                      {"mesh", io::mesh_style(tints(), "ft")}};
    for (auto const& [name, style] : styles) {
        Xml const parsed = xml(io::qml(style));
        ASSERT_NE(parsed, nullptr) << name;
        EXPECT_NE(CPLGetXMLNode(parsed.get(), "=qgis"), nullptr) << name;
        // Each symbol that a renderer names is there.
        std::set<std::string> drawn;
        for (auto const& symbol : attributes(parsed, "symbol", "name")) {
            drawn.insert(symbol);
        }
        for (auto const& symbol : attributes(parsed, "category", "symbol")) {
            EXPECT_TRUE(drawn.contains(symbol)) << name << " " << symbol;
        }
    }
}

TEST(QgisStyles, TintsAreThoseOfMaps) {
    auto const colours = draw::tint_colours();
    ASSERT_EQ(colours.size(), 17U);
    EXPECT_EQ(colours.front(), "#7ea688");
    Xml const parsed = xml(io::qml(io::tint_style(tints(), "m")));
    EXPECT_EQ(attributes(parsed, "item", "value"), (std::vector<std::string>{"-1.5", "10", "100.25"}));
    EXPECT_EQ(attributes(parsed, "item", "label"), (std::vector<std::string>{"-1.5 m", "10 m", "100.25 m"}));
    EXPECT_THROW(io::tint_style({}, "m"), BadInput);
    EXPECT_THROW(io::mesh_style({{1.0, "#ffffff"}}, "m"), BadInput);
    EXPECT_THROW(io::area_style(0.0, 1.0), BadInput);
    EXPECT_THROW(io::area_style(2.0, std::nan("")), BadInput);
}

TEST(QgisStyles, EveryLayerOfAGeoPackageHasOne) {
    SampleNetwork const sample = two_basins();
    RidgeLines const ridges{{{{{0.1, 0.2, 3.5}, {3.1, 4.2, 1.0}}, 1, 3}}};
    std::vector<SecondaryLine> const secondary{{4, {{0.0, 0.0, 0.0}, {5.0, 5.0, 0.0}}, "why"}};
    io::NetworkTables tables = sample.tables();
    tables.ridges = &ridges;
    tables.secondary = &secondary;
    ScratchFolder const folder;
    io::write_geopackage(tables, folder / "net.gpkg");
    io::write_findings({{"cycle", 3, {1.0, 2.0}, 0.5, "a cycle"}}, "EPSG:32631", folder / "found.gpkg");
    io::write_contours({{100.0, {{0.0, 0.0}, {9.0, 9.0}}}}, 20.0, "EPSG:32631", folder / "contours.gpkg");
    io::write_tin({{{0, 0, 1}, {9, 0, 2}, {0, 9, 3}}, {{0, 1, 2}}}, "EPSG:32631", folder / "tin.gpkg",
                  io::TinFormat::geopackage);
    for (char const* file : {"net.gpkg", "found.gpkg", "contours.gpkg", "tin.gpkg"}) {
        auto const dataset = opened(folder / file);
        auto const styles = io::styles_of(folder / file);
        for (OGRLayer* const layer : dataset->GetLayers()) {
            if (layer->GetGeomType() != wkbNone) {
                EXPECT_TRUE(styles.contains(layer->GetName())) << file << " " << layer->GetName();
            }
        }
        OGRLayer& table = *dataset->GetLayerByName("layer_styles");
        EXPECT_EQ(table.GetGeomType(), wkbNone);
        for (auto const& feature : table) {
            // What QGIS looks for when it opens a layer.
            OGRLayer* const layer = dataset->GetLayerByName(feature->GetFieldAsString("f_table_name"));
            ASSERT_NE(layer, nullptr);
            EXPECT_STREQ(feature->GetFieldAsString("f_geometry_column"), layer->GetGeometryColumn());
            EXPECT_STREQ(feature->GetFieldAsString("f_table_schema"), "");
            EXPECT_EQ(feature->GetFieldAsInteger("useAsDefault"), 1);
            xml(feature->GetFieldAsString("styleQML"));
        }
    }
    EXPECT_EQ(io::styles_of(folder / "net.gpkg").at("nodes"), io::node_style());
    EXPECT_THROW(io::styles_of(folder / "none.gpkg"), IoError);
}

TEST(QgisStyles, FindingsOfNoPlaceHaveNoPoint) {
    ScratchFolder const folder;
    io::write_findings({{"cycle", 3, {1.0, 2.0}, 0.5, "a cycle"}, {.kind = "no_crs", .text = "of all"}}, "EPSG:32631",
                       folder / "found.gpkg");
    auto const data = opened(folder / "found.gpkg");
    std::vector<bool> empty;
    for (auto const& feature : *data->GetLayer(0)) {
        empty.push_back(feature->GetGeometryRef()->IsEmpty() != 0);
    }
    EXPECT_EQ(empty, (std::vector<bool>{false, true}));
}

TEST(QgisStyles, RiversOfEachSchemaAreDrawnByItsOwnFields) {
    SampleNetwork const sample = y_shape();
    ScratchFolder const folder;
    for (io::SchemaTable const* schema :
         {&io::table_of(io::Schema::native), &io::table_of(io::Schema::taudem), &io::table_of(io::Schema::nhdplus),
          &io::table_of(io::Schema::hydrorivers), &io::table_of(io::Schema::grass)}) {
        std::string const path = folder / (std::string(schema->name) + ".gpkg");
        io::write_network(sample.tables(), path, {.schema = schema->schema});
        std::string const style = io::styles_of(path).at(std::string(schema->layer));
        Xml const parsed = xml(io::qml(style));
        auto const dataset = opened(path);
        OGRFeatureDefn& fields = *dataset->GetLayerByName(std::string(schema->layer).c_str())->GetLayerDefn();
        auto const orders = attributes(parsed, "renderer-v2", "attr");
        ASSERT_EQ(orders.size(), 1U);
        EXPECT_GE(fields.GetFieldIndex(orders[0].c_str()), 0) << schema->name << " " << orders[0];
        std::size_t const at = style.find("max(0, &quot;");
        ASSERT_EQ(at == std::string::npos, schema->schema == io::Schema::grass) << schema->name;
        if (at != std::string::npos) {
            std::string const field = style.substr(at + 13, style.find("&quot;", at + 13) - at - 13);
            EXPECT_GE(fields.GetFieldIndex(field.c_str()), 0) << schema->name << " " << field;
        }
    }
}

TEST(QgisProjects, HoldTheirLayersByRelativePaths) {
    ScratchFolder const folder;
    io::QgisProject const project = hostile_project();
    io::write_qgis_project(project, folder / "project.qgz");
    Xml const parsed = xml(project_in(folder / "project.qgz"));
    EXPECT_EQ(texts(parsed, "datasource"),
              (std::vector<std::string>{"./network.gpkg|layername=arcs", "./tin.2dm", "./dem.tif", "./dem.tif"}));
    EXPECT_EQ(texts(parsed, "provider").size(), 6U) << "four layers, and two pipes of rasters";
    EXPECT_EQ(texts(parsed, "Absolute"), (std::vector<std::string>{"false"}));
    EXPECT_EQ(texts(parsed, "layername").front(), "Rivers & <more>");
    auto const ids = texts(parsed, "id");
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), project.layers.size());
    EXPECT_EQ(attributes(parsed, "layer-tree-layer", "id"), ids);
    EXPECT_EQ(attributes(parsed, "layer-tree-layer", "checked")[1], "Qt::Unchecked");
    for (auto const& code : texts(parsed, "authid")) {
        EXPECT_EQ(code, "EPSG:32631");
    }
    EXPECT_EQ(texts(parsed, "CanvasColorGreenPart"), (std::vector<std::string>{"220"}));
}

TEST(QgisProjects, HaveOneTextForACode) {
    ScratchFolder const folder;
    io::QgisProject project = hostile_project();
    io::write_qgis_project(project, folder / "code.qgz");
    OGRSpatialReference reference;
    reference.importFromEPSG(32631);
    char* text = nullptr;
    reference.exportToWkt(&text); // WKT 1, as files have it: without the members of the datum
    project.extent.crs = text;
    CPLFree(text);
    io::write_qgis_project(project, folder / "text.qgz");
    EXPECT_EQ(bytes_of(folder / "code.qgz"), bytes_of(folder / "text.qgz"));
}

TEST(QgisProjects, AreTheSameEachTime) {
    ScratchFolder const folder;
    io::write_qgis_project(hostile_project(), folder / "one.qgz");
    io::write_qgis_project(hostile_project(), folder / "two.qgz");
    EXPECT_EQ(bytes_of(folder / "one.qgz"), bytes_of(folder / "two.qgz"));
    io::QgisProject no_crs = hostile_project();
    no_crs.extent.crs = "EPSG:999999";
    EXPECT_THROW(io::write_qgis_project(no_crs, folder / "none.qgz"), BadInput);
    EXPECT_FALSE(std::filesystem::exists(folder / "none.qgz"));
    EXPECT_THROW(io::write_qgis_project(hostile_project(), folder / "missing/project.qgz"), IoError);
}

} // namespace qgis_test
