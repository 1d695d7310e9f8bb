// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/write_graph.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/internal/files.hpp>

namespace thalweg::io {

namespace {

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
        if (!std::isfinite(real)) {
            throw BadInput(fmt::format("{}: {} {} has {} = {}, which cannot be written", what_, table.name, row + 1,
                                       column.name, real));
        }
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

} // namespace

void write_graphml(GraphTables const& graph, std::string const& path, Run const& run) {
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

void write_edge_table(GraphTables const& graph, std::string const& path, Run const& run) {
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

void write_edge_list(GraphTables const& graph, std::string const& path, Run const& run) {
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

} // namespace thalweg::io
