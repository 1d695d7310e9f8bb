// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {
namespace {

// A network as nodes and edges: an edge an arc, its attributes the arc's columns; a node's id is its number + 1.
struct GraphTables {
    Table arcs;
    Table nodes;
    StreamNetwork const& plan;
    std::string crs;
};

using Kind = Column::Kind;
using Value = Column::Value;
/// A text as the format writes it.
using Quote = std::string (*)(std::string_view);

/// XML 1.0 has no control characters but three, not even escaped.
std::string in_xml(std::string_view text) {
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

std::string in_csv(std::string_view text) {
    if (text.find_first_of("\",\r\n") == std::string_view::npos) {
        return std::string(text);
    }
    std::string out = "\"";
    for (char const c : text) {
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    }
    return out + '"';
}

/// A Python string in which neither a line nor a comment ends.
std::string in_python(std::string_view text) {
    std::string out = "'";
    for (char const c : text) {
        bool const plain = static_cast<unsigned char>(c) >= 0x20 && c != '\'' && c != '\\' && c != '#';
        out += plain ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return out + '\'';
}

std::string well_known(std::vector<Vec3> const& line) {
    std::string out = "LINESTRING Z (";
    for (std::size_t i = 0; i < line.size(); ++i) {
        fmt::format_to(std::back_inserter(out), "{}{} {} {}", i == 0 ? "" : ", ", line[i].x, line[i].y, line[i].z);
    }
    return out + ')';
}

class Writer {
public:
    Writer(GraphTables const& graph, std::string const& path, char const* who, Quote quote)
        : graph_(graph), what_(fmt::format("io.{}: {}", who, path)), quote_(quote), file_(path, what_) {}

    std::string value(Table const& table, Column const& column, std::size_t row) const {
        Value const value = column.at(row);
        if (std::holds_alternative<std::monostate>(value)) {
            return quote_ == in_python ? "None" : "";
        }
        if (auto const* text = std::get_if<std::string>(&value)) {
            return quote_(*text);
        }
        if (auto const* whole = std::get_if<std::int64_t>(&value)) {
            return fmt::format("{}", *whole);
        }
        double const real = std::get<double>(value);
        refuse_if<BadInput>(!std::isfinite(real), "{}: {} {} has {} = {}, which cannot be written", what_, table.name,
                            row + 1, column.name, real);
        return fmt::format("{:#}", real); // with a point: nobody takes it for an integer
    }
    std::string geometry(std::size_t row) const { return quote_(well_known(graph_.arcs.shape_at(row))); }
    std::pair<NodeId, NodeId> ends(ArcId a) const { return {graph_.plan.from(a) + 1, graph_.plan.to(a) + 1}; }
    void append(std::string_view text) { file_.append(text); }
    void close() { file_.close(); }

private:
    GraphTables const& graph_;
    std::string what_;
    Quote quote_;
    NewFile file_;
};

/// Calls body for each row of a table.
template <class Body> void each_row(Table const& table, Run const& run, Body const& body) {
    constexpr std::size_t rows_between_reports = 1024;
    for (std::size_t row = 0; row < table.rows; ++row) {
        if (row % rows_between_reports == 0) {
            run.at(static_cast<double>(row) / static_cast<double>(table.rows), "write");
        }
        body(row);
    }
}

/// Whether a column is one of the two that every edge begins with.
bool is_end(Column const& column) {
    return column.name == "from_node" || column.name == "to_node";
}

char const* graphml_type(Kind kind) {
    switch (kind) {
    case Kind::integer:
    case Kind::wide_integer: return "long";
    case Kind::real: return "double";
    case Kind::text:
    case Kind::date:
    case Kind::time:
    case Kind::datetime: break; // GraphML knows no dates
    }
    return "string";
}

std::string graphml_key(std::string const& id, char const* of, std::string const& name, char const* type) {
    return fmt::format("  <key id=\"{}\" for=\"{}\" attr.name=\"{}\" attr.type=\"{}\"/>\n", id, of, in_xml(name), type);
}

// Writes a new GraphML file: a directed graph with attribute crs; nodes with their columns and x, y; edges with theirs
// and their line, geometry, as well-known text. networkx.read_graphml(PATH, node_type=int) reads it. Gives: numbers
// that read back bit for bit. Throws: BadInput naming table, row and column when a number is not finite; IoError, also
// when the file exists. Source: GraphML 1.0.
void write_graphml(GraphTables const& graph, std::string const& path, Run const& run = {}) {
    Writer writer(graph, path, "write_graphml", in_xml);
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n" +
                       graphml_key("crs", "graph", "crs", "string") + graphml_key("x", "node", "x", "double") +
                       graphml_key("y", "node", "y", "double") + graphml_key("geometry", "edge", "geometry", "string");
    for (std::size_t i = 0; i < graph.nodes.columns.size(); ++i) {
        Column const& column = graph.nodes.columns[i];
        text += graphml_key(fmt::format("n{}", i), "node", column.name, graphml_type(column.kind));
    }
    for (std::size_t i = 0; i < graph.arcs.columns.size(); ++i) {
        Column const& column = graph.arcs.columns[i];
        text += graphml_key(fmt::format("e{}", i), "edge", column.name, graphml_type(column.kind));
    }
    text += fmt::format("  <graph id=\"network\" edgedefault=\"directed\">\n    <data key=\"crs\">{}</data>\n",
                        in_xml(graph.crs));
    writer.append(text);
    auto const data = [&](Table const& table, char letter, std::size_t row) {
        std::string out;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            fmt::format_to(std::back_inserter(out), "<data key=\"{}{}\">{}</data>", letter, i,
                           writer.value(table, table.columns[i], row));
        }
        return out;
    };
    each_row(graph.nodes, run, [&](std::size_t row) {
        Vec3 const at = graph.nodes.shape_at(row).front();
        writer.append(
            fmt::format("    <node id=\"{}\"><data key=\"x\">{:#}</data><data key=\"y\">{:#}</data>{}</node>\n",
                        row + 1, at.x, at.y, data(graph.nodes, 'n', row)));
    });
    each_row(graph.arcs, run, [&](std::size_t row) {
        auto const [from, to] = writer.ends(row);
        writer.append(fmt::format("    <edge source=\"{}\" target=\"{}\">{}<data key=\"geometry\">{}</data></edge>\n",
                                  from, to, data(graph.arcs, 'e', row), writer.geometry(row)));
    });
    writer.append("  </graph>\n</graphml>\n");
    writer.close();
}

// Writes the edges as a new CSV table: from_node, to_node, the other columns, geometry; a header first (RFC 4180).
// pandas.read_csv and networkx.from_pandas_edgelist read it. Gives and throws: like write_graphml.
void write_edge_table(GraphTables const& graph, std::string const& path, Run const& run = {}) {
    Writer writer(graph, path, "write_edge_table", in_csv);
    std::string header = "from_node,to_node";
    for (Column const& column : graph.arcs.columns) {
        header += is_end(column) ? "" : fmt::format(",{}", in_csv(column.name));
    }
    writer.append(header + ",geometry\r\n");
    each_row(graph.arcs, run, [&](std::size_t row) {
        auto const [from, to] = writer.ends(row);
        std::string line = fmt::format("{},{}", from, to);
        for (Column const& column : graph.arcs.columns) {
            line += is_end(column) ? "" : fmt::format(",{}", writer.value(graph.arcs, column, row));
        }
        writer.append(fmt::format("{},{}\r\n", line, writer.geometry(row)));
    });
    writer.close();
}

// Writes NetworkX's own edge list: two nodes and a Python dictionary of the other columns a line, comments first.
// networkx.read_edgelist(PATH, nodetype=int, create_using=networkx.DiGraph) reads it. Gives and throws: likewise.
void write_edge_list(GraphTables const& graph, std::string const& path, Run const& run = {}) {
    Writer writer(graph, path, "write_edge_list", in_python);
    writer.append("# networkx.read_edgelist(path, nodetype=int, create_using=networkx.DiGraph)\n");
    each_row(graph.arcs, run, [&](std::size_t row) {
        auto const [from, to] = writer.ends(row);
        std::string line;
        for (Column const& column : graph.arcs.columns) {
            if (!is_end(column)) {
                line += fmt::format("{}{}: {}", line.empty() ? "" : ", ", in_python(column.name),
                                    writer.value(graph.arcs, column, row));
            }
        }
        writer.append(fmt::format("{} {} {{{}}}\n", from, to, line));
    });
    writer.close();
}

void require_lines(RidgeLines const& ridges, std::string const& what) {
    for (std::size_t i = 0; i < ridges.lines.size(); ++i) {
        if (ridges.lines[i].line.size() < 2) {
            throw BadInput(fmt::format("{}: ridge {} between streams {} and {} has fewer than two vertices", what,
                                       i + 1, ridges.lines[i].left, ridges.lines[i].right));
        }
    }
}

Table run_table(std::map<std::string, std::string> const& rows) {
    std::vector<std::pair<std::string, std::string>> const list(rows.begin(), rows.end());
    return {"run",
            Table::Shape::none,
            list.size(),
            {{"name", Column::Kind::text, 0, [=](std::size_t row) { return list[row].first; }},
             {"value", Column::Kind::text, 0, [=](std::size_t row) { return list[row].second; }}},
            {}};
}

} // namespace

void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run) {
    std::string const file = path.ends_with(".gpkg") ? path : path + ".gpkg";
    require_whole(tables, "io.write_geopackage: " + file);
    std::vector<Table> layers{arcs_table(tables), nodes_table(tables)};
    if (tables.ridges != nullptr && !tables.ridges->lines.empty()) {
        require_lines(*tables.ridges, "io.write_geopackage: " + file);
        layers.push_back(ridges_table(*tables.ridges, tables.unit));
    }
    if (tables.secondary != nullptr && !tables.secondary->empty()) {
        layers.push_back(secondary_table(*tables.secondary, tables.user));
    }
    bool const has_sources =
        tables.user != nullptr && std::ranges::any_of(tables.user->sources, [](auto const& of) { return !of.empty(); });
    if (has_sources) {
        layers.push_back(sources_table(*tables.user));
    }
    layers.push_back(run_table(tables.run));
    write_tables(layers, tables.crs, file, run);
}

