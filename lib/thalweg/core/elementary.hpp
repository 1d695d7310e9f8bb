// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Elementary functions with the same bits on every machine: only + - * / and sqrt, no libm, no contraction.
/// Each is within 2 units in the last place of the true value on its range.
namespace thalweg::exact {

inline constexpr double pi = 3.14159265358979323846;

double exp(double x);           ///< x in [-700, 700]; beyond, 0 or infinity
double log(double x);           ///< x > 0
double pow(double x, double y); ///< x > 0
double sin(double x);           ///< |x| <= 1e5 [rad]
double cos(double x);           ///< |x| <= 1e5 [rad]
double atan2(double y, double x);

} // namespace thalweg::exact
