// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

constexpr double near_in_cells = 0.25;     // what lies closer is one river
constexpr double short_in_cells = 4.0;     // lines of fewer cells lie near their neighbours anyway
constexpr double apart_in_cells = 0.5;     // samples along a line
constexpr double covered_share = 0.9;      // of a copy
constexpr std::size_t most_samples = 5000; // of a line

/// Points along a line, both ends left out.
std::vector<Vec2> samples_of(std::vector<Vec2> const& line, std::size_t count) {
    double const step_m = length_of(line) / static_cast<double>(count + 1);
    std::vector<Vec2> samples;
    double along_m = 0.0;
    double next_m = step_m;
    for (std::size_t i = 1; i < line.size() && samples.size() < count; ++i) {
        double const m = distance(line[i - 1], line[i]);
        for (; next_m <= along_m + m && samples.size() < count; next_m += step_m) {
            samples.push_back(line[i - 1] + ((next_m - along_m) / m) * (line[i] - line[i - 1]));
        }
        along_m += m;
    }
    return samples;
}

/// By sample: the other lines that lie near it.
std::vector<std::vector<std::size_t>> beside(std::vector<Vec2> const& samples, std::size_t own,
                                             std::vector<std::vector<geometry::NearSegment>> const& near,
                                             std::size_t first) {
    std::vector<std::vector<std::size_t>> result;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        auto& lines = result.emplace_back();
        for (geometry::NearSegment const& s : near[first + i]) {
            if (s.line != own && (lines.empty() || lines.back() != s.line)) {
                lines.push_back(s.line);
            }
        }
    }
    return result;
}

/// Samples of several lines, and what lies beside them.
struct SampledLines {
    std::vector<std::size_t> lines;
    std::vector<std::vector<std::vector<std::size_t>>> beside; ///< by these lines, by sample
};

template <class Count>
SampledLines sampled(std::vector<std::size_t> const& which, std::vector<std::vector<Vec2>> const& plans, double near_m,
                     Count const& count_of, Run const& run) {
    std::vector<Vec2> all;
    std::vector<std::vector<Vec2>> of_line;
    for (std::size_t const l : which) {
        of_line.push_back(samples_of(plans[l], count_of(l)));
        all.insert(all.end(), of_line.back().begin(), of_line.back().end());
    }
    auto const near = geometry::segments_near(all, plans, near_m, run);
    SampledLines result{which, {}};
    std::size_t first = 0;
    for (std::size_t k = 0; k < which.size(); ++k) {
        result.beside.push_back(beside(of_line[k], which[k], near, first));
        first += of_line[k].size();
    }
    return result;
}

} // namespace

void drop_near_copies(std::vector<RiverLine>& lines, double cell_m, Left& left, Run const& run) {
    std::vector<std::vector<Vec2>> const plans = plan_of(lines);
    double const near_m = near_in_cells * cell_m;
    std::vector<std::size_t> candidates;
    for (std::size_t l = 0; l < plans.size(); ++l) {
        if (length_of(plans[l]) >= short_in_cells * cell_m) {
            candidates.push_back(l);
        }
    }
    SampledLines const quick = sampled(
        candidates, plans, near_m, [](std::size_t) { return 3; }, run);
    std::vector<std::size_t> likely;
    for (std::size_t k = 0; k < quick.lines.size(); ++k) {
        if (std::ranges::count_if(quick.beside[k], [](auto const& others) { return !others.empty(); }) >= 2) {
            likely.push_back(quick.lines[k]);
        }
    }
    if (likely.empty()) {
        return;
    }
    auto const enough = [&](std::size_t l) {
        return std::min(most_samples, static_cast<std::size_t>(length_of(plans[l]) / (apart_in_cells * cell_m)));
    };
    SampledLines const all = sampled(likely, plans, near_m, enough, run);
    std::vector<char> is_gone(lines.size(), 0);
    for (std::size_t k = all.lines.size(); k-- > 0;) {
        std::size_t const l = all.lines[k];
        auto const stays = [&](std::size_t other) { return is_gone[other] == 0; };
        auto const covered = std::ranges::count_if(
            all.beside[k], [&](auto const& others) { return std::ranges::any_of(others, stays); });
        if (static_cast<double>(covered) < covered_share * static_cast<double>(all.beside[k].size())) {
            continue;
        }
        is_gone[l] = 1;
        double const length_m = length_of(plans[l]);
        left.repairs.push_back(
            {"duplicate", lines[l].number(), plans[l].front(), length_m,
             fmt::format("river {} runs beside others within {:.3g} m; it is left out", lines[l].number(), near_m)});
        left.secondary.push_back(
            {lines[l].feature, lines[l].vertices, "duplicate", lines[l].feature, LeftOut::duplicate});
    }
    erase_marked(lines, is_gone);
}

} // namespace thalweg::network::import_steps
