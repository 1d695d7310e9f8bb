// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/qgis/styles.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/qgis/internal/qgis.hpp>

namespace thalweg::io {

namespace {

struct Property {
    char const* name;
    std::string value;
};
using Properties = std::vector<Property>;

std::string options(Properties const& properties) {
    std::string out = "<Option type=\"Map\">";
    for (auto const& [name, value] : properties) {
        out += fmt::format(R"(<Option type="QString" name="{}" value="{}"/>)", name, xml_escaped(value));
    }
    return out + "</Option>";
}

/// Properties that follow an expression for each feature.
std::string by_feature(Properties const& properties) {
    std::string out;
    for (auto const& [name, expression] : properties) {
        out += fmt::format("<Option type=\"Map\" name=\"{}\"><Option type=\"bool\" name=\"active\" value=\"true\"/>"
                           "<Option type=\"QString\" name=\"expression\" value=\"{}\"/>"
                           "<Option type=\"int\" name=\"type\" value=\"3\"/></Option>",
                           name, xml_escaped(expression));
    }
    return fmt::format(
        "<data_defined_properties><Option type=\"Map\"><Option type=\"QString\" name=\"name\" value=\"\"/>"
        "<Option type=\"Map\" name=\"properties\">{}</Option>"
        "<Option type=\"QString\" name=\"type\" value=\"collection\"/></Option></data_defined_properties>",
        out);
}

struct SymbolLayer {
    char const* drawn_by; // "SimpleLine"
    Properties properties;
    Properties expressions = {};
};

struct Symbol {
    char const* type; // "line", "marker", "fill"
    std::vector<SymbolLayer> layers;
};

std::string symbol_text(Symbol const& symbol, std::size_t name) {
    std::string out =
        fmt::format(R"(<symbol alpha="1" type="{}" clip_to_extent="1" name="{}" force_rhr="0">)", symbol.type, name);
    for (SymbolLayer const& layer : symbol.layers) {
        out += fmt::format(R"(<layer class="{}" locked="0" enabled="1" pass="0">{}{}</layer>)", layer.drawn_by,
                           options(layer.properties), layer.expressions.empty() ? "" : by_feature(layer.expressions));
    }
    return out + "</symbol>";
}

std::string symbols_text(std::span<Symbol const> symbols) {
    std::string out = "<symbols>";
    for (std::size_t k = 0; k < symbols.size(); ++k) {
        out += symbol_text(symbols[k], k);
    }
    return out + "</symbols>";
}

std::string single(Symbol const& symbol) {
    return fmt::format("<renderer-v2 type=\"singleSymbol\" symbollevels=\"0\" enableorderby=\"0\" forceraster=\"0\">"
                       "{}</renderer-v2>",
                       symbols_text({&symbol, 1}));
}

struct Category {
    std::string value; // "": every other one
    std::string label;
    Symbol symbol;
};

/// \param order_by an expression by which features are drawn, ascending; "": in the order of the file
std::string categorised(std::string const& field, std::vector<Category> const& categories,
                        std::string const& order_by = {}) {
    std::string list;
    std::vector<Symbol> symbols;
    for (Category const& category : categories) {
        list += fmt::format(R"(<category render="true" symbol="{}" value="{}" label="{}"/>)", symbols.size(),
                            xml_escaped(category.value), xml_escaped(category.label));
        symbols.push_back(category.symbol);
    }
    std::string const order =
        order_by.empty() ? ""
                         : fmt::format(R"(<orderby><orderByClause asc="1" nullsFirst="1">{}</orderByClause></orderby>)",
                                       xml_escaped(order_by));
    return fmt::format("<renderer-v2 type=\"categorizedSymbol\" attr=\"{}\" symbollevels=\"0\" enableorderby=\"{}\" "
                       "forceraster=\"0\"><categories>{}</categories>{}{}</renderer-v2>",
                       xml_escaped(field), order.empty() ? 0 : 1, list, symbols_text(symbols), order);
}

struct KindRule {
    std::string label;
    NodeKind kind;
    double from_scale; // the scale's denominator up to which nodes are drawn; 0: at any scale
    Symbol symbol;
};

/// Rules by the field kind.
std::string by_rules(std::vector<KindRule> const& rules) {
    std::string list;
    std::vector<Symbol> symbols;
    for (KindRule const& rule : rules) {
        std::string const scales =
            rule.from_scale > 0.0 ? fmt::format(R"( scalemindenom="1" scalemaxdenom="{}")", rule.from_scale) : "";
        list += fmt::format(R"(<rule key="thalweg_{0}" label="{1}" symbol="{0}" filter="{2}"{3}/>)", symbols.size(),
                            xml_escaped(rule.label), xml_escaped(fmt::format("\"kind\" = '{}'", name_of(rule.kind))),
                            scales);
        symbols.push_back(rule.symbol);
    }
    return fmt::format("<renderer-v2 type=\"RuleRenderer\" symbollevels=\"0\" enableorderby=\"0\" forceraster=\"0\">"
                       "<rules key=\"thalweg\">{}</rules>{}</renderer-v2>",
                       list, symbols_text(symbols));
}

struct Rgb {
    double red, green, blue;
};

std::string colour(Rgb c, int alpha = 255) {
    return fmt::format("{:.0f},{:.0f},{:.0f},{}", c.red, c.green, c.blue, alpha);
}

constexpr Rgb pale_river{70, 135, 195};
constexpr Rgb dark_river{13, 71, 148}; // as on maps
constexpr Rgb contour{140, 98, 60};
constexpr Rgb ridge{122, 82, 48};
constexpr Rgb white{255, 255, 255};

Rgb between(Rgb a, Rgb b, double share) {
    auto const mix = [share](double p, double q) { return p + (q - p) * share; };
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

/// \param width [mm]
Symbol line(Rgb c, double width, char const* pattern = "") {
    bool const is_dashed = *pattern != '\0';
    return {"line",
            {{"SimpleLine",
              {{"line_color", colour(c)},
               {"line_width", fmt::format("{}", width)},
               {"line_width_unit", "MM"},
               {"line_style", "solid"},
               {"capstyle", is_dashed ? "flat" : "round"},
               {"joinstyle", "round"},
               {"customdash", is_dashed ? pattern : "5;2"},
               {"customdash_unit", "MM"},
               {"use_custom_dash", is_dashed ? "1" : "0"}}}}};
}

/// \param size [mm]
Symbol marker(char const* shape, double size, Rgb fill, Rgb outline) {
    return {"marker",
            {{"SimpleMarker",
              {{"name", shape},
               {"size", fmt::format("{}", size)},
               {"size_unit", "MM"},
               {"color", colour(fill)},
               {"outline_color", colour(outline)},
               {"outline_width", "0.2"},
               {"outline_width_unit", "MM"},
               {"outline_style", "solid"}}}}};
}

Symbol area(Rgb fill, int alpha, Rgb outline, double width) {
    return {"fill",
            {{"SimpleFill",
              {{"color", colour(fill, alpha)},
               {"style", alpha > 0 ? "solid" : "no"},
               {"outline_color", colour(outline)},
               {"outline_width", fmt::format("{}", width)},
               {"outline_width_unit", "MM"},
               {"outline_style", "solid"},
               {"joinstyle", "round"}}}}};
}

std::string quoted(std::string const& field) {
    std::string out = "\"";
    for (char const c : field) {
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    }
    return out + '"';
}

std::string legend(std::string const& unit) {
    return fmt::format("<rampLegendSettings useContinuousLegend=\"1\" orientation=\"2\" direction=\"0\" prefix=\"\" "
                       "suffix=\"{}\" minimumLabel=\"\" maximumLabel=\"\"><numericFormat id=\"basic\">"
                       "<Option type=\"Map\"><Option type=\"int\" name=\"decimals\" value=\"0\"/>"
                       "<Option type=\"int\" name=\"rounding_type\" value=\"0\"/>"
                       "<Option type=\"bool\" name=\"show_thousand_separator\" value=\"false\"/></Option>"
                       "</numericFormat></rampLegendSettings>",
                       xml_escaped(" " + unit));
}

std::string shader(Tints const& tints, std::string const& unit, std::string const& legend_text) {
    std::string items;
    for (auto const& [value, tint] : tints) {
        items += fmt::format(R"(<item value="{}" color="{}" alpha="255" label="{:.6g} {}"/>)", value, tint, value,
                             xml_escaped(unit));
    }
    return fmt::format("<colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" clip=\"0\" "
                       "labelPrecision=\"0\" minimumValue=\"{}\" maximumValue=\"{}\">{}{}</colorrampshader>",
                       tints.front().first, tints.back().first, items, legend_text);
}

struct Tone {
    int brightness = 0;
    int contrast = 0;
};

/// \param blend Qt's number of a blend mode, as QML has it: 0 normal, 6 multiply
std::string raster_pipe(std::string const& renderer, Tone light, int blend, char const* resampling) {
    return fmt::format("<pipe><provider><resampling enabled=\"false\"/></provider>{}"
                       "<brightnesscontrast brightness=\"{}\" contrast=\"{}\" gamma=\"1\"/>"
                       "<huesaturation saturation=\"0\" grayscaleMode=\"0\" colorizeOn=\"0\" invertColors=\"0\"/>"
                       "<rasterresampler maxOversampling=\"2\"{}/><resamplingStage>resamplingFilter</resamplingStage>"
                       "</pipe><blendMode>{}</blendMode>",
                       renderer, light.brightness, light.contrast, resampling, blend);
}

constexpr char const* smooth =
    R"( zoomedInResampler="bilinear" zoomedOutResampler="bilinear")"; // by cells of a DEM a hillshade has steps
constexpr char const* by_cells = "";
constexpr int normal = 0;
constexpr int multiply = 6;

std::string pseudocolour(Tints const& tints, std::string const& unit, std::string const& no_data,
                         std::string const& legend_text) {
    return fmt::format("<rasterrenderer type=\"singlebandpseudocolor\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" "
                       "nodataColor=\"{}\" classificationMin=\"{}\" classificationMax=\"{}\"><minMaxOrigin>"
                       "<limits>None</limits></minMaxOrigin><rastershader>{}</rastershader></rasterrenderer>",
                       no_data, tints.front().first, tints.back().first, shader(tints, unit, legend_text));
}

} // namespace

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (char const c : text) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '"': out += "&quot;"; break;
        default: out += static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r' ? ' ' : c;
        }
    }
    return out;
}

