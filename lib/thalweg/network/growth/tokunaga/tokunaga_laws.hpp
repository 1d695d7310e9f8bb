// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg::network {

/// How many side branches a refinement adds to an interior link.
enum class SideRule : std::uint8_t {
    tokunaga, ///< by the stream's order, so that T_k = a c^(k-1) for every k in expectation
    constant, ///< P_t (lambda - 1), as published: correct for T_1 and T_2 only
    plane     ///< c - 1: the fractal dimension is exactly 2
};

/// The Tokunaga laws of a generator.
struct TokunagaLaws {
    double a = 0.0;           ///< T_1: side branches of the next lower order
    double c = 0.0;           ///< T_k = a c^(k-1); c^2 = c + lambda
    double share = 0.0;       ///< P_t = c / lambda
    double bifurcation = 0.0; ///< R_B: bifurcation ratio
};

/// Computes the laws of a self-similar network in closed form.
/// \param lambda [1, 50] the generator's number
/// \return a = lambda - 1, c = (1 + sqrt(1 + 4 lambda)) / 2, and share and bifurcation from these
/// \throws BadParameter when lambda is outside its range
///
/// Source: \cite nenu2015, equations 1 to 8 (\cite tokunaga1978; Zhang et al. 2009); R_B: \cite peckham1995.
TokunagaLaws tokunaga_laws(int lambda);

/// The mean number of side branches that one refinement adds to an interior link.
/// \param lambda [1, 50] the generator's number
/// \param rule how side branches are distributed
/// \param order [2, ...] Strahler order of the link's stream
/// \return for SideRule::tokunaga, with t = order - 1: a c^t / (lambda + a c (c^(t-1) - 1) / (c - 1))
double mean_side_branches(int lambda, SideRule rule, int order);

} // namespace thalweg::network
