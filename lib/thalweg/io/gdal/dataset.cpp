// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/dataset.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/access.hpp>
#include <thalweg/io/gdal/internal/virtual_files.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

struct Sqlite {
    bool is_one = false;
    bool is_write_ahead = false;
};

// Reads the header of an SQLite file: its magic, and 2 for write-ahead mode as read and write versions.
Sqlite sqlite_in(fs::path const& file) {
    std::array<char, 20> header{};
    std::ifstream stream(file, std::ios::binary);
    bool const is_one =
        stream.read(header.data(), header.size()) && std::string(header.data(), 15) == "SQLite format 3";
    return {is_one, is_one && (header[18] == 2 || header[19] == 2)};
}

fs::path wal_of(fs::path const& file) {
    return file.string() + "-wal";
}

struct State {
    std::uintmax_t bytes = 0;
    fs::file_time_type changed = {};
    friend bool operator==(State const&, State const&) = default;
};

State state_of(fs::path const& file) {
    return {fs::file_size(file), fs::last_write_time(file)};
}

// Copies two files; false if either changed meanwhile.
bool copied(fs::path const& file, fs::path const& copy) {
    std::array const before{state_of(file), state_of(wal_of(file))};
    auto const options = fs::copy_options::overwrite_existing;
    fs::copy_file(file, copy, options);
    fs::copy_file(wal_of(file), wal_of(copy), options);
    return before == std::array{state_of(file), state_of(wal_of(file))};
}

// Whether a NAME.gfs beside a GML file, which GDAL leaves there when another program reads it, hides what its elements
// say by attributes: GDAL takes the fields from it and ignores its own option.
bool has_hiding_gfs(fs::path const& file) {
    std::error_code ignored;
    fs::path beside = file;
    bool const is_gml = EQUAL(file.extension().c_str(), ".gml") || EQUAL(file.extension().c_str(), ".xml");
    if (!is_gml || fs::exists(beside.replace_extension(".xsd"), ignored) ||
        !fs::exists(beside.replace_extension(".gfs"), ignored)) {
        return false;
    }
    std::ifstream stream(beside, std::ios::binary);
    return std::find(std::istreambuf_iterator<char>(stream), {}, '@') == std::istreambuf_iterator<char>();
}

// Opens a file so that reading changes neither it nor its folder. SQLite writes to a GeoPackage in write-ahead mode
// even when it is opened for reading: it creates NAME-wal and NAME-shm, and on closing moves the content of NAME-wal
// into the file; it deletes a NAME-wal beside a file in another mode. A GeoPackage without changes in NAME-wal is
// therefore opened as immutable; one with changes is copied, and the copy is removed with this object. Any other file
// is opened directly.
class UnchangedFile {
public:
    // Throws BadInput as refuse_pipe; IoError when a necessary copy fails, or the file is being written meanwhile.
    explicit UnchangedFile(fs::path const& file) : path_(file) {
        for (char const* const beside : {"", "-journal", "-wal"}) { // SQLite opens these on its own
            std::string const path = file.string() + beside;
            refuse_pipe(path, {"io.open_unchanged", path});
        }
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) {
            return;
        }
        if (has_hiding_gfs(file)) {
            copies_ = std::make_unique<TemporaryFolder>("thalweg");
            path_ = copies_->path() / file.filename();
            fs::create_symlink(fs::absolute(file), path_, ignored);
            path_ = ignored ? file : path_;
            return;
        }
        Sqlite const base = sqlite_in(file);
        if (auto const changes = fs::file_size(wal_of(file), ignored); !base.is_one || ignored || changes == 0) {
            immutable_ = base.is_write_ahead;
            return;
        }
        try {
            copies_ = std::make_unique<TemporaryFolder>("thalweg");
            path_ = copies_->path() / file.filename();
            constexpr int attempts = 3;
            for (int i = 0; i < attempts; ++i) {
                if (copied(file, path_)) {
                    return;
                }
            }
        } catch (fs::filesystem_error const& error) {
            throw IoError("io.open_unchanged",
                          fmt::format("{} has changes in {}, and no copy of both can be made: {}", file.string(),
                                      wal_of(file).filename().string(), error.what()));
        }
        throw IoError(
            "io.open_unchanged",
            fmt::format("{} is being written by another program; close it there and try again", file.string()));
    }

    // The path to open.
    std::string path() const { return path_.string(); }
    // GDAL's open options, null-terminated.
    char const* const* options() const {
        static std::array<char const*, 2> constexpr immutable{"IMMUTABLE=YES", nullptr};
        return immutable_ ? immutable.data() : nullptr;
    }

private:
    fs::path path_;
    std::unique_ptr<TemporaryFolder> copies_; // the folder of the copy; null: none
    bool immutable_ = false;
};

