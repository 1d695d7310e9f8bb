// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/network_tables.hpp>

namespace thalweg::io {
namespace {

using Value = Column::Value;

/// What the quantities of an arc are, by its number; links to arcs are numbers too, no_arc for none.
class Arcs {
public:
    explicit Arcs(NetworkTables const& tables) : tables_(tables), plan_(tables.network.plan) {
        std::size_t const arcs = tables.network.plan.arc_count();
        key_.assign(arcs, 0);
        mouth_.assign(arcs, 0);
        outlet_.assign(arcs, 0);
        length_up_m_.assign(arcs, 0.0);
        longest_up_m_.assign(arcs, 0.0);
        std::int64_t key = 0;
        for (NodeId const n : tables.network.plan.upstream_order()) { // outlets first
            if (ArcId const a = tables.network.plan.out(n); a != no_arc) {
                ArcId const below = down(a);
                key_[a] = ++key;
                outlet_[a] = below == no_arc ? a : outlet_[below];
                mouth_[a] = below != no_arc && hack(below) == hack(a) ? mouth_[below] : a;
            }
        }
        for (auto n = tables.network.plan.upstream_order().rbegin(); n != tables.network.plan.upstream_order().rend();
             ++n) { // sources first
            if (ArcId const a = tables.network.plan.out(*n); a != no_arc) {
                for (ArcId const above : tables.network.plan.in(*n)) {
                    length_up_m_[a] += length_up_m_[above];
                    longest_up_m_[a] = std::max(longest_up_m_[a], longest_up_m_[above]);
                }
                length_up_m_[a] += length(a);
                longest_up_m_[a] += length(a);
            }
        }
    }

    std::vector<Vec3> line(ArcId a) const {
        std::vector<Vec3> line;
        for (std::size_t i = 0; Vec2 const p : arc(a).line) {
            line.push_back({p.x, p.y, z(a)[i++]});
        }
        return line;
    }

    /// The arc that a quantity names, no_arc for none.
    ArcId arc_of(Quantity quantity, ArcId a) const {
        using enum Quantity;
        switch (quantity) {
        case arc_id:
        case key: return a;
        case ds_arc:
        case ds_key: return down(a);
        case us_arc_1: return up(a, 0);
        case us_arc_2: return up(a, 1);
        case us_arc_3: return up(a, 2);
        case us_arc_4: return up(a, 3);
        case us_arc_5: return up(a, 4);
        case outlet_arc: return outlet_[a];
        case us_key: return main_up(a);
        case path: return mouth_[a];
        case ds_path: return down(a) == no_arc ? no_arc : mouth_[down(a)];
        case us_path: return main_up(a) == no_arc ? no_arc : mouth_[main_up(a)];
        case outlet_path: return mouth_[outlet_[a]];
        default: return no_arc;
        }
    }
    std::int64_t key_of(ArcId a) const { return key_[a]; }

    std::int64_t count(Quantity quantity, ArcId a) const {
        using enum Quantity;
        NetworkOrders const& orders = tables_.orders;
        switch (quantity) {
        case from_node: return static_cast<std::int64_t>(plan_.from(a)) + 1;
        case to_node: return static_cast<std::int64_t>(plan_.to(a)) + 1;
        case n_up: return static_cast<std::int64_t>(above(a).size());
        case basin_id: return orders.arc_basin[a];
        case topo_ord: return orders.topological[a];
        case strahler: return orders.strahler[a];
        case shreve: return orders.shreve[a];
        case hack: return this->hack(a);
        case feature: return arc(a).feature;
        case braided: return tables_.braided != nullptr && (*tables_.braided)[a] != 0 ? 1 : 0;
        case given: return arc(a).is_input ? 1 : 0;
        case ds_hack: return down(a) == no_arc ? 0 : this->hack(down(a));
        case n_down: return down(a) == no_arc ? 0 : 1;
        case is_source: return above(a).empty() ? 1 : 0;
        case is_outlet: return down(a) == no_arc ? 1 : 0;
        case horton: return orders.strahler[mouth_[a]]; // orders never fall downstream
        case scheidegger: return 2 * orders.shreve[a];
        case drwal: return static_cast<std::int64_t>(std::bit_width(static_cast<std::uint64_t>(orders.shreve[a])));
        default: return 0;
        }
    }

