// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/network/import/internal/import_lines.hpp>

/// Which of several channels is the main one. Private to this module.
namespace thalweg::network::import_steps {

/// [m] By node: total length of the pieces upstream, which a place with several ways down shares out equally among
/// them; without what runs in a circle.
std::vector<double> lengths_above(Pieces const& p, Divided const& divided);

/// The piece that is the main branch among those that leave a node: see network::adopt.
/// Takes: lengths_above of it; the branches, one at least, whose directions are known.
std::size_t main_of(Pieces const& p, std::vector<RiverLine> const& lines, Divided const& divided,
                    std::vector<double> const& length_above, std::size_t node,
                    std::vector<std::size_t> const& branches);

} // namespace thalweg::network::import_steps
