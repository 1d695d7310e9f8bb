// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/network_tables.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <thalweg/io/network/internal/table.hpp>

namespace thalweg::io {
namespace {

constexpr std::size_t dbf_name = 10;
constexpr std::size_t dbf_text = 254;

std::string without_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

/// As many bytes as fit, whole letters of UTF-8.
std::string cut_to(std::string const& text, std::size_t most) {
    if (text.size() <= most) {
        return text;
    }
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return text.substr(0, end);
}

std::set<std::string> in_lower(std::vector<std::string> const& names) {
    std::set<std::string> result;
    for (std::string const& name : names) {
        result.insert(without_case(name));
    }
    return result;
}

Column::Kind user_kind(AttributeTable::Type type, bool in_shapefile) {
    using Type = AttributeTable::Type;
    switch (type) {
    case Type::integer: return Column::Kind::integer;
    case Type::integer64: return Column::Kind::wide_integer;
    case Type::real: return Column::Kind::real;
    case Type::date: return Column::Kind::date;
    case Type::time: return in_shapefile ? Column::Kind::text : Column::Kind::time; // dBase has dates alone
    case Type::datetime: return in_shapefile ? Column::Kind::text : Column::Kind::datetime;
    case Type::text: break;
    }
    return Column::Kind::text;
}

/// Decimals that leave room for the digits of the greatest value of a column of 24 characters.
int user_decimals(AttributeTable const& attributes, std::size_t column) {
    double greatest = 0.0;
    for (auto const& row : attributes.rows) {
        if (auto const* real = std::get_if<double>(&row[column])) {
            greatest = std::max(greatest, std::fabs(*real));
        }
    }
    int digits = 1;
    for (double power = 10.0; digits < 20 && power <= greatest; power *= 10.0) {
        ++digits;
    }
    constexpr int room = 20;
    constexpr int most = 15;
    return std::clamp(room - digits, 0, most);
}

/// Whether one of the names, a blank between them, is there.
bool has_one_of(std::set<std::string> const& there, std::string_view names) {
    std::istringstream words{std::string(names)};
    return std::any_of(std::istream_iterator<std::string>(words), {},
                       [&](std::string const& word) { return there.contains(word); });
}

/// The names, in small letters, by which a layer with these columns would be recognised as another schema's. The
/// network schema has none: whoever reads it looks for no other.
std::set<std::string> misleading_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                       Schema schema) {
    std::set<std::string> result;
    if (schema == Schema::native) {
        return result;
    }
    std::set<std::string> there = in_lower(taken);
    for (auto const& column : attributes.columns) {
        there.insert(without_case(column.name));
    }
    for (SchemaTable const& other : all_schemas()) {
        bool const is_recognised =
            std::ranges::all_of(other.told_by, [&](std::string_view names) { return has_one_of(there, names); });
        if (other.schema == schema || !is_recognised) {
            continue;
        }
        for (std::string_view const names : other.told_by) {
            std::istringstream words{std::string(names)};
            result.insert(std::istream_iterator<std::string>(words), {});
        }
    }
    return result;
}

} // namespace

std::vector<std::string> user_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                    Schema schema) {
    std::set<std::string> used = in_lower(taken);
    std::set<std::string> const misleading = misleading_names(attributes, taken, schema);
    for (char const* const reserved : {"fid", "geom", "geometry", "ogc_fid"}) {
        used.insert(reserved);
    }
    std::vector<std::string> names;
    for (auto const& column : attributes.columns) {
        std::string const own = column.name.empty() ? "column" : column.name;
        bool const is_free = !used.contains(without_case(own)) && !misleading.contains(without_case(own));
        std::string name = is_free ? own : "u_" + own;
        for (int k = 2; !used.insert(without_case(name)).second; ++k) {
            name = fmt::format("{}_{}", own, k);
        }
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> short_user_names(std::vector<std::string> const& names,
                                          std::vector<std::string> const& taken) {
    std::set<std::string> used = in_lower(taken);
    for (std::string const& name : names) { // those that fit keep their names
        if (name.size() <= dbf_name) {
            used.insert(without_case(name));
        }
    }
    std::vector<std::string> result;
    for (std::string const& name : names) {
        std::string shorter = cut_to(name, dbf_name);
        for (int k = 2; name.size() > dbf_name && !used.insert(without_case(shorter)).second; ++k) {
            std::string const number = fmt::format("_{}", k);
            shorter = cut_to(name, dbf_name - number.size()) + number;
        }
        result.push_back(shorter);
    }
    return result;
}

void add_user_columns(Table& table, AttributeTable const& attributes,
                      std::function<std::int64_t(std::size_t row)> const& record, bool short_names, Schema schema) {
    std::vector<std::string> taken;
    for (Column const& column : table.columns) {
        taken.push_back(column.name);
    }
    std::vector<std::string> names = user_names(attributes, taken, schema);
    if (short_names) {
        names = short_user_names(names, taken);
    }
    for (std::size_t c = 0; c < names.size(); ++c) {
        Column column;
        column.name = names[c];
        column.kind = user_kind(attributes.columns[c].type, short_names);
        column.is_users = true;
        column.decimals = short_names && column.kind == Column::Kind::real ? user_decimals(attributes, c) : 0;
        column.at = [&attributes, record, c, short_names](std::size_t row) -> Column::Value {
            std::int64_t const r = record(row);
            if (r <= 0 || r > static_cast<std::int64_t>(attributes.rows.size())) {
                return {};
            }
            AttributeTable::Value value = attributes.rows[static_cast<std::size_t>(r - 1)][c];
            if (auto* const text = std::get_if<std::string>(&value); text != nullptr && short_names) {
                *text = cut_to(*text, dbf_text);
            }
            return value;
        };
        table.columns.push_back(std::move(column));
    }
}

namespace {

using Kind = Column::Kind;

template <class Get> Column integer(char const* name, Get get) {
    return {name, Kind::integer, 0, [get](std::size_t row) { return static_cast<std::int64_t>(get(row)); }};
}

template <class Get> Column real(char const* name, int decimals, Get get) {
    return {name, Kind::real, decimals, [get](std::size_t row) { return static_cast<double>(get(row)); }};
}

template <class Get> Column text(char const* name, Get get) {
    return {name, Kind::text, 0, [get](std::size_t row) { return std::string(get(row)); }};
}

/// Files in metres have no such column: it would change none of them but their bytes.
void add_unit(Table& table, HeightUnit unit) {
    if (unit != HeightUnit::metre) {
        table.columns.push_back(text("z_unit", [unit](auto) { return name_of(unit); }));
    }
}

} // namespace

double length_in_space(std::vector<Vec2> const& line, std::vector<double> const& z) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        double const plan = distance(line[i - 1], line[i]);
        double const rise = z[i] - z[i - 1];
        sum += std::sqrt(plan * plan + rise * rise);
    }
    return sum;
}

