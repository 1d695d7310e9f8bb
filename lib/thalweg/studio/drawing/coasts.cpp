// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/drawn_coasts.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/studio/internal/drawing_steps.hpp>

namespace thalweg::studio {
namespace {

/// Where a straight line from land to sea leaves the land.
Vec2 find_shore(CoastIndex& coasts, Vec2 land, Vec2 sea) {
    constexpr int halvings = 30;
    for (int i = 0; i < halvings; ++i) {
        Vec2 const middle = 0.5 * (land + sea);
        (coasts.nearest(middle).is_land ? land : sea) = middle;
    }
    return rounded(land);
}

/// A line cut at the coasts: its parts on land, in order, short ones among them.
std::vector<DrawnLine> split_at_coasts(CoastIndex& coasts, DrawnLine const& line, double cell_m) {
    constexpr double on_coast_m = 1e-5; // rounding must not put rivers that meet on the coast into the sea
    std::vector<DrawnLine> parts;
    bool was_land = false;
    Vec2 before = line.front();
    auto const go_to = [&](Vec2 p, bool is_vertex) {
        NearestCoast const coast = coasts.nearest(p);
        bool const is_land = coast.is_land || coast.distance_m < on_coast_m;
        if (is_land && !was_land) {
            parts.emplace_back();
            if (p != line.front()) {
                parts.back().push_back(find_shore(coasts, p, before));
            }
        }
        if (was_land && !is_land) {
            parts.back().push_back(find_shore(coasts, before, p));
        } else if (is_land && is_vertex) {
            parts.back().push_back(p);
        }
        was_land = is_land;
        before = p;
    };
    go_to(line.front(), true);
    for (std::size_t i = 1; i < line.size(); ++i) {
        DrawnLine const places = resample_line({line[i - 1], line[i]}, sampling_cells * cell_m);
        for (std::size_t k = 1; k < places.size(); ++k) {
            go_to(places[k], k + 1 == places.size());
        }
    }
    return parts;
}

/// The parts of a line that lie on land, in order, without short ones.
/// \param keeps_head the first part may be short, because other rivers end where it begins
std::vector<DrawnLine> parts_on_land(CoastIndex& coasts, DrawnLine const& line, double cell_m, bool keeps_head) {
    if (coasts.empty()) {
        return {line};
    }
    std::vector<DrawnLine> parts = split_at_coasts(coasts, line, cell_m);
    for (DrawnLine& part : parts) {
        part = remove_repeats(std::move(part));
    }
    // A line that is short itself stays where it lies on land.
    double const least_m = std::min(least_length_cells * cell_m, length_of(line) - touching_cells * cell_m);
    std::erase_if(parts, [&](DrawnLine const& part) {
        bool const is_head = keeps_head && !part.empty() && part.front() == line.front();
        return part.size() < 2 || (length_of(part) < least_m && !is_head);
    });
    return parts;
}

bool is_at_border(Grid const& grid, Vec2 p) {
    return distance(nearest_on_border(grid, p), p) < 2.0 * snap_cells * grid.cell_m;
}

void carry_end_to_border(Grid const& grid, DrawnLine& line) {
    Vec2 const edge = nearest_on_border(grid, line.back());
    if (is_at_border(grid, line.back())) {
        snap_end(line, edge, grid.cell_m);
    } else {
        line.push_back(edge);
    }
}

/// Whether more of the rivers lie on the sea's side of a coast.
bool has_rivers_in_sea(Drawing const& drawing, DrawnLine const& coast) {
    std::size_t land = 0;
    std::size_t sea = 0;
    std::vector<DrawnLine> const one{coast};
    CoastIndex coasts(one);
    for (DrawnRiver const& river : drawing.rivers) {
        for (Vec2 const p : resample_line(river.line, drawing.grid.cell_m)) {
            ++(coasts.nearest(p).is_land ? land : sea);
        }
    }
    return sea > land;
}

/// The edges between land and sea, from corner to corner of cells, land at their left.
class Outline {
public:
    explicit Outline(Mask const& land) : land_(land), grid_(land.grid()) {
        for (std::int64_t row = 0; row < grid_.height; ++row) {
            for (std::int64_t col = 0; col < grid_.width; ++col) {
                if (land_[Cell{col, row}] == 0) {
                    continue;
                }
                add({col, row + 1}, {col + 1, row + 1}, {col, row + 1}); // to the south: eastwards
                add({col + 1, row + 1}, {col + 1, row}, {col + 1, row});
                add({col + 1, row}, {col, row}, {col, row - 1});
                add({col, row}, {col, row + 1}, {col - 1, row});
            }
        }
    }

