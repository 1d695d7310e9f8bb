// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace thalweg::io {

/// Bytes as base64 of a zlib stream, to stand in a text.
/// \param bytes the number of bytes
/// \return letters, digits, + and /, filled up with =, without line breaks; inflated again they are the same bytes.
/// Which bytes a stream has depends on the zlib or libdeflate that GDAL was built with.
/// \throws BadInput beyond 2^31 - 1 bytes, which older GDALs cannot deflate
/// \throws IoError when GDAL fails
///
/// Source: RFC 1950 (zlib), RFC 4648 (base64).
std::string packed(std::span<std::uint8_t const> bytes);

} // namespace thalweg::io
