// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/internal/condition.hpp>

namespace thalweg::flow {
namespace {

/// Cells covered by water at one level.
struct Lake {
    std::vector<std::int64_t> cells;
    float level = 0.0F;
};

/// The cells that a search has still to visit: by cost, then index. Costs are not negative, so that their bits have
/// their order.
class CheapestCell {
public:
    void clear() { heap_.clear(); }
    bool empty() const { return heap_.empty(); }
    void push(double cost, std::int64_t cell) {
        heap_.push_back((Key{std::bit_cast<std::uint64_t>(cost + 0.0)} << 64) | static_cast<std::uint64_t>(cell));
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
    std::pair<double, std::int64_t> pop() {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        Key const least = heap_.back();
        heap_.pop_back();
        return {std::bit_cast<double>(static_cast<std::uint64_t>(least >> 64)), static_cast<std::int64_t>(least)};
    }

private:
    using Key = unsigned __int128; // compared without branches
    std::vector<Key> heap_;
};

/// What searches know of the cells that they have reached: pages of cells of one row, which the next search uses again.
template <class T> class Pages {
public:
    explicit Pages(std::int64_t cells) : table_(static_cast<std::size_t>(cells) / cells_a_page + 1) {}

    /// Begins a search, which has reached no cell.
    void restart() {
        ++search_;
        used_ = 0;
    }

    /// The value of a cell; T{} until this search sets it. To look at another cell may move it.
    T& operator[](std::int64_t cell) {
        auto const at = static_cast<std::size_t>(cell);
        Page& page = table_[at / cells_a_page];
        if (page.search != search_) {
            page = {search_, used_++};
            std::size_t const first = page.place * cells_a_page;
            pool_.resize(std::max(pool_.size(), first + cells_a_page));
            std::fill_n(pool_.data() + first, cells_a_page, T{});
        }
        return pool_[page.place * cells_a_page + at % cells_a_page];
    }

private:
    static constexpr std::size_t cells_a_page = 16;

    struct Page {
        std::uint32_t search = 0; ///< that used it last
        std::uint32_t place = 0;  ///< in the pool
    };

    std::vector<Page> table_;
    std::vector<T> pool_;
    std::uint32_t search_ = 0;
    std::uint32_t used_ = 0;
};

class Carver {
public:
    Carver(Raster<float> const& dem, Raster<float> const& valley, SparseHeights const& least, int heights,
           Run const& run)
        : heights_(heights), level_(framed(flooded(dem, valley, Lakes::level, run))), land_(framed(dem)), run_(run),
          offsets_(d8_offsets(land_.grid())), wet_(all_cells()), touched_(all_cells()), river_(all_cells()),
          limited_(all_cells()), least_(least), seen_(land_.cells()), reached_(land_.cells()) {
        auto const in_frame = [&](std::int64_t cell) {
            Cell const inner = dem.grid().at(cell);
            return land_.grid().index({inner.col + 1, inner.row + 1});
        };
        for (std::int64_t i = 0; i < valley.cells(); ++i) {
            if (!std::isnan(valley[i])) {
                river_[static_cast<std::size_t>(in_frame(i))] = true;
            }
        }
        limited_ = river_;
        for (std::int64_t& cell : least_.cell) {
            cell = in_frame(cell);
            limited_[static_cast<std::size_t>(cell)] = true;
        }
    }

    /// Breaches depressions where that is cheaper than filling.
    /// \return the terrain; remaining depressions are still to be filled
    Raster<float> cut() {
        for (std::int64_t i = 0; i < land_.cells(); ++i) {
            wet_[static_cast<std::size_t>(i)] = level_[i] > land_[i];
        }
        std::vector<std::int64_t> const pits = pits_of_lakes();
        std::size_t done = 0;
        for (std::int64_t const pit : pits) {
            if (++done % 64 == 0) {
                run_.at(static_cast<double>(done) / static_cast<double>(pits.size()), "carve");
            }
            Lake lake{take_cells(pit, wet_), 0.0F};
            std::sort(lake.cells.begin(), lake.cells.end());
            lake.level = level_[lake.cells.front()];
            if (std::ranges::any_of(lake.cells, [this](auto i) { return touched_[static_cast<std::size_t>(i)]; })) {
                settle(lake.cells);
            } else {
                drain(lake, 0);
                changes_.clear();
            }
        }
        return std::move(land_);
    }

private:
    using Marks = std::vector<bool>; ///< by cell

