// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg::network {

/// How many side branches an interior link gets when a network is refined.
enum class SideRule : std::uint8_t {
    tokunaga, ///< by the order of its stream, so that T_k = a c^(k-1) for every k in the mean
    constant, ///< P_t (lambda - 1) for all, as printed: right for T_1 and T_2 only
    plane     ///< c - 1 for all: the dimension is exactly 2
};

/// What a generator promises of its network.
struct TokunagaLaws {
    double a = 0.0;           ///< side branches of the next lower order, T_1
    double c = 0.0;           ///< their growth by order, T_k = a c^(k-1); c^2 = c + lambda
    double share = 0.0;       ///< P_t = c / lambda
    double bifurcation = 0.0; ///< R_B: streams of an order for each of the next higher
};

/// The closed forms of a self-similar network.
/// \param lambda lambda, [1, 50] the number of the generator
/// \return a = lambda - 1, c = (1 + sqrt(1 + 4 lambda)) / 2 and what follows.
/// \throws BadParameter
///
/// Source: \cite nenu2015, equations 1 to 8 (\cite tokunaga1978; Zhang et al. 2009); R_B: \cite peckham1995.
TokunagaLaws tokunaga_laws(int lambda);

/// With t = order - 1: mu_t = a c^t / (lambda + a c (c^(t-1) - 1) / (c - 1)) for the rule `tokunaga`.
/// \param lambda [1, 50] number of the generator
/// \param rule how side branches are counted
/// \param order >= 2, Strahler order
/// \return mean number of side branches that an interior link of a stream of this order gets in one refinement. order:
/// [2, ...].
double mean_side_branches(int lambda, SideRule rule, int order);

} // namespace thalweg::network
