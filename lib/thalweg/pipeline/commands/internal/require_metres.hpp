// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>

namespace thalweg::pipeline {

/// Throws BadInput where a file's coordinates are known not to be metres.
/// Takes: the grid read from the file at path; who asks, as messages begin: "pipeline.make_points".
void require_metres(Grid const& grid, std::string const& path, char const* who);

} // namespace thalweg::pipeline
