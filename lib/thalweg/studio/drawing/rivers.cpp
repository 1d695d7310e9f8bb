// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/drawn_rivers.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/studio/internal/drawn_coasts.hpp>

namespace thalweg::studio {
namespace {

/// The vertices that two rivers share.
DrawnLine shared_vertices(DrawnLine const& one, DrawnLine const& other) {
    std::set<Vec2, BeforeInPlan> const places(one.begin(), one.end());
    DrawnLine shared;
    std::ranges::copy_if(other, std::back_inserter(shared), [&](Vec2 q) { return places.contains(q); });
    return shared;
}

/// The distance from the nearest of some places; infinite without any.
double distance_to_nearest(DrawnLine const& places, Vec2 p) {
    double least = infinite;
    for (Vec2 const q : places) {
        least = std::min(least, distance(p, q));
    }
    return least;
}

/// Where two lines cross, the first place along one.
/// \param index of the segments of one
std::optional<Vec2> first_crossing(DrawnLine const& one, geometry::SegmentIndex const& index, DrawnLine const& other) {
    std::pair<std::size_t, std::size_t> first{no_number, no_number};
    for (std::size_t k = 0; k + 1 < other.size(); ++k) {
        for (std::size_t const i : index.near(other[k], other[k + 1], 0.0)) {
            if (std::pair(i, k) < first && segments_cross(one[i], one[i + 1], other[k], other[k + 1])) {
                first = {i, k};
            }
        }
    }
    if (first.first == no_number) {
        return std::nullopt;
    }
    auto const [i, k] = first;
    double const from = cross(other[k], other[k + 1], one[i]);
    double const to = cross(other[k], other[k + 1], one[i + 1]);
    return one[i] + from / (from - to) * (one[i + 1] - one[i]);
}

/// \param changed part of a river
void require_no_crossing(Drawing const& drawing, std::size_t river, DrawnLine const& changed) {
    geometry::SegmentIndex const index = index_segments(changed);
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        if (r == river) {
            continue;
        }
        if (auto const at = first_crossing(changed, index, drawing.rivers[r].line)) {
            throw NotDrawn("studio.drawn", "the river would cross another one here; let it end there instead", at);
        }
    }
}

/// \param index of places along a changed part of a river
void require_distance(Drawing const& drawing, std::size_t river, PlaceIndex const& index) {
    constexpr double widening = 0.2; // rivers part by more than this share of the way from where they meet
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        if (r == river) {
            continue;
        }
        DrawnLine const& other = drawing.rivers[r].line;
        std::optional<DrawnLine> joints;
        index.visit_near(other, [&](std::size_t place, double distance_m) {
            Vec2 const p = index.places[place];
            joints = joints ? joints : shared_vertices(drawing.rivers[river].line, other);
            double const along_m = distance_to_nearest(*joints, p);
            if (distance_m < std::min(index.near_m, widening * along_m) && along_m >= drawing.grid.cell_m) {
                throw NotDrawn(
                    "studio.drawn",
                    fmt::format("it comes too near to another river here: keep {} cells apart, or let it end there",
                                index.near_m / drawing.grid.cell_m),
                    p);
            }
        });
    }
}

} // namespace

RiverSpot nearest_on_river(Drawing const& drawing, std::size_t river, Vec2 p, RiverSpot nearest) {
    DrawnLine const& line = drawing.rivers[river].line;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        Vec2 const foot = geometry::foot_on(line[i], line[i + 1], p).at;
        double const distance_m = distance(foot, p);
        if (distance_m < nearest.distance_m) {
            nearest = {river, i, foot, distance_m};
        }
    }
    return nearest;
}

RiverSpot nearest_on_rivers(Drawing const& drawing, Vec2 p, std::size_t left_out, double reach_m) {
    RiverSpot nearest;
    nearest.distance_m = reach_m;
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        nearest = r != left_out ? nearest_on_river(drawing, r, p, nearest) : nearest;
    }
    return nearest;
}

Vec2 add_vertex(Drawing& drawing, RiverSpot const& spot) {
    DrawnLine& line = drawing.rivers[spot.river].line;
    Vec2 const begin = line[spot.segment];
    Vec2 const end = line[spot.segment + 1];
    Vec2 const nearer = distance(begin, spot.at) <= distance(end, spot.at) ? begin : end;
    Vec2 const at = rounded(spot.at);
    if (distance(nearer, at) <= clearance_cells * drawing.grid.cell_m) {
        return nearer;
    }
    line.insert(line.begin() + static_cast<std::ptrdiff_t>(spot.segment) + 1, at);
    return at;
}

