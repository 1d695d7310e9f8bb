// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>

// Idea: A river network looks alike at every scale: in the mean a stream has T_k side branches k
// orders below its own, and T_k = a c^(k-1). To grow such a tree, start with one link and refine:
// every source link becomes a generator (a trunk of lambda links, lambda - 1 side branches and two
// sources), every other link a chain with side branches of its own. A refinement raises all orders
// by one, so an old side branch keeps its place in the law and the new ones enter as the lowest
// order. The mean number of side branches that a link gets decides the law: constant means give T_1
// and T_2 only; with a mean that follows the order of the link's stream (SideRule::tokunaga) the
// recursion closes for every k.
// Source: Northeast Normal University 2015, section 2.1, equations 1 to 6 (Tokunaga 1978); the mean
// by order and its measured T_k are ours: docs/rivers.md, "What the thesis prints and what holds".
// R_B: Peckham 1995.
// Cost: O(n) time and memory for n links, 32 bytes a link of the result; n grows by about R_B with
// each order, which is why max_links exists. One thread.
// Not for: places of rivers. This is topology alone: embed_tree.hpp and grow_strokes.hpp draw it.
// Lambda = 1 has no side branches; lambda = 2 (R_B = 4) suits most rivers.
// Example:
//     TokunagaTree const tree = grow_tokunaga({.seed = 1, .generator = 2, .order = 6});
//     // tree.links[0] is the link at the outlet, of order 6
//     double const expected = tokunaga_laws(2).bifurcation; // 4
// More: docs/rivers.md, "Networks".

namespace thalweg::growth {

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

/// The banks at which side branches enter.
enum class BankRule : std::uint8_t {
    alternating, ///< as in the rules of the L-system
    random       ///< left or right with equal probability
};

/// Options of grow_tokunaga().
struct TokunagaParams {
    std::uint64_t seed = 7;
    int generator = 2; ///< [1, 50] lambda: 1 has no side branches, large values make a feathered network
    int order = 5;     ///< [1, 30] Strahler order of the outlet; each refinement raises it by one
    SideRule rule = SideRule::tokunaga; ///< side branches of an interior link
    BankRule banks = BankRule::random;  ///< their banks
    std::int64_t max_links = 2'000'000; ///< [1, ...] larger networks are rejected
};

using LinkId = std::int64_t; ///< number of a link of a tree: 0, 1, ... from downstream; -1: none

/// A link: a piece of river between two junctions, or from a source to the first.
struct TreeLink {
    LinkId down = -1; ///< the link downstream, a lower number; -1: the outlet
    /// the links upstream, first the one that continues the stream; -1, -1: a source
    std::array<LinkId, 2> up{{-1, -1}};
    int order = 1; ///< Strahler order
    /// relative to the link below, looking upstream: 0 straight on; 1, -1 left and right of a fork; 2, -2 a side branch
    /// from the left and right
    int turn = 0;
};

/// The topology of a network: a binary tree of links, the outlet's first.
struct TokunagaTree {
    std::vector<TreeLink> links;
    double link_length = 1.0; ///< of every link, relative to a generator's trunk: c^-(order - 2)
};

/// Grows a self-similar river network by refinement: every source becomes a generator, every other link a chain with
/// side branches, whose mean number is rounded up or down at random.
/// \return a binary tree of the given order; its side branches have the means T_k = a c^(k-1), exactly so for lambda =
/// 2. One source more than other links. Random numbers are a hash of (seed, refinement, link).
/// \throws BadParameter when a parameter is outside its range or the tree has more than max_links links
///
/// Source: \cite nenu2015, section 2.1, equations 1 to 6.
TokunagaTree grow_tokunaga(TokunagaParams const& params = {}, Run const& run = {});

} // namespace thalweg::growth
