// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The features of a network's layers.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

namespace {

constexpr std::size_t kept_of_a_kind = 1000;

using Q = Quantity;
using FileArc = NetworkFile::FileArc;
using NodeColumns = NetworkFile::NodeColumns;

// The whole numbers of a feature; those that cannot be read are noted and stand as 0.
struct FeatureNumbers {
    OGRFeature const& feature;
    std::int64_t number; // in the order of the layer, from 1
    About const& about;
    Notes& notes;

    // of: the id of the arc or node in the file.
    std::int64_t whole(FileColumn const& column, std::int64_t of, bool may_be_null) const {
        if (column.is_null(feature)) {
            if (column.is_there() && !may_be_null) {
                notes.add(about, "null_number", of, 0.0, fmt::format("feature {} has no {}", number, column.name()));
            }
            return 0;
        }
        auto const value = column.whole(feature);
        if (!value) {
            notes.add(
                about, "not_a_number", of, 0.0,
                fmt::format("feature {} has {} {}, not a whole number", number, column.name(), column.text(feature)));
        }
        return value.value_or(0);
    }
};

// The columns of a node that follow from the rest.
constexpr std::array<std::pair<char const*, double NodeColumns::*>, 7> node_columns{
    {{"deg_in", &NodeColumns::deg_in},
     {"deg_out", &NodeColumns::deg_out},
     {"basin_id", &NodeColumns::basin_id},
     {"strahler", &NodeColumns::strahler},
     {"z", &NodeColumns::z_m},
     {"dist_out", &NodeColumns::dist_out_m},
     {"area", &NodeColumns::area_m2}}};

class ArcReader {
public:
    ArcReader(Layer const& arcs, std::optional<Schema> schema, Wish const& wish, Notes& notes)
        : arcs_(arcs), schema_(schema), table_(table_of(schema.value_or(Schema::native))), notes_(notes),
          fields_(*arcs.layer), flow_(*arcs.layer), natural_(*arcs.layer), attributes_(*arcs.layer),
          by_feature_(!schema && takes_any_lines(wish)), whole_(wish.whole) {
        find_columns(wish.columns);
        if (!by_feature_) {
            require_fields();
        }
    }

    void read(NetworkFile& file, Driver const& driver, Run const& run) {
        file.schema = schema_ ? table_.name : by_feature_ ? "lines" : "mapped";
        file.id_shift = 1 - table_.first_id;
        file.says.nodes = false;
        file.says.ends = has(Q::from_node) && has(Q::to_node);
        file.says.downstream = has(Q::ds_arc) || (has(Q::key) && has(Q::ds_key));
        file.says.strahler = has(Q::strahler);
        file.says.shreve = has(Q::shreve);
        file.says.basin = has(Q::basin_id) || has(Q::outlet_path) || has(Q::outlet_arc);
        file.says.areas = has(Q::ds_area);
        arcs_.each(driver, run, [&](OGRFeature const& feature) { add(file, feature); });
        if (!has(Q::ds_arc) && file.says.downstream) {
            link_by_keys(file, keys_, ds_keys_);
        }
        if (by_feature_) {
            file.says.areas = knows_areas_;
            link_by_features(file);
        }
        for (FileArc& arc : file.arcs) {
            arc.runs = schema_ == Schema::native ? 0 : flow_.runs_of(arc.record);
        }
        file.attributes = attributes_.take();
        if (!whole_) {
            for (Finding const& finding : attributes_.findings()) {
                notes_.add(arcs_.about, finding);
            }
        }
        note_shapes(file);
    }

private:
    // Columns. Without a schema the arcs are understood by the user's alone, in the units of the native schema.

    struct Told {
        FileColumn column;
        SchemaField const* field = nullptr;
    };

    void find_columns(std::map<Quantity, std::string> const& mapped) {
        for (SchemaField const& field : table_.fields) {
            if (field.quantity != Q::constant && schema_ && !has(field.quantity)) {
                columns_[field.quantity] = {FileColumn(*arcs_.layer, names_of(field)), &field};
            }
        }
        for (auto const& [quantity, name] : mapped) {
            FileColumn column(*arcs_.layer, {name});
            auto const names = field_names(*arcs_.layer);
            refuse_if<BadInput>(!column.is_there(), arcs_.about.where, "{}: no field {}.{} (there are {})",
                                arcs_.about.name, name, did_you_mean(name, names), listed(names));
            columns_[quantity] = {std::move(column), field_of(table_, quantity)};
        }
        for (Told const& told : columns_.entries) {
            if (&told != &columns_[Q::type] && told.column.is_there()) {
                told.column.require_numbers(arcs_.about, notes_);
            }
        }
    }

