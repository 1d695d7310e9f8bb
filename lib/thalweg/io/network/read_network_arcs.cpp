// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/line_features.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/network/internal/river_fields.hpp>

namespace thalweg::io {
namespace {

// The numbers of a feature; what cannot be read as one stands as 0.
class FeatureNumbers {
public:
    FeatureNumbers(OGRFeature const& feature, std::int64_t number, std::string const& what, Notes& notes)
        : feature_(feature), number_(number), what_(what), notes_(notes) {}

    // of: the id of the arc or node in the file. nothing: null is no fault, and stands as 0.
    std::int64_t whole(FileColumn const& column, std::int64_t of, bool nothing) const {
        if (!column.is_there()) {
            return 0;
        }
        if (column.is_null(feature_)) {
            if (!nothing) {
                note("null_number", of, fmt::format("feature {} has no {}", number_, column.name()));
            }
            return 0;
        }
        if (auto const value = column.whole(feature_)) {
            return *value;
        }
        note("not_a_number", of,
             fmt::format("feature {} has {} {}, not a whole number", number_, column.name(), column.text(feature_)));
        return 0;
    }

private:
    void note(char const* kind, std::int64_t of, std::string text) const {
        notes_.add(what_, {kind, of, {}, 0.0, std::move(text)});
    }

    OGRFeature const& feature_;
    std::int64_t number_; // in the order of the layer, from 1
    std::string const& what_;
    Notes& notes_;
};

/// The columns of a node that follow from the rest.
class NodeReader {
public:
    explicit NodeReader(OGRLayer& layer)
        : kind_(layer, "kind"), deg_in_(layer, "deg_in"), deg_out_(layer, "deg_out"), basin_(layer, "basin_id"),
          strahler_(layer, "strahler"), z_(layer, "z"), dist_out_(layer, "dist_out"), area_(layer, "area") {}

    NetworkFile::NodeColumns read(OGRFeature const& feature) const {
        return {.kind = kind_.is_there() ? kind_.text(feature) : "",
                .deg_in = told(deg_in_, feature),
                .deg_out = told(deg_out_, feature),
                .basin_id = told(basin_, feature),
                .strahler = told(strahler_, feature),
                .z_m = told(z_, feature),
                .dist_out_m = told(dist_out_, feature),
                .area_m2 = told(area_, feature)};
    }

private:
    static double told(FileColumn const& column, OGRFeature const& feature) {
        return column.is_there() ? column.real(feature) : nan;
    }
    FileColumn kind_;
    FileColumn deg_in_;
    FileColumn deg_out_;
    FileColumn basin_;
    FileColumn strahler_;
    FileColumn z_;
    FileColumn dist_out_;
    FileColumn area_;
};

} // namespace

void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run) {
    OGRFeatureDefn& schema = *sources.layer->GetLayerDefn();
    int const arc_id = schema.GetFieldIndex("arc_id");
    int const feature_id = schema.GetFieldIndex("feature");
    int const from = schema.GetFieldIndex("from_m");
    int const to = schema.GetFieldIndex("to_m");
    if (arc_id < 0 || feature_id < 0 || from < 0 || to < 0) {
        return;
    }
    std::map<std::int64_t, std::size_t> arc_of;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        arc_of.try_emplace(file.arcs[a].id, a);
    }
    sources.each(driver, run, [&](OGRFeature const& row) {
        auto const arc = arc_of.find(row.GetFieldAsInteger64(arc_id));
        Stretch const stretch{row.GetFieldAsInteger64(feature_id), row.GetFieldAsDouble(from),
                              row.GetFieldAsDouble(to)};
        if (arc != arc_of.end() && stretch.from_m >= 0.0 && stretch.to_m > stretch.from_m) {
            file.arcs[arc->second].sources.push_back(stretch);
        }
    });
}

