// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/flow/internal/condition.hpp>
#include <thalweg/flow/internal/priority_flood.hpp>

namespace thalweg::flow {
namespace {

constexpr float no_limit = std::numeric_limits<float>::infinity();

/// Finds the undrained cells of the rows [begin, end), none of them at the grid's border.
void search_rows(Raster<float> const& dem, Raster<float> const& rivers, std::int64_t begin, std::int64_t end,
                 std::vector<CellIndex>& found) {
    constexpr float safe_fall = 1.5F * small_step; // more than from just_above(z) to z, or less than an ulp of z
    constexpr std::size_t together = 64;
    auto const width = static_cast<std::size_t>(dem.width());
    std::array<std::vector<float>, 3> heights; // by row modulo 3
    heights.fill(std::vector<float>(width));
    std::vector<float> lows(width); // of three cells in a column
    float* const low = lows.data();
    for (std::int64_t r = begin - 1; r <= end; ++r) {
        float const* const row = dem.row(r).data();
        float* const height = heights[static_cast<std::size_t>(r % 3)].data();
        for (std::size_t c = 0; c < width; ++c) {
            height[c] = std::isnan(row[c]) ? -no_limit : row[c]; // water leaves there
        }
        if (r <= begin) {
            continue;
        }
        float const* const a = heights[0].data();
        float const* const b = heights[1].data();
        float const* const d = heights[2].data();
        for (std::size_t c = 0; c < width; ++c) {
            low[c] = std::min(std::min(a[c], b[c]), d[c]);
        }
        float const* const here = dem.row(r - 1).data();
        for (std::size_t from = 1; from + 1 < width; from += together) {
            std::size_t const to = std::min(from + together, width - 1);
            int any = 0;
            for (std::size_t c = from; c < to; ++c) {
                any |= static_cast<int>(here[c] - std::min(std::min(low[c - 1], low[c + 1]), low[c]) < safe_fall);
            }
            for (std::size_t c = from; any != 0 && c < to; ++c) {
                CellIndex const i = (r - 1) * dem.width() + static_cast<CellIndex>(c);
                float const lowest = std::min(std::min(low[c - 1], low[c + 1]), low[c]);
                if (here[c] < just_above(lowest) && std::isnan(rivers[i])) {
                    found.push_back(i);
                }
            }
        }
    }
}

/// Fills a DEM cell by cell from where water leaves, but only where a flood may raise it: in lakes grown from undrained
/// cells.
class Flood {
public:
    Flood(Raster<float> dem, Raster<float> const& rivers, Lakes lakes, Run const& run)
        : rivers_(rivers), lakes_(lakes), run_(run), offsets_(d8_offsets(dem.grid())), level_(std::move(dem)),
          state_(level_.grid()) {}

    Raster<float> fill(std::vector<CellIndex> undrained, std::int64_t cells_per_lake) {
        mark_outlets();
        if (level_.cells() < cells_per_lake * std::ssize(undrained)) {
            undrained = {};
            take_all();
        } else {
            bound(undrained);
            for (std::size_t k = 0; k < wet_.size(); ++k) {
                level_[wet_[k]] = land_[k];
            }
        }
        with_queue(level_.grid(), [this](auto queue) { settle(std::move(queue)); });
        return std::move(level_);
    }

private:
    enum State : std::uint8_t {
        unknown,  ///< not raised, once all lakes are bounded; no data
        dry,      ///< not raised: water leaves there, or flows off
        wet,      ///< raised at most to level_
        on_shore, ///< beside the lake that grows
        in_lake,  ///< of the lake that grows
        at_rim,   ///< wet beside others, in the queue, at its own height so far
        settled   ///< wet, at its level
    };

    /// On the shore of the lake that grows.
    struct ShoreCell {
        float z = 0.0F;
        std::uint32_t number = 0; ///< in around_

        auto operator<=>(ShoreCell const&) const = default;
    };

    float rise(float z) const { return lakes_ == Lakes::level ? z : just_above(z); }

