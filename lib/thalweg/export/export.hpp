// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/surface/gaps/close_gaps.hpp>

namespace thalweg::exports {

enum class ExportFormat : std::uint8_t { png16, r16, r32, exr, glb, obj, stl };

/// The name of an export format.
struct ExportFormatName {
    ExportFormat format;
    char const* name;   ///< "png16"
    char const* ending; ///< ".png"
};
/// \return in the order of the enumeration
std::vector<ExportFormatName> const& export_formats();

enum class ExportPreset : std::uint8_t { unreal, unity, godot, blender, web, print3d };

/// The name of a program that takes a folder of files.
struct ExportPresetName {
    ExportPreset preset;
    char const* name; ///< "unreal"
};
/// \return in the order of the enumeration
std::vector<ExportPresetName> const& export_presets();

/// The name of a treatment of cells without data that are connected with the border.
struct RimGapsName {
    surface::RimGaps rim;
    char const* name; ///< "cut"
};
/// \return in the order of the enumeration
std::vector<RimGapsName> const& rim_gaps();

/// The name of a treatment of cells without data that land encloses.
struct EnclosedGapsName {
    surface::EnclosedGaps holes;
    char const* name; ///< "shore"
};
/// \return in the order of the enumeration
std::vector<EnclosedGapsName> const& enclosed_gaps();

/// Options of run_export().
struct ExportParams {
    std::string source = {}; ///< a folder written by make, or a DEM as io::read_drawable
    /// a new file, with a preset a new folder; folders above are created where they are missing
    std::string output = {};
    /// replace: files of the same names are replaced, with a preset those of an earlier export; nothing else
    io::Existing existing = io::Existing::refuse;
    std::string format = {}; ///< a name of export_formats(); "": by the output's extension; "" with a preset
    std::string preset = {}; ///< a name of export_presets(); "": a single file
    /// samples or vertices of a row and of a column, set together: [2, 16385], of meshes [2, 4097]; not set: the DEM's
    /// cells, in a mesh at most 1025 a side. With a preset: of each tile, as its program takes them; not set: the size
    /// nearest to the DEM's.
    std::optional<std::int64_t> width = {};
    std::optional<std::int64_t> height = {};
    std::optional<double> exaggeration = {}; ///< > 0, factor of a mesh's heights; 1 if not set
    /// > 0, thickness below the lowest height: of stl [m], a tenth of the relief, at least a cell of the DEM, if not
    /// set; of print3d [mm], 3 if not set
    std::optional<double> base = {};
    std::optional<double> print_mm = {}; ///< [mm] of print3d: its longer side; 150 if not set
    io::ReadDemParams reading = {};      ///< how the DEM is read
    /// [1, 64] tiles of a row and of a column, set together, of unreal, unity and godot; 1 if not set
    std::optional<std::int64_t> tiles_across = {};
    std::optional<std::int64_t> tiles_down = {};
    std::vector<std::string> masks = {};        ///< of a preset: names, or "all" or "none"; empty: all
    std::optional<std::int64_t> mask_bits = {}; ///< of a preset: 8 or 16; 8 if not set
    std::optional<double> runoff_mm = {};       ///< [mm/a] > 0, of a preset's rivers; 300 if not set
    std::optional<double> tree_line_m = {};     ///< [m] of a preset's land cover; 1800 if not set
    // Cells without data. Meshes of glb and obj, and the preset web, keep them unless one of these is set.
    std::string rim = {};                   ///< a name of rim_gaps(); "": cut
    std::string holes = {};                 ///< a name of enclosed_gaps(); "": shore
    std::optional<double> sea_level_m = {}; ///< [m] of a DEM; nothing: it has no sea
};

/// What became of the cells without data.
struct ExportedGaps {
    std::string rim = {}; ///< how those connected with the border were treated; "": there are none, or they stay
    std::int64_t rim_cells = 0;
    bool is_cut = false;    ///< the DEM became smaller
    std::string holes = {}; ///< how the others were treated; "": there are none, or they stay
    std::int64_t hole_cells = 0;
    Vec2 hole_levels_m = {};                ///< [m] the lowest and the highest that they got
    std::optional<double> sea_level_m = {}; ///< [m] by --sea-level
};

/// What run_export() wrote.
struct ExportResult {
    std::vector<std::string> files; ///< paths: the file named, its companions, its description (FILE.json)
    std::vector<Finding> findings;  ///< changes and choices
    ExportFormat format = ExportFormat::png16;
    std::int64_t width = 0;       ///< samples or vertices of a row, of all tiles together
    std::int64_t height = 0;      ///< samples or vertices of a column
    Vec2 step_m;                  ///< between neighbours of a row, and of a column
    Vec2 north_west;              ///< [m] position of the first sample or vertex
    std::string crs;              ///< as in Grid
    double min_m = 0.0;           ///< lowest height
    double max_m = 0.0;           ///< highest height
    double metres_per_step = 0.0; ///< [m] of 16 bits; else 0
    std::int64_t holes = 0;       ///< cells of the DEM without data
    /// the level of the sea that they were given; not set: there is none, they are left out, or closed as gaps says
    std::optional<double> hole_m = {};
    ExportedGaps gaps = {};
    std::int64_t vertices = 0;    ///< of a mesh; else 0
    std::int64_t triangles = 0;   ///< of a mesh; else 0
    std::int64_t river_lines = 0; ///< of a glb
    Vec3 origin;                  ///< [m] of a mesh's frame
    double exaggeration = 1.0;    ///< of a mesh
    double base_m = 0.0;          ///< of a solid; else 0
    std::string description;      ///< what FILE.json or export.json says: one JSON object
};

/// Runs `thalweg export`: writes the heights of a terrain as one file for game engines, 3D programs and printers, and
/// beside it FILE.json, which says sizes, heights, axes and position. All files are written, or none. The corners are
/// the centres of the DEM's corner cells (thalweg::lattice). png16, r16, r32, exr: as io::write_heightmap. glb, obj,
/// stl: metres from a local origin in the middle at the lowest height. Cells without data get the level of the sea if
/// the folder's recipe has one; else surface::close_gaps closes them, in glb, obj and for the web only where asked. glb
/// and obj are Y up, with a texture; glb has rivers as lines. stl is a closed solid, Z up. A preset leaves a folder:
/// heights in the format and sizes of its program, in tiles that share their edges; a colour texture; masks as grey
/// PNG; rivers with width and discharge as JSON; for godot and blender a GLB; for web tiles and pages, for print3d a
/// solid; export.json, which says all of it in numbers.
/// \return what was written; the same bytes for any number of threads
/// \throws BadParameter for an unknown format, preset or mask, an option of another one or a size that it cannot have;
/// for exr in a build without OpenEXR
/// \throws BadInput when masks of rivers are asked for and there are none, the size would stretch the DEM by more than
/// 1 %, a file exists already; as surface::close_gaps; as the readers
ExportResult run_export(ExportParams const& params, Run const& run = {});

} // namespace thalweg::exports
