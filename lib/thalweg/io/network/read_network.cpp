// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {
namespace {

constexpr std::size_t kept = 1000;

} // namespace

void Notes::add(std::string const& source, Finding finding) {
    if (strict_) {
        throw BadInput(source + ": " + finding.text);
    }
    if (++count_[finding.kind] <= kept) {
        findings_.push_back(std::move(finding));
    }
}

std::vector<Finding> Notes::take() {
    for (auto const& [kind, count] : count_) {
        if (count > kept) {
            std::size_t const more = count - kept;
            findings_.push_back({kind, 0, {}, static_cast<double>(more), fmt::format("{}: {} more", kind, more)});
        }
    }
    count_.clear();
    return std::exchange(findings_, {});
}

namespace {

using FileArc = NetworkFile::FileArc;
using Named = std::pair<std::int64_t, std::size_t>; // a number and the arc that has it

// Sorted, so that of several arcs with a number the first is found.
template <class Number> std::vector<Named> by_number(std::size_t count, Number const& number) {
    std::vector<Named> named;
    named.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        named.emplace_back(number(i), i);
    }
    std::ranges::sort(named);
    return named;
}

std::vector<Named>::const_iterator find(std::vector<Named> const& named, std::int64_t number) {
    auto const found = std::ranges::lower_bound(named, number, {}, &Named::first);
    return found != named.end() && found->first == number ? found : named.end();
}

std::vector<Named> by_id(NetworkFile const& file) {
    return by_number(file.arcs.size(), [&](std::size_t i) { return file.arcs[i].id; });
}

// Bits order every place, NaN among them; 0 and -0 are one.
std::uint64_t bits(double v) {
    return std::bit_cast<std::uint64_t>(v + 0.0);
}

struct End {
    std::array<std::uint64_t, 2> place = {};
    std::int64_t* node = nullptr;
};

} // namespace

void link_by_keys(NetworkFile& file, std::vector<std::int64_t> const& keys, std::vector<std::int64_t> const& ds_keys) {
    auto const by_key = by_number(keys.size(), [&](std::size_t i) { return keys[i]; });
    for (std::size_t i = 0; i < file.arcs.size(); ++i) {
        if (ds_keys[i] == 0) {
            file.arcs[i].ds_arc = 0;
            continue;
        }
        auto const found = find(by_key, ds_keys[i]);
        file.arcs[i].ds_arc = found == by_key.end() ? -ds_keys[i] : file.arcs[found->second].id;
    }
}

void drop_links_out(NetworkFile& file, std::string const& what, Notes& notes) {
    auto const ids = by_id(file);
    for (FileArc& arc : file.arcs) {
        if (arc.ds_arc == 0 || find(ids, arc.ds_arc) != ids.end()) {
            continue;
        }
        std::int64_t const below = arc.ds_arc < 0 ? -arc.ds_arc : arc.ds_arc - file.id_shift;
        std::int64_t const id = arc.id - file.id_shift;
        notes.add(what,
                  {"cut_below",
                   id,
                   {},
                   static_cast<double>(below),
                   fmt::format("arc {} flows into {}, which is not in the file: treated as an outlet", id, below)});
        file.says.basin = false; // those of outlets beyond
        arc.ds_arc = 0;
    }
}

void turn_downstream(NetworkFile& file, bool drawn_upstream, std::string const& what, Notes& notes) {
    auto const ids = by_id(file);
    std::size_t down = 0;
    std::size_t up = 0;
    for (FileArc const& arc : file.arcs) {
        auto const found = find(ids, arc.ds_arc);
        if (found == ids.end() || arc.line.empty() || file.arcs[found->second].line.empty()) {
            continue;
        }
        auto const& below = file.arcs[found->second].line;
        down += plan(arc.line.back()) == plan(below.front()) ? 1U : 0U;
        up += plan(arc.line.front()) == plan(below.back()) ? 1U : 0U;
    }
    bool const upstream = up == down ? drawn_upstream : up > down;
    if (upstream) {
        for (FileArc& arc : file.arcs) {
            std::ranges::reverse(arc.line);
            arc.runs = -arc.runs;
        }
    }
    if (upstream != drawn_upstream) {
        std::string const text = fmt::format("most lines are drawn {}, against this schema: all {} were {}",
                                             upstream ? "upstream" : "downstream", file.arcs.size(),
                                             upstream ? "reversed" : "left as they are drawn");
        notes.add(what, {"turned", 0, {}, static_cast<double>(file.arcs.size()), text});
    }
}