    /// Cells where water leaves are dry: at the grid's border, beside no data, and rivers. Any other has eight
    /// neighbours with data.
    void mark_outlets() {
        Grid const& grid = level_.grid();
        for (CellIndex r = 0; r < grid.height; ++r) {
            auto const land = level_.row(r);
            auto const river = rivers_.row(r);
            auto const state = state_.row(r);
            bool const at_border = r == 0 || r + 1 == grid.height;
            int holes = 0;
            for (std::size_t c = 0; c < land.size(); ++c) {
                holes |= static_cast<int>(std::isnan(land[c]));
                state[c] |=
                    static_cast<std::uint8_t>(static_cast<int>(at_border) | static_cast<int>(!std::isnan(river[c])));
            }
            state.front() = state.back() = dry;
            for (std::size_t c = 0; holes != 0 && c < land.size(); ++c) {
                if (std::isnan(land[c])) {
                    cells_around(grid, {static_cast<CellIndex>(c), r}, 1, [&](Cell at) { state_[at] = dry; });
                }
            }
        }
    }

    void take_all() {
        all_ = true;
        for (std::uint8_t& state : state_.values()) {
            if (state == unknown) {
                state = wet;
            }
        }
    }

    template <class Visit> void each_wet(Visit visit) const {
        if (!all_) {
            std::ranges::for_each(wet_, visit);
            return;
        }
        for (CellIndex i = 0; i < level_.cells(); ++i) {
            if (state_[i] == wet) {
                visit(i);
            }
        }
    }

    /// Finds cells that include all that a flood raises.
    void bound(std::vector<CellIndex> const& undrained) {
        std::size_t done = 0;
        for (CellIndex const i : undrained) {
            if (++done % 1024 == 0) {
                run_.check();
            }
            if (state_[i] == unknown) {
                grow_lake(i);
            }
        }
        // A lake's slope may be higher than cells beside it.
        for (std::size_t k = 0; k < wet_.size(); ++k) {
            float const least = just_above(level_[wet_[k]]);
            for (std::int64_t const step : offsets_) {
                if (CellIndex const n = wet_[k] + step; state_[n] == unknown && level_[n] < least) {
                    descend(n);
                }
            }
        }
    }

    void know(CellIndex i, float least) {
        state_[i] = least > level_[i] ? wet : dry;
        if (state_[i] == wet) {
            wet_.push_back(i);
            land_.push_back(level_[i]);
            level_[i] = least;
        }
    }

    void add_to_shore(CellIndex i) {
        state_[i] = on_shore;
        shore_.push_back({level_[i], static_cast<std::uint32_t>(around_.size())});
        std::push_heap(shore_.begin(), shore_.end(), std::greater<>());
        around_.push_back(i);
    }

    CellIndex lowest_of_shore() {
        std::pop_heap(shore_.begin(), shore_.end(), std::greater<>());
        CellIndex const i = around_[shore_.back().number];
        shore_.pop_back();
        return i;
    }

    /// The lowest level of the known cells around a cell.
    float lowest_known(CellIndex i) const {
        float lowest = no_limit;
        for (std::int64_t const step : offsets_) {
            CellIndex const n = i + step;
            lowest = state_[n] == dry || state_[n] == wet ? std::min(lowest, level_[n]) : lowest;
        }
        return lowest;
    }

    /// Adds the lowest cell around a lake to it until one lies beside a cell that is known. From there the levels of
    /// the others follow: at most, as ways up from cell to cell have them.
    void grow_lake(CellIndex first) {
        shore_.clear();
        around_.clear();
        lake_.clear();
        add_to_shore(first);
        for (float lowest = no_limit; lowest == no_limit;) {
            CellIndex const i = lowest_of_shore();
            state_[i] = in_lake;
            lake_.push_back(i);
            for (std::int64_t const step : offsets_) {
                if (CellIndex const n = i + step; state_[n] == unknown) {
                    add_to_shore(n);
                } else if (state_[n] == dry || state_[n] == wet) {
                    lowest = std::min(lowest, level_[n]);
                }
            }
        }
        // Each cell but the last was reached before another from which it is known; if not, then from one before it.
        for (auto i = lake_.rbegin(); i != lake_.rend(); ++i) {
            if (float const lowest = lowest_known(*i); lowest < no_limit) {
                know(*i, just_above(lowest));
            }
        }
        for (CellIndex const i : lake_) {
            if (state_[i] == in_lake) {
                know(i, just_above(lowest_known(i)));
            }
        }
        for (CellIndex const i : around_) {
            if (state_[i] == on_shore) {
                state_[i] = unknown;
            }
        }
    }

