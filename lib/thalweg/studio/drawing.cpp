// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/drawing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/rosgen.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/studio/internal/segment_squares.hpp>

namespace thalweg::studio {
namespace {

// [cells]
constexpr double snap = 3.0;        ///< ends nearer than this meet
constexpr double clearance = 1.5;   ///< of a new river from others
constexpr double smoothing = 2.5;   ///< of a freehand line, to each side
constexpr double coarseness = 0.25; ///< of a drawn line: it may lie that far from the hand
constexpr double least_length = 3.0;
constexpr double gap = 4.0; ///< between the parts of a river that is cut
constexpr double pace = 0.5;
constexpr double touching = 0.01;
constexpr double in_a_river = 0.75; ///< pins nearer than this lie in its cells

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// A place in the grid as files hold it: rounding must not carry it over the border.
Vec2 in_grid(Grid const& grid, Vec2 p) {
    constexpr double step_m = 1e-6;
    Vec2 q = rounded(Vec2{std::clamp(p.x, grid.west, grid.east()), std::clamp(p.y, grid.south(), grid.north)});
    q.x = q.x > grid.east() ? rounded(q.x - step_m) : q.x < grid.west ? rounded(q.x + step_m) : q.x;
    q.y = q.y > grid.north ? rounded(q.y - step_m) : q.y < grid.south() ? rounded(q.y + step_m) : q.y;
    return q;
}

DrawnLine without_repeats(DrawnLine line) {
    line.erase(std::unique(line.begin(), line.end()), line.end());
    return line;
}

/// A line as files hold it.
DrawnLine in_file(DrawnLine line) {
    std::ranges::transform(line, line.begin(), [](Vec2 p) { return rounded(p); });
    return without_repeats(std::move(line));
}

/// How far a vertex follows another that is moved. along_m: from that one along the line
double following(double along_m, double reach_m) {
    double const share = std::min(along_m / std::max(reach_m, 1e-9), 1.0);
    return (1.0 - share * share) * (1.0 - share * share);
}

/// Places along a line, evenly spaced, both ends among them.
DrawnLine resampled(DrawnLine const& line, double every_m) {
    DrawnLine places;
    for (std::size_t i = 1; i < line.size(); ++i) {
        auto const steps =
            std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(distance(line[i - 1], line[i]) / every_m)));
        for (std::int64_t k = 0; k < steps; ++k) {
            double const share = static_cast<double>(k) / static_cast<double>(steps);
            places.push_back(line[i - 1] + share * (line[i] - line[i - 1]));
        }
    }
    places.push_back(line.back());
    return places;
}

/// A line without vertices that hardly turn. Piece by piece: as a whole the time would grow with the square of a
/// scribble's length.
DrawnLine simplified(DrawnLine const& line, double tolerance_m) {
    constexpr std::size_t piece = 2048;
    DrawnLine result;
    for (std::size_t first = 0; first + 1 < line.size(); first += piece) {
        std::size_t const last = std::min(first + piece, line.size() - 1);
        auto const begin = line.begin() + static_cast<std::ptrdiff_t>(first);
        DrawnLine const part =
            geometry::simplify(DrawnLine(begin, line.begin() + static_cast<std::ptrdiff_t>(last) + 1), tolerance_m);
        result.insert(result.end(), part.begin() + (result.empty() ? 0 : 1), part.end());
    }
    return result;
}

/// A line as the hand meant it.
DrawnLine smoothed(DrawnLine const& line, double cell_m) {
    DrawnLine const places = resampled(line, pace * cell_m);
    DrawnLine result(places.size());
    auto const reach = static_cast<std::size_t>(smoothing / pace);
    for (std::size_t i = 0; i < places.size(); ++i) { // narrower towards the ends, which stay
        std::size_t const wide = std::min({reach, i, places.size() - 1 - i});
        Vec2 sum;
        for (std::size_t k = i - wide; k <= i + wide; ++k) {
            sum = sum + places[k];
        }
        result[i] = 1.0 / static_cast<double>(2 * wide + 1) * sum;
    }
    return simplified(result, coarseness * cell_m);
}

/// The longest part of a line in the grid, carried to its border.
DrawnLine inside_grid(Grid const& grid, DrawnLine const& points) {
    DrawnLine longest;
    DrawnLine part;
    for (std::size_t i = 0; i <= points.size(); ++i) {
        bool const is_in = i < points.size() && in_grid(grid, points[i]) == rounded(points[i]);
        if (is_in && part.empty() && i > 0) {
            part.push_back(in_grid(grid, points[i - 1]));
        }
        if (is_in) {
            part.push_back(points[i]);
        } else if (!part.empty()) {
            if (i < points.size()) {
                part.push_back(in_grid(grid, points[i]));
            }
            longest = length_of(part) > length_of(longest) ? part : longest;
            part.clear();
        }
    }
    return longest;
}

/// What was drawn, in the grid and finite.
DrawnLine taken(Grid const& grid, DrawnLine points) {
    constexpr std::size_t most = 100000;
    constexpr double most_cells = 50000.0;
    if (points.size() > most) {
        throw NotDrawn(fmt::format("studio.drawing: a line has at most {} points", most));
    }
    for (Vec2& p : points) {
        if (!is_finite(p)) {
            throw NotDrawn("studio.drawing: a place that is not a number");
        }
        p = in_grid(grid, p);
    }
    points = without_repeats(std::move(points));
    if (points.size() < 2) {
        throw NotDrawn("studio.drawing: a line has two places at least",
                       points.empty() ? std::nullopt : std::optional(points.front()));
    }
    if (length_of(points) > most_cells * grid.cell_m) {
        throw NotDrawn(fmt::format("studio.drawing: a line is at most {:.0f} cells long; draw it in parts", most_cells),
                       points.front());
    }
    return points;
}

DrawnLine stroke_of(Grid const& grid, DrawnLine points) {
    DrawnLine line = in_file(smoothed(taken(grid, std::move(points)), grid.cell_m));
    if (line.size() < 2 || length_of(line) < least_length * grid.cell_m) {
        throw NotDrawn(fmt::format("studio.drawing: this line is shorter than {} cells", least_length), line.front());
    }
    return line;
}

/// Whether two segments meet between their ends.
bool cross_over(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    double const ca = cross(c, d, a);
    double const cb = cross(c, d, b);
    double const ac = cross(a, b, c);
    double const ad = cross(a, b, d);
    bool const apart = (ca < 0.0 && cb > 0.0) || (ca > 0.0 && cb < 0.0);
    return apart && ((ac < 0.0 && ad > 0.0) || (ac > 0.0 && ad < 0.0));
}

/// \param near_m [m] a line that comes nearer to itself touches itself
void require_no_loop(DrawnLine const& line, bool is_closed, double near_m) {
    std::size_t const segments = line.size() - 1;
    auto const meet = [&](std::size_t i, std::size_t k) {
        if (is_closed && i == 0 && k + 1 == segments) {
            return false; // it ends where it begins
        }
        return (k > i + 1 && cross_over(line[i], line[i + 1], line[k], line[k + 1])) ||
               distance(geometry::foot_on(line[i], line[i + 1], line[k + 1]).at, line[k + 1]) < near_m ||
               distance(geometry::foot_on(line[k], line[k + 1], line[i]).at, line[i]) < near_m;
    };
    SegmentSquares const squares = SegmentSquares::of_line(line, near_m);
    for (std::size_t k = 1; k < segments; ++k) {
        for (std::size_t const i : squares.near(line[k], line[k + 1], near_m)) {
            if (i < k && meet(i, k)) {
                throw NotDrawn("studio.drawing: the line crosses itself here", line[k]);
            }
        }
    }
}

/// A place on one of the rivers.
struct Spot {
    std::size_t river = none;
    std::size_t segment = 0;
    Vec2 at;
    double away_m = infinite;
};

