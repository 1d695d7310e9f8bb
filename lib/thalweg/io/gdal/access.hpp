// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

struct pj_ctx; // PROJ's PJ_CONTEXT

namespace thalweg::io {

/// Tells whether a name makes GDAL connect to a server: a database (PG:, postgresql:) or a file behind an address
/// (/vsicurl/, /vsis3/, ...). /vsistdin/ counts as one.
/// \param path a file's path or a connection
/// \return true: it connects
bool names_connection(std::string const& path);

/// While an object lives, every source is opened as a file named by a recipe, which may come from an untrusted source:
/// it must be an existing file or folder in a format that holds its data and names no other sources, and its driver may
/// open other files in the same folder only. Anything else is BadInput. Otherwise files may have any format that GDAL
/// reads from disk, and a connection is made only to what the path itself names, with a timeout. Applies to all
/// threads.
class RecipeFiles {
public:
    RecipeFiles();
    ~RecipeFiles();
    RecipeFiles(RecipeFiles const&) = delete;
    RecipeFiles& operator=(RecipeFiles const&) = delete;
};

/// \return whether a RecipeFiles lives
bool reads_recipe_files();

/// Rejects sources that a recipe may not name.
/// \param path of the source
/// \throws BadInput when a RecipeFiles lives and the path names a connection, or is neither a file nor a folder
void require_allowed(std::string const& path);

/// Tells whether a recipe may name a source.
/// \param path of the source
/// \return true: it may
bool is_recipe_file(std::string const& path);

// Files that PROJ may open.

/// Restricts a context of PROJ: from now on it reads files in PROJ's own folders only (projinfo --searchpaths) and
/// writes none, whatever the name of a grid is.
/// \param context of PROJ
void confine_proj(pj_ctx* context);

} // namespace thalweg::io
