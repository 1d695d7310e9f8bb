// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

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

// Null when none has the number.
FileArc const* find(NetworkFile const& file, std::vector<Named> const& named, std::int64_t number) {
    auto const found = std::ranges::lower_bound(named, number, {}, &Named::first);
    return found != named.end() && found->first == number ? &file.arcs[found->second] : nullptr;
}

std::vector<Named> by_id(NetworkFile const& file) {
    return by_number(file.arcs.size(), [&](std::size_t i) { return file.arcs[i].id; });
}

// Bits order every place, NaN among them; 0 and -0 are one.
std::uint64_t bits(double v) {
    return std::bit_cast<std::uint64_t>(v + 0.0);
}

/// Makes an outlet of each arc whose ds_arc the file does not hold: an extract ends there. Its basins do not count
/// then.
void drop_links_out(NetworkFile& file, About const& about, Notes& notes) {
    auto const ids = by_id(file);
    for (FileArc& arc : file.arcs) {
        if (arc.ds_arc == 0 || find(file, ids, arc.ds_arc) != nullptr) {
            continue;
        }
        std::int64_t const below = arc.ds_arc < 0 ? -arc.ds_arc : arc.ds_arc - file.id_shift;
        std::int64_t const id = arc.id - file.id_shift;
        notes.add(about, "cut_below", id, static_cast<double>(below),
                  fmt::format("arc {} flows into {}, which is not in the file: treated as an outlet", id, below));
        file.says.basin = false; // those of outlets beyond
        arc.ds_arc = 0;
    }
}

/// Reverses all lines when more linked arcs are drawn up than down; with as many of both, when drawn_upstream.
void turn_downstream(NetworkFile& file, bool drawn_upstream, About const& about, Notes& notes) {
    auto const ids = by_id(file);
    std::size_t down = 0;
    std::size_t up = 0;
    for (FileArc const& arc : file.arcs) {
        FileArc const* const below = find(file, ids, arc.ds_arc);
        if (below != nullptr && !arc.line.empty() && !below->line.empty()) {
            down += in_plan(arc.line.back()) == in_plan(below->line.front()) ? 1U : 0U;
            up += in_plan(arc.line.front()) == in_plan(below->line.back()) ? 1U : 0U;
        }
    }
    bool const upstream = up == down ? drawn_upstream : up > down;
    if (upstream) {
        for (FileArc& arc : file.arcs) {
            std::ranges::reverse(arc.line);
            arc.runs = -arc.runs;
        }
    }
    if (upstream != drawn_upstream) {
        notes.add(about, "turned", 0, static_cast<double>(file.arcs.size()),
                  fmt::format("most lines are drawn {}, against this schema: all {} were {}",
                              upstream ? "upstream" : "downstream", file.arcs.size(),
                              upstream ? "reversed" : "left as they are drawn"));
    }
}

/// Makes a node for each place in plan where an arc begins or ends, from 1 in the order of the arcs, and sets from_node
/// and to_node; arcs without vertices have none (0).
void name_ends(NetworkFile& file) {
    std::map<std::array<std::uint64_t, 2>, std::int64_t> nodes; // by place
    auto const node_at = [&](Vec3 const& p) {
        std::int64_t const next = static_cast<std::int64_t>(nodes.size()) + 1;
        return nodes.try_emplace({bits(p.x), bits(p.y)}, next).first->second;
    };
    for (FileArc& arc : file.arcs) {
        arc.from_node = arc.line.empty() ? 0 : node_at(arc.line.front());
        arc.to_node = arc.line.empty() ? 0 : node_at(arc.line.back());
    }
}

/// Makes a node for each id in from_node and to_node but 0, where most ends of that id are.
void place_nodes(NetworkFile& file) {
    struct Claim {
        std::size_t ends = 0;
        std::size_t first = 0; // of them, in the order of the arcs
        Vec3 at;
    };
    std::map<std::pair<std::int64_t, std::array<std::uint64_t, 3>>, Claim> claims; // by node and place
    std::size_t ends = 0;
    auto const claim = [&](std::int64_t node, Vec3 const& p) {
        if (node != 0) {
            ++claims.try_emplace({node, {bits(p.x), bits(p.y), bits(p.z)}}, Claim{0, ends++, p}).first->second.ends;
        }
    };
    for (FileArc const& arc : file.arcs) {
        if (!arc.line.empty()) {
            claim(arc.from_node, arc.line.front());
            claim(arc.to_node, arc.line.back());
        }
    }
    file.nodes.clear();
    Claim best; // of the last node
    for (auto const& [key, place] : claims) {
        bool const is_new = file.nodes.empty() || file.nodes.back().id != key.first;
        if (is_new) {
            file.nodes.push_back({key.first, place.at});
        }
        if (is_new || place.ends > best.ends || (place.ends == best.ends && place.first < best.first)) {
            file.nodes.back().at = place.at;
            best = place;
        }
    }
}