std::vector<ShortenedName> shortened_names(NetworkTables const& tables, Schema schema) {
    if (tables.user == nullptr) {
        return {};
    }
    std::string const what = "io.shortened_names";
    Table const full = network_layers(tables, schema, false, what).front();
    Table const cut = network_layers(tables, schema, true, what).front();
    std::vector<ShortenedName> names;
    for (std::size_t c = 0; c < full.columns.size(); ++c) {
        if (full.columns[c].is_users && full.columns[c].name != cut.columns[c].name) {
            names.push_back({full.columns[c].name, cut.columns[c].name});
        }
    }
    return names;
}

void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run) {
    require_whole(tables, "io.write_shapefiles: " + path);
    write_shapefile(arcs_table(tables, true), tables.crs, path + "_arcs.shp", run);
    write_shapefile(nodes_table(tables), tables.crs, path + "_nodes.shp", run);
}

namespace {

/// PATH without its ending, which follows.
std::pair<std::string, std::string> stem_and_ending(std::string const& path) {
    std::string const ending = std::filesystem::path(path).extension().string();
    return {path.substr(0, path.size() - ending.size()), ending};
}

bool is_a_file_a_layer(NetworkFormat format) {
    return format == NetworkFormat::shapefile || format == NetworkFormat::flatgeobuf ||
           format == NetworkFormat::geojson;
}

/// The file of a layer: one a layer where there are several.
std::string file_of(std::string const& path, std::string const& layer, bool several) {
    auto const [stem, ending] = stem_and_ending(path);
    return several ? fmt::format("{}_{}{}", stem, layer, ending) : path;
}

Mask mask_of(StreamNetwork const& plan, Grid const& grid) {
    Mask cells(grid);
    for (std::size_t a = 0; a < plan.arc_count(); ++a) {
        for (Cell const c : cells_along(plan.arc(a).line, grid, fmt::format("arc {}", a + 1))) {
            cells[c] = 1;
        }
    }
    return cells;
}

} // namespace

