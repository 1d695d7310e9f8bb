// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

// Arcs and their nodes: what the file says, what the places say, and which way the water runs.
namespace thalweg::measure::topology_steps {

namespace {

Junctions junctions_of(NetworkFile const& file) {
    Junctions j;
    j.ids.reserve(file.nodes.size() + 2 * file.arcs.size());
    for (FileNode const& node : file.nodes) {
        j.ids.push_back(node.id);
    }
    for (FileArc const& arc : file.arcs) {
        j.ids.push_back(arc.from_node);
        j.ids.push_back(arc.to_node);
    }
    std::sort(j.ids.begin(), j.ids.end());
    j.ids.erase(std::unique(j.ids.begin(), j.ids.end()), j.ids.end());
    j.ids.shrink_to_fit();
    j.node.assign(j.ids.size(), none);
    j.repeated.assign(j.ids.size(), 0);
    for (std::size_t n = 0; n < file.nodes.size(); ++n) {
        std::size_t const at = j.of(file.nodes[n].id);
        j.repeated[at] = j.node[at] != none ? 1 : 0;
        j.node[at] = std::min(j.node[at], n);
    }
    return j;
}

/// Nodes by where they lie: asked only where the file's word is at fault.
class NodePlaces {
public:
    NodePlaces(NetworkFile const& file, Junctions const& junctions) : file_(file), junctions_(junctions) {}

