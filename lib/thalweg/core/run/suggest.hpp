// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Finds the known word nearest to a mistyped one by edit distance, ignoring case; a swap of neighbours counts once.
/// \param word as typed
/// \param known valid words
/// \return at most max(1, min(3, a third of the letters)) edits away; of several the first; "": none is near
std::string closest(std::string_view word, std::vector<std::string> const& known);

/// Suggests the closest known word.
/// \param word as typed
/// \param known valid words
/// \return " Did you mean 'x'?", or ""
std::string did_you_mean(std::string_view word, std::vector<std::string> const& known);

} // namespace thalweg
