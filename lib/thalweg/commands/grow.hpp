// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/network/order/order.hpp>

namespace thalweg::commands {

/// Options of run_grow().
struct GrowParams {
    growth::TokunagaParams tree = {}; ///< its seed also decides between several rules
    std::string rules = {};           ///< a text file with an L-system, which is rewritten instead; "": none
    std::string output = {};          ///< a picture of the rewritten word: .svg, .png or .pdf; "": none
    io::Existing existing = io::Existing::refuse;
    bool word = false; ///< write the tree as the word of an L-system, with alternating banks
};

/// What run_grow() returns: a word, or the statistics of a tree beside those predicted in closed form.
struct GrowResult {
    std::string word;       ///< "": the tree was counted
    std::int64_t lines = 0; ///< in the picture
    network::StreamCounts streams;
    growth::TokunagaLaws laws;
    std::vector<double> side_law;    ///< by k - 1: a c^(k-1)
    std::vector<double> bifurcation; ///< by order - 1: N_w / N_(w+1)
};

/// Runs `thalweg grow`: grows a Tokunaga tree and counts its streams or writes its word; or rewrites the L-system of a
/// file and draws it, into a file that is written completely or not at all.
/// \param params tree or file, and options
/// \return word or counts
/// \throws BadParameter as growth::grow_tokunaga and growth::rewrite, for a picture without rules, or of another kind
/// \throws BadInput as growth::read_rules and io::OutputFile
GrowResult run_grow(GrowParams const& params, Run const& run = {});

} // namespace thalweg::commands
