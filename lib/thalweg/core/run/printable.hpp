// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace thalweg {

/// \param text the text
/// \return a text without the passwords of connection strings and addresses: "..." stands for each.
std::string without_passwords(std::string_view text);

/// \param text any bytes
/// \return whether a text is UTF-8.
bool is_utf8(std::string_view text);

/// \param text the text
/// \return a text with \\xNN for each byte that is not UTF-8: what a file may hold.
std::string as_utf8(std::string_view text);

/// A text as one may show it on a terminal, whatever its words came from.
/// \param text the text
/// \return control characters but line feeds and tabs, marks of writing direction, and bytes that are not UTF-8 as
/// \\xNN or \\u{NNNN}; no passwords; of lines above 600 bytes the first 400 and the last 150, of more than 60 lines the
/// first 50, with a note of how much is left out.
std::string printable(std::string_view text);

} // namespace thalweg
