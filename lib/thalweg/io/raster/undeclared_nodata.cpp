// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {
namespace {

// The last, the smallest normal float, is what GDAL's HF2 driver writes for no-data.
constexpr std::array<double, 5> no_terrain{-9999.0, -32767.0, -32768.0, -99999.0,
                                           static_cast<double>(std::numeric_limits<float>::min())};
constexpr double deepest_sea = -12000.0;
constexpr std::int32_t block_side = 3;
constexpr double steepest_coast_m = 300.0; // over one cell, along all of a coast
constexpr double doubtful_coast_m = 30.0;

std::string remedy(double stored, std::string const& path) {
    return fmt::format("declare it (gdal_edit.py -a_nodata {0:.9g} {1}), or use --nodata {0:.9g} where the command has "
                       "that option",
                       stored, path);
}

} // namespace

bool stands_for(double stored, double named) {
    constexpr double largest = 1e30; // matches 3.4e38 for 3.4028235e38
    return stored == named || static_cast<float>(stored) == static_cast<float>(named) ||
           (std::fabs(stored) > largest && std::fabs(named) > largest && (stored > 0.0) == (named > 0.0));
}

std::string implausible_words(std::int64_t col, std::int64_t row, double stored) {
    return fmt::format("the height at column {}, row {} is {}: is the file damaged? A value that stands for no-data "
                       "must be declared (gdal_edit.py -a_nodata {:.9g}) or named (--nodata {:.9g})",
                       col, row, stored, stored, stored);
}

UndeclaredNodata::UndeclaredNodata(int width, ReadDemParams const& params, bool is_declared, double metres)
    : searches_(!params.nodata), searches_blocks_(params.values == CellValues::heights && !is_declared),
      metres_(std::fabs(metres)) {
    low_.run.assign(static_cast<std::size_t>(width), 0);
    high_.run = low_.run;
    for (std::size_t i = 0; i < no_terrain.size(); ++i) {
        sentinels_[i].value = no_terrain[i];
    }
}

void UndeclaredNodata::Extreme::add(std::size_t col, double z) {
    if (z < value) {
        next = value;
        value = z;
        cells = 0;
        std::ranges::fill(run, 0);
        block.reset();
    } else if (z > value && z < next) {
        next = z;
    }
    cells += z == value ? 1 : 0;
    run[col] = z == value ? run[col] + 1 : 0;
}

void UndeclaredNodata::Extreme::end_row(std::int64_t row) {
    std::int64_t wide = 0;
    for (std::size_t col = 0; col < run.size() && !block; ++col) {
        wide = run[col] >= block_side ? wide + 1 : 0;
        if (wide == block_side) {
            block = {static_cast<std::int64_t>(col) - 1, row - 1};
        }
    }
}

void UndeclaredNodata::note_sentinel(std::int64_t col, double z) {
    bool const is_sentinel = std::ranges::find(no_terrain, z) != no_terrain.end();
    for (Sentinel& s : sentinels_) {
        if (z == s.value) {
            s.first = s.count == 0 ? std::array{col, row_} : s.first;
            ++s.count;
        }
        s.is_depth =
            s.is_depth || (!is_sentinel && s.value < 0.0 && s.value > deepest_sea && z < s.value && z > deepest_sea);
    }
}

void UndeclaredNodata::add_row(std::span<double const> stored) {
    constexpr double deep = -9000.0;
    if (searches_) {
        for (std::size_t col = 0; col < stored.size(); ++col) {
            double const z = stored[col];
            if (z < deep || z == no_terrain.back()) {
                note_sentinel(static_cast<std::int64_t>(col), z);
            }
            if (searches_blocks_) { // NaN is skipped by both
                low_.add(col, z);
                high_.add(col, -z);
            }
        }
        if (searches_blocks_) {
            low_.end_row(row_);
            high_.end_row(row_);
        }
    }
    ++row_;
}

std::optional<Finding> UndeclaredNodata::require_none(std::string const& what, std::string const& path) const {
    for (Sentinel const& s : sentinels_) {
        if (s.count > 0 && !s.is_depth) {
            throw BadInput(fmt::format("{} has {} cells of {:g}, the first at column {}, row {}: no terrain has this "
                                       "height, and the file does not declare it as no-data. If it is, {}; --nodata "
                                       "nan takes it as a height",
                                       what, s.count, s.value, s.first[0], s.first[1], remedy(s.value, path)));
        }
    }
    double const gap_below = low_.next - low_.value;
    double const gap_above = high_.next - high_.value;
    double const range_above = -high_.value - low_.next;
    double const range_below = -high_.next - low_.value;
    std::optional<Finding> doubt;
    auto const refuse = [&](Extreme const& e, double value, double gap, double range) {
        if (!e.block || !std::isfinite(gap) || !(range > 0.0)) {
            return;
        }
        bool const is_zero = value == 0.0;
        if (is_zero ? gap * metres_ > steepest_coast_m : gap > range) {
            throw BadInput(fmt::format("{} has a block of cells of {:.9g} around column {}, row {}, {:.6g} apart from "
                                       "every other value, and these differ by {:.6g} only: it looks like no-data "
                                       "that the file does not declare. If it is, {}; if it is terrain, use --nodata "
                                       "nan, or declare another value",
                                       what, value, (*e.block)[0], (*e.block)[1], gap, range, remedy(value, path)));
        }
        if (is_zero && gap > range && gap * metres_ > doubtful_coast_m) {
            doubt = Finding{.kind = "zero_heights",
                            .amount = static_cast<double>(e.cells),
                            .text = fmt::format("{} cells of 0, around column {}, row {}, lie {:.4g} m apart from all "
                                                "other heights, which differ by {:.4g} m",
                                                e.cells, (*e.block)[0], (*e.block)[1], gap * metres_, range * metres_)};
        }
    };
    refuse(low_, low_.value, gap_below, range_above);
    refuse(high_, -high_.value, gap_above, range_below);
    return doubt;
}

} // namespace thalweg::io
