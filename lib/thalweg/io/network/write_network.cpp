// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/internal/access.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/qgis/internal/qgis.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/tables/internal/layers.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;
using Value = Column::Value;
/// A text as the format writes it.
using Quote = std::string (*)(std::string_view);

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

std::string well_known(Table const& lines, std::size_t row) {
    bool const in_plan = lines.shape == Table::Shape::plan_line;
    std::string out = in_plan ? "LINESTRING (" : "LINESTRING Z (";
    char const* separator = "";
    for (Vec3 const p : lines.shape_at(row)) {
        fmt::format_to(std::back_inserter(out), "{}{} {}", std::exchange(separator, ", "), p.x, p.y);
        if (!in_plan) {
            fmt::format_to(std::back_inserter(out), " {}", p.z);
        }
    }
    return out + ')';
}

// A network as nodes and edges in a text: an edge is an arc, its attributes the arc's columns; a node's id is its
// number
// + 1.

std::string value_text(Table const& table, Column const& column, std::size_t row, Quote quote, About const& about) {
    Value const value = column.at(row);
    if (std::holds_alternative<std::monostate>(value)) {
        return quote == in_python ? "None" : "";
    }
    if (auto const* text = std::get_if<std::string>(&value)) {
        return quote(*text);
    }
    if (auto const* whole = std::get_if<std::int64_t>(&value)) {
        return fmt::format("{}", *whole);
    }
    double const real = std::get<double>(value);
    refuse_if<BadInput>(!std::isfinite(real), about.where, "{}: {} {} has {} = {}, which cannot be written", about.name,
                        table.name, row + 1, column.name, real);
    return fmt::format("{:#}", real); // with a point: nobody takes it for an integer
}

/// GraphML knows no dates.
char const* graphml_type(Kind kind) {
    bool const is_whole = kind == Kind::integer || kind == Kind::wide_integer;
    return is_whole ? "long" : kind == Kind::real ? "double" : "string";
}

std::string graphml_key(std::string const& id, char const* of, std::string const& name, char const* type) {
    return fmt::format("  <key id=\"{}\" for=\"{}\" attr.name=\"{}\" attr.type=\"{}\"/>\n", id, of, xml_escaped(name),
                       type);
}

// Writes a new GraphML file: a directed graph with attribute crs; nodes with their columns and x, y; edges with theirs
// and their line, geometry, as well-known text. networkx.read_graphml(PATH, node_type=int) reads it. Numbers read back
// bit for bit. It throws BadInput naming table, row and column when a number is not finite; IoError, also when the file
// exists. Source: GraphML 1.0.
void write_graphml(NetworkTables const& tables, Table const& arcs, std::string const& path, Run const& run) {
    About const about{"io.write_network", path};
    StreamNetwork const& plan = tables.network.planform;
    Table const nodes = nodes_table(tables);
    NewFile graph(path, about);
    graph.append("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                 "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n" +
                 graphml_key("crs", "graph", "crs", "string") + graphml_key("x", "node", "x", "double") +
                 graphml_key("y", "node", "y", "double") + graphml_key("geometry", "edge", "geometry", "string"));
    auto const append_keys = [&](Table const& table, char letter, char const* of) {
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            Column const& column = table.columns[i];
            graph.append(graphml_key(fmt::format("{}{}", letter, i), of, column.name, graphml_type(column.kind)));
        }
    };
    append_keys(nodes, 'n', "node");
    append_keys(arcs, 'e', "edge");
    graph.append(fmt::format("  <graph id=\"network\" edgedefault=\"directed\">\n    <data key=\"crs\">{}</data>\n",
                             xml_escaped(tables.crs)));
    auto const data = [&](Table const& table, char letter, std::size_t row) {
        std::string out;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            if (std::holds_alternative<std::monostate>(table.columns[i].at(row))) {
                continue; // an empty text is no number
            }
            out += fmt::format("<data key=\"{}{}\">{}</data>", letter, i,
                               value_text(table, table.columns[i], row, xml_escaped, about));
        }
        return out;
    };
    each_row(nodes, run, [&](std::size_t row) {
        Vec3 const at = nodes.shape_at(row).front();
        graph.append(
            fmt::format("    <node id=\"{}\"><data key=\"x\">{:#}</data><data key=\"y\">{:#}</data>{}</node>\n",
                        row + 1, at.x, at.y, data(nodes, 'n', row)));
    });
    each_row(arcs, run, [&](std::size_t row) {
        graph.append(fmt::format("    <edge source=\"{}\" target=\"{}\">{}<data key=\"geometry\">{}</data></edge>\n",
                                 plan.from(row) + 1, plan.to(row) + 1, data(arcs, 'e', row),
                                 xml_escaped(well_known(arcs, row))));
    });
    graph.append("  </graph>\n</graphml>\n");
    graph.close();
}

