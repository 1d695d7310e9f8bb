// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::tools {

/// Text as man(7) shows it to the letter: hyphens can be copied into a shell, no line is taken for a request.
std::string roff(std::string const& text);

/// A line of a font macro: `.B text`.
std::string bold_line(std::string const& text);

/// Lines shown as they are.
std::string verbatim(std::string const& lines);

/// A tag and, indented below it, what it means. tag: roff.
std::string tagged(std::string const& tag, std::string const& text);

/// Filled text.
std::string paragraph(std::string const& text);

std::string section(std::string const& name);

} // namespace thalweg::tools
