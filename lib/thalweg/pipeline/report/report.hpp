// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/pipeline/make/make.hpp>

namespace thalweg::pipeline {

/// \param made a terrain with all that led to it
/// \return report.json of a terrain: version, recipe, timings_s, peak_rss_mb, network, dem, checks, repairs, files.
std::string write_report(Made const& made, std::vector<std::string> const& files);

/// \param json the text of a report.json
/// \return the files an earlier report.json lists; empty where the text is none.
std::vector<std::string> files_of_report(std::string const& json);

/// \return statistics as one JSON object, as they stand under "dem" in report.json; laws: of the DEM's rivers, or null;
/// relief: or null.
std::string statistics_json(measure::Statistics const& statistics, DemLaws const* laws = nullptr,
                            TerrainRelief const* relief = nullptr);

/// \return Checks as one JSON array, as they stand under "checks" in report.json.
std::string checks_json(std::vector<Check> const& checks);

/// \return the version of thalweg, e.g. "0.2.0".
std::string version();

/// \throws BadInput when the folder is taken and may not be replaced: asked before the work, not after
void check_folder(std::string const& folder, io::Existing existing);

/// Writes everything `make` leaves behind into a folder, whole or not at all.
/// \param made a terrain with all that led to it
/// \return the names of the files, report.json last. Under replace it removes what the old report.json lists, nothing
/// else.
/// \throws BadInput (the folder is taken), IoError, Cancelled: then nothing has changed
std::vector<std::string> write_terrain(Made const& made, std::string const& folder,
                                       io::Existing existing = io::Existing::refuse, Run const& run = {});

} // namespace thalweg::pipeline
