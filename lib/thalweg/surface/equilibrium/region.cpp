// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/region.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/way_between.hpp>

#include <algorithm>
#include <map>

namespace thalweg::surface {

namespace {

constexpr std::uint64_t region_stage = 0x726567696f6e; // "region"
constexpr std::int64_t least_side = 16;                // [cells of the level] of a window in the region
constexpr std::size_t finest_level = 4;                // cells of sixteen finest ones: a thirtieth of the work

bool ends_inside(Channels const& rivers) {
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] < 0 && !rivers.grid.on_border(rivers.grid.at(rivers.cell[n]))) {
            return true;
        }
    }
    return false;
}

/// The step by which a cell of a window's level leaves it.
Cell way_out(LevelExtent const& window, Cell c) {
    return c.row == 0                   ? Cell{0, -1}
           : c.row == window.height - 1 ? Cell{0, 1}
           : c.col == 0                 ? Cell{-1, 0}
           : c.col == window.width - 1  ? Cell{1, 0}
                                        : Cell{0, 0};
}

/// Rivers of the region while they are led on.
class LedOn {
public:
    LedOn(LevelExtent const& region, std::uint64_t seed) : region_(region), width_(region.width + 2), seed_(seed) {}

    /// Leads a river on from a cell inside the region. Gives: the number of its next cell, -1 where it ends there.
    std::int32_t lead_on(Cell from, Cell step, std::uint64_t river) {
        std::vector<Cell> path;
        std::int32_t joined = -1;
        std::int64_t drift = 0;
        Cell at = from;
        for (std::uint64_t k = 0;; ++k) {
            auto const words = random_block(seed_, region_stage, river, k);
            if (unit(words[0]) < 0.35) {
                drift = static_cast<std::int64_t>(words[1] % 3) - 1;
            }
            at = {at.col + step.col + drift * step.row, at.row + step.row + drift * step.col};
            if (!inside(at)) {
                break;
            }
            if (auto const there = number_.find(index(at)); there != number_.end()) {
                joined = there->second;
                break;
            }
            path.push_back(at);
        }
        for (auto c = path.rbegin(); c != path.rend(); ++c) {
            joined = put(*c, joined, -1, 0);
        }
        return joined;
    }

    std::int32_t put(Cell c, std::int32_t receiver, std::int64_t number, std::uint8_t is_level) {
        auto const i = index(c);
        out_.cell.push_back(static_cast<std::uint32_t>(i));
        out_.receiver.push_back(receiver);
        out_.way.push_back(receiver < 0 ? std::int8_t{-1}
                                        : way_between(i, out_.cell[static_cast<std::size_t>(receiver)], width_));
        out_.level.push_back(is_level);
        out_.number.push_back(number);
        auto const n = static_cast<std::int32_t>(out_.cell.size()) - 1;
        number_[i] = n;
        return n;
    }

    RiverCells taken() { return std::move(out_); }

private:
    bool inside(Cell c) const { return c.col >= 0 && c.row >= 0 && c.col < region_.width && c.row < region_.height; }
    std::size_t index(Cell c) const { return static_cast<std::size_t>((c.row + 1) * width_ + c.col + 1); }

    LevelExtent region_;
    std::int64_t width_;
    std::uint64_t seed_;
    RiverCells out_;
    std::map<std::size_t, std::int32_t> number_;
};

} // namespace

Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    if (params.region <= 1.0 || params.edge != Edge::open || fields.land.cells() > 0 || !rivers.z.empty() ||
        ends_inside(rivers)) {
        return {};
    }
    std::int64_t const least = std::min(rivers.grid.width, rivers.grid.height);
    Region region;
    while (region.level < finest_level && (least >> (region.level + 1)) >= least_side) {
        ++region.level;
    }
    if (region.level < 2) {
        return {};
    }
    std::int64_t const side = std::int64_t{1} << region.level;
    auto const wanted =
        static_cast<double>(std::max(rivers.grid.width, rivers.grid.height)) * 0.5 * (params.region - 1.0);
    region.margin = std::max<std::int64_t>(4, static_cast<std::int64_t>(wanted / static_cast<double>(side))) * side;
    return region;
}

LevelExtent extent_of(Region const& region, Grid const& grid) {
    std::int64_t const side = std::int64_t{1} << region.level;
    auto const cells = [&](std::int64_t size) { return (size + 2 * region.margin + side - 1) / side; };
    return {cells(grid.width), cells(grid.height), {-region.margin, -region.margin}};
}

RiverCells rivers_of_region(RiverCells const& rivers, LevelExtent const& window, LevelExtent const& region,
                            std::int64_t side, std::uint64_t seed) {
    Cell const shift{(window.corner.col - region.corner.col) / side, (window.corner.row - region.corner.row) / side};
    auto const cell_of = [&](std::size_t n) {
        auto const i = static_cast<std::int64_t>(rivers.cell[n]);
        return Cell{i % (window.width + 2) - 1, i / (window.width + 2) - 1};
    };
    LedOn out(region, seed);
    std::vector<std::int32_t> next(rivers.cell.size(), -1);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        Cell const c = cell_of(n);
        Cell const step = way_out(window, c);
        if (rivers.receiver[n] < 0 && !(step == Cell{0, 0})) {
            next[n] = out.lead_on({c.col + shift.col, c.row + shift.row}, step, n);
        }
    }
    std::vector<std::int32_t> place(rivers.cell.size());
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        Cell const c = cell_of(n);
        std::int32_t const r = rivers.receiver[n];
        place[n] = out.put({c.col + shift.col, c.row + shift.row}, r < 0 ? next[n] : place[static_cast<std::size_t>(r)],
                           rivers.number[n], rivers.level[n]);
    }
    return out.taken();
}

} // namespace thalweg::surface
