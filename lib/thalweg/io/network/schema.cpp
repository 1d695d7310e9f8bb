// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/schema.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/io/network/internal/table.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;
using Q = Quantity;

constexpr double km = 1e3;
constexpr double km2 = 1e6;
constexpr double cm = 0.01;

// In the units of others: as fine as those in metres.
constexpr int km_decimals = 12;
constexpr int km2_decimals = 12;
constexpr int cm_decimals = 7;

constexpr SchemaField integer(Q quantity, std::string_view name, std::string_view also = {}) {
    return {.quantity = quantity, .name = name, .also = also};
}

// A field that names an arc; none stands for no arc.
constexpr SchemaField link(Q quantity, std::string_view name, double none, std::string_view also = {}) {
    return {.quantity = quantity, .name = name, .also = also, .unknown = none};
}

constexpr SchemaField real(Q quantity, std::string_view name, int decimals, double unit = 1.0,
                           std::string_view also = {}) {
    return {.quantity = quantity, .name = name, .kind = Kind::real, .decimals = decimals, .unit = unit, .also = also};
}

constexpr SchemaField with_unknown(SchemaField field, double unknown) {
    field.unknown = unknown;
    return field;
}

constexpr SchemaField only_read(SchemaField field) {
    field.written = false;
    return field;
}

constexpr SchemaField always(std::string_view name, Kind kind, double value) {
    return {.name = name, .kind = kind, .value = value};
}

constexpr SchemaField always(std::string_view name, std::string_view text) {
    return {.name = name, .kind = Kind::text, .text = text};
}

// The network schema. Its own tables are written by network_tables.
constexpr std::array native_fields{
    integer(Q::arc_id, "arc_id"),
    integer(Q::from_node, "from_node"),
    integer(Q::to_node, "to_node"),
    link(Q::ds_arc, "ds_arc", 0),
    integer(Q::n_up, "n_up"),
    integer(Q::basin_id, "basin_id"),
    integer(Q::topo_ord, "topo_ord"),
    integer(Q::strahler, "strahler"),
    integer(Q::shreve, "shreve"),
    integer(Q::hack, "hack"),
    real(Q::length, "length", length_decimals),
    real(Q::length_3d, "length_3d", length_decimals),
    real(Q::straight, "straight", length_decimals),
    real(Q::z_up, "z_up", length_decimals),
    real(Q::z_down, "z_down", length_decimals),
    real(Q::dist_out, "dist_out", length_decimals),
    real(Q::slope, "slope", slope_decimals),
    real(Q::us_area, "us_area", area_decimals),
    real(Q::ds_area, "ds_area", area_decimals),
    with_unknown(real(Q::persistence, "survives", length_decimals), -1), // which stands for infinity
    SchemaField{.quantity = Q::feature, .name = "feature", .kind = Kind::wide_integer},
    SchemaField{.quantity = Q::type, .name = "type", .kind = Kind::text},
    integer(Q::braided, "braided"),
    integer(Q::given, "given"),
};

// TauDEM 5, StreamNet: its guide "Stream Reach And Watershed", its source src/streamnet.cpp. WSNO is the number of the
// reach's own watershed, which is that of the reach.
constexpr std::array taudem_fields{
    integer(Q::arc_id, "LINKNO"),
    link(Q::ds_arc, "DSLINKNO", -1),
    link(Q::us_arc_1, "USLINKNO1", -1),
    link(Q::us_arc_2, "USLINKNO2", -1),
    always("DSNODEID", Kind::integer, -1),
    integer(Q::strahler, "strmOrder", "Order"),
    real(Q::length, "Length", length_decimals),
    integer(Q::shreve, "Magnitude"),
    real(Q::ds_area, "DSContArea", area_decimals, 1.0, "DS_Cont_Ar"),
    real(Q::drop, "strmDrop", length_decimals, 1.0, "Drop"),
    real(Q::slope, "Slope", slope_decimals),
    real(Q::straight, "StraightL", length_decimals, 1.0, "Straight_L"),
    real(Q::us_area, "USContArea", area_decimals, 1.0, "US_Cont_Ar"),
    integer(Q::arc_id, "WSNO"),
    real(Q::dist_out, "DOUTEND", length_decimals, 1.0, "DOUT_END"),
    real(Q::dist_up, "DOUTSTART", length_decimals, 1.0, "DOUT_START"),
    real(Q::dist_mid, "DOUTMID", length_decimals, 1.0, "DOUT_MID"),
};

