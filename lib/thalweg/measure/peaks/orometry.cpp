// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/peaks/orometry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/lanes.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::measure {
namespace {

using PeakIndex = std::int32_t;

bool is_higher(Raster<float> const& dem, std::int64_t a, std::int64_t b) {
    return dem[a] > dem[b] || (dem[a] == dem[b] && a < b);
}

/// The cell itself and its neighbours in the order of their numbers, so that the first of equal heights wins.
constexpr std::array<Cell, 9> square_of_nine = {
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
constexpr std::int32_t itself = 4;

/// By cell of a row, the highest of it and its neighbours in the row.
struct HighestOfRow {
    std::vector<float> z;
    std::vector<std::int32_t> place; ///< 0: west, 1: itself, 2: east
};

#define THALWEG_KERNELS <thalweg/measure/peaks/internal/highest_lanes.inc>
#include <thalweg/core/run/lanes.inc>

/// By cell the place in square_of_nine of the highest cell.
Raster<std::uint8_t> highest_around(Raster<float> const& dem, Run const& run) {
    Raster<std::uint8_t> found(dem.grid());
    bool const wide = widest_lanes() == Lanes::avx2;
    auto* const of_three = wide ? &avx2::highest_of_three : &plain::highest_of_three;
    auto* const of_rows = wide ? &avx2::highest_of_rows : &plain::highest_of_rows;
    std::int64_t const width = dem.width();
    parallel_ranges(run, dem.height(), 64, [&](std::int64_t begin, std::int64_t end) {
        std::vector<float> padded(width + 2, std::numeric_limits<float>::quiet_NaN()); // a cell beyond either end
        std::array<HighestOfRow, 3> rows;
        for (HighestOfRow& row : rows) {
            row = {std::vector<float>(width), std::vector<std::int32_t>(width)};
        }
        auto const take = [&](std::int64_t r, HighestOfRow& row) {
            if (r < 0 || r >= dem.height()) {
                std::ranges::fill(row.z, -std::numeric_limits<float>::infinity());
                return;
            }
            std::ranges::copy(dem.row(r), padded.begin() + 1);
            of_three(padded.data(), row.z.data(), row.place.data(), width);
        };
        take(begin - 1, rows[0]);
        take(begin, rows[1]);
        for (std::int64_t r = begin; r < end; ++r) {
            take(r + 1, rows[2]);
            of_rows(rows[0], rows[1], rows[2], found.row(r).data(), width);
            std::rotate(rows.begin(), rows.begin() + 1, rows.end());
        }
    });
    return found;
}

/// The highest saddle between the areas of two peaks.
struct Saddle {
    float z;
    PeakIndex a;
    PeakIndex b;
};

/// The local maxima of a DEM. The area of a peak is all cells from which ascents to the highest neighbour reach it.
struct Summits {
    std::vector<std::int64_t> cell;   ///< of a peak, ascending
    std::vector<float> lowest;        ///< of the area of a peak
    std::vector<Saddle> saddles = {}; ///< from the highest down

    PeakIndex at(std::int64_t top) const {
        return static_cast<PeakIndex>(std::ranges::lower_bound(cell, top) - cell.begin());
    }
};

Summits maxima(Raster<float> const& dem, Raster<std::uint8_t> const& highest) {
    Summits found;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (highest[i] == itself && !std::isnan(dem[i])) {
            found.cell.push_back(i);
        }
    }
    found.lowest.assign(found.cell.size(), std::numeric_limits<float>::infinity());
    return found;
}

/// The peaks of the cells of a few rows. Of the whole DEM they would be four bytes a cell; the ascents that leave the
/// rows are walked to their ends instead.
class PeakRows {
public:
    using LocalPeak = std::int32_t; ///< a peak that cells of these rows ascend to, in the order they come
    static constexpr LocalPeak none = -1;

    PeakRows(Raster<float> const& dem, Raster<std::uint8_t> const& highest, Summits const& summits)
        : dem_(dem), highest_(highest), summits_(summits) {
        std::ranges::transform(square_of_nine, step_.begin(), [&](Cell c) { return c.row * dem.width() + c.col; });
    }