    /// A cell that a search for a breach has reached.
    struct Reached {
        double cost = std::numeric_limits<double>::infinity(); ///< infinite: not reached
        float height = 0.0F;                                   ///< to which the path through this cell is cut
        Direction back = Direction::leaves;                    ///< the step that reached the cell; leaves in the pit
    };

    /// Values of a cell before a change, for undo.
    struct Was {
        std::int64_t cell;
        float land;
        float level;
    };

    std::size_t all_cells() const { return static_cast<std::size_t>(land_.cells()); }

    bool is_lower(std::int64_t a, std::int64_t b) const { return land_[a] != land_[b] ? land_[a] < land_[b] : a < b; }

    std::int64_t pit_of(Lake const& lake) const {
        return *std::ranges::min_element(lake.cells, [this](std::int64_t a, std::int64_t b) { return is_lower(a, b); });
    }

    /// Takes the mark from a cell and all that are marked around it.
    /// \return these
    std::vector<std::int64_t> take_cells(std::int64_t first, Marks& marked) const {
        std::vector<std::int64_t> cells{first};
        marked[static_cast<std::size_t>(first)] = false;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            for (std::int64_t const step : offsets_) {
                std::int64_t const n = cells[k] + step;
                if (marked[static_cast<std::size_t>(n)]) {
                    marked[static_cast<std::size_t>(n)] = false;
                    cells.push_back(n);
                }
            }
        }
        return cells;
    }

    /// The lowest cell of each lake of wet cells, lower ones first: anything lower than the current pit drains already.
    std::vector<std::int64_t> pits_of_lakes() const {
        std::vector<std::int64_t> pits;
        Marks left = wet_;
        for (std::int64_t i = 0; i < land_.cells(); ++i) {
            if (left[static_cast<std::size_t>(i)]) {
                pits.push_back(pit_of({take_cells(i, left)}));
            }
        }
        std::ranges::sort(pits, [this](std::int64_t a, std::int64_t b) { return is_lower(a, b); });
        return pits;
    }

    /// The lakes that cover some of these cells, by their first cell.
    std::vector<Lake> lakes_among(std::vector<std::int64_t> const& cells) {
        std::vector<Lake> lakes;
        seen_.restart();
        for (std::int64_t const first : cells) {
            if (!(level_[first] > land_[first]) || seen_[first] != 0) {
                continue;
            }
            Lake lake{{first}, level_[first]};
            seen_[first] = 1;
            for (std::size_t k = 0; k < lake.cells.size(); ++k) {
                for (std::int64_t const step : offsets_) {
                    std::int64_t const n = lake.cells[k] + step;
                    if (level_[n] > land_[n] && seen_[n] == 0) { // never NaN
                        seen_[n] = 1;
                        lake.cells.push_back(n);
                    }
                }
            }
            std::sort(lake.cells.begin(), lake.cells.end());
            lakes.push_back(std::move(lake));
        }
        return lakes;
    }

    /// Recomputes the levels of these cells after terrain has changed there or beside them.
    void flood_again(std::vector<std::int64_t> const& cells) {
        seen_.restart();
        for (std::int64_t const i : cells) {
            seen_[i] = 1; // still dry
        }
        LowestCell queue;
        for (std::int64_t const i : cells) {
            float lowest = std::numeric_limits<float>::infinity();
            for (std::int64_t const step : offsets_) {
                if (level_[i + step] < lowest && seen_[i + step] == 0) { // never NaN
                    lowest = level_[i + step];
                }
            }
            level_[i] = std::max(land_[i], lowest);
            if (std::isfinite(lowest)) {
                queue.emplace(level_[i], i);
            }
        }
        while (!queue.empty()) {
            auto const [z, i] = queue.top();
            queue.pop();
            if (z > level_[i]) {
                continue;
            }
            for (std::int64_t const step : offsets_) {
                std::int64_t const n = i + step;
                if (std::max(land_[n], z) < level_[n] && seen_[n] != 0) {
                    level_[n] = std::max(land_[n], z);
                    queue.emplace(level_[n], n);
                }
            }
        }
    }

    /// Treats the depressions that now exist on these cells: earlier cuts may have lowered their water.
    void settle(std::vector<std::int64_t> const& cells) {
        flood_again(cells);
        for (Lake const& lake : lakes_among(cells)) {
            drain(lake, 0);
            changes_.clear();
        }
    }