Table arcs_table(NetworkTables const& tables, bool short_names) {
    StreamNetwork const& plan = tables.network.plan;
    auto const& arc_z = tables.network.arc_z;
    NetworkOrders const& orders = tables.orders;
    auto const arc = [&](std::size_t row) -> Arc const& { return plan.arc(row); };
    auto const up = [&](std::size_t row) { return plan.from(row); };
    auto const down = [&](std::size_t row) { return plan.to(row); };

    double const unit = metres_in(tables.unit);
    Table table{"arcs", Table::Shape::line, plan.arc_count(), {}, {}};
    table.shape_at = [arc, unit, &arc_z](std::size_t row) {
        std::vector<Vec3> line;
        for (std::size_t i = 0; Vec2 const p : arc(row).line) {
            line.push_back({p.x, p.y, arc_z[row][i++] / unit});
        }
        return line;
    };
    table.columns = {
        integer("arc_id", [](auto row) { return row + 1; }),
        integer("from_node", [up](auto row) { return up(row) + 1; }),
        integer("to_node", [down](auto row) { return down(row) + 1; }),
        integer("ds_arc", [down, &plan](auto row) { return plan.out(down(row)) + 1; }),
        integer("n_up", [up, &plan](auto row) { return plan.in(up(row)).size(); }),
        integer("basin_id", [&orders](auto row) { return orders.arc_basin[row]; }),
        integer("topo_ord", [&orders](auto row) { return orders.topological[row]; }),
        integer("strahler", [&orders](auto row) { return orders.strahler[row]; }),
        integer("shreve", [&orders](auto row) { return orders.shreve[row]; }),
        integer("hack", [&orders](auto row) { return orders.hack[row]; }),
        real("length", length_decimals, [&plan](auto row) { return plan.length_m(row); }),
        real("length_3d", length_decimals,
             [arc, &arc_z](auto row) { return length_in_space(arc(row).line, arc_z[row]); }),
        real("straight", length_decimals,
             [arc](auto row) { return distance(arc(row).line.front(), arc(row).line.back()); }),
        real("z_up", length_decimals, [unit, &arc_z](auto row) { return arc_z[row].front() / unit; }),
        real("z_down", length_decimals, [unit, &arc_z](auto row) { return arc_z[row].back() / unit; }),
        real("dist_out", length_decimals, [down, &orders](auto row) { return orders.node_dist_out_m[down(row)]; }),
        real("slope", slope_decimals,
             [&arc_z, &plan](auto row) { return (arc_z[row].front() - arc_z[row].back()) / plan.length_m(row); }),
        real("us_area", area_decimals, [&area = tables.us_area_m2](auto row) { return area[row]; }),
        real("ds_area", area_decimals, [&area = tables.ds_area_m2](auto row) { return area[row]; }),
        real("survives", length_decimals,
             [arc](auto row) { return std::isinf(arc(row).persistence) ? -1.0 : arc(row).persistence; }),
        {"feature", Kind::wide_integer, 0, [arc](std::size_t row) { return arc(row).feature; }},
        // A shapefile reads an empty text back as NULL.
        text("type", [arc](auto row) { return arc(row).type.empty() ? "none" : arc(row).type; }),
        integer("braided", [of = tables.braided](auto row) { return of != nullptr && (*of)[row] != 0 ? 1 : 0; }),
        integer("given", [arc](auto row) { return arc(row).is_input ? 1 : 0; }),
    };
    if (tables.user != nullptr) {
        add_user_columns(
            table, tables.user->attributes, [&user = *tables.user](std::size_t row) { return user.record[row]; },
            short_names);
    }
    add_unit(table, tables.unit);
    return table;
}

