// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/access.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <span>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>
#include <proj.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/internal/access.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

bool names_connection(std::string const& path) {
    static constexpr std::array local{"/vsimem/", "/vsizip/", "/vsigzip/", "/vsitar/", "/vsisubfile/", "/vsisparse/"};
    std::string_view const name = path;
    if (name.starts_with("PG:") || name.starts_with("postgresql:") || name.starts_with("postgres:")) {
        return true;
    }
    if (!name.starts_with("/vsi")) {
        return false;
    }
    for (std::string_view const system : local) {
        if (name.starts_with(system)) { // others may be nested: /vsizip//vsicurl/..., /vsizip/{/vsicurl/...}
            std::size_t const inner = name.find_first_not_of("/{", system.size());
            return inner != std::string_view::npos && names_connection("/" + std::string(name.substr(inner)));
        }
    }
    std::error_code ignored;
    return !fs::exists(path, ignored);
}

void require_allowed(Source const& source) {
    if (source.access != Access::recipe) {
        return;
    }
    std::string const& path = source.path;
    refuse_if<BadInput>(names_connection(path), "io.require_allowed",
                        "a recipe names files, and '{}' is a connection: name it on the command line, or convert it to "
                        "a file (ogr2ogr)",
                        path);
    refuse_pipe(path, {"io.require_allowed", path});
    std::error_code ignored;
    auto const status = fs::status(path, ignored);
    refuse_if<BadInput>(!fs::exists(status), "io.require_allowed", "there is no file '{}'", path);
    refuse_if<BadInput>(!fs::is_regular_file(status) && !fs::is_directory(status), "io.require_allowed",
                        "{} is neither a file nor a folder", path);
}

namespace {

// Drivers that connect to servers, also when only a file or a VRT asks for it; GPSBabel starts a program.
constexpr std::array network_drivers{
    "AmigoCloud",    "Carto",        "CSW",      "DAAS",     "DODS",     "EEDA",     "EEDAI",
    "Elasticsearch", "GeoRaster",    "GMLAS",    "GPSBabel", "HANA",     "HTTP",     "JPIPKAK",
    "MongoDBv3",     "MSSQLSpatial", "MySQL",    "NAS",      "NGW",      "OAPIF",    "OCI",
    "ODBC",          "OGCAPI",       "OGR_OGDI", "PGeo",     "PLMOSAIC", "PLSCENES", "PostGISRaster",
    "RDA",           "STACIT",       "STACTA",   "WCS",      "WFS",      "WMS",      "WMTS"};

// Drivers of files that make GDAL open others by any driver, and hold no heights or rivers that a user would name.
constexpr std::array chained_drivers{"GTI", "KMLSuperOverlay", "PDF", "Rasterlite", "RPFTOC", "RS2"};

// GDAL's file systems that stay on this machine.
constexpr std::array local_systems{"/vsimem/",   "/vsizip/",     "/vsigzip/",
                                   "/vsitar/",   "/vsisubfile/", "/vsisparse/",
                                   "/vsicrypt/", "/vsistdout/",  "/vsistdout_redirect/",
                                   "/vsicached?"};

std::atomic<int> connections{0};
std::atomic<bool> is_shared{false};
thread_local int inside = 0; ///< Drivers of this thread
thread_local Refusal refused;

struct Roots {
    std::mutex mutex;
    std::map<std::thread::id, std::vector<std::string>>
        folders;        ///< by thread: two entries for each ConfinedFolder of it
    std::string tables; ///< GDAL's own
};

Roots& roots() {
    static Roots all;
    return all;
}

/// Drivers kept but not registered.
struct UnregisteredDrivers {
    GDALDriver* postgres = nullptr;
    GDALDriver* netcdf = nullptr;
    std::vector<GDALDriver*> never;
};

UnregisteredDrivers& unregistered_drivers() {
    static UnregisteredDrivers drivers;
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
    auto const own = all.folders.find(std::this_thread::get_id());
    if (own == all.folders.end()) {
        return true;
    }
    std::string const real = real_path(path);
    return lies_in(real, all.tables) ||
           std::ranges::any_of(own->second, [&](std::string const& folder) { return lies_in(real, folder); });
}

/// Whether a call comes from others who use GDAL in this process.
bool is_of_others() {
    return is_shared && inside == 0;
}

bool is_no_pipe(char const* path) {
    if (is_of_others() || !is_pipe_or_device(path)) {
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
    if (connections > 0 || is_of_others()) {
        return true;
    }
    refuse_address(path);
    return false;
}

bool is_any(char const* /*path*/) {
    return true;
}

/// A file system of GDAL's that is closed to some names.
class GuardedFileSystem : public VSIFilesystemHandler {
public:
    using Allows = bool (*)(char const*);
    /// allows: which files may be accessed; opens: which of them may be opened.
    GuardedFileSystem(VSIFilesystemHandler* inner, Allows allows, Allows opens = is_any)
        : inner_(inner), allows_(allows), opens_(opens) {}
    ~GuardedFileSystem() override { delete inner_; }
    GuardedFileSystem(GuardedFileSystem const&) = delete;
    GuardedFileSystem& operator=(GuardedFileSystem const&) = delete;

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

    VSIFilesystemHandler* inner_; // deleted here: GDAL deletes this handler, which owns the inner one
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
            VSIFileManager::InstallHandler(
                prefixes[i], new GuardedFileSystem(VSIFileManager::GetHandler(prefixes[i]), is_reachable));
        }
    }
    VSIFileManager::InstallHandler("", new GuardedFileSystem(VSIFileManager::GetHandler(""), is_near, is_no_pipe));
}

