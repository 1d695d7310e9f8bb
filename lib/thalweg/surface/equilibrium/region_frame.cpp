// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/region_frame.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/beside_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace thalweg::surface {

namespace {

constexpr std::uint64_t frame_stage = 0x6672616d65; // "frame"

std::size_t cell_at(LandLevel const& level, LevelPlace p) {
    auto const col = static_cast<std::int64_t>(std::floor(p.col + 0.5));
    auto const row = static_cast<std::int64_t>(std::floor(p.row + 0.5));
    return static_cast<std::size_t>(row * level.width + col);
}

/// Whether a cell of the region lies within a window's level.
class Within {
public:
    Within(LandLevel const& level, LandLevel const& region)
        : region_(region), first_(cell_place(level, region, 1, 1)),
          last_(cell_place(level, region, level.width - 2, level.height - 2)) {}

    bool operator()(std::size_t cell) const {
        auto const col = static_cast<std::int64_t>(cell) % region_.width;
        auto const row = static_cast<std::int64_t>(cell) / region_.width;
        return col >= first_.col && col <= last_.col && row >= first_.row && row <= last_.row;
    }

private:
    static Cell cell_place(LandLevel const& level, LandLevel const& region, std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::int64_t>(cell_at(region, place_in(region, level, col, row)));
        return {i % region.width, i / region.width};
    }

    LandLevel const& region_;
    Cell first_;
    Cell last_;
};

/// Calls visit(column, row) for the cells of a level's frame, once round.
template <class Visit> void each_of_frame(LandLevel const& level, Visit visit) {
    for (std::int64_t col = 0; col < level.width; ++col) {
        visit(col, std::int64_t{0});
        visit(col, level.height - 1);
    }
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        visit(std::int64_t{0}, row);
        visit(level.width - 1, row);
    }
}

std::size_t beside_frame(LandLevel const& level, std::int64_t col, std::int64_t row) {
    return static_cast<std::size_t>(std::clamp<std::int64_t>(row, 1, level.height - 2) * level.width +
                                    std::clamp<std::int64_t>(col, 1, level.width - 2));
}

Vec2 middle_of(Cell c) {
    return {static_cast<double>(c.col), static_cast<double>(c.row)};
}

/// Shares of the frame's cells by how far they are from a valley that leaves the window.
void share_out(RegionFrame& frame, LandLevel const& level, LandLevel const& region, Within const& within,
               std::uint64_t seed) {
    auto const around = region.offsets();
    auto const outside = [&](Cell c) { return cell_at(region, place_in(region, level, c.col, c.row)); };
    auto const leaves = [&](std::size_t beyond) {
        return std::any_of(around.begin(), around.end(), [&](std::int64_t offset) {
            std::size_t const n = moved(beyond, offset);
            return within(n) && region.way[n] >= 0 &&
                   moved(n, around[static_cast<std::size_t>(region.way[n])]) == beyond;
        });
    };
    std::map<std::size_t, std::vector<Cell>> beside; // cells of the frame by that of the region
    for (RegionFrame::Cell const& c : frame.cells) {
        Cell const at = level.at(c.cell);
        beside[outside(at)].push_back(at);
    }
    std::vector<Cell> valleys;
    for (auto const& [beyond, cells] : beside) {
        if (leaves(beyond)) {
            valleys.push_back(cells[random_word(seed, frame_stage, beyond) % cells.size()]);
        }
    }
    std::vector<double> far;
    double sum = 0.0;
    for (RegionFrame::Cell const& c : frame.cells) {
        Cell const at = level.at(c.cell);
        double nearest = static_cast<double>(level.width + level.height);
        for (Cell const v : valleys) {
            nearest = std::min(nearest, distance(middle_of(v), middle_of(at)));
        }
        far.push_back(nearest);
        sum += nearest;
    }
    double const mean = std::max(sum / static_cast<double>(std::max<std::size_t>(far.size(), 1)), 1e-6);
    for (std::size_t k = 0; k < far.size(); ++k) {
        frame.cells[k].share = static_cast<float>(std::min(far[k] / mean, 2.0));
    }
}

} // namespace

