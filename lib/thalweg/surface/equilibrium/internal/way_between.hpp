// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include <thalweg/core/cells/d8.hpp>

/// Private to this module.
namespace thalweg::surface {

/// The direction from a cell to its neighbour, as d8_steps, or -1 when it is none. Takes: cells inside a frame.
inline std::int8_t way_between(std::size_t from, std::size_t to, std::int64_t width) {
    std::int64_t const step = static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from);
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        if (d8_steps[k].row * width + d8_steps[k].col == step) {
            return static_cast<std::int8_t>(k);
        }
    }
    return -1;
}

} // namespace thalweg::surface
