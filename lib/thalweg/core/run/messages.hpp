// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Removes passwords from connection strings and URLs.
/// \param text any text
/// \return "..." in place of each password
std::string without_passwords(std::string_view text);

/// Checks an encoding.
/// \param text any bytes
/// \return true: valid UTF-8
bool is_utf8(std::string_view text);

/// Makes any bytes valid UTF-8.
/// \param text any bytes
/// \return \\xNN in place of each invalid byte
std::string as_utf8(std::string_view text);

/// \return a text in single quotes for a POSIX shell
std::string in_single_quotes(std::string_view text);

/// \return a word for a POSIX shell, in quotes where it needs them
std::string for_shell(std::string const& word);

/// Makes text safe to show on a terminal.
/// \param text any bytes
/// \return without passwords; control characters (except line feeds and tabs), direction marks and invalid UTF-8 as
/// \\xNN or \\u{NNNN}; of a line above 600 bytes the first 400 and the last 150, of more than 60 lines the first 50,
/// with a note of what is left out
std::string printable(std::string_view text);

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
