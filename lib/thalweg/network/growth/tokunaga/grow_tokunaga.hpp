// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

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
    Indexed<LinkId, TreeLink> links;
    double link_length = 1.0; ///< of every link, relative to a generator's trunk: c^-(order - 2)
};

/// Grows a self-similar river network by refinement: every source becomes a generator, every other link a chain with
/// side branches, whose mean number is rounded up or down at random.
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a binary tree of the given order; its side branches have the means T_k = a c^(k-1), exactly so for lambda =
/// 2. One source more than other links. Random numbers are a hash of (seed, refinement, link).
/// \throws BadParameter when a parameter is outside its range or the tree has more than max_links links
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 2.1, equations 1 to 6.
TokunagaTree grow_tokunaga(TokunagaParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
