// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>

struct pj_ctx; // PROJ's PJ_CONTEXT

namespace thalweg::io {

/// \internal
/// Tells whether a name makes GDAL connect to a server: a database (PG:, postgresql:) or a file behind an address
/// (/vsicurl/, /vsis3/, ...). /vsistdin/ counts as one.
/// \param path a file's path or a connection
/// \return true: it connects
bool names_connection(std::string const& path);

/// Finds the file in GDAL's name of one of its variables or layers.
/// \param path such as NETCDF:"heights.nc":elevation
/// \return the existing file; "" for any other name
std::string file_of_part(std::string const& path);

/// Who names a source, which decides what may be opened.
enum class Access : std::uint8_t {
    user,  ///< The user: any format that GDAL reads from the disk, and a connection only to what the path itself names,
           ///< with a timeout.
    recipe ///< A recipe, which may come from anywhere: an existing file or folder in a format that holds its data and
           ///< names no other sources; its driver opens files of the same folder alone. Anything else is BadInput.
};

/// A source of data by its name.
struct Source {
    Source() = default;
    Source(std::string name, Access by = Access::user) : path(std::move(name)), access(by) {} // NOLINT(*-explicit-*)
    Source(char const* name) : path(name) {}                                                  // NOLINT(*-explicit-*)

    /// \return the name for messages
    std::string const& name() const { return shown.empty() ? path : shown; }

    std::string path; ///< "" for none
    Access access = Access::user;
    std::string shown = {}; ///< the file that the user named, if this is a copy of it; "": none
};

/// \internal
/// \param source the source
/// \throws BadInput where a recipe names a connection, or what is neither a file nor a folder
void require_allowed(Source const& source);

/// \internal
/// Tells whether a recipe may name a source.
/// \param path of the source
/// \return true: it may
bool is_recipe_file(std::string const& path);

/// Says, before the first use of GDAL, that this process has others who use it, as a program in Python: its drivers and
/// settings stay as they are, and what may be opened is restricted within this library's own calls alone.
void share_gdal();

// Files that PROJ may open.

/// \internal
/// Restricts a context of PROJ: from now on it reads files in PROJ's own folders only (projinfo --searchpaths) and
/// writes none, whatever the name of a grid is.
/// \param context of PROJ
void confine_proj(pj_ctx* context);

} // namespace thalweg::io