/// The place on another river that is nearest.
Spot nearest_on_rivers(Drawing const& drawing, Vec2 p, std::size_t without, double reach_m) {
    Spot nearest;
    nearest.away_m = reach_m;
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        DrawnLine const& line = drawing.rivers[r].line;
        for (std::size_t i = 0; r != without && i + 1 < line.size(); ++i) {
            Vec2 const foot = geometry::foot_on(line[i], line[i + 1], p).at;
            double const away_m = distance(foot, p);
            if (away_m < nearest.away_m) {
                nearest = {r, i, foot, away_m};
            }
        }
    }
    return nearest;
}

/// Makes a place on a river one of its vertices. Returns where it is then: one that lies near is taken.
Vec2 vertex_at(Drawing& drawing, Spot const& spot) {
    DrawnLine& line = drawing.rivers[spot.river].line;
    Vec2 const begin = line[spot.segment];
    Vec2 const end = line[spot.segment + 1];
    Vec2 const nearer = distance(begin, spot.at) <= distance(end, spot.at) ? begin : end;
    Vec2 const at = rounded(spot.at);
    if (distance(nearer, at) <= clearance * drawing.grid.cell_m) {
        return nearer;
    }
    line.insert(line.begin() + static_cast<std::ptrdiff_t>(spot.segment) + 1, at);
    return at;
}

/// A river's vertex.
struct VertexOf {
    std::size_t river = none;
    std::size_t vertex = 0;
};

/// Where water goes from the end of each river: the vertex of another one, which runs on from there; none: an outlet.
std::vector<VertexOf> ways_down(Drawing const& drawing) {
    std::map<std::pair<double, double>, std::vector<VertexOf>> at; // of every vertex but an outlet
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        Vec2 const end = drawing.rivers[r].line.back();
        at[{end.x, end.y}];
    }
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        DrawnLine const& line = drawing.rivers[r].line;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            if (auto const found = at.find({line[i].x, line[i].y}); found != at.end()) {
                found->second.push_back({r, i});
            }
        }
    }
    std::vector<VertexOf> below(drawing.rivers.size());
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        Vec2 const end = drawing.rivers[r].line.back();
        for (VertexOf const& one : at[{end.x, end.y}]) {
            below[r] = below[r].river == none && one.river != r ? one : below[r];
        }
    }
    return below;
}

/// Whether a place of a river is its outlet.
bool is_outlet(Drawing const& drawing, Spot const& spot) {
    return distance(drawing.rivers[spot.river].line.back(), spot.at) <= drawing.grid.cell_m &&
           ways_down(drawing)[spot.river].river == none;
}

/// Whether water from a river comes by another.
bool flows_through(Drawing const& drawing, std::size_t from, std::size_t through) {
    std::vector<VertexOf> const below = ways_down(drawing);
    for (std::size_t rounds = 0; from != none && rounds <= drawing.rivers.size(); ++rounds) {
        if (from == through) {
            return true;
        }
        from = below[from].river;
    }
    return false;
}

/// Rivers that begin where others end go on from the longest of these: none begins at another's end any more.
std::vector<DrawnRiver> as_streams(Drawing const& drawing) {
    std::vector<VertexOf> const below = ways_down(drawing);
    std::vector<std::vector<std::size_t>> above(below.size()); // those that end where a river begins
    std::vector<std::size_t> upwards;
    for (std::size_t r = 0; r < below.size(); ++r) {
        if (below[r].river != none && below[r].vertex == 0) {
            above[below[r].river].push_back(r);
        } else {
            upwards.push_back(r);
        }
    }
    for (std::size_t i = 0; i < upwards.size(); ++i) {
        upwards.insert(upwards.end(), above[upwards[i]].begin(), above[upwards[i]].end());
    }
    std::vector<DrawnRiver> streams = drawing.rivers;
    std::vector<std::size_t> gone;
    for (auto river = upwards.rbegin(); river != upwards.rend(); ++river) {
        std::vector<std::size_t> const& from = above[*river];
        if (from.empty()) {
            continue;
        }
        std::size_t const longest =
            *std::ranges::max_element(from, {}, [&](std::size_t r) { return length_of(streams[r].line); });
        DrawnLine line = std::move(streams[longest].line);
        line.insert(line.end(), streams[*river].line.begin() + 1, streams[*river].line.end());
        streams[*river].line = std::move(line);
        gone.push_back(longest);
    }
    std::ranges::sort(gone, std::greater());
    for (std::size_t const r : gone) {
        streams.erase(streams.begin() + static_cast<std::ptrdiff_t>(r));
    }
    return streams;
}

/// The vertices that two rivers share.
DrawnLine joints_of(DrawnLine const& one, DrawnLine const& other) {
    std::set<std::pair<double, double>> places;
    for (Vec2 const q : one) {
        places.insert({q.x, q.y});
    }
    DrawnLine joints;
    std::ranges::copy_if(other, std::back_inserter(joints), [&](Vec2 q) { return places.contains({q.x, q.y}); });
    return joints;
}

/// The distance from the nearest of some places.
double distance_from(DrawnLine const& places, Vec2 p) {
    double least = infinite;
    for (Vec2 const q : places) {
        least = std::min(least, distance(p, q));
    }
    return least;
}

/// The box around places.
struct Box {
    Vec2 low;
    Vec2 high;

    explicit Box(std::span<Vec2 const> places) : low(places.front()), high(low) {
        for (Vec2 const p : places) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    }

    /// Whether a segment lies beside it, by a distance at least.
    bool is_apart(Vec2 a, Vec2 b, double by_m) const {
        return std::max(a.x, b.x) < low.x - by_m || std::min(a.x, b.x) > high.x + by_m ||
               std::max(a.y, b.y) < low.y - by_m || std::min(a.y, b.y) > high.y + by_m;
    }
};

/// The nearest place on a line of several, and whether it lies at the line's left.
struct Beside {
    std::size_t line = none;
    Vec2 at;
    double away_m = infinite;
    bool is_left = true;
};

/// Coasts, for many places.
class Coasts {
public:
    explicit Coasts(std::vector<DrawnLine> const& lines) : lines_(lines) {
        constexpr std::size_t together = 16;
        for (std::size_t c = 0; c < lines.size(); ++c) {
            for (std::size_t i = 0; i + 1 < lines[c].size(); i += together) {
                std::size_t const end = std::min(i + together, lines[c].size() - 1);
                stretches_.push_back({c, i, end, Box(std::span(lines[c]).subspan(i, end + 1 - i))});
            }
        }
    }

    bool empty() const { return lines_.empty(); }

    Beside nearest(Vec2 p) {
        constexpr double tie = 1e-9;
        // The nearest place is no farther than from where was asked last.
        double const most_m = (last_m_ + distance(last_, p)) * (1.0 + 4.0 * tie) + tie;
        Beside nearest;
        // Of two that meet at the nearest place the one with the greater distance from its straight line.
        double aside = 0.0;
        for (Stretch const& one : stretches_) {
            Vec2 const beside{std::max({one.box.low.x - p.x, p.x - one.box.high.x, 0.0}),
                              std::max({one.box.low.y - p.y, p.y - one.box.high.y, 0.0})};
            for (std::size_t i = one.begin; dot(beside, beside) <= most_m * most_m && i < one.end; ++i) {
                Vec2 const a = lines_[one.line][i];
                Vec2 const b = lines_[one.line][i + 1];
                Vec2 const foot = geometry::foot_on(a, b, p).at;
                double const away_m = distance(foot, p);
                double const turn = cross(a, b, p) / distance(a, b);
                bool const is_nearer = away_m < nearest.away_m * (1.0 - tie);
                if (is_nearer || (away_m <= nearest.away_m * (1.0 + tie) && std::fabs(turn) > aside)) {
                    nearest = {one.line, foot, away_m, turn >= 0.0};
                    aside = std::fabs(turn);
                }
            }
        }
        last_ = p;
        last_m_ = nearest.away_m;
        return nearest;
    }

private:
    /// Segments that follow one another, and the box around them.
    struct Stretch {
        std::size_t line;
        std::size_t begin;
        std::size_t end;
        Box box;
    };

    std::vector<DrawnLine> const& lines_;
    std::vector<Stretch> stretches_;
    Vec2 last_;
    double last_m_ = infinite;
};

Beside nearest_coast(std::vector<DrawnLine> const& coasts, Vec2 p) {
    return Coasts(coasts).nearest(p);
}

