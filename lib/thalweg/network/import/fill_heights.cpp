// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::network {

namespace {

bool has_heights(RiverLine const& line) {
    return std::all_of(line.vertices.begin(), line.vertices.end(), [](Vec3 const& v) { return std::isfinite(v.z); });
}

/// Lines whose heights are found one after another.
class Filling {
public:
    Filling(std::vector<RiverLine>& lines, double slope) : lines_(lines), slope_(slope) {
        double falling = 0.0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (has_heights(lines[i])) {
                auto const& v = lines[i].vertices;
                falling += v.front().z > v.back().z ? 1.0 : v.front().z < v.back().z ? -1.0 : 0.0;
                learn(v);
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
    using Place = std::pair<double, double>;

    void learn(std::vector<Vec3> const& line) {
        for (Vec3 const& v : line) {
            auto const [known, is_new] = known_.try_emplace({v.x, v.y}, v.z);
            known->second = std::min(known->second, v.z);
        }
    }

    std::optional<double> height_at(Vec3 const& v) const {
        auto const found = known_.find({v.x, v.y});
        return found == known_.end() ? std::nullopt : std::optional(found->second);
    }

    /// All lines of which so many ends are known now.
    bool fill_those_with(int ends) {
        std::vector<std::size_t> now;
        std::vector<std::size_t> later;
        for (std::size_t const i : open_) {
            auto const& v = lines_[i].vertices;
            int const known = (height_at(v.front()) ? 1 : 0) + (height_at(v.back()) ? 1 : 0);
            (known == ends ? now : later).push_back(i);
        }
        for (std::size_t const i : now) {
            auto& v = lines_[i].vertices;
            double const rise = slope_ * length_in_plan(v) * (drawn_downstream_ ? 1.0 : -1.0); // from last to first
            std::optional<double> const first = height_at(v.front());
            std::optional<double> const last = height_at(v.back());
            draw(v, first.value_or(last.value_or(0.0) + rise), last.value_or(first.value_or(0.0) - rise));
        }
        for (std::size_t const i : now) {
            learn(lines_[i].vertices);
        }
        open_ = std::move(later);
        return !now.empty();
    }

    void fill_beside_nearest(std::size_t i) {
        auto& v = lines_[i].vertices;
        double const rise = slope_ * length_in_plan(v);
        Vec2 const mouth = plan(drawn_downstream_ ? v.back() : v.front());
        double nearest = std::numeric_limits<double>::infinity();
        double low = 0.0;
        for (auto const& [place, z] : known_) {
            double const away = distance(mouth, {place.first, place.second});
            if (away < nearest) {
                nearest = away;
                low = z;
            }
        }
        draw(v, drawn_downstream_ ? low + rise : low, drawn_downstream_ ? low : low + rise);
        learn(v);
    }

    static void draw(std::vector<Vec3>& line, double first, double last) {
        double const length = length_in_plan(line);
        double along = 0.0;
        for (std::size_t i = 0; i < line.size(); ++i) {
            along += i == 0 ? 0.0 : distance(plan(line[i - 1]), plan(line[i]));
            double const share = length > 0.0 ? along / length : 0.0;
            line[i].z = i + 1 == line.size() ? last : first + (last - first) * share;
        }
    }

    std::vector<RiverLine>& lines_;
    double slope_;
    bool drawn_downstream_ = true;
    std::map<Place, double> known_; ///< the lowest height at each place
    std::vector<std::size_t> open_; ///< lines without heights
};

} // namespace

FilledHeights fill_heights(RiverLines lines, double slope) {
    if (!(slope > 0.0)) {
        throw BadParameter(fmt::format("network.fill_heights: slope {}; give one above 0", slope));
    }
    FilledHeights out{std::move(lines), 0, 0};
    Filling filling(out.lines.lines, slope);
    if (filling.open().empty() || !filling.tells_anything()) {
        return out;
    }
    out.filled = static_cast<std::int64_t>(filling.open().size());
    out.first = out.lines.lines[filling.open().front()].feature;
    filling.fill();
    out.lines.has_z = true;
    return out;
}

} // namespace thalweg::network
