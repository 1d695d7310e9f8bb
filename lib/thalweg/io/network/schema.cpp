// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/schema.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/tables/internal/layers.hpp>

namespace thalweg::io {

namespace {

using Kind = Column::Kind;
using Q = Quantity;

/// What a 1 in a file is in m, m2 or m/m, and the decimals in a shapefile: as fine as those in metres.
struct FieldUnit {
    double si;
    int decimals;
};
constexpr FieldUnit m{1.0, length_decimals};
constexpr FieldUnit m2{1.0, area_decimals};
constexpr FieldUnit ratio{1.0, slope_decimals};
constexpr FieldUnit km{1e3, 12};
constexpr FieldUnit km2{1e6, 12};
constexpr FieldUnit cm{0.01, 7};

constexpr SchemaField integer(Q quantity, std::string_view name, std::string_view also = {}) {
    return {.quantity = quantity, .name = name, .also = also};
}

// A field that names an arc.
constexpr SchemaField link(Q quantity, std::string_view name, double no_arc, std::string_view also = {}) {
    return {.quantity = quantity, .name = name, .also = also, .unknown = no_arc};
}

constexpr SchemaField real(Q quantity, std::string_view name, FieldUnit unit, std::string_view also = {},
                           double unknown = nan) {
    return {.quantity = quantity,
            .name = name,
            .kind = Kind::real,
            .decimals = unit.decimals,
            .unit = unit.si,
            .also = also,
            .unknown = unknown};
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
    real(Q::length, "length", m),
    real(Q::length_3d, "length_3d", m),
    real(Q::straight, "straight", m),
    real(Q::z_up, "z_up", m),
    real(Q::z_down, "z_down", m),
    real(Q::dist_out, "dist_out", m),
    real(Q::slope, "slope", ratio),
    real(Q::us_area, "us_area", m2),
    real(Q::ds_area, "ds_area", m2),
    real(Q::persistence, "survives", m, {}, -1), // which stands for infinity
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
    real(Q::length, "Length", m),
    integer(Q::shreve, "Magnitude"),
    real(Q::ds_area, "DSContArea", m2, "DS_Cont_Ar"),
    real(Q::drop, "strmDrop", m, "Drop"),
    real(Q::slope, "Slope", ratio),
    real(Q::straight, "StraightL", m, "Straight_L"),
    real(Q::us_area, "USContArea", m2, "US_Cont_Ar"),
    integer(Q::arc_id, "WSNO"),
    real(Q::dist_out, "DOUTEND", m, "DOUT_END"),
    real(Q::dist_up, "DOUTSTART", m, "DOUT_START"),
    real(Q::dist_mid, "DOUTMID", m, "DOUT_MID"),
};

// NHDPlus Version 2 User Guide (2012) and NHDPlus HR data dictionary: NHDFlowline with PlusFlowlineVAA and elevslope
// joined to it. Distances and lengths upstream are from the flowline's end down. -9998 stands for a height or slope
// that is not known.
constexpr std::array nhdplus_fields{
    integer(Q::arc_id, "COMID", "NHDPlusID"),
    always("RESOLUTION", "Local"),
    real(Q::length, "LENGTHKM", km),
    always("FLOWDIR", "With Digitized"),
    always("WBAREACOMI", Kind::integer, 0),
    always("FTYPE", "StreamRiver"),
    always("FCODE", Kind::integer, 46006),
    integer(Q::hack, "StreamLeve", "StreamLevel"),
    integer(Q::strahler, "StreamOrde", "StreamOrder"),
    integer(Q::stream_calc, "StreamCalc"),
    integer(Q::from_node, "FromNode"),
    integer(Q::to_node, "ToNode"),
    integer(Q::key, "Hydroseq"),
    integer(Q::path, "LevelPathI", "LevelPath LevelPathID"),
    real(Q::dist_out, "Pathlength", km),
    integer(Q::outlet_path, "TerminalPa", "TerminalPath"),
    real(Q::length_us, "ArbolateSu", km, "ArbolateSum"),
    integer(Q::divergence, "Divergence"),
    integer(Q::is_source, "StartFlag"),
    integer(Q::is_outlet, "TerminalFl", "TerminalFlag"),
    integer(Q::ds_hack, "DnLevel"),
    link(Q::us_path, "UpLevelPat", 0),
    link(Q::us_key, "UpHydroseq", 0),
    link(Q::ds_path, "DnLevelPat", 0),
    link(Q::ds_minor, "DnMinorHyd", 0),
    integer(Q::n_down, "DnDrainCou"),
    link(Q::ds_key, "DnHydroseq", 0),
    only_read(link(Q::ds_arc, "tocomid", 0)), // nhdplusTools
    always("FromMeas", Kind::real, 0),
    always("ToMeas", Kind::real, 100),
    integer(Q::returns, "RtnDiv"),
    real(Q::own_area, "AreaSqKM", km2),
    real(Q::ds_area, "TotDASqKM", km2),
    real(Q::routed_area, "DivDASqKM", km2),
    real(Q::z_up, "MAXELEVSMO", cm, {}, -9998),
    real(Q::z_down, "MINELEVSMO", cm, {}, -9998),
    real(Q::slope, "SLOPE", ratio, {}, -9998),
};

// HydroRIVERS Technical Documentation v1.0 (2019). Discharge, its class and the sub-basin of HydroBASINS are not
// known here.
constexpr std::array hydrorivers_fields{
    integer(Q::arc_id, "HYRIV_ID"),        link(Q::ds_arc, "NEXT_DOWN", 0),
    integer(Q::outlet_arc, "MAIN_RIV"),    real(Q::length, "LENGTH_KM", km),
    real(Q::dist_out, "DIST_DN_KM", km),   real(Q::dist_source, "DIST_UP_KM", km),
    real(Q::own_area, "CATCH_SKM", km2),   real(Q::ds_area, "UPLAND_SKM", km2),
    always("ENDORHEIC", Kind::integer, 0), always("DIS_AV_CMS", Kind::real, -9999),
    integer(Q::strahler, "ORD_STRA"),      integer(Q::hack, "ORD_CLAS"),
    always("ORD_FLOW", Kind::integer, 0),  always("HYBAS_L12", Kind::integer, 0),
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
    real(Q::length, "length", m),
    real(Q::straight, "stright", m),
    real(Q::sinuosity, "sinosoid", ratio, "sinusoid"),
    real(Q::dist_source, "cum_length", m),
    always("flow_accum", Kind::real, 0),
    real(Q::dist_up, "out_dist", m),
    real(Q::z_up, "source_elev", m, "source_ele"),
    real(Q::z_down, "outlet_elev", m, "outlet_ele"),
    real(Q::drop, "elev_drop", m),
    always("out_drop", Kind::real, 0),
    real(Q::slope, "gradient", ratio),
    only_read(integer(Q::basin_id, "network")),
};

constexpr std::array<std::string_view, 4> native_told{"arc_id", "from_node", "to_node", "ds_arc"};
constexpr std::array<std::string_view, 2> taudem_told{"linkno", "dslinkno"};
constexpr std::array<std::string_view, 2> nhdplus_told{"comid nhdplusid", "hydroseq tocomid tonode"};
constexpr std::array<std::string_view, 2> hydrorivers_told{"hyriv_id", "next_down"};
constexpr std::array<std::string_view, 2> grass_told{"stream cat", "next_stream next_strea stream_type stream_typ"};

// In the order of the enumerators; the layer, the least arc id, how many arcs may flow into one, whether lines are
// drawn upstream, and whether each segment is a part of its own.
constexpr ByEnum<Schema, SchemaTable, 5> tables{{{
    {Schema::native, "native", native_fields, native_told},
    {Schema::taudem, "taudem", taudem_fields, taudem_told, "streamnet", 0, 2, true, true},
    {Schema::nhdplus, "nhdplus", nhdplus_fields, nhdplus_told, "NHDFlowline_Network", 1, 0, false, false, true},
    {Schema::hydrorivers, "hydrorivers", hydrorivers_fields, hydrorivers_told, "HydroRIVERS"},
    {Schema::grass, "grass", grass_fields, grass_told, "streams", 1, 5},
}}};

// Who reads: RiverFields. docs/river_files.md lists them. Nodes that only repeat the drawn direction (startNode of
// INSPIRE and OS, CdNoeudDebut of BD TOPAGE, FNODE_ of ArcInfo) are not here.
constexpr std::array data_sets{
    DataSet{.name = "thalweg",
            .source = "docs/interchange.md",
            .id = "arc_id",
            .down = "ds_arc",
            .from_node = "from_node",
            .to_node = "to_node"},
    DataSet{.name = "NHDPlus",
            .version = "2, HR",
            .source = "USGS, EPA: NHDPlus Version 2 User Guide",
            .id = "hydroseq",
            .down = "dnhydroseq",
            .from_node = "fromnode",
            .to_node = "tonode",
            .rank = "hydroseq",
            .area = "totdasqkm"},
    DataSet{.name = "nhdplusTools",
            .version = "1",
            .source = "USGS: R package nhdplusTools",
            .id = "comid",
            .down = "tocomid"},
    DataSet{.name = "MERIT-Basins, RAPID",
            .version = "0.7, 1.0",
            .source = "Lin et al. 2019",
            .id = "comid",
            .down = "nextdownid",
            .area = "uparea"},
    DataSet{.name = "HydroRIVERS",
            .version = "1.0",
            .source = "HydroSHEDS: HydroRIVERS Technical Documentation",
            .id = "hyriv_id",
            .down = "next_down",
            .rank = "dist_dn_km",
            .area = "upland_skm"},
    DataSet{.name = "EU-Hydro",
            .version = "1.3",
            .source = "Copernicus Land Monitoring Service",
            .id = "object_id",
            .down = "nextdownid",
            .from_node = "fnode",
            .to_node = "tnode"},
    DataSet{.name = "TauDEM, TDX-Hydro, GEOGLOWS",
            .version = "5; 1; 2",
            .source = "TauDEM: Stream Reach And Watershed",
            .id = "linkno",
            .down = "dslinkno",
            .area = "dscontarea",
            .area_unit = 1.0},
    DataSet{.name = "GRASS r.stream.order",
            .version = "8",
            .source = "GRASS: r.stream.order",
            .id = "stream cat",
            .down = "next_stream next_strea"},
    DataSet{.name = "CCM2", .version = "2.1", .source = "JRC: Vogt et al. 2007", .id = "wso1_id", .down = "nextdownid"},
    DataSet{.name = "ArcHydro, Geofabric",
            .version = "2; 3",
            .source = "Maidment 2002; Bureau of Meteorology",
            .id = "hydroid",
            .down = "nextdownid",
            .from_node = "from_node",
            .to_node = "to_node",
            .area = "upstrdarea",
            .area_unit = 1.0},
    DataSet{.name = "ECRINS",
            .version = "1.1",
            .source = "EEA Technical report 7/2012",
            .id = "tr seg_id segment_id gid id objectid",
            .down = "nextdownid",
            .from_node = "fnode",
            .to_node = "tnode"},
    DataSet{.name = "BHO",
            .version = "2017",
            .source = "ANA: Base Hidrográfica Ottocodificada; pgHydro",
            .id = "cotrecho",
            .down = "nutrjus",
            .from_node = "noorigem",
            .to_node = "nodestino",
            .rank = "nudistbact",
            .area = "nuareamont"},
    DataSet{.name = "SWORD",
            .version = "16, 17b, 17c",
            .source = "Altenau et al. 2021",
            .told_by = "rch_id_dn rch_id_dn_main rch_id_dn_1 rch_id_up n_rch_dn n_rch_down",
            .id = "reach_id",
            .down = "rch_id_dn_main rch_id_dn rch_id_dn_1",
            .rank = "dist_out",
            .area = "facc"},
    DataSet{.name = "NextGen hydrofabric",
            .version = "1 to 2.2",
            .source = "NOAA-OWP, Lynker: hydrofabric data model",
            .id = "id flowpath_id",
            .down = "toid flowpath_toid",
            .nexus = "nex-",
            .of_nexus = "wb-",
            .area = "tot_drainage_areasqkm"},
    DataSet{.name = "mizuRoute",
            .version = "2",
            .source = "Mizukami et al. 2016",
            .id = "seg_id segid",
            .down = "tosegment downsegid"},
    DataSet{.name = "QSWAT+", .version = "2", .source = "SWAT+: QSWAT+ manual", .id = "channel", .down = "channelr"},
    DataSet{.name = "ArcSWAT, QSWAT",
            .version = "2012",
            .source = "ArcSWAT user's guide",
            .id = "subbasin",
            .down = "subbasinr"},
    DataSet{.name = "pyflwdir", .version = "0.5", .source = "Deltares: pyflwdir", .id = "idx", .down = "idx_ds"},
    DataSet{.name = "river-route",
            .version = "1, 2",
            .source = "river-route: its routing parameters",
            .id = "river_id",
            .down = "downstream_river_id ds_river_id"},
    DataSet{.name = "3DHP",
            .version = "1",
            .source = "USGS: 3D Hydrography Program",
            .id = "hydrosequence",
            .down = "dnhydrosequence",
            .rank = "hydrosequence"},
    DataSet{.name = "DIBAVOD", .version = "2.3", .source = "VÚV TGM", .id = "utokj_id", .down = "utokjn_id"},
    DataSet{.name = "River Environment Classification",
            .version = "1, 2.4, DN3",
            .source = "NIWA",
            .from_node = "nz_fnode from_node from_no fnode",
            .to_node = "nz_tnode to_node to_no tnode",
            .rank = "lengthdown",
            .area = "cum_area",
            .area_unit = 1.0},
    DataSet{.name = "W05",
            .version = "1 to 3",
            .source = "MLIT: National Land Numerical Information, rivers",
            .from_node = "w05_009",
            .to_node = "w05_010"},
    DataSet{.name = "GRIT",
            .version = "0.6, 1.0",
            .source = "Wortmann et al. 2025",
            .from_node = "upstream_node_id",
            .to_node = "downstream_node_id",
            .main = "is_mainstem",
            .area = "drainage_area_out"},
    DataSet{.name = "INSPIRE",
            .version = "4.0",
            .source = "INSPIRE: LinkDirectionValue",
            .direction = "flowdirection flowdirection_href",
            .with = "indirection",
            .against = "inoppositedirection"},
    DataSet{.name = "NHN",
            .version = "1.0",
            .source = "NRCan: National Hydro Network",
            .direction = "flowdirection",
            .with = "1 samedirection",
            .against = "2 oppositedirection"},
    DataSet{.name = "OS Open Rivers",
            .version = "2",
            .source = "Ordnance Survey: Technical Specification",
            .direction = "flow_direction flow",
            .with = "indirection",
            .against = "inoppositedirection"},
    DataSet{.name = "BD TOPAGE, BD TOPO",
            .version = "2; 3",
            .source = "Sandre; IGN",
            .direction = "sensecoulementth sensecoule sensecoul sens_ecoul sens_de_l_ecoulement",
            .with = "sensdirect dansdirectiontronçon",
            .against = "sensinverse",
            .z_first = "z_ini",
            .z_last = "z_fin"},
    DataSet{.name = "ArcGIS geometric networks, NHD",
            .source = "Esri: FlowDir of ArcHydro and NHD",
            .direction = "flowdir",
            .with = "1 withdigitized withflow",
            .against = "2 againstdigitized againstflow"},
    DataSet{.name = "thalweg", .source = "docs/interchange.md", .area = "ds_area", .area_unit = 1.0},
};

// In the order of the enumerators.
constexpr ByEnum<Quantity, std::string_view, static_cast<std::size_t>(Quantity::constant) + 1> quantity_names{
    {"arc_id",      "from_node", "to_node",     "ds_arc",      "n_up",        "basin_id",   "topo_ord", "strahler",
     "shreve",      "hack",      "length",      "length_3d",   "straight",    "z_up",       "z_down",   "dist_out",
     "slope",       "us_area",   "ds_area",     "survives",    "feature",     "type",       "braided",  "given",
     "us_arc_1",    "us_arc_2",  "us_arc_3",    "us_arc_4",    "us_arc_5",    "outlet_arc", "key",      "ds_key",
     "us_key",      "path",      "ds_path",     "us_path",     "outlet_path", "ds_hack",    "n_down",   "is_source",
     "is_outlet",   "horton",    "scheidegger", "drwal",       "drop",        "sinuosity",  "dist_mid", "dist_up",
     "dist_source", "length_us", "own_area",    "routed_area", "stream_calc", "divergence", "ds_minor", "returns",
     "constant"}};
static_assert(quantity_names[Quantity::constant] == "constant");

} // namespace

std::string_view name_of(Quantity quantity) {
    return quantity_names[quantity];
}

std::optional<Quantity> quantity_of(std::string_view name) {
    auto const* const found = std::ranges::find(quantity_names.entries, name);
    auto const quantity = static_cast<Quantity>(found - quantity_names.entries.begin());
    return quantity < Quantity::constant ? std::optional(quantity) : std::nullopt;
}

std::span<DataSet const> all_data_sets() {
    return data_sets;
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
        names.emplace_back(table.name);
    }
    auto const found = std::ranges::find(names, name);
    refuse_if<BadInput>(found == names.end(), "io.schema_named", "there is no schema '{}'.{} ({})", name,
                        did_you_mean(name, names), listed(names));
    return static_cast<Schema>(found - names.begin());
}

SchemaField const* field_of(SchemaTable const& table, Quantity quantity) {
    auto const found = std::ranges::find(table.fields, quantity, &SchemaField::quantity);
    return found == table.fields.end() ? nullptr : &*found;
}

} // namespace thalweg::io