std::vector<RiverVertex> downstream_vertices(Drawing const& drawing) {
    std::map<Vec2, std::vector<RiverVertex>, BeforeInPlan> at_ends; // vertices from where a river runs on
    for (DrawnRiver const& river : drawing.rivers) {
        at_ends[river.line.back()];
    }
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        DrawnLine const& line = drawing.rivers[r].line;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            if (auto const found = at_ends.find(line[i]); found != at_ends.end()) {
                found->second.push_back({r, i});
            }
        }
    }
    std::vector<RiverVertex> below(drawing.rivers.size());
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        for (RiverVertex const& one : at_ends[drawing.rivers[r].line.back()]) {
            below[r] = below[r].river == no_number && one.river != r ? one : below[r];
        }
    }
    return below;
}

bool flows_through(std::vector<RiverVertex> const& below, std::size_t from, std::size_t through) {
    for (std::size_t rounds = 0; from != no_number && rounds <= below.size(); ++rounds) {
        if (from == through) {
            return true;
        }
        from = below[from].river;
    }
    return false;
}

bool meets_other_river(Drawing const& drawing, std::size_t river, Vec2 at) {
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        DrawnLine const& line = drawing.rivers[r].line;
        if (r != river && std::ranges::find(line, at) != line.end()) {
            return true;
        }
    }
    return false;
}

std::vector<DrawnRiver> merge_successive_rivers(Drawing const& drawing) {
    std::vector<RiverVertex> const below = downstream_vertices(drawing);
    std::vector<std::vector<std::size_t>> above(below.size()); // rivers that end where this one begins
    std::vector<std::size_t> upwards;
    for (std::size_t r = 0; r < below.size(); ++r) {
        if (below[r].river != no_number && below[r].vertex == 0) {
            above[below[r].river].push_back(r);
        } else {
            upwards.push_back(r);
        }
    }
    for (std::size_t i = 0; i < upwards.size(); ++i) {
        upwards.insert(upwards.end(), above[upwards[i]].begin(), above[upwards[i]].end());
    }
    std::vector<DrawnRiver> merged = drawing.rivers;
    std::vector<std::size_t> gone;
    for (auto river = upwards.rbegin(); river != upwards.rend(); ++river) {
        std::vector<std::size_t> const& from = above[*river];
        if (from.empty()) {
            continue;
        }
        std::size_t const longest =
            *std::ranges::max_element(from, {}, [&](std::size_t r) { return length_of(merged[r].line); });
        DrawnLine line = std::move(merged[longest].line);
        line.insert(line.end(), merged[*river].line.begin() + 1, merged[*river].line.end());
        merged[*river].line = std::move(line);
        gone.push_back(longest);
    }
    std::ranges::sort(gone, std::greater());
    for (std::size_t const r : gone) {
        merged.erase(merged.begin() + static_cast<std::ptrdiff_t>(r));
    }
    return merged;
}

void require_clear(Drawing const& drawing, std::size_t river, std::size_t first, std::size_t last, double clear_cells) {
    double const cell_m = drawing.grid.cell_m;
    DrawnLine const& line = drawing.rivers[river].line;
    DrawnLine const changed(line.begin() + static_cast<std::ptrdiff_t>(first),
                            line.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    DrawnLine const places = resample_line(changed, sampling_cells * cell_m);
    CoastIndex coasts(drawing.coasts);
    for (Vec2 const p : places) {
        refuse_step_if(lies_in_sea(coasts.nearest(p), cell_m), "the river would run through the sea here", p);
    }
    if (auto const at = first_near_lines(places, drawing.ridges, 0.5 * clearance_cells * cell_m)) {
        throw NotDrawn(
            "studio.drawn",
            "the river would cross or touch a ridge here: no water crosses it. Move or erase the ridge first", at);
    }
    require_no_crossing(drawing, river, changed);
    require_distance(drawing, river, {places, clear_cells * cell_m});
}

void require_no_circle(Drawing const& drawing) {
    std::vector<RiverVertex> const below = downstream_vertices(drawing);
    std::vector<std::size_t> seen(below.size(), no_number); // from which river first
    for (std::size_t r = 0; r < below.size(); ++r) {
        for (std::size_t at = r; at != no_number && (seen[at] == no_number || seen[at] == r); at = below[at].river) {
            refuse_step_if(seen[at] == r, "the river would flow in a circle", drawing.rivers[at].line.back());
            seen[at] = r;
        }
    }
}

std::vector<std::size_t> rivers_into(Drawing const& drawing, std::size_t river) {
    std::vector<RiverVertex> const below = downstream_vertices(drawing);
    std::vector<std::size_t> found;
    for (std::size_t r = 0; r < below.size(); ++r) {
        if (r != river && flows_through(below, r, river)) {
            found.push_back(r);
        }
    }
    return found;
}

} // namespace thalweg::studio