constexpr std::array recipe_formats{"GTiff",        "HFA",
                                    "AAIGrid",      "GRASSASCIIGrid",
                                    "GSAG",         "GSBG",
                                    "GS7BG",        "EHdr",
                                    "ENVI",         "SAGA",
                                    "RST",          "SRTMHGT",
                                    "DTED",         "USGSDEM",
                                    "BT",           "Terragen",
                                    "ISG",          "XYZ",
                                    "PNG",          "JPEG",
                                    "BMP",          "JP2OpenJPEG",
                                    "PCRaster",     "NWT_GRD",
                                    "GPKG",         "ESRI Shapefile",
                                    "GeoJSON",      "GeoJSONSeq",
                                    "TopoJSON",     "FlatGeobuf",
                                    "CSV",          "OpenFileGDB",
                                    "MapInfo File", "KML",
                                    "LIBKML",       "GPX",
                                    "OGR_GMT",      "JML",
                                    "DXF"};

// Reads the word of an SQL text at a position, without quotes, and advances the position.
std::string next_word(std::string const& sql, std::size_t& at) {
    at = std::min(sql.find_first_not_of(" \t\r\n", at), sql.size());
    if (at == sql.size()) {
        return "";
    }
    char const first = sql[at];
    char const quote = first == '[' ? ']' : first;
    bool const quoted = first == '"' || first == '`' || first == '[' || first == '\'';
    std::size_t const end = quoted ? std::min(sql.find(quote, at + 1), sql.size() - 1) + 1
                                   : std::min(sql.find_first_of(" \t\r\n(", at + 1), sql.size());
    std::string word = sql.substr(at, end - at);
    at = end;
    return word;
}

// Whether a table of a GeoPackage is virtual, which may read any file: all but the spatial index.
bool is_foreign_table(std::string const& sql) {
    std::size_t at = 0;
    for (char const* const word : {"CREATE", "VIRTUAL", "TABLE"}) {
        if (!EQUAL(next_word(sql, at).c_str(), word)) {
            return true;
        }
    }
    next_word(sql, at); // its name
    return !EQUAL(next_word(sql, at).c_str(), "USING") || !EQUAL(next_word(sql, at).c_str(), "rtree");
}

// GDAL's names of formats that contain all their data, read by drivers that open only the files beside the given one;
// nullptr at the end.
std::vector<char const*> recipe_drivers() {
    std::vector<char const*> drivers(recipe_formats.begin(), recipe_formats.end());
    drivers.push_back(nullptr);
    return drivers;
}

// name: GDAL's name of the file; path: the user's. Throws BadInput when the file is in another format.
void refuse_other_format(std::string const& name, std::string const& path) {
    GDALDriverH const driver = GDALIdentifyDriver(name.c_str(), nullptr);
    std::string const format = driver == nullptr ? "" : GDALGetDriverShortName(driver);
    refuse_if<BadInput>(driver != nullptr && std::ranges::find(recipe_formats, format) == recipe_formats.end(),
                        "io.open_unchanged",
                        "{} is in the format {}, and a recipe names files that hold their data themselves, such as "
                        "GeoPackage, Shapefile, GeoJSON, FlatGeobuf, CSV and GeoTIFF: convert it (ogr2ogr, "
                        "gdal_translate), or name it on the command line",
                        path, format);
}

// Throws BadInput when a GeoPackage contains a virtual table, which may read any file; the spatial index is allowed.
void require_own_tables(GDALDataset& package, std::string const& path) {
    OGRLayer* const tables = package.ExecuteSQL(
        "SELECT name, sql FROM sqlite_master WHERE type = 'table' AND (rootpage IS NULL OR rootpage < 1)", nullptr, "");
    refuse_if<BadInput>(tables == nullptr, "io.open_unchanged", "the tables of {} cannot be listed", path);
    std::string foreign;
    for (auto const& row : *tables) {
        if (is_foreign_table(row->GetFieldAsString(1))) {
            foreign = row->GetFieldAsString(0);
        }
    }
    package.ReleaseResultSet(tables);
    refuse_if<BadInput>(
        !foreign.empty(), "io.open_unchanged",
        "the table {} of {} is virtual: it may read any file; copy the data into a new GeoPackage (ogr2ogr)", foreign,
        path);
}

constexpr std::array<char const*, 2> databases{"PostgreSQL", nullptr};

bool is_postgres(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postg");
}

// Resources that a data set needs as long as it is open, in this order.
struct HeldResources {
    std::unique_ptr<Connection const> connection = {};
    std::unique_ptr<UnchangedFile const> file = {};
    std::unique_ptr<WithNetcdf const> netcdf = {};
    std::unique_ptr<ConfinedFolder const> folder = {};
    std::unique_ptr<ConfinedFolder const> folder_of_copy = {};
};

