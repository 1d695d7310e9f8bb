// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>

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

} // namespace

RiverLines clip_lines(RiverLines const& lines, Grid const& grid) {
    Window const box{grid.west, grid.east(), grid.south(), grid.north};
    RiverLines out = lines;
    out.lines.clear();
    for (RiverLine const& line : lines.lines) {
        RiverLine piece = line;
        piece.vertices.clear();
        SecondaryLine beyond{line.feature, {}, "beyond the grid", line.feature, LeftOut::grid};
        auto const finish = [&] {
            if (piece.vertices.size() > 1) {
                out.lines.push_back(piece);
            }
            piece.vertices.clear();
        };
        auto const go_beyond = [&](Vec3 from, Vec3 to) {
            if (beyond.vertices.empty()) {
                beyond.vertices.push_back(from);
            }
            beyond.vertices.push_back(to);
        };
        auto const come_back = [&] {
            if (!beyond.vertices.empty()) {
                out.secondary.push_back(beyond);
            }
            beyond.vertices.clear();
        };
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            Vec3 const a = line.vertices[i - 1];
            Vec3 const b = line.vertices[i];
            auto const part = inside(a, b, box);
            if (!part) {
                finish();
                go_beyond(a, b);
                continue;
            }
            Vec3 const entry = box.holds(a) ? a : on_edge(a, b, part->first, box);
            Vec3 const exit = box.holds(b) ? b : on_edge(a, b, part->second, box);
            if (!box.holds(a)) {
                go_beyond(a, entry);
            }
            come_back();
            if (piece.vertices.empty()) {
                piece.vertices.push_back(entry);
            }
            piece.vertices.push_back(exit);
            if (!box.holds(b)) {
                finish();
                go_beyond(exit, b);
            }
        }
        finish();
        come_back();
    }
    return out;
}

namespace {

/// A vertex, or the middle of what a line runs through a cell.
struct WayPoint {
    Vec3 at;
    bool is_vertex = false;
    bool is_in = false;
};

/// Where a segment goes from one cell to the next, as shares of it, with both ends.
std::vector<double> shares_by_cell(Vec3 a, Vec3 b, Grid const& grid) {
    std::vector<double> shares{0.0, 1.0};
    auto const add = [&](double from, double to) {
        for (double edge = std::ceil(std::min(from, to)); edge < std::max(from, to); edge += 1.0) {
            shares.push_back(std::clamp((edge - from) / (to - from), 0.0, 1.0));
        }
    };
    add((a.x - grid.west) / grid.cell_m, (b.x - grid.west) / grid.cell_m);
    add((grid.north - a.y) / grid.cell_m, (grid.north - b.y) / grid.cell_m);
    std::ranges::sort(shares);
    return shares;
}

std::vector<WayPoint> way_points(std::vector<Vec3> const& line, Mask const& land) {
    auto const place = [&](Vec3 p, bool is_vertex) {
        Cell const cell = land.grid().cell_of({p.x, p.y});
        return WayPoint{p, is_vertex, land.grid().contains(cell) && land[cell] != 0};
    };
    std::vector<WayPoint> places{place(line.front(), true)};
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        std::vector<double> const shares = shares_by_cell(a, b, land.grid());
        for (std::size_t k = 1; k < shares.size(); ++k) {
            double const middle = 0.5 * (shares[k - 1] + shares[k]);
            if (shares[k - 1] < shares[k]) {
                places.push_back(
                    place({a.x + middle * (b.x - a.x), a.y + middle * (b.y - a.y), a.z + middle * (b.z - a.z)}, false));
            }
        }
        places.push_back(place(b, true));
    }
    return places;
}

/// Vertices, and the places between which a line leaves the land; without vertices on the edge of a cell beside it.
std::vector<WayPoint> turning_points(std::vector<WayPoint> const& all) {
    std::vector<WayPoint> places;
    for (std::size_t i = 0; i < all.size(); ++i) {
        WayPoint const& here = all[i];
        WayPoint const& before = all[i > 0 ? i - 1 : i];
        WayPoint const& after = all[i + 1 < all.size() ? i + 1 : i];
        bool const on_edge_of_land = !here.is_in && before.is_in && after.is_in;
        bool const turns = here.is_in != before.is_in || here.is_in != after.is_in;
        if (here.is_vertex ? !on_edge_of_land : turns) {
            places.push_back(here);
        }
    }
    return places;
}

} // namespace

RiverLines clip_lines(RiverLines const& lines, Mask const& land) {
    RiverLines out = lines;
    out.lines.clear();
    for (RiverLine const& line : lines.lines) {
        std::vector<WayPoint> const places = turning_points(way_points(line.vertices, land));
        for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            bool const is_in = places[begin].is_in;
            while (end < places.size() && places[end].is_in == is_in) {
                ++end;
            }
            std::size_t const first = is_in || begin == 0 ? begin : begin - 1; // what is beyond reaches to the pieces
            std::size_t const last = is_in || end == places.size() ? end : end + 1;
            std::vector<Vec3> vertices;
            for (std::size_t i = first; i < last; ++i) {
                vertices.push_back(places[i].at);
            }
            if (vertices.size() > 1 && is_in) {
                RiverLine& piece = out.lines.emplace_back(line);
                piece.vertices = std::move(vertices);
            } else if (vertices.size() > 1) {
                out.secondary.push_back(
                    {line.feature, std::move(vertices), "beyond the terrain", line.feature, LeftOut::grid});
            }
        }
    }
    return out;
}

