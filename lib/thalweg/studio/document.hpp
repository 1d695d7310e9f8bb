// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/recipe/recipe.hpp>

namespace thalweg::studio {

/// What is edited: a recipe that check_recipe() accepts and whose files all lie below inputs/ of its folder.
struct Document {
    std::string toml;          ///< the recipe as recipe.toml holds it
    recipe::Recipe recipe;     ///< the same, read
    std::int64_t revision = 0; ///< grows by 1 with every edit, undo and redo
};

/// Sets a key of the recipe: "network.prune", "patch.2.rotate".
struct SetKey {
    std::string key;
    std::string value; ///< as it stands after "=" on the command line
};

/// Takes a key back to its default, or a section ("detail") or patch ("patch.2") out of the recipe.
struct UnsetKey {
    std::string key;
};

/// Sets a key to a file that lies in the document; DocumentFolder::take() copies it there.
struct TakeInput {
    std::string key;
    std::string file; ///< "inputs/3/rivers.gpkg"
};

/// Puts another recipe in its place.
struct ReplaceRecipe {
    std::string toml;
};

/// Puts other lines into the text of the recipe: what undo and redo do.
struct ReplaceLines {
    std::int64_t first = 0; ///< [lines] before them
    std::string old_text;   ///< whole lines, which stand there
    std::string new_text;   ///< whole lines
};

using Step = std::variant<SetKey, UnsetKey, TakeInput, ReplaceRecipe, ReplaceLines>;

/// What is done and undone at once: one step, or several under a name, as those of a slider that is drawn.
struct Edit {
    std::string name; ///< for people; "": that of its only step
    std::vector<Step> steps;
};

/// \return "network.prune = 20", or the name of the edit.
std::string name_of(Edit const& edit);

/// A document after an edit, and the way back.
struct AppliedEdit {
    Document document;
    ReplaceLines inverse; ///< applied to document, gives the text before, byte for byte
};

/// Begins a document with a recipe.
/// \param toml its text
/// \return the document; what has no effect is left out
/// \throws BadParameter as read_recipe() and check_recipe(), and for files that do not lie below inputs/
Document document_of(std::string const& toml);

/// Applies an edit. Keys that lose their effect by it are left out of the recipe; the inverse brings them back.
/// \param document any
/// \param edit any
/// \return the document after it, and the inverse
/// \throws BadParameter for a key that is unknown or has no effect, and a recipe that is refused, in the recipe's words
/// \throws BadInput when lines to replace are not there
AppliedEdit apply(Document const& document, Edit const& edit);

/// An edit that was made.
struct Change {
    Edit edit;
    ReplaceLines inverse;
};

/// What can be undone and redone, without end.
struct History {
    std::vector<Change> done;   ///< the last is undone first
    std::vector<Change> undone; ///< the last is redone first
};

/// A document and how it came about.
struct Session {
    Document document;
    History history;
};

/// Applies an edit; what was undone can no longer be redone.
/// \return the same session where the edit changes nothing
/// \throws Error as apply()
Session edited(Session session, Edit const& edit);

/// Undoes the last edit.
/// \return the same session where there is none
/// \throws BadParameter when the recipe before is refused
Session undone(Session session);

/// Does again what was undone last.
/// \return the same session where there is none
/// \throws BadParameter when the recipe after is refused
Session redone(Session session);

} // namespace thalweg::studio
