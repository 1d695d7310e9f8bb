// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/grow_strokes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/rosgen.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/growth/tokunaga/embed_tree.hpp>
#include <thalweg/growth/tokunaga/internal/embed_tree.hpp>
#include <thalweg/growth/tokunaga/internal/grow_strokes.hpp>

// Described in docs/algorithms/forest_spreading.md.

namespace thalweg::growth {
namespace {

std::string named(RiverLines const& strokes, std::int64_t feature, Vec2 at) {
    return fmt::format("stroke {} of {} at ({:.3f}, {:.3f})", feature, strokes.name, at.x, at.y);
}

void measure(Stroke& stroke) {
    stroke.way.assign(1, 0.0);
    for (std::size_t i = 1; i < stroke.line.size(); ++i) {
        stroke.way.push_back(stroke.way.back() + distance(stroke.line[i - 1], stroke.line[i]));
    }
}

Stroke as_drawn(RiverLine const& drawn, RiverLines const& strokes, Grid const& grid) {
    Stroke stroke;
    stroke.feature = drawn.feature;
    for (Vec3 const& v : drawn.vertices) {
        Vec2 const p{v.x, v.y};
        if (!(p.x >= grid.west && p.x <= grid.east() && p.y >= grid.south() && p.y <= grid.north)) {
            throw BadInput("growth.grow_strokes",
                           named(strokes, drawn.feature, p) +
                               fmt::format(" leaves the grid, which spans {:.1f} to {:.1f} east and {:.1f} to {:.1f} "
                                           "north; enlarge the grid or shorten the stroke",
                                           grid.west, grid.east(), grid.south(), grid.north));
        }
        stroke.line.push_back(p);
    }
    stroke.line.erase(std::unique(stroke.line.begin(), stroke.line.end()), stroke.line.end());
    measure(stroke);
    if (stroke.line.size() < 2) {
        Vec2 const at = stroke.line.empty() ? Vec2{} : stroke.line.front();
        throw BadInput("growth.grow_strokes",
                       named(strokes, drawn.feature, at) + " is a single point; draw it from its mouth upstream");
    }
    if (!drawn.type.empty() && drawn.type != "none" && !rosgen_of(drawn.type)) {
        std::vector<std::string> names;
        for (Rosgen const type : rosgen_types) {
            names.emplace_back(name_of(type));
        }
        throw BadInput("growth.grow_strokes",
                       named(strokes, drawn.feature, stroke.line.front()) +
                           fmt::format(" has the unknown river type '{}'.{} (Rosgen's are Aa+, A, B, C, D, DA, "
                                       "E, F, G)",
                                       drawn.type, did_you_mean(drawn.type, names)));
    }
    return stroke;
}

/// A position on a stroke: segment and share of it.
struct Spot {
    std::size_t segment = 0;
    double along = 0.0; ///< [0, 1]
};

/// Finds the stroke on which another begins as drawn, if any.
Spot find_beginning(std::size_t number, Strokes& strokes, double tolerance_m) {
    Stroke& stroke = strokes[number];
    double least = tolerance_m;
    Spot spot;
    for (std::size_t other = 0; other < strokes.size(); ++other) {
        if (other == number) {
            continue;
        }
        std::vector<Vec2> const& line = strokes[other].line;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            geometry::Foot const foot = geometry::foot_on(line[i], line[i + 1], stroke.line.front());
            double const off = distance(foot.at, stroke.line.front());
            if (off < least || (off == least && stroke.onto < 0)) {
                least = off;
                spot = {i, foot.along};
                stroke.onto = static_cast<StrokeId>(other);
                stroke.onto_way_m = strokes[other].way[i] + foot.along * distance(line[i], line[i + 1]);
            }
        }
    }
    return spot;
}

/// Moves the beginning of a stroke onto the other, at the given position.
void move_beginning(Stroke& stroke, Stroke const& onto, Spot spot) {
    Vec2 const a = onto.line[spot.segment];
    Vec2 const b = onto.line[spot.segment + 1];
    stroke.line.front() = {a.x + spot.along * (b.x - a.x), a.y + spot.along * (b.y - a.y)};
    stroke.onto_way_m = onto.way[spot.segment] + spot.along * distance(a, b);
    measure(stroke);
}

/// A line's position at a point that it shares with others or with itself.
struct Meeting {
    std::size_t stroke;
    std::size_t segment;
};

bool meets_itself(std::vector<Meeting> const& here) {
    return std::adjacent_find(here.begin(), here.end(), [](Meeting const& a, Meeting const& b) {
               return a.stroke == b.stroke && b.segment > a.segment + 1;
           }) != here.end();
}

/// Throws if strokes meet other than by one beginning on another.
void require_joined(Strokes const& strokes, RiverLines const& names, double tolerance_m, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    for (Stroke const& s : strokes) {
        lines.push_back(s.line);
    }
    std::map<std::pair<double, double>, std::vector<Meeting>> meetings; // sorted by line and segment, like crossings
    for (geometry::Crossing const& c : geometry::crossings(lines, run)) {
        meetings[{c.at.x, c.at.y}].push_back({c.line, c.segment});
    }
    for (auto const& [place, here] : meetings) {
        Vec2 const at{place.first, place.second};
        bool const alone = here.front().stroke == here.back().stroke;
        if (alone || meets_itself(here)) {
            throw BadInput("growth.grow_strokes", named(names, strokes[here.front().stroke].feature, at) +
                                                      " meets itself; draw it without loops");
        }
        auto const begins_here = [&](std::size_t k, std::size_t on) {
            return std::cmp_equal(strokes[k].onto, on) && distance(strokes[k].line.front(), at) <= tolerance_m;
        };
        for (auto const& [other, other_segment] : here) {
            for (auto const& [one, segment] : here) {
                if (one >= other || begins_here(one, other) || begins_here(other, one)) {
                    continue;
                }
                throw BadInput("growth.grow_strokes",
                               named(names, strokes[one].feature, at) +
                                   fmt::format(" crosses stroke {}; rivers do not cross: let one begin on the other",
                                               strokes[other].feature));
            }
        }
    }
}

/// Throws if the upper end of a stroke lies on another.
void require_mouths_below(Strokes const& strokes, RiverLines const& names, double tolerance_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        Vec2 const end = strokes[k].line.back();
        for (std::size_t other = 0; other < strokes.size(); ++other) {
            if (other == k || distance_to(strokes[other], end) > tolerance_m) {
                continue;
            }
            throw BadInput("growth.grow_strokes",
                           named(names, strokes[k].feature, end) +
                               fmt::format(" ends on stroke {}; strokes run from their mouth upstream: turn it round",
                                           strokes[other].feature));
        }
    }
}

