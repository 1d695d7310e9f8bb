// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/draw/distributions.hpp>
#include <thalweg/ensemble/internal/ensemble_table.hpp>

namespace thalweg::ensemble {

/// A key that varies, by member.
struct DrawnKey {
    draw::Distribution values;      ///< numbers, or those of the words
    std::vector<std::string> words; ///< empty: the key is a number
};

/// What the pictures and the page of an ensemble show.
struct EnsembleView {
    std::string title;
    std::string summary; ///< counts of members and varied keys, in words
    MembersTable table;
    std::vector<draw::Distribution> indices; ///< of all members, by group
    std::vector<DrawnKey> parameters;        ///< keys that are numbers, or one of a few words
    std::vector<Finding> findings;           ///< what is left out
};

/// A contact sheet and its note; no bytes: there is none.
struct EnsembleSheet {
    std::string png;
    std::string note;
};

/// Makes the page of an ensemble: HTML with everything in it, without scripts.
/// \param sheet its contact sheet
/// \param command that draws it again
std::string ensemble_page(EnsembleView const& view, EnsembleSheet const& sheet, std::string const& command,
                          Run const& run);

/// The values of a key that varies, in words: "12 to 29.9 degrees", "dla, forest".
std::string words_of_key(MembersTable const& table, std::size_t key);

/// The unit of a key of recipes; "": it has none.
std::string unit_of_key(std::string const& key);

} // namespace thalweg::ensemble