    void require_fields() {
        std::vector<std::string> missing;
        for (Quantity const q : {Q::arc_id, Q::from_node, Q::to_node, Q::ds_arc, Q::strahler, Q::shreve, Q::basin_id}) {
            if (!has(q) && (q == Q::arc_id || schema_ == Schema::native)) {
                SchemaField const* const field = field_of(table_, q);
                missing.emplace_back(field == nullptr ? name_of(q) : field->name);
            }
        }
        refuse_if<BadInput>(!has(Q::arc_id), arcs_.about.where,
                            "{}: no field {} (there are {}); name the field that holds arc_id", arcs_.about.name,
                            listed(missing), listed(field_names(*arcs_.layer)));
        if (!missing.empty()) {
            notes_.add(arcs_.about, "missing_field", 0, static_cast<double>(missing.size()),
                       fmt::format("no field {}", listed(missing)));
        }
    }

    bool has(Quantity quantity) const { return columns_[quantity].column.is_there(); }
    FileColumn const& column(Quantity quantity) const { return columns_[quantity].column; }

    // In SI units; NaN where there is no such column, or no value that is known.
    double real(OGRFeature const& feature, Quantity quantity) const {
        Told const& told = columns_[quantity];
        double const value = told.column.real(feature);
        if (told.field == nullptr) {
            return value;
        }
        return value == told.field->unknown ? nan : value * told.field->unit;
    }

    // [m2] Below 0, such as -1 and -9999, it is unknown.
    double area(OGRFeature const& feature, Quantity quantity) const {
        double const value = real(feature, quantity);
        return value < 0.0 ? nan : value;
    }

    // What stands for no arc in a column of links.
    std::int64_t none(Quantity quantity) const {
        SchemaField const* const field = columns_[quantity].field;
        return field == nullptr ? 0 : whole_in(field->unknown).value_or(0);
    }

    // Features.

    void add(NetworkFile& file, OGRFeature const& feature) {
        ++number_;
        attributes_.read(feature);
        DrawnLine drawn = drawn_line(feature.GetGeometryRef(), number_, others_);
        if (!drawn.is_line) {
            return;
        }
        FileArc arc = numbers_of(feature);
        note_shape(feature.GetGeometryRef(), drawn, arc.id - file.id_shift);
        for (auto& part : drawn.parts) {
            arc.line = std::move(part);
            file.arcs.push_back(arc);
            keys_.push_back(arc.rank);
            ds_keys_.push_back(ds_key_);
        }
    }

    FileArc numbers_of(OGRFeature const& feature) {
        flow_.read(feature, number_);
        FeatureNumbers const numbers{feature, number_, arcs_.about, notes_};
        bool const native = schema_ == Schema::native;
        std::int64_t const id = by_feature_ ? number_ : numbers.whole(column(Q::arc_id), 0, false);
        auto const number = [&](Quantity q) { return numbers.whole(column(q), id, false); };
        auto const optional = [&](Quantity q) { return numbers.whole(column(q), id, true); };
        FileArc arc;
        arc.id = !by_feature_ && column(Q::arc_id).is_null(feature) ? 0 : id + 1 - table_.first_id;
        arc.from_node = number(Q::from_node);
        arc.to_node = number(Q::to_node);
        std::int64_t const below = numbers.whole(column(Q::ds_arc), id, !native);
        bool const is_outlet = column(Q::ds_arc).is_null(feature) || below == none(Q::ds_arc);
        arc.ds_arc = is_outlet ? 0 : below + 1 - table_.first_id;
        arc.rank = number(Q::key);
        ds_key_ = optional(Q::ds_key);
        arc.strahler = number(Q::strahler);
        arc.shreve = number(Q::shreve);
        arc.basin = has(Q::basin_id)      ? number(Q::basin_id)
                    : has(Q::outlet_path) ? number(Q::outlet_path)
                                          : optional(Q::outlet_arc);
        arc.ds_area_m2 = area(feature, Q::ds_area);
        arc.own_area_m2 = area(feature, Q::own_area);
        arc.us_area_m2 = has(Q::us_area) ? area(feature, Q::us_area) : arc.ds_area_m2 - arc.own_area_m2;
        arc.path = has(Q::path) ? optional(Q::path) : 0;
        if (double const level = real(feature, Q::hack); level > 0.0) {
            arc.level = level;
        }
        double const persistence = real(feature, Q::persistence);
        arc.persistence = std::isnan(persistence) ? std::numeric_limits<double>::infinity() : persistence;
        arc.feature = native ? optional(Q::feature) : number_;
        arc.record = number_;
        take_fields(arc, feature, native);
        arc.type = column(Q::type).text(feature);
        if (arc.type == "none") { // which stands for an empty text
            arc.type.clear();
        }
        arc.braided = optional(Q::braided) != 0;
        arc.is_input = !has(Q::given) || optional(Q::given) != 0;
        return arc;
    }