/// Where two lines cross, the first place along one; nothing: nowhere. squares: of one; around: one
std::optional<Vec2> crossing_of(DrawnLine const& one, SegmentSquares const& squares, Box const& around,
                                DrawnLine const& other) {
    std::pair<std::size_t, std::size_t> first{none, none};
    for (std::size_t k = 0; k + 1 < other.size(); ++k) {
        if (around.is_apart(other[k], other[k + 1], 0.0)) {
            continue;
        }
        for (std::size_t const i : squares.near(other[k], other[k + 1], 0.0)) {
            if (std::pair(i, k) < first && cross_over(one[i], one[i + 1], other[k], other[k + 1])) {
                first = {i, k};
            }
        }
    }
    if (first.first == none) {
        return std::nullopt;
    }
    auto const [i, k] = first;
    double const from = cross(other[k], other[k + 1], one[i]);
    double const to = cross(other[k], other[k + 1], one[i + 1]);
    return one[i] + from / (from - to) * (one[i + 1] - one[i]);
}

/// Whether a place lies in the sea, and not on the coast itself.
bool lies_in_sea(Drawing const& drawing, Beside const& coast) {
    return !coast.is_left && coast.away_m > touching * drawing.grid.cell_m;
}

/// \param near_m [m] > 0
SegmentSquares squares_of_places(DrawnLine const& places, double near_m) {
    SegmentSquares squares(2.0 * near_m);
    for (std::size_t i = 0; i < places.size(); ++i) {
        squares.add(i, places[i], places[i]);
    }
    return squares;
}

/// Which of some places lie nearer than that to one of some lines.
template <class Lines> std::vector<bool> near_lines(DrawnLine const& places, Lines const& lines, double near_m) {
    std::vector<bool> is_near(places.size());
    if (places.empty()) {
        return is_near;
    }
    Box const around(places);
    SegmentSquares const squares = squares_of_places(places, near_m);
    for (auto const& one : lines) {
        for (std::size_t k = 0; k + 1 < one.line.size(); ++k) {
            Vec2 const a = one.line[k];
            Vec2 const b = one.line[k + 1];
            if (around.is_apart(a, b, near_m)) {
                continue;
            }
            for (std::size_t const i : squares.near(a, b, near_m)) {
                is_near[i] = is_near[i] || distance(geometry::foot_on(a, b, places[i]).at, places[i]) < near_m;
            }
        }
    }
    return is_near;
}

/// The first of some places along a line that lies nearer than that to one of some lines.
template <class Line>
std::optional<Vec2> touched(DrawnLine const& places, std::vector<Line> const& lines, double near_m) {
    std::vector<bool> const is_near = near_lines(places, lines, near_m);
    auto const first = std::ranges::find(is_near, true);
    return first == is_near.end() ? std::nullopt
                                  : std::optional(places[static_cast<std::size_t>(first - is_near.begin())]);
}

/// Throws where a stretch of a river lies in the sea, crosses another or comes too near, but for where they meet.
void require_clear(Drawing const& drawing, std::size_t river, std::size_t first, std::size_t last, double clear_m) {
    constexpr double widening = 0.2; // rivers part by more than this share of the way from where they meet
    DrawnLine const& line = drawing.rivers[river].line;
    DrawnLine const changed(line.begin() + static_cast<std::ptrdiff_t>(first),
                            line.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    DrawnLine const stretch = resampled(changed, pace * drawing.grid.cell_m);
    Coasts coasts(drawing.coasts);
    for (Vec2 const p : stretch) {
        if (lies_in_sea(drawing, coasts.nearest(p))) {
            throw NotDrawn("studio.drawing: the river would run through the sea here", p);
        }
    }
    if (auto const at = touched(stretch, drawing.ridges, 0.5 * clearance * drawing.grid.cell_m)) {
        throw NotDrawn("studio.drawing: the river would cross or touch a ridge here: no water crosses it. Move or "
                       "erase the ridge first",
                       at);
    }
    Box const around(stretch);
    SegmentSquares const segments = SegmentSquares::of_line(changed, drawing.grid.cell_m);
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        std::optional<Vec2> const at =
            r != river ? crossing_of(changed, segments, around, drawing.rivers[r].line) : std::optional<Vec2>();
        if (at) {
            throw NotDrawn("studio.drawing: the river would cross another one here; let it end there instead", at);
        }
    }
    SegmentSquares const places = squares_of_places(stretch, clear_m);
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        DrawnLine const& other = drawing.rivers[r].line;
        std::optional<DrawnLine> joints;
        for (std::size_t i = 0; r != river && i + 1 < other.size(); ++i) {
            Vec2 const a = other[i];
            Vec2 const b = other[i + 1];
            if (around.is_apart(a, b, clear_m)) {
                continue;
            }
            for (std::size_t const number : places.near(a, b, clear_m)) {
                Vec2 const p = stretch[number];
                double const away_m = distance(geometry::foot_on(a, b, p).at, p);
                if (away_m >= clear_m) {
                    continue;
                }
                joints = joints ? joints : joints_of(line, other);
                double const along_m = distance_from(*joints, p);
                if (away_m >= std::min(clear_m, widening * along_m) || along_m < drawing.grid.cell_m) {
                    continue;
                }
                throw NotDrawn(fmt::format("studio.drawing: it comes too near to another river here: keep {} cells "
                                           "apart, or let it end there",
                                           clear_m / drawing.grid.cell_m),
                               p);
            }
        }
    }
}

void require_clear(Drawing const& drawing, std::size_t river, double clear_m) {
    require_clear(drawing, river, 0, drawing.rivers[river].line.size() - 1, clear_m);
}

} // namespace

bool is_land(Drawing const& drawing, Vec2 at) {
    return nearest_coast(drawing.coasts, at).is_left;
}

