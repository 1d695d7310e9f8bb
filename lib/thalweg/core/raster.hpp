// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/run/large_pages.hpp>

namespace thalweg {

/// One value per cell, row-major from the north-west. In a Raster<float> of heights [m] NaN means no data.
template <class T> class Raster {
public:
    Raster() = default;
    explicit Raster(Grid frame, T fill = T{})
        : grid_(std::move(frame)), values_(static_cast<std::size_t>(grid_.cells()), fill) {}

    Grid const& grid() const { return grid_; }
    std::int64_t width() const { return grid_.width; }
    std::int64_t height() const { return grid_.height; }
    std::int64_t cells() const { return grid_.cells(); }

    T& operator[](std::int64_t i) { return values_[static_cast<std::size_t>(i)]; }
    T const& operator[](std::int64_t i) const { return values_[static_cast<std::size_t>(i)]; }
    T& operator[](Cell c) { return (*this)[grid_.index(c)]; }
    T const& operator[](Cell c) const { return (*this)[grid_.index(c)]; }

    std::span<T> row(std::int64_t r) {
        return std::span<T>(values_).subspan(static_cast<std::size_t>(r * width()), static_cast<std::size_t>(width()));
    }
    std::span<T const> row(std::int64_t r) const {
        return std::span<T const>(values_).subspan(static_cast<std::size_t>(r * width()),
                                                   static_cast<std::size_t>(width()));
    }
    std::span<T> values() { return values_; }
    std::span<T const> values() const { return values_; }

private:
    Grid grid_;
    std::vector<T, LargePages<T>> values_;
};

/// 1: marked, 0: not.
using Mask = Raster<std::uint8_t>;

} // namespace thalweg