std::vector<NetworkFormatName> const& network_formats() {
    static std::vector<NetworkFormatName> const formats{
        {NetworkFormat::geopackage, "gpkg", ".gpkg"},    {NetworkFormat::shapefile, "shp", ".shp"},
        {NetworkFormat::flatgeobuf, "fgb", ".fgb"},      {NetworkFormat::geojson, "geojson", ".geojson"},
        {NetworkFormat::graphml, "graphml", ".graphml"}, {NetworkFormat::csv, "csv", ".csv"},
        {NetworkFormat::edges, "edges", ".edges"},       {NetworkFormat::mask, "tif", ".tif"}};
    return formats;
}

NetworkFormat network_format(std::string const& name, std::string const& path) {
    return format_of(network_formats(), name, path, "io.write_network");
}

std::vector<std::string> network_files(std::string const& path, WriteNetworkParams const& params) {
    std::string const name = std::filesystem::path(path).filename().string();
    if (!is_a_file_a_layer(params.format)) {
        return {name};
    }
    std::vector<std::string> files{name};
    if (params.schema == Schema::native) {
        files = {file_of(name, "arcs", true), file_of(name, "nodes", true)};
    }
    if (params.format == NetworkFormat::shapefile) {
        std::vector<std::string> const layers = files;
        for (std::string const& layer : layers) {
            for (char const* const ending : {".shx", ".dbf", ".prj", ".cpg"}) {
                files.push_back(stem_and_ending(layer).first + ending);
            }
        }
    }
    return files;
}