namespace {

/// The place on the border that is nearest.
Vec2 on_border(Grid const& grid, Vec2 p) {
    std::pair<double, Vec2> const sides[] = {{p.x - grid.west, {grid.west, p.y}},
                                             {grid.east() - p.x, {grid.east(), p.y}},
                                             {p.y - grid.south(), {p.x, grid.south()}},
                                             {grid.north - p.y, {p.x, grid.north}}};
    return in_grid(grid, std::ranges::min_element(sides, {}, &std::pair<double, Vec2>::first)->second);
}

/// Where a straight line from land to sea leaves the land.
Vec2 shore_between(Coasts& coasts, Vec2 land, Vec2 sea) {
    constexpr int halvings = 30;
    for (int i = 0; i < halvings; ++i) {
        Vec2 const middle = 0.5 * (land + sea);
        (coasts.nearest(middle).is_left ? land : sea) = middle;
    }
    return rounded(land);
}

/// The parts of a line that lie on land, in its order, without short ones.
/// \param keeps_head its first part may be short: others end where it begins
std::vector<DrawnLine> parts_on_land(Coasts& coasts, DrawnLine const& line, double cell_m, bool keeps_head) {
    if (coasts.empty()) {
        return {line};
    }
    constexpr double on_coast_m = 1e-5; // where rivers meet on the coast, rounding puts none of them into the sea
    std::vector<DrawnLine> parts;
    bool was_land = false;
    Vec2 before = line.front();
    auto const step = [&](Vec2 p, bool is_vertex) {
        Beside const coast = coasts.nearest(p);
        bool const is_on_land = coast.is_left || coast.away_m < on_coast_m;
        if (is_on_land && !was_land) {
            parts.emplace_back();
            if (p != line.front()) {
                parts.back().push_back(shore_between(coasts, p, before));
            }
        }
        if (was_land && !is_on_land) {
            parts.back().push_back(shore_between(coasts, before, p));
        } else if (is_on_land && is_vertex) {
            parts.back().push_back(p);
        }
        was_land = is_on_land;
        before = p;
    };
    step(line.front(), true);
    for (std::size_t i = 1; i < line.size(); ++i) {
        DrawnLine const places = resampled({line[i - 1], line[i]}, pace * cell_m);
        for (std::size_t k = 1; k < places.size(); ++k) {
            step(places[k], k + 1 == places.size());
        }
    }
    for (DrawnLine& part : parts) {
        part = without_repeats(std::move(part));
    }
    // A line that is short itself stays where it lies on land.
    double const least_m = std::min(least_length * cell_m, length_of(line) - touching * cell_m);
    std::erase_if(parts, [&](DrawnLine const& part) {
        bool const is_head = keeps_head && !part.empty() && part.front() == line.front();
        return part.size() < 2 || (length_of(part) < least_m && !is_head);
    });
    return parts;
}

/// What an end of a new river meets.
struct End {
    enum class Meets : std::uint8_t { nothing, border, coast, river } meets = Meets::nothing;
    Vec2 at;
    Spot on;                ///< of a river
    bool continues = false; ///< it is the outlet of that river
};

End end_of(Drawing const& drawing, Vec2 p, std::size_t without) {
    double const reach_m = snap * drawing.grid.cell_m;
    Spot const spot = nearest_on_rivers(drawing, p, without, reach_m);
    if (spot.river != none) {
        return {End::Meets::river, spot.at, spot, is_outlet(drawing, spot)};
    }
    Beside const coast = nearest_coast(drawing.coasts, p);
    if (coast.away_m < reach_m) {
        return {End::Meets::coast, rounded(coast.at), {}};
    }
    Vec2 const edge = on_border(drawing.grid, p);
    if (distance(edge, p) < reach_m) {
        return {End::Meets::border, edge, {}};
    }
    return {End::Meets::nothing, p, {}};
}

bool can_begin(End const& end) {
    return end.meets != End::Meets::river || end.continues;
}

/// Where an end that was cut back, or snapped, lies now; places that it passed go.
void set_end(DrawnLine& line, Vec2 at, double cell_m) {
    while (line.size() > 2 && distance(line[line.size() - 2], at) < cell_m) {
        line.erase(line.end() - 2);
    }
    line.back() = at;
}

void require_type(std::string const& type, int lambda) {
    constexpr int most = 50;
    refuse_if<BadParameter>(!type.empty() && !rosgen_of(type),
                            "studio.drawing: {} is no river type: Aa+, A, B, C, D, DA, E, F and G are", type);
    refuse_if<BadParameter>(lambda < 0 || lambda > most, "studio.drawing: lambda = {} is outside [1, {}]", lambda,
                            most);
}

std::size_t require_river(Drawing const& drawing, std::size_t river) {
    if (river >= drawing.rivers.size()) {
        throw NotDrawn(fmt::format("studio.drawing: there is no river {}", river));
    }
    return river;
}

std::string many(std::size_t count, char const* one, char const* more) {
    return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more);
}

/// A step on its drawing.
class Hand {
public:
    explicit Hand(Drawing drawing) : is_(std::move(drawing)) {}

    Drawn result() { return {std::move(is_), std::move(name_), std::move(said_)}; }

    void operator()(DrawRiver const& step) {
        name_ = "a river";
        require_type(step.type, step.lambda);
        DrawnLine line = stroke_on_land(step.points, "river");
        End begin = end_of(is_, line.front(), none);
        End end = end_of(is_, line.back(), none);
        if (is_upstream(begin, end)) {
            std::ranges::reverse(line);
            std::swap(begin, end);
            said_.emplace_back("the river runs against your stroke, to where it meets other water");
        }
        bool const begins_and_ends_on_one = begin.on.river != none && begin.on.river == end.on.river;
        if (begins_and_ends_on_one ||
            (begin.on.river != none && end.on.river != none && flows_through(is_, end.on.river, begin.on.river))) {
            throw NotDrawn("studio.drawing: the river would flow in a circle", end.at);
        }
        if (end.meets != End::Meets::nothing) {
            set_end(line, end.on.river == none ? end.at : vertex_at(is_, end.on), is_.grid.cell_m);
        }
        if (begin.meets != End::Meets::nothing) { // numbers of segments hold: the other river is another one
            std::ranges::reverse(line);
            set_end(line, begin.on.river == none ? begin.at : is_.rivers[begin.on.river].line.back(), is_.grid.cell_m);
            std::ranges::reverse(line);
        }
        if (length_of(line) < least_length * is_.grid.cell_m) {
            throw NotDrawn(fmt::format("studio.drawing: the river would be shorter than {} cells", least_length),
                           line.back());
        }
        is_.rivers.push_back({std::move(line), step.type, step.lambda});
        require_clear(is_, is_.rivers.size() - 1, clearance * is_.grid.cell_m);
        DrawnLine pins;
        std::ranges::transform(is_.pins, std::back_inserter(pins), &DrawnPin::at);
        auto const is_wet = near_lines(pins, std::span(&is_.rivers.back(), 1), in_a_river * is_.grid.cell_m);
        auto const in_river = std::ranges::count(is_wet, true);
        if (in_river > 0) {
            said_.push_back(fmt::format("{} in the river now: the river's height decides there",
                                        many(static_cast<std::size_t>(in_river), "pin lies", "pins lie")));
        }
    }

    void operator()(MoveVertex const& step) {
        if (step.of.kind == Part::Kind::pin) {
            name_ = "a pin moved";
            DrawnPin& pin = pin_of(step.of.number);
            pin.at = place_of_pin(step.to, step.of.number);
            return;
        }
        DrawnLine& line = line_of(step.of, step.vertex);
        name_ = fmt::format("{} moved", called(step.of));
        Vec2 to = in_grid(is_.grid, step.to);
        if (step.of.kind != Part::Kind::river) {
            moved_shape(line, step, to);
            return;
        }
        std::size_t const river = step.of.number;
        Vec2 const from = line[step.vertex];
        bool const is_free = !is_shared(river, from);
        bool const is_end = step.vertex + 1 == line.size();
        bool const is_begin = step.vertex == 0;
        if (is_free && (is_end || is_begin)) {
            End const end = end_of(is_, to, river);
            if (end.meets == End::Meets::river) {
                join(river, is_begin, end);
                return;
            }
            to = rounded(end.at);
        }
        if (lies_in_sea(is_, nearest_coast(is_.coasts, to))) { // an end that snapped lies on the coast
            throw NotDrawn("studio.drawing: this place lies in the sea", to);
        }
        move(river, step.vertex, to, step.reach_m);
    }

    void operator()(InsertVertex const& step) {
        require_vertices(step.of);
        DrawnLine& line = line_of(step.of, 0);
        name_ = fmt::format("a vertex of {}", called(step.of));
        bool const is_line = step.of.kind != Part::Kind::lake && step.of.kind != Part::Kind::mask;
        if (step.vertex > line.size() || (is_line && (step.vertex == 0 || step.vertex == line.size()))) {
            throw NotDrawn("studio.drawing: a vertex is put between two others");
        }
        auto const before = static_cast<std::ptrdiff_t>(step.vertex);
        line.insert(line.begin() + before, in_grid(is_.grid, step.at));
        if (step.of.kind == Part::Kind::ridge) {
            auto& heights_m = is_.ridges[step.of.number].heights_m;
            heights_m.insert(heights_m.begin() + before, std::nullopt);
        }
        settle(step.of, step.vertex, step.vertex);
    }

    void operator()(RemoveVertex const& step) {
        require_vertices(step.of);
        DrawnLine& line = line_of(step.of, step.vertex);
        name_ = fmt::format("a vertex of {} removed", called(step.of));
        Vec2 const at = line[step.vertex];
        bool const is_river = step.of.kind == Part::Kind::river;
        if (is_river && is_shared(step.of.number, at) && step.vertex + 1 != line.size()) {
            throw NotDrawn("studio.drawing: another river joins here: move it first", at);
        }
        bool const is_closed = step.of.kind == Part::Kind::coast && line.front() == line.back();
        bool const is_coast = step.of.kind == Part::Kind::coast;
        bool const is_open = is_river || step.of.kind == Part::Kind::ridge || (is_coast && !is_closed);
        std::size_t const least = is_open ? 2 : is_closed ? 4 : 3;
        if (line.size() <= least) {
            throw NotDrawn("studio.drawing: no vertex more can go: erase it as a whole", at);
        }
        line.erase(line.begin() + static_cast<std::ptrdiff_t>(step.vertex));
        if (step.of.kind == Part::Kind::ridge) {
            remove_height(is_.ridges[step.of.number].heights_m, step.vertex);
        }
        if (is_closed && (step.vertex == 0 || step.vertex == line.size())) {
            (step.vertex == 0 ? line.back() : line.front()) = step.vertex == 0 ? line.front() : line.back();
        }
        std::size_t const last = line.size() - 1;
        settle(step.of, std::min(step.vertex, last), std::min(step.vertex, last));
    }

