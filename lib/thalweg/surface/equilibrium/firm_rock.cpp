// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/firm_rock.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/surface/equilibrium/internal/graded_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/perched_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/second_ring.hpp>

namespace thalweg::surface {

namespace {

constexpr float tolerated = 0.2F;     // [cells of the level] that the land beside a river may lack
constexpr float rate = 0.5F;          // most that one call adds
constexpr float firmest = 2.0F;       // [log]
constexpr float of_cap = 0.4F;        // as much firmer, slopes stand up: steeper than rock of the fields, but no walls
constexpr float reach_cells = 4.0F;   // [finest cells] beside a flow path
constexpr std::size_t longest = 4096; // [cells] of a flow path

/// The lowest cell of land in the second ring of a river cell, banks aside.
std::optional<std::size_t> lowest_beside(LandLevel const& level, std::uint32_t cell) {
    std::optional<std::size_t> lowest;
    each_of_second_ring(level, cell, [&](std::size_t n) {
        bool const dry = level.cover[n] == Cover::land || level.cover[n] == Cover::rim;
        if (dry && (!lowest || level.z[n] < level.z[*lowest])) {
            lowest = n;
        }
    });
    return lowest;
}

bool lies_on_way_down(RiverCells const& rivers, std::size_t n, std::size_t cell) {
    constexpr int steps = 12;
    for (int step = 0; step <= steps; ++step) {
        if (rivers.cell[n] == cell) {
            return true;
        }
        if (rivers.receiver[n] < 0) {
            return false;
        }
        n = static_cast<std::size_t>(rivers.receiver[n]);
    }
    return false;
}

/// The height that a river cell has by its grade or its file, whatever the land allows.
float wanted_height(LandLevel const& level, EquilibriumLaw const& law, std::size_t n) {
    RiverCells const& rivers = level.rivers;
    if (!rivers.asked.empty() && !std::isnan(rivers.asked[n])) {
        return rivers.asked[n];
    }
    float const below = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]];
    float const length = level.side * step_lengths[static_cast<std::size_t>(rivers.way[n])];
    return below + graded_tangent(level, law, rivers.cell[n]) * length;
}

/// Marks the flow path from beside a river cell by as much as the land there lacks.
void mark_lack(LandLevel const& level, EquilibriumLaw const& law, std::size_t n, Cells<float>& marks) {
    RiverCells const& rivers = level.rivers;
    auto const lowest = lowest_beside(level, rivers.cell[n]);
    float const wanted = lowest ? wanted_height(level, law, n) : 0.0F;
    if (!lowest || level.z[*lowest] + tolerated * level.side >= wanted) {
        return;
    }
    auto const offsets = level.offsets();
    std::vector<std::size_t> path;
    std::size_t at = *lowest;
    while (is_land(level.cover[at]) && level.way[at] >= 0 && path.size() < longest) {
        path.push_back(at);
        at = moved(at, offsets[static_cast<std::size_t>(level.way[at])]);
    }
    if (lies_on_way_down(rivers, n, at)) { // which falls as its own river does
        return;
    }
    constexpr float least = 1e-3F; // [cells of the level]
    float const base = std::isinf(level.z[at]) ? 0.0F : level.z[at];
    float const has = std::max(level.z[*lowest] - base, least * level.side);
    auto const lack = static_cast<float>(portable::log(static_cast<double>(std::max((wanted - base) / has, 1.0F))));
    for (std::size_t const i : path) {
        marks[i] = std::max(marks[i], rate * std::min(1.0F, lack));
    }
}

/// Sums over 2 reach + 1 neighbours along one axis.
Cells<float> sums_along(Cells<float> const& values, std::int64_t lines, std::int64_t line_step, std::int64_t length,
                        std::int64_t step, std::int64_t reach) {
    Cells<float> sums(values.size());
    for (std::int64_t line = 0; line < lines; ++line) {
        for (std::int64_t k = 0; k < length; ++k) {
            float sum = 0.0F;
            for (std::int64_t n = std::max<std::int64_t>(0, k - reach); n <= std::min(length - 1, k + reach); ++n) {
                sum += values[static_cast<std::size_t>(line * line_step + n * step)];
            }
            sums[static_cast<std::size_t>(line * line_step + k * step)] = sum;
        }
    }
    return sums;
}

/// By cell the mean of the marks in a square around it, 0 where there are none.
Cells<float> spread(Cells<float> const& marks, LandLevel const& level, std::int64_t reach) {
    Cells<float> counts(marks.size());
    std::transform(marks.begin(), marks.end(), counts.begin(), [](float mark) { return mark > 0.0F ? 1.0F : 0.0F; });
    auto const sums = [&](Cells<float> const& of) {
        return sums_along(sums_along(of, level.height, level.width, level.width, 1, reach), level.width, 1,
                          level.height, level.width, reach);
    };
    Cells<float> means = sums(marks);
    counts = sums(counts);
    for (std::size_t i = 0; i < means.size(); ++i) {
        means[i] = counts[i] > 0.0F ? means[i] / counts[i] : 0.0F;
    }
    return means;
}

void add_firmness(LandLevel& level, std::size_t i, float more) {
    if (!(more > 0.0F) || level.cover[i] == Cover::river) {
        return;
    }
    level.firmness[i] += more;
    level.erodibility[i] *= static_cast<float>(portable::exp(static_cast<double>(-more)));
    level.cap[i] *= static_cast<float>(portable::exp(static_cast<double>(of_cap * more)));
}

} // namespace

void firm_rock(LandLevel& level, EquilibriumLaw const& law) {
    RiverCells const& rivers = level.rivers;
    Cells<float> marks(static_cast<std::size_t>(level.cells()), 0.0F);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.number[n] >= 0 && !leaves_grid(rivers, n) && rivers.level[n] == 0) {
            mark_lack(level, law, n, marks);
        }
    }
    if (std::all_of(marks.begin(), marks.end(), [](float mark) { return mark == 0.0F; })) {
        return;
    }
    level.firmness.resize(marks.size(), 0.0F);
    marks = spread(marks, level, std::max<std::int64_t>(1, static_cast<std::int64_t>(reach_cells / level.side)));
    for (std::size_t i = 0; i < marks.size(); ++i) {
        add_firmness(level, i, std::min(marks[i], firmest - level.firmness[i]));
    }
}

void take_firmness(LandLevel& level, LandLevel const& coarser) {
    if (coarser.firmness.empty()) {
        return;
    }
    level.firmness.assign(static_cast<std::size_t>(level.cells()), 0.0F);
    each_inner(level, [&](std::size_t i) {
        Cell const c = level.at(i);
        add_firmness(level, i, value_at(coarser, coarser.firmness, place_in(coarser, level, c.col, c.row)));
    });
}

} // namespace thalweg::surface