void name_ends(NetworkFile& file) {
    std::vector<End> ends;
    ends.reserve(2 * file.arcs.size());
    for (FileArc& arc : file.arcs) {
        arc.from_node = 0;
        arc.to_node = 0;
        if (!arc.line.empty()) {
            ends.push_back({{bits(arc.line.front().x), bits(arc.line.front().y)}, &arc.from_node});
            ends.push_back({{bits(arc.line.back().x), bits(arc.line.back().y)}, &arc.to_node});
        }
    }
    std::vector<std::size_t> order(ends.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(ends[i].place, i); });
    // The first end at a place, in the order of the arcs, stands for the place.
    std::vector<std::size_t> first(ends.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        bool const same = k > 0 && ends[order[k]].place == ends[order[k - 1]].place;
        first[order[k]] = same ? first[order[k - 1]] : order[k];
    }
    std::int64_t nodes = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        *ends[i].node = first[i] == i ? ++nodes : *ends[first[i]].node;
    }
}

void place_nodes(NetworkFile& file) {
    using Place = std::array<std::uint64_t, 3>;
    struct Claim {
        std::int64_t node = 0;
        Place place = {};
        std::size_t end = 0; // in the order of the arcs
        Vec3 at;
    };
    std::vector<Claim> claims;
    claims.reserve(2 * file.arcs.size());
    for (std::size_t i = 0; i < file.arcs.size(); ++i) {
        FileArc const& arc = file.arcs[i];
        if (arc.line.empty()) {
            continue;
        }
        for (auto const& [node, at, end] : {std::tuple(arc.from_node, arc.line.front(), 2 * i),
                                            std::tuple(arc.to_node, arc.line.back(), 2 * i + 1)}) {
            if (node != 0) {
                claims.push_back({node, {bits(at.x), bits(at.y), bits(at.z)}, end, at});
            }
        }
    }
    std::ranges::sort(claims, {}, [](Claim const& c) { return std::tuple(c.node, c.place, c.end); });
    file.nodes.clear();
    // How many ends the node has at the place chosen for it, and which of them is the first.
    std::size_t most = 0;
    std::size_t earliest = 0;
    for (std::size_t k = 0; k < claims.size();) {
        Claim const& claim = claims[k];
        std::size_t next = k;
        while (next < claims.size() && claims[next].node == claim.node && claims[next].place == claim.place) {
            ++next;
        }
        bool const is_new = file.nodes.empty() || file.nodes.back().id != claim.node;
        if (is_new) {
            file.nodes.push_back({claim.node, claim.at});
        }
        if (is_new || next - k > most || (next - k == most && claim.end < earliest)) {
            file.nodes.back().at = claim.at;
            most = next - k;
            earliest = claim.end;
        }
        k = next;
    }
}

void link_by_nodes(NetworkFile& file) {
    auto const beginning = by_number(file.arcs.size(), [&](std::size_t i) { return file.arcs[i].from_node; });
    for (FileArc& arc : file.arcs) {
        auto const found = find(beginning, arc.to_node);
        arc.ds_arc = arc.to_node == 0 || found == beginning.end() ? 0 : file.arcs[found->second].id;
    }
}