    void operator()(CutRiver const& step) {
        name_ = "a river cut";
        std::size_t const river = require_river(is_, step.river);
        DrawnLine const& line = is_.rivers[river].line;
        Spot spot;
        Vec2 const place = in_grid(is_.grid, step.at);
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            Vec2 const foot = geometry::foot_on(line[i], line[i + 1], place).at;
            if (distance(foot, place) < spot.away_m) {
                spot = {river, i, foot, distance(foot, place)};
            }
        }
        Vec2 const at = vertex_at(is_, spot);
        DrawnLine const whole = is_.rivers[river].line;
        auto const middle = std::ranges::find(whole, at);
        DrawnLine upper(whole.begin(), middle + 1);
        DrawnLine lower(middle, whole.end());
        double const least_m = least_length * is_.grid.cell_m;
        if (length_of(lower) < least_m || length_of(upper) < least_m + gap * is_.grid.cell_m) {
            throw NotDrawn("studio.drawing: too near to its end to be cut", at);
        }
        shorten(upper, river);
        is_.rivers[river].line = std::move(lower);
        DrawnRiver above = is_.rivers[river];
        above.line = std::move(upper);
        is_.rivers.push_back(std::move(above));
    }

    void operator()(JoinRiver const& step) {
        name_ = "rivers joined";
        std::size_t const river = require_river(is_, step.river);
        Vec2 const end = step.at_source ? is_.rivers[river].line.front() : is_.rivers[river].line.back();
        if (is_shared(river, end)) {
            throw NotDrawn("studio.drawing: this end meets another river already: cut it off first", end);
        }
        join(river, step.at_source, end_of(is_, in_grid(is_.grid, step.at), river));
    }

    void operator()(ReverseRiver const& step) {
        name_ = "a river reversed";
        std::size_t river = require_river(is_, step.river);
        std::size_t vertex = 0;
        // All ways are found before the first river runs the other way.
        std::vector<VertexOf> const below = ways_down(is_);
        std::vector<VertexOf> way;
        for (; river != none && way.size() <= is_.rivers.size();) {
            way.push_back({river, vertex});
            VertexOf const next = below[river];
            river = next.river;
            vertex = next.vertex;
        }
        for (VertexOf const& one : way) {
            DrawnRiver turned = is_.rivers[one.river];
            DrawnLine const line = turned.line;
            turned.line.assign(line.rbegin(), line.rend() - static_cast<std::ptrdiff_t>(one.vertex));
            if (one.vertex == 0) {
                is_.rivers[one.river] = std::move(turned);
            } else {
                is_.rivers[one.river].line.resize(one.vertex + 1);
                is_.rivers.push_back(std::move(turned));
            }
        }
        if (way.size() > 1) {
            said_.push_back(fmt::format("{} below it run the other way too", many(way.size() - 1, "river", "rivers")));
        }
    }

    void operator()(Erase const& step) {
        require_there(step.of);
        name_ = fmt::format("{} erased", called(step.of));
        std::size_t const number = step.of.number;
        switch (step.of.kind) {
        case Part::Kind::river: erase_river(number, step.alone); break;
        case Part::Kind::coast: remove(is_.coasts, number); break;
        case Part::Kind::lake: remove(is_.lakes, number); break;
        case Part::Kind::mask:
            remove(is_.masks, number);
            if (number < is_.mask_islands.size()) {
                remove(is_.mask_islands, number);
            }
            break;
        case Part::Kind::pin: remove(is_.pins, number); break;
        case Part::Kind::ridge: remove(is_.ridges, number); break;
        }
    }

    void operator()(SetType const& step) {
        name_ = fmt::format("river type {}", step.type.empty() ? "none" : step.type);
        require_type(step.type, 0);
        for (std::size_t const river : step.rivers) {
            is_.rivers[require_river(is_, river)].type = step.type;
        }
    }
    void operator()(SetLambda const& step) {
        name_ = fmt::format("lambda = {}", step.lambda);
        require_type("", step.lambda);
        for (std::size_t const river : step.rivers) {
            is_.rivers[require_river(is_, river)].lambda = step.lambda;
        }
    }
    void operator()(SetSideStreams const& step) {
        name_ = step.on ? "with side streams" : "without side streams";
        if (step.on && !is_.coasts.empty()) {
            throw NotDrawn("studio.drawing: rivers with side streams know no coast: erase the coasts, or draw the side "
                           "streams yourself");
        }
        is_.has_side_streams = step.on;
    }

    void operator()(DrawCoast const& step) {
        name_ = "a coast";
        if (is_.has_side_streams) {
            throw NotDrawn("studio.drawing: rivers with side streams know no coast: turn side streams off first");
        }
        DrawnLine line = stroke_of(is_.grid, step.points);
        double const apart_m = distance(line.front(), line.back());
        constexpr double nearly = 0.15; // of the line's length
        double const near_m = std::max(2.0 * snap * is_.grid.cell_m, nearly * length_of(line));
        bool const is_closed = apart_m < near_m && !(at_border(line.front()) && at_border(line.back()));
        if (is_closed) {
            line.back() = line.front();
            line = without_repeats(std::move(line));
            require_area(line);
        } else {
            carry_to_border(line);
            std::ranges::reverse(line);
            carry_to_border(line);
            std::ranges::reverse(line);
        }
        require_no_loop(line, is_closed, touching * is_.grid.cell_m);
        require_apart(line);
        if (is_closed && geometry::signed_area(line) < 0.0) {
            std::ranges::reverse(line); // counterclockwise: land within
        }
        if (prefers_other_side(line)) {
            std::ranges::reverse(line);
            said_.emplace_back("the land is where the rivers are; \"swap\" makes it the sea");
        }
        is_.coasts.push_back(std::move(line));
        cut_at_coasts();
    }
    void operator()(SwapSides const& step) {
        name_ = "land and sea swapped";
        line_of({Part::Kind::coast, step.coast}, 0);
        std::ranges::reverse(is_.coasts[step.coast]);
        cut_at_coasts();
    }

    void operator()(DrawLake const& step) {
        name_ = "a lake";
        DrawnLine ring = ring_of(step.points);
        bool const has_river = std::ranges::any_of(is_.rivers, [&](DrawnRiver const& river) {
            return std::ranges::any_of(resampled(river.line, is_.grid.cell_m),
                                       [&](Vec2 p) { return geometry::contains(ring, p); });
        });
        if (!has_river) {
            said_.emplace_back("no river runs through this lake: it holds water only where one does");
        }
        is_.lakes.push_back({{std::move(ring)}, level_of(step.level_m)});
    }
    void operator()(SetLevel const& step) {
        line_of({Part::Kind::lake, step.lake}, 0);
        is_.lakes[step.lake].level_m = level_of(step.level_m);
        name_ = step.level_m ? fmt::format("lake level {} m", *step.level_m) : "lake level by the terrain";
    }
    void operator()(DrawMask const& step) {
        name_ = "a mask";
        is_.masks.push_back(ring_of(step.points));
    }

    void operator()(DrawPin const& step) {
        name_ = fmt::format("a pin at {} m", step.height_m);
        require_height(step.height_m, "the height of a pin");
        is_.pins.push_back({place_of_pin(step.at, none), step.height_m});
    }
    void operator()(SetHeight const& step) {
        name_ = fmt::format("pin height {} m", step.height_m);
        require_height(step.height_m, "the height of a pin");
        pin_of(step.pin).height_m = step.height_m;
    }
    void operator()(DrawRidge const& step) {
        name_ = "a ridge";
        DrawnLine line = short_of_rivers(stroke_on_land(step.points, "ridge"));
        is_.ridges.push_back({std::move(line), {}});
        set_ends(is_.ridges.back(), step.from_m, step.to_m);
    }
    void operator()(SetRidgeHeights const& step) {
        line_of({Part::Kind::ridge, step.ridge}, 0);
        set_ends(is_.ridges[step.ridge], step.from_m, step.to_m);
        name_ = step.from_m || step.to_m ? "heights of a ridge" : "a ridge with the terrain's heights";
    }
    void operator()(Clear const&) {
        name_ = "an empty sheet";
        Drawing empty;
        empty.grid = is_.grid;
        is_ = std::move(empty);
    }

