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
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

// Values of cells without heights that the file does not declare as no-data.

/// No landscape is so high; a damaged DEFLATE tile is read without an error and contains such numbers.
inline constexpr double implausible_height = 1e30;

/// What no height is, and often stands for none. The smallest normal float is what GDAL's HF2 driver writes.
inline constexpr std::array<double, 7> no_terrain{
    -9999.0, -32767.0, -32768.0, -99999.0, std::numeric_limits<float>::min(), 32767.0, 65535.0};

/// Whether a stored value equals the one given by a user: floats in files have more digits than people type.
bool stands_for(double stored, double named);

/// The message for a value beyond implausible_height.
std::string implausible_words(std::int64_t col, std::int64_t row, double stored);

/// Reads a raster's values row by row and detects those that no terrain has: -9999, 65535 m and the like; among heights
/// also the lowest or highest value if it fills a block of 3 x 3 cells and is farther from the next value than the
/// others are apart. 0 is the sea: it counts only if the next height is more than 300 m away, which no coast is. It is
/// a doubt from 30 m on if the others differ by less, from 50 m on in any case, and, like the largest 16-bit numbers,
/// in single cells that lie more than 50 m from all cells around them.
class UndeclaredNodata {
public:
    /// Does not search if params has a no-data value; refuses no blocks if the file declares one.
    /// \param metres of a stored unit
    UndeclaredNodata(int width, ReadDemParams const& params, bool is_declared, double metres);

    /// Processes the next row: stored values, NaN: declared as no-data.
    void add_row(std::span<double const> stored);
    /// Call it once, after the last row. about: the file. Throws BadInput naming the value, its first cell
    /// and the remedy.
    /// \return the doubt about cells of 0, if there is one
    std::optional<Finding> require_none(About const& about, std::string const& path);

private:
    using Position = std::array<std::int64_t, 2>; ///< column and row

    /// The lowest value so far; of negated values the highest.
    struct Extreme {
        double value = std::numeric_limits<double>::infinity();
        double next = std::numeric_limits<double>::infinity();
        std::int64_t cells = 0;
        Position first{};
        std::vector<std::int32_t> run; ///< by column: number of consecutive cells with the value
        std::optional<Position> block; ///< its centre

        void add(Position at, double z);
        void end_row(std::int64_t row);
        double gap() const { return next - value; }
    };
    struct Sentinel {
        double value = 0.0;
        std::int64_t count = 0;
        Position first{};
        bool is_depth = false; ///< other cells are slightly deeper: the sea
    };

    void note_sentinel(std::int64_t col, double z);
    /// Counts single cells in the second of the last three rows.
    void note_single();
    void refuse_sentinels(About const& about, std::string const& path) const;
    /// \param value of the extreme, e.value or its negative
    /// \param range of all other values
    void refuse_block(Extreme const& e, double value, double range, About const& about, std::string const& path) const;
    std::optional<Finding> doubt_about(Extreme const& e, double range) const;

    bool searches_ = true;
    bool is_height_ = true;
    bool is_declared_ = false;
    double metres_ = 1.0;
    double highest_ = 0.0; ///< stored values above it are looked at
    std::int64_t row_ = 0;
    Extreme low_;
    Extreme high_;
    std::array<Sentinel, 7> sentinels_;
    std::array<std::vector<double>, 3> recent_; ///< the last three rows
    std::int64_t single_ = 0;
    Position first_single_{};
    double single_value_ = 0.0;
};

} // namespace thalweg::io
