// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/river_heights.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::network {
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
        int falling = 0;
        double fall_m = 0.0;
        double length_m = 0.0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            auto const& v = lines[i].vertices;
            learn(v);
            falling += fall_of(v);
            if (fall_of(v) != 0) {
                auto const [first, last] = ends_of_known(v);
                fall_m += std::fabs(first->z - (last - 1)->z);
                length_m += length_in_plan({first, last});
            }
            if (!has_heights(lines[i])) {
                open_.push_back(i);
            }
        }
        drawn_downstream_ = falling >= 0;
        slope_ = length_m > 0.0 ? std::min(slope_, fall_m / length_m) : slope_;
        learn_from_both_sides();
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

    using Vertices = std::vector<Vec3>;

    /// The known heights of a line: the first of them, and behind the last.
    static std::pair<Vertices::const_iterator, Vertices::const_iterator> ends_of_known(Vertices const& line) {
        return {std::ranges::find_if(line, has_height), std::find_if(line.rbegin(), line.rend(), has_height).base()};
    }

    /// 1: the known heights of a line fall as it is drawn; -1: they rise; 0: neither.
    static int fall_of(Vertices const& line) {
        auto const [first, last] = ends_of_known(line);
        return first == line.end() || first->z == (last - 1)->z ? 0 : first->z > (last - 1)->z ? 1 : -1;
    }

    /// By which heights beyond the known ones rise or fall: not more than these do.
    double slope_of(Vertices const& line) const {
        auto const [first, last] = ends_of_known(line);
        return fall_of(line) == 0
                   ? slope_
                   : std::min(slope_, std::fabs(first->z - (last - 1)->z) / length_in_plan({first, last}));
    }

    /// What a line says of one of its ends, whose height is not known.
    struct FromEnd {
        double z_m = 0.0;    ///< the nearest known height
        double away_m = 0.0; ///< its distance along the line
        int fall = 0;        ///< 1: its known heights fall to the end; -1: they rise to it; 0: neither
        double slope = 0.0;  ///< [m/m] by which they go on
    };

    std::optional<FromEnd> from_end(std::vector<Vec3> const& line, bool is_back) const {
        std::vector<Vec3> const way =
            is_back ? std::vector<Vec3>(line.rbegin(), line.rend()) : std::vector<Vec3>(line.begin(), line.end());
        auto const nearest = std::ranges::find_if(way, has_height);
        if (nearest == way.end()) {
            return std::nullopt;
        }
        return FromEnd{nearest->z, length_in_plan({way.begin(), nearest + 1}), -fall_of(way), slope_of(way)};
    }

    /// [m] The height of an end at which lines meet that have heights.
    double height_between(std::vector<FromEnd> const& ends) const {
        auto const lowest = std::ranges::min_element(ends, {}, &FromEnd::z_m);
        bool const all_rise = std::ranges::all_of(ends, [](FromEnd const& e) { return e.fall < 0; });
        double z = all_rise ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
        for (auto end = ends.begin(); end != ends.end(); ++end) {
            double const length = end->away_m + lowest->away_m;
            double const share = length > 0.0 ? lowest->away_m / length : 0.0;
            if (all_rise) {
                z = std::max(z, end->z_m + end->slope * end->away_m);
            } else if (lowest->fall > 0) { // the water leaves by another line
                z = std::min(z, end->z_m - end->slope * end->away_m);
            } else if (end != lowest) {
                z = std::min(z, lowest->z_m + share * (end->z_m - lowest->z_m));
            }
        }
        return z;
    }

    /// Learns heights of ends at which two lines or more with heights meet.
    void learn_from_both_sides() {
        std::map<WayPoint, std::vector<FromEnd>> ends;
        for (std::size_t const i : open_) {
            auto const& v = lines_[i].vertices;
            for (bool const is_back : {false, true}) {
                Vec3 const end = v.empty() ? Vec3{} : is_back ? v.back() : v.front();
                auto const seen = v.empty() || has_height(end) || known_.contains({end.x, end.y})
                                      ? std::nullopt
                                      : from_end(v, is_back);
                if (seen) {
                    ends[{end.x, end.y}].push_back(*seen);
                }
            }
        }
        for (auto const& [place, seen] : ends) {
            if (seen.size() > 1) {
                known_[place] = height_between(seen);
            }
        }
    }

    /// Heights from the known ones of a line, which has some: beyond them by slope.
    void draw(std::vector<Vec3>& line) const {
        auto const first = std::find_if(line.begin(), line.end(), has_height);
        auto const last = std::find_if(line.rbegin(), line.rend(), has_height);
        int const fall = fall_of(line);
        double const fall_per_m = slope_of(line) * (fall != 0 ? fall : drawn_downstream_ ? 1 : -1);
        double const before = fall_per_m * length_in_plan({line.begin(), first + 1});
        double const after = fall_per_m * length_in_plan({last.base() - 1, line.end()});
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

constexpr double no_data_m = -9999.0;
constexpr double above_m = 1.0; ///< heights above it say that a line does not lie at the sea
constexpr double high_m = 10.0; ///< likewise, where zeros follow one another
// How steep the step to a mouth may be, by the steepest of the line's other ones: where lines share it and are not
// drawn alike; and in a file with placeholders.
constexpr double mouth_steepness = 2;
constexpr double cliff_steepness = 5;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A line from one of its ends at 0.
struct FromZero {
    std::size_t line = 0;
    bool is_back = false;    ///< the end is the line's last vertex
    std::size_t zeros = 0;   ///< vertices of 0 that follow one another from the end
    double near_m = missing; ///< the first other height
    double far_m = missing;  ///< the last height, of two vertices or more
    double step = 0.0;       ///< [m/m] from the end to near_m
    double steepest = 0.0;   ///< [m/m] of the other segments

    bool rises() const { return zeros == 1 && near_m > 0.0; }
    bool is_mute() const { return rises() && std::isnan(far_m); } ///< has no other height
    bool is_fallen_to() const { return rises() && far_m >= near_m; }
    bool falls_away() const { return rises() && near_m - far_m > above_m; }
};

double slope_between(Vec3 const& a, Vec3 const& b) {
    double const away = distance(in_plan(a), in_plan(b));
    return away > 0.0 ? std::fabs(b.z - a.z) / away : 0.0;
}

FromZero from_zero(std::vector<Vec3> line, std::size_t number, bool is_back) {
    if (is_back) {
        std::ranges::reverse(line);
    }
    FromZero from{number, is_back};
    auto const near = std::ranges::find_if(line, [](Vec3 const& v) { return v.z != 0.0; });
    from.zeros = static_cast<std::size_t>(near - line.begin());
    if (near == line.end()) {
        return from;
    }
    from.near_m = near->z;
    from.step = slope_between(*(near - 1), *near);
    auto const says = [](Vec3 const& v) { return has_height(v) && v.z != 0.0; };
    for (auto v = near + 1; v != line.end(); ++v) {
        from.far_m = says(*v) ? v->z : from.far_m;
        from.steepest = std::max(from.steepest, says(*v) && says(*(v - 1)) ? slope_between(*(v - 1), *v) : 0.0);
    }
    return from;
}

/// Lines that end at one position at 0.
struct ZeroNode {
    std::vector<FromZero> ends;
    double other_m = missing; ///< the height farthest from 0 that a vertex has there

    /// Whether all lines fall to it, and none is drawn as what leaves a confluence.
    bool is_mouth_of_all() const {
        auto const falls = [](FromZero const& e) { return e.is_fallen_to() || e.is_mute(); };
        auto const falls_gently = [](FromZero const& e) {
            return e.is_fallen_to() && e.step <= mouth_steepness * e.steepest;
        };
        auto const is_drawn_alike = [&](FromZero const& e) { return e.is_back == ends.front().is_back; };
        return std::ranges::all_of(ends, falls_gently) ||
               (std::ranges::all_of(ends, falls) && std::ranges::all_of(ends, is_drawn_alike));
    }
    bool is_free() const { return ends.size() == 1 && std::isnan(other_m); }
    /// Whether 0 is no height of one of its ends.
    bool is_missing(FromZero const& end) const {
        if (!std::isnan(other_m)) {
            return end.zeros == 1 || std::fabs(other_m) > high_m;
        }
        if (ends.size() == 1) {
            return end.falls_away();
        }
        return std::ranges::all_of(ends, &FromZero::rises) && !is_mouth_of_all();
    }
    /// Whether a line ends here at its mouth, in a file with zeros that are no heights.
    bool is_mouth() const {
        FromZero const& end = ends.front();
        return is_free() && end.is_fallen_to() && (end.near_m <= high_m || end.step <= cliff_steepness * end.steepest);
    }
    /// The same of a line that says nothing of how it falls.
    bool may_be_mouth() const { return is_free() && ends.front().is_mute(); }
};

bool has_zero_between(std::vector<Vec3> const& line) {
    auto const is_high = [](Vec3 const& v) { return v.z > above_m; };
    auto const first = std::ranges::find_if(line, is_high);
    auto const last = std::find_if(line.rbegin(), line.rend(), is_high).base();
    return first < last && std::any_of(first, last, [](Vec3 const& v) { return v.z == 0.0; });
}

/// Finds heights of 0 that stand for missing ones.
class ZeroFinder {
public:
    explicit ZeroFinder(std::vector<std::vector<Vec3>*> lines) : lines_(std::move(lines)) {
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            add_ends(i);
        }
        if (nodes_.empty()) {
            return;
        }
        for (auto const* const line : lines_) {
            for (Vec3 const& v : *line) {
                auto const node = v.z != 0.0 && has_height(v) ? nodes_.find({v.x, v.y}) : nodes_.end();
                if (node != nodes_.end() && !(std::fabs(node->second.other_m) >= std::fabs(v.z))) {
                    node->second.other_m = v.z;
                }
            }
        }
    }

    /// By line: the vertices whose 0 is none.
    std::vector<std::vector<std::size_t>> find() {
        found_.assign(lines_.size(), {});
        bool const zeros_between =
            std::ranges::any_of(lines_, [](auto const* line) { return has_zero_between(*line); });
        if (zeros_between) {
            find_all_but_mouths();
        } else {
            find_ends();
        }
        return std::move(found_);
    }

private:
    void add_ends(std::size_t i) {
        auto const& line = *lines_[i];
        if (line.size() < 2 || in_plan(line.front()) == in_plan(line.back())) { // a shore at 0 has no ends
            return;
        }
        for (bool const is_back : {false, true}) {
            Vec3 const& end = is_back ? line.back() : line.front();
            if (end.z == 0.0) {
                nodes_[{end.x, end.y}].ends.push_back(from_zero(line, i, is_back));
            }
        }
    }

    void take(FromZero const& end) {
        std::size_t const size = lines_[end.line]->size();
        for (std::size_t k = 0; k < end.zeros; ++k) {
            found_[end.line].push_back(end.is_back ? size - 1 - k : k);
        }
    }

    ZeroNode const& node_of(std::size_t line, bool is_back) const {
        Vec3 const& end = is_back ? lines_[line]->back() : lines_[line]->front();
        return nodes_.at({end.x, end.y});
    }

    /// Of a line that rises above 1 m between two ends at 0 none counts, but for a mouth where the other end is
    /// explained by what it meets.
    bool is_between_zeros(ZeroNode const& node, FromZero const& end) const {
        auto const& line = *lines_[end.line];
        if (end.zeros != 1 || line.front().z != 0.0 || line.back().z != 0.0 ||
            std::ranges::none_of(line, [](Vec3 const& v) { return v.z > above_m; })) {
            return false;
        }
        ZeroNode const& other = node_of(end.line, !end.is_back);
        bool const is_explained = !other.is_free() && std::ranges::any_of(other.ends, [&](FromZero const& there) {
            return there.line == end.line && there.is_back != end.is_back && other.is_missing(there);
        });
        return !(is_explained && node.is_mouth());
    }

    void find_ends() {
        bool any = false;
        std::vector<ZeroNode const*> left;
        for (auto const& [place, node] : nodes_) {
            for (FromZero const& end : node.ends) {
                if (node.is_missing(end) || is_between_zeros(node, end)) {
                    take(end);
                    any = true;
                } else if (node.is_free()) {
                    left.push_back(&node);
                }
            }
        }
        for (ZeroNode const* const node : left) {
            if (any && node->ends.front().rises() && !node->is_mouth() && !node->may_be_mouth()) {
                take(node->ends.front());
            }
        }
    }

    void find_all_but_mouths() {
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            for (std::size_t k = 0; k < lines_[i]->size(); ++k) {
                if ((*lines_[i])[k].z == 0.0) {
                    found_[i].push_back(k);
                }
            }
        }
        for (auto const& [place, node] : nodes_) {
            FromZero const& end = node.ends.front();
            if (node.is_mouth() && !is_between_zeros(node, end)) {
                std::erase(found_[end.line], end.is_back ? lines_[end.line]->size() - 1 : 0);
            }
        }
    }

    std::vector<std::vector<Vec3>*> lines_;
    std::map<std::pair<double, double>, ZeroNode> nodes_; ///< by position
    std::vector<std::vector<std::size_t>> found_;
};

} // namespace

