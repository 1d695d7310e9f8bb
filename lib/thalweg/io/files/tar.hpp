// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg::io {

/// \internal
/// Formats a file as an entry of a tar archive: a header and the bytes, in blocks of 512 bytes, with mode 644, owner 0
/// and time 0. An archive is any number of entries and tar_end().
/// \param name [1, 100] bytes, with / between folders
/// \param bytes of the file, less than 8 GiB
/// \return the entry
/// \throws BadParameter for a name or a size that a header does not hold
///
/// Source: IEEE Std 1003.1 (POSIX), pax, ustar interchange format.
std::string tar_entry(std::string const& name, std::string_view bytes);

/// \internal
/// \return the end of an archive: two empty blocks
std::string tar_end();

/// Where a file lies in an archive.
struct TarEntry {
    std::string name;
    std::int64_t begin = 0; ///< [bytes] of its header
    std::int64_t end = 0;   ///< [bytes] after its last block
};

/// Lists the entries of an archive of tar_entry() and tar_end().
/// \param path of the archive
/// \return in their order
/// \throws BadInput naming the archive when it is cut off or not such an archive
/// \throws IoError when it cannot be read
std::vector<TarEntry> tar_entries(std::string const& path);

} // namespace thalweg::io
