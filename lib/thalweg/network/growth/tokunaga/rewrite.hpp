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

namespace thalweg::network {

/// An L-system of any signs: what a word is rewritten by, and how a turtle draws it.
struct LSystem {
    std::string axiom;
    int iterations = 1;                             ///< [0, 60]
    double angle_deg = 30.0;                        ///< [deg] [0, 180] of one turn
    std::map<char, std::vector<std::string>> rules; ///< by sign; of several words for it each is as likely
};

/// Reads an L-system from text: lines "axiom WORD", "iterations N", "angle DEGREES" and "SIGN -> WORD". Behind # is a
/// comment; a WORD may be empty but for the axiom, and blanks in it do not count. A sign that has several lines is
/// rewritten by one of them at random.
/// \param text the text
/// \param name its name
/// \return axiom and rules
/// \throws BadInput naming file and line. name: for messages
LSystem read_rules(std::string_view text, std::string const& name);

/// The word after all iterations: in each every sign with a rule is replaced at once.
/// \pre rules; seed of the choice between several.
/// \param system axiom and rules
/// \param seed random seed
/// \param run progress, log, stop token and number of threads
/// \return the same word for any number of threads. With F -> FF alone a word's links are halved and its branches stay.
/// \throws BadParameter when the word would have more than 20 million signs, or brackets do not match
/// \throws Cancelled
///
/// Source: \cite nenu2015, section 2.2; \cite prusinkiewicz1990, The algorithmic beauty of plants, sections 1.2 and
/// 1.7.
std::string rewrite(LSystem const& system, std::uint64_t seed = 7, Run const& run = {});

/// What a turtle draws of a word that starts to the north from the origin, every step of length 1.
/// \pre capital letters draw a step, small letters make one without drawing, + and - turn left and right, | turns
/// round, [ and ] remember and return to a place and bearing; other signs do nothing.
/// \param word the word
/// \param angle_deg [degrees] angle
/// \param run progress, log, stop token and number of threads
/// \return polylines, each as long as nothing interrupts it.
///
/// Source: as rewrite.
std::vector<std::vector<Vec2>> draw_word(std::string_view word, double angle_deg, Run const& run = {});

} // namespace thalweg::network