// NHDPlus Version 2 User Guide (2012) and NHDPlus HR data dictionary: NHDFlowline with PlusFlowlineVAA and elevslope
// joined to it. Distances and lengths upstream are from the flowline's end down. -9998 stands for a height or slope
// that is not known.
constexpr std::array nhdplus_fields{
    integer(Q::arc_id, "COMID", "NHDPlusID"),
    always("RESOLUTION", "Local"),
    real(Q::length, "LENGTHKM", km_decimals, km),
    always("FLOWDIR", "With Digitized"),
    always("WBAREACOMI", Kind::integer, 0),
    always("FTYPE", "StreamRiver"),
    always("FCODE", Kind::integer, 46006),
    integer(Q::hack, "StreamLeve", "StreamLevel"),
    integer(Q::strahler, "StreamOrde", "StreamOrder"),
    integer(Q::strahler, "StreamCalc"),
    integer(Q::from_node, "FromNode"),
    integer(Q::to_node, "ToNode"),
    integer(Q::key, "Hydroseq"),
    integer(Q::path, "LevelPathI", "LevelPath LevelPathID"),
    real(Q::dist_out, "Pathlength", km_decimals, km),
    integer(Q::outlet_path, "TerminalPa", "TerminalPath"),
    real(Q::length_us, "ArbolateSu", km_decimals, km, "ArbolateSum"),
    always("Divergence", Kind::integer, 0),
    integer(Q::is_source, "StartFlag"),
    integer(Q::is_outlet, "TerminalFl", "TerminalFlag"),
    integer(Q::ds_hack, "DnLevel"),
    link(Q::us_path, "UpLevelPat", 0),
    link(Q::us_key, "UpHydroseq", 0),
    link(Q::ds_path, "DnLevelPat", 0),
    always("DnMinorHyd", Kind::integer, 0),
    integer(Q::n_down, "DnDrainCou"),
    link(Q::ds_key, "DnHydroseq", 0),
    only_read(link(Q::ds_arc, "tocomid", 0)), // nhdplusTools
    always("FromMeas", Kind::real, 0),
    always("ToMeas", Kind::real, 100),
    always("RtnDiv", Kind::integer, 0),
    real(Q::own_area, "AreaSqKM", km2_decimals, km2),
    real(Q::ds_area, "TotDASqKM", km2_decimals, km2),
    real(Q::ds_area, "DivDASqKM", km2_decimals, km2),
    with_unknown(real(Q::z_up, "MAXELEVSMO", cm_decimals, cm), -9998),
    with_unknown(real(Q::z_down, "MINELEVSMO", cm_decimals, cm), -9998),
    with_unknown(real(Q::slope, "SLOPE", slope_decimals), -9998),
};

// HydroRIVERS Technical Documentation v1.0 (2019). Discharge, its class and the sub-basin of HydroBASINS are not
// known here.
constexpr std::array hydrorivers_fields{
    integer(Q::arc_id, "HYRIV_ID"),
    link(Q::ds_arc, "NEXT_DOWN", 0),
    integer(Q::outlet_arc, "MAIN_RIV"),
    real(Q::length, "LENGTH_KM", km_decimals, km),
    real(Q::dist_out, "DIST_DN_KM", km_decimals, km),
    real(Q::dist_source, "DIST_UP_KM", km_decimals, km),
    real(Q::own_area, "CATCH_SKM", km2_decimals, km2),
    real(Q::ds_area, "UPLAND_SKM", km2_decimals, km2),
    always("ENDORHEIC", Kind::integer, 0),
    always("DIS_AV_CMS", Kind::real, -9999),
    integer(Q::strahler, "ORD_STRA"),
    integer(Q::hack, "ORD_CLAS"),
    always("ORD_FLOW", Kind::integer, 0),
    always("HYBAS_L12", Kind::integer, 0),
};

// GRASS addon r.stream.order, the table of stream_vect (its source stream_vector.c, misspellings included; prev_str of
// no stream is 0, next_stream is -1; flow_accum is 0 without an accumulation map), and r.stream.extract, which tells
// only cat, stream_type, type_code and network.
constexpr std::array grass_fields{
    integer(Q::arc_id, "cat"),
    integer(Q::arc_id, "stream"),
    link(Q::ds_arc, "next_stream", -1, "next_strea"),
    link(Q::us_arc_1, "prev_str01", 0),
    link(Q::us_arc_2, "prev_str02", 0),
    link(Q::us_arc_3, "prev_str03", 0),
    link(Q::us_arc_4, "prev_str04", 0),
    link(Q::us_arc_5, "prev_str05", 0),
    integer(Q::strahler, "strahler"),
    integer(Q::horton, "horton"),
    integer(Q::shreve, "shreve"),
    integer(Q::hack, "hack"),
    integer(Q::topo_ord, "topo_dim"),
    integer(Q::scheidegger, "scheidegger", "scheidegge"),
    integer(Q::drwal, "drwal_old"),
    real(Q::length, "length", length_decimals),
    real(Q::straight, "stright", length_decimals),
    real(Q::sinuosity, "sinosoid", slope_decimals, 1.0, "sinusoid"),
    real(Q::dist_source, "cum_length", length_decimals),
    always("flow_accum", Kind::real, 0),
    real(Q::dist_up, "out_dist", length_decimals),
    real(Q::z_up, "source_elev", length_decimals, 1.0, "source_ele"),
    real(Q::z_down, "outlet_elev", length_decimals, 1.0, "outlet_ele"),
    real(Q::drop, "elev_drop", length_decimals),
    always("out_drop", Kind::real, 0),
    real(Q::slope, "gradient", slope_decimals),
    only_read(integer(Q::basin_id, "network")),
};