WithoutPlaceholders without_placeholders(RiverLines lines) {
    WithoutPlaceholders out;
    std::vector<std::vector<Vec3>*> vertices;
    std::vector<std::int64_t> features;
    for (auto* const some : {&lines.lines, &lines.channels}) {
        for (RiverLine& line : *some) {
            vertices.push_back(&line.vertices);
            features.push_back(line.feature);
        }
    }
    auto const remove = [&](std::size_t line, Vec3& v) {
        if (out.vertices == 0) {
            out.first = features[line];
            out.at = in_plan(v);
        }
        v.z = missing;
        ++out.vertices;
    };
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (Vec3& v : *vertices[i]) {
            if (v.z <= no_data_m) {
                remove(i, v);
            }
        }
    }
    auto const zeros = ZeroFinder(vertices).find();
    for (std::size_t i = 0; i < zeros.size(); ++i) {
        for (std::size_t const k : zeros[i]) {
            if (has_height((*vertices[i])[k])) { // else it is at both ends of a line of zeros
                remove(i, (*vertices[i])[k]);
                ++out.zeros;
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
    refuse_if<BadParameter>(!(slope > 0.0), "network.fill_heights", "slope {}; give one above 0", slope);
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

RiverLines with_all_heights(RiverLines lines, double slope) {
    FilledHeights filled = fill_heights(std::move(lines), slope);
    double same = std::numeric_limits<double>::quiet_NaN();
    for (RiverLine const& line : filled.lines.lines) {
        auto const known = std::ranges::find_if(line.vertices, has_height);
        same = known == line.vertices.end() ? same : known->z;
    }
    for (RiverLine& line : filled.lines.lines) {
        for (Vec3& v : line.vertices) {
            v.z = has_height(v) ? v.z : same; // else there was nothing to derive heights from
        }
    }
    return std::move(filled.lines);
}

} // namespace thalweg::network