    NetworkFile::ArcColumns columns_of(OGRFeature const& feature) const {
        auto const told = [&](Quantity q) { return real(feature, q); };
        return {.n_up = told(Q::n_up),
                .topo_ord = told(Q::topo_ord),
                .hack = told(Q::hack),
                .length_m = told(Q::length),
                .length_3d_m = told(Q::length_3d),
                .straight_m = told(Q::straight),
                .z_up_m = told(Q::z_up),
                .z_down_m = told(Q::z_down),
                .dist_out_m = told(Q::dist_out),
                .slope = told(Q::slope)};
    }

    void take_fields(FileArc& arc, OGRFeature const& feature, bool native) {
        RiverLine line;
        fields_.read(feature, line);
        arc.name = std::move(line.name);
        if (native) {
            arc.columns = columns_of(feature);
            return;
        }
        if (by_feature_ && line.area_m2 > 0.0) {
            arc.ds_area_m2 = line.area_m2;
            knows_areas_ = true;
        }
        arc.size = std::move(line.size);
        arc.channel = line.channel;
        Unnatural unnatural = natural_.of(feature);
        arc.unnatural = std::move(unnatural.reason);
        arc.is_channel = unnatural.is_channel;
    }

    void link_by_features(NetworkFile& file) {
        file.says.downstream = flow_.has_links();
        auto const downs = flow_.downs();
        for (FileArc& arc : file.arcs) {
            arc.ds_arc = downs.contains(arc.id) ? downs.at(arc.id) : 0;
        }
        notes_.add(arcs_.about, "by_feature", 0, static_cast<double>(file.arcs.size()),
                   fmt::format("its fields match no schema: lines are numbered by their features and joined by {}",
                               file.says.downstream ? "their links" : "their ends"));
    }

    // Shapes.

    void note_shape(OGRGeometry const* shape, DrawnLine const& drawn, std::int64_t id) {
        auto const& first = drawn.parts.front();
        bool const joined = drawn.parts.size() == 1;
        if (drawn.drawn_parts > 1 && !(joined && table_.segment_parts)) {
            notes_.add(arcs_.about, "multi_part", id, drawn.drawn_parts,
                       fmt::format("feature {} has {} parts{}", number_, drawn.drawn_parts,
                                   joined ? ", which join end to end: read as one line"
                                          : ": an arc is one line; each was read as an arc of the same id"));
        }
        if (shape != nullptr && shape->hasCurveGeometry(TRUE) != 0) {
            notes_.add(arcs_.about, "curve", id, static_cast<double>(first.size()),
                       fmt::format("feature {} is a curve: read as a line of {} vertices", number_, first.size()));
        }
        measured_ += shape != nullptr && shape->IsMeasured() != 0 ? 1 : 0;
        if (!first.empty()) {
            bool const is_flat = shape->Is3D() == 0;
            (is_flat ? flat_ : raised_) += 1;
            first_flat_ = first_flat_ == 0 && is_flat ? number_ : first_flat_;
        }
    }

    void note_shapes(NetworkFile& file) {
        auto const note = [&](FindingKind kind, std::int64_t amount, std::string text) {
            notes_.add(arcs_.about, kind, 0, static_cast<double>(amount), std::move(text));
        };
        for (Finding const& other : others_.findings()) { // whose places are in coordinates of the file
            notes_.add(arcs_.about, other.kind, 0, other.amount, other.text);
        }
        if (measured_ > 0) {
            note("measures", measured_, fmt::format("{} lines have measures (M), which were left out", measured_));
        }
        file.says.heights = raised_ > 0;
        if (flat_ > 0) {
            note("no_heights", flat_,
                 fmt::format("feature {} has no heights (Z): there are {} such lines", first_flat_, flat_));
        }
        // Many formats fill a Z that is not known with 0.
        bool const filled =
            schema_ != Schema::native && raised_ > 0 && std::ranges::all_of(file.arcs, [](FileArc const& arc) {
                return std::ranges::all_of(arc.line, [](Vec3 const& p) { return !(p.z != 0.0); });
            });
        if (filled) {
            file.says.heights = false;
            for (FileArc& arc : file.arcs) {
                for (Vec3& p : arc.line) {
                    p.z = nan;
                }
            }
            note("no_heights", raised_, "every height (Z) is 0: treated as missing");
        }
    }