struct DriverOption {
    char const* driver;
    char const* name;
    char const* value;
};

// Without these GDAL leaves NAME.gfs beside a GML file, and leaves out what its elements say by attributes (references
// by xlink:href, as INSPIRE's directions and nodes), the heights of GPX, and lines of CSV in a column that is not WKT,
// as convert, geopandas and GDAL since 3.10 name it.
constexpr std::array driver_options{
    DriverOption{"GML", "WRITE_GFS", "NO"}, DriverOption{"GML", "GML_ATTRIBUTES_TO_OGR_FIELDS", "YES"},
    DriverOption{"GPX", "ELE_AS_25D", "YES"}, // since GDAL 3.8
    DriverOption{"CSV", "GEOM_POSSIBLE_NAMES", "WKT,_WKT*,geometry,geom,the_geom,wkt_geom,wkb_geometry"},
    DriverOption{"CSV", "KEEP_GEOM_COLUMNS", "NO"}};

// The options that the driver of a file has, and others that are given.
CPLStringList open_options(std::string const& path, unsigned kinds, char const* const* drivers,
                           char const* const* given) {
    CPLStringList options(CSLDuplicate(const_cast<char**>(given)), TRUE);
    GDALDriverH const driver = GDALIdentifyDriverEx(path.c_str(), kinds, drivers, nullptr);
    char const* const known = driver == nullptr ? nullptr : GDALGetMetadataItem(driver, GDAL_DMD_OPENOPTIONLIST, "");
    for (DriverOption const& option : driver_options) {
        if (known != nullptr && EQUAL(GDALGetDriverShortName(driver), option.driver) &&
            std::string_view(known).find(option.name) != std::string_view::npos) {
            options.SetNameValue(option.name, option.value);
        }
    }
    return options;
}

// shown: the name in messages.
Dataset opened(std::string const& path, unsigned kinds, char const* const* drivers,
               std::shared_ptr<HeldResources const> held, std::string const& shown) {
    take_refusal();
    CPLStringList const options = open_options(path, kinds, drivers, held->file ? held->file->options() : nullptr);
    CPLConfigOptionSetter const heights("GPX_ELE_AS_25D", "YES", true); // before GDAL 3.8
    Dataset data(
        GDALDataset::Open(path.c_str(), kinds | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers, options.List()),
        {std::move(held)});
    throw_refusal(take_refusal(), {"io.open_unchanged", shown});
    return data;
}

Dataset open_connection(std::string const& path, unsigned kinds) {
    auto held = std::make_shared<HeldResources>();
    held->connection = std::make_unique<Connection const>();
    std::vector<char const*> const files = recipe_drivers();
    return opened(path, kinds, is_postgres(path) ? databases.data() : files.data(), held, path);
}

Dataset open_recipe_file(std::string const& path, unsigned kinds) {
    require_allowed({path, Access::recipe});
    auto held = std::make_shared<HeldResources>();
    held->file = std::make_unique<UnchangedFile const>(path);
    held->folder = std::make_unique<ConfinedFolder const>(path);
    held->folder_of_copy = std::make_unique<ConfinedFolder const>(held->file->path());
    std::string const name = inside_archive(held->file->path());
    std::vector<char const*> const drivers = recipe_drivers();
    Dataset data = opened(name, kinds, drivers.data(), held, path);
    if (data == nullptr) {
        refuse_other_format(name, path);
    }
    if (data != nullptr && data->GetDriver() != nullptr && EQUAL(data->GetDriver()->GetDescription(), "GPKG")) {
        require_own_tables(*data, path);
    }
    return data;
}

// The file that GDAL reads beside a header of the same stem, such as NAME.sdat beside NAME.sgrd; "": none, or several.
std::string data_beside(fs::path const& header) {
    std::string found;
    std::error_code ignored;
    fs::path const folder = header.has_parent_path() ? header.parent_path() : fs::path(".");
    for (fs::directory_entry const& entry : fs::directory_iterator(folder, ignored)) {
        fs::path const& file = entry.path();
        if (file.stem() == header.stem() && file.filename() != header.filename() && entry.is_regular_file(ignored) &&
            GDALIdentifyDriver(file.c_str(), nullptr) != nullptr) {
            if (!found.empty()) {
                return "";
            }
            found = file.filename().string();
        }
    }
    return found;
}

} // namespace

std::string inside_archive(std::string const& path) {
    std::error_code ignored;
    std::string const ending = fs::path(path).extension().string();
    if ((ending != ".zip" && ending != ".ZIP") || !fs::is_regular_file(path, ignored)) {
        return path;
    }
    std::string inside = "/vsizip/{" + path + "}";
    constexpr int deepest = 4;
    for (int level = 0; level < deepest; ++level) {
        CPLStringList const entries(VSIReadDir(inside.c_str()), TRUE);
        VSIStatBufL status;
        if (entries.size() != 1 || VSIStatL((inside + "/" + entries[0]).c_str(), &status) != 0) {
            break;
        }
        inside += std::string("/") + entries[0];
        if (VSI_ISDIR(status.st_mode) == 0) {
            break;
        }
    }
    return inside;
}

