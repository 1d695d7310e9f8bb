// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <cpl_conv.h>
#include <gtest/gtest.h>

/// The bytes of base64 (RFC 4648), read letter by letter; complains of anything else.
inline std::vector<std::uint8_t> from_base64(std::string_view text) {
    std::string_view const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    EXPECT_EQ(text.size() % 4, 0U);
    std::uint32_t bits = 0;
    int held = 0;
    std::size_t const padding = text.find('=');
    EXPECT_TRUE(padding == std::string_view::npos || padding + 2 >= text.size());
    for (char const c : text.substr(0, padding)) {
        std::size_t const value = letters.find(c);
        EXPECT_NE(value, std::string_view::npos) << "character " << static_cast<int>(c);
        bits = (bits << 6U) | static_cast<std::uint32_t>(value);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(static_cast<std::uint8_t>((bits >> held) & 0xFFU));
        }
    }
    return bytes;
}

/// The bytes in base64 of a zlib stream.
inline std::vector<std::uint8_t> unpacked(std::string_view text) {
    std::vector<std::uint8_t> const stream = from_base64(text);
    std::size_t size = 0;
    void* const inflated = CPLZLibInflate(stream.data(), stream.size(), nullptr, 0, &size);
    EXPECT_NE(inflated, nullptr);
    auto const* const first = static_cast<std::uint8_t const*>(inflated);
    std::vector<std::uint8_t> bytes(first, first + size);
    VSIFree(inflated);
    return bytes;
}