private:
    template <class T> static void remove(std::vector<T>& from, std::size_t number) {
        from.erase(from.begin() + static_cast<std::ptrdiff_t>(number));
    }

    static char const* called(Part const& part) {
        static constexpr char const* names[] = {"a river", "a coast", "a lake", "a mask", "a pin", "a ridge"};
        return names[static_cast<std::size_t>(part.kind)];
    }

    void require_there(Part const& part) const {
        std::size_t const counts[] = {is_.rivers.size(), is_.coasts.size(), is_.lakes.size(),
                                      is_.masks.size(),  is_.pins.size(),   is_.ridges.size()};
        if (part.number >= counts[static_cast<std::size_t>(part.kind)]) {
            throw NotDrawn(
                fmt::format("studio.drawing: {} with the number {} is not there", called(part), part.number));
        }
    }

    static void require_vertices(Part const& part) {
        if (part.kind == Part::Kind::pin) {
            throw NotDrawn("studio.drawing: a pin is one place: it has no vertices");
        }
    }

    /// The line of a part that has one, and in it a vertex.
    DrawnLine& line_of(Part const& part, std::size_t vertex) {
        require_there(part);
        DrawnLine& line = part.kind == Part::Kind::river   ? is_.rivers[part.number].line
                          : part.kind == Part::Kind::coast ? is_.coasts[part.number]
                          : part.kind == Part::Kind::lake  ? is_.lakes[part.number].rings.front()
                          : part.kind == Part::Kind::ridge ? is_.ridges[part.number].line
                                                           : is_.masks[part.number];
        if (vertex >= line.size()) {
            throw NotDrawn(fmt::format("studio.drawing: {} has no vertex {}", called(part), vertex));
        }
        return line;
    }

    static void require_height(double height_m, char const* what) {
        constexpr double deepest = -12000.0;
        constexpr double highest = 30000.0;
        refuse_if<BadParameter>(!(height_m >= deepest && height_m <= highest),
                                "studio.drawing: {} lies between {} and {} m", what, deepest, highest);
    }

    static std::optional<double> level_of(std::optional<double> level_m) {
        if (level_m) {
            require_height(*level_m, "a lake's level");
        }
        return level_m;
    }

    DrawnPin& pin_of(std::size_t number) {
        require_there({Part::Kind::pin, number});
        return is_.pins[number];
    }

    /// \param moved the number of a pin that is moved; none: it is a new one
    Vec2 place_of_pin(Vec2 wanted, std::size_t moved) const {
        if (!is_finite(wanted)) {
            throw NotDrawn("studio.drawing: a place that is not a number");
        }
        Vec2 const at = in_grid(is_.grid, wanted);
        if (lies_in_sea(is_, nearest_coast(is_.coasts, at))) {
            throw NotDrawn("studio.drawing: this place lies in the sea: a pin stands on land", at);
        }
        if (nearest_on_rivers(is_, at, none, in_a_river * is_.grid.cell_m).river != none) {
            throw NotDrawn("studio.drawing: a river runs here, and its height decides: set the pin beside it", at);
        }
        for (std::size_t i = 0; i < is_.pins.size(); ++i) {
            if (i != moved && is_.grid.cell_of(is_.pins[i].at) == is_.grid.cell_of(at)) {
                throw NotDrawn("studio.drawing: there is a pin in this cell already: set its height", at);
            }
        }
        return at;
    }

    static void set_ends(DrawnRidge& ridge, std::optional<double> from_m, std::optional<double> to_m) {
        for (std::optional<double> const& height_m : {from_m, to_m}) {
            if (height_m) {
                require_height(*height_m, "the height of a ridge");
            }
        }
        ridge.heights_m.resize(ridge.line.size());
        if (!from_m && !to_m) {
            std::ranges::fill(ridge.heights_m, std::nullopt);
        }
        ridge.heights_m.front() = from_m;
        ridge.heights_m.back() = to_m;
    }

    /// Takes a vertex's height out; that of an end goes to the next vertex, if it has none.
    static void remove_height(std::vector<std::optional<double>>& heights_m, std::size_t vertex) {
        std::optional<double> const height_m = heights_m[vertex];
        bool const is_first = vertex == 0;
        bool const is_last = vertex + 1 == heights_m.size();
        remove(heights_m, vertex);
        std::optional<double>& next = is_first ? heights_m.front() : heights_m.back();
        if ((is_first || is_last) && !next) {
            next = height_m;
        }
    }

    /// A stroke, or its longest part in the grid and on land. what: "river"
    DrawnLine stroke_on_land(DrawnLine const& points, char const* what) {
        DrawnLine const within = inside_grid(is_.grid, points);
        double const beyond_m = length_of(points) - length_of(within);
        if (beyond_m > is_.grid.cell_m) {
            said_.push_back(fmt::format("{:.3g} km beyond the grid were left out", beyond_m / 1e3));
        }
        DrawnLine line = stroke_of(is_.grid, within);
        require_no_loop(line, false, touching * is_.grid.cell_m);
        return on_land(std::move(line), what);
    }

    /// The longest part of a ridge that keeps away from rivers, where little is lost by it.
    DrawnLine short_of_rivers(DrawnLine line) {
        constexpr double most_lost = 1.0 / 3.0;
        DrawnLine const places = resampled(line, pace * is_.grid.cell_m);
        std::vector<bool> const is_near = near_lines(places, is_.rivers, clearance * is_.grid.cell_m);
        auto const first = std::ranges::find(is_near, true);
        if (first == is_near.end()) {
            return line;
        }
        DrawnLine longest;
        DrawnLine part;
        for (std::size_t i = 0; i <= places.size(); ++i) {
            if (i < places.size() && !is_near[i]) {
                part.push_back(places[i]);
                continue;
            }
            longest = length_of(part) > length_of(longest) ? part : longest;
            part.clear();
        }
        double const lost_m = length_of(line) - length_of(longest);
        if (length_of(longest) < least_length * is_.grid.cell_m || lost_m > most_lost * length_of(line)) {
            throw NotDrawn("studio.drawing: the ridge would cross or touch a river here: let it end short of it",
                           places[static_cast<std::size_t>(first - is_near.begin())]);
        }
        said_.push_back(fmt::format("the ridge ends short of the river: {:.3g} km were left out", lost_m / 1e3));
        constexpr double straight = 0.05; // [cells]
        return in_file(geometry::simplify(longest, straight * is_.grid.cell_m));
    }

    /// The longest part of a line on land. what: "river"
    DrawnLine on_land(DrawnLine line, char const* what) {
        Coasts coasts(is_.coasts);
        std::vector<DrawnLine> parts = parts_on_land(coasts, line, is_.grid.cell_m, false);
        if (parts.empty()) {
            throw NotDrawn(fmt::format("studio.drawing: this lies in the sea: {}s run on land", what), line.front());
        }
        DrawnLine longest = *std::ranges::max_element(parts, {}, length_of);
        double const cut_m = length_of(line) - length_of(longest);
        if (cut_m > is_.grid.cell_m) {
            said_.push_back(
                fmt::format("the {} ends at the coast: {:.3g} km in the sea were left out", what, cut_m / 1e3));
        }
        return longest;
    }

    /// Whether a new river runs against its stroke.
    static bool is_upstream(End const& begin, End const& end) {
        bool const as_drawn = can_begin(begin);
        bool const turned = can_begin(end);
        if (!as_drawn && !turned) {
            throw NotDrawn(
                "studio.drawing: a river cannot flow out of another one: water has one way down. Let one end "
                "lie apart, or begin where a river ends",
                begin.at);
        }
        if (as_drawn != turned) {
            return turned;
        }
        auto const rank = [](End const& e) { return e.continues ? -1 : static_cast<int>(e.meets); };
        return rank(begin) > std::max(rank(end), 0);
    }

    /// Whether another river has a vertex there.
    bool is_shared(std::size_t river, Vec2 at) const {
        for (std::size_t r = 0; r < is_.rivers.size(); ++r) {
            if (r != river && std::ranges::find(is_.rivers[r].line, at) != is_.rivers[r].line.end()) {
                return true;
            }
        }
        return false;
    }

    void move(std::size_t river, std::size_t vertex, Vec2 to, double reach_m) {
        DrawnLine const before = is_.rivers[river].line;
        Vec2 const by = to - before[vertex];
        std::map<std::pair<double, double>, Vec2> places; // from, to
        std::size_t first = vertex;
        std::size_t last = vertex;
        auto const carry = [&](std::size_t i, double along_m) {
            places[{before[i].x, before[i].y}] =
                i == vertex ? to : in_grid(is_.grid, before[i] + following(along_m, reach_m) * by);
            first = std::min(first, i);
            last = std::max(last, i);
        };
        carry(vertex, 0.0);
        double along_m = 0.0;
        for (std::size_t i = vertex + 1; i < before.size(); ++i) {
            along_m += distance(before[i - 1], before[i]);
            if (along_m >= reach_m || (i + 1 == before.size() && vertex + 1 != before.size())) {
                break; // an end stays unless it is what is moved
            }
            carry(i, along_m);
        }
        along_m = 0.0;
        for (std::size_t i = vertex; i > 0; --i) {
            along_m += distance(before[i], before[i - 1]);
            if (along_m >= reach_m || i == 1) {
                break;
            }
            carry(i - 1, along_m);
        }
        std::set<std::size_t> touched;
        for (std::size_t r = 0; r < is_.rivers.size(); ++r) {
            for (Vec2& p : is_.rivers[r].line) {
                if (auto const found = places.find({p.x, p.y}); found != places.end()) {
                    p = found->second;
                    touched.insert(r);
                }
            }
        }
        for (std::size_t const r : touched) {
            DrawnLine& line = is_.rivers[r].line;
            std::size_t const count = line.size();
            line = without_repeats(std::move(line));
            if (line.size() < 2) {
                throw NotDrawn("studio.drawing: nothing would be left of a river here", to);
            }
            require_no_loop(line, false, touching * is_.grid.cell_m);
            bool const is_own = r == river && line.size() == count;
            std::size_t const begin = is_own && first > 0 ? first - 1 : 0;
            std::size_t const end = is_own ? std::min(last + 1, line.size() - 1) : line.size() - 1;
            require_clear(is_, r, begin, end, 0.5 * clearance * is_.grid.cell_m);
        }
    }

    /// Carries a free end of a river to another river, a coast, the border or a place.
    void join(std::size_t river, bool at_source, End const& end) {
        name_ = end.meets == End::Meets::river ? "rivers joined" : "a river carried on";
        if (end.meets == End::Meets::river && at_source) {
            if (!end.continues) {
                throw NotDrawn("studio.drawing: a river cannot flow out of another one: water has one way down. Its "
                               "source can only be joined to where a river ends",
                               end.at);
            }
            extend(end.on.river, is_.rivers[river].line.front(), river); // the other one runs on in this one
            return;
        }
        if (end.meets == End::Meets::river) {
            extend(river, vertex_at(is_, end.on), end.on.river);
            return;
        }
        if (at_source) {
            DrawnLine& line = is_.rivers[river].line;
            line.insert(line.begin(), rounded(end.at));
            require_no_loop(line, false, touching * is_.grid.cell_m);
            require_clear(is_, river, 0, 1, clearance * is_.grid.cell_m);
            return;
        }
        extend(river, rounded(end.at), none);
    }

    void extend(std::size_t river, Vec2 to, std::size_t into) {
        if (into != none && river != into && flows_through(is_, into, river)) {
            throw NotDrawn("studio.drawing: the river would flow in a circle", to);
        }
        DrawnLine& line = is_.rivers[river].line;
        if (line.back() == to) {
            throw NotDrawn("studio.drawing: it lies there already", to);
        }
        if (distance(line.back(), to) <= snap * is_.grid.cell_m && line.size() > 2 && !is_shared(river, line.back())) {
            set_end(line, to, is_.grid.cell_m);
        } else {
            line.push_back(to);
        }
        require_no_loop(line, false, touching * is_.grid.cell_m);
        require_clear(is_, river, line.size() - 2, line.size() - 1, clearance * is_.grid.cell_m);
    }

    /// Takes a few cells from the lower end of a line, as far as no river joins it.
    void shorten(DrawnLine& line, std::size_t river) {
        double left_m = gap * is_.grid.cell_m;
        while (line.size() > 1) {
            Vec2 const end = line.back();
            Vec2 const before = line[line.size() - 2];
            double const step_m = distance(before, end);
            if (step_m > left_m) {
                line.back() = rounded(end + (left_m / step_m) * (before - end));
                return;
            }
            if (is_shared(river, before)) {
                throw NotDrawn("studio.drawing: a river joins too near above: cut elsewhere", before);
            }
            line.pop_back();
            left_m -= step_m;
        }
    }

    void erase_river(std::size_t river, bool alone) {
        std::vector<std::size_t> gone = rivers_into(is_, river);
        if (!gone.empty()) {
            said_.push_back(
                alone ? fmt::format("{} end inland now", many(gone.size(), "river above it does", "rivers above it"))
                      : fmt::format("{} that flow into it went with it", many(gone.size(), "river", "rivers")));
        }
        if (alone) {
            gone.clear();
        }
        gone.push_back(river);
        std::ranges::sort(gone, std::greater());
        for (std::size_t const one : gone) {
            remove(is_.rivers, one);
        }
    }

    DrawnLine ring_of(DrawnLine const& points) {
        DrawnLine line = taken(is_.grid, points);
        line.push_back(line.front());
        line = in_file(smoothed(line, is_.grid.cell_m));
        require_area(line);
        require_no_loop(line, true, touching * is_.grid.cell_m);
        line.pop_back();
        return line;
    }

    /// \param line ends where it begins
    void require_area(DrawnLine const& line) const {
        constexpr double least_cells = 9.0;
        if (line.size() < 4 ||
            std::fabs(geometry::signed_area(line)) < least_cells * is_.grid.cell_m * is_.grid.cell_m) {
            throw NotDrawn(fmt::format("studio.drawing: this area has fewer than {} cells", least_cells), line.front());
        }
    }

    bool at_border(Vec2 p) const { return distance(on_border(is_.grid, p), p) < 2.0 * snap * is_.grid.cell_m; }

    void carry_to_border(DrawnLine& line) const {
        Vec2 const edge = on_border(is_.grid, line.back());
        if (at_border(line.back())) {
            set_end(line, edge, is_.grid.cell_m);
        } else {
            line.push_back(edge);
        }
    }

    void require_apart(DrawnLine const& line) const {
        double const near_m = touching * is_.grid.cell_m;
        SegmentSquares const squares = SegmentSquares::of_line(line, is_.grid.cell_m);
        for (DrawnLine const& coast : is_.coasts) {
            for (std::size_t i = 0; i + 1 < coast.size(); ++i) {
                for (std::size_t const k : squares.near(coast[i], coast[i + 1], near_m)) {
                    auto const lies_on = [&](Vec2 a, Vec2 b, Vec2 p) {
                        return distance(geometry::foot_on(a, b, p).at, p) < near_m;
                    };
                    if (cross_over(coast[i], coast[i + 1], line[k], line[k + 1]) ||
                        lies_on(coast[i], coast[i + 1], line[k]) || lies_on(line[k], line[k + 1], coast[i])) {
                        throw NotDrawn("studio.drawing: the coast would cross another one here", line[k]);
                    }
                }
            }
        }
    }

    /// Whether more of the rivers lie at a coast's right.
    bool prefers_other_side(DrawnLine const& coast) const {
        std::size_t left = 0;
        std::size_t right = 0;
        std::vector<DrawnLine> const one{coast};
        Coasts coasts(one);
        for (DrawnRiver const& river : is_.rivers) {
            for (Vec2 const p : resampled(river.line, is_.grid.cell_m)) {
                ++(coasts.nearest(p).is_left ? left : right);
            }
        }
        return right > left;
    }

    /// Leaves of every river what lies on land.
    void cut_at_coasts() {
        std::vector<DrawnRiver> on_land;
        double lost_m = 0.0;
        std::size_t cut = 0;
        Coasts coasts(is_.coasts);
        std::set<std::pair<double, double>> ends;
        for (DrawnRiver const& river : is_.rivers) {
            ends.insert({river.line.back().x, river.line.back().y});
        }
        for (DrawnRiver const& river : is_.rivers) {
            bool const is_joined = ends.contains({river.line.front().x, river.line.front().y});
            std::vector<DrawnLine> parts = parts_on_land(coasts, river.line, is_.grid.cell_m, is_joined);
            double rest_m = length_of(river.line);
            for (DrawnLine& part : parts) {
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
            said_.push_back(fmt::format("{} into the sea: {:.3g} km were left out",
                                        many(cut, "river reaches", "rivers reach"), lost_m / 1e3));
        }
        is_.rivers = std::move(on_land);
    }

    void moved_shape(DrawnLine& line, MoveVertex const& step, Vec2 to) {
        bool const is_coast = step.of.kind == Part::Kind::coast;
        bool const is_closed = step.of.kind != Part::Kind::ridge && (!is_coast || line.front() == line.back());
        DrawnLine const before = line;
        std::size_t const count = is_coast && is_closed ? line.size() - 1 : line.size();
        bool const is_end = is_coast && !is_closed && (step.vertex == 0 || step.vertex + 1 == count);
        Vec2 const by = (is_end ? on_border(is_.grid, to) : to) - before[step.vertex % count];
        std::vector<double> const along = ways_along(before, count, is_closed);
        for (std::size_t i = 0; i < count; ++i) {
            bool const is_other_end = !is_closed && (i == 0 || i + 1 == count);
            double const between = std::fabs(along[i] - along[step.vertex % count]);
            double const away_m = is_closed ? std::min(between, along[count] - between) : between;
            bool const is_moved = i == step.vertex % count;
            if (is_moved || (away_m < step.reach_m && !is_other_end)) {
                double const weight = is_moved ? 1.0 : following(away_m, step.reach_m);
                line[i] = in_grid(is_.grid, before[i] + weight * by);
            }
        }
        if (is_coast && is_closed) {
            line.back() = line.front();
        }
        settle(step.of, 0, line.size() - 1);
    }

    /// [m] To each vertex along a line, or around a ring, and to its end.
    static std::vector<double> ways_along(DrawnLine const& line, std::size_t count, bool is_closed) {
        std::vector<double> along{0.0};
        for (std::size_t i = 0; i < count; ++i) {
            double const step = i + 1 < count || is_closed ? distance(line[i], line[(i + 1) % count]) : 0.0;
            along.push_back(along.back() + step);
        }
        return along;
    }

    /// Checks what was changed between two vertices.
    void settle(Part const& part, std::size_t first, std::size_t last) {
        DrawnLine& line = line_of(part, 0);
        if (part.kind == Part::Kind::ridge) {
            merge_repeats(is_.ridges[part.number]);
        }
        line = without_repeats(std::move(line));
        bool const is_coast = part.kind == Part::Kind::coast;
        bool const is_ring =
            is_coast ? line.front() == line.back() : part.kind == Part::Kind::lake || part.kind == Part::Kind::mask;
        if (line.size() < (!is_ring ? 2U : is_coast ? 4U : 3U)) {
            throw NotDrawn(fmt::format("studio.drawing: nothing would be left of {} here", called(part)), line.front());
        }
        switch (part.kind) {
        case Part::Kind::river: {
            require_no_loop(line, false, touching * is_.grid.cell_m);
            std::size_t const end = std::min(last + 1, line.size() - 1);
            require_clear(is_, part.number, first > 0 ? std::min(first, end) - 1 : 0, end,
                          0.5 * clearance * is_.grid.cell_m);
            break;
        }
        case Part::Kind::coast: {
            require_no_loop(line, line.front() == line.back(), touching * is_.grid.cell_m);
            DrawnLine const changed = line;
            remove(is_.coasts, part.number);
            require_apart(changed);
            is_.coasts.insert(is_.coasts.begin() + static_cast<std::ptrdiff_t>(part.number), changed);
            cut_at_coasts();
            break;
        }
        case Part::Kind::lake:
        case Part::Kind::mask: {
            DrawnLine ring = line;
            ring.push_back(ring.front());
            require_no_loop(ring, true, touching * is_.grid.cell_m);
            break;
        }
        case Part::Kind::ridge: {
            require_no_loop(line, false, touching * is_.grid.cell_m);
            DrawnLine const places = resampled(line, pace * is_.grid.cell_m);
            if (auto const at = touched(places, is_.rivers, 0.5 * clearance * is_.grid.cell_m)) {
                throw NotDrawn("studio.drawing: the ridge would cross or touch a river here: no water crosses it", at);
            }
            break;
        }
        case Part::Kind::pin: break;
        }
    }

    /// Of vertices in a row at one place the first one stays, with the first height.
    static void merge_repeats(DrawnRidge& ridge) {
        for (std::size_t i = 1; i < ridge.line.size();) {
            if (ridge.line[i] != ridge.line[i - 1]) {
                ++i;
                continue;
            }
            ridge.heights_m[i - 1] = ridge.heights_m[i - 1] ? ridge.heights_m[i - 1] : ridge.heights_m[i];
            remove(ridge.line, i);
            remove(ridge.heights_m, i);
        }
    }

    Drawing is_;
    std::string name_;
    std::vector<std::string> said_;
};

