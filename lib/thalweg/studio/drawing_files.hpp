// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/studio/document.hpp>
#include <thalweg/studio/drawing.hpp>

namespace thalweg::studio {

/// The name of files of drawn rivers and their coasts: layer rivers, with rosgen, lambda and natural ("coastline").
inline constexpr char const* drawing_name = "drawing.gpkg";

/// Whether the rivers of a recipe are drawn lines: network.lines.path names a drawing, or there are strokes.
bool is_drawn(recipe::Recipe const& recipe);

/// The grid that a recipe says in full, with corner and CRS.
std::optional<Grid> grid_of(recipe::Recipe const& recipe);

/// Reads what is drawn.
/// \param recipe its files are read
/// \param grid of the recipe's terrain
/// \return rivers and coasts where is_drawn(), else none; lakes; masks that are polygons; pins and ridges
/// \throws Error as io::read_rivers(), io::read_polygons() and io::read_points()
Drawing read_drawing(recipe::Recipe const& recipe, Grid const& grid, Run const& run = {});

/// The rivers of a terrain as if they were drawn, an arc a river, and the coasts of its land.
/// \param attributes of the file that they come from, by feature
Drawing drawing_of(Grid const& grid, StreamNetwork const& network, Mask const& land, AttributeTable const& attributes);

/// Writes rivers and coasts as a new GeoPackage.
/// \param path ends in .gpkg
void write_drawing(Drawing const& drawing, std::string const& path, Run const& run = {});

/// Writes a file of a document, and gives the step that sets a key to it.
using PutInput = std::function<TakeInput(std::string const& key, std::string const& name,
                                         std::function<void(std::string const& path)> const& write)>;

/// The edit that turns one drawing of a document into another. Rivers that were not drawn become drawn lines, on the
/// grid that they have: what had a say in how they came about goes out of the recipe. Where there were none, terrain in
/// equilibrium gets network.meander = 1, unless the recipe sets it.
/// \param before what read_drawing() or drawing_of() gives for the document
/// \param put called for each file that changed
/// \return steps; none where nothing changed
Edit edit_between(Document const& document, Drawing const& before, DrawResult const& after, PutInput const& put);

/// The edit that makes an empty sheet of a document: nothing is drawn on it.
Edit empty_sheet(Document const& document, Grid const& grid, PutInput const& put);

} // namespace thalweg::studio