void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run) {
    FileColumn const id(*nodes.layer, node_id);
    if (!id.is_there()) {
        throw BadInput(fmt::format("{}: no field {} (there are {})", nodes.what, node_id, fields_of(*nodes.layer)));
    }
    id.require_numbers(*nodes.layer, nodes.what, notes);
    NodeReader const columns(*nodes.layer);
    std::int64_t number = 0;
    nodes.each(driver, run, [&](OGRFeature const& feature) {
        ++number;
        auto const* const shape = feature.GetGeometryRef();
        refuse_if<BadInput>(shape == nullptr || wkbFlatten(shape->getGeometryType()) != wkbPoint || shape->IsEmpty(),
                            "{}: feature {} is not a point", nodes.what, number);
        OGRPoint const& p = *shape->toPoint();
        if (p.Is3D() == FALSE && file.says.heights) {
            notes.add(nodes.what, {"no_heights", 0, {}, 1.0, fmt::format("feature {} has no heights (Z)", number)});
        }
        file.nodes.push_back({FeatureNumbers(feature, number, nodes.what, notes).whole(id, 0, false),
                              {p.getX(), p.getY(), p.Is3D() == FALSE ? nan : p.getZ()},
                              columns.read(feature)});
    });
    file.says.nodes = true;
}

namespace {

using Q = Quantity;
using FileArc = NetworkFile::FileArc;

void require_fields(Layer const& arcs, ArcColumns const& columns, std::optional<Schema> schema, Notes& notes) {
    std::vector<std::string> missing;
    for (Quantity const q : {Q::arc_id, Q::from_node, Q::to_node, Q::ds_arc, Q::strahler, Q::shreve, Q::basin_id}) {
        if (!columns.has(q) && (q == Q::arc_id || schema == Schema::native)) {
            SchemaField const* const field = field_of(table_of(schema.value_or(Schema::native)), q);
            missing.emplace_back(field == nullptr ? name_of(q) : field->name);
        }
    }
    if (!columns.has(Q::arc_id)) {
        throw BadInput(fmt::format("{}: no field {} (there are {}); name the field that holds arc_id", arcs.what,
                                   fmt::join(missing, ", "), fields_of(*arcs.layer)));
    }
    if (!missing.empty()) {
        notes.add(arcs.what, {"missing_field",
                              0,
                              {},
                              static_cast<double>(missing.size()),
                              fmt::format("no field {}", fmt::join(missing, ", "))});
    }
}

// What there was in all the lines of a file.
struct Drawn {
    std::int64_t flat = 0;
    std::int64_t raised = 0;
    std::int64_t measured = 0;
    std::string first_flat;
    OtherShapes others;
};

class ArcReader {
public:
    ArcReader(Layer const& arcs, std::optional<Schema> schema, Wish const& wish, Notes& notes)
        : arcs_(arcs), schema_(schema), table_(table_of(schema.value_or(Schema::native))), notes_(notes),
          columns_(*arcs.layer, schema, wish.fields, arcs.what, notes), fields_(*arcs.layer), attributes_(*arcs.layer),
          by_feature_(!schema && takes_any_lines(wish)), whole_(wish.whole) {
        if (!by_feature_) {
            require_fields(arcs, columns_, schema, notes);
        }
    }

    void read(NetworkFile& file, Driver const& driver, Run const& run) {
        file.schema = schema_ ? table_.name : by_feature_ ? "lines" : "mapped";
        file.id_shift = 1 - table_.first_id;
        file.says.nodes = false;
        file.says.ends = columns_.has(Q::from_node) && columns_.has(Q::to_node);
        file.says.downstream = columns_.has(Q::ds_arc) || (columns_.has(Q::key) && columns_.has(Q::ds_key));
        file.says.strahler = columns_.has(Q::strahler);
        file.says.shreve = columns_.has(Q::shreve);
        file.says.basin = columns_.has(Q::basin_id) || columns_.has(Q::outlet_path) || columns_.has(Q::outlet_arc);
        file.says.areas = columns_.has(Q::ds_area);
        if (GIntBig const count = arcs_.layer->GetFeatureCount(FALSE); count > 0) {
            file.arcs.reserve(static_cast<std::size_t>(count));
        }
        arcs_.each(driver, run, [&](OGRFeature const& feature) { add(file, feature); });
        if (!columns_.has(Q::ds_arc) && file.says.downstream) {
            link_by_keys(file, keys_, ds_keys_);
        }
        if (by_feature_) {
            link_by_features(file);
        }
        file.attributes = attributes_.take();
        if (!whole_) {
            for (Finding const& finding : attributes_.findings()) {
                notes_.add(arcs_.what, finding);
            }
        }
        say_what_was_drawn(file);
    }

private:
    void link_by_features(NetworkFile& file) {
        file.says.downstream = fields_.has_links();
        for (FileArc& arc : file.arcs) {
            arc.ds_arc = fields_.down_of(arc.id);
        }
        notes_.add(arcs_.what,
                   {"by_feature",
                    0,
                    {},
                    static_cast<double>(file.arcs.size()),
                    fmt::format("its fields match no schema: lines are numbered by their features and joined by {}",
                                file.says.downstream ? "their links" : "their ends")});
    }