    /// Finds peaks, lowest cells and saddles of rows, and the saddles between the last and the one below it.
    void take(std::int64_t first_row, std::int64_t beyond_row) {
        begin_ = first_row * dem_.width();
        peaks_.clear();
        number_.clear();
        saddles_.clear();
        std::int64_t const end_row = std::min(beyond_row + 1, dem_.height());
        of_.assign((end_row - first_row) * dem_.width(), none);
        for (std::int64_t i = begin_; i < end_row * dem_.width(); ++i) {
            if (!std::isnan(dem_[i])) {
                ascend(i);
            }
        }
        find_lowest((beyond_row - first_row) * dem_.width());
        find_saddles(first_row, beyond_row);
    }

    /// Adds what was found to the whole; the order of bands makes no difference.
    void add_to(std::vector<float>& lowest, std::unordered_map<std::uint64_t, float>& saddles) const {
        for (LocalPeak p = 0; p < static_cast<LocalPeak>(peaks_.size()); ++p) {
            lowest[peaks_[p]] = std::min(lowest[peaks_[p]], lowest_[p]);
        }
        for (auto const& [pair, z] : saddles_) {
            auto const [a, b] = std::minmax(peaks_[pair >> 32U], peaks_[pair & 0xFFFFFFFFU]);
            keep_higher(saddles, pair_of(a, b), z);
        }
    }

    static std::uint64_t pair_of(std::int32_t a, std::int32_t b) {
        return (static_cast<std::uint64_t>(a) << 32U) | static_cast<std::uint64_t>(b);
    }

private:
    static void keep_higher(std::unordered_map<std::uint64_t, float>& saddles, std::uint64_t pair, float z) {
        auto const [known, is_new] = saddles.emplace(pair, z);
        known->second = is_new ? z : std::max(known->second, z);
    }

    void ascend(std::int64_t cell) {
        way_.clear();
        while (is_inside(cell) && of_[cell - begin_] == none && highest_[cell] != itself) {
            way_.push_back(cell);
            cell += step_[highest_[cell]];
        }
        LocalPeak const peak = is_inside(cell) && of_[cell - begin_] != none ? of_[cell - begin_] : top_of(cell);
        for (std::int64_t const passed : way_) {
            of_[passed - begin_] = peak;
        }
    }
    bool is_inside(std::int64_t cell) const {
        return cell >= begin_ && cell < begin_ + static_cast<std::int64_t>(of_.size());
    }
    LocalPeak top_of(std::int64_t cell) {
        while (highest_[cell] != itself) {
            cell += step_[highest_[cell]];
        }
        auto const [known, is_new] = number_.emplace(cell, static_cast<LocalPeak>(peaks_.size()));
        if (is_new) {
            peaks_.push_back(summits_.at(cell));
        }
        if (is_inside(cell)) {
            of_[cell - begin_] = known->second;
        }
        return known->second;
    }

    void find_lowest(std::int64_t cells) {
        lowest_.assign(peaks_.size(), std::numeric_limits<float>::infinity());
        for (std::int64_t i = 0; i < cells; ++i) {
            if (of_[i] != none) {
                lowest_[of_[i]] = std::min(lowest_[of_[i]], dem_[begin_ + i]);
            }
        }
    }

    void find_saddles(std::int64_t first_row, std::int64_t beyond_row) {
        std::array<std::int64_t, 4> const onwards = {1, dem_.width() - 1, dem_.width(),
                                                     dem_.width() + 1}; // a pair once
        for (std::int64_t row = first_row; row < beyond_row; ++row) {
            bool const is_last = row + 1 == dem_.height();
            for (std::int64_t col = 0; col < dem_.width(); ++col) {
                std::int64_t const i = (row - first_row) * dem_.width() + col;
                bool const has_east = col + 1 < dem_.width();
                if (has_east) {
                    meet(i, i + onwards[0]);
                }
                if (!is_last && col > 0) {
                    meet(i, i + onwards[1]);
                }
                if (!is_last) {
                    meet(i, i + onwards[2]);
                }
                if (!is_last && has_east) {
                    meet(i, i + onwards[3]);
                }
            }
        }
    }
    void meet(std::int64_t i, std::int64_t there) {
        if (of_[i] == of_[there] || of_[i] == none || of_[there] == none) {
            return;
        }
        auto const [a, b] = std::minmax(of_[i], of_[there]);
        keep_higher(saddles_, pair_of(a, b), std::min(dem_[begin_ + i], dem_[begin_ + there]));
    }

