// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

namespace thalweg::tools {

/// The option of commands that read a DEM.
inline void add_nodata_option(CLI::App& app, std::optional<double>& nodata) {
    app.add_option("--nodata", nodata,
                   "Treat DEM cells with this stored value as no-data, beside what the file declares; nan: treat every "
                   "value as a height. Default: refuse values that look like undeclared no-data.")
        ->type_name("V");
}

} // namespace thalweg::tools