    /// The junction of a node exactly there, none where no node lies; of several, preferred if it is one of them.
    std::size_t at(Vec2 p, std::size_t preferred) {
        if (by_place_.empty()) {
            for (FileNode const& node : file_.nodes) {
                if (is_number(node.at.x) && is_number(node.at.y)) {
                    by_place_.emplace_back(node.at.x, node.at.y, junctions_.of(node.id));
                }
            }
            std::sort(by_place_.begin(), by_place_.end());
        }
        std::size_t found = none;
        for (auto i = std::lower_bound(by_place_.begin(), by_place_.end(), std::tuple(p.x, p.y, std::size_t{0}));
             i != by_place_.end() && std::get<0>(*i) == p.x && std::get<1>(*i) == p.y; ++i) {
            found = found == none || std::get<2>(*i) == preferred ? std::get<2>(*i) : found;
        }
        return found;
    }

private:
    NetworkFile const& file_;
    Junctions const& junctions_;
    std::vector<std::tuple<double, double, std::size_t>> by_place_;
};

bool same_bits(Vec3 p, Vec3 q, bool heights) {
    auto const same = [](double a, double b) {
        return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    return same(p.x, q.x) && same(p.y, q.y) && (!heights || same(p.z, q.z));
}

class EndCheck {
public:
    EndCheck(NetworkFile const& file, Joints& joints, Findings& findings)
        : file_(file), joints_(joints), findings_(findings), places_(file, joints.junctions) {}

    void look(std::size_t a, bool has_line) {
        FileArc const& arc = file_.arcs[a];
        bool const against = has_line && is_against(arc, joints_.said[a]);
        joints_.against[a] = against ? 1 : 0;
        for (std::size_t const end : {0U, 1U}) {
            bool const first = (end == 0) != against;
            Vec2 const start = start_of(arc);
            Vec3 const place = !has_line ? Vec3{start.x, start.y, 0.0} : first ? arc.line.front() : arc.line.back();
            joints_.meant[a][end] = look(a, end, place, has_line);
        }
    }

private:
    FileNode const* node(std::size_t junction) const {
        std::size_t const n = joints_.junctions.node[junction];
        return n == none ? nullptr : &file_.nodes[n];
    }

    bool is_against(FileArc const& arc, Ends ends) const {
        FileNode const* const from = node(ends[0]);
        FileNode const* const to = node(ends[1]);
        return from != nullptr && to != nullptr && plan_of(from->at) != plan_of(to->at) &&
               plan_of(arc.line.front()) == plan_of(to->at) && plan_of(arc.line.back()) == plan_of(from->at);
    }

    /// The junction in which the end is meant to be.
    std::size_t look(std::size_t a, std::size_t end, Vec3 place, bool has_line) {
        FileArc const& arc = file_.arcs[a];
        std::size_t const said = joints_.said[a][end];
        std::int64_t const id = joints_.junctions.ids[said];
        char const* const which = end == 0 ? "from_node" : "to_node";
        FileNode const* const there = node(said);
        if (there == nullptr) {
            std::size_t const meant = has_line ? places_.at(plan_of(place), said) : none;
            bool const named_already = meant != none && joints_.junctions.repeated[meant] != 0;
            joints_.faulty[a][end] = 1;
            if (named_already) {
                return said; // the arcs of a node that bears another's name still agree on its own
            }
            findings_.push_back(
                {"missing_node", number_of(file_, arc), plan_of(place), static_cast<double>(id),
                 fmt::format("arc {}: its {} {} is not among the nodes", number_of(file_, arc), which, id)});
            return meant == none ? said : meant;
        }
        if (!has_line || !is_number(there->at.x) || !is_number(there->at.y) ||
            (file_.says.heights && !is_number(there->at.z)) || same_bits(place, there->at, file_.says.heights)) {
            return said;
        }
        std::size_t const meant = places_.at(plan_of(place), said);
        if (meant == said && joints_.junctions.repeated[said] != 0) {
            return said;
        }
        double const dz = file_.says.heights ? place.z - there->at.z : 0.0;
        double const flat = distance(plan_of(place), plan_of(there->at));
        double const apart = std::sqrt(flat * flat + dz * dz);
        joints_.faulty[a][end] = 1;
        findings_.push_back(
            {"end_mismatch", number_of(file_, arc), plan_of(place), apart,
             fmt::format("arc {}: its end at ({}, {}, {}) lies {} m from {} {} at ({}, {}, {})", number_of(file_, arc),
                         place.x, place.y, place.z, apart, which, id, there->at.x, there->at.y, there->at.z)});
        return meant == none ? said : meant;
    }

    NetworkFile const& file_;
    Joints& joints_;
    Findings& findings_;
    NodePlaces places_;
};

/// By arc: whether the arcs that ds_arc links to it all say that it flows from its meant[1] to its meant[0].
std::vector<char> turned_by_links(NetworkFile const& file, std::vector<Ends> const& meant,
                                  std::vector<char> const& left_out, std::vector<char> const& ambiguous) {
    std::vector<char> turned(file.arcs.size(), 0);
    if (!file.says.downstream) {
        return turned;
    }
    std::vector<std::pair<std::int64_t, std::size_t>> ids;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (ambiguous[a] == 0 && left_out[a] == 0) {
            ids.emplace_back(file.arcs[a].id, a);
        }
    }
    std::sort(ids.begin(), ids.end());
    std::vector<std::array<bool, 2>> votes(file.arcs.size(), {false, false}); // runs as said, against it
    for (std::size_t up = 0; up < file.arcs.size(); ++up) {
        auto const next = std::lower_bound(ids.begin(), ids.end(), std::pair(file.arcs[up].ds_arc, std::size_t{0}));
        if (left_out[up] != 0 || next == ids.end() || next->first != file.arcs[up].ds_arc || next->second == up) {
            continue;
        }
        std::size_t const down = next->second;
        auto const touches = [&](std::size_t arc, std::size_t junction) {
            return meant[arc][0] == junction || meant[arc][1] == junction;
        };
        bool const up_by_its_end = touches(down, meant[up][1]);
        bool const up_by_its_start = touches(down, meant[up][0]);
        if (up_by_its_end != up_by_its_start) {
            votes[up][up_by_its_end ? 0 : 1] = true;
        }
        bool const down_by_its_start = touches(up, meant[down][0]);
        bool const down_by_its_end = touches(up, meant[down][1]);
        if (down_by_its_start != down_by_its_end) {
            votes[down][down_by_its_start ? 0 : 1] = true;
        }
    }
    for (std::size_t a = 0; a < turned.size(); ++a) {
        turned[a] = votes[a][1] && !votes[a][0] ? 1 : 0;
    }
    return turned;
}

} // namespace

std::size_t Junctions::of(std::int64_t id) const {
    return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

Joints check_ends(NetworkFile const& file, Plans const& plans, std::vector<char> const& left_out,
                  std::vector<char> const& ambiguous, Findings& findings) {
    std::size_t const arcs = file.arcs.size();
    Joints joints{junctions_of(file), {}, {}, std::vector<std::array<char, 2>>(arcs, {0, 0}), std::vector<char>(arcs)};
    joints.said.reserve(arcs);
    for (FileArc const& arc : file.arcs) {
        joints.said.push_back({joints.junctions.of(arc.from_node), joints.junctions.of(arc.to_node)});
    }
    joints.meant = joints.said;
    EndCheck check(file, joints, findings);
    for (std::size_t a = 0; a < arcs; ++a) {
        check.look(a, !plans[a].empty());
    }
    auto const turned = turned_by_links(file, joints.meant, left_out, ambiguous);
    for (std::size_t a = 0; a < arcs; ++a) {
        if (left_out[a] == 0 && (turned[a] != 0 || joints.against[a] != 0)) {
            FileArc const& arc = file.arcs[a];
            findings.push_back({"wrong_direction", number_of(file, arc), start_of(arc), length_of(plans[a]),
                                turned[a] == 0
                                    ? fmt::format("arc {}: is drawn from its to_node {} to its from_node {}",
                                                  number_of(file, arc), arc.to_node, arc.from_node)
                                    : fmt::format("arc {}: is said to run from node {} to {}, against the arcs that "
                                                  "ds_arc links it to",
                                                  number_of(file, arc), arc.from_node, arc.to_node)});
        }
        if (turned[a] != 0) {
            std::swap(joints.said[a][0], joints.said[a][1]);
            std::swap(joints.meant[a][0], joints.meant[a][1]);
            std::swap(joints.faulty[a][0], joints.faulty[a][1]);
            joints.against[a] = joints.against[a] == 0 ? 1 : 0;
        }
    }
    return joints;
}

void check_heights(NetworkFile const& file, Plans const& plans, std::vector<char> const& left_out, Joints const& joints,
                   Findings& findings) {
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        if (!file.says.heights || left_out[a] != 0 || plans[a].empty()) {
            continue;
        }
        auto const& line = file.arcs[a].line;
        double greatest_rise = 0.0;
        std::size_t rises_at = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const rise = joints.against[a] == 0 ? line[i].z - line[i - 1].z : line[i - 1].z - line[i].z;
            if (rise > greatest_rise) {
                greatest_rise = rise;
                rises_at = joints.against[a] == 0 ? i : i - 1;
            }
        }
        if (greatest_rise > 0.0) {
            Vec2 const at = plan_of(line[rises_at]);
            findings.push_back({"z_rising", number_of(file, file.arcs[a]), at, greatest_rise,
                                fmt::format("arc {}: runs uphill by {} m to vertex {} at ({}, {})",
                                            number_of(file, file.arcs[a]), greatest_rise, rises_at, at.x, at.y)});
        }
    }
}

} // namespace thalweg::measure::topology_steps