std::string qml(QgisStyle const& style) {
    return fmt::format("<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
                       "<qgis {}>{}</qgis>\n",
                       style_attributes, style);
}

QgisStyle river_style(std::string const& order_field, int highest, RiverWidths const& widths) {
    constexpr double thinnest = 0.15; // [mm]
    constexpr double widest = 1.5;
    std::vector<Category> orders;
    for (int k = 1; k <= std::max(highest, 1); ++k) {
        double const share = highest > 1 ? (k - 1.0) / (highest - 1.0) : 1.0;
        Symbol symbol = line(between(pale_river, dark_river, share), thinnest + (widest - thinnest) * share * share);
        if (!widths.field.empty() && widths.greatest > 0.0) {
            symbol.layers.front().expressions = {
                {"outlineWidth", fmt::format("{} + {} * sqrt(max(0, {}) / {})", thinnest, widest - thinnest,
                                             quoted(widths.field), widths.greatest)}};
        }
        orders.push_back({fmt::format("{}", k), fmt::format("Order {}", k), symbol});
    }
    if (order_field.empty()) {
        return single(orders.back().symbol);
    }
    return categorised(order_field, orders, quoted(order_field));
}

QgisStyle node_style() {
    constexpr Rgb red{200, 40, 40};
    constexpr double detailed = 200000.0; // at smaller scales they would hide the rivers
    return by_rules({{"Outlet", NodeKind::outlet, 0.0, marker("triangle", 2.2, red, white)},
                     {"Sink", NodeKind::sink, 0.0, marker("diamond", 2.4, red, white)},
                     {"Confluence", NodeKind::confluence, detailed, marker("circle", 1.1, dark_river, white)},
                     {"Source", NodeKind::source, detailed, marker("circle", 1.0, white, dark_river)},
                     {"Pseudo-node", NodeKind::pseudo, detailed, marker("circle", 0.7, {150, 150, 150}, white)}});
}

