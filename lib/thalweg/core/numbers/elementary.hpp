// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

/// Elementary functions with the same bits on every machine: only + - * / and sqrt, no libm, no contraction. Each is
/// within 2 ulp of the true value on its range.
namespace thalweg::portable {

inline constexpr double pi = 3.14159265358979323846;

/// The exponential function.
/// \param x any number
/// \return infinity above 709.78, 0 below -745.13
double exp(double x);
/// The natural logarithm.
/// \param x >= 0
/// \return -infinity at 0, NaN below
double log(double x);
/// The power x^y.
/// \param x >= 0
/// \param y any number
/// \return NaN for x < 0
double pow(double x, double y);
/// The sine.
/// \param x [rad] |x| <= 1e5
/// \return NaN outside the range
double sin(double x);
/// The cosine.
/// \param x [rad] |x| <= 1e5
/// \return NaN outside the range
double cos(double x);
/// The angle of the vector (x, y).
/// \param y,x components
/// \return [rad] in [-pi, pi]
double atan2(double y, double x);

} // namespace thalweg::portable
