// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {

/// How QGIS draws a layer: the elements within <qgis> of a QML file, from version 3.22 on.
using QgisStyle = std::string;

/// \param style of a layer
/// \return the text of a QML file
std::string qml(QgisStyle const& style);

/// The field by which rivers are as wide as the root of their drainage area.
struct RiverWidths {
    std::string field = {}; ///< "": all are equally wide for their order
    double greatest = 0.0;  ///< [as its values]
};

/// Rivers, darker with their order.
/// \param order_field of the layer; "": one colour
/// \param highest order that has a colour of its own, >= 1
/// \return a style for lines
QgisStyle river_style(std::string const& order_field, int highest, RiverWidths const& widths);

/// Sources, confluences, outlets, sinks and pseudo-nodes by the field kind.
/// \return a style for points
QgisStyle node_style();

/// \return a style for ridge lines
QgisStyle ridge_style();

/// \return a style for lines of a file that are not in the network
QgisStyle secondary_style();

/// Contour lines by the field is_index; index contours are labelled with their z.
/// \return a style for lines
QgisStyle contour_style();

/// Catchments, tinted so that neighbouring basins differ by the field basin_id.
/// \param is_whole true for basins: their outlines stand out
/// \return a style for polygons
QgisStyle catchment_style(bool is_whole);

/// Findings of a check by the field kind.
/// \param kinds every value of it
/// \return a style for points
QgisStyle finding_style(std::vector<std::string> const& kinds);

/// \return a style for polygons, such as the triangles of a TIN: pale, with thin edges
QgisStyle polygon_style();

/// \return a style for polygons of open water
QgisStyle water_style();

/// Heights and their colours, "#7ea688", ascending.
using Tints = std::vector<std::pair<double, std::string>>;

/// Hypsometric tints, which multiply what lies below, such as a hillshade.
/// \param tints [unit] heights and their colours, ascending
/// \param unit of the heights in the legend: "m"
/// \param no_data colour of cells without a height; "": none
/// \return a style for a DEM
/// \throws BadInput when there are fewer than two tints; likewise mesh_style
QgisStyle tint_style(Tints const& tints, std::string const& unit, std::string const& no_data = {});

/// Light from the north-west.
/// \param metres_in_unit [m] in a unit of the heights
/// \return a style for a DEM
QgisStyle hillshade_style(double metres_in_unit = 1.0);

/// Colours for the cells of a mask that are 1; others are clear.
/// \param label in the legend
/// \param colour "#9fc4e0"
/// \return a style for a raster of bytes
QgisStyle mask_style(std::string const& label, std::string const& colour);

/// A number of cells in a raster of bytes, and what it stands for.
struct ClassOfCells {
    int number = 0;
    std::string label;  ///< in the legend
    std::string colour; ///< "#9fc4e0"
};

/// Colours for cells by their number; others are clear.
/// \return a style for a raster of bytes, which multiplies what lies below
QgisStyle classes_style(std::vector<ClassOfCells> const& classes);

/// Contributing areas by their logarithm.
/// \param smallest,greatest [m2] > 0
/// \return a style for a raster
/// \throws BadInput when they are not
QgisStyle area_style(double smallest, double greatest);

/// A TIN as a mesh of a 2DM file, whose heights QGIS calls "Bed Elevation": hypsometric tints, and thin edges.
/// \param tints [unit] as for tint_style
/// \param unit of the heights in the legend
/// \return a style for a mesh with heights in its first dataset
QgisStyle mesh_style(Tints const& tints, std::string const& unit);

/// Reads the styles that a GeoPackage has for its layers (table layer_styles).
/// \param path of a GeoPackage
/// \return by layer; empty: it has none
/// \throws IoError when it cannot be read
std::map<std::string, QgisStyle> styles_of(std::string const& path);

} // namespace thalweg::io
