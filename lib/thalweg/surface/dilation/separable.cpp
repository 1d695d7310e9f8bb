// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/separable.hpp>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <new>
#include <thread>

#include <thalweg/core/run/error.hpp>

namespace thalweg::surface::separable {
namespace {

/// Level of a cell not reached; every level of a grid is less.
template <class Level> constexpr Level no_level = std::is_same_v<Level, std::uint16_t> ? 0xffff : 1 << 30;

template <class Level> struct Field {
    std::int64_t width = 0;
    std::int64_t height = 0;
    Level* level = nullptr;
    float* base = nullptr;
};

/// The row below, for a strip of columns.
struct Carry {
    std::int64_t count = 0;
    std::int32_t* level = nullptr;
    std::int32_t* key = nullptr;
};

#define THALWEG_KERNELS <thalweg/surface/dilation/internal/separable_lanes.inc>
#include <thalweg/core/run/lanes.inc>

constexpr std::int64_t rows_between_checks = 512;

template <class T> std::unique_ptr<T[], Free> fresh(std::int64_t count) {
    return std::unique_ptr<T[], Free>(
        static_cast<T*>(allocate_large_pages(static_cast<std::size_t>(count) * sizeof(T))));
}

template <class T> void raise_to(std::atomic<T>& most, T value) {
    T seen = most.load();
    while (seen < value && !most.compare_exchange_weak(seen, value)) {
    }
}

std::int64_t workers(Run const& run) {
    return run.threads > 0 ? run.threads : std::max<std::int64_t>(1, std::thread::hardware_concurrency());
}

/// Rows per band: a few more bands than workers, but a single one for one worker, since rows carry downwards within a
/// band only.
std::int64_t band_rows(std::int64_t height, Run const& run) {
    std::int64_t const bands = run.threads == 1 ? 1 : 2 * workers(run);
    return std::max<std::int64_t>(8, (height + bands - 1) / bands);
}

/// Columns per strip: as wide as the number of workers allows, because long rows suit the memory.
std::int64_t strip_cols(std::int64_t width, Run const& run) {
    return std::max<std::int64_t>(64, (width + workers(run) - 1) / workers(run));
}

template <class Level>
float bands_down(Valley const& valley, Field<Level> const& field, std::int64_t rows, Lanes lanes, Run const& run) {
    auto* const down = lanes == Lanes::avx2 ? &avx2::rows_down<Level> : &plain::rows_down<Level>;
    std::atomic<std::int32_t> greatest = -1;
    parallel_ranges(run, (field.height + rows - 1) / rows, 1, [&](std::int64_t first, std::int64_t last) {
        std::vector<std::int32_t> scratch(static_cast<std::size_t>(2 * avx2::lanes * field.width));
        for (std::int64_t band = first; band < last; ++band) {
            std::int64_t const bottom = std::min(field.height, (band + 1) * rows);
            for (std::int64_t row = band * rows; row < bottom; row += rows_between_checks) {
                run.check();
                raise_to(greatest, down(valley.z.values().data(), field, band * rows, row,
                                        std::min(bottom, row + rows_between_checks), scratch.data()));
            }
        }
    });
    return greatest < 0 ? -1.0F : std::bit_cast<float>(greatest.load());
}

/// Carries each band's last row into the next as long as cells change, then computes the levels.
template <class Level>
std::int64_t join_bands(Field<Level> const& field, std::int64_t rows, Lanes lanes, Run const& run) {
    auto* const mend = lanes == Lanes::avx2 ? &avx2::carry_row<Level> : &plain::carry_row<Level>;
    auto* const measure = lanes == Lanes::avx2 ? &avx2::greatest_level<Level> : &plain::greatest_level<Level>;
    std::atomic<std::int64_t> levels = 0;
    parallel_ranges(run, field.width, strip_cols(field.width, run), [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t seam = rows; seam < field.height; seam += rows) {
            run.check();
            std::int64_t const bottom = std::min(field.height, seam + rows);
            for (std::int64_t row = seam; row < bottom && mend(field, row, first, last); ++row) {
            }
        }
        raise_to(levels, measure(field, first, last));
    });
    return levels;
}

/// Calls rows_up(begin, end, first column, carry) from the bottom upwards, on strips of columns.
template <class Level, class RowsUp> void strips_up(Field<Level> const& field, Run const& run, RowsUp const& rows_up) {
    parallel_ranges(run, field.width, strip_cols(field.width, run), [&](std::int64_t first, std::int64_t last) {
        std::vector<std::int32_t> level(static_cast<std::size_t>(last - first), no_level<Level>);
        std::vector<std::int32_t> key(level.size());
        Carry const carry{last - first, level.data(), key.data()};
        for (std::int64_t end = field.height; end > 0; end -= rows_between_checks) {
            run.check();
            rows_up(std::max<std::int64_t>(0, end - rows_between_checks), end, first, carry);
        }
    });
}

template <class Level> Field<Level> field_of(Swept<Level> const& swept, Raster<float>& base) {
    return {base.width(), base.height(), swept.level.get(), base.values().data()};
}

} // namespace

template <class Level> Swept<Level> sweep_down(Valley const& valley, Raster<float>& base, Lanes lanes, Run const& run) {
    Swept<Level> swept;
    swept.level = fresh<Level>(base.cells());
    Field<Level> const field = field_of(swept, base);
    std::int64_t const rows = band_rows(field.height, run);
    swept.greatest = bands_down(valley, field, rows, lanes, run);
    if (swept.greatest >= 0.0F) {
        swept.levels = join_bands(field, rows, lanes, run);
    }
    return swept;
}

template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, Raster<std::int32_t>& level, Lanes lanes,
              Run const& run) {
    Field<Level> const field = field_of(swept, base);
    strips_up(field, run, [&](std::int64_t begin, std::int64_t end, std::int64_t first, Carry const& carry) {
        auto* const rows_up = lanes == Lanes::avx2 ? &avx2::rows_up_levels<Level> : &plain::rows_up_levels<Level>;
        rows_up(field, begin, end, first, carry, level.values().data());
    });
}

template <class Level>
void sweep_up(Swept<Level> const& swept, Raster<float>& base, std::vector<double> above_valley, Lanes lanes,
              Run const& run) {
    Field<Level> const field = field_of(swept, base);
    above_valley[0] = -0.0; // the only number that preserves every height's bits when added, including -0
    strips_up(field, run, [&](std::int64_t begin, std::int64_t end, std::int64_t first, Carry const& carry) {
        auto* const rows_up = lanes == Lanes::avx2 ? &avx2::rows_up_heights<Level> : &plain::rows_up_heights<Level>;
        rows_up(field, begin, end, first, carry, above_valley.data());
    });
}

template Swept<std::uint16_t> sweep_down(Valley const&, Raster<float>&, Lanes, Run const&);
template Swept<std::int32_t> sweep_down(Valley const&, Raster<float>&, Lanes, Run const&);
template void sweep_up(Swept<std::uint16_t> const&, Raster<float>&, Raster<std::int32_t>&, Lanes, Run const&);
template void sweep_up(Swept<std::int32_t> const&, Raster<float>&, Raster<std::int32_t>&, Lanes, Run const&);
template void sweep_up(Swept<std::uint16_t> const&, Raster<float>&, std::vector<double>, Lanes, Run const&);
template void sweep_up(Swept<std::int32_t> const&, Raster<float>&, std::vector<double>, Lanes, Run const&);

} // namespace thalweg::surface::separable
