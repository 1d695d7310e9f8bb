// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/network/import/prepare_lines.hpp>

namespace thalweg::network {
namespace {

struct Window {
    double west;
    double east;
    double south;
    double north;
    bool holds(Vec3 p) const { return p.x >= west && p.x <= east && p.y >= south && p.y <= north; }
};

/// The part of segment a-b inside the box as shares [first, last] (Liang and Barsky 1984).
std::optional<std::pair<double, double>> inside(Vec3 a, Vec3 b, Window const& box) {
    double first = 0.0;
    double last = 1.0;
    double const dx = b.x - a.x;
    double const dy = b.y - a.y;
    std::array<std::pair<double, double>, 4> const sides = {
        {{-dx, a.x - box.west}, {dx, box.east - a.x}, {-dy, a.y - box.south}, {dy, box.north - a.y}}};
    for (auto const& [towards, room] : sides) {
        if (towards == 0.0) {
            if (room < 0.0) {
                return std::nullopt;
            }
        } else if (towards < 0.0) {
            first = std::max(first, room / towards);
        } else {
            last = std::min(last, room / towards);
        }
    }
    return first < last ? std::optional(std::pair(first, last)) : std::nullopt;
}

Vec3 on_edge(Vec3 a, Vec3 b, double share, Window const& box) {
    return {std::clamp(a.x + share * (b.x - a.x), box.west, box.east),
            std::clamp(a.y + share * (b.y - a.y), box.south, box.north), a.z + share * (b.z - a.z)};
}

/// Consecutive vertices of a line on one side of a window's edge, with the positions on the edge.
struct SidePart {
    bool is_inside = false;
    std::vector<Vec3> vertices;
};

std::vector<SidePart> parts_by_side(std::vector<Vec3> const& line, Window const& window) {
    std::vector<SidePart> found;
    auto const go = [&](bool is_inside, Vec3 from, Vec3 to) {
        if (found.empty() || found.back().is_inside != is_inside) {
            found.push_back({is_inside, {from}});
        }
        found.back().vertices.push_back(to);
    };
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        auto const part = inside(a, b, window);
        if (!part) {
            go(false, a, b);
            continue;
        }
        Vec3 const entry = window.holds(a) ? a : on_edge(a, b, part->first, window);
        Vec3 const exit = window.holds(b) ? b : on_edge(a, b, part->second, window);
        if (!window.holds(a)) {
            go(false, a, entry);
        }
        go(true, entry, exit);
        if (!window.holds(b)) {
            go(false, exit, b);
        }
    }
    return found;
}

SecondaryLine beyond_grid(RiverLine const& line, std::vector<Vec3> vertices) {
    return {line.feature, std::move(vertices), "beyond the grid", line.feature, LeftOut::grid};
}

using Place = std::pair<double, double>;

Place plan_key(Vec3 p) {
    return {p.x, p.y};
}

/// What is left of a line from this distance on.
std::vector<Vec3> from_distance(std::vector<Vec3> const& line, double distance_m) {
    double left_m = distance_m;
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        double const step_m = distance(in_plan(a), in_plan(b));
        if (step_m > left_m) {
            double const share = left_m / step_m;
            std::vector<Vec3> rest{{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)}};
            rest.insert(rest.end(), line.begin() + static_cast<std::ptrdiff_t>(i), line.end());
            return rest;
        }
        left_m -= step_m;
    }
    return {line.back()};
}

std::vector<Vec3> reversed(std::vector<Vec3> const& line) {
    return {line.rbegin(), line.rend()};
}

/// Clips lines where they come to the outermost cells of a grid.
class Ending {
public:
    Ending(RiverLines const& lines, Grid const& grid)
        : lines_(lines), grid_(grid), inset_m_(inset_cells * grid.cell_m),
          window_{grid.west + inset_m_, grid.east() - inset_m_, grid.south() + inset_m_, grid.north - inset_m_} {
        for (RiverLine const& line : lines.lines) {
            std::set<Place> own; // a line meets itself at no other one's vertex
            for (std::size_t i = 0; i < line.vertices.size(); ++i) {
                Vec3 const& p = line.vertices[i];
                if (window_.holds(p) || !own.insert(plan_key(p)).second) {
                    continue;
                }
                Meeting& here = meetings_[plan_key(p)];
                bool const is_first = i == 0;
                bool const is_end = is_first || i + 1 == line.vertices.size();
                ++here.lines;
                here.heads += is_end && is_first == (line.runs >= 0) ? 1 : 0;
                here.mouths += is_end && is_first != (line.runs >= 0) ? 1 : 0;
            }
        }
    }

