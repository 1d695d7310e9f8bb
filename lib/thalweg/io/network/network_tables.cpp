// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/network_tables.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/tables/internal/layers.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;
using Value = Column::Value;

constexpr std::size_t dbf_name = 10;
constexpr std::size_t dbf_text = 254;

/// As many bytes as fit, whole letters of UTF-8.
std::string cut_to(std::string const& text, std::size_t most) {
    std::size_t end = std::min(most, text.size());
    while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return text.substr(0, end);
}

std::set<std::string> in_lower_case(std::vector<std::string> const& names) {
    std::set<std::string> result;
    std::ranges::transform(names, std::inserter(result, result.end()), lower_case);
    return result;
}

/// Decimals that leave room for the digits of the greatest value of a column of 24 characters.
int user_decimals(AttributeTable const& attributes, std::size_t column) {
    double greatest = 0.0;
    for (auto const& row : attributes.rows) {
        if (auto const* real = std::get_if<double>(&row[column])) {
            greatest = std::max(greatest, std::fabs(*real));
        }
    }
    int decimals = 15;
    for (double power = 1e5; decimals > 0 && power <= greatest; power *= 10.0) {
        --decimals;
    }
    return decimals;
}

/// The names, in small letters, by which a layer with these columns would be recognised as another schema's. Beside the
/// native schema there are none: whoever reads it looks for no other.
std::set<std::string> misleading_names(AttributeTable const& attributes, std::set<std::string> there, Schema schema) {
    std::set<std::string> result;
    for (auto const& column : attributes.columns) {
        there.insert(lower_case(column.name));
    }
    for (SchemaTable const& other : all_schemas()) {
        bool const is_recognised = std::ranges::all_of(other.told_by, [&](std::string_view names) {
            return std::ranges::any_of(words_of(names), [&](auto const& word) { return there.contains(word); });
        });
        if (schema != Schema::native && other.schema != schema && is_recognised) {
            for (std::string_view const names : other.told_by) {
                std::ranges::copy(words_of(names), std::inserter(result, result.end()));
            }
        }
    }
    return result;
}

/// The names that columns get beside others that are taken, in a layer of a schema: u_NAME where the name is taken, or
/// is that of a feature's id or geometry, or the layer would be recognised as another schema's by it; else as they are;
/// with a number where two are equal in any case of letters.
std::vector<std::string> user_names(AttributeTable const& attributes, std::vector<std::string> const& taken,
                                    Schema schema) {
    std::set<std::string> used = in_lower_case(taken);
    std::set<std::string> const misleading = misleading_names(attributes, used, schema);
    used.insert({"fid", "geom", "geometry", "ogc_fid"});
    std::vector<std::string> names;
    for (auto const& column : attributes.columns) {
        std::string const own = column.name.empty() ? "column" : column.name;
        bool const is_free = !used.contains(lower_case(own)) && !misleading.contains(lower_case(own));
        std::string name = is_free ? own : "u_" + own;
        for (int k = 2; !used.insert(lower_case(name)).second; ++k) {
            name = fmt::format("{}_{}", own, k);
        }
        names.push_back(name);
    }
    return names;
}

/// The same in a shapefile: of at most 10 bytes, cut before a letter and made unique by a number at their end.
std::vector<std::string> short_user_names(std::vector<std::string> const& names,
                                          std::vector<std::string> const& taken) {
    std::set<std::string> used = in_lower_case(taken);
    for (std::string const& name : names) { // those that fit keep their names
        if (name.size() <= dbf_name) {
            used.insert(lower_case(name));
        }
    }
    std::vector<std::string> result;
    for (std::string const& name : names) {
        std::string shorter = cut_to(name, dbf_name);
        for (int k = 2; name.size() > dbf_name && !used.insert(lower_case(shorter)).second; ++k) {
            std::string const number = fmt::format("_{}", k);
            shorter = cut_to(name, dbf_name - number.size()) + number;
        }
        result.push_back(shorter);
    }
    return result;
}

/// The divergences of a forest. A minor branch begins in a node of its own, without inflow, at the place of the node
/// that its main branch leaves.
class Divergences {
public:
    /// \param has_any whether nodes at one place count as divergences
    Divergences(StreamNetwork const& plan, bool has_any, NetworkTables const& tables)
        : plan_(plan), start_(plan.from()), minor_(plan.node_count()) {
        if (has_any) {
            find();
        }
        order_downstream_first();
        if (any_) {
            count_orders();
            route_areas(tables);
            find_returns();
        }
    }