QgisStyle ridge_style() {
    return single(line(ridge, 0.3, "2;0.8"));
}

QgisStyle secondary_style() {
    return single(line(pale_river, 0.3, "1.2;0.8"));
}

QgisStyle contour_style() {
    constexpr Rgb ink{104, 70, 40};
    std::string const labels = fmt::format(
        "<labeling type=\"simple\"><settings calloutType=\"simple\">"
        "<text-style fieldName=\"{}\" isExpression=\"1\" fontWeight=\"50\" fontSize=\"7\" fontSizeUnit=\"Point\" "
        "textColor=\"{}\" textOpacity=\"1\"><text-buffer bufferDraw=\"1\" bufferSize=\"0.4\" "
        "bufferSizeUnits=\"MM\" bufferColor=\"{}\" bufferOpacity=\"0.75\" bufferNoFill=\"1\"/></text-style>"
        "<placement placement=\"2\" placementFlags=\"9\" priority=\"3\" repeatDistance=\"0\" "
        "repeatDistanceUnits=\"MM\"/><rendering drawLabels=\"1\" obstacle=\"0\" mergeLines=\"1\" "
        "minFeatureSize=\"30\" upsidedownLabels=\"0\" "
        "scaleVisibility=\"0\"/></settings></labeling>",
        xml_escaped(R"(if("is_index" = 1, "z", NULL))"), colour(ink), colour(white));
    return categorised("is_index",
                       {{"1", "Index contour", line(contour, 0.26)}, {"0", "Contour", line(contour, 0.1)}}) +
           labels;
}