void set_unless_set(char const* option, char const* value) {
    if (CPLGetConfigOption(option, nullptr) == nullptr) {
        CPLSetConfigOption(option, value);
    }
}

// GDAL starts no Python, writes NAME.gz.properties beside no archive, and puts temporary files (of OpenStreetMap's
// nodes beyond 100 MB) where they belong: by itself it takes the current folder.
std::vector<std::pair<std::string, std::string>> const& own_settings() {
    static std::vector<std::pair<std::string, std::string>> const settings = [] {
        std::vector<std::pair<std::string, std::string>> all{{"GDAL_VRT_ENABLE_PYTHON", "NO"},
                                                             {"CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO"},
                                                             // ours are fixed, and checking them reads large tables
                                                             {"GDAL_VALIDATE_CREATION_OPTIONS", "NO"}};
        std::error_code failed;
        std::string const folder = fs::temp_directory_path(failed).string();
        if (!failed && CPLGetConfigOption("CPL_TMPDIR", nullptr) == nullptr) {
            all.emplace_back("CPL_TMPDIR", folder);
        }
        return all;
    }();
    return settings;
}

std::vector<std::string> folders_of_proj() {
    std::vector<std::string> folders;
    std::string_view rest = proj_info().searchpath;
    while (!rest.empty()) {
        std::size_t const end = std::min(rest.find(':'), rest.size());
        if (end > 0) {
            folders.push_back((fs::absolute(rest.substr(0, end)) / "").lexically_normal().string());
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return folders;
}

std::vector<std::string> const& proj_folders() {
    static std::vector<std::string> const folders = folders_of_proj();
    return folders;
}

/// PROJ tries a name without a folder in each of its folders and finally in the current one; failure there is normal.
bool is_of_proj(char const* name) noexcept {
    try {
        std::string const path = fs::absolute(name).lexically_normal().string();
        if (std::ranges::any_of(proj_folders(), [&](std::string const& folder) { return path.starts_with(folder); })) {
            return true;
        }
        if (std::string_view(name).find('/') != std::string_view::npos) {
            refused.grid = name;
        }
    } catch (std::exception const&) { // exceptions must not cross C frames
    }
    return false;
}

std::FILE* file_of(PROJ_FILE_HANDLE* handle) {
    return reinterpret_cast<std::FILE*>(handle);
}

PROJ_FILE_HANDLE* open_file_of_proj(PJ_CONTEXT*, char const* name, PROJ_OPEN_ACCESS access, void*) {
    bool const may = access == PROJ_OPEN_ACCESS_READ_ONLY && is_of_proj(name);
    return may ? reinterpret_cast<PROJ_FILE_HANDLE*>(std::fopen(name, "rbe")) : nullptr;
}
std::size_t read_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void* to, std::size_t bytes, void*) {
    return std::fread(to, 1, bytes, file_of(handle));
}
std::size_t write_no_file(PJ_CONTEXT*, PROJ_FILE_HANDLE*, void const*, std::size_t, void*) {
    return 0;
}
int seek_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, long long offset, int whence, void*) {
    return std::fseek(file_of(handle), static_cast<long>(offset), whence) == 0 ? 1 : 0;
}
unsigned long long tell_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) {
    return static_cast<unsigned long long>(std::ftell(file_of(handle)));
}
void close_file_of_proj(PJ_CONTEXT*, PROJ_FILE_HANDLE* handle, void*) {
    std::fclose(file_of(handle));
}
int exists_for_proj(PJ_CONTEXT*, char const* name, void*) {
    std::error_code ignored;
    return is_of_proj(name) && fs::exists(name, ignored) ? 1 : 0;
}
int change_no_file(PJ_CONTEXT*, char const*, void*) {
    return 0;
}
int rename_no_file(PJ_CONTEXT*, char const*, char const*, void*) {
    return 0;
}

constexpr PROJ_FILE_API own_files{1,
                                  open_file_of_proj,
                                  read_file_of_proj,
                                  write_no_file,
                                  seek_file_of_proj,
                                  tell_file_of_proj,
                                  close_file_of_proj,
                                  exists_for_proj,
                                  change_no_file,
                                  change_no_file,
                                  rename_no_file};

} // namespace

void share_gdal() {
    is_shared = true;
}

bool is_gdal_shared() {
    return is_shared;
}

void enter_gdal() {
    if (inside++ == 0 && is_shared) {
        CPLHTTPPushFetchCallback(refuse_fetch, nullptr);
        for (auto const& [option, value] : own_settings()) {
            CPLSetThreadLocalConfigOption(option.c_str(), value.c_str());
        }
    }
}

