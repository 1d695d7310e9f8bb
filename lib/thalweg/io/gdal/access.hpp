// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

struct pj_ctx; // PROJ's PJ_CONTEXT

namespace thalweg::io {

/// \param path path of the file
/// \return whether a name makes GDAL connect to a server: a database (PG:, postgresql:) or a file behind an address
/// (/vsicurl/, /vsis3/, ...). /vsistdin/ counts as one.
bool names_connection(std::string const& path);

/// While one lives, every source is opened as a file that a recipe names, and a recipe may come from anywhere. It is an
/// existing file or folder in one of the formats that hold data and name no other sources; what its driver opens beside
/// it lies in the same folder. Anything else is BadInput. Without one, files may be in any format that GDAL reads from
/// the disk, and a connection is made only to what a path itself names, with a timeout. Holds for all threads.
class RecipeFiles {
public:
    RecipeFiles();
    ~RecipeFiles();
    RecipeFiles(RecipeFiles const&) = delete;
    RecipeFiles& operator=(RecipeFiles const&) = delete;
};

/// \return whether a RecipeFiles lives.
bool reads_recipe_files();

/// \param path path of the file
/// \throws BadInput while a RecipeFiles lives and the path names a connection, or is neither a file nor a folder
void require_allowed(std::string const& path);

/// \param path path of the file
/// \return whether a recipe may name this source.
bool is_recipe_file(std::string const& path);

// What PROJ may open.

/// From now on a context of PROJ reads files in PROJ's own folders only (projinfo --searchpaths) and writes none,
/// wherever the name of a grid comes from.
/// \param context the context of PROJ
void confine_proj(pj_ctx* context);

} // namespace thalweg::io
