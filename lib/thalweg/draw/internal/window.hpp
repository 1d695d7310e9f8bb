// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>
#include <thalweg/draw/internal/canvas.hpp>

namespace thalweg::draw {

/// The part of the ground that a map shows, and where on the sheet. Private to this module.
struct Window {
    Box frame;             ///< [px]
    double west = 0.0;     ///< [m] of the frame's left side
    double north = 0.0;    ///< [m] of the frame's upper side
    double px_per_m = 1.0; ///< > 0

    Vec2 at(Vec2 ground) const {
        return {frame.x + (ground.x - west) * px_per_m, frame.y + (north - ground.y) * px_per_m};
    }
    double east() const { return west + frame.width / px_per_m; }
    double south() const { return north - frame.height / px_per_m; }
};

} // namespace thalweg::draw
