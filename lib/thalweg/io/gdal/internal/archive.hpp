// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// The name by which GDAL opens what a zip archive holds: the archive itself, or the only folder in it where its files
/// lie there. Any other path is given back. Private to this module. Needs a Driver that outlives it.
std::string inside_archive(std::string const& path);

} // namespace thalweg::io