namespace {

// Leaves out arcs whose vertices all lie at one place: arcs that flow into one flow into what is downstream of it.
// Their Strahler numbers are then those of two streams after another, not of all that meet.
void bridge_points(NetworkFile& file, std::string const& what, Notes& notes) {
    std::map<std::int64_t, std::int64_t> below; // of an arc without length the arc downstream
    for (FileArc const& arc : file.arcs) {
        bool const is_point = !arc.line.empty() && std::ranges::all_of(arc.line, [&](Vec3 const& p) {
            return plan(p) == plan(arc.line.front());
        });
        if (is_point && arc.ds_arc != arc.id) {
            below.emplace(arc.id, arc.ds_arc);
        }
    }
    if (below.empty()) {
        return;
    }
    auto const next_of = [&](std::int64_t id) {
        std::size_t steps = 0;
        for (auto at = below.find(id); at != below.end() && steps <= below.size(); at = below.find(id), ++steps) {
            id = at->second;
        }
        return steps <= below.size() ? id : 0; // else they run in a circle
    };
    std::erase_if(file.arcs, [&](FileArc const& arc) { return below.contains(arc.id); });
    for (FileArc& arc : file.arcs) {
        arc.ds_arc = next_of(arc.ds_arc);
    }
    for (auto const& [id, down] : below) {
        std::int64_t const next = next_of(down);
        notes.add(what,
                  {"bridged",
                   id - file.id_shift,
                   {},
                   next == 0 ? 0.0 : static_cast<double>(next - file.id_shift),
                   next == 0 ? fmt::format("arc {} has no length: what flows into it ends there", id - file.id_shift)
                             : fmt::format("arc {} has no length: what flows into it flows into arc {}",
                                           id - file.id_shift, next - file.id_shift)});
    }
    file.says.strahler = false;
}

// Sets where the findings that name an arc are: where it begins.
void place_findings(NetworkFile& file) {
    auto const ids = by_id(file);
    for (Finding& finding : file.findings) {
        auto const found = find(ids, finding.feature + file.id_shift);
        if (finding.feature != 0 && found != ids.end() && !file.arcs[found->second].line.empty()) {
            finding.where = plan(file.arcs[found->second].line.front());
        }
    }
}

Wish wish_of(ReadNetworkParams const& params) {
    Wish wish{.schema = params.schema,
              .arcs_layer = params.arcs_layer,
              .nodes_layer = params.nodes_layer,
              .crs = params.crs,
              .source_crs = params.source_crs,
              .any_lines = params.any_lines,
              .bridge = params.bridge};
    for (auto const& [quantity, field] : params.fields) {
        if (quantity == "node_id") {
            wish.node_id = field;
            continue;
        }
        auto const known = quantity_of(quantity);
        if (!known) {
            std::vector<std::string> names{"node_id"};
            for (std::size_t q = 0; q < static_cast<std::size_t>(Quantity::constant); ++q) {
                names.emplace_back(name_of(static_cast<Quantity>(q)));
            }
            throw BadInput(fmt::format("io.read_network: '{}' is not a quantity of the network schema.{} ({})",
                                       quantity, did_you_mean(quantity, names), fmt::join(names, ", ")));
        }
        wish.fields[*known] = field;
    }
    return wish;
}

FilePlaces places_of(NetworkFile const& file) {
    FilePlaces places;
    for (FileArc const& arc : file.arcs) {
        for (Vec3 const& p : arc.line) {
            if (is_finite(plan(p))) {
                places.add(p.x, p.y);
            }
        }
    }
    return places;
}

/// Brings heights into metres, from the unit that the layer of arcs says.
void convert_heights(NetworkFile& file, Layer const& arcs, Wish const& wish, Notes& notes) {
    double const unit = height_unit_of(*arcs.layer, wish.source_crs);
    if (unit == 1.0) {
        return;
    }
    for (FileArc& arc : file.arcs) {
        for (Vec3& p : arc.line) {
            p.z *= unit;
        }
        arc.columns.z_up_m *= unit;
        arc.columns.z_down_m *= unit;
    }
    for (NetworkFile::FileNode& node : file.nodes) {
        node.at.z *= unit;
        node.columns.z_m *= unit;
    }
    if (!wish.whole) {
        notes.add(arcs.what, {"heights_converted",
                              0,
                              {},
                              unit,
                              fmt::format("its heights, in {}, were converted into metres", words_for_unit(unit))});
    }
}

void bring_into_metres(NetworkFile& file, Layer const& arcs, Layer const* nodes, Wish const& wish, Notes& notes,
                       Run const& run) {
    OGRSpatialReference const own = crs_of_layer(arcs.layer->GetSpatialRef(), wish.source_crs);
    bool const has_none = own.IsEmpty() != 0;
    if (nodes != nullptr) {
        OGRSpatialReference const other = crs_of_layer(nodes->layer->GetSpatialRef(), wish.source_crs);
        if (!has_none && other.IsEmpty() == 0 && own.IsSame(&other) == FALSE && name_of(own) != name_of(other)) {
            throw BadInput(fmt::format("{} is in {} and {} in {}: reproject both to one CRS", arcs.what, own.GetName(),
                                       nodes->what, other.GetName()));
        }
    }
    if (has_none) {
        if (file.schema != "native") {
            notes.add(arcs.what, {"no_crs", 0, {}, 0.0, "no CRS: its coordinates are treated as metres"});
        }
        return;
    }
    FilePlaces const places = places_of(file);
    if (!places.any()) {
        file.crs = name_of(own);
        return;
    }
    // A network in the native schema has the CRS that its maker chose.
    OwnMetres const own_metres = file.schema == "native" ? OwnMetres::kept : OwnMetres::judged;
    IntoMetres const metres(own, wish.crs, places.box(), arcs.what, own_metres);
    file.crs = metres.crs();
    auto const move = [&](std::span<Vec3> points) {
        auto const done = metres.apply(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (done[i] == 0) {
                points[i].x = nan; // for the check to find
                points[i].y = nan;
            }
        }
    };
    if (!metres.moves()) {
        return;
    }
    for (FileArc& arc : file.arcs) {
        run.check();
        move(arc.line);
        for (double* const length : {&arc.columns.length_m, &arc.columns.length_3d_m, &arc.columns.straight_m,
                                     &arc.columns.dist_out_m, &arc.columns.slope}) {
            *length = nan; // of another projection
        }
    }
    for (NetworkFile::FileNode& node : file.nodes) {
        move({&node.at, 1});
        node.columns.dist_out_m = nan;
    }
    notes.add(arcs.what,
              {"reprojected",
               0,
               {},
               0.0,
               fmt::format("its coordinates were reprojected from {} to {}", own.GetName(), in_message(file.crs))});
}

void take_nodes(NetworkFile& file, std::optional<Layer> const& nodes, Layer const& arcs, std::string const& source_name,
                Wish const& wish, Driver const& driver, Notes& notes, Run const& run) {
    if (nodes) {
        read_nodes(file, *nodes, wish.node_id, driver, notes, run);
    } else if (file.schema == "native") {
        notes.add(source_name, {"missing_nodes", 0, {}, 0.0, "has no layer nodes"});
    }
    convert_heights(file, arcs, wish, notes);
    bring_into_metres(file, arcs, nodes ? &*nodes : nullptr, wish, notes, run);
}

NetworkFile read(std::string const& path, Wish const& wish, Run const& run) {
    Driver const driver;
    NetworkPlace const place = find_network(path, wish.whole);
    Notes notes(wish.whole);
    NetworkSource const arcs_source(place.arcs, driver);
    std::unique_ptr<NetworkSource> const own_nodes = place.nodes.empty() || place.nodes == place.arcs
                                                         ? nullptr
                                                         : std::make_unique<NetworkSource>(place.nodes, driver);
    NetworkSource const* const nodes_source = place.nodes.empty() ? nullptr
                                              : own_nodes         ? own_nodes.get()
                                                                  : &arcs_source;

    Layer const arcs = choose_arcs(arcs_source, wish);
    auto const schema = choose_schema(arcs, wish);
    auto const nodes = choose_nodes(nodes_source, arcs_source, arcs, schema, wish);
    NetworkFile file;
    read_arcs(file, arcs, schema, wish, driver, notes, run);
    if (OGRLayer* const sources = arcs_source.layer("sources"); sources != nullptr && schema == Schema::native) {
        read_sources(file, {sources, arcs_source.what() + ", layer sources"}, driver, run);
    }
    take_nodes(file, nodes, arcs, arcs_source.what(), wish, driver, notes, run);
    SchemaTable const& table = table_of(schema.value_or(Schema::native));
    if (schema != Schema::native) {
        if (file.says.downstream) {
            drop_links_out(file, arcs.what, notes);
            if (wish.bridge && !file.says.ends) {
                bridge_points(file, arcs.what, notes);
            }
        }
        turn_downstream(file, table.drawn_upstream, arcs.what, notes);
    }
    if (!file.says.ends) {
        name_ends(file);
        file.says.nodes = false;
    }
    if (!file.says.nodes) {
        place_nodes(file);
    }
    if (!file.says.downstream) {
        link_by_nodes(file);
    }
    file.findings = notes.take();
    place_findings(file);
    return file;
}

} // namespace

NetworkFile read_network(std::string const& path, ReadNetworkParams const& params, Run const& run) {
    return read(path, wish_of(params), run);
}

NetworkFile read_network(std::string const& path, Run const& run) {
    return read(path, {.schema = Schema::native, .whole = true}, run);
}

} // namespace thalweg::io