// Writes the edges as a new CSV table: from_node, to_node, the other columns, geometry; a header first (RFC 4180).
// pandas.read_csv and networkx.from_pandas_edgelist read it. Or NetworkX's own edge list: two nodes and a Python
// dictionary of the other columns a line, comments first. networkx.read_edgelist(PATH, nodetype=int,
// create_using=networkx.DiGraph) reads it. Like write_graphml for the rest.
void write_edges(NetworkTables const& tables, Table arcs, std::string const& path, bool is_csv, Run const& run) {
    About const about{"io.write_network", path};
    StreamNetwork const& plan = tables.network.planform;
    NewFile graph(path, about);
    std::erase_if(arcs.columns, [](Column const& c) { return c.name == "from_node" || c.name == "to_node"; });
    if (is_csv) {
        graph.append("from_node,to_node");
        for (Column const& column : arcs.columns) {
            graph.append(fmt::format(",{}", in_csv(column.name)));
        }
        graph.append(",geometry\r\n");
    } else {
        graph.append("# networkx.read_edgelist(path, nodetype=int, create_using=networkx.DiGraph)\n");
    }
    each_row(arcs, run, [&](std::size_t row) {
        std::string line;
        for (Column const& column : arcs.columns) {
            std::string const value = value_text(arcs, column, row, is_csv ? in_csv : in_python, about);
            line += is_csv ? fmt::format("{},", value)
                           : fmt::format("{}{}: {}", line.empty() ? "" : ", ", in_python(column.name), value);
        }
        NodeId const from = plan.from(row) + 1;
        NodeId const to = plan.to(row) + 1;
        graph.append(is_csv ? fmt::format("{},{},{}{}\r\n", from, to, line, in_csv(well_known(arcs, row)))
                            : fmt::format("{} {} {{{}}}\n", from, to, line));
    });
    graph.close();
}

/// NAME_LAYER.ending for NAME.ending.
std::string file_of(std::filesystem::path const& path, std::string const& layer) {
    return (path.parent_path() / fmt::format("{}_{}{}", path.stem().string(), layer, path.extension().string()))
        .string();
}