    bool any() const { return any_; }
    /// The node that an arc leaves, of a minor branch that of the main one.
    NodeId start(ArcId a) const { return start_[a]; }
    bool is_minor(ArcId a) const { return start_[a] != plan_.from(a); }
    /// The minor branches that leave a node.
    std::vector<ArcId> const& minor(NodeId n) const { return minor_[n]; }
    /// All arcs, each after those into which its water runs.
    std::vector<ArcId> const& downstream_first() const { return downstream_first_; }
    std::int64_t stream_calc(ArcId a) const { return calc_[a]; }
    std::int64_t strahler(ArcId a) const { return strahler_[a]; }
    double routed_m2(ArcId a) const { return routed_m2_[a]; } ///< -1: unknown
    bool returns(ArcId a) const { return any_ && returns_[a] != 0; }

private:
    void find() {
        std::map<std::pair<double, double>, NodeId> divides; // by place: nodes with inflow and outflow
        for (NodeId n = 0; n < plan_.node_count(); ++n) {
            if (plan_.out(n) != no_arc && !plan_.in(n).empty()) {
                divides.emplace(std::pair(plan_.node(n).at.x, plan_.node(n).at.y), n);
            }
        }
        for (ArcId a = 0; a < plan_.arc_count(); ++a) {
            NodeId const n = plan_.from(a);
            auto const divide = divides.find({plan_.node(n).at.x, plan_.node(n).at.y});
            if (plan_.in(n).empty() && divide != divides.end()) {
                start_[a] = divide->second;
                minor_[divide->second].push_back(a);
                any_ = true;
            }
        }
    }

    void order_downstream_first() {
        std::vector<std::size_t> missing(plan_.node_count()); // by node: arcs that leave it and are not yet in order
        std::vector<NodeId> ready;
        for (NodeId const n : plan_.upstream_order()) {
            missing[n] = (plan_.out(n) == no_arc ? 0 : 1) + minor_[n].size();
            if (missing[n] == 0) {
                ready.push_back(n);
            }
        }
        for (std::size_t i = 0; i < ready.size(); ++i) {
            for (ArcId const a : plan_.in(ready[i])) {
                downstream_first_.push_back(a);
                if (--missing[start_[a]] == 0) {
                    ready.push_back(start_[a]);
                }
            }
        }
        refuse_if<BadInput>(downstream_first_.size() < plan_.arc_count(), "io.write_network",
                            "rivers run in a circle through a divergence; run thalweg check on the file; its --fix "
                            "writes a mended copy");
    }

    /// Strahler's rule without minor branches, and the order of the water that enters these.
    void count_orders() {
        calc_.assign(plan_.arc_count(), 0);
        strahler_.assign(plan_.arc_count(), 0);
        for (auto a = downstream_first_.rbegin(); a != downstream_first_.rend(); ++a) { // upstream first
            std::int64_t highest = 0;
            std::int64_t how_many = 0;
            std::int64_t arriving = 0;
            for (ArcId const up : plan_.in(start_[*a])) {
                how_many = calc_[up] > highest ? 1 : how_many + (calc_[up] == highest ? 1 : 0);
                highest = std::max(highest, calc_[up]);
                arriving = std::max(arriving, strahler_[up]);
            }
            bool const is_source = plan_.in(start_[*a]).empty();
            std::int64_t const by_rule = is_source ? 1 : highest + (highest > 0 && how_many > 1 ? 1 : 0);
            calc_[*a] = is_minor(*a) ? 0 : by_rule;
            strahler_[*a] = std::max({by_rule, calc_[*a] == 0 ? arriving : 0, std::int64_t{1}});
        }
    }