    Raster<float> const& dem_;
    Raster<std::uint8_t> const& highest_;
    Summits const& summits_;
    std::array<std::int64_t, square_of_nine.size()> step_{};
    std::int64_t begin_ = 0;                             ///< the first cell of the rows
    std::vector<LocalPeak> of_;                          ///< by cell of the rows
    std::vector<PeakIndex> peaks_;                       ///< by local peak
    std::vector<float> lowest_;                          ///< by local peak
    std::unordered_map<std::int64_t, LocalPeak> number_; ///< of the peak at a cell
    std::unordered_map<std::uint64_t, float> saddles_;   ///< by pair of local peaks
    std::vector<std::int64_t> way_;
};

Summits summits_of(Raster<float> const& dem, Run const& run) {
    constexpr std::int64_t band_rows = 64;
    Raster<std::uint8_t> const highest = highest_around(dem, run);
    Summits found = maxima(dem, highest);
    std::vector<float> lowest = found.lowest;
    std::unordered_map<std::uint64_t, float> saddles;
    std::mutex mutex;
    std::int64_t const bands = (dem.height() + band_rows - 1) / band_rows;
    parallel_ranges(run, bands, 1, [&](std::int64_t begin, std::int64_t end) {
        PeakRows band(dem, highest, found);
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            band.take(b * band_rows, std::min((b + 1) * band_rows, dem.height()));
            std::scoped_lock const lock(mutex);
            band.add_to(lowest, saddles);
        }
    });
    found.lowest = std::move(lowest);
    found.saddles.reserve(saddles.size());
    for (auto const& [pair, z] : saddles) {
        found.saddles.push_back({z, static_cast<PeakIndex>(pair >> 32U), static_cast<PeakIndex>(pair & 0xFFFFFFFFU)});
    }
    std::sort(found.saddles.begin(), found.saddles.end(),
              [](Saddle const& p, Saddle const& q) { return std::tie(q.z, p.a, p.b) < std::tie(p.z, q.a, q.b); });
    return found;
}

/// Joins the areas of peaks from the highest saddle down; the lower peak of two gets its prominence.
class Joining {
public:
    Joining(Raster<float> const& dem, std::vector<std::int64_t> const& cell)
        : dem_(dem), cell_(cell), highest_(static_cast<std::int32_t>(cell.size())),
          prominence_(static_cast<std::int32_t>(cell.size())) {
        for (PeakIndex p = 0; p < static_cast<std::int32_t>(cell.size()); ++p) {
            highest_[p] = p;
        }
    }

    void join(Saddle const& saddle) {
        PeakIndex const a = highest_peak(saddle.a);
        PeakIndex const b = highest_peak(saddle.b);
        if (a == b) {
            return;
        }
        PeakIndex const lower = is_higher(dem_, cell_[a], cell_[b]) ? b : a;
        prominence_[lower] = static_cast<double>(dem_[cell_[lower]]) - static_cast<double>(saddle.z);
        highest_[lower] = lower == a ? b : a;
    }
    /// The highest peak of the joined area, with path halving.
    PeakIndex highest_peak(PeakIndex peak) {
        while (highest_[peak] != peak) {
            highest_[peak] = highest_[highest_[peak]];
            peak = highest_[peak];
        }
        return peak;
    }
    double& prominence(PeakIndex peak) { return prominence_[peak]; }

private:
    Raster<float> const& dem_;
    std::vector<std::int64_t> const& cell_;
    std::vector<PeakIndex> highest_;
    std::vector<double> prominence_;
};

