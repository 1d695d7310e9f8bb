// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/internal/mend_lines.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/vec.hpp>
#include <thalweg/network/import/keep_connectors.hpp>
#include <thalweg/network/vectorise/cut_loops.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>

namespace thalweg::pipeline {
namespace {

constexpr double greatest_coordinate = 1e18; // beyond, measure::check_topology takes it for none

bool is_number(double c) {
    return std::fabs(c) < greatest_coordinate;
}
/// The nodes with a place, by id and by place.
class Nodes {
public:
    explicit Nodes(NetworkFile const& file) : file_(file) {
        for (std::size_t n = 0; n < file.nodes.size(); ++n) {
            Vec3 const at = file.nodes[n].at;
            if (is_number(at.x) && is_number(at.y)) {
                by_id_.emplace_back(file.nodes[n].id, n);
                by_place_.emplace_back(at.x, at.y);
            }
        }
        std::sort(by_id_.begin(), by_id_.end());
        std::sort(by_place_.begin(), by_place_.end());
    }
    /// The first of that id, null for none.
    Vec3 const* of(std::int64_t id) const {
        auto const found = std::lower_bound(by_id_.begin(), by_id_.end(), std::pair(id, std::size_t{0}));
        return found == by_id_.end() || found->first != id ? nullptr : &file_.nodes[found->second].at;
    }
    bool lies_at(Vec3 p) const { return std::binary_search(by_place_.begin(), by_place_.end(), std::pair(p.x, p.y)); }

private:
    NetworkFile const& file_;
    std::vector<std::pair<std::int64_t, std::size_t>> by_id_;
    std::vector<std::pair<double, double>> by_place_;
};

/// Heights that are none become those of the way between their neighbours; at the ends those of the node, if it has
/// one, else of the neighbour.
void fill_heights(std::vector<Vec3>& line, Vec3 const* first, Vec3 const* last) {
    auto const take = [](Vec3& end, Vec3 const* node) {
        if (!is_number(end.z) && node != nullptr && is_number(node->z)) {
            end.z = node->z;
        }
    };
    take(line.front(), first);
    take(line.back(), last);
    std::size_t const size = line.size();
    std::size_t known = size; // the last vertex with a height
    for (std::size_t i = 0; i < size; ++i) {
        if (!is_number(line[i].z)) {
            continue;
        }
        for (std::size_t j = known == size ? 0 : known + 1; j < i; ++j) {
            double const share = known == size ? 1.0 : static_cast<double>(j - known) / static_cast<double>(i - known);
            double const from = known == size ? line[i].z : line[known].z;
            line[j].z = from + share * (line[i].z - from);
        }
        known = i;
    }
    for (std::size_t j = known == size ? 0 : known + 1; j < size; ++j) {
        line[j].z = known == size ? 0.0 : line[known].z;
    }
}

class LineMender {
public:
    LineMender(NetworkFile const& file, measure::TopologyReport const& found, double near_m)
        : file_(file), found_(found), nodes_(file), near_m_(near_m) {
        for (Finding const& f : found.findings) {
            if (f.kind == "spike" || f.kind == "self_touching") {
                looped_.insert(f.feature);
            }
        }
    }

    void mend(std::size_t a) {
        auto const& arc = file_.arcs[a];
        std::int64_t const number = number_of(arc);
        int runs = arc.runs;
        auto line = numbers_of(arc);
        Vec3 const* from = nodes_.of(arc.from_node);
        Vec3 const* to = nodes_.of(arc.to_node);
        bool const named_back = is_named_back(line, from, to);
        if (named_back) {
            std::swap(from, to);
        }
        if (length_in_plan(line) <= 0.0) {
            if (from == nullptr || to == nullptr || plan(*from) == plan(*to)) {
                say("left_out", number, line.empty() ? Vec2{} : plan(line.front()), 0.0,
                    fmt::format("arc {}: has no length and joins no two nodes; it is left out", number));
                return;
            }
            line = {*from, *to};
            say("drawn", number, plan(*from), length_in_plan(line),
                fmt::format("arc {}: has no line; it is drawn straight from node {} to node {}", number, arc.from_node,
                            arc.to_node));
        } else {
            put_onto(from, line.front(), number);
            put_onto(to, line.back(), number);
        }
        fill_heights(line, from, to);
        if (arc.is_channel) {
            RiverLine& channel = result_.rivers.channels.emplace_back();
            channel = {arc.id, std::move(line), arc.type, arc.rank};
            channel.artificial = arc.unnatural;
            channel.id_shift = file_.id_shift;
            arc_of_channel_.try_emplace(arc.id, a);
            return;
        }
        if (!arc.unnatural.empty()) {
            put_aside(arc.id, std::move(line), arc.unnatural);
            return;
        }
        if (found_.upstream[a] != 0) {
            std::reverse(line.begin(), line.end());
            runs = -runs;
            say("turned", number, plan(line.front()), length_in_plan(line),
                fmt::format("arc {}: is reversed to run downstream", number));
        }
        if (looped_.contains(number)) {
            network::CutLine cut = network::cut_loops(line, near_m_);
            if (length_in_plan(cut.line) <= 0.0) {
                put_aside(arc.id, std::move(line), "closed ring");
                return;
            }
            line = std::move(cut.line);
            say("cut", number, plan(line.front()), cut.cut_m,
                fmt::format("arc {}: loops and spikes of {} m are cut off", number, cut.cut_m));
        }
        std::int64_t const ds_arc = file_.says.downstream ? arc.ds_arc : 0; // else told by places alone
        result_.rivers.lines.push_back({arc.id,
                                        std::move(line),
                                        arc.type,
                                        arc.rank,
                                        0,
                                        ds_arc,
                                        arc.size,
                                        arc.channel,
                                        arc.name,
                                        {},
                                        file_.id_shift,
                                        runs});
        result_.arcs.push_back(a);
    }

