// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
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

class Carver {
public:
    Carver(Raster<float> const& dem, Raster<float> const& valley, Raster<float> const& least, int heights,
           Run const& run)
        : heights_(heights), land_(framed(dem)), level_(framed(flooded(dem, valley, Lakes::level, run))),
          least_(framed(least)), run_(run), offsets_(d8_offsets(land_.grid())), lake_(land_.grid()),
          seen_(land_.grid()), reached_(land_.grid()) {
        for (std::int64_t r = 0; r < valley.height(); ++r) {
            for (std::int64_t c = 0; c < valley.width(); ++c) {
                if (Cell const inner{c, r}; !std::isnan(valley[inner])) {
                    least_[Cell{c + 1, r + 1}] = uncuttable;
                }
            }
        }
    }

    /// Breaches depressions where that is cheaper than filling.
    /// \return the terrain; remaining depressions are still to be filled
    Raster<float> cut() {
        std::vector<std::int64_t> all;
        for (std::int64_t i = 0; i < land_.cells(); ++i) {
            if (level_[i] > land_[i]) {
                all.push_back(i);
            }
        }
        std::vector<Lake> lakes = lakes_among(all);
        for (std::size_t k = 0; k < lakes.size(); ++k) {
            for (std::int64_t const i : lakes[k].cells) {
                lake_[i] = static_cast<std::uint32_t>(k + 1);
            }
        }
        touched_.assign(lakes.size() + 1, false);
        // Lower pits first: anything lower than the current pit drains already.
        std::vector<std::tuple<float, std::int64_t, std::size_t>> order;
        for (std::size_t k = 0; k < lakes.size(); ++k) {
            std::int64_t const pit = pit_of(lakes[k]);
            order.emplace_back(land_[pit], pit, k);
        }
        std::sort(order.begin(), order.end());
        std::size_t done = 0;
        for (auto const& [z, pit, k] : order) {
            if (++done % 64 == 0) {
                run_.at(static_cast<double>(done) / static_cast<double>(order.size()), "carve");
            }
            if (touched_[k + 1]) {
                settle(lakes[k].cells);
            } else {
                drain(lakes[k], 0);
                changes_.clear();
            }
            lakes[k] = {};
        }
        return std::move(land_);
    }

private:
    static constexpr float uncuttable = std::numeric_limits<float>::infinity(); ///< the least height of a river cell

    /// A cell that a search for a breach has reached.
    struct Reached {
        double cost = 0.0;
        float height = 0.0F;                ///< to which the path through this cell is cut
        std::uint32_t stamp = 0;            ///< of the last search that reached the cell
        Direction back = Direction::leaves; ///< the step that reached the cell; leaves in the pit
    };

    /// Values of a cell before a change, for undo.
    struct Was {
        std::int64_t cell;
        float land;
        float level;
    };

    std::int64_t pit_of(Lake const& lake) const {
        return *std::min_element(lake.cells.begin(), lake.cells.end(), [this](std::int64_t a, std::int64_t b) {
            return land_[a] != land_[b] ? land_[a] < land_[b] : a < b;
        });
    }

