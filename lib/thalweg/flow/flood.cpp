// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
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
        unknown,  ///< not raised, once all lakes are bounded
        dry,      ///< not raised
        wet,      ///< raised at most to level_
        on_shore, ///< beside the lake that grows
        in_lake,  ///< of the lake that grows
        at_rim,   ///< wet beside others, in the queue, at its own height so far
        settled   ///< wet, at its level
    };

    float rise(float z) const { return lakes_ == Lakes::level ? z : just_above(z); }

    /// Whether water leaves at a cell. Any other has eight neighbours with data.
    bool is_outlet(CellIndex i) const {
        return !std::isnan(rivers_[i]) || level_.grid().on_border(level_.grid().at(i)) ||
               std::any_of(offsets_.begin(), offsets_.end(),
                           [&](std::int64_t step) { return std::isnan(level_[i + step]); });
    }

    void take_all() {
        all_ = true;
        for (CellIndex i = 0; i < level_.cells(); ++i) {
            state_[i] = std::isnan(level_[i]) || is_outlet(i) ? unknown : wet;
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

    /// Adds the lowest cell around a lake to it until water leaves it there; then its cells are known.
    void grow_lake(CellIndex first) {
        LowestCell shore;
        shore.emplace(level_[first], first);
        around_.clear();
        CellIndex way_out = first;
        for (bool on = true; on;) {
            way_out = shore.top().second;
            shore.pop();
            state_[way_out] = in_lake;
            float lowest = no_limit;
            if (is_outlet(way_out)) {
                lowest = -no_limit;
            } else {
                for (std::int64_t const step : offsets_) {
                    CellIndex const n = way_out + step;
                    if (state_[n] == unknown) {
                        state_[n] = on_shore;
                        around_.push_back(n);
                        shore.emplace(level_[n], n);
                    } else if (state_[n] == dry || state_[n] == wet) {
                        lowest = std::min(lowest, level_[n]);
                    }
                }
            }
            if (lowest < no_limit) {
                know(way_out, just_above(lowest));
                on = false;
            }
        }
        LowestCell water;
        water.emplace(level_[way_out], way_out);
        while (!water.empty()) {
            CellIndex const i = water.top().second;
            water.pop();
            Cell const at = level_.grid().at(i);
            for (Cell const step : d8_steps) {
                Cell const to{at.col + step.col, at.row + step.row};
                CellIndex const n = level_.grid().index(to);
                if (level_.grid().contains(to) && state_[n] == in_lake) {
                    know(n, just_above(level_[i]));
                    water.emplace(level_[n], n);
                }
            }
        }
        for (CellIndex const i : around_) {
            if (state_[i] == on_shore) {
                state_[i] = unknown;
            }
        }
    }

    /// Follows the water of a cell down to one beside a cell that is known, or out; then all cells of its way are
    /// known.
    void descend(CellIndex i) {
        around_.clear();
        float least = no_limit;
        while (least == no_limit) {
            around_.push_back(i);
            if (is_outlet(i)) {
                least = -no_limit;
                break;
            }
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
    std::vector<CellIndex> around_; ///< a lake, or above a cell
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
