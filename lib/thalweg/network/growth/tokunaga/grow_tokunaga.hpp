// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/network/growth/tokunaga/tokunaga_laws.hpp>

namespace thalweg::network {

/// The banks on which side branches enter.
enum class BankRule : std::uint8_t {
    alternating, ///< as the rules of the L-system are written
    random       ///< each at random, either as likely
};

/// Options of grow_tokunaga().
struct TokunagaParams {
    std::uint64_t seed = 7;
    int generator = 2;                  ///< [1, 50] lambda: 1 has no side branches, many make a feathered network
    int order = 5;                      ///< [1, 30] Strahler order of the outlet; each refinement raises it by one
    SideRule rule = SideRule::tokunaga; ///< side branches of an interior link
    BankRule banks = BankRule::random;  ///< their banks
    std::int64_t max_links = 2'000'000; ///< [1, ...] a network of more is refused
};

using LinkId = std::int64_t; ///< number of a link of a tree: 0, 1, ... downstream first; -1 for none

/// A piece of river between two junctions, or from a source to the first of them.
struct TreeLink {
    LinkId down = -1;                   ///< the link it flows into, a lower number; -1 for the outlet's
    std::array<LinkId, 2> up{{-1, -1}}; ///< those that flow into it: the one that continues its stream first; -1,
                                        ///< -1 for a source
    int order = 1;                      ///< Strahler order
    int turn = 0; ///< against the link below: 0 straight on, 1 and -1 the left and right of a fork, 2 and -2 a side
                  ///< branch from the left and from the right, looking upstream
};

/// A network without places: a binary tree of links, that of the outlet first.
struct TokunagaTree {
    Indexed<LinkId, TreeLink> links;
    double link_length = 1.0; ///< of every link, for a trunk as long as that of the generator: c^-(order - 2)
};

/// Grows a self-similar river network by refining: every source becomes a generator, every other link a chain with side
/// branches, whose mean number is rounded up or down at random.
/// \param params the generator's number lambda and the order
/// \param run progress, log, stop token and number of threads
/// \return a binary tree of that order whose side branches have the means T_k = a c^(k-1), at random (seed, refinement,
/// link); for lambda = 2 exactly. One source more than other links.
/// \throws BadParameter also where the tree has more than max_links links
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 2.1, equations 1 to 6.
TokunagaTree grow_tokunaga(TokunagaParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
