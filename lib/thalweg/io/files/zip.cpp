// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/files/zip.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

#include <boost/crc.hpp>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg::io {

namespace {

// Appends an unsigned number, the lowest byte first.
template <class Number> void append(std::string& out, Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
        out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU);
    }
}

// What the header before a file and the one in the directory share: how it is packed, its date, checksum, sizes, the
// length of its name and that of no further fields.
std::string common_fields(std::string const& name, std::string_view bytes) {
    constexpr std::uint16_t version = 10; // 1.0: stored files
    constexpr std::uint16_t first_day = 1U << 5 | 1U;
    boost::crc_32_type checksum;
    checksum.process_bytes(bytes.data(), bytes.size());
    std::string fields;
    append(fields, version);
    append(fields, std::uint16_t{0}); // flags
    append(fields, std::uint16_t{0}); // stored
    append(fields, std::uint16_t{0}); // midnight
    append(fields, first_day);
    append(fields, static_cast<std::uint32_t>(checksum.checksum()));
    append(fields, static_cast<std::uint32_t>(bytes.size()));
    append(fields, static_cast<std::uint32_t>(bytes.size()));
    append(fields, static_cast<std::uint16_t>(name.size()));
    append(fields, std::uint16_t{0});
    return fields;
}

} // namespace

std::string zip_archive(std::string const& name, std::string_view bytes) {
    constexpr std::size_t headers = 200; // more than all but names and bytes take
    refuse_if<BadParameter>(name.empty() || name.size() > std::numeric_limits<std::uint16_t>::max() ||
                                bytes.size() >= std::numeric_limits<std::uint32_t>::max() - 2 * name.size() - headers,
                            "io.zip_archive", "{} of {} bytes does not fit into a ZIP archive", name, bytes.size());
    std::string const fields = common_fields(name, bytes);
    std::string archive = "PK\x03\x04" + fields + name;
    archive += bytes;
    std::size_t const directory = archive.size();
    archive += "PK\x01\x02";
    append(archive, std::uint16_t{3U << 8 | 10U}); // made on Unix, whose modes follow
    archive += fields;
    append(archive, std::uint16_t{0});               // length of the comment
    append(archive, std::uint16_t{0});               // number of the disk
    append(archive, std::uint16_t{0});               // internal attributes
    append(archive, std::uint32_t{0100644U << 16U}); // a plain file, rw-r--r--
    append(archive, std::uint32_t{0});               // where the file begins
    archive += name;
    auto const directory_size = static_cast<std::uint32_t>(archive.size() - directory);
    archive += "PK\x05\x06";
    append(archive, std::uint16_t{0}); // number of this disk, and of that with the directory
    append(archive, std::uint16_t{0});
    append(archive, std::uint16_t{1}); // entries on this disk, and in all
    append(archive, std::uint16_t{1});
    append(archive, directory_size);
    append(archive, static_cast<std::uint32_t>(directory));
    append(archive, std::uint16_t{0}); // length of the comment
    return archive;
}

} // namespace thalweg::io
