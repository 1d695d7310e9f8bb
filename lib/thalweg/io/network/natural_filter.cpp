// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which lines of a file are natural watercourses.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

namespace {

// Values of OpenStreetMap's key waterway.
constexpr std::string_view natural_waterways = "river stream tidal_channel brook creek wadi rapids waterfall";
constexpr std::string_view artificial_waterways = "canal ditch drain pressurised pipeline";

// OpenStreetMap's keys of lines that are no waterways: columns of any layer, and those of its ways alone.
constexpr std::string_view keys_of_ways = "highway railway aerialway barrier power route";
constexpr std::string_view more_keys = "boundary natural man_made landuse leisure aeroway building place historic "
                                       "telecom military tourism amenity golf geological";

// Canals, ditches and pipes in the words of several languages, as simple_name() makes them of values: letters and
// digits in lower case, without the accented ones. BD TOPO has "Conduit forcé", FKB "KanalGrøft".
constexpr std::string_view channel_words =
    "canal canals kanal kanaal canale canalartificial artificialcanal canalditch canalorditch canalgroup "
    "canalprimary irrigationcanal drainagecanal kanalgrft axkanal "
    "ditch drain drainageditch drainditch graben entwsserungsgraben sloot greppel greppeldrogesloot foss fosse fossato "
    "acequia zanja leat lock canalfeeder transfer bissesuone "
    "pipe pipeline conduit conduitbuse conduitforc conduitforce conduite aqueduct aqueduc acueducto rohr rohrleitung "
    "verrohrung druckleitung druckleitungeinfach druckleitungmehrfach druckstollen duiker leiding rioolleiding tubera "
    "sewer sewerconnection penstock vala canalencoberto canalnooperacional";

struct CodeRow {
    std::string_view columns;
    std::string_view channels; ///< as simple_name() makes them, or of a list of codes the last part
    std::string_view coasts = "";
};

// Columns of schemas besides OpenStreetMap's and NHD's.
constexpr std::array<CodeRow, 7> code_rows{{
    // OS Open Rivers; BD TOPO and BD TOPAGE; D-HYDRO; Geofabrik; Natural Earth; ATKIS; FKB; TOP10NL; swissTLM3D,
    // swissTLMRegio, VECTOR25; EDGV and BC250; and common names.
    {"form watercourseform nature natureth naturetron branchtype branch_type fclass featurecla featuretype feattype "
     "feature_type objart_txt objtype objekttype objekttyp objektart typewater watertype objval objectval "
     "tipotrechodrenagem tipo_trecho_drenagem tipotrecho description type typ kind "
     "class waterdefin "
     "waterdefinition",
     channel_words, "kystkontur coastline"},
    {"origin origin_href origine", "manmade artificiel artificielle"},     // INSPIRE
    {"dfdd f_code", "bh010 bh020 bh030 bh060 bh065 bh110 aq113", "ba010"}, // EU-Hydro, VMAP: codes of DFDD
    {"objart", "44003"},                                                   // ATKIS
    {"fkt funktion", "8300 8400 8410"},                                    // its axes of canals and ditches
    {"tipotrechodrenagem tipo_trecho_drenagem tipotrecho", "2 4 5 11"},    // EDGV
    {"waterdefinition water_definition waterdefin definition", "1 2 3"},   // NHN: canal, conduit, ditch
}};

bool is_among(std::string_view words, std::string_view word) {
    for (std::size_t at = words.find(word); !word.empty() && at != std::string_view::npos;
         at = words.find(word, at + 1)) {
        std::size_t const end = at + word.size();
        if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' ')) {
            return true;
        }
    }
    return false;
}

// What NHD calls lines that are not rivers, by FTYPE in words or as a number, or by the first digits of FCODE; "" for
// any other.
std::string nhd_type(std::string const& type) {
    std::string const word = lower_case(type);
    return word == "566" || word == "coastline"    ? "Coastline"
           : word == "428" || word == "pipeline"   ? "Pipeline"
           : word == "336" || word == "canalditch" ? "CanalDitch"
                                                   : "";
}

bool holds_tags(std::string const& value) {
    return value.find("=>") != std::string::npos || value.starts_with('{');
}

} // namespace

std::string value_of_tag(std::string_view tags, std::string_view key) {
    std::string const name = fmt::format("\"{}\"", key);
    for (std::size_t at = tags.find(name); at != std::string_view::npos; at = tags.find(name, at + 1)) {
        std::string_view rest = tags.substr(at + name.size());
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        std::size_t const sign = rest.starts_with("=>") ? 2 : rest.starts_with(':') ? 1 : 0;
        rest.remove_prefix(sign);
        rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
        if (sign == 0 || !rest.starts_with('"')) {
            continue;
        }
        std::string value;
        for (std::size_t i = 1; i < rest.size() && rest[i] != '"'; ++i) {
            i += rest[i] == '\\' && i + 1 < rest.size() ? 1 : 0;
            value += rest[i];
        }
        return value;
    }
    return "";
}