    double volume_below(Lake const& lake, float height) const {
        double volume = 0.0;
        for (std::int64_t const i : lake.cells) {
            volume += std::max(0.0, static_cast<double>(height) - static_cast<double>(land_[i]));
        }
        return volume;
    }

    double raise_to(Lake const& lake, float height) {
        double const volume = volume_below(lake, height);
        for (std::int64_t const i : lake.cells) {
            if (land_[i] < height) {
                set(i, height, level_[i]);
            }
        }
        return volume;
    }

    /// A cut that drains a lake once it is filled up to a height.
    struct Cut {
        float from = 0.0F;
        std::int64_t end = nowhere; ///< last cell to be cut
        bool is_last = false;       ///< found by the last search
    };

    /// Finds the cheapest cut, which starts between the pit's own height and the water level: where a river's bank must
    /// not be cut, it is better to fill a pit below it up to the bank first.
    Cut cheapest_cut(Lake const& lake, double full) {
        Cut best;
        float const bottom = land_[pit_of(lake)];
        double bound = full;
        for (int k = 0; k < heights_; ++k) {
            float const share = static_cast<float>(k) / static_cast<float>(heights_);
            float const from = bottom + (lake.level - bottom) * share;
            double const filled = volume_below(lake, from);
            if (!(filled < bound)) {
                break;
            }
            std::size_t const mark = changes_.size();
            raise_to(lake, from);
            best.is_last = false;
            if (std::int64_t const end = find_breach(pit_of(lake), bound - filled); end != nowhere) {
                best = {from, end, true};
                bound = filled + reached_[end].cost;
            }
            take_back(mark);
        }
        return best;
    }

    /// Fills a lake or cuts its outlet.
    /// \return volume moved [m times cells]
    double drain(Lake const& lake, int depth) {
        double full = 0.0;
        for (std::int64_t const i : lake.cells) {
            full += static_cast<double>(lake.level) - static_cast<double>(land_[i]);
        }
        std::size_t const mark = changes_.size();
        if (Cut const cut = depth < deepest ? cheapest_cut(lake, full) : Cut{}; cut.end != nowhere) {
            double moved = raise_to(lake, cut.from);
            moved += cut_back_from(cut.is_last ? cut.end : find_breach(pit_of(lake), full));
            flood_again(lake.cells);
            for (Lake const& rest : lakes_among(lake.cells)) {
                moved += drain(rest, depth + 1);
            }
            if (moved < full) {
                return moved;
            }
            take_back(mark);
        }
        for (std::int64_t const i : lake.cells) {
            set(i, lake.level, lake.level);
        }
        return full;
    }

    void set(std::int64_t i, float land, float level) {
        changes_.push_back({i, land_[i], level_[i]});
        land_[i] = land;
        level_[i] = level;
        touched_[static_cast<std::size_t>(i)] = true;
        for (std::int64_t const step : offsets_) {
            touched_[static_cast<std::size_t>(i + step)] = true;
        }
    }

    void take_back(std::size_t mark) {
        for (; changes_.size() > mark; changes_.pop_back()) {
            Was const& was = changes_.back();
            land_[was.cell] = was.land;
            level_[was.cell] = was.level;
        }
    }

    /// Finds the least-cost path from a pit to a cell that drains, if it costs less than the bound.
    /// \return the last cell to be cut
    std::int64_t find_breach(std::int64_t pit, double bound) {
        reached_.restart();
        queue_.clear();
        reached_[pit] = {0.0, land_[pit], Direction::leaves};
        queue_.push(0.0, pit);
        while (!queue_.empty()) {
            auto const [cost, i] = queue_.pop();
            Reached const here = reached_[i];
            if (cost > here.cost) {
                continue;
            }
            float const height = just_below(here.height);
            for (std::size_t k = 0; k < offsets_.size(); ++k) {
                std::int64_t const n = i + offsets_[k];
                float const land = land_[n];
                if (land <= height ? level_[n] == land : std::isnan(land)) {
                    return i;
                }
                double const there = cost + std::max(0.0, static_cast<double>(land) - static_cast<double>(height));
                if (!(there < bound)) {
                    continue;
                }
                auto const at = static_cast<std::size_t>(n);
                Reached& reached = reached_[n];
                if (!(there < reached.cost) ||
                    (limited_[at] && (river_[at] || (land > height && least_.of(n) > height)))) {
                    continue;
                }
                reached = {there, height, direction_of(k)};
                queue_.push(there, n);
            }
        }
        return nowhere;
    }

