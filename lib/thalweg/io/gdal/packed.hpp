// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace thalweg::io {

/// \internal
/// Encodes bytes for embedding in text.
/// \param bytes any
/// \return letters, digits, + and /, padded with =, without line breaks
/// \throws IoError when there is no memory
///
/// Source: RFC 4648.
std::string base64(std::span<std::uint8_t const> bytes);

/// \internal
/// Compresses bytes to base64 of a zlib stream, for embedding in text.
/// \param bytes any
/// \return letters, digits, + and /, padded with =, without line breaks. The bytes of the stream depend on the zlib or
/// libdeflate that GDAL uses; decompression restores the input.
/// \throws BadInput beyond 2^31 - 1 bytes, which older GDALs cannot compress
/// \throws IoError when GDAL fails
///
/// Source: RFC 1950 (zlib), RFC 4648 (base64).
std::string packed(std::span<std::uint8_t const> bytes);

} // namespace thalweg::io
