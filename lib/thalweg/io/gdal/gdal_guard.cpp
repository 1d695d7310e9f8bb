// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/gdal_guard.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

// Drivers that connect to servers, also where only a file or a VRT tells them to; GPSBabel starts a program.
constexpr std::array network_drivers{
    "AmigoCloud",    "Carto",        "CSW",      "DAAS",     "DODS",     "EEDA",     "EEDAI",
    "Elasticsearch", "GeoRaster",    "GMLAS",    "GPSBabel", "HANA",     "HTTP",     "JPIPKAK",
    "MongoDBv3",     "MSSQLSpatial", "MySQL",    "NAS",      "NGW",      "OAPIF",    "OCI",
    "ODBC",          "OGCAPI",       "OGR_OGDI", "PGeo",     "PLMOSAIC", "PLSCENES", "PostGISRaster",
    "RDA",           "STACIT",       "STACTA",   "WCS",      "WFS",      "WMS",      "WMTS"};

// File systems of GDAL's that stay on this machine.
constexpr std::array local_systems{"/vsimem/",   "/vsizip/",     "/vsigzip/",
                                   "/vsitar/",   "/vsisubfile/", "/vsisparse/",
                                   "/vsicrypt/", "/vsistdout/",  "/vsistdout_redirect/",
                                   "/vsicached?"};

std::atomic<int> connections{0};
thread_local Refusal refused;

struct Roots {
    std::mutex mutex;
    std::vector<std::string> folders; ///< one of each Confined, twice
    std::string tables;               ///< GDAL's own
};

Roots& roots() {
    static Roots all;
    return all;
}

/// Drivers that are at hand but not registered.
struct Aside {
    GDALDriver* postgres = nullptr;
    GDALDriver* netcdf = nullptr;
    std::vector<GDALDriver*> never;
};

Aside& drivers_aside() {
    static Aside drivers;
    return drivers;
}

std::string real_path(fs::path const& path) {
    std::error_code failed;
    fs::path const real = fs::weakly_canonical(fs::absolute(path, failed), failed);
    return failed ? "" : real.string();
}

bool lies_in(std::string const& path, std::string const& folder) {
    return !folder.empty() && path.starts_with(folder) &&
           (path.size() == folder.size() || folder.back() == '/' || path[folder.size()] == '/');
}

bool is_near(char const* path) {
    Roots& all = roots();
    std::lock_guard const lock(all.mutex);
    if (all.folders.empty()) {
        return true;
    }
    std::string const real = real_path(path);
    return lies_in(real, all.tables) ||
           std::ranges::any_of(all.folders, [&](std::string const& folder) { return lies_in(real, folder); });
}

bool is_no_pipe(char const* path) {
    if (!is_pipe_or_device(path)) {
        return true;
    }
    refused.pipe = path;
    CPLError(CE_Failure, CPLE_OpenFailed, "%s is a pipe or a device", path);
    return false;
}

void refuse_address(std::string const& address) {
    refused.address = address;
    CPLError(CE_Failure, CPLE_AppDefined, "no connection to %s: only what the command line names is reached",
             address.c_str());
}

bool is_reachable(char const* path) {
    if (connections > 0) {
        return true;
    }
    refuse_address(path);
    return false;
}

bool is_any(char const* /*path*/) {
    return true;
}

/// A file system of GDAL's that some names do not reach.
class Guarded : public VSIFilesystemHandler {
public:
    using Allows = bool (*)(char const*);
    /// Takes: what may be touched at all, and what of that may be opened.
    Guarded(VSIFilesystemHandler* inner, Allows allows, Allows opens = is_any)
        : inner_(inner), allows_(allows), opens_(opens) {}
    ~Guarded() override { delete inner_; }
    Guarded(Guarded const&) = delete;
    Guarded& operator=(Guarded const&) = delete;