/// Throws if two strokes begin or join at the same position, a stroke begins where another joins, or strokes begin on
/// one another in a cycle.
void require_apart(Strokes const& strokes, RiverLines const& names, double tolerance_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        for (std::size_t m = 0; m < k; ++m) {
            if (distance(strokes[k].line.front(), strokes[m].line.front()) <= tolerance_m) {
                throw BadInput("growth.grow_strokes",
                               named(names, strokes[k].feature, strokes[k].line.front()) +
                                   fmt::format(" begins where stroke {} does; move one of them", strokes[m].feature));
            }
        }
    }
    for (Stroke const& s : strokes) {
        if (s.onto >= 0) {
            Stroke const& below = strokes[s.onto];
            if (s.onto_way_m >= below.way.back() - tolerance_m) {
                throw BadInput(
                    "growth.grow_strokes",
                    named(names, s.feature, s.line.front()) +
                        fmt::format(" begins at the upper end of stroke {}; draw both as one, or let it begin "
                                    "lower down",
                                    below.feature));
            }
        }
        StrokeId below = s.onto;
        for (std::size_t steps = 0; below >= 0; ++steps) {
            if (steps > strokes.size()) {
                throw BadInput("growth.grow_strokes",
                               named(names, s.feature, s.line.front()) + " flows in a ring of strokes; let one end");
            }
            below = strokes[below].onto;
        }
    }
}