void forget_archive(std::string const& path, Driver const& driver) {
    if (inside_archive(path) != path) {
        driver.take();
    }
}

void CloseDataset::operator()(GDALDataset* dataset) const {
    GDALClose(dataset);
}

Dataset open_unchanged(Source const& source, unsigned kinds) {
    std::string const& path = source.path;
    if (source.access == Access::recipe) {
        return open_recipe_file(path, kinds);
    }
    if (names_connection(path)) {
        return open_connection(path, kinds);
    }
    auto held = std::make_shared<HeldResources>();
    held->file = std::make_unique<UnchangedFile const>(path);
    held->netcdf = std::make_unique<WithNetcdf const>(path);
    std::string const name = inside_archive(held->file->path());
    bool const is_disguised = is_virtual_in_disguise(name, path);
    if (is_disguised) { // who names a picture does not expect to read files elsewhere
        held->folder = std::make_unique<ConfinedFolder const>(path);
        held->folder_of_copy = std::make_unique<ConfinedFolder const>(held->file->path());
    }
    require_honest_sources(name, path, is_disguised);
    if (held->netcdf->is_meant()) {
        static constexpr std::array<char const*, 2> netcdf{"netCDF", nullptr};
        Dataset data = opened(name, kinds, netcdf.data(), held, path);
        if (data != nullptr) {
            return data;
        }
    }
    return opened(name, kinds, nullptr, held, path);
}

bool is_recipe_file(std::string const& path) {
    Driver const driver;
    try {
        bool const opens = open_unchanged({path, Access::recipe}, GDAL_OF_RASTER | GDAL_OF_VECTOR) != nullptr;
        driver.take();
        return opens;
    } catch (BadInput const&) {
        driver.take();
        return false;
    }
}

Dataset open_part(Dataset const& file, std::string const& name) {
    std::array<char const*, 2> const drivers{file->GetDriver()->GetDescription(), nullptr};
    return {GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers.data()),
            file.get_deleter()};
}

std::string file_of_part(std::string const& path) {
    std::size_t const first = path.find(':');
    std::size_t const last = path.rfind(':');
    if (first == std::string::npos || last <= first + 1 || names_connection(path)) {
        return "";
    }
    std::string file = path.substr(first + 1, last - first - 1);
    std::erase(file, '"');
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) ? file : "";
}

void refuse_folder(std::string const& path, About const& about) {
    std::error_code ignored;
    refuse_if<BadInput>(fs::is_directory(path, ignored), about.where,
                        "{} is a folder, and holds nothing that GDAL reads as a whole: name a file in it", about.name);
}

Dataset open_file(Source const& source, unsigned kinds, About const& about) {
    // GDAL takes addresses and connection strings for file names.
    if (std::error_code ignored; !fs::exists(source.path, ignored)) {
        std::string const file = file_of_part(source.path);
        if (file.empty()) {
            throw BadInput(about.where, about.name + " does not exist");
        }
        Dataset part = open_part(open_file({file, source.access}, kinds, about), source.path);
        if (part == nullptr) {
            throw BadInput(about.where, fmt::format("{} cannot be read: {}", about.name, CPLGetLastErrorMsg()));
        }
        return part;
    }
    CPLErrorReset();
    Dataset dataset = open_unchanged(source, kinds);
    if (dataset == nullptr) {
        std::string words = CPLGetLastErrorMsg();
        words = words.empty() ? "its format is not known" : words;
        words.erase(words.find_last_not_of('.') + 1);
        refuse_folder(source.path, about);
        std::string const other = data_beside(source.path);
        throw BadInput(about.where,
                       fmt::format("{} cannot be read: {}{}", about.name, words,
                                   other.empty() ? "" : fmt::format("; its data are in {}: name that file", other)));
    }
    return dataset;
}

MemoryFile::MemoryFile() {
    static std::atomic<int> made{0};
    path_ = fmt::format("/vsimem/thalweg{}/file", ++made);
}

MemoryFile::~MemoryFile() {
    VSIRmdirRecursive(path_.substr(0, path_.rfind('/')).c_str());
}

std::string_view MemoryFile::bytes() const {
    vsi_l_offset size = 0;
    auto const* const data = reinterpret_cast<char const*>(VSIGetMemFileBuffer(path_.c_str(), &size, FALSE));
    return data == nullptr ? std::string_view() : std::string_view(data, size);
}

} // namespace thalweg::io
