// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::commands {

/// Options of run_draw().
struct DrawParams {
    /// a folder written by make, or a DEM; of an ensemble its table.csv, or the folder that holds it
    std::string source;
    /// a folder, which may have other content, for files WHAT.FORMAT and page.html; or the name of one picture, ending
    /// in .png, .svg or .pdf, or of a report page, ending in .html. Of an ensemble: distributions.FORMAT,
    /// responses_KEY.FORMAT, contact_sheet.png and ensemble.html; or one picture of the distributions, or the page
    std::string output;
    io::Existing existing = io::Existing::refuse; ///< replace: files of the same name are replaced, nothing else
    /// names of kinds, or page; or ensemble, alone; empty: all pictures that can be drawn
    std::vector<std::string> what;
    /// png, svg, pdf; empty: the extension of the output, else png, of an ensemble svg
    std::vector<std::string> formats;
    std::string network;            ///< file of river lines over a DEM; "": none
    std::string title;              ///< "": the scene's own
    report::Look look;              ///< its format is not used
    io::ReadDemParams reading = {}; ///< how the DEM is read
};

/// What run_draw() returns.
struct DrawResult {
    std::vector<std::string> files; ///< paths, folder included
    std::vector<Finding> findings;  ///< changes and choices
};

/// Runs `thalweg draw`: draws pictures of a folder written by make, of a raster, or of an ensemble. Each file is
/// written completely or not at all.
/// \return the files written
/// \throws BadParameter for an unknown kind or format (with a suggestion), or several pictures for one name
/// \throws BadInput for a picture that cannot be drawn, or a file that exists already; as the readers and the pictures
DrawResult run_draw(DrawParams const& params, Run const& run = {});

} // namespace thalweg::commands
