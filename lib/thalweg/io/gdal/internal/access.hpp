// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <thread>

#include <thalweg/io/files/internal/about.hpp>

/// What GDAL may access.
namespace thalweg::io {

/// Blocks GDAL's access to the network: drivers that connect, addresses as file names, fetches by HTTP. Pipes and
/// devices are not opened either, whatever their name comes from. Call it once, after the drivers are registered.
void guard_gdal();

/// Whether share_gdal() was called.
bool is_gdal_shared();

/// A thread begins and ends to use GDAL for this library; pairs may be nested.
void enter_gdal();
void leave_gdal();

/// While an object lives, one server that the user names may be contacted. It must respond within 10 s.
class Connection {
public:
    Connection();
    ~Connection();
    Connection(Connection const&) = delete;
    Connection& operator=(Connection const&) = delete;
};

/// While an object lives, GDAL opens only files in the folder of this file, and its own tables, on this thread.
class ConfinedFolder {
public:
    explicit ConfinedFolder(std::string const& path);
    ~ConfinedFolder();
    ConfinedFolder(ConfinedFolder const&) = delete;
    ConfinedFolder& operator=(ConfinedFolder const&) = delete;

private:
    std::thread::id thread_;
    std::string near_; ///< the folder as in the path
    std::string real_; ///< the folder after resolving links
};

/// While an object lives, GDAL reads netCDF, whose library connects on its own if a name is an address.
class WithNetcdf {
public:
    explicit WithNetcdf(std::string const& path); ///< has no effect unless the file is netCDF
    ~WithNetcdf();
    WithNetcdf(WithNetcdf const&) = delete;
    WithNetcdf& operator=(WithNetcdf const&) = delete;

    /// Whether no other driver is meant: those of raw data take any file beside whose name a header lies, NAME.hdr.
    bool is_meant() const { return is_meant_; }

private:
    bool is_meant_ = false;
    bool added_ = false;
};

/// An access that a source requested and the guard refused; "": none.
struct Refusal {
    std::string address = {};
    std::string pipe = {}; ///< or a device
    std::string grid = {}; ///< of a datum, outside PROJ's folders
};

/// Returns and clears this thread's last refusal.
Refusal take_refusal();

/// Throws BadInput if something was refused.
void throw_refusal(Refusal const& refusal, About const& about);

} // namespace thalweg::io
