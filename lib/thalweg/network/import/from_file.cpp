// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/from_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

namespace {

using FileArc = NetworkFile::FileArc;

constexpr char const* remedy = "run thalweg check on the file; its --fix writes a mended copy";

[[noreturn]] void refuse(std::string const& fault) {
    throw BadInput("network.from_file", fmt::format("{}; {}", fault, remedy));
}

/// The file's own number of an arc.
std::int64_t number_in(NetworkFile const& file, FileArc const& arc) {
    return arc.id - file.id_shift;
}

/// Indices of the items in ascending order of their ids. Throws if an id repeats. shift: of the ids in the file.
template <class Item>
std::vector<std::size_t> by_id(std::vector<Item> const& items, char const* noun, std::int64_t shift = 0) {
    std::vector<std::size_t> order(items.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(items[i].id, i); });
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (items[order[i]].id == items[order[i - 1]].id) {
            refuse(fmt::format("several {}s have the id {}", noun, items[order[i]].id - shift));
        }
    }
    return order;
}

/// The nodes of a file: their numbers, and lookup by id.
class Nodes {
public:
    explicit Nodes(NetworkFile const& file)
        : file_(file), sorted_(by_id(file.nodes, "node")), number_(sorted_.size()), order_(sorted_) {
        for (std::size_t i = 0; i < number_.size(); ++i) {
            number_[i] = i;
        }
    }

    /// Indices of the nodes in the file, in the order of their numbers.
    std::vector<std::size_t> const& order() const { return order_; }
    /// The number of the node at an end of an arc.
    NodeId of(std::int64_t id, FileArc const& arc) const { return number_[place_of(id, arc)]; }

    /// Numbers nodes in the order in which arcs use them: ids derived from positions follow the order of features,
    /// which depends on the format.
    void number_by(std::vector<std::size_t> const& arcs) {
        constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
        std::vector<std::size_t> number(sorted_.size(), none);
        std::vector<std::size_t> order;
        auto const name = [&](std::size_t place) {
            if (number[place] == none) {
                number[place] = order.size();
                order.push_back(sorted_[place]);
            }
        };
        for (std::size_t const i : arcs) {
            name(place_of(file_.arcs[i].from_node, file_.arcs[i]));
            name(place_of(file_.arcs[i].to_node, file_.arcs[i]));
        }
        for (std::size_t place = 0; place < sorted_.size(); ++place) {
            name(place);
        }
        number_ = std::move(number);
        order_ = std::move(order);
    }

private:
    /// The position of an id among the sorted ids.
    std::size_t place_of(std::int64_t id, FileArc const& arc) const {
        auto const at = std::ranges::lower_bound(sorted_, id, {}, [&](std::size_t i) { return file_.nodes[i].id; });
        if (at == sorted_.end() || file_.nodes[*at].id != id) {
            refuse(fmt::format("arc {} names node {}, which is missing", number_in(file_, arc), id));
        }
        return static_cast<std::size_t>(at - sorted_.begin());
    }

    NetworkFile const& file_;
    std::vector<std::size_t> sorted_; ///< nodes of the file, sorted by id
    std::vector<std::size_t> number_; ///< number of the node at a position in sorted_
    std::vector<std::size_t> order_;  ///< nodes of the file, by number
};

void require_line(NetworkFile const& file, FileArc const& arc) {
    bool const heights = file.says.heights;
    double length = 0.0;
    for (std::size_t i = 0; i < arc.line.size(); ++i) {
        Vec3 const p = arc.line[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || (heights && !std::isfinite(p.z))) {
            refuse(fmt::format("vertex {} of arc {} is ({}, {}, {})", i + 1, number_in(file, arc), p.x, p.y, p.z));
        }
        length += i > 0 ? distance({arc.line[i - 1].x, arc.line[i - 1].y}, {p.x, p.y}) : 0.0;
    }
    if (!(length > 0.0)) {
        refuse(fmt::format("arc {} has no length", number_in(file, arc)));
    }
}

