// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

/// Writer of LAS files, from the specification (ASPRS, LAS 1.4-R15): any version and point format.
namespace las_files {

template <class T> void append(std::string& bytes, T value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
}

/// Overwrites a number of a file.
template <class T> std::string with(std::string bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof(T));
    return bytes;
}

struct Point {
    thalweg::Vec3 at = {};
    int kind = 2;
    bool is_withheld = false;
};

/// A variable-length record.
struct Record {
    int id;
    std::string data;
    std::string user = "LASF_Projection";
};

struct File {
    std::vector<Point> points = {};
    int minor = 2;
    int format = 0;
    double scale = 0.01;
    thalweg::Vec3 offset = {};
    std::vector<Record> records = {};
    std::vector<Record> long_records = {}; ///< behind the points, from version 1.4 on
    int extra_bytes = 0;                   ///< of each point
    bool is_wkt = false;
};

/// A directory of GeoTIFF keys with values of 16 bits.
inline Record keys(std::initializer_list<std::array<int, 2>> const& values) {
    std::string data;
    for (int const number : {1, 1, 0, static_cast<int>(values.size())}) {
        append(data, static_cast<std::uint16_t>(number));
    }
    for (auto const& [key, value] : values) {
        for (int const number : {key, 0, 1, value}) {
            append(data, static_cast<std::uint16_t>(number));
        }
    }
    return {34735, data};
}

inline std::string padded(std::string text, std::size_t size) {
    text.resize(size, '\0');
    return text;
}

inline std::string bytes_of_record(Record const& record, bool is_long) {
    std::string bytes(2, '\0');
    bytes += padded(record.user, 16);
    append(bytes, static_cast<std::uint16_t>(record.id));
    if (is_long) {
        append(bytes, static_cast<std::uint64_t>(record.data.size()));
    } else {
        append(bytes, static_cast<std::uint16_t>(record.data.size()));
    }
    return bytes + padded("a record", 32) + record.data;
}

inline std::string bytes_of_point(Point const& p, File const& file) {
    constexpr std::array<std::size_t, 11> lengths{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    std::string bytes;
    for (auto const& [v, origin] :
         {std::array{p.at.x, file.offset.x}, std::array{p.at.y, file.offset.y}, std::array{p.at.z, file.offset.z}}) {
        append(bytes, static_cast<std::int32_t>(std::lround((v - origin) / file.scale)));
    }
    append(bytes, std::uint16_t{777}); // intensity
    if (file.format < 6) {
        append(bytes, std::uint8_t{0x09});
        append(bytes, static_cast<std::uint8_t>(p.kind | (p.is_withheld ? 0x80 : 0)));
    } else {
        append(bytes, std::uint8_t{0x11});
        append(bytes, static_cast<std::uint8_t>(p.is_withheld ? 0x04 : 0));
        append(bytes, static_cast<std::uint8_t>(p.kind));
    }
    return padded(bytes, lengths[static_cast<std::size_t>(file.format)] + static_cast<std::size_t>(file.extra_bytes));
}

inline std::string bytes_of(File const& file) {
    std::size_t const header_size = file.minor == 4 ? 375 : file.minor == 3 ? 235 : 227;
    std::string records;
    for (Record const& record : file.records) {
        records += bytes_of_record(record, false);
    }
    std::string points;
    for (Point const& p : file.points) {
        points += bytes_of_point(p, file);
    }
    std::string bytes = "LASF";
    append(bytes, std::uint16_t{0});
    append(bytes, static_cast<std::uint16_t>(file.is_wkt ? 0x10 : 0));
    bytes += std::string(16, '\0') + '\1' + static_cast<char>(file.minor) + padded("system", 32) + padded("test", 32);
    append(bytes, std::uint16_t{1});
    append(bytes, std::uint16_t{2020});
    append(bytes, static_cast<std::uint16_t>(header_size));
    append(bytes, static_cast<std::uint32_t>(header_size + records.size()));
    append(bytes, static_cast<std::uint32_t>(file.records.size()));
    bytes += static_cast<char>(file.format);
    append(bytes, static_cast<std::uint16_t>(bytes_of_point({}, file).size()));
    append(bytes, static_cast<std::uint32_t>(file.format < 6 ? file.points.size() : 0)); // the old count
    bytes = padded(bytes, 131);
    for (double const number : {file.scale, file.scale, file.scale, file.offset.x, file.offset.y, file.offset.z}) {
        append(bytes, number);
    }
    bytes = padded(bytes, file.minor == 4 ? 235 : header_size);
    if (file.minor == 4) {
        append(bytes, static_cast<std::uint64_t>(header_size + records.size() + points.size()));
        append(bytes, static_cast<std::uint32_t>(file.long_records.size()));
        append(bytes, static_cast<std::uint64_t>(file.points.size()));
        bytes = padded(bytes, header_size);
    }
    bytes += records + points;
    for (Record const& record : file.long_records) {
        bytes += bytes_of_record(record, true);
    }
    return bytes;
}

} // namespace las_files
