// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

using CellIndex = std::int64_t; ///< place of a cell in a grid, row by row from the north-west; -1 for none

/// A cell by its column (to the east) and row (to the south), both from 0.
struct Cell {
    std::int64_t col = 0;
    std::int64_t row = 0;
    friend bool operator==(Cell const&, Cell const&) = default;
};

/// The frame of a raster: square cells, cell (0, 0) in the north-west.
struct Grid {
    std::int64_t width = 0;  ///< [cells]
    std::int64_t height = 0; ///< [cells]
    double cell_m = 1.0;     ///< [m] side of a cell
    double west = 0.0;       ///< [m] outer edge of column 0
    double north = 0.0;      ///< [m] outer edge of row 0
    std::string crs;         ///< "EPSG:32631" or WKT, projected, metres; "" for none

    friend bool operator==(Grid const&, Grid const&) = default;

    std::int64_t cells() const { return width * height; }
    bool contains(Cell c) const { return c.col >= 0 && c.row >= 0 && c.col < width && c.row < height; }
    std::int64_t index(Cell c) const { return c.row * width + c.col; }
    Cell at(std::int64_t index) const { return {index % width, index / width}; }
    bool on_border(Cell c) const { return c.col == 0 || c.row == 0 || c.col == width - 1 || c.row == height - 1; }

    Vec2 centre(Cell c) const {
        return {west + (static_cast<double>(c.col) + 0.5) * cell_m,
                north - (static_cast<double>(c.row) + 0.5) * cell_m};
    }
    /// Finds the cell of a position. One on the grid's outer edge lies in the outermost cell.
    /// \param p [m]
    /// \return may lie outside the grid
    Cell cell_of(Vec2 p) const {
        auto const col = static_cast<std::int64_t>(std::floor((p.x - west) / cell_m));
        auto const row = static_cast<std::int64_t>(std::floor((north - p.y) / cell_m));
        return {col == width && p.x <= east() ? col - 1 : col, row == height && p.y >= south() ? row - 1 : row};
    }
    double east() const { return west + static_cast<double>(width) * cell_m; }
    double south() const { return north - static_cast<double>(height) * cell_m; }
};

/// One value per cell, row-major from the north-west. In a Raster<float> of heights [m] NaN means no data.
template <class T> class Raster {
public:
    Raster() = default;
    explicit Raster(Grid frame, T fill = T{})
        : grid_(std::move(frame)), own_(static_cast<std::size_t>(grid_.cells()), fill), values_(own_) {}

    /// Shows memory of others as a raster. Nothing may be written through it: a stage takes it by const&; what is moved
    /// from it still shows that memory, and a copy has its own.
    /// \param frame its grid
    /// \param values one per cell
    /// \param owner keeps the memory alive
    /// \return the raster, not copied
    static Raster view_of(Grid frame, std::span<T const> values, std::shared_ptr<void const> owner) {
        return {std::move(frame), {const_cast<T*>(values.data()), values.size()}, std::move(owner)};
    }

    Raster(Raster const& other) : grid_(other.grid_), own_(other.values_.begin(), other.values_.end()), values_(own_) {}
    Raster(Raster&& other) noexcept
        : grid_(std::exchange(other.grid_, {})), own_(std::exchange(other.own_, {})),
          values_(std::exchange(other.values_, {})), owner_(std::exchange(other.owner_, {})) {}
    Raster& operator=(Raster const& other) {
        if (this != &other) {
            *this = Raster(other);
        }
        return *this;
    }
    Raster& operator=(Raster&& other) noexcept {
        Raster taken(std::move(other)); // other is empty afterwards, unless it is this raster
        grid_ = std::move(taken.grid_);
        own_ = std::move(taken.own_);
        values_ = taken.values_;
        owner_ = std::move(taken.owner_);
        return *this;
    }
    ~Raster() = default;

    Grid const& grid() const { return grid_; }
    std::int64_t width() const { return grid_.width; }
    std::int64_t height() const { return grid_.height; }
    std::int64_t cells() const { return grid_.cells(); }

    T& operator[](std::int64_t i) { return values_[i]; }
    T const& operator[](std::int64_t i) const { return values_[i]; }
    T& operator[](Cell c) { return (*this)[grid_.index(c)]; }
    T const& operator[](Cell c) const { return (*this)[grid_.index(c)]; }

    std::span<T> row(std::int64_t r) {
        return values_.subspan(static_cast<std::size_t>(r * width()), static_cast<std::size_t>(width()));
    }
    std::span<T const> row(std::int64_t r) const {
        return values_.subspan(static_cast<std::size_t>(r * width()), static_cast<std::size_t>(width()));
    }
    std::span<T> values() { return values_; }
    std::span<T const> values() const { return values_; }

private:
    Raster(Grid frame, std::span<T> values, std::shared_ptr<void const> owner)
        : grid_(std::move(frame)), values_(values), owner_(std::move(owner)) {}

    Grid grid_;
    std::vector<T, LargePages<T>> own_;
    std::span<T> values_;               ///< own_, or memory of others
    std::shared_ptr<void const> owner_; ///< of that memory
};

/// 1: marked, 0: not.
using Mask = Raster<std::uint8_t>;

/// Heights [m] of the river cells, NaN elsewhere: the constraint of a surface.
struct Valley {
    Raster<float> z;
};

/// Heights [m] of the cells that constrain a surface (rivers, ridges and points); NaN elsewhere.
struct Skeleton {
    Raster<float> z;
};

} // namespace thalweg