    void route_areas(NetworkTables const& tables) {
        routed_m2_.assign(plan_.arc_count(), -1.0);
        for (auto a = downstream_first_.rbegin(); a != downstream_first_.rend(); ++a) {
            double const us_m2 = tables.us_area_m2[*a];
            double const ds_m2 = tables.ds_area_m2[*a];
            if (us_m2 < 0.0 || ds_m2 < 0.0) {
                continue;
            }
            double sum_m2 = 0.0;
            double routed_m2 = is_minor(*a) ? 0.0 : plan_.in(plan_.from(*a)).empty() ? us_m2 : 0.0;
            bool is_known = true;
            for (ArcId const up : plan_.in(plan_.from(*a))) {
                sum_m2 += tables.ds_area_m2[up];
                routed_m2 += routed_m2_[up];
                is_known = is_known && routed_m2_[up] >= 0.0;
            }
            bool const has_inflow = !plan_.in(plan_.from(*a)).empty();
            double const between_m2 = has_inflow ? std::max(us_m2 - sum_m2, 0.0) : 0.0;
            if (is_known) {
                routed_m2_[*a] = std::min(routed_m2 + between_m2 + (ds_m2 - us_m2), ds_m2);
            }
        }
    }

    /// Follows the water of each divergence downstream to where all of it has met again.
    void find_returns() {
        returns_.assign(plan_.arc_count(), 0);
        std::vector<std::size_t> rank(plan_.arc_count()); // falls downstream
        for (std::size_t i = 0; i < downstream_first_.size(); ++i) {
            rank[downstream_first_[i]] = i;
        }
        for (NodeId divide = 0; divide < plan_.node_count(); ++divide) {
            if (minor_[divide].empty()) {
                continue;
            }
            std::map<std::size_t, int> ahead; // by rank: how many inflows of an arc have this water
            auto const enter = [&](NodeId n) {
                auto const add = [&](ArcId a) { ++ahead[rank[a]]; };
                std::ranges::for_each(minor_[n], add);
                if (plan_.out(n) != no_arc) {
                    add(plan_.out(n));
                }
            };
            enter(divide);
            while (ahead.size() > 1) {
                auto const farthest = std::prev(ahead.end());
                ArcId const a = downstream_first_[farthest->first];
                ahead.erase(farthest);
                enter(plan_.to(a));
                for (auto const& [at, inflows] : ahead) {
                    if (inflows > 1) {
                        returns_[downstream_first_[at]] = 1;
                    }
                }
            }
        }
    }

    StreamNetwork const& plan_;
    std::vector<NodeId> start_;             ///< by arc
    std::vector<std::vector<ArcId>> minor_; ///< by node
    bool any_ = false;
    std::vector<ArcId> downstream_first_ = {};
    std::vector<std::int64_t> calc_ = {};     ///< by arc
    std::vector<std::int64_t> strahler_ = {}; ///< by arc
    std::vector<double> routed_m2_ = {};      ///< by arc
    std::vector<std::uint8_t> returns_ = {};  ///< by arc
};

/// The quantities of a network's arcs in a schema.
class Arcs {
public:
    Arcs(NetworkTables const& tables, SchemaTable const& schema)
        : tables_(tables), plan_(tables.network.planform), schema_(schema),
          z_unit_m_(schema.schema == Schema::native ? metres_in(tables.unit) : 1.0), key_(plan_.arc_count()),
          mouth_(plan_.arc_count()), outlet_(plan_.arc_count()), length_up_m_(plan_.arc_count()),
          longest_up_m_(plan_.arc_count()), divided_(plan_, schema.divergences, tables) {
        auto const& upstream = plan_.upstream_order();
        for (std::int64_t key = 0; ArcId const a : divided_.downstream_first()) {
            key_[a] = ++key;
        }
        for (NodeId const n : upstream) { // outlets first
            if (ArcId const a = plan_.out(n); a != no_arc) {
                ArcId const below = down(a);
                outlet_[a] = below == no_arc ? a : outlet_[below];
                mouth_[a] = below != no_arc && hack_of(below) == hack_of(a) ? mouth_[below] : a;
            }
        }
        for (auto n = upstream.rbegin(); n != upstream.rend(); ++n) { // sources first
            if (ArcId const a = plan_.out(*n); a != no_arc) {
                for (ArcId const above : plan_.in(*n)) {
                    length_up_m_[a] += length_up_m_[above];
                    longest_up_m_[a] = std::max(longest_up_m_[a], longest_up_m_[above]);
                }
                length_up_m_[a] += plan_.length_m(a);
                longest_up_m_[a] += plan_.length_m(a);
            }
        }
    }

