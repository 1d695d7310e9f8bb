// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/internal/mend_network.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/lower_rises.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/commands/internal/mend_lines.hpp>
#include <thalweg/pipeline/make/internal/given.hpp>
#include <thalweg/pipeline/plan/internal/append.hpp>

namespace thalweg::pipeline {
namespace {

/// Of the vertices that are places.
double diagonal_of(NetworkFile const& file) {
    constexpr double greatest_coordinate = 1e18; // beyond, measure::check_topology takes it for none
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

/// What the file knows of the rivers' lines, by feature; of several of one id, of the first.
class Known {
public:
    Known(NetworkFile const& file, MendedLines const& lines) : file_(file), lines_(lines) {
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
    MendedLines const& lines_;
    std::vector<std::pair<std::int64_t, std::size_t>> by_feature_;
};

/// An arc has the area its file gives at an end that is still where it was; else what flows in, which is the least.
void take_areas(Known const& known, double near_m, MendedNetwork& mended) {
    StreamNetwork const& plan = mended.network.plan;
    mended.us_area_m2.assign(plan.arc_count(), 0.0);
    mended.ds_area_m2.assign(plan.arc_count(), 0.0);
    mended.node_area_m2.assign(plan.node_count(), 0.0);
    auto const is_at = [&](Vec2 p, Vec3 q) { return distance(p, {q.x, q.y}) <= near_m; };
    for (auto node = plan.upstream_order().rbegin(); node != plan.upstream_order().rend(); ++node) {
        for (ArcId const a : plan.in(*node)) {
            mended.node_area_m2[*node] += mended.ds_area_m2[a];
        }
        if (plan.out(*node) == no_arc) {
            continue;
        }
        auto const a = plan.out(*node);
        Arc const& arc = plan.arc(a);
        auto const& given = known.arc(arc.feature);
        auto const& line = known.line(arc.feature).vertices;
        bool const keeps_up = is_at(arc.line.front(), line.front()) && std::isfinite(given.us_area_m2);
        bool const keeps_down = is_at(arc.line.back(), line.back()) && std::isfinite(given.ds_area_m2);
        double const arriving = mended.node_area_m2[*node];
        mended.us_area_m2[a] = keeps_up ? std::max(given.us_area_m2, arriving) : arriving;
        mended.ds_area_m2[a] = keeps_down ? std::max(given.ds_area_m2, mended.us_area_m2[a]) : mended.us_area_m2[a];
        mended.node_area_m2[*node] = mended.us_area_m2[a];
    }
}

/// The features of an arc that is a part of a file's, or the whole of it.
std::vector<Stretch> stretches_of(NetworkFile::FileArc const& given, double given_m, double length_m) {
    bool const is_whole = std::fabs(given_m - length_m) <= 1e-6 * given_m;
    if (is_whole && !given.sources.empty()) {
        return given.sources;
    }
    return given.feature == 0 ? std::vector<Stretch>{} : std::vector<Stretch>{{given.feature, 0.0, length_m}};
}

/// Arcs take from the file what it says of them beside their lines.
void take_words(Known const& known, MendedNetwork& mended) {
    NetworkDraft named = mended.network.plan.draft();
    for (ArcId a = 0; a < named.arcs.size(); ++a) {
        Arc& of = named.arcs[a].arc;
        auto const& given = known.arc(of.feature);
        std::vector<Vec2> line;
        for (Vec3 const v : known.line(of.feature).vertices) {
            line.push_back({v.x, v.y});
        }
        mended.braided.push_back(given.braided ? 1 : 0);
        mended.user.record.push_back(given.record);
        mended.user.sources.push_back(stretches_of(given, length_of(line), mended.network.plan.length_m(a)));
        of.persistence = given.persistence;
        of.is_input = given.is_input;
        of.feature = given.feature;
    }
    mended.network.plan = std::move(named);
}

/// Secondary lines by the features of the file.
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

/// One finding for each kind that the check found, so that nothing is mended in silence.
void say_mended(measure::TopologyReport const& found, std::vector<Finding>& mended) {
    for (auto first = found.findings.begin(); first != found.findings.end();) {
        auto const last =
            std::find_if(first, found.findings.end(), [&](Finding const& f) { return f.kind != first->kind; });
        mended.push_back(
            {"mended", first->feature, first->where, static_cast<double>(last - first),
             fmt::format("{} of kind {} repaired, the first: {}", last - first, first->kind, first->text)});
        first = last;
    }
}

void say_lowered(network::Lowered const& lowered, std::int64_t id_shift, std::vector<Finding>& mended) {
    std::size_t a = 0;
    for (ArcId arc = 0; arc < lowered.network.plan.arc_count(); ++arc) {
        Arc const& of = lowered.network.plan.arc(arc);
        if (double const by = lowered.by_m[a++]; by > 0.0) {
            mended.push_back({"lowered", of.feature - id_shift, of.line.front(), by,
                              fmt::format("arc {}: is lowered by up to {} m so that it does not run uphill",
                                          of.feature - id_shift, by)});
        }
    }
}

/// What was turned by which evidence, then sentences on what is doubtful.
std::vector<Finding> doubts_of_directions(network::Directions const& directions, bool has_dem) {
    std::vector<Finding> notes;
    if (std::string const turned = turned_in_words(directions); !turned.empty()) {
        double sum_m = 0.0;
        for (network::Directions::Turned const& one : directions.turned) {
            sum_m += one.length_m;
        }
        notes.push_back({"directions", 0, {}, sum_m, turned});
    }
    for (std::string const& doubt : direction_doubts(directions, has_dem ? "" : "--dem FILE", "")) {
        notes.push_back({"uncertain_direction", 0, {}, 0.0, doubt});
    }
    return notes;
}

} // namespace

MendedNetwork mend_network(NetworkFile const& file, measure::TopologyReport const& found,
                           MendNetworkParams const& params, Run const& run) {
    MendedNetwork mended;
    auto const give_up = [&](std::string const& why) {
        mended.mended.push_back({"not_mended", 0, {}, 0.0, why});
        return mended;
    };
    double const near_m = params.near_m > 0.0 ? params.near_m : 1e-6 * diagonal_of(file);
    MendedLines lines = mend_lines(file, found, near_m);
    mended.mended = std::move(lines.mended);
    if (lines.rivers.lines.empty()) {
        return give_up("no arc is left that has a line");
    }
    network::Imported imported;
    try {
        imported = network::import_lines(
            lines.rivers,
            {.snap_m = near_m,
             .orientation = file.schema == "native" ? network::Orientation::least_turned : network::Orientation::links,
             .join = false,
             .snapped = network::SnappedEnds::open,
             .dem = params.dem},
            run);
    } catch (BadInput const& cannot) {
        return give_up(cannot.what());
    }
    append(mended.mended, std::move(imported.repairs));
    mended.doubts = doubts_of_directions(imported.directions, params.dem != nullptr);
    network::Lowered lowered = network::lower_rises(imported.network, imported.arc_z);
    say_lowered(lowered, file.id_shift, mended.mended);
    if (!file.says.heights) {
        mended.mended.push_back(
            {"level", 0, {}, static_cast<double>(file.arcs.size()), "the file has no heights: all are 0"});
    }
    mended.network = std::move(lowered.network);
    mended.orders = network::order(mended.network.plan);
    Known const known(file, lines);
    take_areas(known, near_m, mended);
    take_words(known, mended);
    mended.user.attributes = file.attributes;
    append(lines.secondary, std::move(imported.secondary));
    mended.secondary = named_by_file(file, std::move(lines.secondary));
    say_mended(found, mended.mended);

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

} // namespace thalweg::pipeline
