// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/qgis/project.hpp>

#include <charconv>
#include <memory>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/zip.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/qgis/internal/qgis.hpp>

namespace thalweg::io {

namespace {

using LayerKind = QgisLayer::Kind;

struct LayerWords {
    char const* type;
    char const* provider;
};
constexpr ByEnum<LayerKind, LayerWords, 3> layer_words{{{{"vector", "ogr"}, {"raster", "gdal"}, {"mesh", "mdal"}}}};

std::string element(char const* name, std::string const& text) {
    return fmt::format("<{0}>{1}</{0}>", name, xml_escaped(text));
}

/// The text of a code, such as "EPSG:32617"; "": PROJ does not know it. That of GDAL differs with what it has read
/// before.
std::string text_of_code(std::string const& code) {
    struct Free {
        void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
        void operator()(PJ* crs) const { proj_destroy(crs); }
    };
    std::unique_ptr<PJ_CONTEXT, Free> const context(proj_context_create());
    confine_proj(context.get());
    std::unique_ptr<PJ, Free> const crs(proj_create(context.get(), code.c_str()));
    char const* const options[] = {"MULTILINE=NO", nullptr};
    char const* const text = crs ? proj_as_wkt(context.get(), crs.get(), PJ_WKT2_2018, options) : nullptr;
    return text == nullptr ? "" : text;
}

/// QGIS takes the code where there is one, but not without a text.
std::string reference_system(std::string const& crs) {
    OGRSpatialReference const reference = read_reference(crs);
    char const* const authority = reference.GetAuthorityName(nullptr);
    char const* const code = reference.GetAuthorityCode(nullptr);
    std::string const authid =
        authority != nullptr && code != nullptr ? fmt::format("{}:{}", authority, code) : std::string();
    std::string wkt = authid.empty() ? "" : text_of_code(authid);
    if (wkt.empty()) {
        char* text = nullptr;
        char const* const options[] = {"FORMAT=WKT2_2018", nullptr};
        reference.exportToWkt(&text, options);
        wkt = text == nullptr ? "" : text;
        CPLFree(text);
    }
    return "<spatialrefsys nativeFormat=\"Wkt\">" + element("wkt", wkt) + element("authid", authid) +
           "</spatialrefsys>";
}

std::string source_of(QgisLayer const& layer) {
    return "./" + layer.file + (layer.layer.empty() ? "" : "|layername=" + layer.layer);
}

/// Unique in a project, and the same each time.
std::string id_of(QgisLayer const& layer, std::size_t place) {
    std::string id = fmt::format("thalweg_{}_", place + 1);
    for (char const c : layer.title) {
        bool const is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        id += is_plain ? c : '_';
    }
    return id;
}

std::string box_of(Grid const& grid) {
    return fmt::format("<extent><xmin>{}</xmin><ymin>{}</ymin><xmax>{}</xmax><ymax>{}</ymax></extent>", grid.west,
                       grid.south(), grid.east(), grid.north);
}

std::string map_layer(QgisLayer const& layer, std::string const& id, std::string const& box, std::string const& srs) {
    LayerWords const& words = layer_words[layer.kind];
    std::string out = fmt::format("<maplayer type=\"{}\" {}>\n{}", words.type, style_attributes,
                                  layer.kind == LayerKind::vector ? "" : box);
    out += element("id", id) + element("datasource", source_of(layer)) + element("layername", layer.title);
    out += "<srs>" + srs + "</srs>";
    out += fmt::format("<provider{}>{}</provider>", layer.kind == LayerKind::vector ? " encoding=\"UTF-8\"" : "",
                       words.provider);
    return out + "\n" + layer.style + "\n</maplayer>\n";
}

std::string legend_of(QgisLayer const& layer) {
    return layer.legend.empty() ? "<Option/>"
                                : fmt::format("<Option type=\"Map\"><Option type=\"QString\" "
                                              "name=\"legend/label-0\" value=\"{}\"/></Option>",
                                              xml_escaped(layer.legend));
}

std::string tree_layer(QgisLayer const& layer, std::string const& id) {
    return fmt::format("<layer-tree-layer id=\"{}\" name=\"{}\" source=\"{}\" providerKey=\"{}\" checked=\"{}\" "
                       "expanded=\"{}\" legend_exp=\"\"><customproperties>{}</customproperties>"
                       "</layer-tree-layer>\n",
                       id, xml_escaped(layer.title), xml_escaped(source_of(layer)), layer_words[layer.kind].provider,
                       layer.is_shown ? "Qt::Checked" : "Qt::Unchecked", layer.is_expanded ? 1 : 0, legend_of(layer));
}

int byte_of(std::string const& colour, std::size_t at) {
    int value = 255;
    std::from_chars(colour.data() + at, colour.data() + at + 2, value, 16);
    return value;
}

std::string project_text(QgisProject const& project) {
    std::string const srs = reference_system(project.extent.crs);
    std::string const box = box_of(project.extent);
    std::string tree;
    std::string order;
    std::string layers;
    for (std::size_t k = 0; k < project.layers.size(); ++k) {
        QgisLayer const& layer = project.layers[k];
        std::string const id = id_of(layer, k);
        tree += tree_layer(layer, id);
        order += element("item", id);
        layers += map_layer(layer, id, box, srs);
    }
    std::string const& colour = project.background;
    return fmt::format(
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
        "<qgis version=\"3.22.0\" projectname=\"{0}\">\n<homePath path=\"\"/>\n{1}\n<projectCrs>{2}</projectCrs>\n"
        "<layer-tree-group><customproperties><Option/></customproperties>\n{3}"
        "<custom-order enabled=\"0\">{4}</custom-order></layer-tree-group>\n"
        "<mapcanvas name=\"theMapCanvas\" annotationsVisible=\"1\"><units>meters</units>{5}<rotation>0</rotation>"
        "<destinationsrs>{2}</destinationsrs><rendermaptile>0</rendermaptile></mapcanvas>\n"
        "<projectlayers>\n{6}</projectlayers>\n"
        "<properties><Gui><CanvasColorRedPart type=\"int\">{7}</CanvasColorRedPart>"
        "<CanvasColorGreenPart type=\"int\">{8}</CanvasColorGreenPart>"
        "<CanvasColorBluePart type=\"int\">{9}</CanvasColorBluePart></Gui>"
        "<Paths><Absolute type=\"bool\">false</Absolute></Paths>"
        "<SpatialRefSys><ProjectionsEnabled type=\"int\">1</ProjectionsEnabled></SpatialRefSys></properties>\n"
        "<ProjectViewSettings UseProjectScales=\"0\"><Scales/><DefaultViewExtent xmin=\"{10}\" ymin=\"{11}\" "
        "xmax=\"{12}\" ymax=\"{13}\">{2}</DefaultViewExtent></ProjectViewSettings>\n</qgis>\n",
        xml_escaped(project.title), element("title", project.title), srs, tree, order, box, layers, byte_of(colour, 1),
        byte_of(colour, 3), byte_of(colour, 5), project.extent.west, project.extent.south(), project.extent.east(),
        project.extent.north);
}

} // namespace

void write_qgis_project(QgisProject const& project, std::string const& path) {
    About const about{"io.write_qgis_project", path};
    Driver const driver;
    std::string const text = project_text(project);
    driver.check(about.where, about.name);
    write_text(path, zip_archive("project.qgs", text));
}

} // namespace thalweg::io