bool is_a_file_a_layer(NetworkFormat format) {
    return format == NetworkFormat::shapefile || format == NetworkFormat::flatgeobuf ||
           format == NetworkFormat::geojson || format == NetworkFormat::geojson2008;
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

/// What is made, where: names are plain, so that they stand in SQL as they are.
struct Names {
    std::string schema; ///< of the database; "" for its default
    std::string name;

    std::string full(std::string const& relation) const { return schema.empty() ? relation : schema + "." + relation; }
    std::string edges() const { return name + "_edges"; }
};

bool is_plain_word(std::string_view word) {
    auto const letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
    constexpr std::size_t most = 50; // PostgreSQL cuts names after 63 bytes, ours get endings
    return !word.empty() && word.size() <= most && letter(word.front()) &&
           std::ranges::all_of(word, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

Names names_of(std::string const& text) {
    std::size_t const dot = text.find('.');
    Names names{dot == std::string::npos ? "" : text.substr(0, dot),
                dot == std::string::npos ? text : text.substr(dot + 1)};
    refuse_if<BadParameter>(
        (dot != std::string::npos && !is_plain_word(names.schema)) || !is_plain_word(names.name), "io.write_postgis",
        "'{}' is not a valid table name: write NAME or SCHEMA.NAME in lower-case letters, digits and _, at most 50",
        text);
    return names;
}

Dataset open_database(std::string const& connection, About const& about, Driver const& driver) {
    std::array<char const*, 2> constexpr drivers{"PostgreSQL", nullptr};
    std::array<char const*, 2> constexpr options{"LIST_ALL_TABLES=NO", nullptr};
    Dataset dataset(
        GDALDataset::Open(connection.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, drivers.data(), options.data()));
    if (dataset == nullptr) {
        std::string const reason = driver.take();
        throw IoError(about.where,
                      fmt::format("{} cannot be reached: {}", about.name, reason.empty() ? "no reason given" : reason));
    }
    return dataset;
}

/// A database in a transaction, which is rolled back unless commit() is called.
class Database {
public:
    Database(std::string const& connection, About const& about, std::string const& crs, std::string const& schema)
        : dataset_(open_database(connection, about, driver_)),
          reference_(crs.empty() ? OGRSpatialReference() : read_reference(crs)),
          target_{LayerFormat::postgresql, about, driver_, *dataset_, crs.empty() ? nullptr : &reference_, schema} {
        target_.require(dataset_->StartTransaction() == OGRERR_NONE);
    }
    ~Database() {
        if (open_) {
            dataset_->RollbackTransaction();
        }
    }
    Database(Database const&) = delete;
    Database& operator=(Database const&) = delete;

    /// The first field of the first row that a query gives, "" for none.
    std::string ask(std::string const& sql) {
        OGRLayer* const result = dataset_->ExecuteSQL(sql.c_str(), nullptr, nullptr);
        driver_.check(target_.about.where, target_.about.name);
        std::string answer;
        if (result != nullptr) {
            if (OGRFeatureUniquePtr const row{result->GetNextFeature()}; row != nullptr && row->GetFieldCount() > 0) {
                answer = row->GetFieldAsString(0);
            }
            dataset_->ReleaseResultSet(result);
        }
        return answer;
    }
    void write(Table const& table, Run const& run) {
        write_layer(target_, table, run);
        // The driver makes a table when its first row comes, or it is asked for what it holds.
        if (OGRLayer* const layer = dataset_->GetLayer(dataset_->GetLayerCount() - 1)) {
            target_.require(layer->SyncToDisk() == OGRERR_NONE);
        }
    }
    void commit() {
        target_.require(dataset_->CommitTransaction() == OGRERR_NONE);
        open_ = false;
        driver_.check(target_.about.where, target_.about.name);
    }

private:
    Driver driver_;
    Connection connection_;
    Dataset dataset_;
    OGRSpatialReference reference_;
    LayerTarget target_;
    bool open_ = true;
};

/// The view that pgRouting takes.
std::string edges_view(Names const& names, std::string const& table, SchemaTable const& schema) {
    auto const column = [&](Quantity quantity) { return lower_case(std::string(field_of(schema, quantity)->name)); };
    return fmt::format("CREATE VIEW {} AS SELECT {}::bigint AS id, {}::bigint AS source, {}::bigint AS target, {} AS "
                       "cost, -1.0::double precision AS reverse_cost, geom FROM {}",
                       names.full(names.edges()), column(Quantity::arc_id), column(Quantity::from_node),
                       column(Quantity::to_node), column(Quantity::length), names.full(table));
}

} // namespace

void write_geopackage(NetworkTables const& tables, std::string const& path, Run const& run) {
    bool const is_named_so = lower_case(std::filesystem::path(path).extension().string()) == ".gpkg";
    std::string const file = is_named_so ? path : path + ".gpkg";
    write_tables(geopackage_tables(tables, {"io.write_geopackage", file}), tables.crs, file, run);
}

void write_shapefiles(NetworkTables const& tables, std::string const& path, Run const& run) {
    for (Table const& layer : network_layers(tables, Schema::native, true, {"io.write_shapefiles", path})) {
        write_file({&layer, 1}, tables.crs, fmt::format("{}_{}.shp", path, layer.name), LayerFormat::shapefile, run);
    }
}

std::vector<ShortenedName> shortened_names(NetworkTables const& tables, Schema schema) {
    if (tables.user == nullptr) {
        return {};
    }
    About const about{"io.shortened_names", ""};
    Table const full = network_layers(tables, schema, false, about).front();
    Table const cut = network_layers(tables, schema, true, about).front();
    std::vector<ShortenedName> names;
    for (std::size_t c = 0; c < full.columns.size(); ++c) {
        if (full.columns[c].is_users && full.columns[c].name != cut.columns[c].name) {
            names.push_back({full.columns[c].name, cut.columns[c].name});
        }
    }
    return names;
}

std::vector<NetworkFormatName> const& network_formats() {
    static std::vector<NetworkFormatName> const formats{{NetworkFormat::geopackage, "gpkg", ".gpkg"},
                                                        {NetworkFormat::shapefile, "shp", ".shp"},
                                                        {NetworkFormat::flatgeobuf, "fgb", ".fgb"},
                                                        {NetworkFormat::geojson, "geojson", ".geojson"},
                                                        {NetworkFormat::geojson2008, "geojson2008", ".geojson"},
                                                        {NetworkFormat::graphml, "graphml", ".graphml"},
                                                        {NetworkFormat::csv, "csv", ".csv"},
                                                        {NetworkFormat::edges, "edges", ".edges"},
                                                        {NetworkFormat::mask, "tif", ".tif"}};
    return formats;
}

NetworkFormat network_format(std::string const& name, std::string const& path) {
    return format_of(network_formats(), name, path, "io.write_network");
}

std::vector<std::string> network_files(std::string const& path, WriteNetworkParams const& params) {
    std::string const name = std::filesystem::path(path).filename().string();
    std::vector<std::string> files{name};
    if (is_a_file_a_layer(params.format) && params.schema == Schema::native) {
        files = {file_of(name, "arcs"), file_of(name, "nodes")};
    }
    if (params.format == NetworkFormat::shapefile) {
        std::vector<std::string> const layers = files;
        for (std::string const& layer : layers) {
            for (char const* const ending : {".shx", ".dbf", ".prj", ".cpg"}) {
                files.push_back(std::filesystem::path(layer).replace_extension(ending).string());
            }
        }
    }
    return files;
}

void write_network(NetworkTables const& tables, std::string const& path, WriteNetworkParams const& params,
                   Run const& run) {
    if (params.schema == Schema::native && params.format == NetworkFormat::geopackage) {
        write_geopackage(tables, path, run);
        return;
    }
    bool const is_shapefile = params.format == NetworkFormat::shapefile;
    std::vector<Table> const layers = network_layers(tables, params.schema, is_shapefile, {"io.write_network", path});
    switch (params.format) {
    case NetworkFormat::geopackage: write_tables(layers, tables.crs, path, run); break;
    case NetworkFormat::graphml: write_graphml(tables, layers.front(), path, run); break;
    case NetworkFormat::csv: write_edges(tables, layers.front(), path, true, run); break;
    case NetworkFormat::edges: write_edges(tables, layers.front(), path, false, run); break;
    case NetworkFormat::mask: write_mask(mask_of(tables.network.planform, params.grid), path, run); break;
    default:
        for (Table const& layer : layers) { // both enumerations of formats begin alike, up to geojson2008
            write_file({&layer, 1}, tables.crs, layers.size() > 1 ? file_of(path, layer.name) : path,
                       static_cast<LayerFormat>(params.format), run);
        }
    }
}

void write_findings(std::vector<Finding> const& findings, std::string const& crs, std::string const& path,
                    Run const& run) {
    auto const at = [&](std::size_t row) -> Finding const& { return findings[row]; };
    auto const finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
    Table table{"findings", Table::Shape::point, findings.size(), {}, {}};
    table.shape_at = [=](std::size_t row) {
        Vec2 const where = at(row).where; // what is said of all has no place
        return is_finite(where) ? std::vector<Vec3>{{where.x, where.y, 0.0}} : std::vector<Vec3>{};
    };
    table.columns = {
        {"kind", Column::Kind::text, 0, [=](std::size_t row) { return std::string(at(row).kind); }},
        {"severity", Column::Kind::text, 0, [=](std::size_t row) { return std::string(name_of(at(row).severity())); }},
        {"feature", Column::Kind::wide_integer, 0, [=](std::size_t row) { return at(row).feature; }},
        {"amount", Column::Kind::real, 0, [=](std::size_t row) { return finite(at(row).amount); }},
        {"text", Column::Kind::text, 0, [=](std::size_t row) { return at(row).text; }}};
    std::set<std::string> kinds;
    std::ranges::transform(findings, std::inserter(kinds, kinds.end()), &Finding::kind);
    table.style = finding_style({kinds.begin(), kinds.end()});
    write_tables({table}, crs, path, run);
}

// A network in a database.

bool is_postgis(std::string const& name) {
    return name.starts_with("PG:") || name.starts_with("pg:");
}

std::vector<std::string> write_postgis(NetworkTables const& tables, std::string const& connection,
                                       WritePostgisParams const& params, Run const& run) {
    Names const names = names_of(params.name);
    About const about{"io.write_postgis", names.full(names.name)};
    std::vector<Table> layers = network_layers(tables, params.schema, false, about);
    bool const routable = field_of(table_of(params.schema), Quantity::from_node) != nullptr;
    std::vector<std::string> relations;
    for (Table& layer : layers) {
        layer.name = layers.size() > 1 ? names.name + "_" + layer.name : names.name;
        relations.push_back(layer.name);
    }
    if (routable) {
        relations.push_back(names.edges());
    }

    Database database(connection, about, tables.crs, names.schema);
    refuse_if<BadInput>(
        !names.schema.empty() &&
            database.ask(fmt::format("SELECT 1 FROM pg_namespace WHERE nspname = '{}'", names.schema)).empty(),
        about.where, "{}: the database has no schema {}: create it first", about.name, names.schema);
    for (auto relation = relations.rbegin(); relation != relations.rend(); ++relation) { // the view before its table
        std::string const kind = database.ask(
            fmt::format("SELECT relkind FROM pg_class WHERE oid = to_regclass('{}')", names.full(*relation)));
        if (kind.empty()) {
            continue;
        }
        bool const is_view = routable && *relation == names.edges();
        refuse_if<BadInput>(!params.overwrite, about.where,
                            "{}: {} already exists: give another name (--table) or use --overwrite", about.name,
                            names.full(*relation));
        refuse_if<BadInput>(kind != (is_view ? "v" : "r"), about.where,
                            "{}: {} is not a {} written by thalweg, and is not replaced", about.name,
                            names.full(*relation), is_view ? "view" : "table");
        database.ask(fmt::format("DROP {} {}", is_view ? "VIEW" : "TABLE", names.full(*relation)));
    }
    for (Table const& layer : layers) {
        database.write(layer, run);
    }
    if (routable) {
        database.ask(edges_view(names, layers.front().name, table_of(params.schema)));
    }
    database.commit();
    for (std::string& relation : relations) {
        relation = names.full(relation);
    }
    return relations;
}

} // namespace thalweg::io
