// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/tar.hpp>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::io {

namespace {

constexpr std::size_t block = 512;

} // namespace

std::string tar_entry(std::string const& name, std::string_view bytes) {
    constexpr std::size_t longest_name = 100;
    constexpr std::uint64_t size_limit = std::uint64_t{1} << 33; // 11 octal digits
    refuse_if<BadParameter>(name.empty() || name.size() > longest_name || bytes.size() >= size_limit, "io.tar_entry",
                            "{} of {} bytes does not fit into a tar header", name, bytes.size());
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

std::vector<TarEntry> tar_entries(std::string const& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    refuse_if<IoError>(!file, "io.tar_entries", "{} cannot be opened", path);
    auto const size = static_cast<std::int64_t>(file.tellg());
    constexpr auto step = static_cast<std::int64_t>(block);
    std::vector<TarEntry> entries;
    std::int64_t at = 0;
    for (std::string header(block, '\0'); at + step <= size;) {
        file.seekg(at);
        refuse_if<IoError>(!file.read(header.data(), step), "io.tar_entries", "{} cannot be read", path);
        if (header.find_first_not_of('\0') == std::string::npos) {
            return entries;
        }
        std::int64_t bytes = 0;
        char const* const digits = header.data() + 124;
        auto const [stop, fault] = std::from_chars(digits, digits + 11, bytes, 8);
        std::int64_t const end = at + step + (bytes + step - 1) / step * step;
        refuse_if<BadInput>(header.compare(257, 5, "ustar") != 0 || fault != std::errc() || stop != digits + 11 ||
                                end > size,
                            "io.tar_entries", "{} is cut off or damaged at byte {}", path, at);
        entries.push_back({header.c_str(), at, end});
        at = end;
    }
    throw BadInput("io.tar_entries", fmt::format("{} is cut off at byte {}", path, at));
}

} // namespace thalweg::io
