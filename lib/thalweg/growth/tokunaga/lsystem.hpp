// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

// Idea: An L-system rewrites all signs of a word at once, by rules such as F -> F[++G]F. A turtle
// reads the word: letters are steps, + and - turns, brackets remember a place and return to it. So
// a few rules describe a branching system, and every iteration replaces each link by a small tree.
// The same signs also write down a tree that exists (write_lsystem): F a link, G the link of a
// source.
// Source: Prusinkiewicz and Lindenmayer 1990, sections 1.2 and 1.7; the rules for rivers: Northeast
// Normal University 2015, section 2.2, of which F -> FF and one rule for lambda = 3 break its own
// law (docs/rivers.md, "What the thesis prints and what holds").
// Cost: linear in the length of the word, which grows exponentially with iterations; 20 million
// signs at most. One thread.
// Not for: networks for terrain. The turtle turns by fixed angles and knows no other branch, so
// lines cross (13 to 31 % of the links after five refinements): embed grow_tokunaga's tree instead.
// Example:
//     LSystem const rules = read_rules("axiom G\nG -> F[--G]F[-G][+G]\nF -> F[++G]F\n", "rules");
//     std::string const word = rewrite(rules, 7);
//     std::vector<std::vector<Vec2>> const lines = draw_word(word, rules.angle_deg);
// More: docs/rivers.md, "Networks".

namespace thalweg::growth {

/// Writes a network as the word of an L-system: F a link, G a source's link, [ ] a branch, + and - turns to the left
/// and right, doubled for side branches. For lambda = 2 and alternating banks the words are those of the axiom G and
/// the rules G -> F[--G]F[-G][+G], F -> F[++G]F.
/// \param tree a binary tree of links
/// \return its word, from the outlet upstream
///
/// Source: \cite nenu2015, section 2.2; its rules F -> FF and F -> F[--G]F[-G][+G] violate eq. 1 and are corrected.
std::string write_lsystem(TokunagaTree const& tree);

/// Grows a network and writes its word: write_lsystem(grow_tokunaga(params)).
/// \return its word
/// \throws BadParameter as grow_tokunaga
std::string lsystem(TokunagaParams const& params = {}, Run const& run = {});

/// An L-system with any symbols and its turtle's angle.
struct LSystem {
    std::string axiom;
    int iterations = 1;                             ///< [0, 60]
    double angle_deg = 30.0;                        ///< [deg] [0, 180] angle of one turn
    std::map<char, std::vector<std::string>> rules; ///< by symbol: replacements, all equally likely
};

/// Parses an L-system: lines "axiom WORD", "iterations N", "angle DEGREES" and "SIGN -> WORD". # begins a comment;
/// blanks in a word are skipped; only the axiom must not be empty. Several rules of one sign are chosen at random.
/// \param text the rules
/// \param name of the file, for messages
/// \return axiom and rules
/// \throws BadInput naming file and line
LSystem read_rules(std::string_view text, std::string const& name);

/// Rewrites the axiom: in each iteration all signs with a rule are replaced at once.
/// \param system axiom and rules
/// \param seed random seed of the choice between several rules
/// \return the same word for any number of threads
/// \throws BadParameter when the word exceeds 20 million signs or brackets do not match
///
/// Source: \cite nenu2015, section 2.2; \cite prusinkiewicz1990, The algorithmic beauty of plants, sections 1.2 and
/// 1.7.
std::string rewrite(LSystem const& system, std::uint64_t seed = 7, Run const& run = {});

/// Draws a word by turtle graphics, northwards from the origin with steps of length 1.
/// \param word capital letters draw a step, small letters make one without drawing, + and - turn left and right, |
/// turns round, [ and ] save and restore position and bearing; other signs are ignored
/// \param angle_deg [deg] of one turn
/// \return maximal polylines
///
/// Source: as rewrite.
std::vector<std::vector<Vec2>> draw_word(std::string_view word, double angle_deg, Run const& run = {});

} // namespace thalweg::growth
