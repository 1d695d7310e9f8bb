// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

/// Private to this module.
namespace thalweg::network {

inline double smooth_step(double t) {
    double const u = std::clamp(t, 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

} // namespace thalweg::network
