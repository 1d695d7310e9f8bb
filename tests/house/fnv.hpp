// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

/// A hash of values bit for bit: FNV-1a, 64 bits, lowest byte first.
class Fnv {
public:
    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) {
            hash_ = (hash_ ^ ((word >> (8 * byte)) & 0xff)) * 0x100000001b3;
        }
    }
    void add(std::int64_t n) { add(static_cast<std::uint64_t>(n)); }
    void add(int n) { add(static_cast<std::int64_t>(n)); }
    void add(std::uint8_t n) { add(static_cast<std::uint64_t>(n)); }
    void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
    void add(float x) { add(static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(x))); }
    template <class T> void add_all(T const& values) {
        add(static_cast<std::uint64_t>(values.size()));
        for (auto const& value : values) {
            add(value);
        }
    }
    std::uint64_t hash() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};