constexpr double coarse = 1.0 / 24.0; // relative to the reach: spacing of the lattice that measures areas

/// Whether a position lies to the left of the nearest part of a stroke.
bool left_of(Stroke const& stroke, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    bool left = false;
    for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
        Vec2 const a = stroke.line[i];
        Vec2 const b = stroke.line[i + 1];
        if (double const off = distance(p, geometry::foot_on(a, b, p).at); off < least) {
            least = off;
            left = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0.0;
        }
    }
    return left;
}

struct Wing {
    LinkId link;
    std::int64_t links; ///< with all upstream
};

/// By link: number of links upstream, itself included.
std::vector<std::int64_t> sizes_of(TokunagaTree const& tree) {
    std::vector<std::int64_t> links(tree.links.size(), 1);
    for (std::size_t i = tree.links.size(); i-- > 1;) {
        links[tree.links[i].down] += links[i];
    }
    return links;
}

constexpr std::uint64_t stroke_stage = 0x7374726f6b65; // "stroke"

void check(StrokesParams const& params) {
    require_in("growth.grow_strokes", "max_depth", params.max_depth, Range::between(1, 29));
    require_in("growth.grow_strokes", "reach", params.reach, Range{0.0, 2.0, false, true});
    require_in("growth.grow_strokes", "clearance", params.clearance, Range::between(0.05, 0.35));
    require_in("growth.grow_strokes", "min_spacing_m", params.min_spacing_m, Range::at_least(0.0));
}

/// The beginning of another stroke on a trunk.
struct Junction {
    double way_m;
    std::size_t stroke;
};

/// Positions of a trunk's own nodes, evenly spaced between the junctions; the last is the fork.
std::vector<double> positions_on_trunk(std::size_t nodes, double length_m, std::vector<Junction> const& junctions) {
    double fork = length_m * static_cast<double>(nodes) / static_cast<double>(nodes + 1);
    if (!junctions.empty() && junctions.back().way_m >= fork) {
        fork = 0.5 * (junctions.back().way_m + length_m);
    }
    std::vector<double> fixed{0.0};
    for (Junction const& j : junctions) {
        fixed.push_back(j.way_m);
    }
    fixed.push_back(fork);
    std::vector<std::size_t> count(fixed.size() - 1, 0);
    std::vector<std::size_t> part(nodes - 1);
    for (std::size_t i = 0; i + 1 < nodes; ++i) {
        double const nominal = fork * static_cast<double>(i + 1) / static_cast<double>(nodes);
        while (part[i] + 1 < count.size() && fixed[part[i] + 1] <= nominal) {
            ++part[i];
        }
        ++count[part[i]];
    }
    std::vector<double> ways;
    std::size_t in_part = 0;
    for (std::size_t i = 0; i + 1 < nodes; ++i) {
        in_part = i > 0 && part[i] == part[i - 1] ? in_part + 1 : 1;
        double const share = static_cast<double>(in_part) / static_cast<double>(count[part[i]] + 1);
        ways.push_back(fixed[part[i]] + share * (fixed[part[i] + 1] - fixed[part[i]]));
    }
    ways.push_back(fork);
    return ways;
}

