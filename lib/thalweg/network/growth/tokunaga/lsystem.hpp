// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::network {

/// Writes a network as the word of an L-system: F a link, G a source's link, [ ] a branch, + and - turns to the left
/// and right, doubled for side branches. For lambda = 2 and alternating banks the words are those of the axiom G and
/// the rules G -> F[--G]F[-G][+G], F -> F[++G]F.
/// \param tree a binary tree of links
/// \return its word, from the outlet upstream; write_lsystem(read_lsystem(word)) equals word
///
/// Source: \cite nenu2015, section 2.2; its rules F -> FF and F -> F[--G]F[-G][+G] violate eq. 1 and are corrected.
std::string write_lsystem(TokunagaTree const& tree);

/// Grows a network and writes its word: write_lsystem(grow_tokunaga(params)).
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return its word
/// \throws BadParameter as grow_tokunaga
/// \throws Cancelled
std::string lsystem(TokunagaParams const& params = {}, Run const& run = {});

/// Reads the word of an L-system.
/// \param word F, G, +, -, [ and ]; blanks are skipped. Two branches follow F, or one and the stream's next link
/// \return the tree, numbered in the word's order, with Strahler orders and link_length 1
/// \throws BadInput naming the position, from 1
TokunagaTree read_lsystem(std::string_view word);

/// Options of draw_turtle().
struct TurtleParams {
    double delta_deg = 30.0; ///< [deg] [0, 90] angle of one + or -
    Required<double> link_m; ///< [m] > 0, length of F and G
};

/// Draws a network's word by turtle graphics, northwards from the origin. Links may cross: use it for figures, not for
/// terrain.
/// \param tree a binary tree of links
/// \param params options, each with its default, unit and range
/// \return by link: its lower and upper end [m]
/// \throws BadParameter when a parameter is outside its range
///
/// Source: \cite nenu2015, section 2.2, figure 1 (a).
std::vector<std::vector<Vec2>> draw_turtle(TokunagaTree const& tree, TurtleParams const& params);

} // namespace thalweg::network
