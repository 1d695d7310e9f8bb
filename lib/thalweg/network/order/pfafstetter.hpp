// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

// Idea: A code that tells position without a map. The main stem of a basin has four largest
// tributaries: these get 2, 4, 6, 8 from the mouth up, the reaches between them 1, 3, 5, 7, 9. Each
// part is divided likewise, and its digit is appended. So codes that agree in their first digits
// lie in one basin, and from the first digit that differs one reads which of two links lies
// downstream of the other.
// Source: Verdin and Verdin 1999.
// Cost: O(n d) for n links and d digits, at most `levels`. One thread.
// Not for: orders of size (order.hpp), or codes that stay when a tributary is added: they are
// relative to the network and its areas.
// Example:
//     std::vector<std::string> const codes = pfafstetter(down, area_m2, {.levels = 6});
// More: docs/measures.md, "Pfafstetter codes".

namespace thalweg::network {

/// Strahler and Shreve orders by link.
struct LinkOrders {
    std::vector<int> strahler;
    std::vector<std::int64_t> shreve;
};

/// Computes the orders of links.
/// \param down by link: the link downstream, numbered in any order; -1: none
/// \return orders as network::order
/// \throws BadInput for a link that does not exist or links in a circle
LinkOrders order_links(std::vector<std::int64_t> const& down);

/// Options of pfafstetter().
struct PfafstetterParams {
    int levels = 9; ///< [1, 18] maximum number of digits
};

/// Codes the links of each basin by Pfafstetter's system. The main stem, upstream along the largest areas (ties: lower
/// link), has four largest tributaries; they get 2, 4, 6, 8 from the mouth up, the main stem's reaches between them,
/// with all lesser tributaries, 1, 3, 5, 7, 9. Each part is divided likewise at the next digit until it has no
/// tributary; with fewer than four tributaries the digits end earlier.
/// \param down by link: the link downstream, numbered in any order; -1: none
/// \param area_m2 by link: contributing area at its downstream end; not above 0, or NaN: unknown, the smallest
/// \return by link; each basin begins its own codes; "": a basin without tributaries
/// \throws BadParameter when levels is outside its range
/// \throws BadInput for a link that does not exist, links in a circle, or another number of areas
///
/// Source: \cite verdin1999.
std::vector<std::string> pfafstetter(std::vector<std::int64_t> const& down, std::vector<double> const& area_m2,
                                     PfafstetterParams const& params = {});

} // namespace thalweg::network
