// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::network {

/// Links of the stream that runs from the outlet to its fork or source, by number, upstream.
std::vector<std::size_t> trunk_of(TokunagaTree const& tree);

/// Chooses the banks of the trunk's side branches so that the links on either side are in proportion to the land there:
/// the largest branch first, each to the side that lacks the more.
/// Takes: a tree and the share of the land on the left of its trunk, looking upstream, in [0, 1].
/// Gives: the same tree but for the turns of those branches; the links on the left differ from their share of all
/// beside the trunk by at most those of the largest branch or of a branch of its fork. Throws: BadParameter when
/// share_left lies outside.
void balance_banks(TokunagaTree& tree, double share_left);

} // namespace thalweg::network
