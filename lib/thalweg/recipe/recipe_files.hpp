// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {

/// Lets the user's own words name what a recipe may not: a database, an address, a VRT or any other format. Such
/// sources, where --set or the name of the rivers named them and no recipe file did, are copied as GeoPackages and
/// GeoTIFFs into a temporary folder that goes with this object, and the recipe names the copies: what make keeps in
/// inputs/ needs no connection and no other file.
class UserFiles {
public:
    /// \throws BadInput when a source cannot be read
    UserFiles(Recipe& recipe, Run const& run = {});

private:
    std::string copied(Recipe const& recipe, std::string const& name, std::string const& layer, Run const& run);

    std::unique_ptr<io::TemporaryFolder> folder_; ///< null where nothing was copied
    int copies_ = 0;
};

/// \internal
/// \return the name of every file in a recipe, in the order of recipe files.
std::vector<std::string> file_names(Recipe const& recipe);

/// \internal
/// \return a text that differs when a file of a recipe, or one beside it that has its name, as the parts of a
/// Shapefile, was changed, and when the recipe lies elsewhere
std::string state_of_files(Recipe const& recipe);

/// \internal
/// Copies every file of a recipe, with what belongs to it, into inputs/ of an output.
/// \param recipe any; files of keys without an effect are left
/// \param out the output
/// \return the recipe with the names of the copies, and no folder
/// \throws BadInput when a file is missing or cannot be read
Recipe keep_inputs(Recipe recipe, io::OutputFolder const& out);

/// \internal
/// Copies a file that the user names, with what belongs to it, into an output; a database, an address or a format that
/// no recipe may name becomes a GeoPackage or a GeoTIFF, as with UserFiles.
/// \return its name there
/// \throws BadInput when it is missing or cannot be read
std::string keep_user_file(std::string const& path, io::OutputFolder const& out, Run const& run = {});

// What a recipe names.

/// A file the recipe names, found from the recipe's folder.
/// \internal
io::Source file_in(Recipe const& recipe, std::string const& name);

/// A file that a key names.
struct NamedFile {
    Key const* key;
    std::size_t item;  ///< of a section that is an array
    std::string name;  ///< as the recipe says it
    std::string layer; ///< "" for any
};

/// Every file that a recipe names, in the order of recipe files.
/// \internal
std::vector<NamedFile> files_of(Recipe const& recipe);

/// Whether a name means a database or an address of GDAL's, which no folder holds.
/// \internal
bool is_address(std::string const& name);

/// The recipe with every file it names found from anywhere.
/// \internal
Recipe with_absolute_files(Recipe recipe);

/// Says what the files of a recipe are converted from, and how far the grid leaves its UTM zone.
/// \return a note for each: "converted", "stretched"; kept by the files, whatever else the recipe says.
/// \internal
std::vector<Finding> conversions(Recipe const& recipe, Grid const& grid, Run const& run = {});

} // namespace thalweg::recipe
