// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/packed.hpp>

#include <algorithm>
#include <limits>
#include <memory>

#include <cpl_conv.h>
#include <cpl_string.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {

namespace {

constexpr int level = 6;
constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t piece = 3 << 20; // a multiple of three: base64 pads only at its end

struct VsiFree {
    void operator()(void* memory) const { VSIFree(memory); }
};

} // namespace

std::string base64(std::span<std::uint8_t const> bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
        std::unique_ptr<char, VsiFree> const part(
            CPLBase64Encode(static_cast<int>(std::min(piece, bytes.size() - at)), bytes.data() + at));
        refuse_if<IoError>(part == nullptr, "io.base64", "out of memory");
        text += part.get();
    }
    return text;
}

std::string packed(std::span<std::uint8_t const> bytes) {
    refuse_if<BadInput>(bytes.size() > most, "io.packed", "{} bytes are more than the {} that can be packed at once",
                        bytes.size(), most);
    Driver const driver;
    std::uint8_t const none = 0;
    std::size_t size = 0;
    std::unique_ptr<void, VsiFree> const stream(
        CPLZLibDeflate(bytes.empty() ? &none : bytes.data(), bytes.size(), level, nullptr, 0, &size));
    if (stream == nullptr) {
        driver.check("io.packed");
        throw IoError("io.packed", "io.packed failed");
    }
    return base64({static_cast<std::uint8_t const*>(stream.get()), size});
}

} // namespace thalweg::io