QgisStyle catchment_style(bool is_whole) {
    constexpr Rgb outline{90, 70, 110};
    Symbol symbol = area({180, 180, 180}, is_whole ? 0 : 90, is_whole ? outline : white, is_whole ? 0.5 : 0.15);
    if (!is_whole) { // hues a golden angle apart
        symbol.layers.front().expressions = {
            {"fillColor", R"(color_hsla(("basin_id" * 137 + "arc_id" * 11) % 360, 45, 62, 90))"}};
    }
    return single(symbol);
}

QgisStyle finding_style(std::vector<std::string> const& kinds) {
    std::vector<Category> categories;
    constexpr std::array<Rgb, 6> colours{
        {{214, 39, 40}, {255, 127, 14}, {148, 103, 189}, {44, 140, 60}, {227, 119, 194}, {120, 80, 60}}};
    for (std::string const& kind : kinds) {
        categories.push_back(
            {kind, kind, marker("diamond", 3.0, colours.at(categories.size() % colours.size()), white)});
    }
    return categorised("kind", categories);
}

QgisStyle polygon_style() {
    return single(area({214, 214, 164}, 60, {120, 120, 110}, 0.1));
}

QgisStyle water_style() {
    return single(area({159, 196, 224}, 255, dark_river, 0.2));
}

// Rasters and meshes.

QgisStyle tint_style(Tints const& tints, std::string const& unit, std::string const& no_data) {
    refuse_if<BadInput>(tints.size() < 2, "io.tint_style", "{} tints; there must be two or more", tints.size());
    return raster_pipe(pseudocolour(tints, unit, no_data, legend(unit)), {}, multiply, smooth);
}

QgisStyle hillshade_style(double metres_in_unit) {
    std::string const renderer =
        fmt::format("<rasterrenderer type=\"hillshade\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\" "
                    "azimuth=\"315\" angle=\"45\" zfactor=\"{}\" multidirection=\"0\"/>",
                    metres_in_unit);
    return raster_pipe(renderer, {.brightness = 55, .contrast = -12}, normal, smooth);
}

QgisStyle mask_style(std::string const& label, std::string const& colour_code) {
    return raster_pipe(
        fmt::format("<rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" "
                    "nodataColor=\"\"><colorPalette><paletteEntry value=\"1\" color=\"{}\" alpha=\"255\" "
                    "label=\"{}\"/><paletteEntry value=\"0\" color=\"#ffffff\" alpha=\"0\" label=\"\"/>"
                    "</colorPalette></rasterrenderer>",
                    colour_code, xml_escaped(label)),
        {}, normal, by_cells);
}