namespace {

std::vector<Vec2> plan_of(std::vector<Vec3> const& line) {
    std::vector<Vec2> result;
    for (Vec3 const p : line) {
        result.push_back(in_plan(p));
    }
    return result;
}

// Removes the tips of spikes; that may expose another spike.
std::vector<Vec3> without_spikes(std::vector<Vec3> const& line, double near_m) {
    std::vector<Vec3> result;
    for (Vec3 const p : line) {
        while (result.size() > 1 &&
               geometry::is_spike(in_plan(result[result.size() - 2]), in_plan(result.back()), in_plan(p), near_m)) {
            result.pop_back();
        }
        if (result.empty() || in_plan(result.back()) != in_plan(p)) {
            result.push_back(p);
        }
    }
    return result;
}

// Adds a vertex wherever the line meets itself.
std::vector<Vec3> with_crossings(std::vector<Vec3> const& line) {
    auto const found = geometry::crossings({plan_of(line)}); // by segment, then along it
    std::vector<Vec3> result;
    auto next = found.begin();
    for (std::size_t i = 0; i < line.size(); ++i) {
        result.push_back(line[i]);
        for (; next != found.end() && next->segment == i; ++next) {
            double const z = line[i].z + next->along * (line[i + 1].z - line[i].z);
            if (in_plan(result.back()) != next->at && in_plan(line[i + 1]) != next->at) {
                result.push_back({next->at.x, next->at.y, z});
            }
        }
    }
    return result;
}

// Skips from a vertex to where the line leaves it for the last time.
std::vector<Vec3> without_returns(std::vector<Vec3> const& line) {
    std::map<std::pair<double, double>, std::size_t> last;
    for (std::size_t i = 0; i < line.size(); ++i) {
        last[{line[i].x, line[i].y}] = i;
    }
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < line.size(); ++i) {
        result.push_back(line[i]);
        i = last[{line[i].x, line[i].y}];
    }
    if (result.size() > 1) {
        result.back() = line.back();
    }
    return result;
}

} // namespace

CutLine cut_loops(std::vector<Vec3> const& line, double near_m) {
    CutLine cut{without_spikes(line, near_m), 0.0};
    // A rounded crossing bends the line slightly: the first round nearly always suffices.
    constexpr int rounds = 16;
    for (int round = 0; round < rounds; ++round) {
        auto const crossed = with_crossings(cut.line);
        auto next = without_returns(crossed);
        bool const settled = next.size() == cut.line.size();
        cut.line = std::move(next);
        if (settled) {
            break;
        }
    }
    cut.cut_m = std::max(0.0, length_in_plan(line) - length_in_plan(cut.line));
    return cut;
}

namespace {

bool has_height(Vec3 const& v) {
    return std::isfinite(v.z);
}

bool has_heights(RiverLine const& line) {
    return std::all_of(line.vertices.begin(), line.vertices.end(), has_height);
}

bool has_some_heights(RiverLine const& line) {
    return std::any_of(line.vertices.begin(), line.vertices.end(), has_height);
}

/// Heights of vertices without, linear by length between those with; the ends have heights.
void interpolate(std::vector<Vec3>& line) {
    for (std::size_t from = 0; from + 1 < line.size();) {
        std::size_t to = from + 1;
        while (!has_height(line[to])) {
            ++to;
        }
        std::vector<double> along{0.0};
        for (std::size_t i = from + 1; i <= to; ++i) {
            along.push_back(along.back() + distance(in_plan(line[i - 1]), in_plan(line[i])));
        }
        double const rise = line[to].z - line[from].z;
        for (std::size_t i = from + 1; i < to; ++i) {
            line[i].z = line[from].z + rise * (along.back() > 0.0 ? along[i - from] / along.back() : 0.0);
        }
        from = to;
    }
}

/// Lines whose heights are determined one after another.
class Filling {
public:
    Filling(std::vector<RiverLine>& lines, double slope) : lines_(lines), slope_(slope) {
        double falling = 0.0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            auto const& v = lines[i].vertices;
            learn(v);
            if (has_heights(lines[i])) {
                falling += v.front().z > v.back().z ? 1.0 : v.front().z < v.back().z ? -1.0 : 0.0;
            } else {
                open_.push_back(i);
            }
        }
        drawn_downstream_ = falling >= 0.0;
    }

    std::vector<std::size_t> const& open() const { return open_; }

    bool tells_anything() const {
        return std::any_of(known_.begin(), known_.end(),
                           [this](auto const& place) { return place.second != known_.begin()->second; });
    }

    void fill() {
        while (!open_.empty()) {
            if (!fill_those_with(2) && !fill_those_with(1)) {
                fill_beside_nearest(open_.front());
                open_.erase(open_.begin());
            }
        }
    }

private:
    using WayPoint = std::pair<double, double>;