class Planting {
public:
    Planting(Strokes const& strokes, RiverLines const& drawn, StrokeLands const& lands, double width_m,
             StrokesParams const& params)
        : strokes_(strokes), drawn_(drawn), lands_(lands), width_m_(width_m), params_(params),
          joints_(strokes.size(), -1), junctions_(strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (strokes[k].onto >= 0) {
                junctions_[strokes[k].onto].push_back({strokes[k].onto_way_m, k});
            }
        }
        for (auto& list : junctions_) {
            std::sort(list.begin(), list.end(), [](Junction const& a, Junction const& b) { return a.way_m < b.way_m; });
        }
    }

    void plant(std::size_t stroke, Run const& run) {
        TokunagaParams params = params_.tree;
        params.seed = random_word(params_.tree.seed, stroke_stage, stroke);
        params.generator = drawn_.lines[stroke].lambda > 0 ? drawn_.lines[stroke].lambda : params.generator;
        params.order = depth_of(stroke) + 1;
        TokunagaTree tree = grow_tokunaga(params, run);
        balance_banks(tree, lands_.share_left(stroke));
        std::vector<std::size_t> const trunk = trunk_of(tree);
        std::vector<double> const ways =
            positions_on_trunk(trunk.size(), strokes_[stroke].way.back(), junctions_[stroke]);

        std::vector<LinkId> number(tree.links.size(), -1); // of its links in the forest
        LinkId below = joints_[stroke];
        int turn = below < 0 ? 0 : side_of(stroke);
        std::size_t joined = 0;
        for (std::size_t i = 0; i < trunk.size(); ++i) {
            for (; joined < junctions_[stroke].size() && junctions_[stroke][joined].way_m < ways[i]; ++joined) {
                Junction const& junction = junctions_[stroke][joined];
                below =
                    add(below, tree.links[trunk[i]].order, turn, stroke, place_at(strokes_[stroke], junction.way_m));
                joints_[junction.stroke] = below;
                turn = 0;
            }
            below = add(below, tree.links[trunk[i]].order, turn, stroke, place_at(strokes_[stroke], ways[i]));
            number[trunk[i]] = below;
            turn = 0;
        }
        for (std::size_t i = 0; i < tree.links.size(); ++i) {
            TreeLink const& link = tree.links[i];
            if (number[i] < 0) {
                number[i] = add(number[link.down], link.order, link.turn, stroke, {});
            }
        }
    }

    /// A river's order is at least that of its tributaries.
    std::vector<ForestLink> take() {
        for (std::size_t i = links_.size(); i-- > 0;) {
            if (links_[i].down >= 0) {
                int& order = links_[links_[i].down].order;
                order = std::max(order, links_[i].order);
            }
        }
        return std::move(links_);
    }

    /// The link into which each stroke flows; -1: its own mouth.
    std::vector<LinkId> const& joints() const { return joints_; }

private:
    int depth_of(std::size_t stroke) const {
        double const depth = std::floor(strokes_[stroke].way.back() / width_m_ * params_.max_depth + 0.5);
        return static_cast<int>(std::clamp(depth, 1.0, static_cast<double>(params_.max_depth)));
    }

    /// The bank from which a stroke joins another, as TreeLink::turn.
    int side_of(std::size_t stroke) const {
        Stroke const& own = strokes_[stroke];
        Stroke const& onto = strokes_[own.onto];
        Vec2 const a = place_at(onto, own.onto_way_m);
        Vec2 const b = place_at(onto, own.onto_way_m + 0.01 * onto.way.back());
        Vec2 const c = own.line[1];
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0 ? 2 : -2;
    }

    LinkId add(LinkId down, int order, int turn, std::size_t tree, std::optional<Vec2> pinned) {
        links_.push_back({.down = down, .order = order, .turn = turn, .tree = tree, .pinned = pinned});
        return std::ssize(links_) - 1;
    }

    Strokes const& strokes_;
    RiverLines const& drawn_;
    StrokeLands const& lands_;
    double width_m_; ///< [m] of the grid
    StrokesParams const& params_;
    std::vector<ForestLink> links_;
    std::vector<LinkId> joints_;
    std::vector<std::vector<Junction>> junctions_;
};

/// Throws if a stroke would join another more than a cell from where it was drawn.
void require_in_place(Strokes const& strokes, RiverLines const& drawn, std::vector<LinkId> const& joints,
                      SettledLinks const& settled, double cell_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        Vec3 const start = drawn.lines[k].vertices.front();
        LinkId const joint = joints[k];
        if (joint >= 0 && settled.stays[joint] != 0 && distance(settled.at[joint], {start.x, start.y}) > cell_m) {
            throw BadInput("growth.grow_strokes",
                           fmt::format("stroke {} of {} at ({:.3f}, {:.3f}) begins on stroke {}, which others leave no "
                                       "room there; draw the strokes further apart",
                                       strokes[k].feature, drawn.name, start.x, start.y,
                                       strokes[strokes[k].onto].feature));
        }
    }
}

} // namespace

