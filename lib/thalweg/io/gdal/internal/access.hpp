// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

/// What GDAL may reach.
namespace thalweg::io {

/// Takes GDAL's doors to the network away: drivers that connect, addresses as file names, fetches by HTTP. Pipes and
/// devices are not opened either, wherever a name comes from. To be called once, when the drivers are registered.
void guard_gdal();

/// While one lives, a server may be reached: one that the user names. A server that does not answer within 10 s is
/// given up.
class Connection {
public:
    Connection();
    ~Connection();
    Connection(Connection const&) = delete;
    Connection& operator=(Connection const&) = delete;
};

/// While one lives, GDAL opens files in the folder of this file only, and its own tables.
class Confined {
public:
    explicit Confined(std::string const& path);
    ~Confined();
    Confined(Confined const&) = delete;
    Confined& operator=(Confined const&) = delete;

private:
    std::string near_; ///< the folder by the path's own words
    std::string real_; ///< and where links lead
};

/// While one lives, GDAL reads netCDF. Its library connects by itself, where a name is an address.
class WithNetcdf {
public:
    explicit WithNetcdf(std::string const& path); ///< nothing changes unless the file is one
    ~WithNetcdf();
    WithNetcdf(WithNetcdf const&) = delete;
    WithNetcdf& operator=(WithNetcdf const&) = delete;

private:
    bool added_ = false;
};

/// What a source named and the guard refused; "" for nothing.
struct Refusal {
    std::string address = {};
    std::string pipe = {}; ///< or a device
    std::string grid = {}; ///< of a datum, outside PROJ's folders
};

/// What was refused in this thread since the last call.
Refusal take_refusal();

/// Throws: BadInput that begins with what, where something was refused.
void throw_refusal(Refusal const& refusal, std::string const& what);

} // namespace thalweg::io
