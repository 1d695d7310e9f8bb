// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <complex>
#include <cstdint>
#include <type_traits>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>

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
    void add(std::uint32_t n) { add(static_cast<std::uint64_t>(n)); }
    void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
    void add(float x) { add(static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(x))); }
    void add(thalweg::Vec2 p) { put(p.x, p.y); }
    void add(thalweg::Vec3 p) { put(p.x, p.y, p.z); }
    void add(thalweg::Cell c) { put(c.col, c.row); }
    void add(std::complex<double> z) { put(z.real(), z.imag()); }
    template <class T>
        requires std::is_enum_v<T>
    void add(T value) {
        add(static_cast<int>(value));
    }
    /// One value after another.
    template <class... T> Fnv& put(T const&... values) {
        (add(values), ...);
        return *this;
    }
    /// The values of a range without their number.
    template <class T> Fnv& each(T const& values) {
        for (auto const& value : values) {
            add(value);
        }
        return *this;
    }
    template <class T> void add_all(T const& values) {
        add(static_cast<std::uint64_t>(values.size()));
        each(values);
    }
    std::uint64_t hash() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325;
};