    /// [m, m2, m/m]; NaN where it is not known.
    double measure(Quantity quantity, ArcId a) const {
        using enum Quantity;
        NetworkOrders const& orders = tables_.orders;
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        double const drop_m = z(a).front() - z(a).back();
        double const straight_m = distance(arc(a).line.front(), arc(a).line.back());
        double const dist_out_m = orders.node_dist_out_m[plan_.to(a)];
        double const us_m2 = tables_.us_area_m2[a];
        double const ds_m2 = tables_.ds_area_m2[a];
        auto const known = [&](bool is_known, double value) { return is_known ? value : unknown; };
        switch (quantity) {
        case length: return this->length(a);
        case length_3d: return length_in_space(arc(a).line, z(a));
        case straight: return straight_m;
        case z_up: return known(tables_.heights, z(a).front());
        case z_down: return known(tables_.heights, z(a).back());
        case drop: return known(tables_.heights, drop_m);
        case slope: return known(tables_.heights, drop_m / this->length(a));
        case dist_out: return dist_out_m;
        case dist_mid: return dist_out_m + this->length(a) / 2.0;
        case dist_up: return dist_out_m + this->length(a);
        case dist_source: return longest_up_m_[a];
        case length_us: return length_up_m_[a];
        case sinuosity: return known(straight_m > 0.0, this->length(a) / straight_m);
        case us_area: return known(us_m2 >= 0.0, us_m2);
        case ds_area: return known(ds_m2 >= 0.0, ds_m2);
        case own_area: return known(us_m2 >= 0.0 && ds_m2 >= 0.0, ds_m2 - us_m2);
        case persistence: return known(std::isfinite(arc(a).persistence), arc(a).persistence);
        default: return unknown;
        }
    }

    std::string const& type(ArcId a) const { return arc(a).type; }

private:
    Arc const& arc(ArcId a) const { return plan_.arc(a); }
    std::vector<double> const& z(ArcId a) const { return tables_.network.arc_z[a]; }
    double length(ArcId a) const { return plan_.length_m(a); }
    int hack(ArcId a) const { return tables_.orders.hack[a]; }
    ArcId down(ArcId a) const { return plan_.out(plan_.to(a)); }
    std::span<ArcId const> above(ArcId a) const { return plan_.in(plan_.from(a)); }
    ArcId up(ArcId a, std::size_t k) const { return k < above(a).size() ? above(a)[k] : no_arc; }
    /// The arc upstream on the same main stem.
    ArcId main_up(ArcId a) const {
        std::span<ArcId const> const upstream = above(a);
        auto const found = std::ranges::find_if(upstream, [&](ArcId b) { return hack(b) == hack(a); });
        return found == upstream.end() ? no_arc : *found;
    }

