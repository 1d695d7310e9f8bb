// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/give_up_tips.hpp>

#include <thalweg/surface/equilibrium/internal/beside_rivers.hpp>
#include <thalweg/surface/equilibrium/internal/perched_rivers.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::surface {

namespace {

constexpr std::int32_t longest_tip = 200;     // [cells]: more is no tip
constexpr std::int32_t longest_touching = 32; // likewise, for what lies beside another river

/// By river cell how many drain through it, itself included.
std::vector<std::int32_t> upstream_of(RiverCells const& rivers) {
    std::vector<std::int32_t> upstream(rivers.cell.size(), 1);
    for (std::size_t n = upstream.size(); n-- > 0;) {
        if (rivers.receiver[n] >= 0) {
            upstream[static_cast<std::size_t>(rivers.receiver[n])] += upstream[n];
        }
    }
    return upstream;
}

/// Marks river cells of which something is true, with little upstream of them, and all that lies upstream.
template <class Is>
std::vector<std::uint8_t> marked_tips(RiverCells const& rivers, std::vector<std::int32_t> const& upstream,
                                      std::int32_t longest, Is is) {
    std::vector<std::uint8_t> marked(upstream.size());
    for (std::size_t n = 0; n < marked.size(); ++n) {
        if (leaves_grid(rivers, n)) {
            continue;
        }
        bool const below = marked[static_cast<std::size_t>(rivers.receiver[n])] != 0;
        bool const tip = rivers.level[n] == 0 && upstream[n] <= longest;
        marked[n] = below || (tip && is(n)) ? 1 : 0;
    }
    return marked;
}

/// Whether two river cells come to one place within so many steps that their heights are alike.
bool meet_soon(RiverCells const& rivers, std::int32_t a, std::int32_t b) {
    constexpr int most = 400;
    for (int step = 0; a != b; ++step) { // receivers have lower numbers
        std::int32_t& upper = a > b ? a : b;
        upper = rivers.receiver[static_cast<std::size_t>(upper)];
        if (upper < 0 || step == most) {
            return false;
        }
    }
    return true;
}

/// Marks the cells near heads that lie beside another river, which has more upstream, and all that lies upstream.
std::vector<std::uint8_t> touching_heads(LandLevel const& level) {
    RiverCells const& rivers = level.rivers;
    constexpr std::int32_t nothing = -1;
    std::vector<std::int32_t> number_at(static_cast<std::size_t>(level.cells()), nothing);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        number_at[rivers.cell[n]] = static_cast<std::int32_t>(n);
    }
    auto const offsets = level.offsets();
    std::vector<std::int32_t> const upstream = upstream_of(rivers);
    return marked_tips(rivers, upstream, longest_touching, [&](std::size_t n) {
        return std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
            std::int32_t const other = number_at[moved(rivers.cell[n], offset)];
            auto const i = static_cast<std::int32_t>(n);
            return other != nothing &&
                   std::pair(upstream[n], -i) < std::pair(upstream[static_cast<std::size_t>(other)], -other) &&
                   !meet_soon(rivers, i, other);
        });
    });
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

std::vector<std::int64_t> give_up(LandLevel& level, std::vector<std::uint8_t> const& marked, TipBanks banks) {
    RiverCells& rivers = level.rivers;
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

} // namespace

std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent, TipBanks banks) {
    auto const perched = [&](std::size_t n) { return is_perched(level, level.rivers.cell[n], tangent); };
    return give_up(level, marked_tips(level.rivers, upstream_of(level.rivers), longest_tip, perched), banks);
}

std::vector<std::int64_t> give_up_touching_tips(LandLevel& level) {
    return give_up(level, touching_heads(level), TipBanks::rise);
}

} // namespace thalweg::surface