    std::vector<Vec3> line(ArcId a) const {
        std::vector<Vec3> line;
        for (std::size_t i = 0; Vec2 const p : plan_.arc(a).line) {
            line.push_back({p.x, p.y, z(a)[i++] / z_unit_m_});
        }
        if (schema_.drawn_upstream) {
            std::ranges::reverse(line);
        }
        return line;
    }

    bool is_native() const { return schema_.schema == Schema::native; }

    /// In m, m2 and m/m; NULL where it is not known, or there is no such arc.
    Value value(Quantity quantity, ArcId a) const {
        using enum Quantity;
        Arc const& arc = plan_.arc(a);
        NetworkOrders const& orders = tables_.orders;
        bool const heights = tables_.heights;
        double const length_m = plan_.length_m(a);
        double const dist_out_m = orders.node_dist_out_m[plan_.to(a)];
        double const us_m2 = tables_.us_area_m2[a];
        double const ds_m2 = tables_.ds_area_m2[a];
        switch (quantity) {
        case arc_id: return id(a);
        case ds_arc: return id(down(a));
        case us_arc_1: return id(up(a, 0));
        case us_arc_2: return id(up(a, 1));
        case us_arc_3: return id(up(a, 2));
        case us_arc_4: return id(up(a, 3));
        case us_arc_5: return id(up(a, 4));
        case outlet_arc: return id(outlet_[a]);
        case key: return key_of(a);
        case ds_key: return key_of(down(a));
        case us_key: return key_of(main_up(a));
        case path: return key_of(mouth_[a]);
        case ds_path: return key_of(mouth(down(a)));
        case us_path: return key_of(mouth(main_up(a)));
        case outlet_path: return key_of(mouth_[outlet_[a]]);
        case from_node: return static_cast<std::int64_t>(divided_.start(a)) + 1;
        case to_node: return static_cast<std::int64_t>(plan_.to(a)) + 1;
        case n_up: return static_cast<std::int64_t>(above(a).size());
        case basin_id: return orders.arc_basin[a];
        case topo_ord: return orders.topological[a];
        case strahler: return divided_.any() ? divided_.strahler(a) : orders.strahler[a];
        case shreve: return orders.shreve[a];
        case hack: return hack_of(a);
        case feature: return arc.feature;
        case type: return arc.type.empty() ? "none" : arc.type; // a shapefile reads an empty text back as NULL
        case braided: return tables_.braided != nullptr && (*tables_.braided)[a] != 0 ? 1 : 0;
        case given: return arc.is_input ? 1 : 0;
        case ds_hack: return down(a) == no_arc ? 0 : hack_of(down(a));
        case n_down: return static_cast<std::int64_t>((down(a) == no_arc ? 0 : 1) + divided_.minor(plan_.to(a)).size());
        case is_source: return above(a).empty() ? 1 : 0;
        case is_outlet: return down(a) == no_arc ? 1 : 0;
        case horton: return orders.strahler[mouth_[a]]; // orders never fall downstream
        case scheidegger: return 2 * orders.shreve[a];
        case drwal: return static_cast<std::int64_t>(std::bit_width(static_cast<std::uint64_t>(orders.shreve[a])));
        case length: return length_m;
        case length_3d: return known(heights, length_in_space(a));
        case straight: return straight_m(a);
        case z_up: return known(heights, z(a).front() / z_unit_m_);
        case z_down: return known(heights, z(a).back() / z_unit_m_);
        case drop: return known(heights, z(a).front() - z(a).back());
        case slope: return known(heights, (z(a).front() - z(a).back()) / length_m);
        case dist_out: return dist_out_m;
        case dist_mid: return dist_out_m + length_m / 2.0;
        case dist_up: return dist_out_m + length_m;
        case dist_source: return longest_up_m_[a];
        case length_us: return length_up_m_[a];
        case sinuosity: return known(straight_m(a) > 0.0, length_m / straight_m(a));
        case us_area: return known(!(us_m2 < 0.0), us_m2);
        case ds_area: return known(!(ds_m2 < 0.0), ds_m2);
        case own_area: return own_area_of(a);
        case routed_area:
            return divided_.any() ? known(divided_.routed_m2(a) >= 0.0, divided_.routed_m2(a))
                                  : known(!(ds_m2 < 0.0), ds_m2);
        case stream_calc: return divided_.any() ? divided_.stream_calc(a) : orders.strahler[a];
        case divergence: return divided_.is_minor(a) ? 2 : divided_.minor(plan_.from(a)).empty() ? 0 : 1;
        case ds_minor: return divided_.minor(plan_.to(a)).empty() ? Value() : key_[divided_.minor(plan_.to(a)).front()];
        case returns: return divided_.returns(a) ? 1 : 0;
        case persistence: return known(!std::isinf(arc.persistence), arc.persistence);
        case constant: break;
        }
        return {};
    }

private:
    Value own_area_of(ArcId a) const {
        double const us_m2 = tables_.us_area_m2[a];
        double const ds_m2 = tables_.ds_area_m2[a];
        if (tables_.own_area_m2 != nullptr && (us_m2 < 0.0 || ds_m2 < 0.0)) {
            return known((*tables_.own_area_m2)[a] >= 0.0, (*tables_.own_area_m2)[a]);
        }
        return known(!(us_m2 < 0.0) && !(ds_m2 < 0.0), ds_m2 - us_m2);
    }
    static Value known(bool is_known, double value) { return is_known ? Value(value) : Value(); }
    Value id(ArcId a) const { return a == no_arc ? Value() : static_cast<std::int64_t>(a) + schema_.first_id; }
    Value key_of(ArcId a) const { return a == no_arc ? Value() : key_[a]; }
    std::vector<double> const& z(ArcId a) const { return tables_.network.arc_z[a]; }
    int hack_of(ArcId a) const { return tables_.orders.hack[a]; }
    ArcId mouth(ArcId a) const { return a == no_arc ? no_arc : mouth_[a]; }
    ArcId down(ArcId a) const { return plan_.out(plan_.to(a)); }
    std::span<ArcId const> above(ArcId a) const { return plan_.in(divided_.start(a)); }
    ArcId up(ArcId a, std::size_t k) const { return k < above(a).size() ? above(a)[k] : no_arc; }
    /// The arc upstream on the same main stem.
    ArcId main_up(ArcId a) const {
        std::span<ArcId const> const upstream = above(a);
        int const hack = hack_of(divided_.is_minor(a) ? plan_.out(divided_.start(a)) : a);
        auto const found = std::ranges::find_if(upstream, [&](ArcId b) { return hack_of(b) == hack; });
        return found == upstream.end() ? no_arc : *found;
    }
    double straight_m(ArcId a) const { return distance(plan_.arc(a).line.front(), plan_.arc(a).line.back()); }
    double length_in_space(ArcId a) const {
        auto const& line = plan_.arc(a).line;
        double sum = 0.0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const in_plan = distance(line[i - 1], line[i]);
            double const rise = z(a)[i] - z(a)[i - 1];
            sum += std::sqrt(in_plan * in_plan + rise * rise);
        }
        return sum;
    }

    NetworkTables const& tables_;
    StreamNetwork const& plan_;
    SchemaTable const& schema_;
    double z_unit_m_;
    std::vector<std::int64_t> key_;    ///< 1, 2, ... from the outlets upstream
    std::vector<ArcId> mouth_;         ///< last arc downstream of the same main stem
    std::vector<ArcId> outlet_;        ///< the arc at the outlet
    std::vector<double> length_up_m_;  ///< of all arcs upstream and its own
    std::vector<double> longest_up_m_; ///< of the longest path from a source, its own length included
    Divergences divided_;
};

