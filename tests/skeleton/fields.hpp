// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>

#include <support.hpp>

#include <thalweg/core/raster.hpp>

using test::frame;

/// Mean product of a field, whose mean is known to be 0, with itself at a distance.
inline double covariance(thalweg::Raster<float> const& field, std::int64_t dx, std::int64_t dy) {
    double sum = 0.0;
    std::int64_t pairs = 0;
    for (std::int64_t r = 0; r < field.height(); ++r) {
        for (std::int64_t c = 0; c < field.width(); ++c) {
            thalweg::Cell const other{c + dx, r + dy};
            if (field.grid().contains(other)) {
                sum += static_cast<double>(field[thalweg::Cell{c, r}]) * field[other];
                ++pairs;
            }
        }
    }
    return sum / static_cast<double>(pairs);
}