    RiverLines ended() {
        RiverLines out = lines_;
        out.lines.clear();
        for (RiverLine const& line : lines_.lines) {
            if (is_ended(line)) {
                out.lines.push_back(line);
            } else {
                cut(line, out);
            }
        }
        join_neighbours(out.lines);
        return out;
    }

private:
    static constexpr double inset_cells = 1.001; ///< a position there lies in no outermost cell
    static constexpr double joined_cells = 3.0;  ///< a line that comes back this near its exit stays whole
    static constexpr double fewest_cells = 3.0;  ///< shorter pieces between two edges are dropped

    /// Lines with a vertex at a position.
    struct Meeting {
        int lines = 0;
        int heads = 0;  ///< that begin there
        int mouths = 0; ///< that end there
    };

    bool is_met(Vec3 p) const {
        auto const known = meetings_.find(plan_key(p));
        return known != meetings_.end() && known->second.lines > 1;
    }

    /// Whether a river runs on from a line's end, in another line.
    bool runs_on(RiverLine const& line, bool is_last) const {
        auto const known = meetings_.find(plan_key(is_last ? line.vertices.back() : line.vertices.front()));
        bool const is_mouth = is_last == (line.runs >= 0);
        return known != meetings_.end() &&
               known->second.lines > (is_mouth ? known->second.mouths : known->second.heads);
    }

    /// Whether a line's only outermost cells, if it has any, are those of ends from which no river runs on.
    bool is_ended(RiverLine const& line) const {
        std::vector<Vec2> plan;
        for (Vec3 const& p : line.vertices) {
            bool const is_inside =
                p.x >= grid_.west && p.x <= grid_.east() && p.y >= grid_.south() && p.y <= grid_.north;
            if (!is_inside) {
                return false;
            }
            plan.push_back(in_plan(p));
        }
        std::vector<Cell> const cells = cells_along(plan, grid_, "a river");
        auto const is_outermost = [this](Cell c) { return grid_.on_border(c); };
        if (std::ranges::all_of(cells, is_outermost)) {
            return false;
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            bool const is_end = i == 0 || i + 1 == cells.size();
            if (is_outermost(cells[i]) && (!is_end || runs_on(line, i > 0))) {
                return false;
            }
        }
        return true;
    }

    /// Draws a line on from the window's edge to the grid's, straight, with the height that the line reaches there.
    Vec3 on_grid_edge(std::vector<Vec3> const& beyond) const {
        Vec3 const p = beyond.front();
        std::array<std::pair<double, Vec3>, 4> const sides = {{{p.x - window_.west, {grid_.west, p.y, p.z}},
                                                               {window_.east - p.x, {grid_.east(), p.y, p.z}},
                                                               {p.y - window_.south, {p.x, grid_.south(), p.z}},
                                                               {window_.north - p.y, {p.x, grid_.north, p.z}}}};
        Vec3 end = std::ranges::min_element(sides, {}, &std::pair<double, Vec3>::first)->second;
        end.z = from_distance(beyond, inset_m_).front().z;
        return end;
    }

    bool comes_back(SidePart const& beyond) const {
        return distance(in_plan(beyond.vertices.front()), in_plan(beyond.vertices.back())) <=
                   joined_cells * grid_.cell_m &&
               std::ranges::none_of(beyond.vertices, [this](Vec3 p) { return is_met(p); });
    }

    /// An end at the edge: the line's number, and whether it is its last vertex.
    struct EdgeEnd {
        std::size_t line;
        bool is_last;
    };

    Cell outermost(RiverLine const& line, bool is_last) const {
        return grid_.cell_of(in_plan(is_last ? line.vertices.back() : line.vertices.front()));
    }

    /// Joins ends in neighbouring cells one cell inside the edge, where there is no land between them: two rivers that
    /// leave the grid side by side meet there, one that leaves and comes back goes on. Lines count as drawn downstream
    /// unless their file says otherwise.
    void join_neighbours(std::vector<RiverLine>& lines) const {
        std::map<std::pair<std::int64_t, std::int64_t>, EdgeEnd> ends;
        for (std::size_t l = 0; l < lines.size(); ++l) {
            for (bool const is_last : {false, true}) {
                if (is_last ? !lines[l].ends_at_edge : !lines[l].begins_at_edge) {
                    continue;
                }
                Cell const at = outermost(lines[l], is_last);
                bool is_joined = false;
                for (std::int64_t row = at.row - 1; row <= at.row + 1 && !is_joined; ++row) {
                    for (std::int64_t col = at.col - 1; col <= at.col + 1 && !is_joined; ++col) {
                        if (auto const other = ends.find({col, row}); other != ends.end()) {
                            is_joined = join(lines, other->second, {l, is_last});
                            if (is_joined && !is_at_edge(lines, other->second)) {
                                ends.erase(other);
                            }
                        }
                    }
                }
                if (!is_joined) {
                    ends.try_emplace({at.col, at.row}, EdgeEnd{l, is_last});
                }
            }
        }
    }

