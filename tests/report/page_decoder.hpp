// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/vec.hpp>

/// Reads what the report page reads, value by value as web/README.md puts it, and shares no code with what writes it.
namespace page_decoder {

/// Heights [m], NaN for none.
inline std::vector<double> heights(std::vector<std::uint8_t> const& bytes, std::int64_t width, std::int64_t height,
                                   double min, double max) {
    std::int64_t const count = width * height;
    EXPECT_EQ(static_cast<std::int64_t>(bytes.size()), height + 2 * count);
    std::vector<std::int64_t> q(static_cast<std::size_t>(count));
    auto const at = [&](std::int64_t col, std::int64_t row) {
        return col < 0 || row < 0 ? std::int64_t{0} : q[static_cast<std::size_t>(row * width + col)];
    };
    std::vector<double> z;
    for (std::int64_t row = 0; row < height; ++row) {
        int const predictor = bytes[static_cast<std::size_t>(row)];
        EXPECT_LE(predictor, 3);
        for (std::int64_t col = 0; col < width; ++col) {
            std::int64_t const i = row * width + col;
            std::int64_t const coded = bytes[static_cast<std::size_t>(height + i)] +
                                       256 * std::int64_t{bytes[static_cast<std::size_t>(height + count + i)]};
            std::int64_t const residual = coded % 2 == 0 ? coded / 2 : -(coded + 1) / 2;
            std::int64_t const a = at(col - 1, row);
            std::int64_t const b = at(col, row - 1);
            std::int64_t const c = at(col - 1, row - 1);
            std::int64_t const prediction = predictor == 0   ? b
                                            : predictor == 1 ? a
                                            : predictor == 2 ? a + b - c
                                                             : (a + b) / 2;
            std::int64_t const value = ((prediction + residual) % 65536 + 65536) % 65536;
            q[static_cast<std::size_t>(i)] = value;
            z.push_back(value == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : min + static_cast<double>(value - 1) / 65534.0 * (max - min));
        }
    }
    return z;
}

/// D8 directions, 1 to 8 clockwise from the east, 0: none; and lakes. z as heights() gives them.
struct Water {
    std::vector<int> direction;
    std::vector<bool> lake;
};

inline Water water(std::vector<std::uint8_t> const& bytes, std::vector<double> const& z, std::int64_t width, double min,
                   double max) {
    EXPECT_EQ(bytes.size(), z.size());
    std::vector<std::int64_t> q;
    for (double const height : z) {
        q.push_back(std::isnan(height) ? 0 : 1 + std::llround((height - min) / (max - min) * 65534.0));
    }
    auto const height = static_cast<std::int64_t>(q.size()) / width;
    std::vector<std::pair<int, int>> const around{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    Water found;
    for (std::int64_t i = 0; i < width * height; ++i) {
        int steepest = 0;
        double most = 0.0;
        for (int way = 1; auto const& [dx, dy] : around) {
            std::int64_t const col = i % width + dx;
            std::int64_t const row = i / width + dy;
            if (col >= 0 && row >= 0 && col < width && row < height) {
                std::int64_t const there = q[row * width + col];
                double const drop = there > 0 && there < q[i] ? static_cast<double>(q[i] - there) : 0.0;
                if (double const square = drop * drop / (dx * dx + dy * dy); square > most) {
                    most = square;
                    steepest = way;
                }
            }
            ++way;
        }
        found.direction.push_back((steepest + bytes[i] % 16) % 9);
        found.lake.push_back(bytes[i] >= 16);
    }
    return found;
}

/// Vertices by line, in whole steps.
inline std::vector<std::vector<thalweg::Vec2>> lines(std::vector<std::uint8_t> const& bytes,
                                                     std::vector<std::int64_t> const& vertices) {
    std::size_t at = 0;
    auto const number = [&] {
        std::uint64_t value = 0;
        std::uint64_t place = 1;
        for (bool more = true; more; place *= 128) {
            EXPECT_LT(at, bytes.size());
            more = bytes[at] >= 128;
            value += (bytes[at++] % 128) * place;
        }
        auto const half = static_cast<double>(value / 2);
        return value % 2 == 0 ? half : -half - 1.0;
    };
    std::vector<std::vector<thalweg::Vec2>> out;
    thalweg::Vec2 here;
    for (std::int64_t const n : vertices) {
        out.emplace_back();
        for (std::int64_t i = 0; i < n; ++i) {
            here.x += number();
            here.y += number();
            out.back().push_back(here);
        }
    }
    EXPECT_EQ(at, bytes.size()) << "bytes are left over";
    return out;
}

/// What stands in a page in the place of a marker of web/dist/report.html, "@@DATA@@".
inline std::string part(std::string_view page, std::string const& marker) {
    std::ifstream file(THALWEG_SOURCE_DIR "/web/dist/report.html", std::ios::binary);
    std::string const bare{std::istreambuf_iterator<char>(file), {}};
    std::size_t in_bare = 0;
    std::size_t in_page = 0;
    while (true) {
        std::size_t const at = bare.find("@@", in_bare);
        if (at == std::string::npos) {
            ADD_FAILURE() << "no " << marker;
            return "";
        }
        std::size_t const end = bare.find("@@", at + 2) + 2;
        std::string const name = bare.substr(at, end - at);
        if (name != "@@TITLE@@" && name != "@@DATA@@" && name != "@@HEIGHTS@@" && name != "@@LINES@@" &&
            name != "@@WATER@@" && name != "@@STUDIO@@") {
            in_page += at + 2 - in_bare;
            in_bare = at + 2;
            continue;
        }
        in_page += at - in_bare;
        // What follows a marker in the page as built cannot stand in what replaces it: it begins with a tag.
        std::size_t const after = page.find(bare.substr(end, 8), in_page);
        EXPECT_NE(after, std::string_view::npos);
        if (name == marker) {
            return std::string(page.substr(in_page, after - in_page));
        }
        in_bare = end;
        in_page = after;
    }
}

} // namespace page_decoder
