// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::flow {

/// The cells of some whole rows.
struct RowBand {
    std::int64_t begin = 0;
    std::int64_t end = 0;
    std::size_t number = 0;

    bool contains(std::int64_t cell) const { return cell >= begin && cell < end; }
};

/// A grid's rows in bands, in which water is followed at the same time. One band, if the run has one thread.
class RowBands {
public:
    RowBands(Grid const& grid, Run const& run)
        : width_(grid.width), height_(grid.height),
          count_(run.threads == 1 ? 1 : std::clamp(grid.height / least_rows, std::int64_t{1}, most)) {}

    std::size_t count() const { return static_cast<std::size_t>(count_); }
    RowBand band(std::int64_t number) const {
        return {begin(number), begin(number + 1), static_cast<std::size_t>(number)};
    }
    std::size_t band_of(std::int64_t cell) const {
        std::int64_t const about = cell / width_ * count_ / height_;
        return static_cast<std::size_t>(cell < begin(about + 1) ? about : about + 1);
    }
    /// Calls work(RowBand const&) for each, at the same time.
    template <class Work> void each(Run const& run, Work const& work) const {
        parallel_ranges(run, count_, 1, [&](std::int64_t first, std::int64_t last) {
            for (std::int64_t number = first; number < last; ++number) {
                work(band(number));
            }
        });
    }

private:
    static constexpr std::int64_t most = 16;
    static constexpr std::int64_t least_rows = 64;

    std::int64_t begin(std::int64_t number) const { return height_ * number / count_ * width_; }

    std::int64_t width_;
    std::int64_t height_;
    std::int64_t count_;
};

} // namespace thalweg::flow