/// The name of a field, or its first other one that fits into a shapefile.
std::string short_name(SchemaField const& field) {
    std::vector<std::string> const names = names_of(field);
    auto const fits = std::ranges::find_if(names, [](auto const& name) { return name.size() <= dbf_name; });
    return fits == names.end() ? names.front().substr(0, dbf_name) : *fits;
}

/// Follows from heights: NULL in the native schema where these are unknown.
constexpr std::array of_heights{Quantity::length_3d, Quantity::z_up, Quantity::z_down, Quantity::slope};

/// What is not known is the field's own word for it, and -1 where it has none.
Value field_value(SchemaField const& field, Arcs const& arcs, ArcId a) {
    if (field.quantity == Quantity::constant && field.kind == Kind::text) {
        return std::string(field.text);
    }
    bool const is_real = field.kind == Kind::real;
    Value value = arcs.value(field.quantity, a);
    if (arcs.is_native() && std::holds_alternative<std::monostate>(value) &&
        std::ranges::find(of_heights, field.quantity) != of_heights.end()) {
        return value;
    }
    if (std::holds_alternative<std::monostate>(value)) {
        double const none = field.quantity == Quantity::constant ? field.value
                            : std::isnan(field.unknown)          ? -1.0
                                                                 : field.unknown;
        return is_real ? Value(none) : Value(static_cast<std::int64_t>(none));
    }
    if (auto* const real = std::get_if<double>(&value)) {
        *real /= field.unit;
    }
    return value;
}

