// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>

/// What the tests of several modules need.
namespace test {

using namespace thalweg;

/// Whether a text has all of these words in it; a check that fails shows the text and the words it lacks.
inline testing::AssertionResult has(std::string_view text, std::convertible_to<std::string_view> auto const&... words) {
    for (std::string_view const one : {std::string_view(words)...}) {
        if (text.find(one) == std::string_view::npos) {
            return testing::AssertionFailure() << "'" << text << "' lacks '" << one << "'";
        }
    }
    return testing::AssertionSuccess() << "'" << text << "'";
}

/// What an act that fails with Failure says; nothing where it does not fail.
template <class Failure = Error> std::string message_of(auto&& act) {
    try {
        act();
    } catch (Failure const& error) {
        return error.what();
    }
    return "";
}

/// The same with the function that threw in front: "module.function: what is wrong".
template <class Failure = Error> std::string full_message_of(auto&& act) {
    try {
        act();
    } catch (Failure const& error) {
        return std::string(error.where()) + ": " + error.what();
    }
    return "";
}

/// Class, place and message of the error that an act throws: "BadInput io.read_dem: ..."; "" where it throws none.
inline std::string error_of(auto&& act) {
    auto const words = [](char const* kind, Error const& error) {
        return std::string(kind) + " " + error.where() + ": " + error.what();
    };
    try {
        act();
    } catch (BadParameter const& error) {
        return words("BadParameter", error);
    } catch (BadInput const& error) {
        return words("BadInput", error);
    } catch (IoError const& error) {
        return words("IoError", error);
    } catch (Cancelled const& error) {
        return words("Cancelled", error);
    } catch (Error const& error) {
        return words("Error", error);
    }
    return "";
}

/// Whether an act fails with Failure, thrown by this function ("module.function"), with these words.
template <class Failure = BadInput>
testing::AssertionResult refused(std::string_view where, auto&& act, std::string_view words = "") {
    try {
        act();
    } catch (Failure const& error) {
        if (error.where() != where) {
            return testing::AssertionFailure() << error.where() << " refuses it, not " << where << ": " << error.what();
        }
        return has(error.what(), words);
    }
    return testing::AssertionFailure() << where << " accepts it";
}

/// The bytes of a file; none where it cannot be read.
inline std::string bytes_of(std::filesystem::path const& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Makes a file that holds the text.
inline void write(std::filesystem::path const& path, std::string_view text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// A run on so many threads.
inline Run on_threads(int threads) {
    Run run;
    run.threads = threads;
    return run;
}

/// A run that is asked to stop before it begins.
inline Run stopped_run() {
    std::stop_source source;
    source.request_stop();
    Run run;
    run.stop = source.get_token();
    run.progress = [](double, char const*, void*) { return 0; };
    return run;
}

/// How many findings are of a kind.
inline std::int64_t count(std::vector<Finding> const& findings, std::string_view kind) {
    return std::ranges::count(findings, kind, &Finding::kind);
}

/// A file of features in GeoJSON, in EPSG:32631.
inline std::string geojson(std::string const& features) {
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32631"}},)"
           R"("features":[)" +
           features + "]}";
}

/// A feature in GeoJSON, with its coordinates and properties as they stand in the file.
inline std::string feature(std::string const& type, std::string const& coordinates,
                           std::string const& properties = "") {
    return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":")" + type +
           R"(","coordinates":)" + coordinates + "}}";
}
inline std::string line(std::string const& vertices, std::string const& properties = "") {
    return feature("LineString", "[" + vertices + "]", properties);
}
inline std::string polygon(std::string const& ring, std::string const& properties = "") {
    return feature("Polygon", "[[" + ring + "]]", properties);
}

/// A grid with its south-west corner at (0, 0).
inline Grid frame(std::int64_t width, std::int64_t height, double cell_m = 1.0) {
    return {width, height, cell_m, 0.0, static_cast<double>(height) * cell_m, ""};
}

/// A grid with its north-west corner at (0, 0).
inline Grid frame_below(std::int64_t width, std::int64_t height, double cell_m = 1.0) {
    return {width, height, cell_m, 0.0, 0.0, ""};
}

/// A raster whose cells have the values z(cell).
template <class T = float> Raster<T> raster_of(Grid const& grid, auto&& z) {
    Raster<T> raster(grid);
    for (std::int64_t i = 0; i < raster.cells(); ++i) {
        raster[i] = static_cast<T>(z(grid.at(i)));
    }
    return raster;
}

/// Whether two numbers agree bit by bit.
template <std::floating_point T> bool same_bits(T a, T b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Whether two rasters have one grid, and values that agree bit by bit.
template <class T> bool same_bits(Raster<T> const& a, Raster<T> const& b) {
    return a.grid() == b.grid() && std::memcmp(a.values().data(), b.values().data(), a.values().size_bytes()) == 0;
}

} // namespace test
