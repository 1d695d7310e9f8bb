// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace thalweg::io {

/// Appends a number to a file's bytes, lowest byte first on every machine. Private to this module.
template <class T> void put_number(std::string& bytes, T value) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) {
        std::reverse(raw.begin(), raw.end());
    }
    bytes.append(raw.data(), raw.size());
}

/// Appends a field of so many bytes, filled with zeros.
inline void put_field(std::string& bytes, std::string_view words, std::size_t size) {
    bytes.append(words.substr(0, size));
    bytes.append(size - std::min(size, words.size()), '\0');
}

} // namespace thalweg::io
