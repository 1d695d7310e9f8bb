// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/internal/repair_network.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/make/given.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/choose_cell.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/import/river_heights.hpp>
#include <thalweg/network/order/main_stems.hpp>
#include <thalweg/network/order/order.hpp>

namespace thalweg::commands {
namespace {

struct RepairedLines {
    RiverLines rivers;                         // in the direction of flow, feature = arc_id
    std::vector<std::size_t> arcs;             // by river: number of its arc in the file
    std::vector<SecondaryLine> secondary = {}; // arcs that are not natural watercourses, feature = arc_id
    std::vector<Finding> mended;
};

constexpr double greatest_coordinate = 1e18; // beyond this, measure::check_topology rejects coordinates

bool is_number(double c) {
    return std::fabs(c) < greatest_coordinate;
}

/// The nodes with positions, by id and by position.
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
    /// \return the first with that id; null: none.
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

/// Whether every vertex of a file has a height, and not all the same.
bool heights_tell_directions(NetworkFile const& file) {
    double low = greatest_coordinate;
    double high = -greatest_coordinate;
    for (auto const& arc : file.arcs) {
        for (Vec3 const p : arc.line) {
            if (!is_number(p.z)) {
                return false;
            }
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    }
    return file.says.heights && low < high;
}

/// What decides the directions of a file's lines. Where no schema says how they are drawn, heights do, as for make.
network::Orientation orientation_of(NetworkFile const& file) {
    bool const by_height = file.schema == "lines" && heights_tell_directions(file);
    return file.schema == "native" ? network::Orientation::least_turned
           : by_height             ? network::Orientation::automatic
                                   : network::Orientation::links;
}

/// Replaces missing heights by interpolation between neighbours; at the ends by the node's, if it has one, else by the
/// neighbour's.
void fill_line(std::vector<Vec3>& line, Vec3 const* first, Vec3 const* last) {
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

class LineRepairer {
public:
    LineRepairer(NetworkFile const& file, measure::TopologyReport const& found, double near_m)
        : file_(file), found_(found), nodes_(file), near_m_(near_m) {
        for (Finding const& f : found.findings) {
            if (f.kind == FindingKind("spike") || f.kind == FindingKind("self_touching")) {
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
        if (!reach_ends(line, arc, from, to)) {
            return;
        }
        fill_line(line, from, to);
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
            say("turned", number, in_plan(line.front()), length_in_plan(line),
                fmt::format("arc {}: is reversed to run downstream", number));
        }
        if (looped_.contains(number)) {
            network::CutLine cut = network::cut_loops(line, near_m_);
            if (length_in_plan(cut.line) <= 0.0) {
                put_aside(arc.id, std::move(line), "closed ring");
                return;
            }
            line = std::move(cut.line);
            say("cut", number, in_plan(line.front()), cut.cut_m,
                fmt::format("arc {}: loops and spikes of {} m are cut off", number, cut.cut_m));
        }
        std::int64_t const ds_arc = file_.says.downstream ? arc.ds_arc : 0; // otherwise derived from positions alone
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

    RepairedLines finish() {
        if (file_.says.heights && file_.schema != "native") {
            remove_placeholders();
        }
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
    void say(FindingKind kind, std::int64_t feature, Vec2 at, double amount, std::string text) {
        result_.mended.push_back({kind, feature, at, amount, std::move(text)});
    }

    void remove_placeholders() {
        network::WithoutPlaceholders checked = network::without_placeholders(std::move(result_.rivers));
        result_.rivers = std::move(checked.lines);
        if (checked.vertices > 0) {
            std::int64_t const number = checked.first - file_.id_shift;
            say("level", number, checked.at, static_cast<double>(checked.vertices),
                fmt::format("arc {}: heights of {} count as missing and are interpolated ({} in all, the first at "
                            "({}, {}))",
                            number, checked.zeros > 0 ? "0" : "-9999 m", checked.vertices, checked.at.x, checked.at.y));
            result_.rivers = network::with_all_heights(std::move(result_.rivers), recipe::NetworkRecipe{}.slope);
            for (RiverLine& line : result_.rivers.lines) {
                fill_line(line.vertices, nullptr, nullptr); // with 0 where the file has none but placeholders
            }
        }
    }

    /// The file's own number of an arc.
    std::int64_t number_of(NetworkFile::FileArc const& arc) const { return arc.id - file_.id_shift; }

    void put_aside(std::int64_t id, std::vector<Vec3> line, std::string const& reason) {
        std::int64_t const number = id - file_.id_shift;
        say("secondary", number, in_plan(line.front()), length_in_plan(line),
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
            say("left_out", number_of(arc), line.empty() ? Vec2{} : in_plan(line.front()), static_cast<double>(lost),
                fmt::format("arc {}: {} vertices without finite coordinates are left out", number_of(arc), lost));
        }
        if (without_height > 0 && file_.says.heights) {
            say("level", number_of(arc), in_plan(line.front()), static_cast<double>(without_height),
                fmt::format("arc {}: {} vertices without a height are interpolated between their neighbours",
                            number_of(arc), without_height));
        }
        return line;
    }

    /// The line runs from to_node to from_node: `upstream` decides which of the two is wrong.
    static bool is_named_back(std::vector<Vec3> const& line, Vec3 const* from, Vec3 const* to) {
        return from != nullptr && to != nullptr && !line.empty() && in_plan(*from) != in_plan(*to) &&
               in_plan(line.front()) == in_plan(*to) && in_plan(line.back()) == in_plan(*from);
    }

    /// Lets a line reach the nodes at its ends; one without length is drawn from node to node.
    /// \return false: it is left out
    bool reach_ends(std::vector<Vec3>& line, NetworkFile::FileArc const& arc, Vec3 const* from, Vec3 const* to) {
        std::int64_t const number = number_of(arc);
        if (length_in_plan(line) > 0.0) {
            put_onto(from, line.front(), number);
            put_onto(to, line.back(), number);
            return true;
        }
        if (from == nullptr || to == nullptr || in_plan(*from) == in_plan(*to)) {
            say("left_out", number, line.empty() ? Vec2{} : in_plan(line.front()), 0.0,
                fmt::format("arc {}: has no length and joins no two nodes; it is left out", number));
            return false;
        }
        line = {*from, *to};
        say("drawn", number, in_plan(*from), length_in_plan(line),
            fmt::format("arc {}: has no line; it is drawn straight from node {} to node {}", number, arc.from_node,
                        arc.to_node));
        return true;
    }

    /// Moves an end without a node at its position onto its own node.
    void put_onto(Vec3 const* node, Vec3& end, std::int64_t id) {
        if (node == nullptr || in_plan(*node) == in_plan(end) || nodes_.lies_at(end)) {
            return;
        }
        say("moved", id, in_plan(*node), distance(in_plan(*node), in_plan(end)),
            fmt::format("arc {}: its end at ({}, {}) is put onto its node at ({}, {})", id, end.x, end.y, node->x,
                        node->y));
        end = {node->x, node->y, is_number(node->z) ? node->z : end.z};
    }

    NetworkFile const& file_;
    measure::TopologyReport const& found_;
    Nodes nodes_;
    double near_m_;
    std::set<std::int64_t> looped_ = {};
    std::map<std::int64_t, std::size_t> arc_of_channel_ = {}; ///< by arc_id: the first with that id
    RepairedLines result_ = {};
};

// Makes an importable line of every arc that allows it.
RepairedLines repair_lines(NetworkFile const& file, measure::TopologyReport const& found, double near_m) {
    LineRepairer repairer(file, found, near_m);
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        repairer.mend(a);
    }
    return repairer.finish();
}

/// Of the finite vertices.
double diagonal_of(NetworkFile const& file) {
    Vec2 low{greatest_coordinate, greatest_coordinate};
    Vec2 high{-greatest_coordinate, -greatest_coordinate};
    for (auto const& arc : file.arcs) {
        for (Vec3 const p : arc.line) {
            if (std::fabs(p.x) < greatest_coordinate && std::fabs(p.y) < greatest_coordinate) {
                low = {std::min(low.x, p.x), std::min(low.y, p.y)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            }
        }
    }
    return low.x > high.x ? 0.0 : distance(low, high);
}

/// The file's attributes of the rivers' lines, by feature; of several with one id, of the first.
class GivenAttributes {
public:
    GivenAttributes(NetworkFile const& file, RepairedLines const& lines) : file_(file), lines_(lines) {
        for (std::size_t r = 0; r < lines.arcs.size(); ++r) {
            by_feature_.emplace_back(lines.rivers.lines[r].feature, r);
        }
        std::sort(by_feature_.begin(), by_feature_.end());
    }
    NetworkFile::FileArc const& arc(std::int64_t feature) const { return file_.arcs[lines_.arcs[river(feature)]]; }
    RiverLine const& line(std::int64_t feature) const { return lines_.rivers.lines[river(feature)]; }

private:
    std::size_t river(std::int64_t feature) const {
        return std::lower_bound(by_feature_.begin(), by_feature_.end(), std::pair(feature, std::size_t{0}))->second;
    }

    NetworkFile const& file_;
    RepairedLines const& lines_;
    std::vector<std::pair<std::int64_t, std::size_t>> by_feature_;
};

constexpr double unknown_area = -1.0;

/// The known areas of arcs that end in one node.
struct ArrivingAreas {
    double sum_m2 = 0.0;
    double largest_m2 = 0.0;
    bool is_known = false; ///< of one at least

    void add(double area_m2) {
        if (area_m2 >= 0.0) {
            is_known = true;
            sum_m2 += area_m2;
            largest_m2 = std::max(largest_m2, area_m2);
        }
    }
};

/// Computes the areas of the arcs of a repaired network. At an end that did not move an arc has the file's area, raised
/// where one upstream is larger: rivers that divide count common water in both branches, so that the sum of two is no
/// bound. At a new end it has the sum of its inflows, at most the file's area farther down. What the file does not know
/// stays unknown.
class AreaKeeper {
public:
    AreaKeeper(GivenAttributes const& known, double near_m, std::int64_t id_shift, RepairedNetwork& mended)
        : known_(known), near_m_(near_m), id_shift_(id_shift), mended_(mended) {}

    void take() {
        StreamNetwork const& plan = mended_.network.planform;
        mended_.us_area_m2.assign(plan.arc_count(), unknown_area);
        mended_.ds_area_m2.assign(plan.arc_count(), unknown_area);
        mended_.node_area_m2.assign(plan.node_count(), unknown_area);
        for (auto node = plan.upstream_order().rbegin(); node != plan.upstream_order().rend(); ++node) {
            ArrivingAreas arriving;
            for (ArcId const a : plan.in(*node)) {
                arriving.add(mended_.ds_area_m2[a]);
            }
            if (ArcId const a = plan.out(*node); a != no_arc) {
                take(a, arriving);
                mended_.node_area_m2[*node] = mended_.us_area_m2[a];
            } else if (arriving.is_known) {
                mended_.node_area_m2[*node] = arriving.sum_m2;
            }
        }
    }

private:
    void take(ArcId a, ArrivingAreas const& arriving) {
        Arc const& arc = mended_.network.planform.arc(a);
        auto const& given = known_.arc(arc.feature);
        auto const& line = known_.line(arc.feature).vertices;
        bool const is_up = is_at(arc.line.front(), line.front());
        bool const is_down = is_at(arc.line.back(), line.back());
        bool const knows_down = std::isfinite(given.ds_area_m2);
        double& us_m2 = mended_.us_area_m2[a];
        double& ds_m2 = mended_.ds_area_m2[a];
        if (is_up && std::isfinite(given.us_area_m2)) {
            us_m2 = at_least(given.us_area_m2, arriving.largest_m2, arc);
        } else if (!is_up && knows_down) {
            us_m2 = std::max(std::min(arriving.sum_m2, given.ds_area_m2), arriving.largest_m2);
        }
        if (is_down && knows_down) {
            ds_m2 = at_least(given.ds_area_m2, std::max(us_m2, arriving.largest_m2), arc);
        } else if (!is_down && knows_down) {
            ds_m2 = us_m2;
        }
    }

    bool is_at(Vec2 p, Vec3 q) const { return distance(p, {q.x, q.y}) <= near_m_; }

    double at_least(double area_m2, double least_m2, Arc const& arc) {
        constexpr double rounding = 1e-9; // of numbers in km2
        if (area_m2 >= least_m2 * (1.0 - rounding)) {
            return area_m2;
        }
        std::int64_t const number = arc.feature - id_shift_;
        if (std::exchange(raised_, number) == number) {
            return least_m2; // its other end was told of
        }
        mended_.mended.push_back({"area_raised", number, arc.line.front(), least_m2 - area_m2,
                                  fmt::format("arc {}: its contributing area is {} km2, less than the {} km2 of an "
                                              "inflow, and is raised to that",
                                              number, area_m2 * 1e-6, least_m2 * 1e-6)});
        return least_m2;
    }

    GivenAttributes const& known_;
    double near_m_;
    std::int64_t id_shift_;
    RepairedNetwork& mended_;
    std::int64_t raised_ = -1; ///< the last arc that was told of
};

/// What the file says of the main stems.
network::StemClues clues_of(GivenAttributes const& known, StreamNetwork const& plan) {
    network::StemClues clues;
    for (Arc const& arc : plan.arcs()) {
        clues.arcs.push_back(network::clues_of(known.arc(arc.feature)));
    }
    return clues;
}

/// The features of an arc that is part of the file's arc, or all of it.
std::vector<Stretch> stretches_of(NetworkFile::FileArc const& given, double given_m, double length_m) {
    bool const is_whole = std::fabs(given_m - length_m) <= 1e-6 * given_m;
    if (is_whole && !given.sources.empty()) {
        return given.sources;
    }
    return given.feature == 0 ? std::vector<Stretch>{} : std::vector<Stretch>{{given.feature, 0.0, length_m}};
}

/// Copies the file's attributes of arcs, other than their lines.
void take_words(GivenAttributes const& known, RepairedNetwork& mended) {
    NetworkDraft named = mended.network.planform.draft();
    for (ArcId a = 0; a < named.arcs.size(); ++a) {
        Arc& of = named.arcs[a].arc;
        auto const& given = known.arc(of.feature);
        std::vector<Vec2> const line = in_plan(known.line(of.feature).vertices);
        mended.braided.push_back(given.braided ? 1 : 0);
        mended.user.record.push_back(given.record);
        mended.user.sources.push_back(stretches_of(given, length_of(line), mended.network.planform.length_m(a)));
        of.persistence = given.persistence;
        of.is_input = given.is_input;
        of.feature = given.feature;
    }
    mended.network.planform = std::move(named);
}

/// Names secondary lines by the features of the file.
std::vector<SecondaryLine> named_by_file(NetworkFile const& file, std::vector<SecondaryLine> lines) {
    std::map<std::int64_t, std::size_t> arc_of;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        arc_of.try_emplace(file.arcs[a].id, a);
    }
    for (SecondaryLine& line : lines) {
        auto const& arc = file.arcs[arc_of.at(line.feature)];
        line.feature = arc.feature;
        line.record = arc.record;
    }
    return lines;
}

/// Adds one finding for each kind of repaired fault, so that every repair is reported.
void report_repairs(measure::TopologyReport const& found, std::vector<Finding>& mended) {
    for (auto first = found.findings.begin(); first != found.findings.end();) {
        auto const last =
            std::find_if(first, found.findings.end(), [&](Finding const& f) { return f.kind != first->kind; });
        mended.push_back(
            {"mended", first->feature, first->where, static_cast<double>(last - first),
             fmt::format("{} of kind {} repaired, the first: {}", last - first, first->kind.name(), first->text)});
        first = last;
    }
}

void report_lowering(network::LoweredNetwork const& lowered, std::int64_t id_shift, std::vector<Finding>& mended) {
    std::size_t a = 0;
    for (ArcId arc = 0; arc < lowered.network.planform.arc_count(); ++arc) {
        Arc const& of = lowered.network.planform.arc(arc);
        if (double const by = lowered.by_m[a++]; by > 0.0) {
            mended.push_back({"lowered", of.feature - id_shift, of.line.front(), by,
                              fmt::format("arc {}: is lowered by up to {} m so that it does not run uphill",
                                          of.feature - id_shift, by)});
        }
    }
}

} // namespace

RepairedNetwork repair_network(NetworkFile const& file, measure::TopologyReport const& found,
                               RepairNetworkParams const& params, Run const& run) {
    RepairedNetwork mended;
    auto const give_up = [&](std::string const& why) {
        mended.mended.push_back({"not_mended", 0, nowhere, 0.0, why});
        return mended;
    };
    double const near_m = params.near_m > 0.0 ? params.near_m : 1e-6 * diagonal_of(file);
    RepairedLines lines = repair_lines(file, found, near_m);
    mended.mended = std::move(lines.mended);
    if (lines.rivers.lines.empty()) {
        return give_up("no arc is left that has a line");
    }
    bool const may_have_gaps = params.near_m <= 0.0 && file.schema != "native"; // whose arcs say where rivers end
    double const cell_m = may_have_gaps ? network::choose_cell(lines.rivers, {}, run).cell_m : 0.0;
    network::ImportedNetwork imported;
    try {
        imported = network::import_lines(lines.rivers,
                                         {.snap_m = near_m,
                                          .orientation = orientation_of(file),
                                          .join = false,
                                          .snapped = network::SnappedEnds::open,
                                          .cell_m = cell_m,
                                          .dem = params.dem},
                                         run);
    } catch (BadInput const& cannot) {
        return give_up(cannot.what());
    }
    append(mended.mended, std::move(imported.repairs));
    mended.doubts = make::direction_findings(imported.directions, params.dem != nullptr ? "" : "--dem FILE", "");
    network::LoweredNetwork lowered = network::lower_rises(imported.network, imported.arc_z);
    report_lowering(lowered, file.id_shift, mended.mended);
    if (!file.says.heights) {
        mended.mended.push_back(
            {"level", 0, {}, static_cast<double>(file.arcs.size()), "the file has no heights, nor has the copy"});
    }
    mended.network = std::move(lowered.network);
    mended.has_heights = file.says.heights;
    GivenAttributes const known(file, lines);
    StreamNetwork const& plan = mended.network.planform;
    mended.orders = network::order(plan, network::main_inflows(plan, clues_of(known, plan), params.main));
    AreaKeeper(known, near_m, file.id_shift, mended).take();
    take_words(known, mended);
    mended.user.attributes = file.attributes;
    append(lines.secondary, std::move(imported.secondary));
    mended.secondary = named_by_file(file, std::move(lines.secondary));
    report_repairs(found, mended.mended);

    auto const left = measure::check_topology(measure::as_file(mended.network, mended.orders), {near_m}, run);
    if (!left.findings.empty()) {
        constexpr std::size_t shown = 10;
        for (std::size_t i = 0; i < std::min(shown, left.findings.size()); ++i) {
            mended.mended.push_back(left.findings[i]);
        }
        return give_up(fmt::format("{} faults are left; the first are listed", left.findings.size()));
    }
    mended.done = true;
    return mended;
}

} // namespace thalweg::commands
