// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Elementary functions with the same bits on every machine: only + - * / and sqrt, no libm, no contraction.
/// Each is within 2 units in the last place of the true value on its range.
namespace thalweg::portable {

inline constexpr double pi = 3.14159265358979323846;

/// \param x x
/// \return infinity above 709.78, 0 below -745.13
double exp(double x);
/// \param x x
/// \return x > 0; -infinity at 0, NaN below
double log(double x);
/// \param x x
/// \param y y
/// \return x >= 0; NaN below
double pow(double x, double y);
/// \param x x
/// \return |x| <= 1e5 [rad]; NaN beyond
double sin(double x);
/// \param x x
/// \return |x| <= 1e5 [rad]; NaN beyond
double cos(double x);
/// \param y y
/// \param x x
/// \return [rad] in [-pi, pi]
double atan2(double y, double x);

} // namespace thalweg::portable