    /// The lakes that cover some of these cells, by their first cell.
    std::vector<Lake> lakes_among(std::vector<std::int64_t> const& cells) {
        std::vector<Lake> lakes;
        ++stamp_;
        for (std::int64_t const first : cells) {
            if (seen_[first] == stamp_ || !(level_[first] > land_[first])) {
                continue;
            }
            Lake lake{{first}, level_[first]};
            seen_[first] = stamp_;
            for (std::size_t k = 0; k < lake.cells.size(); ++k) {
                for (std::int64_t const step : offsets_) {
                    std::int64_t const n = lake.cells[k] + step;
                    if (seen_[n] != stamp_ && level_[n] > land_[n]) { // never NaN
                        seen_[n] = stamp_;
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
        ++stamp_;
        for (std::int64_t const i : cells) {
            seen_[i] = stamp_; // still dry
        }
        LowestCell queue;
        for (std::int64_t const i : cells) {
            float lowest = std::numeric_limits<float>::infinity();
            for (std::int64_t const step : offsets_) {
                if (seen_[i + step] != stamp_ && level_[i + step] < lowest) { // never NaN
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
                if (seen_[n] == stamp_ && std::max(land_[n], z) < level_[n]) {
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
        touched_[lake_[i]] = true;
        for (std::int64_t const step : offsets_) {
            touched_[lake_[i + step]] = true;
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
        ++stamp_;
        queue_.clear();
        reached_[pit] = {0.0, land_[pit], stamp_, Direction::leaves};
        queue_.push(0.0, pit);
        while (!queue_.empty()) {
            auto const [cost, i] = queue_.pop();
            if (cost > reached_[i].cost) {
                continue;
            }
            float const height = just_below(reached_[i].height);
            for (std::size_t k = 0; k < offsets_.size(); ++k) {
                std::int64_t const n = i + offsets_[k];
                float const land = land_[n];
                if (land <= height ? level_[n] == land : std::isnan(land)) {
                    return i;
                }
                if (least_[n] > height && (land > height || least_[n] == uncuttable)) {
                    continue;
                }
                double const there = cost + std::max(0.0, static_cast<double>(land) - static_cast<double>(height));
                Reached& reached = reached_[n];
                if (there < bound && (reached.stamp != stamp_ || there < reached.cost)) {
                    reached = {there, height, stamp_, direction_of(k)};
                    queue_.push(there, n);
                }
            }
        }
        return nowhere;
    }

    /// Cuts along the path found.
    /// \return volume moved [m times cells]
    double cut_back_from(std::int64_t end) {
        double moved = 0.0;
        for (std::int64_t i = end;; i -= offsets_[index_of(reached_[i].back)]) {
            float const height = std::min(land_[i], reached_[i].height);
            moved += static_cast<double>(land_[i]) - static_cast<double>(height);
            set(i, height, height);
            if (!goes_on(reached_[i].back)) {
                return moved;
            }
        }
    }

    static constexpr std::int64_t nowhere = -1;
    int heights_;                      ///< number of heights at which a cut may begin, the pit's own first
    static constexpr int deepest = 64; ///< nesting depth of lakes; deeper ones are filled

    Raster<float> land_;
    Raster<float> level_;
    Raster<float> least_;
    Run const& run_;
    std::array<std::int64_t, 8> offsets_;
    std::vector<Was> changes_;
    Raster<std::uint32_t> lake_; ///< number of the lake that covers the cell at first, from 1; 0: none
    std::vector<bool> touched_;  ///< by number: a cell of the lake, or beside it, has changed
    std::uint32_t stamp_ = 0;
    Raster<std::uint32_t> seen_; ///< stamp of the last search that reached the cell
    Raster<Reached> reached_;
    CheapestCell queue_; ///< of the last search
};

} // namespace

Raster<float> carve_depressions(Raster<float> const& dem, Valley const& valley, Raster<float> const& least,
                                Run const& run) {
    // A pit below a river's banks may have to be partly filled before it is cut. A cut that is cheaper for its lake may
    // make others more expensive, so both strategies are tried on the whole terrain and the cheaper is kept.
    bool const banks =
        std::any_of(least.values().begin(), least.values().end(), [](float z) { return !std::isnan(z); });
    std::optional<Raster<float>> best;
    double moved = 0.0;
    for (int const heights : {1, 8}) {
        if (heights > 1 && !banks) {
            break;
        }
        Raster<float> cut = Carver(dem, valley.z, least, heights, run).cut();
        Raster<float> drained = flooded(unframed(cut, dem.grid()), valley.z, Lakes::slope, run);
        double const volume = change_between(dem, drained).volume_m3();
        if (!best || volume < moved) {
            best = std::move(drained);
            moved = volume;
        }
    }
    return *std::move(best);
}

Raster<float> carve(Raster<float> const& dem, Valley const& valley, Raster<float> const& least, Run const& run) {
    check_drainable(dem, valley, run);
    require_same_grid(least.grid(), dem.grid(), "flow.carve", "the least heights and the land",
                      "make both on one grid");
    return undrained_cells(dem, valley.z, run).empty() ? dem : carve_depressions(dem, valley, least, run);
}

} // namespace thalweg::flow
