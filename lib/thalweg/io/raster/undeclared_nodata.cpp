// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {
namespace {

constexpr double highest_land_m = 30000.0; // of any planet
constexpr double deepest_sea = -12000.0;
constexpr std::int32_t block_side = 3;
constexpr double steepest_coast_m = 300.0; // over one cell, along all of a coast
constexpr double doubtful_coast_m = 30.0;
constexpr double steep_coast_m = 50.0;

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
    : searches_(!params.nodata), is_height_(params.values == CellValues::heights), is_declared_(is_declared),
      metres_(std::fabs(metres)),
      highest_(is_height_ ? highest_land_m / metres_ : std::numeric_limits<double>::infinity()) {
    low_.run.assign(static_cast<std::size_t>(width), 0);
    high_.run = low_.run;
    for (std::size_t i = 0; i < no_terrain.size(); ++i) {
        sentinels_[i].value = no_terrain[i];
    }
}

void UndeclaredNodata::Extreme::add(Position at, double z) {
    if (z < value) {
        next = value;
        value = z;
        cells = 0;
        first = at;
        std::ranges::fill(run, 0);
        block.reset();
    } else if (z > value && z < next) {
        next = z;
    }
    auto const col = static_cast<std::size_t>(at[0]);
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

void UndeclaredNodata::note_single() {
    auto const& [above, row, below] = recent_;
    for (std::size_t col = 0; col < row.size(); ++col) {
        double const z = row[col];
        bool const is_void = z == 0.0 || z == 32767.0 || z == 65535.0;
        if (!is_void || (col > 0 && row[col - 1] == z)) {
            continue;
        }
        int far = 0;
        int near = 0;
        for (std::vector<double> const* const line : {&above, &row, &below}) {
            for (std::size_t at = col == 0 ? 0 : col - 1; at < std::min(col + 2, line->size()); ++at) {
                double const wall_m = std::fabs((*line)[at] - z) * metres_;
                far += wall_m > steep_coast_m ? 1 : 0; // NaN is neither
                near += wall_m <= steep_coast_m ? 1 : 0;
            }
        }
        constexpr int least = 3;         // a corner of the raster has as many
        if (far >= least && near == 1) { // itself
            first_single_ = single_ == 0 ? Position{static_cast<std::int64_t>(col), row_ - 2} : first_single_;
            single_value_ = single_ == 0 ? z : single_value_;
            ++single_;
        }
    }
}

void UndeclaredNodata::add_row(std::span<double const> stored) {
    constexpr double deep = -9000.0;
    if (!searches_) {
        return;
    }
    for (std::size_t col = 0; col < stored.size(); ++col) {
        double const z = stored[col];
        auto const at = static_cast<std::int64_t>(col);
        if (z < deep || z == std::numeric_limits<float>::min() || z > highest_) {
            note_sentinel(at, z);
        }
        if (is_height_) { // NaN is skipped by both
            low_.add({at, row_}, z);
            high_.add({at, row_}, -z);
        }
    }
    ++row_;
    if (is_height_) {
        low_.end_row(row_ - 1);
        high_.end_row(row_ - 1);
        std::rotate(recent_.begin(), recent_.begin() + 1, recent_.end());
        recent_[2].assign(stored.begin(), stored.end());
        note_single();
    }
}

void UndeclaredNodata::refuse_sentinels(About const& about, std::string const& path) const {
    for (Sentinel const& s : sentinels_) {
        if (s.count > 0 && !s.is_depth) {
            throw BadInput(about.where,
                           fmt::format("{} has {} cells of {:g}, the first at column {}, row {}: {}, and the file does "
                                       "not declare it as no-data. If it is, {}{}",
                                       about.name, s.count, s.value, s.first[0], s.first[1],
                                       is_height_ ? "no terrain has this height" : "this number stands for no-data",
                                       remedy(s.value, path),
                                       is_height_ ? "; --nodata nan takes it as a height" : "; else use another"));
        }
    }
}

void UndeclaredNodata::refuse_block(Extreme const& e, double value, double range, About const& about,
                                    std::string const& path) const {
    if (is_declared_ || !e.block || !std::isfinite(e.gap()) || !(range > 0.0)) {
        return;
    }
    if (value == 0.0 ? e.gap() * metres_ > steepest_coast_m : e.gap() > range) {
        throw BadInput(
            about.where,
            fmt::format("{} has a block of cells of {:.9g} around column {}, row {}, {:.6g} apart from every other "
                        "value, and these differ by {:.6g} only: it looks like no-data that the file does not declare. "
                        "If it is, {}; if it is terrain, use --nodata nan, or declare another value",
                        about.name, value, (*e.block)[0], (*e.block)[1], e.gap(), range, remedy(value, path)));
    }
}

std::optional<Finding> UndeclaredNodata::doubt_about(Extreme const& e, double range) const {
    double const gap_m = e.gap() * metres_;
    bool const is_coast = gap_m <= steep_coast_m && !(e.block && e.gap() > range && gap_m > doubtful_coast_m);
    if (e.value != 0.0 || !std::isfinite(gap_m) || is_coast || !(range > 0.0)) {
        return std::nullopt;
    }
    Position const at = e.block.value_or(e.first);
    return Finding{.kind = "zero_heights",
                   .amount = static_cast<double>(e.cells),
                   .text = fmt::format("{} cells of 0, around column {}, row {}, lie {:.4g} m apart from all other "
                                       "heights, which differ by {:.4g} m",
                                       e.cells, at[0], at[1], gap_m, range * metres_)};
}

std::optional<Finding> UndeclaredNodata::require_none(About const& about, std::string const& path) {
    refuse_sentinels(about, path);
    if (!searches_ || !is_height_) {
        return std::nullopt;
    }
    std::rotate(recent_.begin(), recent_.begin() + 1, recent_.end());
    recent_[2].clear();
    ++row_;
    note_single();
    double const range_above = -high_.value - low_.next;
    double const range_below = -high_.next - low_.value;
    refuse_block(low_, low_.value, range_above, about, path);
    refuse_block(high_, -high_.value, range_below, about, path);
    if (auto const low = doubt_about(low_, range_above)) {
        return low;
    }
    if (auto const high = doubt_about(high_, range_below)) {
        return high;
    }
    return single_ == 0
               ? std::nullopt
               : std::optional(Finding{
                     .kind = "zero_heights",
                     .amount = static_cast<double>(single_),
                     .text = fmt::format("{} single cells of {:g} or such, the first at column {}, row {}, lie "
                                         "more than {:g} m apart from all cells around them",
                                         single_, single_value_, first_single_[0], first_single_[1], steep_coast_m)});
}

} // namespace thalweg::io