constexpr std::array<std::string_view, 4> native_told{"arc_id", "from_node", "to_node", "ds_arc"};
constexpr std::array<std::string_view, 2> taudem_told{"linkno", "dslinkno"};
constexpr std::array<std::string_view, 2> nhdplus_told{"comid nhdplusid", "hydroseq tocomid tonode"};
constexpr std::array<std::string_view, 2> hydrorivers_told{"hyriv_id", "next_down"};
constexpr std::array<std::string_view, 2> grass_told{"stream cat", "next_stream next_strea stream_type stream_typ"};

constexpr ByEnum<Schema, SchemaTable, 5> tables{{
    SchemaTable{.name = "native", .fields = native_fields, .told_by = native_told},
    SchemaTable{.schema = Schema::taudem,
                .name = "taudem",
                .fields = taudem_fields,
                .told_by = taudem_told,
                .layer = "streamnet",
                .first_id = 0,
                .most_upstream = 2,
                .drawn_upstream = true,
                .segment_parts = true},
    SchemaTable{.schema = Schema::nhdplus,
                .name = "nhdplus",
                .fields = nhdplus_fields,
                .told_by = nhdplus_told,
                .layer = "NHDFlowline_Network"},
    SchemaTable{.schema = Schema::hydrorivers,
                .name = "hydrorivers",
                .fields = hydrorivers_fields,
                .told_by = hydrorivers_told,
                .layer = "HydroRIVERS"},
    SchemaTable{.schema = Schema::grass,
                .name = "grass",
                .fields = grass_fields,
                .told_by = grass_told,
                .layer = "streams",
                .most_upstream = 5},
}};

// In the order of the enumerators.
constexpr ByEnum<Quantity, std::string_view, static_cast<std::size_t>(Quantity::constant) + 1> quantity_names{
    {"arc_id",      "from_node", "to_node",     "ds_arc",    "n_up",        "basin_id",   "topo_ord", "strahler",
     "shreve",      "hack",      "length",      "length_3d", "straight",    "z_up",       "z_down",   "dist_out",
     "slope",       "us_area",   "ds_area",     "survives",  "feature",     "type",       "braided",  "given",
     "us_arc_1",    "us_arc_2",  "us_arc_3",    "us_arc_4",  "us_arc_5",    "outlet_arc", "key",      "ds_key",
     "us_key",      "path",      "ds_path",     "us_path",   "outlet_path", "ds_hack",    "n_down",   "is_source",
     "is_outlet",   "horton",    "scheidegger", "drwal",     "drop",        "sinuosity",  "dist_mid", "dist_up",
     "dist_source", "length_us", "own_area",    "constant"}};
static_assert(quantity_names[Quantity::constant] == "constant");

// Written so that a table in another order does not compile.
constexpr bool in_order() {
    for (std::size_t i = 0; i < tables.entries.size(); ++i) {
        if (tables.entries.at(i).schema != static_cast<Schema>(i)) {
            return false;
        }
    }
    return true;
}
static_assert(in_order());

} // namespace

std::string_view name_of(Quantity quantity) {
    return quantity_names[quantity];
}

std::optional<Quantity> quantity_of(std::string_view name) {
    auto const* const found = std::ranges::find(quantity_names.entries, name);
    if (found == quantity_names.entries.end() || *found == name_of(Quantity::constant)) {
        return std::nullopt;
    }
    return static_cast<Quantity>(found - quantity_names.entries.begin());
}

SchemaTable const& table_of(Schema schema) {
    return tables[schema];
}

std::span<SchemaTable const> all_schemas() {
    return tables.entries;
}

Schema schema_named(std::string const& name) {
    std::vector<std::string> names;
    for (SchemaTable const& table : tables.entries) {
        if (table.name == name) {
            return table.schema;
        }
        names.emplace_back(table.name);
    }
    throw BadInput(fmt::format("io.schema_named: there is no schema '{}'.{} ({})", name, did_you_mean(name, names),
                               fmt::join(names, ", ")));
}

SchemaField const* field_of(SchemaTable const& table, Quantity quantity) {
    auto const found = std::ranges::find(table.fields, quantity, &SchemaField::quantity);
    return found == table.fields.end() ? nullptr : &*found;
}

} // namespace thalweg::io