    VSIVirtualHandle* Open(char const* path, char const* access, bool set_error, CSLConstList options) override {
        if (!may(path)) {
            return nullptr;
        }
        if (!opens_(path)) {
            errno = EACCES;
            return nullptr;
        }
        return inner_->Open(path, access, set_error, options);
    }
    int Stat(char const* path, VSIStatBufL* status, int flags) override {
        return may(path) ? inner_->Stat(path, status, flags) : -1;
    }
    int Unlink(char const* path) override { return may(path) ? inner_->Unlink(path) : -1; }
    int* UnlinkBatch(CSLConstList files) override { return inner_->UnlinkBatch(files); }
    int Mkdir(char const* path, long mode) override { return may(path) ? inner_->Mkdir(path, mode) : -1; }
    int Rmdir(char const* path) override { return may(path) ? inner_->Rmdir(path) : -1; }
    int RmdirRecursive(char const* path) override { return may(path) ? inner_->RmdirRecursive(path) : -1; }
    char** ReadDirEx(char const* path, int most) override {
        return may(path) ? inner_->ReadDirEx(path, most) : nullptr;
    }
    char** SiblingFiles(char const* path) override { return may(path) ? inner_->SiblingFiles(path) : nullptr; }
    int Rename(char const* from, char const* to) override {
        return may(from) && may(to) ? inner_->Rename(from, to) : -1;
    }
    int IsCaseSensitive(char const* path) override { return inner_->IsCaseSensitive(path); }
    GIntBig GetDiskFreeSpace(char const* path) override { return inner_->GetDiskFreeSpace(path); }
    int SupportsSparseFiles(char const* path) override { return inner_->SupportsSparseFiles(path); }
    int HasOptimizedReadMultiRange(char const* path) override { return inner_->HasOptimizedReadMultiRange(path); }
    char const* GetActualURL(char const* path) override { return inner_->GetActualURL(path); }
    char const* GetOptions() override { return inner_->GetOptions(); }
    char* GetSignedURL(char const* path, CSLConstList options) override {
        return may(path) ? inner_->GetSignedURL(path, options) : nullptr;
    }
    bool Sync(char const* from, char const* to, char const* const* options, GDALProgressFunc progress, void* data,
              char*** outputs) override {
        return may(from) && may(to) && inner_->Sync(from, to, options, progress, data, outputs);
    }
    VSIDIR* OpenDir(char const* path, int depth, char const* const* options) override {
        return may(path) ? inner_->OpenDir(path, depth, options) : nullptr;
    }
    char** GetFileMetadata(char const* path, char const* domain, CSLConstList options) override {
        return may(path) ? inner_->GetFileMetadata(path, domain, options) : nullptr;
    }
    bool SetFileMetadata(char const* path, CSLConstList metadata, char const* domain, CSLConstList options) override {
        return may(path) && inner_->SetFileMetadata(path, metadata, domain, options);
    }
    bool AbortPendingUploads(char const* path) override { return inner_->AbortPendingUploads(path); }
    std::string GetStreamingFilename(std::string const& path) const override {
        return inner_->GetStreamingFilename(path);
    }
    bool IsLocal(char const* path) override { return inner_->IsLocal(path); }
    bool SupportsSequentialWrite(char const* path, bool local_temporary) override {
        return inner_->SupportsSequentialWrite(path, local_temporary);
    }
    bool SupportsRandomWrite(char const* path, bool local_temporary) override {
        return inner_->SupportsRandomWrite(path, local_temporary);
    }
    bool SupportsRead(char const* path) override { return inner_->SupportsRead(path); }

private:
    bool may(char const* path) const {
        if (allows_(path)) {
            return true;
        }
        errno = EACCES;
        return false;
    }

    VSIFilesystemHandler* inner_; // deleted here: GDAL deletes what it holds, and it holds this
    Allows allows_;
    Allows opens_;
};

CPLHTTPResult* refuse_fetch(char const* url, CSLConstList options, GDALProgressFunc /*progress*/, void* /*data*/,
                            CPLHTTPFetchWriteFunc /*write*/, void* /*to*/, void* /*user*/) {
    auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    if (CSLFetchNameValue(options, "CLOSE_PERSISTENT") == nullptr) {
        refuse_address(url);
        result->nStatus = 1;
        result->pszErrBuf = CPLStrdup("connections are refused");
    }
    return result;
}

GDALDriver* take_away(char const* name) {
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(name);
    if (driver != nullptr) {
        GetGDALDriverManager()->DeregisterDriver(driver);
    }
    return driver;
}

void guard_file_systems() {
    CPLStringList const prefixes(VSIFileManager::GetPrefixes(), TRUE);
    for (int i = 0; i < prefixes.size(); ++i) {
        std::string_view const prefix = prefixes[i];
        if (!prefix.empty() && std::ranges::find(local_systems, prefix) == local_systems.end()) {
            VSIFileManager::InstallHandler(prefixes[i],
                                           new Guarded(VSIFileManager::GetHandler(prefixes[i]), is_reachable));
        }
    }
    VSIFileManager::InstallHandler("", new Guarded(VSIFileManager::GetHandler(""), is_near, is_no_pipe));
}

