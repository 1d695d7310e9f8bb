// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/give_up_tips.hpp>

#include <thalweg/surface/beside_rivers.hpp>
#include <thalweg/surface/second_ring.hpp>

#include <algorithm>
#include <limits>

namespace thalweg::surface {

namespace {

constexpr std::size_t longest_tip = 50; // [cells]: more is no tip

bool is_perched(LandLevel const& level, std::uint32_t cell, float tangent) {
    float low = std::numeric_limits<float>::infinity();
    each_of_second_ring(level, cell, [&](std::size_t n) { low = std::min(low, level.z[n]); });
    return level.z[cell] > low + tangent * level.side;
}

std::vector<std::int32_t> donors_of(RiverCells const& rivers) {
    std::vector<std::int32_t> donors(rivers.cell.size());
    for (std::int32_t const r : rivers.receiver) {
        if (r >= 0) {
            ++donors[static_cast<std::size_t>(r)];
        }
    }
    return donors;
}

/// Cells from a river's head to its last perched one.
std::vector<std::size_t> perched_tip(LandLevel const& level, std::vector<std::int32_t> const& donors, std::size_t head,
                                     float tangent) {
    RiverCells const& rivers = level.rivers;
    std::vector<std::size_t> tip;
    std::size_t last = 0;
    for (std::size_t n = head; tip.size() < longest_tip; n = static_cast<std::size_t>(rivers.receiver[n])) {
        std::int32_t const r = rivers.receiver[n];
        bool const ends = r < 0 || rivers.number[static_cast<std::size_t>(r)] < 0;
        if (ends || donors[n] > 1 || rivers.level[n] != 0) {
            break;
        }
        tip.push_back(n);
        last = is_perched(level, rivers.cell[n], tangent) ? tip.size() : last;
    }
    tip.resize(last);
    return tip;
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

std::vector<std::int64_t> perched_cells(LandLevel const& level, float tangent) {
    std::vector<std::int64_t> numbers;
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        if (level.rivers.number[n] >= 0 && is_perched(level, level.rivers.cell[n], tangent)) {
            numbers.push_back(level.rivers.number[n]);
        }
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent) {
    RiverCells& rivers = level.rivers;
    std::vector<std::int32_t> const donors = donors_of(rivers);
    std::vector<std::uint8_t> gone(rivers.cell.size());
    std::vector<std::int64_t> numbers;
    auto const offsets = level.offsets();
    for (std::size_t head = 0; head < donors.size(); ++head) {
        if (donors[head] != 0) {
            continue;
        }
        for (std::size_t const n : perched_tip(level, donors, head, tangent)) {
            std::size_t const i = rivers.cell[n];
            level.cover[i] = Cover::land; // so that what comes next is not seen beside it
            if (highest_river(level, i, offsets) >= level.z[i]) {
                level.cover[i] = Cover::river;
                break;
            }
            gone[n] = 1;
            numbers.push_back(rivers.number[n]);
            cover_again(level, i, offsets);
            for (std::int64_t const offset : offsets) {
                if (std::size_t const near = moved(i, offset); is_land(level.cover[near])) {
                    cover_again(level, near, offsets);
                }
            }
        }
    }
    compact(rivers, gone);
    return numbers;
}

} // namespace thalweg::surface
