// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace thalweg::io {

/// Formats a ZIP archive of one file, stored without compression and dated 1980-01-01: the same bytes for the same
/// file, whatever the clock, the zone and the versions of other libraries.
/// \param name [1, 65535] ASCII, with / between folders
/// \param bytes of the file, less than 4 GiB
/// \return the archive
/// \throws BadParameter for a name or a size that its headers do not hold
///
/// Source: PKWARE, .ZIP File Format Specification, version 6.3.10.
std::string zip_archive(std::string const& name, std::string_view bytes);

} // namespace thalweg::io