template <class Get> Column integer(char const* name, Get get) {
    return {name, Kind::integer, 0, [get](std::size_t row) { return static_cast<std::int64_t>(get(row)); }};
}

template <class Get> Column real(char const* name, int decimals, Get get) {
    return {name, Kind::real, decimals, [get](std::size_t row) { return static_cast<double>(get(row)); }};
}

template <class Get> Column text(char const* name, Get get) {
    return {name, Kind::text, 0, [get](std::size_t row) { return std::string(get(row)); }};
}

/// Files in metres have no such column: only their bytes would change.
void add_unit(Table& table, HeightUnit unit) {
    if (unit != HeightUnit::metre) {
        table.columns.push_back(text("z_unit", [unit](auto) { return name_of(unit); }));
    }
}

/// \return null where a schema has no such field
SchemaField const* written_field(SchemaTable const& schema, Quantity quantity) {
    auto const found = std::ranges::find_if(
        schema.fields, [quantity](SchemaField const& field) { return field.written && field.quantity == quantity; });
    return found == schema.fields.end() ? nullptr : &*found;
}

QgisStyle style_of_arcs(NetworkTables const& tables, SchemaTable const& schema) {
    SchemaField const* const order = written_field(schema, Quantity::strahler);
    SchemaField const* const area = written_field(schema, Quantity::ds_area);
    double const greatest_m2 = std::ranges::max(tables.ds_area_m2);
    RiverWidths widths;
    if (area != nullptr && greatest_m2 > 0.0) {
        widths = {std::string(area->name), greatest_m2 / area->unit};
    }
    return river_style(order == nullptr ? "" : std::string(order->name),
                       static_cast<int>(std::ranges::max(tables.orders.strahler)), widths);
}

Table arcs_table(NetworkTables const& tables, SchemaTable const& schema, bool short_names) {
    auto const arcs = std::make_shared<Arcs const>(tables, schema);
    Table table{std::string(schema.layer),
                tables.heights ? Table::Shape::line : Table::Shape::plan_line,
                tables.network.planform.arc_count(),
                {},
                {}};
    table.shape_at = [arcs](std::size_t row) { return arcs->line(row); };
    for (SchemaField const& field : schema.fields) {
        if (field.written) {
            table.columns.push_back({short_names ? short_name(field) : std::string(field.name), field.kind,
                                     field.decimals,
                                     [arcs, &field](std::size_t row) { return field_value(field, *arcs, row); }});
            table.columns.back().may_be_null = !tables.heights;
        }
    }
    if (tables.user != nullptr) {
        add_user_columns(
            table, tables.user->attributes, [&user = *tables.user](std::size_t row) { return user.record[row]; },
            short_names, schema.schema);
    }
    if (schema.schema == Schema::native) {
        add_unit(table, tables.unit);
    }
    table.style = style_of_arcs(tables, schema);
    return table;
}