    static bool is_at_edge(std::vector<RiverLine> const& lines, EdgeEnd end) {
        return end.is_last ? lines[end.line].ends_at_edge : lines[end.line].begins_at_edge;
    }

    /// \return false for the heads of two rivers, or of one line
    static bool join(std::vector<RiverLine>& lines, EdgeEnd kept, EdgeEnd moved) {
        RiverLine& other = lines[kept.line];
        RiverLine& own = lines[moved.line];
        bool const gives = kept.is_last == (other.runs >= 0);
        bool const has = moved.is_last == (own.runs >= 0);
        if (kept.line == moved.line || (!gives && !has)) {
            return false;
        }
        std::vector<Vec3>& theirs = other.vertices;
        Vec3 const meeting = kept.is_last ? theirs[theirs.size() - 2] : theirs[1];
        (moved.is_last ? own.vertices.back() : own.vertices.front()) = meeting;
        (moved.is_last ? own.ends_at_edge : own.begins_at_edge) = false;
        if (gives != has) { // one river: it does not touch the edge
            theirs.erase(kept.is_last ? theirs.end() - 1 : theirs.begin());
            (kept.is_last ? other.ends_at_edge : other.begins_at_edge) = false;
        }
        return true;
    }

    void cut(RiverLine const& line, RiverLines& out) const {
        std::vector<SidePart> const parts = parts_by_side(line.vertices, window_);
        std::vector<Vec3> piece;
        bool began_at_edge = false;
        auto const leave_out = [&](std::vector<Vec3> const& part) {
            if (part.size() > 1) {
                out.secondary.push_back(beyond_grid(line, part));
            }
        };
        auto const finish = [&](bool ends_at_edge) {
            bool const is_scrap = began_at_edge && ends_at_edge && length_in_plan(piece) < fewest_cells * grid_.cell_m;
            if (is_scrap) {
                leave_out(piece);
            } else if (piece.size() > 1) {
                RiverLine& one = out.lines.emplace_back(line);
                one.vertices = piece;
                one.begins_at_edge = began_at_edge;
                one.ends_at_edge = ends_at_edge;
            }
            piece.clear();
        };
        for (std::size_t i = 0; i < parts.size(); ++i) {
            std::vector<Vec3> const& part = parts[i].vertices;
            bool const is_last = i + 1 == parts.size();
            if (parts[i].is_inside) {
                piece.insert(piece.end(), part.begin() + (piece.empty() ? 0 : 1), part.end());
                continue;
            }
            if (!piece.empty() && !is_last && comes_back(parts[i])) {
                leave_out(from_distance(part, distance(in_plan(part.front()), in_plan(part.back()))));
                piece.push_back(part.back());
                continue;
            }
            // What is drawn on takes the place of as many metres beyond.
            std::vector<Vec3> const after = piece.empty() ? part : from_distance(part, inset_m_);
            leave_out(is_last ? after : reversed(from_distance(reversed(after), inset_m_)));
            if (!piece.empty()) {
                piece.push_back(on_grid_edge(part));
                finish(true);
            }
            began_at_edge = !is_last;
            if (!is_last) {
                piece = {on_grid_edge(reversed(part)), part.back()};
            }
        }
        finish(false);
    }

    RiverLines const& lines_;
    Grid const& grid_;
    double inset_m_;
    Window window_;
    std::map<Place, Meeting> meetings_; ///< by position outside the window
};

} // namespace

RiverLines clip_lines(RiverLines const& lines, Grid const& grid) {
    Window const box{grid.west, grid.east(), grid.south(), grid.north};
    RiverLines out = lines;
    out.lines.clear();
    for (RiverLine const& line : lines.lines) {
        for (SidePart& part : parts_by_side(line.vertices, box)) {
            if (part.is_inside) {
                out.lines.emplace_back(line).vertices = std::move(part.vertices);
            } else {
                out.secondary.push_back(beyond_grid(line, std::move(part.vertices)));
            }
        }
    }
    return out;
}

RiverLines end_at_edge(RiverLines const& lines, Grid const& grid) {
    constexpr std::int64_t fewest = 5;
    return std::min(grid.width, grid.height) < fewest ? clip_lines(lines, grid) : Ending(lines, grid).ended();
}

} // namespace thalweg::network