void require_end(NetworkFile const& file, FileArc const& arc, NetworkFile::FileNode const& node, Vec3 end) {
    bool const own_height = file.says.heights && file.says.nodes;
    bool const meets = end.x == node.at.x && end.y == node.at.y && (!own_height || end.z == node.at.z);
    if (!meets) {
        refuse(fmt::format("arc {} ends at ({}, {}, {}) but its node {} is at ({}, {}, {})", number_in(file, arc),
                           end.x, end.y, end.z, node.id, node.at.x, node.at.y, node.at.z));
    }
}

/// Checks that the arcs downstream are those of the file.
void require_downstream(NetworkFile const& file, std::vector<std::size_t> const& order, StreamNetwork const& network) {
    for (std::size_t a = 0; a < order.size(); ++a) {
        ArcId const below = network.out(network.to(a));
        std::int64_t const id = below == no_arc ? 0 : file.arcs[order[below]].id;
        if (FileArc const& arc = file.arcs[order[a]]; arc.ds_arc != id) {
            auto const named = [&](std::int64_t of) {
                return of == 0 ? std::string("none") : fmt::format("{}", of - file.id_shift);
            };
            refuse(fmt::format("arc {} says that {} is downstream of it, but its node {} leads to {}",
                               number_in(file, arc), named(arc.ds_arc), arc.to_node, named(id)));
        }
    }
}

/// Adds an arc with its heights and attributes.
void add_arc(FileArc const& arc, NetworkFile const& file, Nodes const& nodes, NetworkDraft& drawing,
             FileNetwork& made) {
    bool const heights = file.says.heights;
    require_line(file, arc);
    NodeId const from = nodes.of(arc.from_node, arc);
    NodeId const to = nodes.of(arc.to_node, arc);
    require_end(file, arc, file.nodes[nodes.order()[from]], arc.line.front());
    require_end(file, arc, file.nodes[nodes.order()[to]], arc.line.back());
    Arc drawn{{}, arc.persistence, arc.feature, arc.type, arc.is_input};
    std::vector<double> z;
    for (Vec3 const p : arc.line) {
        drawn.line.push_back({p.x, p.y});
        z.push_back(heights ? p.z : std::numeric_limits<double>::quiet_NaN());
    }
    z.front() = made.network.node_z[from];
    z.back() = made.network.node_z[to];
    drawing.add_arc(from, to, std::move(drawn));
    made.network.arc_z.push_back(std::move(z));
    made.us_area_m2.push_back(arc.us_area_m2);
    made.ds_area_m2.push_back(arc.ds_area_m2);
    made.own_area_m2.push_back(arc.own_area_m2);
    made.braided.push_back(arc.braided ? 1 : 0);
    made.arc_ids.push_back(arc.id);
    made.records.push_back(arc.record);
    made.clues.arcs.push_back(clues_of(arc));
}

/// By arc: the stretches of features it consists of.
std::vector<std::vector<Stretch>> stretches_of(NetworkFile const& file, std::vector<std::size_t> const& order,
                                               StreamNetwork const& plan) {
    std::vector<std::vector<Stretch>> stretches;
    for (std::size_t a = 0; a < order.size(); ++a) {
        FileArc const& arc = file.arcs[order[a]];
        bool const is_whole = arc.sources.empty() && arc.feature != 0;
        stretches.push_back(is_whole ? std::vector<Stretch>{{arc.feature, 0.0, plan.length_m(a)}} : arc.sources);
    }
    return stretches;
}

void require_arcs_at_nodes(NetworkFile const& file, Nodes const& nodes, StreamNetwork const& plan) {
    for (NodeId n = 0; n < plan.node_count(); ++n) {
        if (plan.out(n) == no_arc && plan.in(n).empty()) {
            refuse(fmt::format("node {} at ({}, {}) has no arc", file.nodes[nodes.order()[n]].id, plan.node(n).at.x,
                               plan.node(n).at.y));
        }
    }
}

