// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <thalweg/io/mesh/internal/las_ply.hpp>

class OGRSpatialReference;

namespace thalweg::io {

// LAS and LAZ files. Source: ASPRS, LAS specification version 1.4-R15; versions 1.0 to 1.3 differ in what they lack.

/// The format of a point cloud.
enum class CloudFormat : std::uint8_t {
    none,
    las, ///< LAS, LAZ or COPC
    e57
};

/// Tells the format of a file by its first bytes, or, where these name none, by its extension.
/// \return none also for a path that is no file
CloudFormat cloud_format(std::string const& path);

/// \param where "module.function"
/// \throws BadInput that says how to convert the file
[[noreturn]] void refuse_e57(std::string const& path, std::string const& where);

/// What is used of a point record: position in steps of the header's scales, and class.
struct LasPoint {
    std::int32_t x;
    std::int32_t y;
    std::int32_t z;
    std::uint8_t kind;
    bool is_withheld;
};

/// A file's own CRS, as it stands in its variable-length records.
struct LasCrs {
    std::string directory; ///< GeoKeyDirectoryTag, 16-bit numbers; "": none
    std::string doubles;   ///< GeoDoubleParamsTag
    std::string ascii;     ///< GeoAsciiParamsTag
    std::string wkt;       ///< OGC WKT; "": none
    bool is_wkt = false;   ///< which of them holds, if there are both
};

/// The header of a file, checked against its size.
struct LasHeader {
    std::string path;
    std::string name; ///< of the file, for messages
    int minor = 2;    ///< of the version
    int format = 0;   ///< [0, 10] of points
    bool is_compressed = false;
    std::uint64_t points_at = 0;
    std::uint64_t count = 0;  ///< of points; of a compressed file as it says
    std::uint32_t length = 0; ///< [bytes] of a record
    LasAxis x;
    LasAxis y;
    LasAxis z;
    LasCrs crs;

    Vec3 place(LasPoint const& p) const { return {x.read(p.x), y.read(p.y), z.read(p.z)}; }
};

/// Reads the header and the records of the CRS.
/// \throws BadInput naming the file and what is wrong with it: damaged, truncated, a version or format that does not
/// exist
/// \throws IoError when it cannot be read
LasHeader read_las_header(std::string const& path);

/// \return the CRS of a file, with its unit of heights where it has one; empty: none
/// \throws BadInput when its records hold no CRS that GDAL understands
OGRSpatialReference crs_of_las(LasHeader const& header);

/// The points of a file, one after the other.
class LasRecords {
public:
    LasRecords() = default;
    virtual ~LasRecords() = default;
    LasRecords(LasRecords const&) = delete;
    LasRecords& operator=(LasRecords const&) = delete;

    /// Reads the next points.
    /// \param points are replaced; none: all are read
    /// \throws BadInput when the file is damaged
    virtual void next(std::vector<LasPoint>& points) = 0;
};

/// \throws BadInput of a compressed file in a build without LASzip, which says what to do
std::unique_ptr<LasRecords> open_las(LasHeader const& header);

/// The same of a compressed file: read_laz.cpp with LASzip, read_laz_absent.cpp without.
std::unique_ptr<LasRecords> open_laz(LasHeader const& header);

} // namespace thalweg::io