void set_unless_set(char const* option, char const* value) {
    if (CPLGetConfigOption(option, nullptr) == nullptr) {
        CPLSetConfigOption(option, value);
    }
}

} // namespace

void guard_gdal() {
    for (char const* const name : network_drivers) {
        if (GDALDriver* const driver = take_away(name)) {
            drivers_aside().never.push_back(driver);
        }
    }
    drivers_aside().postgres = take_away("PostgreSQL");
    drivers_aside().netcdf = take_away("netCDF");
    if (char const* const table = CPLFindFile("gdal", "gdalvrt.xsd")) {
        roots().tables = real_path(fs::path(table).parent_path());
    }
    CPLSetConfigOption("GDAL_VRT_ENABLE_PYTHON", "NO");
    CPLHTTPSetFetchCallback(refuse_fetch, nullptr);
    guard_file_systems();
}

Connection::Connection() {
    if (connections++ == 0) {
        setenv("PGCONNECT_TIMEOUT", "10", 0);
        set_unless_set("GDAL_HTTP_CONNECTTIMEOUT", "10");
        set_unless_set("GDAL_HTTP_LOW_SPEED_TIME", "10");
        set_unless_set("GDAL_HTTP_LOW_SPEED_LIMIT", "1");
        if (drivers_aside().postgres != nullptr) {
            GetGDALDriverManager()->RegisterDriver(drivers_aside().postgres);
        }
    }
}

Connection::~Connection() {
    if (--connections == 0 && drivers_aside().postgres != nullptr) {
        GetGDALDriverManager()->DeregisterDriver(drivers_aside().postgres);
    }
}

Confined::Confined(std::string const& path) {
    std::error_code ignored;
    fs::path const file = fs::absolute(path, ignored);
    fs::path const real = real_path(file);
    bool const is_folder = fs::is_directory(file, ignored);
    near_ = real_path(is_folder ? file : file.parent_path());
    real_ = is_folder ? real.string() : real.parent_path().string();
    std::lock_guard const lock(roots().mutex);
    roots().folders.insert(roots().folders.end(), {near_, real_});
}

Confined::~Confined() {
    std::lock_guard const lock(roots().mutex);
    for (std::string const& folder : {near_, real_}) {
        auto& folders = roots().folders;
        if (auto const at = std::ranges::find(folders, folder); at != folders.end()) {
            folders.erase(at);
        }
    }
}

WithNetcdf::WithNetcdf(std::string const& path) {
    std::array<char, 4> head{};
    std::error_code ignored;
    if (drivers_aside().netcdf == nullptr || !fs::is_regular_file(path, ignored)) {
        return;
    }
    std::ifstream(path, std::ios::binary).read(head.data(), head.size());
    std::string_view const magic(head.data(), head.size());
    if (magic.starts_with("CDF") || magic == "\x89HDF") {
        added_ = true;
        GetGDALDriverManager()->RegisterDriver(drivers_aside().netcdf);
    }
}

WithNetcdf::~WithNetcdf() {
    if (added_) {
        GetGDALDriverManager()->DeregisterDriver(drivers_aside().netcdf);
    }
}

void refuse_grid(std::string const& path) {
    refused.grid = path;
}

Refusal take_refusal() {
    return std::exchange(refused, {});
}

void throw_refusal(Refusal const& refusal, std::string const& what) {
    if (!refusal.address.empty()) {
        throw BadInput(fmt::format("{} makes a connection ({}), and thalweg connects only to what the command line "
                                   "names; take the address out of the file",
                                   what, refusal.address));
    }
    if (!refusal.pipe.empty()) {
        throw BadInput(
            fmt::format("{} needs {}, which is a pipe or a device, and inputs are read more than once: write "
                        "it to a file first",
                        what, refusal.pipe));
    }
    if (!refusal.grid.empty()) {
        throw BadInput(fmt::format("{} names {}, and a CRS names grids of PROJ's own folders (projinfo --searchpaths): "
                                   "copy it there and leave its folder out",
                                   what, refusal.grid));
    }
}

} // namespace thalweg::io
