// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/surface/equilibrium/internal/way_between.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace thalweg::surface {

namespace {

std::vector<std::int32_t> steps_to_end(RiverCells const& rivers) {
    std::vector<std::int32_t> steps(rivers.cell.size());
    for (std::size_t n = 0; n < steps.size(); ++n) {
        std::int32_t const r = rivers.receiver[n];
        steps[n] = r < 0 ? 0 : steps[static_cast<std::size_t>(r)] + 1;
    }
    return steps;
}

} // namespace

RiverCells coarsened(RiverCells const& fine, std::int64_t fine_width, std::int64_t coarse_width,
                     std::int64_t coarse_height) {
    auto const above = [&](std::uint32_t cell) {
        std::int64_t const row = (cell / fine_width - 1) / 2 + 1;
        std::int64_t const col = (cell % fine_width - 1) / 2 + 1;
        return static_cast<std::size_t>(row * coarse_width + col);
    };
    std::vector<std::int32_t> const steps = steps_to_end(fine);
    std::vector<std::int32_t> chosen(static_cast<std::size_t>(coarse_width * coarse_height), -1);
    for (std::size_t n = 0; n < steps.size(); ++n) {
        std::int32_t& best = chosen[above(fine.cell[n])];
        if (best < 0 || steps[n] < steps[static_cast<std::size_t>(best)]) {
            best = static_cast<std::int32_t>(n);
        }
    }
    std::vector<std::int32_t> kept;
    std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(kept), [](std::int32_t n) { return n >= 0; });
    std::sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
        auto const rank = [&](std::int32_t n) { return std::pair{steps[static_cast<std::size_t>(n)], n}; };
        return rank(a) < rank(b);
    });
    for (std::size_t n = 0; n < kept.size(); ++n) {
        chosen[above(fine.cell[static_cast<std::size_t>(kept[n])])] = static_cast<std::int32_t>(n);
    }
    RiverCells coarse;
    for (std::int32_t const from : kept) {
        auto const n = static_cast<std::size_t>(from);
        std::size_t const here = above(fine.cell[n]);
        coarse.cell.push_back(static_cast<std::uint32_t>(here));
        coarse.level.push_back(fine.level[n]);
        coarse.number.push_back(fine.number[n]);
        if (!fine.asked.empty()) {
            coarse.asked.push_back(fine.asked[n]);
        }
        if (fine.receiver[n] < 0) {
            coarse.receiver.push_back(-1);
            coarse.way.push_back(-1);
            continue;
        }
        std::size_t const there = above(fine.cell[static_cast<std::size_t>(fine.receiver[n])]);
        coarse.receiver.push_back(chosen[there]);
        coarse.way.push_back(way_between(here, there, coarse_width));
    }
    return coarse;
}

} // namespace thalweg::surface