    /// Cuts along the path found.
    /// \return volume moved [m times cells]
    double cut_back_from(std::int64_t end) {
        double moved = 0.0;
        for (std::int64_t i = end;; i -= offsets_[index_of(reached_[i].back)]) {
            Reached const reached = reached_[i];
            float const height = std::min(land_[i], reached.height);
            moved += static_cast<double>(land_[i]) - static_cast<double>(height);
            set(i, height, height);
            if (!goes_on(reached.back)) {
                return moved;
            }
        }
    }

    static constexpr std::int64_t nowhere = -1;
    int heights_;                      ///< number of heights at which a cut may begin, the pit's own first
    static constexpr int deepest = 64; ///< nesting depth of lakes; deeper ones are filled

    Raster<float> level_; ///< framed, as all that follows
    Raster<float> land_;
    Run const& run_;
    std::array<std::int64_t, 8> offsets_;
    std::vector<Was> changes_;
    Marks wet_;     ///< of the lakes that are still to be drained
    Marks touched_; ///< it, or one beside it, has changed
    Marks river_;   ///< must not be cut
    Marks limited_; ///< a river or has a least height
    SparseHeights least_;
    Pages<std::uint8_t> seen_; ///< 1: by the last search
    Pages<Reached> reached_;
    CheapestCell queue_; ///< of the last search
};

} // namespace

float SparseHeights::of(CellIndex i) const {
    auto const at = std::ranges::lower_bound(cell, i) - cell.begin();
    return z[static_cast<std::size_t>(at)];
}

SparseHeights sparse_heights(Raster<float> const& by_cell) {
    SparseHeights least;
    for (CellIndex i = 0; i < by_cell.cells(); ++i) {
        if (!std::isnan(by_cell[i])) {
            least.cell.push_back(i);
            least.z.push_back(by_cell[i]);
        }
    }
    return least;
}

namespace {

SparseHeights changed_cells(Raster<float> const& before, Raster<float> const& after) {
    SparseHeights changed;
    for (CellIndex i = 0; i < before.cells(); ++i) {
        if (std::bit_cast<std::uint32_t>(before[i]) != std::bit_cast<std::uint32_t>(after[i])) {
            changed.cell.push_back(i);
            changed.z.push_back(after[i]);
        }
    }
    return changed;
}

/// The terrain after cuts, which may begin at several heights, and the filling of what they leave.
Raster<float> drained_by(int heights, Raster<float> const& dem, Valley const& valley, SparseHeights const& least,
                         Run const& run) {
    Raster<float> land = Carver(dem, valley.z, least, heights, run).cut();
    land = unframed(land, dem.grid());
    return flooded(std::move(land), valley.z, Lakes::slope, run);
}

} // namespace

Raster<float> carve_depressions(Raster<float> const& dem, Valley const& valley, SparseHeights const& least,
                                Run const& run) {
    // A pit below a river's banks may have to be partly filled before it is cut. A cut that is cheaper for its lake may
    // make others more expensive, so both strategies are tried on the whole terrain and the cheaper is kept.
    Raster<float> from_pits = drained_by(1, dem, valley, least, run);
    if (least.cell.empty()) {
        return from_pits;
    }
    double const volume = change_between(dem, from_pits).volume_m3();
    SparseHeights const kept = changed_cells(dem, from_pits);
    from_pits = {};
    Raster<float> drained = drained_by(8, dem, valley, least, run);
    if (change_between(dem, drained).volume_m3() < volume) {
        return drained;
    }
    drained = dem;
    for (std::size_t k = 0; k < kept.cell.size(); ++k) {
        drained[kept.cell[k]] = kept.z[k];
    }
    return drained;
}

Raster<float> carve(Raster<float> const& dem, Valley const& valley, Raster<float> const& least, Run const& run) {
    check_drainable(dem, valley, run);
    require_same_grid(least.grid(), dem.grid(), "flow.carve", "the least heights and the land",
                      "make both on one grid");
    return undrained_cells(dem, valley.z, run).empty() ? dem
                                                       : carve_depressions(dem, valley, sparse_heights(least), run);
}

} // namespace thalweg::flow
