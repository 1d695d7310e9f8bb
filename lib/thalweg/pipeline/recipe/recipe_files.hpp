// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace thalweg::pipeline {

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

} // namespace thalweg::pipeline