Table nodes_table(NetworkTables const& tables) {
    auto const& plan = tables.network.plan;
    auto const& node_z = tables.network.node_z;
    NetworkOrders const& orders = tables.orders;

    double const unit = metres_in(tables.unit);
    Table table{"nodes", Table::Shape::point, plan.node_count(), {}, {}};
    table.shape_at = [unit, &plan, &node_z](std::size_t row) {
        Vec2 const p = plan.node(row).at;
        return std::vector<Vec3>{{p.x, p.y, node_z[row] / unit}};
    };
    table.columns = {
        integer("node_id", [](auto row) { return row + 1; }),
        text("kind",
             [&plan, &sinks = tables.sinks](auto row) {
                 bool const is_sink = std::binary_search(sinks.begin(), sinks.end(), row);
                 return name_of(is_sink ? NodeKind::sink : kind_of(plan, row));
             }),
        integer("deg_in", [&plan](auto row) { return plan.in(row).size(); }),
        integer("deg_out", [&plan](auto row) { return plan.out(row) == no_arc ? 0 : 1; }),
        integer("basin_id", [&orders](auto row) { return orders.node_basin[row]; }),
        integer("strahler", [&orders](auto row) { return orders.node_strahler[row]; }),
        real("z", length_decimals, [unit, &node_z](auto row) { return node_z[row] / unit; }),
        real("area", area_decimals, [&area = tables.node_area_m2](auto row) { return area[row]; }),
        real("dist_out", length_decimals, [&orders](auto row) { return orders.node_dist_out_m[row]; }),
    };
    add_unit(table, tables.unit);
    return table;
}

Table ridges_table(RidgeLines const& ridges, HeightUnit unit) {
    auto const ridge = [&ridges](std::size_t row) -> RidgeLine const& { return ridges.lines[row]; };
    auto const lower = [](Vec3 const& a, Vec3 const& b) { return a.z < b.z; };

    Table table{"ridges", Table::Shape::line, ridges.lines.size(), {}, {}};
    double const metres = metres_in(unit);
    table.shape_at = [ridge, metres](std::size_t row) {
        std::vector<Vec3> line = ridge(row).line;
        for (Vec3& p : line) {
            p.z /= metres;
        }
        return line;
    };
    table.columns = {
        integer("ridge_id", [](auto row) { return row + 1; }),
        integer("left", [ridge](auto row) { return ridge(row).left; }),
        integer("right", [ridge](auto row) { return ridge(row).right; }),
        real("length", length_decimals, [ridge](auto row) { return length_in_plan(ridge(row).line); }),
        real("z_min", length_decimals,
             [=](auto row) { return std::ranges::min_element(ridge(row).line, lower)->z / metres; }),
        real("z_max", length_decimals,
             [=](auto row) { return std::ranges::max_element(ridge(row).line, lower)->z / metres; }),
    };
    add_unit(table, unit);
    return table;
}

Table secondary_table(std::vector<SecondaryLine> const& secondary, UserData const* user) {
    auto const one = [&secondary](std::size_t row) -> SecondaryLine const& { return secondary[row]; };
    Table table{"secondary", Table::Shape::plan_line, secondary.size(), {}, {}};
    table.shape_at = [one](std::size_t row) {
        std::vector<Vec3> line = one(row).vertices;
        for (Vec3& v : line) {
            v.z = 0.0;
        }
        return line;
    };
    table.columns = {
        {"feature", Kind::wide_integer, 0, [one](std::size_t row) { return one(row).feature; }},
        text("reason", [one](auto row) { return one(row).reason; }),
        real("length", length_decimals, [one](auto row) { return length_in_plan(one(row).vertices); }),
    };
    if (user != nullptr) {
        add_user_columns(
            table, user->attributes, [one](std::size_t row) { return one(row).record; }, false);
    }
    return table;
}

Table sources_table(UserData const& user) {
    struct Row {
        std::int64_t arc;
        Stretch stretch;
    };
    auto const rows = std::make_shared<std::vector<Row>>();
    for (std::size_t a = 0; a < user.sources.size(); ++a) {
        for (Stretch const& s : user.sources[a]) {
            rows->push_back({static_cast<std::int64_t>(a) + 1, s});
        }
    }
    Table table{"sources", Table::Shape::none, rows->size(), {}, {}};
    table.columns = {
        integer("arc_id", [rows](auto row) { return (*rows)[row].arc; }),
        {"feature", Kind::wide_integer, 0, [rows](std::size_t row) { return (*rows)[row].stretch.feature; }},
        real("from_m", length_decimals, [rows](auto row) { return (*rows)[row].stretch.from_m; }),
        real("to_m", length_decimals, [rows](auto row) { return (*rows)[row].stretch.to_m; }),
    };
    return table;
}

} // namespace thalweg::io
