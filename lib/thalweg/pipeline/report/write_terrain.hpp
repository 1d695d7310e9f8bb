// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/pipeline/make/make.hpp>

namespace thalweg::pipeline {

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