    void add(NetworkFile& file, OGRFeature const& feature) {
        ++number_;
        attributes_.read(feature);
        DrawnLine drawn = drawn_line(feature.GetGeometryRef(), number_, drawn_.others);
        if (!drawn.is_line) {
            return;
        }
        FileArc arc = numbers_of(feature);
        note_shape(drawn, arc.id - file.id_shift);
        for (auto& part : drawn.parts) {
            arc.line = std::move(part);
            file.arcs.push_back(arc);
            if (columns_.has(Q::key)) {
                keys_.push_back(key_);
                ds_keys_.push_back(ds_key_);
            }
        }
    }

    FileArc numbers_of(OGRFeature const& feature) {
        FeatureNumbers const numbers(feature, number_, arcs_.what, notes_);
        bool const native = schema_ == Schema::native;
        std::int64_t const id = by_feature_ ? number_ : numbers.whole(columns_.column(Q::arc_id), 0, false);
        auto const number = [&](Quantity q) { return numbers.whole(columns_.column(q), id, false); };
        auto const link = [&](Quantity q) {
            FileColumn const& column = columns_.column(q);
            std::int64_t const value = numbers.whole(column, id, !native);
            bool const none = !column.is_there() || column.is_null(feature) || value == columns_.none(q).value_or(0);
            return none ? 0 : value + 1 - table_.first_id;
        };
        FileArc arc;
        bool const unnamed = !by_feature_ && columns_.column(Q::arc_id).is_null(feature);
        arc.id = unnamed ? 0 : id + 1 - table_.first_id;
        arc.from_node = number(Q::from_node);
        arc.to_node = number(Q::to_node);
        arc.ds_arc = link(Q::ds_arc);
        key_ = number(Q::key);
        ds_key_ = numbers.whole(columns_.column(Q::ds_key), id, true);
        arc.strahler = number(Q::strahler);
        arc.shreve = number(Q::shreve);
        arc.basin = columns_.has(Q::basin_id)      ? number(Q::basin_id)
                    : columns_.has(Q::outlet_path) ? number(Q::outlet_path)
                                                   : numbers.whole(columns_.column(Q::outlet_arc), id, true);
        arc.ds_area_m2 = columns_.real(feature, Q::ds_area);
        arc.us_area_m2 = columns_.has(Q::us_area) ? columns_.real(feature, Q::us_area)
                                                  : arc.ds_area_m2 - columns_.real(feature, Q::own_area);
        double const persistence = columns_.real(feature, Q::persistence);
        arc.persistence = std::isnan(persistence) ? std::numeric_limits<double>::infinity() : persistence;
        arc.feature = native ? numbers.whole(columns_.column(Q::feature), id, true) : number_;
        arc.record = number_;
        if (native) {
            arc.columns = columns_of(feature);
        } else {
            RiverLine line;
            line.feature = number_;
            fields_.read(feature, line);
            arc.size = std::move(line.size);
            arc.channel = line.channel;
            arc.name = std::move(line.name);
            arc.runs = line.runs;
            arc.rank = key_;
            RiverFields::Unnatural unnatural = fields_.unnatural(feature);
            arc.unnatural = std::move(unnatural.reason);
            arc.is_channel = unnatural.is_channel;
        }
        arc.type = columns_.column(Q::type).text(feature);
        if (arc.type == "none") { // what stands for an empty text
            arc.type.clear();
        }
        arc.braided = numbers.whole(columns_.column(Q::braided), id, true) != 0;
        arc.is_input = !columns_.has(Q::given) || numbers.whole(columns_.column(Q::given), id, true) != 0;
        return arc;
    }

