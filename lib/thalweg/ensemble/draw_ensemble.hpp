// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::ensemble {

/// A format of pictures and its name, which is also the extension.
struct NamedFormat {
    char const* name;
    draw::Format format;
};

/// What draw_ensemble() draws, and where.
struct DrawEnsembleParams {
    std::string source; ///< a table.csv, or the folder that holds it
    std::string title;  ///< "": after the folder
    report::Look look;
    std::string folder;
    std::string single;                           ///< name of the only file; "": all files, into the folder
    io::Existing existing = io::Existing::refuse; ///< replace: files of the same name are replaced, nothing else
    std::vector<NamedFormat> formats;
    bool page = false;   ///< the only file is the page
    std::string command; ///< that draws it again
};

/// What draw_ensemble() wrote.
struct DrawnEnsemble {
    std::vector<std::string> files; ///< paths, folder included
    std::vector<Finding> findings;  ///< what is left out
};

/// Draws an ensemble from its table: distributions, responses to the keys that vary, a contact sheet, and a
/// page of all of them.
/// \internal
/// \throws BadInput as read_members_table, and the readers of the DEMs in the table's folder
DrawnEnsemble draw_ensemble(DrawEnsembleParams const& params, Run const& run);

} // namespace thalweg::ensemble