    /// Follows the water of a cell down to one beside a cell that is known; then all cells of its way are known.
    void descend(CellIndex i) {
        around_.clear();
        float least = no_limit;
        while (least == no_limit) {
            around_.push_back(i);
            CellIndex lowest = i;
            float known = no_limit; // the lowest level beside it
            for (std::int64_t const step : offsets_) {
                CellIndex const n = i + step;
                if (state_[n] == unknown) {
                    lowest = level_[n] < level_[lowest] ? n : lowest;
                } else {
                    known = std::min(known, level_[n]);
                }
            }
            if (lowest == i || known <= level_[lowest]) {
                least = just_above(known);
            }
            i = lowest;
        }
        for (auto above = around_.rbegin(); above != around_.rend(); ++above) {
            know(*above, least);
            least = just_above(level_[*above]);
        }
    }

    /// The level of a wet cell beside others that are not.
    float rim_level(CellIndex i) const {
        float lowest = no_limit;
        for (std::int64_t const step : offsets_) {
            lowest = state_[i + step] <= dry ? std::min(lowest, level_[i + step]) : lowest;
        }
        return lowest < no_limit ? std::max(level_[i], rise(lowest)) : no_limit;
    }

    /// Floods the wet cells from those beside them. A cell keeps its own height until the water has come.
    template <class Queue> void settle(Queue queue) {
        float* const level = level_.values().data(); // what is written to state may not change where these are
        std::uint8_t* const state = state_.values().data();
        std::int64_t count = 0;
        each_wet([&](CellIndex i) {
            ++count;
            if (float const z = rim_level(i); z < no_limit) {
                queue.push(z, i);
                state[i] = at_rim;
            }
        });
        std::int64_t popped = 0;
        for (CellIndex i = queue.pop(); i >= 0; i = queue.pop()) {
            if (++popped % cells_between_checks == 0) {
                run_.at(std::min(1.0, static_cast<double>(popped) / static_cast<double>(count)), "carve");
            }
            if (state[i] == at_rim) {
                level[i] = rim_level(i);
                state[i] = settled;
            }
            float const least = rise(level[i]);
            for (std::int64_t const step : offsets_) {
                CellIndex const n = i + step;
                if (state[n] == wet || state[n] == at_rim) {
                    float const z = std::max(level[n], least);
                    level[n] = state[n] == wet ? z : std::min(rim_level(n), z);
                    state[n] = settled;
                    queue.push(level[n], n);
                }
            }
        }
    }

    Raster<float> const& rivers_;
    Lakes lakes_;
    Run const& run_;
    std::array<std::int64_t, 8> offsets_;
    Raster<float> level_;
    Raster<std::uint8_t> state_;    ///< as State
    bool all_ = false;              ///< all cells are wet but those where water leaves
    std::vector<CellIndex> wet_;    ///< otherwise
    std::vector<float> land_;       ///< their heights
    std::vector<CellIndex> around_; ///< the cells of a lake and its shore, or above a cell
    std::vector<ShoreCell> shore_;  ///< a heap, the lowest first
    std::vector<CellIndex> lake_;   ///< in the order in which it has grown
};

} // namespace

std::vector<CellIndex> undrained_cells(Raster<float> const& dem, Raster<float> const& rivers, Run const& run) {
    std::vector<CellIndex> all;
    if (dem.width() < 3) {
        return all;
    }
    std::mutex guard;
    constexpr std::int64_t rows = 64;
    parallel_ranges(run, dem.height() - 2, rows, [&](std::int64_t begin, std::int64_t end) {
        std::vector<CellIndex> found;
        search_rows(dem, rivers, begin + 1, end + 1, found);
        std::scoped_lock const lock(guard);
        all.insert(all.end(), found.begin(), found.end());
    });
    std::sort(all.begin(), all.end());
    return all;
}

Raster<float> flooded(Raster<float> dem, Raster<float> const& rivers, Lakes lakes, Run const& run,
                      std::int64_t cells_per_lake) {
    std::vector<CellIndex> undrained = undrained_cells(dem, rivers, run);
    return Flood(std::move(dem), rivers, lakes, run).fill(std::move(undrained), cells_per_lake);
}

} // namespace thalweg::flow