/// Throws BadInput when the tables are not those of the network: else another arc's numbers would be written.
void require_whole(NetworkTables const& tables, About const& about) {
    std::string const beginning = about.beginning();
    StreamNetwork const& plan = tables.network.planform;
    auto const& node_z = tables.network.node_z;
    auto const& arc_z = tables.network.arc_z;
    NetworkOrders const& orders = tables.orders;
    std::size_t const arcs = plan.arc_count();
    std::size_t const nodes = plan.node_count();
    auto const each = [](std::size_t count, auto const&... values) { return ((values.size() == count) && ...); };
    refuse_if<BadInput>(arcs == 0, about.where, "{}the network has no arcs", beginning);
    refuse_if<BadInput>(
        !each(arcs, arc_z, orders.strahler, orders.shreve, orders.hack, orders.topological, orders.arc_basin,
              tables.us_area_m2, tables.ds_area_m2) ||
            !each(nodes, node_z, orders.node_basin, orders.node_strahler, orders.node_dist_out_m,
                  tables.node_area_m2) ||
            (tables.braided != nullptr && tables.braided->size() != arcs) ||
            (tables.user != nullptr && tables.user->record.size() != arcs),
        about.where,
        "{}heights, orders, areas, braids and records do not have one value for each of {} arcs and {} nodes",
        beginning, arcs, nodes);
    for (ArcId a = 0; a < arcs; ++a) {
        auto const& line = plan.arc(a).line;
        NodeId const from = plan.from(a);
        NodeId const to = plan.to(a);
        bool const meets = line.size() >= 2 && arc_z[a].size() == line.size() && line.front() == plan.node(from).at &&
                           line.back() == plan.node(to).at && arc_z[a].front() == node_z[from] &&
                           arc_z[a].back() == node_z[to];
        refuse_if<BadInput>(!meets, about.where, "{}arc {} does not begin at node {} and end at node {}", beginning,
                            a + 1, from + 1, to + 1);
    }
    for (NodeId n = 0; n < nodes; ++n) {
        refuse_if<BadInput>(plan.basin(n) == 0, about.where, "{}node {} at ({}, {}) reaches no outlet", beginning,
                            n + 1, plan.node(n).at.x, plan.node(n).at.y);
    }
}

Table ridges_table(RidgeLines const& ridges, HeightUnit unit, About const& about) {
    std::string const beginning = about.beginning();
    for (std::size_t i = 0; i < ridges.lines.size(); ++i) {
        RidgeLine const& ridge = ridges.lines[i];
        refuse_if<BadInput>(ridge.line.size() < 2, about.where,
                            "{}ridge {} between streams {} and {} has fewer than two vertices", beginning, i + 1,
                            ridge.left, ridge.right);
    }
    auto const ridge = [&ridges](std::size_t row) -> RidgeLine const& { return ridges.lines[row]; };
    auto const line = [ridge, unit_m = metres_in(unit)](std::size_t row) {
        std::vector<Vec3> drawn = ridge(row).line;
        for (Vec3& p : drawn) {
            p.z /= unit_m;
        }
        return drawn;
    };
    Table table{"ridges", Table::Shape::line, ridges.lines.size(), {}, line};
    table.columns = {
        integer("ridge_id", [](auto row) { return row + 1; }),
        integer("left", [ridge](auto row) { return ridge(row).left; }),
        integer("right", [ridge](auto row) { return ridge(row).right; }),
        real("length", length_decimals, [ridge](auto row) { return length_in_plan(ridge(row).line); }),
        real("z_min", length_decimals, [line](auto row) { return std::ranges::min(line(row), {}, &Vec3::z).z; }),
        real("z_max", length_decimals, [line](auto row) { return std::ranges::max(line(row), {}, &Vec3::z).z; }),
    };
    add_unit(table, unit);
    table.style = ridge_style();
    return table;
}

/// Lines that are not in the network, in plan.
Table secondary_table(std::vector<SecondaryLine> const& secondary, UserData const* user) {
    auto const one = [&secondary](std::size_t row) -> SecondaryLine const& { return secondary[row]; };
    Table table{"secondary", Table::Shape::plan_line, secondary.size(), {}, {}};
    table.shape_at = [one](std::size_t row) { return one(row).vertices; };
    table.columns = {
        {"feature", Kind::wide_integer, 0, [one](std::size_t row) { return one(row).feature; }},
        text("reason", [one](auto row) { return one(row).reason; }),
        real("length", length_decimals, [one](auto row) { return length_in_plan(one(row).vertices); }),
    };
    if (user != nullptr) {
        add_user_columns(
            table, user->attributes, [one](std::size_t row) { return one(row).record; }, false);
    }
    table.style = secondary_style();
    return table;
}

