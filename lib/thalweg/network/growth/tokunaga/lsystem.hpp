// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/required.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::network {

/// Writes a network as the word of an L-system: F a link, G a source's link, [ ] a branch, + and - turns to the left
/// and right, doubled for side branches. With lambda = 2 and alternating banks the words are those of the axiom G and
/// the rules G -> F[--G]F[-G][+G], F -> F[++G]F.
/// \param tree a tree
/// \return its word, from the outlet upstream; of what read_lsystem makes of a word it gives that word.
///
/// Source: \cite nenu2015, section 2.2; its rules F -> FF and F -> F[--G]F[-G][+G] do not keep eq. 1 and are mended.
std::string write_lsystem(TokunagaTree const& tree);

/// Grows a network and writes it.
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the text
/// \throws BadParameter
/// \throws Cancelled
std::string lsystem(TokunagaParams const& params = {}, Run const& run = {});

/// Reads a word back.
/// \param word F, G, +, -, [ and ]; blanks are skipped. After F come two branches, or one and the stream's next link
/// \return the tree, numbered as written, with Strahler orders and link_length 1.
/// \throws BadInput naming the position, from 1
TokunagaTree read_lsystem(std::string_view word);

/// Options of draw_turtle().
struct TurtleParams {
    double delta_deg = 30.0; ///< [deg] [0, 90] what one + or - turns
    Required<double> link_m; ///< [m] > 0 what F and G draw
};

/// Draws a network as its word says, to the north from the origin.
/// \param tree a tree
/// \param params options, each with its default, unit and range
/// \return by link its lower and upper end. Links cross one another: for pictures, not for land.
/// \throws BadParameter
///
/// Source: \cite nenu2015, section 2.2, figure 1 (a).
std::vector<std::vector<Vec2>> draw_turtle(TokunagaTree const& tree, TurtleParams const& params);

} // namespace thalweg::network
