// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/give_up_tips.hpp>

#include <thalweg/surface/equilibrium/internal/beside_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/perched_rivers.hpp>

#include <algorithm>
#include <limits>

namespace thalweg::surface {

namespace {

constexpr std::int32_t longest_tip = 200; // [cells]: more is no tip

/// Marks river cells that are perched with little upstream of them, and all that lies upstream.
std::vector<std::uint8_t> perched_heads(LandLevel const& level, float tangent) {
    RiverCells const& rivers = level.rivers;
    std::vector<std::int32_t> upstream(rivers.cell.size(), 1);
    for (std::size_t n = upstream.size(); n-- > 0;) {
        if (rivers.receiver[n] >= 0) {
            upstream[static_cast<std::size_t>(rivers.receiver[n])] += upstream[n];
        }
    }
    std::vector<std::uint8_t> marked(upstream.size());
    for (std::size_t n = 0; n < marked.size(); ++n) {
        if (leaves_grid(rivers, n)) {
            continue;
        }
        bool const below = marked[static_cast<std::size_t>(rivers.receiver[n])] != 0;
        bool const tip = rivers.level[n] == 0 && upstream[n] <= longest_tip;
        marked[n] = below || (tip && is_perched(level, rivers.cell[n], tangent)) ? 1 : 0;
    }
    return marked;
}

bool is_rim(LandLevel const& level, std::size_t i) {
    auto const offsets = level.offsets();
    return std::any_of(offsets.begin(), offsets.end(),
                       [&](std::int64_t offset) { return level.cover[moved(i, offset)] == Cover::outside; });
}

void cover_again(LandLevel& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    bool const beside = highest_river(level, i, offsets) > -std::numeric_limits<float>::infinity();
    level.cover[i] = is_rim(level, i) ? (beside ? Cover::rim_bank : Cover::rim) : (beside ? Cover::bank : Cover::land);
}

/// Leaves out the marked ones; receivers of the others are never among them.
void compact(RiverCells& rivers, std::vector<std::uint8_t> const& gone) {
    std::vector<std::int32_t> place(gone.size(), -1);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < gone.size(); ++n) {
        if (gone[n] != 0) {
            continue;
        }
        rivers.cell[kept] = rivers.cell[n];
        rivers.receiver[kept] = rivers.receiver[n] < 0 ? -1 : place[static_cast<std::size_t>(rivers.receiver[n])];
        rivers.way[kept] = rivers.way[n];
        rivers.level[kept] = rivers.level[n];
        rivers.number[kept] = rivers.number[n];
        if (!rivers.asked.empty()) {
            rivers.asked[kept] = rivers.asked[n];
        }
        place[n] = static_cast<std::int32_t>(kept++);
    }
    rivers.cell.resize(kept);
    rivers.receiver.resize(kept);
    rivers.way.resize(kept);
    rivers.level.resize(kept);
    rivers.number.resize(kept);
    rivers.asked.resize(rivers.asked.empty() ? 0 : kept);
}

} // namespace

std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent, TipBanks banks) {
    RiverCells& rivers = level.rivers;
    std::vector<std::uint8_t> const marked = perched_heads(level, tangent);
    std::vector<std::uint8_t> gone(marked.size());
    std::vector<std::uint8_t> holds(marked.size()); // something that stays lies upstream
    std::vector<std::int64_t> numbers;
    auto const offsets = level.offsets();
    for (std::size_t n = marked.size(); n-- > 0;) {
        std::size_t const i = rivers.cell[n];
        if (marked[n] != 0 && holds[n] == 0) {
            gone[n] = banks == TipBanks::rise || highest_river(level, i, offsets) < level.z[i]
                          ? 1
                          : 0; // what it drained is gone already
        }
        if (gone[n] == 0) {
            if (rivers.receiver[n] >= 0) {
                holds[static_cast<std::size_t>(rivers.receiver[n])] = 1;
            }
            continue;
        }
        numbers.push_back(rivers.number[n]);
        cover_again(level, i, offsets);
        for (std::int64_t const offset : offsets) {
            if (std::size_t const near = moved(i, offset); is_land(level.cover[near])) {
                cover_again(level, near, offsets);
            }
        }
    }
    compact(rivers, gone);
    return numbers;
}

} // namespace thalweg::surface
