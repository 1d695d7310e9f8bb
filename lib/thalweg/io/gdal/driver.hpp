// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

namespace thalweg::io {

/// Holds GDAL's drivers and, for the calling thread, its error handler for as long as it lives; every door of this
/// module opens one as a local variable, before any dataset, and closes the datasets before the last check().
/// Errors GDAL only logs (a flush that failed at close, a corrupt tile) are kept and thrown by check().
class Driver {
public:
    Driver();
    ~Driver();
    Driver(Driver const&) = delete;
    Driver& operator=(Driver const&) = delete;
    /// \param what what was done, for messages
    /// \throws IoError with GDAL's words when an error came since the last call, BadInput when a file wanted a
    /// connection or names a CRS that does not exist. what: "io.write_dem: out/dem.tif"
    void check(std::string const& what) const;
    /// \return GDAL's words for the errors since the last call, "" for none: for messages of one's own.
    std::string take() const;

private:
    struct Log;
    std::unique_ptr<Log> log_;
};

/// \return the name and version of GDAL, for reports.
std::string gdal_version();

} // namespace thalweg::io
