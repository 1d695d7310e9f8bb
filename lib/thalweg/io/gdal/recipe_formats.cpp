// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/recipe_formats.hpp>

#include <algorithm>
#include <array>
#include <string_view>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::io {

namespace {

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

// The word of an SQL text that begins at a place, and the place behind it; quotes taken off.
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

// Whether a table of a GeoPackage is made by a program, which may read any file: all but the index of shapes.
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

} // namespace

std::vector<char const*> recipe_drivers() {
    std::vector<char const*> drivers(recipe_formats.begin(), recipe_formats.end());
    drivers.push_back(nullptr);
    return drivers;
}

void refuse_other_format(std::string const& name, std::string const& path) {
    GDALDriverH const driver = GDALIdentifyDriver(name.c_str(), nullptr);
    std::string const format = driver == nullptr ? "" : GDALGetDriverShortName(driver);
    if (driver != nullptr && std::ranges::find(recipe_formats, format) == recipe_formats.end()) {
        throw BadInput(
            fmt::format("io.recipe_formats: {} is in the format {}, and a recipe names files that hold their "
                        "data themselves, such as GeoPackage, Shapefile, GeoJSON, FlatGeobuf, CSV and "
                        "GeoTIFF: convert it (ogr2ogr, gdal_translate), or name it on the command line",
                        path, format));
    }
}

void require_own_tables(GDALDataset& package, std::string const& path) {
    OGRLayer* const tables = package.ExecuteSQL(
        "SELECT name, sql FROM sqlite_master WHERE type = 'table' AND (rootpage IS NULL OR rootpage < 1)", nullptr, "");
    if (tables == nullptr) {
        throw BadInput("io.recipe_formats: the tables of " + path + " cannot be listed");
    }
    std::string foreign;
    for (auto const& row : *tables) {
        if (is_foreign_table(row->GetFieldAsString(1))) {
            foreign = row->GetFieldAsString(0);
        }
    }
    package.ReleaseResultSet(tables);
    if (!foreign.empty()) {
        throw BadInput(fmt::format("io.recipe_formats: the table {} of {} is virtual: it may read any file; copy the "
                                   "data into a new GeoPackage (ogr2ogr)",
                                   foreign, path));
    }
}

} // namespace thalweg::io