void write_network(NetworkTables const& tables, std::string const& path, WriteNetworkParams const& params,
                   Run const& run) {
    std::string const what = "io.write_network: " + path;
    if (params.schema == Schema::native && params.format == NetworkFormat::geopackage) {
        write_geopackage(tables, path, run);
        return;
    }
    bool const is_shapefile = params.format == NetworkFormat::shapefile;
    std::vector<Table> const layers = network_layers(tables, params.schema, is_shapefile, what);
    auto const each = [&](auto const& write) {
        for (Table const& layer : layers) {
            write(layer, tables.crs, file_of(path, layer.name, layers.size() > 1), run);
        }
    };
    switch (params.format) {
    case NetworkFormat::geopackage: write_tables(layers, tables.crs, path, run); break;
    case NetworkFormat::shapefile: each(write_shapefile); break;
    case NetworkFormat::flatgeobuf: each(write_flatgeobuf); break;
    case NetworkFormat::geojson: each(write_geojson); break;
    case NetworkFormat::graphml:
        write_graphml({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::csv:
        write_edge_table({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::edges:
        write_edge_list({layers.front(), nodes_table(tables), tables.network.plan, tables.crs}, path, run);
        break;
    case NetworkFormat::mask: write_mask(mask_of(tables.network.plan, params.grid), path, run); break;
    }
}

void write_findings(std::vector<Finding> const& findings, std::string const& crs, std::string const& path,
                    Run const& run) {
    auto const at = [&](std::size_t row) -> Finding const& { return findings[row]; };
    auto const finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
    Table table{"findings", Table::Shape::point, findings.size(), {}, {}};
    table.shape_at = [=](std::size_t row) {
        return std::vector<Vec3>{{finite(at(row).where.x), finite(at(row).where.y), 0.0}};
    };
    table.columns = {{"kind", Column::Kind::text, 0, [=](std::size_t row) { return at(row).kind; }},
                     {"feature", Column::Kind::wide_integer, 0, [=](std::size_t row) { return at(row).feature; }},
                     {"amount", Column::Kind::real, 0, [=](std::size_t row) { return finite(at(row).amount); }},
                     {"text", Column::Kind::text, 0, [=](std::size_t row) { return at(row).text; }}};
    write_tables({table}, crs, path, run);
}

} // namespace thalweg::io
