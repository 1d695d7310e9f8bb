// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// Holds GDAL's drivers and error handler for as long as it lives; every door of this room opens one.
/// Errors GDAL only logs (a flush that failed at close, a corrupt tile) are kept and thrown by check().
class Driver {
public:
    Driver();
    ~Driver();
    Driver(Driver const&) = delete;
    Driver& operator=(Driver const&) = delete;
    /// Throws IoError with GDAL's words when an error came since the last call. what: "io.write_dem: out/dem.tif".
    void check(std::string const& what) const;
};

/// The name and version of GDAL, for reports.
std::string gdal_version();

} // namespace thalweg::io
