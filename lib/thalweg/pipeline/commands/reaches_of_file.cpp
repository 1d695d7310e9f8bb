// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/river_claims.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/network/import/clip_lines.hpp>

namespace thalweg::pipeline {

namespace {

using Places = std::unordered_map<std::int64_t, std::int64_t>;

std::int64_t place_in(Places const& places, std::int64_t key) {
    auto const found = places.find(key);
    return found == places.end() ? -1 : found->second;
}

bool inside(std::vector<Vec3> const& line, Grid const& grid) {
    return std::all_of(line.begin(), line.end(), [&](Vec3 const& v) {
        return v.x >= grid.west && v.x <= grid.east() && v.y >= grid.south() && v.y <= grid.north;
    });
}

std::vector<Vec2> in_plan(std::vector<Vec3> const& line) {
    std::vector<Vec2> plan;
    plan.reserve(line.size());
    for (Vec3 const& v : line) {
        plan.push_back({v.x, v.y});
    }
    return plan;
}

bool is_somewhere(std::vector<Vec3> const& line) {
    return std::all_of(line.begin(), line.end(),
                       [](Vec3 const& v) { return std::isfinite(v.x) && std::isfinite(v.y); });
}

std::vector<std::vector<Vec2>> parts_in(std::vector<Vec3> const& line, Grid const& grid) {
    if (line.empty() || !is_somewhere(line)) {
        return {};
    }
    if (inside(line, grid)) { // bit for bit
        return {in_plan(line)};
    }
    RiverLines whole;
    whole.lines.push_back({0, line, {}, 0, 0});
    std::vector<std::vector<Vec2>> parts;
    for (RiverLine const& part : network::clip_lines(whole, grid).lines) {
        parts.push_back(in_plan(part.vertices));
    }
    return parts;
}

/// By reach, the basin of the file where it has them; else 1, 2, ... by the node at its outlet.
std::vector<std::int64_t> basins_of(NetworkFile const& file, std::vector<flow::Reach> const& reaches,
                                    std::vector<std::size_t> const& first_arc) {
    std::vector<std::int64_t> basins;
    bool const told = file.says.basin && std::all_of(file.arcs.begin(), file.arcs.end(),
                                                     [](NetworkFile::FileArc const& a) { return a.basin > 0; });
    if (told) {
        for (std::size_t const arc : first_arc) {
            basins.push_back(file.arcs[arc].basin);
        }
        return basins;
    }
    basins.assign(reaches.size(), 0);
    Places known;
    std::vector<std::size_t> way;
    for (std::size_t start = 0; start < reaches.size(); ++start) {
        way.clear();
        std::size_t at = start;
        while (basins[at] == 0 && reaches[at].ds >= 0) {
            way.push_back(at);
            at = static_cast<std::size_t>(reaches[at].ds);
        }
        if (basins[at] == 0) {
            auto const next = static_cast<std::int64_t>(known.size()) + 1;
            basins[at] = known.try_emplace(file.arcs[first_arc[at]].to_node, next).first->second;
        }
        for (std::size_t const above : way) {
            basins[above] = basins[at];
        }
    }
    return basins;
}

} // namespace

FileReaches reaches_of_file(NetworkFile const& file, Grid const& grid) {
    FileReaches result;
    Places places;
    std::vector<std::size_t> first_arc;
    for (std::size_t i = 0; i < file.arcs.size(); ++i) {
        auto const& arc = file.arcs[i];
        auto const next = static_cast<std::int64_t>(result.reaches.size());
        auto const [place, fresh] = places.try_emplace(arc.id, next);
        if (fresh) {
            result.reaches.push_back({{}, -1, arc.id});
            first_arc.push_back(i);
        } else if (file.arcs[first_arc[static_cast<std::size_t>(place->second)]].ds_arc != arc.ds_arc) {
            throw BadInput(fmt::format("pipeline.reaches_of_file: arcs of the id {} run into several; see what thalweg "
                                       "check says",
                                       arc.id));
        }
        auto& lines = result.reaches[static_cast<std::size_t>(place->second)].lines;
        auto parts = parts_in(arc.line, grid);
        result.nowhere += is_somewhere(arc.line) ? 0 : 1;
        std::move(parts.begin(), parts.end(), std::back_inserter(lines));
    }
    std::vector<bool> leaves(result.reaches.size(), false);
    for (auto const& arc : file.arcs) {
        auto const reach = static_cast<std::size_t>(places.at(arc.id));
        leaves[reach] = leaves[reach] || !inside(arc.line, grid);
        result.reaches[reach].ds = place_in(places, arc.ds_arc);
    }
    flow::steps_to_outlet(result.reaches); // says where rivers run in a circle
    for (std::size_t i = 0; i < result.reaches.size(); ++i) {
        bool const none = result.reaches[i].lines.empty();
        result.outside += none ? 1 : 0;
        result.cut += leaves[i] && !none ? 1 : 0;
    }
    if (result.outside == static_cast<std::int64_t>(result.reaches.size())) {
        throw BadInput(fmt::format("pipeline.reaches_of_file: none of {} arcs lies on the DEM, which reaches from "
                                   "({:.3f}, {:.3f}) to ({:.3f}, {:.3f})",
                                   file.arcs.size(), grid.west, grid.south(), grid.east(), grid.north));
    }
    result.basins = basins_of(file, result.reaches, first_arc);
    return result;
}

} // namespace thalweg::pipeline