QgisStyle classes_style(std::vector<ClassOfCells> const& classes) {
    std::string entries;
    for (ClassOfCells const& some : classes) {
        entries += fmt::format("<paletteEntry value=\"{}\" color=\"{}\" alpha=\"255\" label=\"{}\"/>", some.number,
                               some.colour, xml_escaped(some.label));
    }
    return raster_pipe(fmt::format("<rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" "
                                   "nodataColor=\"\"><colorPalette>{}</colorPalette></rasterrenderer>",
                                   entries),
                       {}, multiply, by_cells);
}

QgisStyle area_style(double smallest, double greatest) {
    constexpr std::array<char const*, 5> colours{{"#f7fbff", "#c9ddf0", "#85b6dd", "#2f74b5", "#08306b"}};
    refuse_if<BadInput>(!(smallest > 0.0) || !(greatest >= smallest), "io.area_style",
                        "areas from {} to {} m2; they must be greater than 0 and ascend", smallest, greatest);
    double const high = std::max(greatest, 16.0 * smallest);
    double const middle = std::sqrt(smallest * high);
    std::array<double, 5> const steps{smallest, std::sqrt(smallest * middle), middle, std::sqrt(middle * high), high};
    Tints tints;
    for (std::size_t k = 0; k < colours.size(); ++k) {
        tints.emplace_back(steps.at(k), colours.at(k));
    }
    return raster_pipe(pseudocolour(tints, "m2", "", ""), {}, normal, by_cells);
}

QgisStyle mesh_style(Tints const& tints, std::string const& unit) {
    refuse_if<BadInput>(tints.size() < 2, "io.mesh_style", "{} tints; there must be two or more", tints.size());
    return fmt::format(
        "<mesh-renderer-settings><active-dataset-group scalar=\"0\" vector=\"-1\"/>"
        "<scalar-settings group=\"0\" min-val=\"{0}\" max-val=\"{1}\" opacity=\"1\" interpolation-method=\"none\">{2}"
        "<edge-settings stroke-width-unit=\"0\"><mesh-stroke-width fixed-width=\"0.2\" width-varying=\"0\" "
        "minimum-width=\"0.2\" maximum-width=\"3\" minimum-value=\"{0}\" maximum-value=\"{1}\" "
        "ignore-out-of-range=\"0\" use-absolute-value=\"0\"/></edge-settings></scalar-settings>"
        "<mesh-settings-native enabled=\"1\" color=\"90,80,70,80\" line-width=\"0.1\" line-width-unit=\"MM\"/>"
        "<mesh-settings-edge enabled=\"0\" color=\"0,0,0,255\" line-width=\"0.1\" line-width-unit=\"MM\"/>"
        "<mesh-settings-triangular enabled=\"0\" color=\"0,0,0,255\" line-width=\"0.1\" line-width-unit=\"MM\"/>"
        "</mesh-renderer-settings><name-to-global-index name=\"Bed Elevation\" "
        "global-index=\"0\"/><mesh-simplify-settings enabled=\"0\" mesh-resolution=\"5\" reduction-factor=\"10\"/>"
        "<blendMode>0</blendMode><layerOpacity>1</layerOpacity>",
        tints.front().first, tints.back().first, shader(tints, unit, legend(unit)));
}

// Where they stand in a GeoPackage.

std::map<std::string, QgisStyle> styles_of(std::string const& path) {
    About const about{"io.styles_of", path};
    Driver const driver;
    std::map<std::string, QgisStyle> styles;
    {
        Dataset const data(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
        refuse_if<IoError>(data == nullptr, about.where, "{} cannot be opened", about.name);
        if (OGRLayer* const layer = data->GetLayerByName(styles_layer)) {
            for (auto const& feature : *layer) {
                std::string const text = feature->GetFieldAsString("styleQML");
                std::size_t const begin = text.find('>', text.find("<qgis "));
                std::size_t const end = text.rfind("</qgis>");
                if (begin < end && end != std::string::npos) {
                    styles[feature->GetFieldAsString("f_table_name")] = text.substr(begin + 1, end - begin - 1);
                }
            }
        }
    }
    driver.check(about.where, about.name);
    return styles;
}

} // namespace thalweg::io