    std::vector<DrawnLine> lines() {
        std::vector<DrawnLine> found;
        std::set<Corner> ends;
        for (auto const& [from, to] : edges_) {
            for (Corner const& corner : to) {
                ends.insert(corner);
            }
        }
        std::vector<Corner> begins; // open lines first
        for (auto const& [from, to] : edges_) {
            if (!ends.contains(from)) {
                begins.push_back(from);
            }
        }
        for (Corner const& from : begins) {
            found.push_back(walk(from));
        }
        while (!edges_.empty()) {
            found.push_back(walk(edges_.begin()->first));
        }
        return found;
    }

private:
    using Corner = std::pair<std::int64_t, std::int64_t>; ///< column, row of the grid's lines

    void add(Corner from, Corner to, Cell beyond) {
        if (grid_.contains(beyond) && land_[beyond] == 0) {
            edges_[from].push_back(to);
        }
    }

    DrawnLine walk(Corner at) {
        DrawnLine line{place(at)};
        Corner const begin = at;
        Corner before{at.first, at.second};
        for (auto next = edges_.find(at); next != edges_.end(); next = edges_.find(at)) {
            std::vector<Corner>& to = next->second;
            // Where two cells touch at a corner, each keeps its own shore: the walk turns left.
            auto const chosen = std::ranges::max_element(to, {}, [&](Corner const& c) {
                return (at.first - before.first) * -(c.second - at.second) -
                       -(at.second - before.second) * (c.first - at.first);
            });
            before = at;
            at = *chosen;
            to.erase(chosen);
            if (to.empty()) {
                edges_.erase(next);
            }
            line.push_back(place(at));
            if (at == begin) {
                break;
            }
        }
        return line;
    }

    Vec2 place(Corner const& corner) const {
        return {grid_.west + static_cast<double>(corner.first) * grid_.cell_m,
                grid_.north - static_cast<double>(corner.second) * grid_.cell_m};
    }

