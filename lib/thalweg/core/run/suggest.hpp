// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// \param word a mistyped word
/// \param known the known words
/// \return the known word nearest to a mistyped one by edit distance, neighbours swapped being one slip, whatever the
/// case (at most a third of its letters, at least 1 and at most 3 off; ties: the first), or "" when none is near.
std::string closest(std::string_view word, std::vector<std::string> const& known);

/// " Did you mean 'x'?" for the closest known word, or "".
/// \param word a mistyped word
/// \param known the known words
/// \return the suggestion, or ""
std::string did_you_mean(std::string_view word, std::vector<std::string> const& known);

} // namespace thalweg