    void learn(std::vector<Vec3> const& line) {
        for (Vec3 const& v : line) {
            if (has_height(v)) {
                auto const [known, is_new] = known_.try_emplace({v.x, v.y}, v.z);
                known->second = std::min(known->second, v.z);
            }
        }
    }

    /// Gives an end the height of lines that it meets.
    void meet(Vec3& end) const {
        auto const found = known_.find({end.x, end.y});
        end.z = has_height(end) || found == known_.end() ? end.z : found->second;
    }

    /// [m] by which a line rises from its last vertex to its first.
    double rise_of(std::vector<Vec3> const& line) const {
        return slope_ * length_in_plan(line) * (drawn_downstream_ ? 1.0 : -1.0);
    }

    /// Heights from the known ones of a line, which has some: beyond them by slope.
    void draw(std::vector<Vec3>& line) const {
        auto const first = std::find_if(line.begin(), line.end(), has_height);
        auto const last = std::find_if(line.rbegin(), line.rend(), has_height);
        double const before = rise_of({line.begin(), first + 1});
        double const after = rise_of({last.base() - 1, line.end()});
        double const from = first->z + before;
        double const to = last->z - after;
        line.front().z = first == line.begin() ? first->z : from;
        line.back().z = last == line.rbegin() ? last->z : to;
        interpolate(line);
    }

    /// Fills all lines with this number of known ends; with known heights between them as with one.
    bool fill_those_with(int ends) {
        std::vector<std::size_t> now;
        std::vector<std::size_t> later;
        for (std::size_t const i : open_) {
            Vec3 first = lines_[i].vertices.front();
            Vec3 last = lines_[i].vertices.back();
            meet(first);
            meet(last);
            int const known = (has_height(first) ? 1 : 0) + (has_height(last) ? 1 : 0);
            bool const takes = known == ends || (ends == 1 && known == 0 && has_some_heights(lines_[i]));
            (takes ? now : later).push_back(i);
        }
        for (std::size_t const i : now) { // one after another, as they may meet
            auto& v = lines_[i].vertices;
            meet(v.front());
            meet(v.back());
            draw(v);
            learn(v);
        }
        open_ = std::move(later);
        return !now.empty();
    }

    void fill_beside_nearest(std::size_t i) {
        auto& v = lines_[i].vertices;
        Vec3& mouth = drawn_downstream_ ? v.back() : v.front();
        double nearest = std::numeric_limits<double>::infinity();
        for (auto const& [place, z] : known_) {
            double const away = distance(in_plan(mouth), {place.first, place.second});
            if (away < nearest) {
                nearest = away;
                mouth.z = z;
            }
        }
        draw(v);
        learn(v);
    }

    std::vector<RiverLine>& lines_;
    double slope_;
    bool drawn_downstream_ = true;
    std::map<WayPoint, double> known_; ///< the lowest height at each position
    std::vector<std::size_t> open_;    ///< lines without heights, or with some
};

} // namespace

WithoutPlaceholders without_placeholders(RiverLines lines) {
    constexpr double no_data_m = -9999.0;
    constexpr double above_m = 1.0;
    WithoutPlaceholders out;
    auto const is_high = [](Vec3 const& v) { return v.z > above_m; };
    out.zeros = std::ranges::any_of(lines.lines, [&](RiverLine const& line) {
        auto const first = std::ranges::find_if(line.vertices, is_high);
        auto const last = std::find_if(line.vertices.rbegin(), line.vertices.rend(), is_high).base();
        return first < last && std::any_of(first, last, [](Vec3 const& v) { return v.z == 0.0; });
    });
    for (RiverLine& line : lines.lines) {
        for (Vec3& v : line.vertices) {
            if (v.z <= no_data_m || (out.zeros && v.z == 0.0)) {
                v.z = std::numeric_limits<double>::quiet_NaN();
                ++out.vertices;
            }
        }
    }
    out.lines = std::move(lines);
    out.lines.has_z = out.lines.has_z && out.vertices == 0;
    return out;
}

std::vector<Vec3> with_heights_between(std::vector<Vec3> line) {
    auto const first = std::find_if(line.begin(), line.end(), has_height);
    if (first != line.end()) {
        line.front().z = first->z;
        line.back().z = std::find_if(line.rbegin(), line.rend(), has_height)->z;
        interpolate(line);
    }
    return line;
}

FilledHeights fill_heights(RiverLines lines, double slope) {
    refuse_if<BadParameter>(!(slope > 0.0), "network.fill_heights: slope {}; give one above 0", slope);
    FilledHeights out{std::move(lines)};
    Filling filling(out.lines.lines, slope);
    if (filling.open().empty() || !filling.tells_anything()) {
        return out;
    }
    out.filled = static_cast<std::int64_t>(filling.open().size());
    out.first = out.lines.lines[filling.open().front()].feature;
    out.partly =
        std::ranges::count_if(filling.open(), [&](std::size_t i) { return has_some_heights(out.lines.lines[i]); });
    filling.fill();
    out.lines.has_z = true;
    return out;
}

} // namespace thalweg::network