    NetworkFile::ArcColumns columns_of(OGRFeature const& feature) const {
        auto const told = [&](Quantity q) { return columns_.real(feature, q); };
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

    void note_shape(DrawnLine const& drawn, std::int64_t id) {
        auto const& first = drawn.parts.front();
        bool const joined = drawn.parts.size() == 1;
        if (drawn.drawn_parts > 1 && !(joined && table_.segment_parts)) {
            notes_.add(arcs_.what,
                       {"multi_part",
                        id,
                        {},
                        static_cast<double>(drawn.drawn_parts),
                        fmt::format("feature {} has {} parts{}", number_, drawn.drawn_parts,
                                    joined ? ", which join end to end: read as one line"
                                           : ": an arc is one line; each was read as an arc of the same id")});
        }
        if (drawn.curved) {
            notes_.add(arcs_.what,
                       {"curve",
                        id,
                        {},
                        static_cast<double>(first.size()),
                        fmt::format("feature {} is a curve: read as a line of {} vertices", number_, first.size())});
        }
        drawn_.measured += drawn.has_m ? 1 : 0;
        if (!first.empty()) {
            (drawn.has_z ? drawn_.raised : drawn_.flat) += 1;
            if (!drawn.has_z && drawn_.first_flat.empty()) {
                drawn_.first_flat = fmt::format("feature {} has no heights (Z)", number_);
            }
        }
    }

    void say_what_was_drawn(NetworkFile& file) {
        for (Finding& finding : drawn_.others.findings()) {
            finding.where = {}; // in coordinates of the file
            notes_.add(arcs_.what, std::move(finding));
        }
        if (drawn_.measured > 0) {
            notes_.add(arcs_.what, {"measures",
                                    0,
                                    {},
                                    static_cast<double>(drawn_.measured),
                                    fmt::format("{} lines have measures (M), which were left out", drawn_.measured)});
        }
        file.says.heights = drawn_.raised > 0;
        if (drawn_.flat > 0) {
            notes_.add(arcs_.what, {"no_heights",
                                    0,
                                    {},
                                    static_cast<double>(drawn_.flat),
                                    fmt::format("{}: there are {} such lines", drawn_.first_flat, drawn_.flat)});
        }
        // Many formats fill a Z that nobody has with 0.
        bool const filled =
            schema_ != Schema::native && drawn_.raised > 0 && std::ranges::all_of(file.arcs, [](FileArc const& arc) {
                return std::ranges::all_of(arc.line, [](Vec3 const& p) { return !(p.z != 0.0); });
            });
        if (filled) {
            file.says.heights = false;
            for (FileArc& arc : file.arcs) {
                for (Vec3& p : arc.line) {
                    p.z = nan;
                }
            }
            notes_.add(
                arcs_.what,
                {"no_heights", 0, {}, static_cast<double>(drawn_.raised), "every height (Z) is 0: treated as missing"});
        }
    }

    Layer const& arcs_;
    std::optional<Schema> schema_;
    SchemaTable const& table_;
    Notes& notes_;
    ArcColumns columns_;
    RiverFields fields_;
    AttributeReader attributes_;
    bool by_feature_ = false; // arcs have the numbers of their features
    bool whole_ = false;      // findings are refused
    std::int64_t number_ = 0; // of the feature in hand, in the order of the layer, from 1
    Drawn drawn_;
    std::int64_t key_ = 0; // of the feature in hand
    std::int64_t ds_key_ = 0;
    std::vector<std::int64_t> keys_; // by arc
    std::vector<std::int64_t> ds_keys_;
};

} // namespace

void read_arcs(NetworkFile& file, Layer const& arcs, std::optional<Schema> schema, Wish const& wish,
               Driver const& driver, Notes& notes, Run const& run) {
    ArcReader(arcs, schema, wish, notes).read(file, driver, run);
}

} // namespace thalweg::io