/// Sets ds_arc to the first arc that begins at the arc's end.
void link_by_nodes(NetworkFile& file) {
    auto const beginning = by_number(file.arcs.size(), [&](std::size_t i) { return file.arcs[i].from_node; });
    for (FileArc& arc : file.arcs) {
        FileArc const* const below = arc.to_node == 0 ? nullptr : find(file, beginning, arc.to_node);
        arc.ds_arc = below == nullptr ? 0 : below->id;
    }
}

// Leaves out arcs whose vertices all lie at one place: arcs that flow into one flow into what is downstream of it.
// Their Strahler numbers are then those of two streams after another, not of all that meet.
void bridge_points(NetworkFile& file, About const& about, Notes& notes) {
    std::map<std::int64_t, std::int64_t> below; // of an arc without length the arc downstream
    for (FileArc const& arc : file.arcs) {
        bool const is_point = !arc.line.empty() && std::ranges::all_of(arc.line, [&](Vec3 const& p) {
            return in_plan(p) == in_plan(arc.line.front());
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
    for (auto const& [bridged, down] : below) {
        std::int64_t const id = bridged - file.id_shift;
        std::int64_t const next = next_of(down) == 0 ? 0 : next_of(down) - file.id_shift;
        notes.add(about, "bridged", id, static_cast<double>(next),
                  fmt::format("arc {} has no length: what flows into it {}", id,
                              next_of(down) == 0 ? "ends there" : fmt::format("flows into arc {}", next)));
    }
    file.says.strahler = false;
}

// Sets where the findings that name an arc are: where it begins.
void place_findings(NetworkFile& file) {
    auto const ids = by_id(file);
    for (Finding& finding : file.findings) {
        FileArc const* const arc = find(file, ids, finding.feature + file.id_shift);
        if (finding.feature != 0 && arc != nullptr && !arc->line.empty()) {
            finding.where = in_plan(arc->line.front());
        }
    }
}

Wish wish_of(ReadNetworkParams const& params) {
    Wish wish{params};
    std::vector<std::string> names{"node_id"};
    for (std::size_t q = 0; q < static_cast<std::size_t>(Quantity::constant); ++q) {
        names.emplace_back(name_of(static_cast<Quantity>(q)));
    }
    for (auto const& [quantity, field] : params.fields) {
        auto const known = quantity_of(quantity);
        refuse_if<BadInput>(!known && quantity != "node_id", "io.read_network",
                            "'{}' is not a quantity of the network schema.{} ({})", quantity,
                            did_you_mean(quantity, names), listed(names));
        (known ? wish.columns[*known] : wish.node_id) = field;
    }
    return wish;
}

/// Converts heights into metres, from the unit that the layer of arcs names.
void convert_heights(NetworkFile& file, Layer const& arcs, Wish const& wish, Notes& notes) {
    double const unit = height_unit_of(*arcs.layer, wish.source_crs);
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
    if (unit != 1.0 && !wish.whole) {
        notes.add(arcs.about, "heights_converted", 0, unit,
                  fmt::format("its heights, in {}, were converted into metres", words_for_unit(unit)));
    }
}

void reproject_to_metres(NetworkFile& file, Layer const& arcs, std::optional<Layer> const& nodes, Wish const& wish,
                         Notes& notes, Run const& run) {
    OGRSpatialReference const own = crs_of_layer(arcs.layer->GetSpatialRef(), wish.source_crs);
    bool const has_none = own.IsEmpty() != 0;
    if (nodes) {
        OGRSpatialReference const other = crs_of_layer(nodes->layer->GetSpatialRef(), wish.source_crs);
        refuse_if<BadInput>(!has_none && other.IsEmpty() == 0 && own.IsSame(&other) == FALSE &&
                                name_of(own) != name_of(other),
                            arcs.about.where, "{} is in {} and layer {} in {}: reproject both to one CRS",
                            arcs.about.name, own.GetName(), nodes->layer->GetName(), other.GetName());
    }
    bool const native = file.schema == "native";
    if (has_none) {
        if (!native) {
            notes.add(arcs.about, "no_crs", 0, 0.0, "no CRS: its coordinates are treated as metres");
        }
        return;
    }
    FilePlaces places;
    for (FileArc const& arc : file.arcs) {
        for (Vec3 const& p : arc.line) {
            if (is_finite(in_plan(p))) {
                places.add(p.x, p.y);
            }
        }
    }
    if (!places.any()) {
        file.crs = name_of(own);
        return;
    }
    std::string const& name = arcs.about.name;
    // A network in the native schema has the CRS that its maker chose.
    IntoMetres const metres(own, wish.crs, places.box(), name, native ? OwnMetres::kept : OwnMetres::judged);
    file.crs = metres.crs();
    if (auto const doubt = degrees_as_metres(own, places.box(), name); doubt && !wish.whole) {
        notes.add(arcs.about, *doubt);
    }
    if (!metres.moves()) {
        return;
    }
    auto const move = [&](std::span<Vec3> points) {
        auto const done = metres.apply(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (done[i] == 0) {
                points[i] = {nan, nan, points[i].z}; // for the check to find
            }
        }
    };
    for (FileArc& arc : file.arcs) {
        run.check();
        move(arc.line);
        NetworkFile::ArcColumns& columns = arc.columns; // of another projection
        columns.length_m = columns.length_3d_m = columns.straight_m = columns.dist_out_m = columns.slope = nan;
    }
    for (NetworkFile::FileNode& node : file.nodes) {
        move({&node.at, 1});
        node.columns.dist_out_m = nan;
    }
    notes.add(arcs.about, "reprojected", 0, 0.0,
              fmt::format("its coordinates were reprojected from {} to {}", own.GetName(), in_message(file.crs)));
}

NetworkFile read(std::string const& path, Wish const& wish, Run const& run) {
    Driver const driver;
    NetworkPlace const place = find_network(path, wish.whole);
    Notes notes(wish.whole);
    NetworkSource const source = open_network(place.arcs, driver);
    bool const together = place.nodes.empty() || place.nodes == place.arcs;
    NetworkSource const own_nodes = together ? NetworkSource() : open_network(place.nodes, driver);
    NetworkSource const* const nodes_source = place.nodes.empty() ? nullptr : together ? &source : &own_nodes;

    Layer const arcs = choose_arcs(source, wish);
    auto const schema = choose_schema(arcs, wish);
    auto const nodes = choose_nodes(nodes_source, source, arcs, schema, wish);
    NetworkFile file;
    read_arcs(file, arcs, schema, wish, driver, notes, run);
    OGRLayer* const sources = schema == Schema::native ? source.dataset->GetLayerByName("sources") : nullptr;
    if (sources != nullptr) {
        read_sources(file, {sources, {source.about.where, source.about.name + ", layer sources"}}, driver, run);
    }
    if (nodes) {
        read_nodes(file, *nodes, wish.node_id, driver, notes, run);
    } else if (schema == Schema::native) {
        notes.add(source.about, "missing_nodes", 0, 0.0, "has no layer nodes");
    }
    convert_heights(file, arcs, wish, notes);
    reproject_to_metres(file, arcs, nodes, wish, notes, run);
    if (!arcs.read_from.empty() && wish.arcs_layer.empty() && !wish.whole) {
        for (Finding const& others :
             layers_not_read(*source.dataset, arcs.read_from, file.crs, wish.source_crs,
                             {source.about.where, std::filesystem::path(place.arcs).filename().string()})) {
            notes.add(arcs.about, others);
        }
    }
    if (schema != Schema::native) {
        if (file.says.downstream) {
            drop_links_out(file, arcs.about, notes);
            if (wish.bridge && !file.says.ends) {
                bridge_points(file, arcs.about, notes);
            }
        }
        turn_downstream(file, table_of(schema.value_or(Schema::native)).drawn_upstream, arcs.about, notes);
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

void link_by_keys(NetworkFile& file, std::vector<std::int64_t> const& keys, std::vector<std::int64_t> const& ds_keys) {
    auto const by_key = by_number(keys.size(), [&](std::size_t i) { return keys[i]; });
    for (std::size_t i = 0; i < file.arcs.size(); ++i) {
        FileArc const* const below = ds_keys[i] == 0 ? nullptr : find(file, by_key, ds_keys[i]);
        file.arcs[i].ds_arc = below == nullptr ? -ds_keys[i] : below->id;
    }
}

NetworkFile read_network(std::string const& path, ReadNetworkParams const& params, Run const& run) {
    return read(path, wish_of(params), run);
}

NetworkFile read_network(std::string const& path, Run const& run) {
    Wish wish{{.schema = Schema::native}};
    wish.whole = true;
    return read(path, wish, run);
}

} // namespace thalweg::io