void require_no_circle(Drawing const& drawing) {
    std::vector<VertexOf> const below = ways_down(drawing);
    std::vector<std::size_t> seen(below.size(), none); // from which river first
    for (std::size_t r = 0; r < below.size(); ++r) {
        for (std::size_t at = r; at != none && (seen[at] == none || seen[at] == r); at = below[at].river) {
            if (seen[at] == r) {
                throw NotDrawn("studio.drawing: the river would flow in a circle", drawing.rivers[at].line.back());
            }
            seen[at] = r;
        }
    }
}

} // namespace

Drawn drawn(Drawing drawing, DrawStep const& step) {
    Hand hand(std::move(drawing));
    std::visit(hand, step);
    Drawn result = hand.result();
    require_no_circle(result.drawing);
    if (result.drawing.has_side_streams) { // a river that goes on where another ends is one with it
        result.drawing.rivers = as_streams(result.drawing);
    }
    return result;
}

std::vector<std::size_t> rivers_into(Drawing const& drawing, std::size_t river) {
    std::vector<VertexOf> const below = ways_down(drawing);
    std::vector<std::vector<std::size_t>> above(below.size());
    for (std::size_t r = 0; r < below.size(); ++r) {
        if (below[r].river != none) {
            above[below[r].river].push_back(r);
        }
    }
    std::set<std::size_t> found;
    std::vector<std::size_t> next{river};
    while (!next.empty()) {
        std::size_t const one = next.back();
        next.pop_back();
        for (std::size_t const r : above[one]) {
            if (r != river && found.insert(r).second) {
                next.push_back(r);
            }
        }
    }
    return {found.begin(), found.end()};
}

namespace {

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

std::vector<DrawnLine> coasts_of(Mask const& land) {
    constexpr double tolerance = 0.75; // [cells]
    std::vector<DrawnLine> coasts;
    for (DrawnLine const& line : land.cells() > 0 ? Outline(land).lines() : std::vector<DrawnLine>()) {
        DrawnLine coast = in_file(geometry::simplify(line, tolerance * land.grid().cell_m));
        bool const is_closed = coast.front() == coast.back();
        if (coast.size() >= (is_closed ? 4U : 2U)) {
            coasts.push_back(std::move(coast));
        }
    }
    return coasts;
}

} // namespace thalweg::studio