    Mask const& land_;
    Grid const& grid_;
    std::map<Corner, std::vector<Corner>> edges_;
};

} // namespace

CoastIndex::CoastIndex(std::vector<DrawnLine> const& coasts) : coasts_(coasts) {
    constexpr std::size_t together = 16;
    for (std::size_t c = 0; c < coasts.size(); ++c) {
        for (std::size_t i = 0; i + 1 < coasts[c].size(); i += together) {
            Stretch stretch{c, i, std::min(i + together, coasts[c].size() - 1), coasts[c][i], coasts[c][i]};
            for (std::size_t k = i; k <= stretch.end; ++k) {
                Vec2 const p = coasts[c][k];
                stretch.low = {std::min(stretch.low.x, p.x), std::min(stretch.low.y, p.y)};
                stretch.high = {std::max(stretch.high.x, p.x), std::max(stretch.high.y, p.y)};
            }
            stretches_.push_back(stretch);
        }
    }
}

NearestCoast CoastIndex::nearest(Vec2 p) {
    constexpr double tie = 1e-9;
    // The coast nearest to the last place bounds the distance from here.
    double const most_m = (last_m_ + distance(last_, p)) * (1.0 + 4.0 * tie) + tie;
    NearestCoast nearest;
    double aside = 0.0; // of the nearest segment: the distance of the place from its straight line
    for (Stretch const& stretch : stretches_) {
        Vec2 const beside{std::max({stretch.low.x - p.x, p.x - stretch.high.x, 0.0}),
                          std::max({stretch.low.y - p.y, p.y - stretch.high.y, 0.0})};
        for (std::size_t i = stretch.begin; dot(beside, beside) <= most_m * most_m && i < stretch.end; ++i) {
            Vec2 const a = coasts_[stretch.coast][i];
            Vec2 const b = coasts_[stretch.coast][i + 1];
            Vec2 const foot = geometry::foot_on(a, b, p).at;
            double const distance_m = distance(foot, p);
            double const turn = cross(a, b, p) / distance(a, b);
            bool const is_nearer = distance_m < nearest.distance_m * (1.0 - tie);
            if (is_nearer || (distance_m <= nearest.distance_m * (1.0 + tie) && std::fabs(turn) > aside)) {
                nearest = {foot, distance_m, turn >= 0.0};
                aside = std::fabs(turn);
            }
        }
    }
    last_ = p;
    last_m_ = nearest.distance_m;
    return nearest;
}

bool is_land(Drawing const& drawing, Vec2 at) {
    return CoastIndex(drawing.coasts).nearest(at).is_land;
}

Vec2 nearest_on_border(Grid const& grid, Vec2 p) {
    std::pair<double, Vec2> const sides[] = {{p.x - grid.west, {grid.west, p.y}},
                                             {grid.east() - p.x, {grid.east(), p.y}},
                                             {p.y - grid.south(), {p.x, grid.south()}},
                                             {grid.north - p.y, {p.x, grid.north}}};
    return clip_to_grid(grid, std::ranges::min_element(sides, {}, &std::pair<double, Vec2>::first)->second);
}

bool lies_in_sea(NearestCoast const& coast, double cell_m) {
    return !coast.is_land && coast.distance_m > touching_cells * cell_m;
}

bool lies_in_sea(Drawing const& drawing, Vec2 p) {
    return lies_in_sea(CoastIndex(drawing.coasts).nearest(p), drawing.grid.cell_m);
}

DrawnLine line_on_land(DrawResult& result, DrawnLine const& points, char const* what) {
    Drawing const& drawing = result.drawing;
    DrawnLine const within = longest_part_in_grid(drawing.grid, points);
    double const beyond_m = length_of(points) - length_of(within);
    if (beyond_m > drawing.grid.cell_m) {
        result.said.push_back(fmt::format("{:.3g} km beyond the grid were left out", beyond_m / 1e3));
    }
    DrawnLine const line = line_from_stroke(drawing.grid, within);
    require_no_loop(line, false, drawing.grid.cell_m);
    CoastIndex coasts(drawing.coasts);
    std::vector<DrawnLine> const parts = parts_on_land(coasts, line, drawing.grid.cell_m, false);
    if (parts.empty()) {
        throw NotDrawn("studio.drawn", fmt::format("this lies in the sea: {}s run on land", what), line.front());
    }
    DrawnLine longest = *std::ranges::max_element(parts, {}, length_of);
    double const cut_m = length_of(line) - length_of(longest);
    if (cut_m > drawing.grid.cell_m) {
        result.said.push_back(
            fmt::format("the {} ends at the coast: {:.3g} km in the sea were left out", what, cut_m / 1e3));
    }
    return longest;
}

void require_apart_from_coasts(Drawing const& drawing, DrawnLine const& line) {
    double const near_m = touching_cells * drawing.grid.cell_m;
    geometry::SegmentIndex const index = index_segments(line);
    for (DrawnLine const& coast : drawing.coasts) {
        for (std::size_t i = 0; i + 1 < coast.size(); ++i) {
            for (std::size_t const k : index.near(coast[i], coast[i + 1], near_m)) {
                refuse_step_if(segments_cross(coast[i], coast[i + 1], line[k], line[k + 1]) ||
                                   distance_to_segment(coast[i], coast[i + 1], line[k]) < near_m ||
                                   distance_to_segment(line[k], line[k + 1], coast[i]) < near_m,
                               "the coast would cross another one here", line[k]);
            }
        }
    }
}

void cut_rivers_at_coasts(DrawResult& result) {
    Drawing& drawing = result.drawing;
    std::vector<DrawnRiver> on_land;
    double lost_m = 0.0;
    std::size_t cut = 0;
    CoastIndex coasts(drawing.coasts);
    std::set<Vec2, BeforeInPlan> ends;
    for (DrawnRiver const& river : drawing.rivers) {
        ends.insert(river.line.back());
    }
    for (DrawnRiver const& river : drawing.rivers) {
        bool const is_joined = ends.contains(river.line.front());
        double rest_m = length_of(river.line);
        for (DrawnLine& part : parts_on_land(coasts, river.line, drawing.grid.cell_m, is_joined)) {
            rest_m -= length_of(part);
            on_land.push_back(river);
            on_land.back().line = std::move(part);
        }
        if (rest_m > 1e-3) {
            ++cut;
            lost_m += rest_m;
        }
    }
    if (cut > 0) {
        result.said.push_back(fmt::format("{} into the sea: {:.3g} km were left out",
                                          count_of(cut, "river reaches", "rivers reach"), lost_m / 1e3));
    }
    drawing.rivers = std::move(on_land);
}

void apply_step(DrawResult& result, DrawCoast const& step) {
    result.name = "a coast";
    Drawing& drawing = result.drawing;
    Grid const& grid = drawing.grid;
    refuse_step_if(drawing.has_side_streams, "rivers with side streams know no coast: turn side streams off first");
    DrawnLine line = line_from_stroke(grid, step.points);
    double const apart_m = distance(line.front(), line.back());
    constexpr double gap_share = 0.15; // a gap of this share of the line is closed
    double const near_m = std::max(2.0 * snap_cells * grid.cell_m, gap_share * length_of(line));
    bool const is_closed = apart_m < near_m && !(is_at_border(grid, line.front()) && is_at_border(grid, line.back()));
    if (is_closed) {
        line.back() = line.front();
        line = remove_repeats(std::move(line));
        require_area(line, grid.cell_m);
    } else {
        carry_end_to_border(grid, line);
        std::ranges::reverse(line);
        carry_end_to_border(grid, line);
        std::ranges::reverse(line);
    }
    require_no_loop(line, is_closed, grid.cell_m);
    require_apart_from_coasts(drawing, line);
    if (is_closed && geometry::signed_area(line) < 0.0) {
        std::ranges::reverse(line); // counterclockwise: land within
    }
    if (has_rivers_in_sea(drawing, line)) {
        std::ranges::reverse(line);
        result.said.emplace_back("the land is where the rivers are; \"swap\" makes it the sea");
    }
    drawing.coasts.push_back(std::move(line));
    cut_rivers_at_coasts(result);
}

void apply_step(DrawResult& result, SwapSides const& step) {
    result.name = "land and sea swapped";
    std::ranges::reverse(line_of_part(result.drawing, {Part::Kind::coast, step.coast}, 0));
    cut_rivers_at_coasts(result);
}

std::vector<DrawnLine> coasts_of(Mask const& land) {
    constexpr double tolerance = 0.75; // [cells]
    std::vector<DrawnLine> coasts;
    for (DrawnLine const& line : land.cells() > 0 ? Outline(land).lines() : std::vector<DrawnLine>()) {
        DrawnLine coast = round_line(geometry::simplify(line, tolerance * land.grid().cell_m));
        bool const is_closed = coast.front() == coast.back();
        if (coast.size() >= (is_closed ? 4U : 2U)) {
            coasts.push_back(std::move(coast));
        }
    }
    return coasts;
}

} // namespace thalweg::studio
