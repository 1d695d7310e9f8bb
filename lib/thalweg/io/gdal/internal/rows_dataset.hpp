// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {

/// Gives a part of a row, from a column on.
template <class T> using RowPart = std::function<void(std::int64_t row, std::int64_t col, std::span<T> part)>;

/// Shows rows to GDAL as a data set of one band, which asks for them when it is read and keeps none. Needs a Driver
/// that outlives it.
/// \param width [cells] [1, 2^31)
/// \param height [cells] likewise
/// \param no_data value of cells without data
/// \param part is called on the thread that reads
Dataset rows_dataset(std::int64_t width, std::int64_t height, float no_data, RowPart<float> part);
Dataset rows_dataset(std::int64_t width, std::int64_t height, std::int32_t no_data, RowPart<std::int32_t> part);

} // namespace thalweg::io