/// The highest peak of each connected area gets its height above the lowest cell as prominence.
void finish(Raster<float> const& dem, Summits const& summits, Joining& joining) {
    auto const peaks = static_cast<PeakIndex>(summits.cell.size());
    std::vector<float> lowest = summits.lowest;
    for (PeakIndex p = 0; p < peaks; ++p) {
        float& least = lowest[joining.highest_peak(p)];
        least = std::min(least, summits.lowest[p]);
    }
    for (PeakIndex p = 0; p < peaks; ++p) {
        if (joining.highest_peak(p) == p) {
            joining.prominence(p) = static_cast<double>(dem[summits.cell[p]]) - static_cast<double>(lowest[p]);
        }
    }
}

bool has_all_neighbours(Raster<float> const& dem, std::int64_t cell) {
    Cell const at = dem.grid().at(cell);
    return std::all_of(d8_steps.begin(), d8_steps.end(), [&](Cell step) {
        Cell const there{at.col + step.col, at.row + step.row};
        return dem.grid().contains(there) && !std::isnan(dem[there]);
    });
}

constexpr std::int64_t none_yet = std::numeric_limits<std::int64_t>::max();

/// The least squared distance [cells^2] to a higher cell of the ring.
std::int64_t nearest_of_ring(Raster<float> const& dem, Cell at, std::int64_t ring) {
    std::int64_t nearest = none_yet;
    auto const look = [&](Cell there) {
        if (dem.grid().contains(there) && dem[there] > dem[at]) {
            nearest = std::min(nearest, squared_cells(at, there));
        }
    };
    for (std::int64_t k = -ring; k <= ring; ++k) {
        look({at.col + k, at.row - ring});
        look({at.col + k, at.row + ring});
        look({at.col - ring, at.row + k});
        look({at.col + ring, at.row + k});
    }
    return nearest;
}

constexpr double square_metres_a_km2 = 1e6;

/// The median, or the mean of the middle two; NaN: no values.
double median(std::vector<double> values) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    std::size_t const half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Finds how far the nearest higher cell is, by the highest cells of blocks: few peaks have one beside them.
class HigherGround {
public:
    HigherGround(Raster<float> const& dem, Run const& run) : dem_(dem), maxima_(block_maxima(dem, side, run)) {}

    /// The least squared distance [cells^2] to a higher cell.
    std::int64_t nearest(Cell at) const {
        std::int64_t nearest = none_yet;
        Cell const block{at.col / side, at.row / side};
        std::int64_t const last =
            std::max({block.col, block.row, maxima_.width() - 1 - block.col, maxima_.height() - 1 - block.row});
        auto const look = [&](Cell there) {
            if (maxima_.grid().contains(there) && maxima_[there] > dem_[at]) {
                nearest = std::min(nearest, nearest_in(there, at, nearest));
            }
        };
        look(block);
        // The cells of a ring of blocks are no nearer than this.
        auto const reach = [](std::int64_t ring) { return (ring - 1) * side + 1; };
        for (std::int64_t ring = 1; ring <= last && (nearest == none_yet || reach(ring) * reach(ring) < nearest);
             ++ring) {
            for (std::int64_t k = -ring; k <= ring; ++k) {
                look({block.col + k, block.row - ring});
                look({block.col + k, block.row + ring});
            }
            for (std::int64_t k = 1 - ring; k < ring; ++k) {
                look({block.col - ring, block.row + k});
                look({block.col + ring, block.row + k});
            }
        }
        return nearest;
    }

private:
    static constexpr std::int64_t side = 16;