Strokes join_strokes(RiverLines const& drawn, Grid const& grid, Run const& run) {
    double const tolerance_m = 0.5 * grid.cell_m;
    Strokes strokes;
    for (RiverLine const& line : drawn.lines) {
        strokes.push_back(as_drawn(line, drawn, grid));
    }
    std::vector<Spot> spots;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        spots.push_back(find_beginning(k, strokes, tolerance_m));
    }
    require_apart(strokes, drawn, tolerance_m);
    for (std::size_t const k : downstream_first(strokes)) {
        if (strokes[k].onto >= 0) {
            move_beginning(strokes[k], strokes[strokes[k].onto], spots[k]);
        }
        if (!(strokes[k].way.back() > tolerance_m)) {
            throw BadInput("growth.grow_strokes", named(drawn, strokes[k].feature, strokes[k].line.front()) +
                                                      " is no longer than half a cell; draw it longer");
        }
    }
    require_mouths_below(strokes, drawn, tolerance_m);
    require_joined(strokes, drawn, 2.0 * tolerance_m, run);
    return strokes;
}

double distance_to(Stroke const& stroke, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
        least = std::min(least, distance(p, geometry::foot_on(stroke.line[i], stroke.line[i + 1], p).at));
    }
    return least;
}

std::vector<std::size_t> downstream_first(Strokes const& strokes) {
    std::vector<std::size_t> turn;
    std::vector<std::uint8_t> done(strokes.size(), 0);
    while (turn.size() < strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (done[k] == 0 && (strokes[k].onto < 0 || done[strokes[k].onto] != 0)) {
                done[k] = 1;
                turn.push_back(k);
            }
        }
    }
    return turn;
}

