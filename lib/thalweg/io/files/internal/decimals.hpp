// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace thalweg::io {

// Decimals in a shapefile: more than a double at 1e6 m carries, few enough for 1e13 m or 1e16 m2.
inline constexpr int length_decimals = 9;
inline constexpr int area_decimals = 6;
inline constexpr int slope_decimals = 15;

} // namespace thalweg::io
