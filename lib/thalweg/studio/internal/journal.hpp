// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <thalweg/studio/document.hpp>

namespace thalweg::studio {

/// Whether a name means a file below inputs/ of the document.
bool lies_in_inputs(std::string const& name);

/// A text with lines replaced. Throws BadInput where the old ones are not there.
std::string with_lines(std::string toml, ReplaceLines const& lines);

ReplaceLines reversed(ReplaceLines lines);

/// Moves the last change, which must be there.
void move_last(std::vector<Change>& from, std::vector<Change>& to);

// The journal of a document: a line of JSON for the recipe that it began with, then one for each edit, undo and redo.

std::string line_of_beginning(std::string const& toml);
std::string line_of(Change const& change);
std::string line_of_undo();
std::string line_of_redo();

/// The shortest journal of a history.
std::string journal_of(std::string const& first_toml, History const& history);

/// What a journal says.
struct Journal {
    std::string first_toml; ///< the recipe that it began with
    std::string toml;       ///< the recipe at its end
    History history;
    std::int64_t lines = 0;
    std::size_t bytes = 0; ///< of the lines that can be read; others follow from there
    std::string fault;     ///< why the next line cannot be read; "": there is none, or it was not written to its end
    bool passed = false;   ///< the recipe that was looked for was there, and others came after it
};

/// Reads as far as lines are whole and fit together.
/// \param text of the journal
/// \param looked_for a recipe
Journal read_journal(std::string_view text, std::string const& looked_for);

} // namespace thalweg::studio
