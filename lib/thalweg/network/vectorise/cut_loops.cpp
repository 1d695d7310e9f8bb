// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <map>
#include <utility>

#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::network {
namespace {

std::vector<Vec2> plan_of(std::vector<Vec3> const& line) {
    std::vector<Vec2> result;
    for (Vec3 const p : line) {
        result.push_back(plan(p));
    }
    return result;
}

// Without the tips of spikes; taking one away may leave another.
std::vector<Vec3> without_spikes(std::vector<Vec3> const& line, double near_m) {
    std::vector<Vec3> result;
    for (Vec3 const p : line) {
        while (result.size() > 1 &&
               geometry::is_spike(plan(result[result.size() - 2]), plan(result.back()), plan(p), near_m)) {
            result.pop_back();
        }
        if (result.empty() || plan(result.back()) != plan(p)) {
            result.push_back(p);
        }
    }
    return result;
}

// With a vertex wherever the line meets itself.
std::vector<Vec3> with_crossings(std::vector<Vec3> const& line) {
    auto const found = geometry::crossings({plan_of(line)}); // by segment, then along it
    std::vector<Vec3> result;
    auto next = found.begin();
    for (std::size_t i = 0; i < line.size(); ++i) {
        result.push_back(line[i]);
        for (; next != found.end() && next->segment == i; ++next) {
            double const z = line[i].z + next->along * (line[i + 1].z - line[i].z);
            if (plan(result.back()) != next->at && plan(line[i + 1]) != next->at) {
                result.push_back({next->at.x, next->at.y, z});
            }
        }
    }
    return result;
}

// From a vertex straight on from where the line leaves it for the last time.
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
    // A crossing that is rounded bends the line a little: nearly always the first round is the last.
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

} // namespace thalweg::network
