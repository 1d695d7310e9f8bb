// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/raster/raster_files.hpp>

class GDALRasterBand;

namespace thalweg::io {

// Plausibility checks of a raster.

/// No landscape is so high; a damaged DEFLATE tile is read without an error and contains such numbers.
inline constexpr double implausible_height = 1e30;

/// Whether cells of dx x dy, both above 0, count as squares: their sides are equal up to rounding in the file, or
/// differ by less than 0.1 %, and over the whole raster by less than a tenth of a cell.
inline bool are_squares(double dx, double dy, int width, int height) {
    double const off = std::fabs(dx - dy);
    bool const is_rounded = off <= 1e-6 * dx;
    return is_rounded || (off <= 1e-3 * dx && off * std::max(width, height) < 0.1 * std::min(dx, dy));
}

// Values of cells without heights that the file does not declare as no-data.

/// Whether a stored value equals the one given by a user: floats in files have more digits than people type.
bool stands_for(double stored, double named);

/// Whether a file declares which of a band's cells have data: by a no-data value, a mask or alpha.
bool declares_nodata(GDALRasterBand& band);

/// The message for a value beyond implausible_height.
std::string implausible_words(std::int64_t col, std::int64_t row, double stored);

/// Reads a raster's values row by row and detects those that no terrain has: -9999 and the like; among heights also the
/// lowest or highest value if it is not 0, fills a block of 3 x 3 cells, and is farther from the next value than the
/// others are apart.
class UndeclaredNodata {
public:
    /// Does not search if params has a no-data value; searches no blocks if the file declares one.
    UndeclaredNodata(int width, ReadDemParams const& params, bool is_declared);

    /// Processes the next row: stored values, NaN: declared as no-data.
    void add_row(std::span<double const> stored);
    /// what: "io.read_dem: FILE". Throws BadInput naming the value, its first cell and the remedy.
    void require_none(std::string const& what, std::string const& path) const;

private:
    /// The lowest value so far; of negated values the highest.
    struct Extreme {
        double value = std::numeric_limits<double>::infinity();
        double next = std::numeric_limits<double>::infinity();
        std::vector<std::int32_t> run;                    ///< by column: number of consecutive cells with the value
        std::optional<std::array<std::int64_t, 2>> block; ///< column and row of its centre

        void add(std::size_t col, double z);
        void end_row(std::int64_t row);
    };
    struct Sentinel {
        double value = 0.0;
        std::int64_t count = 0;
        std::array<std::int64_t, 2> first{};
        bool is_depth = false; ///< other cells are slightly deeper: the sea
    };

    void note_sentinel(std::int64_t col, double z);

    bool searches_ = true;
    bool searches_blocks_ = true;
    std::int64_t row_ = 0;
    Extreme low_;
    Extreme high_;
    std::array<Sentinel, 4> sentinels_;
};

} // namespace thalweg::io
