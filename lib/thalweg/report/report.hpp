// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/make/against.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/measure/relief/statistics.hpp>

namespace thalweg::report {

/// \internal
/// Formats report.json of a terrain: version, recipe, timings_s, cpu_s, peak_mb, peak_rss_mb, network, dem, checks,
/// findings, repairs, files.
/// \param made a terrain
/// \param files names of the files written
/// \param writing times of writing them
/// \return JSON
std::string write_report(make::MakeResult const& made, std::vector<std::string> const& files,
                         Timings const& writing = {});

/// \internal
/// Reads the files that an earlier report.json lists.
/// \param json its text
/// \return empty: the text is not a report
std::vector<std::string> files_of_report(std::string const& json);

/// \internal
/// Formats statistics as one JSON object, as under "dem" in report.json.
/// \param statistics of a DEM
/// \param laws of the DEM's rivers, or null
/// \return JSON
std::string statistics_json(measure::Statistics const& statistics, make::DemLaws const* laws = nullptr,
                            make::TerrainRelief const* relief = nullptr);

/// Formats the laws of river lines as one JSON object: arcs, outlets, length_m, left_out (lines, length_m), horton and
/// tokunaga as under "network" in report.json, laws.
/// \param found the laws
/// \return JSON
std::string line_laws_json(make::LineLaws const& found);

/// \internal
/// Formats checks as one JSON array, as under "checks" in report.json.
/// \param checks any
/// \return JSON
std::string checks_json(std::vector<Check> const& checks);

/// Formats a finding as one JSON object: kind, severity, feature, x and y [m] where it has a place, amount and its
/// unit, text, remedy, key, layer, numbers.
/// \param finding any
/// \return JSON without line breaks
std::string finding_json(Finding const& finding);

/// Formats findings as one JSON array of such objects, as under "findings" in report.json.
/// \param findings any
/// \return JSON without line breaks
std::string findings_json(std::vector<Finding> const& findings);

/// \return the version of thalweg, e.g. "0.2.0"
std::string version();

/// Writes the rivers of a terrain as network.gpkg has them, columns of the user's file among them.
/// \param made a terrain
/// \param path of a new GeoPackage
/// \throws BadInput when the recipe has no rivers; as io::write_geopackage
void write_rivers(make::MakeResult const& made, std::string const& path, Run const& run = {});

/// Options of draw_map().
struct DrawMapParams {
    std::optional<std::string> title = {};     ///< that of the recipe if not set
    int width_px = draw::MapParams{}.width_px; ///< [200, 8000] of the whole sheet; its height follows
};

/// Draws the map of a terrain, as map.png has it.
/// \param made a terrain with a surface
/// \return the picture
/// \throws BadInput when the recipe asks for rivers alone; as draw::map
draw::Picture draw_map(make::MakeResult const& made, DrawMapParams const& params = {}, Run const& run = {});

/// \internal
/// Checks an output folder before the work starts.
/// \param folder of the output
/// \param existing whether its content may be replaced
/// \throws BadInput when the folder has content that must not be replaced
void check_folder(std::string const& folder, io::Existing existing);

/// Writes all output of `make` into a folder, completely or not at all.
/// \param made a terrain
/// \param folder of the output
/// \param existing under replace, files listed in the old report.json are removed, nothing else
/// \return the names of the files, report.json last
/// \throws Error BadInput (the folder has content), IoError, Cancelled: then nothing has changed
std::vector<std::string> write_terrain(make::MakeResult const& made, std::string const& folder,
                                       io::Existing existing = io::Existing::refuse, Run const& run = {});

/// Makes a terrain and writes all output of `make`, as make() and write_terrain() do; with more than one thread files
/// are written while the terrain is assessed.
/// \return as make(), without terrain.water.drainage.area_cells: no file has them
/// \throws Error as make() and write_terrain()
make::MakeResult make_folder(recipe::Recipe const& recipe, std::string const& folder,
                             io::Existing existing = io::Existing::refuse, Run const& run = {});

/// Draws the differences of a terrain and the DEM it is compared with.
/// \internal
draw::Picture differences_against(make::Against const& against, make::Terrain const& terrain, int width_px);

/// Draws a terrain beside the DEM it is compared with.
/// \internal
draw::Picture comparison_against(make::Against const& against, make::Terrain const& terrain, std::string const& title);

// Parts of report.json common to other reports.

/// Figures of a terrain beside a DEM as a JSON object.
/// \internal
std::string figures_against(make::TerrainAgainst const& terrain);

/// Whether a finding is about one of the input's features and no fault.
/// \internal
bool is_repair(Finding const& finding);

/// A certificate as a JSON object.
/// \internal
std::string certificate_json(measure::Certificate const& certificate);

} // namespace thalweg::report