    MendedLines finish() {
        result_.rivers = network::keep_connectors(std::move(result_.rivers), near_m_);
        for (std::size_t l = result_.arcs.size(); l < result_.rivers.lines.size(); ++l) {
            result_.arcs.push_back(arc_of_channel_.at(result_.rivers.lines[l].feature));
        }
        for (SecondaryLine& line : std::exchange(result_.rivers.secondary, {})) {
            put_aside(line.feature, std::move(line.vertices), line.reason);
        }
        append(result_.mended, std::exchange(result_.rivers.findings, {}));
        result_.rivers.crs = file_.crs;
        result_.rivers.name = "the network";
        result_.rivers.has_z = true;
        return std::move(result_);
    }

private:
    void say(char const* kind, std::int64_t feature, Vec2 at, double amount, std::string text) {
        result_.mended.push_back({kind, feature, at, amount, std::move(text)});
    }

    /// By which the file itself calls an arc.
    std::int64_t number_of(NetworkFile::FileArc const& arc) const { return arc.id - file_.id_shift; }

    void put_aside(std::int64_t id, std::vector<Vec3> line, std::string const& reason) {
        std::int64_t const number = id - file_.id_shift;
        say("secondary", number, plan(line.front()), length_in_plan(line),
            fmt::format("arc {}: is not a river: {}", number, reason));
        result_.secondary.push_back({id, std::move(line), reason});
    }

    std::vector<Vec3> numbers_of(NetworkFile::FileArc const& arc) {
        std::vector<Vec3> line;
        std::size_t without_height = 0;
        for (Vec3 const p : arc.line) {
            if (is_number(p.x) && is_number(p.y)) {
                without_height += is_number(p.z) ? 0 : 1;
                line.push_back({p.x, p.y, file_.says.heights ? p.z : 0.0});
            }
        }
        std::size_t const lost = arc.line.size() - line.size();
        if (lost > 0) {
            say("left_out", number_of(arc), line.empty() ? Vec2{} : plan(line.front()), static_cast<double>(lost),
                fmt::format("arc {}: {} vertices without finite coordinates are left out", number_of(arc), lost));
        }
        if (without_height > 0 && file_.says.heights) {
            say("level", number_of(arc), plan(line.front()), static_cast<double>(without_height),
                fmt::format("arc {}: {} vertices without a height are interpolated between their neighbours",
                            number_of(arc), without_height));
        }
        return line;
    }

    /// The line runs from to_node to from_node: which of both is wrong, upstream tells.
    static bool is_named_back(std::vector<Vec3> const& line, Vec3 const* from, Vec3 const* to) {
        return from != nullptr && to != nullptr && !line.empty() && plan(*from) != plan(*to) &&
               plan(line.front()) == plan(*to) && plan(line.back()) == plan(*from);
    }

    /// An end that lies where there is no node belongs to its own.
    void put_onto(Vec3 const* node, Vec3& end, std::int64_t id) {
        if (node == nullptr || plan(*node) == plan(end) || nodes_.lies_at(end)) {
            return;
        }
        say("moved", id, plan(*node), distance(plan(*node), plan(end)),
            fmt::format("arc {}: its end at ({}, {}) is put onto its node at ({}, {})", id, end.x, end.y, node->x,
                        node->y));
        end = {node->x, node->y, is_number(node->z) ? node->z : end.z};
    }

    NetworkFile const& file_;
    measure::TopologyReport const& found_;
    Nodes nodes_;
    double near_m_;
    std::set<std::int64_t> looped_ = {};
    std::map<std::int64_t, std::size_t> arc_of_channel_ = {}; ///< by arc_id, the first that has it
    MendedLines result_ = {};
};

} // namespace

MendedLines mend_lines(NetworkFile const& file, measure::TopologyReport const& found, double near_m) {
    LineMender mender(file, found, near_m);
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        mender.mend(a);
    }
    return mender.finish();
}

} // namespace thalweg::pipeline