void leave_gdal() {
    if (--inside == 0 && is_shared) {
        CPLHTTPPopFetchCallback();
        for (auto const& [option, value] : own_settings()) {
            CPLSetThreadLocalConfigOption(option.c_str(), nullptr);
        }
    }
}

void guard_gdal() {
    if (!is_shared) {
        for (auto const& names :
             {std::span<char const* const>(network_drivers), std::span<char const* const>(chained_drivers)}) {
            for (char const* const name : names) {
                if (GDALDriver* const driver = take_away(name)) {
                    unregistered_drivers().never.push_back(driver);
                }
            }
        }
        if (GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM")) {
            memory->pfnOpen = nullptr; // a name with an address would be read as it stands; creating needs none
            memory->pfnIdentify = nullptr;
        }
        unregistered_drivers().postgres = take_away("PostgreSQL");
        unregistered_drivers().netcdf = take_away("netCDF");
        for (auto const& [option, value] : own_settings()) {
            CPLSetConfigOption(option.c_str(), value.c_str());
        }
        CPLHTTPSetFetchCallback(refuse_fetch, nullptr);
    }
    if (char const* const table = CPLFindFile("gdal", "gdalvrt.xsd")) {
        roots().tables = real_path(fs::path(table).parent_path());
    }
    guard_file_systems();
}

Connection::Connection() {
    if (connections++ == 0) {
        setenv("PGCONNECT_TIMEOUT", "10", 0);
        set_unless_set("GDAL_HTTP_CONNECTTIMEOUT", "10");
        set_unless_set("GDAL_HTTP_LOW_SPEED_TIME", "10");
        set_unless_set("GDAL_HTTP_LOW_SPEED_LIMIT", "1");
        if (unregistered_drivers().postgres != nullptr) {
            GetGDALDriverManager()->RegisterDriver(unregistered_drivers().postgres);
        }
    }
}

Connection::~Connection() {
    if (--connections == 0 && unregistered_drivers().postgres != nullptr) {
        GetGDALDriverManager()->DeregisterDriver(unregistered_drivers().postgres);
    }
}

ConfinedFolder::ConfinedFolder(std::string const& path) : thread_(std::this_thread::get_id()) {
    std::error_code ignored;
    fs::path const file = fs::absolute(path, ignored);
    fs::path const real = real_path(file);
    bool const is_folder = fs::is_directory(file, ignored);
    near_ = real_path(is_folder ? file : file.parent_path());
    real_ = is_folder ? real.string() : real.parent_path().string();
    std::lock_guard const lock(roots().mutex);
    std::vector<std::string>& folders = roots().folders[thread_];
    folders.insert(folders.end(), {near_, real_});
}

ConfinedFolder::~ConfinedFolder() {
    std::lock_guard const lock(roots().mutex);
    std::vector<std::string>& folders = roots().folders[thread_];
    for (std::string const& folder : {near_, real_}) {
        if (auto const at = std::ranges::find(folders, folder); at != folders.end()) {
            folders.erase(at);
        }
    }
    if (folders.empty()) {
        roots().folders.erase(thread_);
    }
}

WithNetcdf::WithNetcdf(std::string const& path) {
    std::array<char, 4> head{};
    std::error_code ignored;
    if (unregistered_drivers().netcdf == nullptr || !fs::is_regular_file(path, ignored)) {
        return;
    }
    std::ifstream(path, std::ios::binary).read(head.data(), head.size());
    std::string_view const magic(head.data(), head.size());
    if (magic.starts_with("CDF") || magic == "\x89HDF") {
        added_ = true;
        GetGDALDriverManager()->RegisterDriver(unregistered_drivers().netcdf);
        std::string const ending = fs::path(path).extension().string();
        is_meant_ = magic.starts_with("CDF") || EQUAL(ending.c_str(), ".nc") || EQUAL(ending.c_str(), ".nc4");
    }
}

WithNetcdf::~WithNetcdf() {
    if (added_) {
        GetGDALDriverManager()->DeregisterDriver(unregistered_drivers().netcdf);
    }
}

Refusal take_refusal() {
    return std::exchange(refused, {});
}

void throw_refusal(Refusal const& refusal, About const& about) {
    refuse_if<BadInput>(!refusal.address.empty(), about.where,
                        "{} makes a connection ({}), and thalweg connects only to what the command line names; take "
                        "the address out of the file",
                        about.name, refusal.address);
    refuse_if<BadInput>(
        !refusal.pipe.empty(), about.where,
        "{} needs {}, which is a pipe or a device, and inputs are read more than once: write it to a file first",
        about.name, refusal.pipe);
    refuse_if<BadInput>(!refusal.grid.empty(), about.where,
                        "{} names {}, and a CRS names grids of PROJ's own folders (projinfo --searchpaths): copy it "
                        "there and leave its folder out",
                        about.name, refusal.grid);
}

void confine_proj(pj_ctx* context) {
    proj_context_set_fileapi(context, &own_files, nullptr);
}

} // namespace thalweg::io
