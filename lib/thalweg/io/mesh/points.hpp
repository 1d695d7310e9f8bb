// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>

namespace thalweg::io {

/// Whether points need heights.
enum class PointHeights : std::uint8_t {
    wanted,
    passed_over ///< points lie in plan: any heights count as 0, and text needs no third column
};

/// Treatment of points with the same position in plan but different heights.
enum class DuplicatePoints : std::uint8_t {
    refused,
    averaged ///< all points at a position get the mean of their heights
};

/// Options of read_points().
struct ReadPointsParams {
    Source path = {};          ///< text (.csv, .txt, .xyz), a point cloud (LAS, LAZ) or anything OGR opens
    std::string layer = {};    ///< "" takes the only layer of points
    std::string z_field = "z"; ///< heights of points that have none themselves
    std::string crs = {};      ///< of the result; "" takes the file's own when projected in metres, else its UTM zone;
                               ///< a file without one, text included, is taken to be in it unless source_crs says
    PointHeights heights = PointHeights::wanted;
    DuplicatePoints duplicates = DuplicatePoints::refused;
    /// Column of the heights of all points, of text too; "": their Z or z_field; nothing: the user has no option to
    /// name it
    std::optional<std::string> height_column = {};
    /// [m] A height that stands for no data: such points are left out. NaN: none does. None: those that are known to
    /// (-9999, ...) are refused where no other height is near
    std::optional<double> nodata = {};
    /// Text: the columns of x, y and z, as names in a first line or numbers from 1 ("3,2,4"), or "pnezd" (number,
    /// northing, easting, height, description). "": a first line names them x, y and z, or there are exactly these
    /// three; nothing: the user has no option to name them
    std::optional<std::string> columns = {};
    /// CRS of a file that has none, text included ("": crs); nothing: the user has no option to name it
    std::optional<std::string> source_crs = {};
    /// Classes of a point cloud that are taken, separated by commas: ground (2 and 8, model key-points), water (9), all
    /// but noise (7 and 18), or numbers in [0, 255]. "": ground, or all of a cloud that is not classified; nothing: the
    /// user has no option to name them
    std::optional<std::string> classes = {};
    /// [m] >= 0, of a point cloud: the point nearest to the centre of each cell of this side is kept, on a lattice
    /// through the origin of the file's CRS; 0: all points. Nothing: the smallest of 1, 2 or 5 times a power of ten
    /// that leaves about a million points, if there are more
    std::optional<double> thin_m = {};
    // How a user names height_column and nodata, for messages.
    std::string height_option = "--height-column ";
    std::string nodata_option = "--nodata ";
};

/// Reads points with heights. Text: one point per line, x y z in three columns, in those named by a first line (x, y, z
/// in any case and order) or by params.columns, separated by commas, semicolons or blanks; empty lines and those that
/// begin with # are skipped. OGR: points and multi-points, their Z or the field z, reprojected and rounded to 1e-6 m
/// like read_rivers. Point clouds: LAS 1.0 to 1.4 of any point format, LAZ and COPC where LASzip is installed, by their
/// content; withheld points are left out.
/// \return in the file's order; of a thinned point cloud by cell, so that the order of its points does not matter
/// \throws BadInput naming file and line or feature: missing file, layer or height, several layers of points, no
/// points, a feature that is not a point, a value that is not a finite number, no CRS (except text), coordinates that
/// cannot be reprojected, text without names that has more than three columns, text without a CRS that can only be
/// longitudes and latitudes (if params.source_crs is set), a point cloud that is damaged, truncated, compressed in a
/// build without LASzip, in E57, or has no points of the classes
/// \throws BadParameter when columns are not three, classes or thin_m are wrong, or an option does not suit the file
/// \throws IoError when the file cannot be read to its end
///
/// Source: ASPRS, LAS specification version 1.4-R15.
FeaturePoints read_points(ReadPointsParams const& params, Run const& run = {});

/// \internal
/// Tells whether a path's extension is that of text with points.
/// \param path of the file
/// \return true: .csv, .txt or .xyz
bool is_text_of_points(std::string const& path);

/// \internal
/// Tells whether a file begins as a point cloud does, or is named as one.
/// \param path of the file
/// \return true: LAS, LAZ (COPC too) or E57, which read_points() refuses with what to do
bool is_point_cloud(std::string const& path);

/// Formats of point clouds.
enum class PointFormat : std::uint8_t {
    ply, ///< PLY, binary, coordinates as doubles
    las, ///< LAS 1.2, point format 0
    xyz, ///< text, x y z of one point per line
};

/// A point format name.
struct PointFormatName {
    PointFormat format;
    char const* name;   ///< "las"
    char const* ending; ///< ".las"
};
std::vector<PointFormatName> const& point_formats();

/// Finds a format.
/// \param name its name; "": by the path's extension, ignoring case
/// \param path of the file
/// \return the format
/// \throws BadParameter that lists the names
PointFormat point_format(std::string const& name, std::string const& path);

/// Classification of a point in LAS.
enum class PointClass : std::uint8_t {
    ground = 2,    ///< cells of terrain
    key_point = 8, ///< points of a file, ridges and points of a skeleton (model key-point)
    water = 9      ///< rivers of a skeleton
};

/// Options of write_points().
struct WritePointsParams {
    PointFormat format = PointFormat::las;
    std::int64_t every = 1; ///< [1, ...] writes every n-th point, or row and column, starting with the first
};

/// Writes points, or the centres of all cells with a height, as a new file. crs as in Grid is kept by ply (comment) and
/// las (EPSG code); rivers: a mask in the skeleton's frame.
/// \param points in any order
/// \param path of the file
/// \return number of points, written in their order, cells row by row from the north-west. Coordinates read back bit
/// for bit, in text a cell's height as a float; in LAS within half a millimetre, or half a thousandth of a cell below a
/// metre (of extents that need more than 32 bits: half the least power of ten that fits). The same bytes on any day.
/// \throws BadInput naming point or cell when a number is not finite, when there is no point, too many for LAS, or the
/// mask has another frame
/// \throws IoError also when the file exists
///
/// Source: ASPRS LAS 1.2; \cite turk1994, The PLY polygon file format.
std::uint64_t write_points(FeaturePoints const& points, std::string const& path, WritePointsParams const& params = {},
                           Run const& run = {});
std::uint64_t write_points(Raster<float> const& land, std::string const& path, WritePointsParams const& params = {},
                           Run const& run = {});
std::uint64_t write_points(Skeleton const& skeleton, Mask const& rivers, std::string const& path,
                           WritePointsParams const& params = {}, Run const& run = {});

} // namespace thalweg::io
