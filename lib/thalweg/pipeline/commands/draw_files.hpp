// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/report/pictures.hpp>

namespace thalweg::pipeline {

/// Options of draw_files().
struct DrawParams {
    std::vector<std::string> what;     ///< names of kinds, or page; none takes all pictures that can be drawn
    std::vector<std::string> formats;  ///< png, svg, pdf; none takes the ending of the output, else png
    std::string network;               ///< file of river lines over a DEM; "" for none
    std::string title;                 ///< "" takes the scene's own
    Look look;                         ///< its format is not used
    std::optional<double> nodata = {}; ///< of a raster, as in io::ReadDemParams
};

/// What draw_files() returns.
struct Drawn {
    std::vector<std::string> files; ///< as they were written, folder included
    std::vector<std::string> notes; ///< what was changed or chosen, in words
};

/// Draws pictures of a folder written by make, or of a raster, into files, whole or not at all.
/// \param source the file or DEM to take from
/// \param output a folder, which may hold other things, for WHAT.FORMAT each and page.html; or the name of one picture,
/// ending in .png, .svg or .pdf, or of a report page, ending in .html
/// \param existing under replace a picture file of the same name is replaced, and nothing else
/// \return the files written
/// \throws BadParameter an unknown kind or format (did you mean), several pictures for one name
/// \throws BadInput a picture that cannot be drawn, a file that is there already; what read_scene and the pictures
/// throw
Drawn draw_files(std::string const& source, std::string const& output, DrawParams const& params,
                 io::Existing existing = io::Existing::refuse, Run const& run = {});

} // namespace thalweg::pipeline