/// The main one of arcs that leave a node.
std::size_t main_of(NetworkFile const& file, std::vector<std::size_t> const& leaving,
                    std::map<std::int64_t, std::int64_t> const& links) {
    auto const is_main = [&](std::size_t a) { return file.arcs[a].channel == Channel::main; };
    auto const is_minor = [&](std::size_t a) { return file.arcs[a].channel == Channel::minor; };
    auto const linked = std::ranges::max_element(leaving, {}, [&](std::size_t a) {
        auto const link = links.find(file.arcs[a].id);
        return link == links.end() ? 0 : link->second;
    });
    if (links.contains(file.arcs[*linked].id)) {
        return *linked;
    }
    if (auto const main = std::ranges::find_if(leaving, is_main); main != leaving.end()) {
        return *main;
    }
    auto const other = std::ranges::find_if_not(leaving, is_minor);
    return other == leaving.end() ? leaving.front() : *other;
}

} // namespace

std::pair<NetworkFile, std::int64_t> divide(NetworkFile file) {
    std::map<std::int64_t, std::vector<std::size_t>> leaving; // by node
    std::map<std::int64_t, std::int64_t> links;               // by arc: how many lead to it
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        leaving[file.arcs[a].from_node].push_back(a);
        if (file.says.downstream && file.arcs[a].ds_arc != 0) {
            ++links[file.arcs[a].ds_arc];
        }
    }
    std::map<std::int64_t, std::size_t> place; // by node
    std::int64_t next = 1;
    for (std::size_t n = 0; n < file.nodes.size(); ++n) {
        place.try_emplace(file.nodes[n].id, n);
        next = std::max(next, file.nodes[n].id + 1);
    }
    std::int64_t divided = 0;
    for (auto const& [node, arcs] : leaving) {
        auto const at = place.find(node);
        if (arcs.size() < 2 || at == place.end()) {
            continue;
        }
        std::size_t const main = main_of(file, arcs, links);
        for (std::size_t const a : arcs) {
            if (a != main) {
                NetworkFile::FileNode copy = file.nodes[at->second];
                copy.id = next++;
                file.arcs[a].from_node = copy.id;
                file.nodes.push_back(std::move(copy));
                ++divided;
            }
        }
    }
    return {std::move(file), divided};
}

StemClues::OfArc clues_of(NetworkFile::FileArc const& arc) {
    double const area_m2 = std::isnan(arc.ds_area_m2) ? 0.0 : arc.ds_area_m2;
    return {.path = arc.path, .level = arc.level, .name = arc.name, .area_m2 = area_m2, .size = arc.size};
}

FileNetwork from_file(NetworkFile const& file) {
    refuse_if<BadInput>(file.arcs.empty(), "network.from_file", "the file holds no arcs: is it the right layer?");
    bool const heights = file.says.heights;
    Nodes nodes(file);
    std::vector<std::size_t> const order = by_id(file.arcs, "arc", file.id_shift);
    if (!file.says.ends) {
        nodes.number_by(order);
    }
    FileNetwork made;
    NetworkDraft drawing;
    for (std::size_t const i : nodes.order()) {
        Vec3 const at = file.nodes[i].at;
        drawing.add_node({at.x, at.y});
        made.network.node_z.push_back(heights ? at.z : std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t const i : order) {
        add_arc(file.arcs[i], file, nodes, drawing, made);
    }
    made.network.planform = std::move(drawing);
    StreamNetwork const& plan = made.network.planform;
    made.stretches = stretches_of(file, order, plan);
    require_arcs_at_nodes(file, nodes, plan);
    try {
        require_trees(plan, "network.from_file");
    } catch (BadInput const& fault) {
        throw BadInput(fault.where(), fmt::format("{}; {}", fault.what(), remedy));
    }
    if (file.says.downstream) {
        require_downstream(file, order, plan);
    }
    return made;
}

} // namespace thalweg::network
