// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/tar.hpp>

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::io {

namespace {

constexpr std::size_t block = 512;

} // namespace

std::string tar_entry(std::string const& name, std::string_view bytes) {
    constexpr std::size_t longest_name = 100;
    constexpr std::uint64_t size_limit = std::uint64_t{1} << 33; // 11 octal digits
    refuse_if<BadParameter>(name.empty() || name.size() > longest_name || bytes.size() >= size_limit,
                            "io.tar_entry: {} of {} bytes does not fit into a tar header", name, bytes.size());
    constexpr std::size_t checksum_at = 148;
    std::string header(block, '\0');
    auto const put = [&](std::size_t at, std::string_view text) { header.replace(at, text.size(), text); };
    put(0, name);
    put(100, "0000644");
    put(108, "0000000"); // owner
    put(116, "0000000"); // group
    put(124, fmt::format("{:011o}", bytes.size()));
    put(136, "00000000000"); // time
    put(checksum_at, "        ");
    put(156, "0"); // a plain file
    put(257, std::string_view("ustar\00000", 8));
    unsigned sum = 0;
    for (char const c : header) {
        sum += static_cast<unsigned char>(c);
    }
    put(checksum_at, fmt::format("{:06o}", sum));
    put(checksum_at + 6, std::string_view("\0 ", 2));
    std::string entry = header;
    entry += bytes;
    entry.resize((entry.size() + block - 1) / block * block, '\0');
    return entry;
}

std::string tar_end() {
    std::string zeros(2 * block, '\0');
    return zeros;
}

} // namespace thalweg::io
