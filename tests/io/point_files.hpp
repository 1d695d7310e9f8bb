// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

/// Readers of point files, written from the standards.
namespace point_files {

/// A number of a little-endian file.
template <class T> T number_at(std::string const& bytes, std::size_t at) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// A LAS 1.2 file of point format 0 (ASPRS): its header's figures checked against its points.
struct Las {
    std::vector<thalweg::Vec3> points;
    std::vector<int> classes;
    std::array<double, 3> scale{};
    int epsg = 0;
};

inline Las read_las(std::string const& bytes) {
    Las las;
    EXPECT_EQ(bytes.substr(0, 4), "LASF");
    EXPECT_EQ(bytes[24], 1);
    EXPECT_EQ(bytes[25], 2);
    EXPECT_EQ(number_at<std::uint16_t>(bytes, 94), 227);
    auto const begin = number_at<std::uint32_t>(bytes, 96);
    auto const records = number_at<std::uint32_t>(bytes, 100);
    EXPECT_EQ(bytes[104], 0);
    EXPECT_EQ(number_at<std::uint16_t>(bytes, 105), 20);
    auto const count = number_at<std::uint32_t>(bytes, 107);
    EXPECT_EQ(number_at<std::uint32_t>(bytes, 111), count);
    EXPECT_EQ(bytes.size(), begin + std::size_t{20} * count);
    EXPECT_LE(records, 1U);
    if (records == 1) {
        EXPECT_EQ(bytes.substr(227 + 2, 15), "LASF_Projection");
        EXPECT_EQ(number_at<std::uint16_t>(bytes, 227 + 18), 34735);
        EXPECT_EQ(begin, 227U + 54U + number_at<std::uint16_t>(bytes, 227 + 20));
        EXPECT_EQ(number_at<std::uint16_t>(bytes, 227 + 54 + 16), 3072);
        las.epsg = number_at<std::uint16_t>(bytes, 227 + 54 + 22);
    } else {
        EXPECT_EQ(begin, 227U);
    }
    std::array<double, 3> low{};
    std::array<double, 3> high{};
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t const at = begin + 20 * i;
        std::array<double, 3> v{};
        for (std::size_t k = 0; k < 3; ++k) {
            las.scale[k] = number_at<double>(bytes, 131 + 8 * k);
            auto const offset = number_at<double>(bytes, 155 + 8 * k);
            v[k] = static_cast<double>(number_at<std::int32_t>(bytes, at + 4 * k)) * las.scale[k] + offset;
            low[k] = i == 0 || v[k] < low[k] ? v[k] : low[k];
            high[k] = i == 0 || v[k] > high[k] ? v[k] : high[k];
        }
        las.points.push_back({v[0], v[1], v[2]});
        EXPECT_EQ(bytes[at + 14], 9); // return 1 of 1
        las.classes.push_back(bytes[at + 15]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(number_at<double>(bytes, 179 + 16 * k), high[k]);
        EXPECT_EQ(number_at<double>(bytes, 187 + 16 * k), low[k]);
    }
    return las;
}

/// A binary PLY file of vertices, and triangles where it has an element for them (Turk 1994).
inline thalweg::Tin read_ply(std::string const& bytes) {
    std::istringstream in(bytes);
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "ply");
    std::getline(in, line);
    EXPECT_EQ(line, "format binary_little_endian 1.0");
    thalweg::Tin tin;
    bool has_faces = false;
    std::string properties;
    while (std::getline(in, line) && line != "end_header") {
        if (line.starts_with("element vertex ")) {
            tin.vertices.resize(std::stoul(line.substr(15)));
        } else if (line.starts_with("element face ")) {
            tin.triangles.resize(std::stoul(line.substr(13)));
            has_faces = true;
        } else if (!line.starts_with("comment ")) {
            properties += line + ";";
        }
    }
    EXPECT_EQ(properties, std::string("property double x;property double y;property double z;") +
                              (has_faces ? "property list uchar int vertex_indices;" : ""));
    auto at = static_cast<std::size_t>(in.tellg());
    for (thalweg::Vec3& v : tin.vertices) {
        v = {number_at<double>(bytes, at), number_at<double>(bytes, at + 8), number_at<double>(bytes, at + 16)};
        at += 24;
    }
    for (auto& t : tin.triangles) {
        EXPECT_EQ(bytes[at], 3);
        t = {number_at<std::uint32_t>(bytes, at + 1), number_at<std::uint32_t>(bytes, at + 5),
             number_at<std::uint32_t>(bytes, at + 9)};
        at += 13;
    }
    EXPECT_EQ(at, bytes.size());
    return tin;
}

/// The points of a text with x y z of one a line.
inline std::vector<thalweg::Vec3> read_xyz(std::string const& text) {
    std::istringstream in(text);
    std::vector<thalweg::Vec3> points;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        thalweg::Vec3 p;
        std::string rest;
        EXPECT_TRUE(words >> p.x >> p.y >> p.z) << line;
        EXPECT_FALSE(words >> rest) << line;
        points.push_back(p);
    }
    return points;
}

} // namespace point_files
