// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/region.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

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

/// The step by which a cell leaves a window's level.
Cell exit_step(LevelExtent const& window, Cell c) {
    return c.row == 0                   ? Cell{0, -1}
           : c.row == window.height - 1 ? Cell{0, 1}
           : c.col == 0                 ? Cell{-1, 0}
           : c.col == window.width - 1  ? Cell{1, 0}
                                        : Cell{0, 0};
}

/// Rivers of the region under extension.
class ExtendedRivers {
public:
    ExtendedRivers(LevelExtent const& region, std::uint64_t seed)
        : region_(region), width_(region.width + 2), seed_(seed) {}

    /// Extends a river from a cell inside the region.
    /// \return number of its next cell; -1: it ends there
    std::int32_t extend_river(Cell from, Cell step, std::uint64_t river) {
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
        out_.direction.push_back(receiver < 0 ? std::int8_t{-1} : direction_between(i, out_.cell[receiver], width_));
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

constexpr std::uint64_t frame_stage = 0x6672616d65; // "frame"

std::size_t cell_at(TerrainLevel const& level, LevelPlace p) {
    auto const col = static_cast<std::int64_t>(std::floor(p.col + 0.5));
    auto const row = static_cast<std::int64_t>(std::floor(p.row + 0.5));
    return static_cast<std::size_t>(row * level.width + col);
}

/// Whether a cell of the region lies within a window's level.
class Within {
public:
    Within(TerrainLevel const& level, TerrainLevel const& region)
        : region_(region), first_(cell_place(level, region, 1, 1)),
          last_(cell_place(level, region, level.width - 2, level.height - 2)) {}

    bool operator()(std::size_t cell) const {
        auto const col = static_cast<std::int64_t>(cell) % region_.width;
        auto const row = static_cast<std::int64_t>(cell) / region_.width;
        return col >= first_.col && col <= last_.col && row >= first_.row && row <= last_.row;
    }

private:
    static Cell cell_place(TerrainLevel const& level, TerrainLevel const& region, std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::int64_t>(cell_at(region, place_in(region, level, col, row)));
        return {i % region.width, i / region.width};
    }

    TerrainLevel const& region_;
    Cell first_;
    Cell last_;
};

/// Calls visit(column, row) for the cells of a level's frame, once round.
template <class Visit> void each_of_frame(TerrainLevel const& level, Visit visit) {
    for (std::int64_t col = 0; col < level.width; ++col) {
        visit(col, std::int64_t{0});
        visit(col, level.height - 1);
    }
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        visit(std::int64_t{0}, row);
        visit(level.width - 1, row);
    }
}

std::size_t beside_frame(TerrainLevel const& level, std::int64_t col, std::int64_t row) {
    return static_cast<std::size_t>(std::clamp<std::int64_t>(row, 1, level.height - 2) * level.width +
                                    std::clamp<std::int64_t>(col, 1, level.width - 2));
}

Vec2 middle_of(Cell c) {
    return {static_cast<double>(c.col), static_cast<double>(c.row)};
}

/// Computes the shares of the frame's cells from their distance to a valley that leaves the window.
void share_out(RegionFrame& frame, TerrainLevel const& level, TerrainLevel const& region, Within const& within,
               std::uint64_t seed) {
    auto const around = region.offsets();
    auto const outside = [&](Cell c) { return cell_at(region, place_in(region, level, c.col, c.row)); };
    auto const leaves = [&](std::size_t beyond) {
        return std::any_of(around.begin(), around.end(), [&](std::int64_t offset) {
            std::size_t const n = moved(beyond, offset);
            return within(n) && region.direction[n] >= 0 && moved(n, around[region.direction[n]]) == beyond;
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

Region region_around(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    bool const given = params.heights != RiverHeights::graded && !rivers.z.empty();
    if (params.region <= 1.0 || params.edge != Edge::open || fields.land.cells() > 0 || given || ends_inside(rivers)) {
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
    ExtendedRivers out(region, seed);
    std::vector<std::int32_t> next(rivers.cell.size(), -1);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        Cell const c = cell_of(n);
        Cell const step = exit_step(window, c);
        if (rivers.receiver[n] < 0 && !(step == Cell{0, 0})) {
            next[n] = out.extend_river({c.col + shift.col, c.row + shift.row}, step, n);
        }
    }
    std::vector<std::int32_t> place(rivers.cell.size());
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        Cell const c = cell_of(n);
        std::int32_t const r = rivers.receiver[n];
        place[n] = out.put({c.col + shift.col, c.row + shift.row}, r < 0 ? next[n] : place[r], rivers.number[n],
                           rivers.level[n]);
    }
    return out.taken();
}

RegionFrame frame_by_region(TerrainLevel& level, TerrainLevel const& region, std::uint64_t seed) {
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
        if (level.type[i] != CellType::boundary) {
            return;
        }
        LevelPlace const place = place_in(region, level, col, row);
        std::size_t const outside = cell_at(region, place);
        std::int8_t const way = region.direction[outside];
        if (way >= 0 && within(moved(outside, around[way]))) {
            level.type[i] = CellType::outside;
            level.z[i] = std::numeric_limits<float>::infinity();
            std::size_t const inner = beside_frame(level, col, row);
            Lowest& lowest = entries[outside];
            if (is_land(level.type[inner]) && level.z[inner] < lowest.z) {
                lowest = {inner, level.z[inner]};
            }
            return;
        }
        frame.cells.push_back({static_cast<std::uint32_t>(i), value_at(region, region.z, place), 0.0F});
    });
    share_out(frame, level, region, within, seed);
    each_inner(level, [&](std::size_t i) {
        if ((level.type[i] == CellType::land || level.type[i] == CellType::bank) &&
            std::any_of(offsets.begin(), offsets.end(),
                        [&](std::int64_t offset) { return level.type[moved(i, offset)] == CellType::outside; })) {
            level.type[i] = level.type[i] == CellType::bank ? CellType::rim_bank : CellType::rim;
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
            if (is_land(level.type[i])) {
                frame.land.push_back({i, value_at(region, region.z, place_in(region, level, col, row))});
            }
        }
    }
    lift_frame(level, frame);
    return frame;
}

void lift_frame(TerrainLevel& level, RegionFrame const& frame) {
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
        float const river = level.type[inner] == CellType::river
                                ? std::max(level.z[inner], highest_river(level, inner, offsets))
                                : highest_river(level, inner, offsets);
        level.z[c.cell] = std::max(c.z + c.share * lift, river + level.least * level.side);
    }
}

std::vector<float> end_heights(TerrainLevel const& level, TerrainLevel const& region) {
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

std::vector<RegionInflow> inflows_of(TerrainLevel const& level, Grid const& grid, std::int64_t margin) {
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
            bool const flows_in = level.direction[n] >= 0 && moved(n, offsets[level.direction[n]]) == at;
            area += !grid.contains(beyond) && flows_in ? level.area[n] : 0;
        }
        if (area >= much) {
            found.push_back({i, area});
        }
    }
    return found;
}

} // namespace thalweg::surface