    NetworkTables const& tables_;
    StreamNetwork const& plan_;
    std::vector<std::int64_t> key_;    ///< 1, 2, ... from the outlets upstream
    std::vector<ArcId> mouth_;         ///< last arc downstream of the same main stem
    std::vector<ArcId> outlet_;        ///< the arc at the outlet
    std::vector<double> length_up_m_;  ///< of all arcs upstream and its own
    std::vector<double> longest_up_m_; ///< of the longest way from a source, its own length with it
};

bool names_an_arc(Quantity quantity) {
    using enum Quantity;
    return quantity == arc_id || quantity == ds_arc || quantity == outlet_arc ||
           (quantity >= us_arc_1 && quantity <= us_arc_5);
}

bool names_a_key(Quantity quantity) {
    return quantity >= Quantity::key && quantity <= Quantity::outlet_path;
}

std::function<Value(ArcId)> value_of(SchemaField const& field, SchemaTable const& schema,
                                     std::shared_ptr<Arcs const> const& arcs) {
    double const none = std::isnan(field.unknown) ? -1.0 : field.unknown;
    Quantity const quantity = field.quantity;
    if (quantity == Quantity::constant) {
        return [field](ArcId) -> Value {
            using enum Column::Kind;
            return field.kind == text   ? Value(std::string(field.text))
                   : field.kind == real ? Value(field.value)
                                        : Value(static_cast<std::int64_t>(field.value));
        };
    }
    if (names_an_arc(quantity) || names_a_key(quantity)) {
        bool const is_key = names_a_key(quantity);
        return [=, first = schema.first_id](ArcId a) -> Value {
            ArcId const named = arcs->arc_of(quantity, a);
            return named == no_arc ? static_cast<std::int64_t>(none)
                   : is_key        ? arcs->key_of(named)
                                   : static_cast<std::int64_t>(named) + first;
        };
    }
    if (field.kind == Column::Kind::text) {
        return [=](ArcId a) -> Value { return arcs->type(a).empty() ? "none" : arcs->type(a); };
    }
    if (field.kind != Column::Kind::real) {
        return [=](ArcId a) -> Value { return arcs->count(quantity, a); };
    }
    return [=, unit = field.unit](ArcId a) -> Value {
        double const value = arcs->measure(quantity, a);
        return std::isnan(value) ? none : value / unit;
    };
}

/// The name, or its first other one that fits into a shapefile.
std::string short_name(SchemaField const& field) {
    constexpr std::size_t most = 10;
    std::string const words = std::string(field.name) + " " + std::string(field.also);
    for (std::size_t begin = 0; begin < words.size();) {
        std::size_t const end = std::min(words.find(' ', begin), words.size());
        if (end > begin && end - begin <= most) {
            return words.substr(begin, end - begin);
        }
        begin = end + 1;
    }
    return std::string(field.name.substr(0, most));
}

// The arcs of a network in the words, units and direction of a schema that is not the network's own; names of more than
// ten characters are short where short_names is set. Takes: a network with at most as many arcs upstream of one as the
// schema can name. What the fields tell stands with Quantity in schema.hpp; what is not known is the field's own word
// for it, and -1 where it has none. The arguments must outlive the table.
Table schema_arcs(SchemaTable const& schema, NetworkTables const& tables, bool short_names) {
    auto const arcs = std::make_shared<Arcs const>(tables);
    Table table{std::string(schema.layer), Table::Shape::line, tables.network.plan.arc_count(), {}, {}};
    table.shape_at = [arcs, upstream = schema.drawn_upstream](ArcId row) {
        std::vector<Vec3> line = arcs->line(row);
        if (upstream) {
            std::ranges::reverse(line);
        }
        return line;
    };
    for (SchemaField const& field : schema.fields) {
        if (field.written) {
            table.columns.push_back({short_names ? short_name(field) : std::string(field.name), field.kind,
                                     field.decimals, value_of(field, schema, arcs)});
        }
    }
    if (tables.user != nullptr) {
        add_user_columns(
            table, tables.user->attributes, [&user = *tables.user](ArcId a) { return user.record[a]; }, short_names,
            schema.schema);
    }
    return table;
}

void require_nameable(StreamNetwork const& plan, SchemaTable const& schema, std::string const& what) {
    auto const most = static_cast<std::size_t>(schema.most_upstream);
    for (NodeId n = 0; most > 0 && n < plan.node_count(); ++n) {
        if (plan.out(n) != no_arc && plan.in(n).size() > most) {
            throw BadInput(fmt::format("{}: {} rivers meet at ({}, {}), but {} names no more than {} upstream of one: "
                                       "split confluences (--max-upstream {})",
                                       what, plan.in(n).size(), plan.node(n).at.x, plan.node(n).at.y, schema.name, most,
                                       most));
        }
    }
}

} // namespace

void require_whole(NetworkTables const& tables, std::string const& what) {
    StreamNetwork const& plan = tables.network.plan;
    auto const& node_z = tables.network.node_z;
    auto const& arc_z = tables.network.arc_z;
    NetworkOrders const& orders = tables.orders;
    std::size_t const arcs = tables.network.plan.arc_count();
    std::size_t const nodes = plan.node_count();
    refuse_if<BadInput>(arcs == 0, "{}: the network has no arcs", what);
    bool const by_arc = arc_z.size() == arcs && orders.strahler.size() == arcs && orders.shreve.size() == arcs &&
                        orders.hack.size() == arcs && orders.topological.size() == arcs &&
                        orders.arc_basin.size() == arcs && tables.us_area_m2.size() == arcs &&
                        tables.ds_area_m2.size() == arcs &&
                        (tables.braided == nullptr || tables.braided->size() == arcs) &&
                        (tables.user == nullptr || tables.user->record.size() == arcs);
    bool const by_node = node_z.size() == nodes && orders.node_basin.size() == nodes &&
                         orders.node_strahler.size() == nodes && orders.node_dist_out_m.size() == nodes &&
                         tables.node_area_m2.size() == nodes;
    refuse_if<BadInput>(
        !by_arc || !by_node,
        "{}: heights, orders, areas and what is braided do not have one value for each of {} arcs and {} nodes", what,
        arcs, nodes);
    for (std::size_t i = 0; i < arcs; ++i) {
        auto const& line = plan.arc(i).line;
        NodeId const from = tables.network.plan.from(i);
        NodeId const to = tables.network.plan.to(i);
        bool const meets = line.size() >= 2 && arc_z[i].size() == line.size() && line.front() == plan.node(from).at &&
                           line.back() == plan.node(to).at && arc_z[i].front() == node_z[from] &&
                           arc_z[i].back() == node_z[to];
        refuse_if<BadInput>(!meets, "{}: arc {} does not begin at node {} and end at node {}", what, i + 1, from + 1,
                            to + 1);
    }
    for (NodeId n = 0; n < nodes; ++n) {
        if (tables.network.plan.basin(n) == 0) {
            throw BadInput(fmt::format("{}: node {} at ({}, {}) reaches no outlet", what, n + 1, plan.node(n).at.x,
                                       plan.node(n).at.y));
        }
    }
}

std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names,
                                  std::string const& what) {
    require_whole(tables, what);
    if (schema == Schema::native) {
        return {arcs_table(tables, short_names), nodes_table(tables)};
    }
    require_nameable(tables.network.plan, table_of(schema), what);
    return {schema_arcs(table_of(schema), tables, short_names)};
}

} // namespace thalweg::io