Vec2 place_at(Stroke const& stroke, double way_m) {
    std::size_t i = 1;
    while (i + 1 < stroke.line.size() && stroke.way[i] < way_m) {
        ++i;
    }
    double const share = std::clamp((way_m - stroke.way[i - 1]) / (stroke.way[i] - stroke.way[i - 1]), 0.0, 1.0);
    Vec2 const a = stroke.line[i - 1];
    Vec2 const b = stroke.line[i];
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

std::vector<Vec2> StrokeLands::sample(std::size_t stroke, double width_m) const {
    double const far = reach_m(stroke);
    Vec2 low = strokes_[stroke].line.front();
    Vec2 high = low;
    for (Vec2 const p : strokes_[stroke].line) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    low = {std::max(low.x - far, grid_.west), std::max(low.y - far, grid_.south())};
    high = {std::min(high.x + far, grid_.east()), std::min(high.y + far, grid_.north)};
    std::vector<Vec2> places;
    for (double y = low.y + 0.5 * width_m; y < high.y; y += width_m) {
        for (double x = low.x + 0.5 * width_m; x < high.x; x += width_m) {
            if (belongs(stroke, {x, y})) {
                places.push_back({x, y});
            }
        }
    }
    return places;
}

double StrokeLands::area_m2(std::size_t stroke) const {
    double const width = coarse * reach_m(stroke);
    return std::max(1.0, static_cast<double>(sample(stroke, width).size())) * width * width;
}

double StrokeLands::share_left(std::size_t stroke) const {
    std::vector<Vec2> const places = sample(stroke, coarse * reach_m(stroke));
    auto const left =
        std::count_if(places.begin(), places.end(), [&](Vec2 const p) { return left_of(strokes_[stroke], p); });
    return places.empty() ? 0.5 : static_cast<double>(left) / static_cast<double>(places.size());
}

bool StrokeLands::belongs(std::size_t stroke, Vec2 p) const {
    double const own = distance_to(strokes_[stroke], p) / reach_m(stroke);
    if (!(own < 1.0)) {
        return false;
    }
    for (std::size_t k = 0; k < strokes_.size(); ++k) {
        if (k == stroke) {
            continue;
        }
        double const other = distance_to(strokes_[k], p) / reach_m(k);
        if (other < own || (other == own && k < stroke)) {
            return false;
        }
    }
    return true;
}

std::vector<std::size_t> trunk_of(TokunagaTree const& tree) {
    std::vector<std::size_t> trunk;
    LinkId link = 0;
    while (link >= 0) {
        TreeLink const& here = tree.links[link];
        trunk.push_back(static_cast<std::size_t>(link));
        LinkId const next = here.up[0];
        link = next >= 0 && tree.links[next].order == here.order ? next : -1;
    }
    return trunk;
}

void balance_banks(TokunagaTree& tree, double share_left) {
    require_in("growth.balance_banks", "share_left", share_left, Range::between(0.0, 1.0));
    std::vector<std::int64_t> const sizes = sizes_of(tree);
    std::int64_t left = 0;
    std::int64_t right = 0;
    std::vector<Wing> branches;
    for (std::size_t const t : trunk_of(tree)) {
        for (LinkId const up : tree.links[t].up) {
            if (up < 0 || tree.links[up].turn == 0) {
                continue;
            }
            int const turn = tree.links[up].turn;
            if (turn == 1 || turn == -1) { // of the fork
                (turn > 0 ? left : right) += sizes[up];
            } else {
                branches.push_back({up, sizes[up]});
            }
        }
    }
    std::stable_sort(branches.begin(), branches.end(), [](Wing const& a, Wing const& b) { return a.links > b.links; });
    std::int64_t all = left + right;
    for (Wing const& branch : branches) {
        all += branch.links;
    }
    double const wanted_left = share_left * static_cast<double>(all);
    double const wanted_right = static_cast<double>(all) - wanted_left;
    for (Wing const& branch : branches) {
        double const lacks_left = wanted_left - static_cast<double>(left);
        double const lacks_right = wanted_right - static_cast<double>(right);
        bool const goes_left =
            lacks_left > lacks_right || (lacks_left == lacks_right && tree.links[branch.link].turn > 0);
        tree.links[branch.link].turn = goes_left ? 2 : -2;
        (goes_left ? left : right) += branch.links;
    }
}

GrownStrokes grow_strokes(RiverLines const& drawn, Grid const& grid, StrokesParams const& params, Run const& run) {
    check(params);
    Strokes const strokes = join_strokes(drawn, grid, run);
    GrownStrokes grown;
    if (strokes.empty()) {
        return grown;
    }
    StrokeLands const lands(strokes, grid, params.reach);
    Planting planting(strokes, drawn, lands, grid.east() - grid.west, params);
    for (std::size_t const k : downstream_first(strokes)) {
        planting.plant(k, run);
    }
    Forest forest;
    forest.links = planting.take();
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        forest.shares.push_back({.mouth = strokes[k].line.front(),
                                 .far = strokes[k].line.back(),
                                 .area_m2 = lands.area_m2(k),
                                 .sample = [&lands, k](double width) { return lands.sample(k, width); }});
    }
    std::vector<Vec2> const edge = outline(grid);
    forest.walls = sides_of(edge);
    forest.inside = [&edge](Vec2 p) { return geometry::contains(edge, p); };
    forest.seed = params.tree.seed;
    forest.clearance = params.clearance;
    forest.min_spacing_m = params.min_spacing_m;

    SettledLinks const settled = settle_links(forest, spread_forest(forest, run));
    require_in_place(strokes, drawn, planting.joints(), settled, grid.cell_m);
    grown.placed = std::count(settled.stays.begin(), settled.stays.end(), std::uint8_t{1});
    grown.dropped = static_cast<std::int64_t>(forest.links.size()) - grown.placed;
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    for (ArcId a = 0; a < kept.network.arcs.size(); ++a) {
        RiverLine const& stroke = drawn.lines[forest.links[kept.links_of_arc[a].front()].tree];
        kept.network.arcs[a].arc.type = stroke.type;
        kept.network.arcs[a].arc.feature = stroke.feature;
    }
    grown.network = std::move(kept.network);
    return grown;
}

} // namespace thalweg::growth
