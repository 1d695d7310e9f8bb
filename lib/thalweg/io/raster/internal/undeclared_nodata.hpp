// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

// Values of cells without heights that the file does not declare as no-data.

/// No landscape is so high; a damaged DEFLATE tile is read without an error and contains such numbers.
inline constexpr double implausible_height = 1e30;

/// Whether a stored value equals the one given by a user: floats in files have more digits than people type.
bool stands_for(double stored, double named);

/// The message for a value beyond implausible_height.
std::string implausible_words(std::int64_t col, std::int64_t row, double stored);

/// Reads a raster's values row by row and detects those that no terrain has: -9999 and the like; among heights also the
/// lowest or highest value if it fills a block of 3 x 3 cells and is farther from the next value than the others are
/// apart. 0 is the sea: it counts only if the next height is more than 300 m away, which no coast is; from 30 m on it
/// is a doubt.
class UndeclaredNodata {
public:
    /// Does not search if params has a no-data value; searches no blocks if the file declares one.
    /// \param metres of a stored unit
    UndeclaredNodata(int width, ReadDemParams const& params, bool is_declared, double metres);

    /// Processes the next row: stored values, NaN: declared as no-data.
    void add_row(std::span<double const> stored);
    /// what: "io.read_dem: FILE". Throws BadInput naming the value, its first cell and the remedy.
    /// \return the doubt about cells of 0, if there is one
    std::optional<Finding> require_none(std::string const& what, std::string const& path) const;

private:
    /// The lowest value so far; of negated values the highest.
    struct Extreme {
        double value = std::numeric_limits<double>::infinity();
        double next = std::numeric_limits<double>::infinity();
        std::int64_t cells = 0;
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
    double metres_ = 1.0;
    std::int64_t row_ = 0;
    Extreme low_;
    Extreme high_;
    std::array<Sentinel, 5> sentinels_;
};

} // namespace thalweg::io
