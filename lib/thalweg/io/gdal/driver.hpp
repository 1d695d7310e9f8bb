// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

namespace thalweg::io {

/// Holds GDAL's drivers and, for the calling thread, its error handler; every public function of this module creates
/// one as a local variable before any dataset, and closes the datasets before the last check(). Errors that GDAL only
/// logs (a failed flush at close, a corrupt tile) are kept and thrown by check().
class Driver {
public:
    Driver();
    ~Driver();
    Driver(Driver const&) = delete;
    Driver& operator=(Driver const&) = delete;
    /// Throws errors that GDAL reported since the last call.
    /// \param where the public function that was called: "io.write_dem"
    /// \param name of the file, for messages: "out/dem.tif"; "": the call has none
    /// \throws IoError with GDAL's message
    /// \throws BadInput when a file requested a connection or names a CRS that does not exist
    void check(std::string const& where, std::string const& name = "") const;
    /// \return GDAL's messages since the last call, for the caller's own error; "": none
    std::string take() const;

private:
    struct Log;
    std::unique_ptr<Log> log_;
};

/// \return the name and version of GDAL, for reports
std::string gdal_version();

} // namespace thalweg::io