RegionFrame frame_by_region(LandLevel& level, LandLevel const& region, std::uint64_t seed) {
    Within const within(level, region);
    auto const offsets = level.offsets();
    auto const around = region.offsets();
    struct Lowest {
        std::size_t cell = 0;
        float z = std::numeric_limits<float>::infinity();
    };
    std::map<std::size_t, Lowest> entries; // by cell of the region from which water flows in
    RegionFrame frame;
    each_of_frame(level, [&](std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::size_t>(row * level.width + col);
        if (level.cover[i] != Cover::edge) {
            return;
        }
        LevelPlace const place = place_in(region, level, col, row);
        std::size_t const outside = cell_at(region, place);
        std::int8_t const way = region.way[outside];
        if (way >= 0 && within(moved(outside, around[static_cast<std::size_t>(way)]))) {
            level.cover[i] = Cover::outside;
            level.z[i] = std::numeric_limits<float>::infinity();
            std::size_t const inner = beside_frame(level, col, row);
            Lowest& lowest = entries[outside];
            if (is_land(level.cover[inner]) && level.z[inner] < lowest.z) {
                lowest = {inner, level.z[inner]};
            }
            return;
        }
        frame.cells.push_back({static_cast<std::uint32_t>(i), value_at(region, region.z, place), 0.0F});
    });
    share_out(frame, level, region, within, seed);
    each_inner(level, [&](std::size_t i) {
        if ((level.cover[i] == Cover::land || level.cover[i] == Cover::bank) &&
            std::any_of(offsets.begin(), offsets.end(),
                        [&](std::int64_t offset) { return level.cover[moved(i, offset)] == Cover::outside; })) {
            level.cover[i] = level.cover[i] == Cover::bank ? Cover::rim_bank : Cover::rim;
        }
    });
    float const each = region.side * region.side / (level.side * level.side);
    level.inflow.clear();
    for (auto const& [outside, lowest] : entries) {
        if (!std::isinf(lowest.z)) {
            level.inflow.push_back({static_cast<std::uint32_t>(lowest.cell),
                                    static_cast<std::uint32_t>(static_cast<float>(region.area[outside]) * each)});
        }
    }
    auto const inset = static_cast<std::int64_t>(0.2 * static_cast<double>(std::min(level.width, level.height)));
    auto const stride = std::max<std::int64_t>(1, static_cast<std::int64_t>(region.side / level.side) / 2);
    for (std::int64_t row = inset; row < level.height - inset; row += stride) {
        for (std::int64_t col = inset; col < level.width - inset; col += stride) {
            auto const i = static_cast<std::uint32_t>(row * level.width + col);
            if (is_land(level.cover[i])) {
                frame.land.push_back({i, value_at(region, region.z, place_in(region, level, col, row))});
            }
        }
    }
    lift_frame(level, frame);
    return frame;
}

void lift_frame(LandLevel& level, RegionFrame const& frame) {
    double sum = 0.0;
    for (RegionFrame::Sample const& s : frame.land) {
        sum += static_cast<double>(level.z[s.cell]) - static_cast<double>(s.z);
    }
    auto const lift =
        frame.land.empty() ? 0.0F : static_cast<float>(std::max(0.0, sum / static_cast<double>(frame.land.size())));
    auto const offsets = level.offsets();
    for (RegionFrame::Cell const& c : frame.cells) {
        Cell const at = level.at(c.cell);
        std::size_t const inner = beside_frame(level, at.col, at.row);
        float const river = level.cover[inner] == Cover::river
                                ? std::max(level.z[inner], highest_river(level, inner, offsets))
                                : highest_river(level, inner, offsets);
        level.z[c.cell] = std::max(c.z + c.share * lift, river + bank_step * level.side);
    }
}

std::vector<float> end_heights(LandLevel const& level, LandLevel const& region) {
    RiverCells const& rivers = level.rivers;
    std::vector<float> heights(rivers.cell.size(), 0.0F);
    for (std::size_t n = 0; n < heights.size(); ++n) {
        if (rivers.receiver[n] < 0) {
            auto const cell = static_cast<std::int64_t>(rivers.cell[n]);
            LevelPlace const place = place_in(region, level, cell % level.width, cell / level.width);
            heights[n] = region.z[cell_at(region, place)];
        }
    }
    return heights;
}

std::vector<RegionInflow> inflows_of(LandLevel const& level, Grid const& grid, std::int64_t margin) {
    constexpr std::uint32_t much = 1000; // [cells]
    auto const offsets = level.offsets();
    std::vector<RegionInflow> found;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        if (!grid.on_border(c)) {
            continue;
        }
        auto const at = static_cast<std::size_t>((c.row + margin + 1) * level.width + c.col + margin + 1);
        std::uint32_t area = 0;
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            Cell const beyond{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
            std::size_t const n = moved(at, offsets[k]);
            bool const flows_in = level.way[n] >= 0 && moved(n, offsets[static_cast<std::size_t>(level.way[n])]) == at;
            area += !grid.contains(beyond) && flows_in ? level.area[n] : 0;
        }
        if (area >= much) {
            found.push_back({i, area});
        }
    }
    return found;
}

} // namespace thalweg::surface