    Layer const& arcs_;
    std::optional<Schema> schema_;
    SchemaTable const& table_;
    Notes& notes_;
    ByEnum<Quantity, Told, static_cast<std::size_t>(Quantity::constant)> columns_;
    RiverFields fields_;
    FlowFields flow_;
    NaturalFilter natural_;
    AttributeReader attributes_;
    bool by_feature_ = false;        // arcs have the numbers of their features
    bool whole_ = false;             // findings are refused
    bool knows_areas_ = false;       // of lines in no schema, by a column of their data set
    std::int64_t number_ = 0;        // of the feature in hand, in the order of the layer, from 1
    std::int64_t ds_key_ = 0;        // likewise
    std::vector<std::int64_t> keys_; // by arc
    std::vector<std::int64_t> ds_keys_;
    // What there was in all the lines of the file.
    std::int64_t flat_ = 0;
    std::int64_t first_flat_ = 0;
    std::int64_t raised_ = 0;
    std::int64_t measured_ = 0;
    OtherShapes others_;
};

} // namespace

void Notes::add(About const& about, Finding finding) {
    refuse_if<BadInput>(strict_, about.where, "{}: {}", about.name, finding.text);
    if (++count_[finding.kind] <= kept_of_a_kind) {
        findings_.push_back(std::move(finding));
    }
}

std::vector<Finding> Notes::take() {
    for (auto const& [kind, count] : count_) {
        if (count > kept_of_a_kind) {
            std::size_t const more = count - kept_of_a_kind;
            findings_.push_back(
                {kind, 0, nowhere, static_cast<double>(more), fmt::format("{}: {} more", kind.name(), more)});
        }
    }
    count_.clear();
    return std::exchange(findings_, {});
}

void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run) {
    FileColumn const arc_id(*sources.layer, {"arc_id"});
    FileColumn const feature_id(*sources.layer, {"feature"});
    FileColumn const from(*sources.layer, {"from_m"});
    FileColumn const to(*sources.layer, {"to_m"});
    std::map<std::int64_t, std::size_t> arc_of;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        arc_of.try_emplace(file.arcs[a].id, a);
    }
    sources.each(driver, run, [&](OGRFeature const& row) {
        auto const arc = arc_of.find(arc_id.whole(row).value_or(0));
        Stretch const stretch{feature_id.whole(row).value_or(0), from.real(row), to.real(row)};
        if (arc != arc_of.end() && stretch.from_m >= 0.0 && stretch.to_m > stretch.from_m) {
            file.arcs[arc->second].sources.push_back(stretch);
        }
    });
}

void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run) {
    FileColumn const id(*nodes.layer, {node_id});
    refuse_if<BadInput>(!id.is_there(), nodes.about.where, "{}: no field {} (there are {})", nodes.about.name, node_id,
                        listed(field_names(*nodes.layer)));
    id.require_numbers(nodes.about, notes);
    FileColumn const kind(*nodes.layer, {"kind"});
    std::vector<std::pair<FileColumn, double NodeColumns::*>> columns;
    for (auto const& [name, member] : node_columns) {
        columns.emplace_back(FileColumn(*nodes.layer, {name}), member);
    }
    std::int64_t number = 0;
    nodes.each(driver, run, [&](OGRFeature const& feature) {
        ++number;
        auto const* const shape = feature.GetGeometryRef();
        refuse_if<BadInput>(shape == nullptr || wkbFlatten(shape->getGeometryType()) != wkbPoint || shape->IsEmpty(),
                            nodes.about.where, "{}: feature {} is not a point", nodes.about.name, number);
        OGRPoint const& p = *shape->toPoint();
        bool const is_flat = p.Is3D() == FALSE;
        if (is_flat && file.says.heights) {
            notes.add(nodes.about, "no_heights", 0, 1.0, fmt::format("feature {} has no heights (Z)", number));
        }
        NetworkFile::FileNode& node = file.nodes.emplace_back();
        node.id = FeatureNumbers{feature, number, nodes.about, notes}.whole(id, 0, false);
        node.at = {p.getX(), p.getY(), is_flat ? nan : p.getZ()};
        node.columns.kind = kind.text(feature);
        for (auto const& [column, member] : columns) {
            node.columns.*member = column.real(feature);
        }
    });
    file.says.nodes = true;
}

void read_arcs(NetworkFile& file, Layer const& arcs, std::optional<Schema> schema, Wish const& wish,
               Driver const& driver, Notes& notes, Run const& run) {
    ArcReader(arcs, schema, wish, notes).read(file, driver, run);
}

} // namespace thalweg::io