/// The features that arcs are made of.
Table sources_table(UserData const& user) {
    auto const rows = std::make_shared<std::vector<std::pair<std::size_t, Stretch>>>();
    for (std::size_t a = 0; a < user.sources.size(); ++a) {
        for (Stretch const& stretch : user.sources[a]) {
            rows->emplace_back(a + 1, stretch);
        }
    }
    Table table{"sources", Table::Shape::none, rows->size(), {}, {}};
    table.columns = {
        integer("arc_id", [rows](auto row) { return (*rows)[row].first; }),
        {"feature", Kind::wide_integer, 0, [rows](std::size_t row) { return (*rows)[row].second.feature; }},
        real("from_m", length_decimals, [rows](auto row) { return (*rows)[row].second.from_m; }),
        real("to_m", length_decimals, [rows](auto row) { return (*rows)[row].second.to_m; }),
    };
    return table;
}

Table run_table(std::map<std::string, std::string> const& rows) {
    auto const row_at = [&rows](std::size_t row) { return *std::next(rows.begin(), static_cast<std::ptrdiff_t>(row)); };
    return {"run",
            Table::Shape::none,
            rows.size(),
            {text("name", [row_at](auto row) { return row_at(row).first; }),
             text("value", [row_at](auto row) { return row_at(row).second; })},
            {}};
}

} // namespace

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
        column.is_users = true;
        column.kind = static_cast<Kind>(attributes.columns[c].type); // both enumerations have one order
        if (short_names && (column.kind == Kind::time || column.kind == Kind::datetime)) {
            column.kind = Kind::text; // dBase has dates alone
        }
        column.decimals = short_names && column.kind == Kind::real ? user_decimals(attributes, c) : 0;
        column.at = [&attributes, record, c, short_names](std::size_t row) -> Value {
            std::int64_t const r = record(row);
            if (r <= 0 || r > static_cast<std::int64_t>(attributes.rows.size())) {
                return {};
            }
            Value value = attributes.rows[r - 1][c];
            if (auto* const text = std::get_if<std::string>(&value); text != nullptr && short_names) {
                *text = cut_to(*text, dbf_text);
            }
            return value;
        };
        table.columns.push_back(std::move(column));
    }
}

// Arcs in any schema.

std::vector<Table> network_layers(NetworkTables const& tables, Schema schema, bool short_names, About const& about) {
    require_whole(tables, about);
    std::string const beginning = about.beginning();
    StreamNetwork const& plan = tables.network.planform;
    SchemaTable const& words = table_of(schema);
    auto const most = static_cast<std::size_t>(words.most_upstream);
    for (NodeId n = 0; n < plan.node_count(); ++n) {
        refuse_if<BadInput>(most > 0 && plan.out(n) != no_arc && plan.in(n).size() > most, about.where,
                            "{}{} rivers meet at ({}, {}), but {} names no more than {} upstream of one: split "
                            "confluences (--max-upstream {})",
                            beginning, plan.in(n).size(), plan.node(n).at.x, plan.node(n).at.y, words.name, most, most);
    }
    std::vector<Table> layers{arcs_table(tables, words, short_names)};
    if (schema == Schema::native) {
        layers.push_back(nodes_table(tables));
    }
    return layers;
}

// The other tables of the native schema.

Table nodes_table(NetworkTables const& tables) {
    auto const& plan = tables.network.planform;
    NetworkOrders const& orders = tables.orders;
    auto const z = [&z_m = tables.network.node_z, unit_m = metres_in(tables.unit)](NodeId n) {
        return z_m[n] / unit_m;
    };
    bool const heights = tables.heights;
    Table table{"nodes", heights ? Table::Shape::point : Table::Shape::plan_point, plan.node_count(), {}, {}};
    table.shape_at = [z, &plan](std::size_t row) {
        Vec2 const p = plan.node(row).at;
        return std::vector<Vec3>{{p.x, p.y, z(row)}};
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
        {"z", Kind::real, length_decimals, [z, heights](std::size_t row) { return heights ? Value(z(row)) : Value(); },
         false, !heights},
        real("area", area_decimals, [&area = tables.node_area_m2](auto row) { return area[row]; }),
        real("dist_out", length_decimals, [&orders](auto row) { return orders.node_dist_out_m[row]; }),
    };
    add_unit(table, tables.unit);
    table.style = node_style();
    return table;
}

std::vector<Table> geopackage_tables(NetworkTables const& tables, About const& about) {
    std::vector<Table> layers = network_layers(tables, Schema::native, false, about);
    if (tables.ridges != nullptr && !tables.ridges->lines.empty()) {
        layers.push_back(ridges_table(*tables.ridges, tables.unit, about));
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
    return layers;
}

} // namespace thalweg::io