NaturalFilter::NaturalFilter(OGRLayer& layer)
    : all_tags_(FileColumn::with_tags(layer)), osm_id_(layer, {"osm_id", "osm_way_id", "full_id", "@id"}, false),
      ftype_(layer, {"ftype"}, false), fcode_(layer, {"fcode"}, false) {
    for (std::string_view const keys : {std::string_view("waterway tunnel"), keys_of_ways, more_keys}) {
        for (std::string const& key : words_of(keys)) {
            tags_.emplace(key, FileColumn(layer, {key}, false));
        }
    }
    fcode_ = fcode_.is_number() ? fcode_ : FileColumn();
    for (std::size_t row = 0; row < code_rows.size(); ++row) {
        for (std::string const& name : words_of(code_rows[row].columns)) {
            if (FileColumn column(layer, {name}, false); column.is_there()) {
                codes_.push_back({std::move(column), row});
            }
        }
    }
}

std::string NaturalFilter::tag(OGRFeature const& feature, std::string_view key) const {
    auto const column = tags_.find(key);
    std::string value = column == tags_.end() ? "" : column->second.text(feature);
    return lower_case(value.empty() && all_tags_.is_there() ? value_of_tag(all_tags_.text(feature), key) : value);
}

bool NaturalFilter::is_way(OGRFeature const& feature) const {
    if (!osm_id_.is_there()) {
        return all_tags_.is_there() && holds_tags(all_tags_.text(feature));
    }
    auto const has = [&](std::string const& key) { return tags_.find(key)->second.is_there(); };
    return !osm_id_.text(feature).empty() && (all_tags_.is_there() || std::ranges::any_of(words_of(keys_of_ways), has));
}

std::string NaturalFilter::other_way(OGRFeature const& feature) const {
    bool const way = is_way(feature);
    for (std::string_view const keys : {keys_of_ways, way ? more_keys : std::string_view()}) {
        for (std::string const& key : words_of(keys)) {
            if (std::string const value = tag(feature, key); !value.empty()) {
                return key + " " + value;
            }
        }
    }
    return way ? "no waterway" : "";
}

Unnatural NaturalFilter::by_tags(OGRFeature const& feature) const {
    std::string const waterway = tag(feature, "waterway");
    if (!waterway.empty() && !is_among(natural_waterways, waterway)) {
        return {"waterway " + waterway, is_among(artificial_waterways, waterway)};
    }
    if (tag(feature, "natural") == "coastline") {
        return {"natural coastline"};
    }
    if (tag(feature, "tunnel") == "flooded") {
        return {"tunnel flooded", true};
    }
    bool const has_column = tags_.find("waterway")->second.is_there();
    if (waterway.empty() && (has_column || is_way(feature))) {
        if (std::string reason = other_way(feature); !reason.empty()) {
            return {std::move(reason), tag(feature, "man_made") == "pipeline"};
        }
    }
    return tag(feature, "man_made") == "pipeline" ? Unnatural{"man_made pipeline", true} : Unnatural();
}

Unnatural NaturalFilter::by_code(OGRFeature const& feature) const {
    for (Code const& code : codes_) {
        std::string const value = code.column.text(feature);
        bool const is_link = value.starts_with("http");
        std::string const word = simple_name(std::string_view(value).substr(is_link ? value.rfind('/') : 0));
        CodeRow const& row = code_rows[code.row];
        bool const is_channel = is_among(row.channels, word);
        if (is_channel || is_among(row.coasts, word)) {
            return {code.column.name() + " " + value, is_channel, !is_channel};
        }
    }
    return {};
}

Unnatural NaturalFilter::of(OGRFeature const& feature) const {
    std::string const ftype = ftype_.text(feature);
    std::string const by_ftype = nhd_type(ftype);
    double const number = fcode_.real(feature);
    int const fcode = std::isfinite(number) ? static_cast<int>(number) : 0;
    std::string const by_fcode = nhd_type(fmt::format("{}", fcode / 100));
    Unnatural found = by_tags(feature);
    if (found.reason.empty() && !by_ftype.empty()) {
        found = {"FTYPE " + ftype, by_ftype != "Coastline"};
    }
    if (found.reason.empty() && !by_fcode.empty()) {
        found = {fmt::format("FCODE {} {}", fcode, by_fcode), by_fcode != "Coastline"};
    }
    if (found.reason.empty()) {
        found = by_code(feature);
    }
    found.is_coast =
        found.is_coast || tag(feature, "natural") == "coastline" || by_ftype == "Coastline" || by_fcode == "Coastline";
    return found;
}

} // namespace thalweg::io
