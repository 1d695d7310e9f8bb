// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/studio/document.hpp>

namespace thalweg::studio {

struct Journal;

/// Makes the folder of a document, completely or not at all: recipe.toml, which `thalweg make` makes the same terrain
/// of; inputs/, with copies of all its files; history.jsonl, every edit as a line of JSON.
/// \param folder a new one, or an empty one
/// \param input a recipe, a folder that make wrote (its recipe is taken), or rivers or a DEM as for
/// recipe::recipe_from(); "": recipe::default_recipe()
/// \param preset of recipe::presets(), for keys that the input does not set; "": none
/// \throws BadInput when the folder has content, and when an input cannot be read
/// \throws BadParameter as document_of() and recipe::with_preset()
void new_document(std::string const& folder, std::string const& input = {}, std::string const& preset = {},
                  Run const& run = {});

/// Makes a document to draw on, 512 x 512 cells of 30 m without rivers. Those that are drawn meander.
/// \param folder as for new_document()
/// \param preset likewise
/// \throws BadInput when the folder has content
/// \throws BadParameter as recipe::with_preset()
void new_sheet(std::string const& folder, std::string const& preset = {});

/// Whether a folder is that of a document.
bool is_document(std::string const& folder);

/// A document in its folder. An edit is on disk when the call returns: first its line at the end of history.jsonl, then
/// recipe.toml, written aside and renamed. A process that dies in between leaves the state before or after an edit. No
/// file of inputs/ is ever removed, since an undo may need it.
class DocumentFolder {
public:
    /// Opens a document. A line at the end of the history that was not written to its end is dropped. Where recipe.toml
    /// is no state of the history, it was changed elsewhere, and becomes an edit that can be undone.
    /// \param folder that new_document() made
    /// \throws BadInput when it is none, or open in another process
    /// \throws BadParameter when the recipe is refused, with all its faults
    /// \throws IoError with the system's reason
    explicit DocumentFolder(std::string folder);
    ~DocumentFolder();
    DocumentFolder(DocumentFolder const&) = delete;
    DocumentFolder& operator=(DocumentFolder const&) = delete;

    Document const& document() const { return session_.document; }
    History const& history() const { return session_.history; }
    /// \return what was found and mended when it was opened, as sentences
    std::vector<std::string> const& notes() const { return notes_; }

    /// \throws Error as apply(); IoError when it cannot be saved; nothing is changed then
    void edit(Edit const& edit);
    /// \return false: there was nothing to undo
    bool undo();
    /// \return false: there was nothing to redo
    bool redo();

    /// Copies a file into inputs/, in a folder of its own.
    /// \param key of a recipe, which the file is for
    /// \param path any that the user names
    /// \return the step that sets the key to the copy, for edit()
    /// \throws BadInput when the file is missing or cannot be read
    TakeInput take(std::string const& key, std::string const& path, Run const& run = {}) const;
    /// Writes a new file into inputs/, in a folder of its own.
    /// \param name of the file
    /// \param write is given the path
    /// \return as take()
    TakeInput put(std::string const& key, std::string const& name,
                  std::function<void(std::string const& path)> const& write) const;

private:
    void open();
    void mend(std::string const& path, std::string const& text, Journal const& journal, bool is_whole);
    void save(Document after, std::string const& line);
    void append(std::string const& line);
    std::string free_input() const;

    std::string folder_;
    int lock_ = -1;          ///< a file that this process has locked
    std::int64_t bytes_ = 0; ///< of history.jsonl
    Session session_;
    std::vector<std::string> notes_;
};

} // namespace thalweg::studio
