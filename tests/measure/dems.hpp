// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>

using test::frame;

inline constexpr float hole = std::numeric_limits<float>::quiet_NaN();

inline thalweg::Raster<float> dem_of(std::int64_t width, std::vector<float> const& heights) {
    thalweg::Raster<float> dem(frame(width, static_cast<std::int64_t>(heights.size()) / width));
    std::copy(heights.begin(), heights.end(), dem.values().begin());
    return dem;
}

/// Independent heights in [0, 1).
inline thalweg::Raster<float> rough_dem(thalweg::Grid const& grid, std::uint64_t seed) {
    thalweg::Raster<float> dem(grid);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(thalweg::unit(thalweg::random_word(seed, static_cast<std::uint64_t>(i))));
    }
    return dem;
}

/// Every number of [least, beyond) as likely: rapidcheck's own range keeps to small ones.
template <class T> rc::Gen<T> evenly(T least, T beyond) {
    return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, beyond));
}

/// Any DEM up to side x side: few whole heights, so that ties, flats and depressions abound; up to holes_percent holes.
inline rc::Gen<thalweg::Raster<float>> gen_dem(std::int64_t side, int holes_percent) {
    return rc::gen::exec([=] {
        auto const width = *evenly<std::int64_t>(1, side + 1);
        auto const height = *evenly<std::int64_t>(1, side + 1);
        auto const levels = *rc::gen::element(1, 2, 4, 1000);
        auto const holes = *evenly(0, holes_percent + 1);
        thalweg::Raster<float> dem(frame(width, height));
        for (float& z : dem.values()) {
            bool const none = *evenly(0, 100) < holes;
            z = none ? hole : static_cast<float>(*evenly(-levels, levels));
        }
        return dem;
    });
}