    /// The same among the cells of a block; those that are not below a distance may be left out.
    std::int64_t nearest_in(Cell block, Cell at, std::int64_t below) const {
        std::int64_t const col = block.col * side;
        std::int64_t const beyond = std::min(col + side, dem_.width());
        std::int64_t const aside = at.col - std::clamp(at.col, col, beyond - 1);
        std::int64_t nearest = none_yet;
        for (std::int64_t r = block.row * side; r < std::min((block.row + 1) * side, dem_.height()); ++r) {
            if ((at.row - r) * (at.row - r) + aside * aside >= std::min(nearest, below)) {
                continue;
            }
            for (std::int64_t c = col; c < beyond; ++c) {
                if (dem_[Cell{c, r}] > dem_[at]) {
                    nearest = std::min(nearest, squared_cells(at, {c, r}));
                }
            }
        }
        return nearest;
    }

    Raster<float> const& dem_;
    Raster<float> maxima_;
};

double in_metres(std::int64_t squared, Grid const& grid) {
    return squared == none_yet ? std::numeric_limits<double>::quiet_NaN()
                               : std::sqrt(static_cast<double>(squared)) * grid.cell_m;
}

std::vector<double> isolations(Raster<float> const& dem, std::vector<Peak> const& peaks, Run const& run) {
    if (peaks.empty()) {
        return {};
    }
    HigherGround const higher(dem, run);
    std::vector<double> found(peaks.size());
    parallel_ranges(run, static_cast<std::int64_t>(peaks.size()), 1, [&](std::int64_t begin, std::int64_t end) {
        for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
            run.check();
            found[p] = in_metres(higher.nearest(dem.grid().at(peaks[p].cell)), dem.grid());
        }
    });
    std::erase_if(found, [](double far) { return std::isnan(far); });
    return found;
}

} // namespace

std::vector<Peak> prominent_peaks(Raster<float> const& dem, double least_m, Run const& run) {
    require_in("measure.prominent_peaks", "least_m", least_m, Range::at_least(0.0));
    Summits const summits = summits_of(dem, run);
    Joining joining(dem, summits.cell);
    for (Saddle const& saddle : summits.saddles) {
        joining.join(saddle);
    }
    finish(dem, summits, joining);
    std::vector<Peak> found;
    for (PeakIndex p = 0; p < static_cast<std::int32_t>(summits.cell.size()); ++p) {
        std::int64_t const cell = summits.cell[p];
        if (joining.prominence(p) >= least_m && has_all_neighbours(dem, cell)) {
            found.push_back({cell, static_cast<double>(dem[cell]), joining.prominence(p)});
        }
    }
    return found;
}

double isolation(Raster<float> const& dem, std::int64_t cell) {
    refuse_if<BadInput>(cell < 0 || cell >= dem.cells(), "measure.isolation", "cell {} is not one of the DEM's {}",
                        cell, dem.cells());
    Cell const at = dem.grid().at(cell);
    std::int64_t const last = std::max({at.col, at.row, dem.width() - 1 - at.col, dem.height() - 1 - at.row});
    std::int64_t nearest = none_yet;
    for (std::int64_t ring = 1; ring <= last && (nearest == none_yet || ring * ring < nearest); ++ring) {
        nearest = std::min(nearest, nearest_of_ring(dem, at, ring));
    }
    return in_metres(nearest, dem.grid());
}

Orometry orometry(Raster<float> const& dem, OrometryParams const& params, Run const& run) {
    std::vector<Peak> const peaks = prominent_peaks(dem, params.least_prominence_m, run);
    auto const cells = std::count_if(dem.values().begin(), dem.values().end(), [](float z) { return !std::isnan(z); });
    double const cell_km2 = dem.grid().cell_m * dem.grid().cell_m / square_metres_a_km2;
    Orometry found;
    found.peaks = static_cast<std::int64_t>(peaks.size());
    if (cells > 0) {
        found.peaks_per_km2 = static_cast<double>(found.peaks) / (static_cast<double>(cells) * cell_km2);
    }
    std::vector<double> prominences;
    prominences.reserve(peaks.size());
    for (Peak const& peak : peaks) {
        prominences.push_back(peak.prominence_m);
    }
    found.median_prominence_m = median(std::move(prominences));
    found.median_isolation_m = median(isolations(dem, peaks, run));
    return found;
}

} // namespace thalweg::measure
