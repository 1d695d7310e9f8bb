// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>

namespace valleys {

using namespace thalweg;

inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Valley cells at random, at least one; heights in steps of 1/8 with ties, -0 and +0 among them, or arbitrary.
inline Valley by_chance(std::int64_t width, std::int64_t height, double share, std::uint64_t seed) {
    Valley valley{Raster<float>(test::frame_below(width, height), nan)};
    bool const stepped = seed % 2 == 0;
    auto const put = [&](std::int64_t i) {
        double const u = unit(random_word(seed, 2, static_cast<std::uint64_t>(i)));
        double const z = stepped ? std::floor(16.0 * u) / 8.0 - 1.0 : 50.0 * u - 10.0;
        valley.z[i] = z == 0.0 && i % 2 == 0 ? -0.0F : static_cast<float>(z);
    };
    for (std::int64_t i = 0; i < valley.z.cells(); ++i) {
        if (unit(random_word(seed, 1, static_cast<std::uint64_t>(i))) < share) {
            put(i);
        }
    }
    put(static_cast<std::int64_t>(random_word(seed, 3) % static_cast<std::uint64_t>(valley.z.cells())));
    return valley;
}

/// The same for rapidcheck: sides 1 .. longest, shares from lonely cells to crowds.
inline Valley any(std::int64_t longest) {
    auto const width = *rc::gen::inRange<std::int64_t>(1, longest + 1).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, longest + 1).as("height");
    double const share = *rc::gen::element(0.0, 0.01, 0.1, 0.6).as("share");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    return by_chance(width, height, share, seed);
}

/// A mask for a valley: barriers at random, at least one valley cell inside.
inline Mask barriers(Valley const& valley, double share, std::uint64_t seed) {
    Mask inside(valley.z.grid(), 1);
    std::int64_t kept = -1;
    for (std::int64_t i = 0; i < inside.cells(); ++i) {
        inside[i] = unit(random_word(seed, 4, static_cast<std::uint64_t>(i))) < share ? 0 : 1;
        kept = std::isnan(valley.z[i]) ? kept : i;
    }
    inside[kept] = 1;
    return inside;
}

/// What the paper says, read aloud: for x = 1, 2, ... the whole grid is scanned; a cell that is not finished and has
/// finished 4-neighbours gets the least of their heights plus dh(x) and is READY; after the scan READY is FINISHED.
inline std::vector<double> literal_dilation(Valley const& valley, Mask const& inside, std::vector<double> const& dh) {
    enum class State { open, ready, finished };
    Grid const& grid = valley.z.grid();
    std::vector<double> z(static_cast<std::size_t>(grid.cells()), std::numeric_limits<double>::quiet_NaN());
    std::vector<State> state(z.size(), State::open);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (inside[i] != 0 && !std::isnan(valley.z[i])) {
            z[static_cast<std::size_t>(i)] = static_cast<double>(valley.z[i]);
            state[static_cast<std::size_t>(i)] = State::finished;
        }
    }
    for (double const rise : dh) {
        for (std::int64_t row = 0; row < grid.height; ++row) {
            for (std::int64_t col = 0; col < grid.width; ++col) {
                auto const here = static_cast<std::size_t>(grid.index({col, row}));
                if (state[here] != State::open || inside[{col, row}] == 0) {
                    continue;
                }
                double least = std::numeric_limits<double>::infinity();
                for (Cell const near : {Cell{col - 1, row}, {col + 1, row}, {col, row - 1}, {col, row + 1}}) {
                    if (grid.contains(near) && state[static_cast<std::size_t>(grid.index(near))] == State::finished) {
                        least = std::min(least, z[static_cast<std::size_t>(grid.index(near))]);
                    }
                }
                if (std::isfinite(least)) {
                    z[here] = least + rise;
                    state[here] = State::ready;
                }
            }
        }
        for (State& s : state) {
            s = s == State::ready ? State::finished : s;
        }
    }
    return z;
}

} // namespace valleys
