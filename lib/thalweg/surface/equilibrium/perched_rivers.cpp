// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/perched_rivers.hpp>

#include <thalweg/core/cells/cells_around.hpp>
#include <thalweg/surface/equilibrium/internal/second_ring.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace thalweg::surface {

namespace {

/// Above it a river cell stands perched.
float highest_lawful(LandLevel const& level, std::uint32_t cell, float tangent) {
    float low = std::numeric_limits<float>::infinity();
    each_of_second_ring(level, cell, [&](std::size_t n) { low = std::min(low, level.z[n]); });
    return low + tangent * level.side;
}

/// Lowers a river cell to a height, and what lies downstream of it as far as needed; not at all where that would go on
/// for long, or into a lake or an end.
void dig(LandLevel& level, std::size_t from, float z, float step) {
    constexpr int longest = 256; // [cells] on a floor that hardly falls
    RiverCells const& rivers = level.rivers;
    std::size_t n = from;
    float wanted = z;
    for (int k = 0; level.z[rivers.cell[n]] > wanted; ++k, wanted -= step) {
        if (k == longest || leaves_grid(rivers, n) || rivers.level[n] != 0) {
            return;
        }
        n = static_cast<std::size_t>(rivers.receiver[n]);
    }
    for (std::size_t dug = from; dug != n; dug = static_cast<std::size_t>(rivers.receiver[dug]), z -= step) {
        level.z[rivers.cell[dug]] = z;
    }
}

/// Whether a river runs through a cell within a few steps.
bool runs_soon(RiverCells const& rivers, std::size_t n, std::size_t cell) {
    constexpr int steps = 4; // as far as the second ring, with a bend
    for (int step = 0; step < steps && rivers.receiver[n] >= 0; ++step) {
        n = static_cast<std::size_t>(rivers.receiver[n]);
        if (rivers.cell[n] == cell) {
            return true;
        }
    }
    return false;
}

} // namespace

bool leaves_grid(RiverCells const& rivers, std::size_t n) {
    std::int32_t const r = rivers.receiver[n];
    return r < 0 || rivers.number[static_cast<std::size_t>(r)] < 0;
}

bool is_perched(LandLevel const& level, std::uint32_t cell, float tangent) {
    return level.z[cell] > highest_lawful(level, cell, tangent);
}

std::vector<std::int64_t> walled_cells(LandLevel const& level, float tangent) {
    RiverCells const& rivers = level.rivers;
    std::vector<std::int64_t> numbers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.number[n] < 0 || !is_perched(level, rivers.cell[n], tangent)) {
            continue;
        }
        bool walled = false;
        each_of_second_ring(level, rivers.cell[n], [&](std::size_t i) {
            bool const lower = level.z[rivers.cell[n]] > level.z[i] + tangent * level.side;
            walled = walled || (lower && !runs_soon(rivers, n, i));
        });
        if (walled) {
            numbers.push_back(rivers.number[n]);
        }
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

void lower_perched(LandLevel& level, float tangent, float step) {
    constexpr std::size_t passes = 2; // what is dug lowers the surroundings of others
    RiverCells const& rivers = level.rivers;
    std::size_t const count = rivers.cell.size();
    for (std::size_t k = 0; k < passes * count; ++k) {
        std::size_t const n = k % count;
        if (!leaves_grid(rivers, n) && rivers.level[n] == 0) {
            float& z = level.z[rivers.cell[n]];
            float const least = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]] + step;
            float const lawful = highest_lawful(level, rivers.cell[n], tangent);
            z = std::max(std::min(z, lawful), std::min(z, least));
            if (z > lawful) {
                dig(level, n, lawful, step);
            }
        }
    }
}

void raise_below_perched(LandLevel& level, float tangent) {
    constexpr std::int64_t reach = 4; // [cells]
    Grid frame;
    frame.width = level.width;
    frame.height = level.height;
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.number[n] < 0 || !is_perched(level, rivers.cell[n], tangent)) {
            continue;
        }
        Cell const at{rivers.cell[n] % level.width, rivers.cell[n] / level.width};
        float const z = level.z[rivers.cell[n]];
        cells_around(frame, at, reach, [&](Cell c) {
            std::int64_t const far = std::max(std::abs(c.col - at.col), std::abs(c.row - at.row));
            auto const i = static_cast<std::size_t>(c.row * level.width + c.col);
            if (far > 1 && is_land(level.cover[i])) {
                level.z[i] = std::max(level.z[i], z - tangent * level.side * static_cast<float>(far - 1));
            }
        });
    }
}

} // namespace thalweg::surface
