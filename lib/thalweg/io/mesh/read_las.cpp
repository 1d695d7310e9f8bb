// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/internal/read_las.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/points.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

template <class T> T las_number(char const* bytes) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) {
        std::reverse(raw.begin(), raw.end());
    }
    return std::bit_cast<T>(raw);
}

constexpr char const* damaged = "it is truncated or damaged: copy it again from where it comes";

/// A file that is read at any place, with checks against its size.
class LasFile {
public:
    explicit LasFile(std::string const& path) : name_(fs::path(path).filename().string()) {
        refuse_pipe(path, {"io.read_points", name_});
        std::error_code error;
        refuse_if<BadInput>(!fs::is_regular_file(path, error), "io.read_points", "there is no file {}", path);
        size_ = fs::file_size(path, error);
        file_.open(path, std::ios::binary);
        refuse_if<IoError>(error || !file_, "io.read_points", "{} cannot be opened", path);
    }

    std::string const& name() const { return name_; }
    std::uint64_t size() const { return size_; }

    /// \pre The bytes lie inside the file.
    std::string bytes(std::uint64_t at, std::size_t count) {
        std::string text(count, '\0');
        file_.seekg(static_cast<std::streamoff>(at));
        take(text.data(), count);
        return text;
    }
    void go_to(std::uint64_t at) { file_.seekg(static_cast<std::streamoff>(at)); }
    void take(char* bytes, std::size_t count) {
        file_.read(bytes, static_cast<std::streamsize>(count));
        refuse_if<IoError>(!file_, "io.read_points", "{} cannot be read to its end", name_);
    }

private:
    std::string name_;
    std::uint64_t size_ = 0;
    std::ifstream file_;
};

constexpr std::size_t least_header = 227; // of LAS 1.0 to 1.2; later ones are longer
constexpr std::size_t header_of_1_4 = 375;

/// The least bytes of a record, by point format.
constexpr std::array<std::uint32_t, 11> record_bytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

LasAxis las_axis(std::string const& bytes, std::size_t axis, std::string const& name) {
    LasAxis const read{las_number<double>(bytes.data() + 131 + 8 * axis),
                       las_number<double>(bytes.data() + 155 + 8 * axis)};
    // Beyond these no coordinate of the Earth is meant, and products with 32 bits would not be finite.
    bool const is_scale = read.scale > 0.0 && read.scale <= 1e9;
    refuse_if<BadInput>(!is_scale || !(std::fabs(read.offset) <= 1e15), "io.read_points",
                        "the header of {} has a {} scale of {} and an offset of {}: scales lie above 0, and offsets "
                        "are finite; the file is damaged, write it again",
                        name, "xyz"[axis], read.scale, read.offset);
    return read;
}

/// The numbers at the beginning of the file.
LasHeader las_fixed_part(std::string const& bytes, LasFile const& file) {
    std::string const& name = file.name();
    LasHeader header;
    header.name = name;
    header.minor = static_cast<unsigned char>(bytes[25]);
    refuse_if<BadInput>(bytes[24] != 1 || header.minor > 4, "io.read_points",
                        "{} is LAS {}.{}, and 1.0 to 1.4 are read; convert it: pdal translate IN.las OUT.las "
                        "--writers.las.minor_version=4",
                        name, static_cast<int>(static_cast<unsigned char>(bytes[24])), header.minor);
    auto const format = static_cast<unsigned char>(bytes[104]);
    header.is_compressed = (format & 0xc0U) != 0; // LASzip sets the upper bits
    header.format = format & 0x3fU;
    refuse_if<BadInput>(header.format > 10, "io.read_points",
                        "the points of {} have format {}, and there are 0 to 10; {}", name, header.format, damaged);
    header.length = las_number<std::uint16_t>(bytes.data() + 105);
    std::uint32_t const least = record_bytes[static_cast<std::size_t>(header.format)];
    refuse_if<BadInput>(header.length < least, "io.read_points",
                        "the points of {} are {} bytes long, and those of format {} have at least {}; {}", name,
                        header.length, header.format, least, damaged);
    header.points_at = las_number<std::uint32_t>(bytes.data() + 96);
    header.count = las_number<std::uint32_t>(bytes.data() + 107);
    if (header.minor == 4) {
        auto const large = las_number<std::uint64_t>(bytes.data() + 247);
        header.count = large > 0 ? large : header.count;
    }
    header.x = las_axis(bytes, 0, name);
    header.y = las_axis(bytes, 1, name);
    header.z = las_axis(bytes, 2, name);
    header.crs.is_wkt = (las_number<std::uint16_t>(bytes.data() + 6) & 0x10U) != 0;
    return header;
}

void require_points_inside(LasHeader const& header, std::uint64_t header_size, std::uint64_t size) {
    refuse_if<BadInput>(header.points_at < header_size || header.points_at > size, "io.read_points",
                        "the points of {} begin at byte {}, and the header ends at {}, the file at {}; {}", header.name,
                        header.points_at, header_size, size, damaged);
    std::uint64_t const room = (size - header.points_at) / header.length;
    refuse_if<BadInput>(!header.is_compressed && header.count > room, "io.read_points",
                        "{} has room for {} points, and its header says {}; {}", header.name, room, header.count,
                        damaged);
}

/// One of a file's records besides its points.
struct VariableRecord {
    std::uint64_t at;     ///< of its data
    std::uint64_t length; ///< of its data
    int id;
    bool has_crs; ///< its user is LASF_Projection
};

void keep_crs(LasCrs& crs, VariableRecord const& record, LasFile& file) {
    std::string* const part = !record.has_crs      ? nullptr
                              : record.id == 2112  ? &crs.wkt
                              : record.id == 34735 ? &crs.directory
                              : record.id == 34736 ? &crs.doubles
                              : record.id == 34737 ? &crs.ascii
                                                   : nullptr;
    if (part == nullptr) {
        return;
    }
    constexpr std::uint64_t most_bytes = std::uint64_t{1} << 20U; // WKT of real systems is a hundredth of it
    refuse_if<BadInput>(record.length > most_bytes, "io.read_points", "the CRS of {} is {} bytes long; {}", file.name(),
                        record.length, damaged);
    *part = file.bytes(record.at, static_cast<std::size_t>(record.length));
}

/// Reads records one after the other, each with a header of 54 bytes, or of 60, whose length has 64 bits.
/// \param end of the room for them
void read_records(LasCrs& crs, LasFile& file, std::uint64_t at, std::uint64_t end, std::uint32_t count, bool is_long) {
    std::uint64_t const head = is_long ? 60 : 54;
    for (std::uint32_t i = 0; i < count; ++i) {
        bool const has_head = at <= end && end - at >= head;
        VariableRecord record{at + head, 0, 0, false};
        if (has_head) {
            std::string const bytes = file.bytes(at, static_cast<std::size_t>(head));
            record.has_crs = std::string_view(bytes).substr(2, 16).starts_with("LASF_Projection");
            record.id = las_number<std::uint16_t>(bytes.data() + 18);
            record.length =
                is_long ? las_number<std::uint64_t>(bytes.data() + 20) : las_number<std::uint16_t>(bytes.data() + 20);
        }
        refuse_if<BadInput>(!has_head || record.length > end - record.at, "io.read_points",
                            "variable-length record {} of {} of {}, at byte {}, reaches beyond byte {}; {}", i + 1,
                            count, file.name(), at, end, damaged);
        keep_crs(crs, record, file);
        at = record.at + record.length;
    }
}

/// A field of a TIFF with so many numbers; those that do not fit into it stand elsewhere.
void put_tiff_field(std::string& bytes, std::uint16_t tag, std::uint16_t type, std::uint32_t count,
                    std::uint32_t value) {
    put_number(bytes, tag);
    put_number(bytes, type);
    put_number(bytes, count);
    put_number(bytes, value);
}

/// A TIFF of one cell with the GeoTIFF keys: GDAL reads keys from such files only.
std::string tiff_of_keys(LasCrs const& crs) {
    constexpr std::uint16_t ascii = 2;
    constexpr std::uint16_t whole = 3;
    constexpr std::uint16_t real = 12;
    std::string const doubles = crs.doubles.substr(0, crs.doubles.size() / 8 * 8);
    std::string const words = crs.ascii + std::string(crs.ascii.size() < 4 ? 4 : 1, '\0'); // longer than a field
    auto const fields = static_cast<std::uint16_t>(doubles.empty() ? 11 : 12);
    auto const keys_at = static_cast<std::uint32_t>(8 + 2 + 12 * fields + 4);
    auto const doubles_at = static_cast<std::uint32_t>(keys_at + crs.directory.size());
    auto const words_at = static_cast<std::uint32_t>(doubles_at + doubles.size());
    auto const cell_at = static_cast<std::uint32_t>(words_at + words.size());
    std::string bytes("II*\0\x08\0\0\0", 8);
    put_number(bytes, fields);
    put_tiff_field(bytes, 256, whole, 1, 1); // columns
    put_tiff_field(bytes, 257, whole, 1, 1); // rows
    put_tiff_field(bytes, 258, whole, 1, 8); // bits of a sample
    put_tiff_field(bytes, 259, whole, 1, 1); // not compressed
    put_tiff_field(bytes, 262, whole, 1, 1); // black is 0
    put_tiff_field(bytes, 273, 4, 1, cell_at);
    put_tiff_field(bytes, 277, whole, 1, 1); // samples of a cell
    put_tiff_field(bytes, 278, whole, 1, 1); // rows of a strip
    put_tiff_field(bytes, 279, 4, 1, 1);     // bytes of the strip
    put_tiff_field(bytes, 34735, whole, static_cast<std::uint32_t>(crs.directory.size() / 2), keys_at);
    if (!doubles.empty()) {
        put_tiff_field(bytes, 34736, real, static_cast<std::uint32_t>(doubles.size() / 8), doubles_at);
    }
    put_tiff_field(bytes, 34737, ascii, static_cast<std::uint32_t>(words.size()), words_at);
    put_number(bytes, std::uint32_t{0});
    return bytes + crs.directory + doubles + words + '\0';
}

[[noreturn]] void refuse_crs(LasHeader const& header, char const* what, std::string const& words) {
    throw BadInput("io.read_points",
                   fmt::format("the CRS of {} ({}) is not understood{}; write it again: pdal translate "
                               "IN.las OUT.las --writers.las.a_srs=EPSG:n",
                               header.name, what, words.empty() ? "" : ": " + words));
}

/// Whether the directory holds as many keys as it says.
bool is_directory_whole(std::string const& directory) {
    return directory.size() >= 8 && directory.size() % 2 == 0 &&
           directory.size() >= 8 + std::size_t{8} * las_number<std::uint16_t>(directory.data() + 6);
}

OGRSpatialReference crs_of_keys(LasHeader const& header) {
    constexpr char const* what = "GeoTIFF keys";
    if (!is_directory_whole(header.crs.directory)) {
        refuse_crs(header, what, "their directory is shorter than it says");
    }
    std::string const tiff = tiff_of_keys(header.crs);
    Driver const driver;
    MemoryFile const memory;
    VSILFILE* const file = VSIFOpenL(memory.path().c_str(), "wb");
    bool const is_written = file != nullptr && VSIFWriteL(tiff.data(), 1, tiff.size(), file) == tiff.size();
    if (file != nullptr) {
        VSIFCloseL(file);
    }
    refuse_if<IoError>(!is_written, "io.read_points", "the CRS of {} does not fit into memory", header.name);
    CPLConfigOptionSetter const with_heights("GTIFF_REPORT_COMPD_CS", "YES", false);
    std::array<char const*, 2> const drivers{"GTiff", nullptr};
    Dataset const data(GDALDataset::Open(memory.path().c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR, drivers.data()));
    OGRSpatialReference const* const found = data ? data->GetSpatialRef() : nullptr;
    std::string const words = driver.take();
    if (found == nullptr) {
        refuse_crs(header, what, words);
    }
    OGRSpatialReference crs(*found);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

OGRSpatialReference crs_of_wkt(LasHeader const& header) {
    std::string const text = header.crs.wkt.substr(0, header.crs.wkt.find('\0'));
    try {
        return read_reference(text);
    } catch (BadInput const& error) {
        refuse_crs(header, "OGC WKT", error.what());
    }
}

bool has_text(std::string const& wkt) {
    return wkt.substr(0, wkt.find('\0')).find_first_not_of(" \t\r\n") != std::string::npos;
}

class PlainRecords : public LasRecords {
public:
    explicit PlainRecords(LasHeader const& header) : file_(header.path), header_(header), left_(header.count) {
        file_.go_to(header.points_at);
    }

    void next(std::vector<LasPoint>& points) override {
        constexpr std::size_t bytes_a_time = std::size_t{1} << 22U;
        std::size_t const length = header_.length;
        auto const count =
            static_cast<std::size_t>(std::min<std::uint64_t>(left_, std::max<std::size_t>(bytes_a_time / length, 1)));
        bytes_.resize(count * length);
        file_.take(bytes_.data(), bytes_.size());
        points.resize(count);
        bool const is_old = header_.format < 6;
        for (std::size_t i = 0; i < count; ++i) {
            char const* const at = bytes_.data() + i * length;
            auto const flags = static_cast<unsigned char>(at[15]);
            points[i] = {las_number<std::int32_t>(at), las_number<std::int32_t>(at + 4),
                         las_number<std::int32_t>(at + 8),
                         is_old ? static_cast<std::uint8_t>(flags & 0x1fU) : static_cast<std::uint8_t>(at[16]),
                         (flags & (is_old ? 0x80U : 0x04U)) != 0};
        }
        left_ -= count;
    }

private:
    LasFile file_;
    LasHeader const& header_;
    std::uint64_t left_;
    std::string bytes_;
};

} // namespace

CloudFormat cloud_format(std::string const& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        return CloudFormat::none;
    }
    std::array<char, 8> first{};
    std::ifstream file(path, std::ios::binary);
    file.read(first.data(), first.size());
    std::string_view const bytes(first.data(), first.size());
    std::string const ending = lower_extension(path);
    if (bytes.starts_with("LASF")) {
        return CloudFormat::las;
    }
    if (bytes == "ASTM-E57") {
        return CloudFormat::e57;
    }
    return ending == ".las" || ending == ".laz" ? CloudFormat::las : CloudFormat::none;
}

bool is_point_cloud(std::string const& path) {
    return cloud_format(path) != CloudFormat::none;
}

void refuse_e57(std::string const& path, std::string const& where) {
    throw BadInput(where, fmt::format("{} is E57, which is not read; convert it: pdal translate {} {}", path,
                                      for_shell(path), for_shell(fs::path(path).replace_extension(".las").string())));
}

LasHeader read_las_header(std::string const& path) {
    LasFile file(path);
    refuse_if<BadInput>(file.size() < least_header, "io.read_points",
                        "{} is {} bytes long, and the header of LAS alone has {}; {}", file.name(), file.size(),
                        least_header, damaged);
    std::string bytes = file.bytes(0, static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), header_of_1_4)));
    refuse_if<BadInput>(!bytes.starts_with("LASF"), "io.read_points", "{} is not LAS: it does not begin with LASF",
                        file.name());
    std::uint64_t const size = las_number<std::uint16_t>(bytes.data() + 94);
    bool const is_1_4 = bytes[24] == 1 && bytes[25] == 4;
    std::size_t const least = is_1_4 ? header_of_1_4 : least_header;
    refuse_if<BadInput>(size < least || bytes.size() < least, "io.read_points",
                        "the header of {} is {} bytes long, and that of its version has {}; {}", file.name(),
                        std::min<std::uint64_t>(size, file.size()), least, damaged);
    LasHeader header = las_fixed_part(bytes, file);
    header.path = path;
    require_points_inside(header, size, file.size());
    read_records(header.crs, file, size, header.points_at, las_number<std::uint32_t>(bytes.data() + 100), false);
    if (auto const long_ones = is_1_4 ? las_number<std::uint32_t>(bytes.data() + 243) : 0U; long_ones > 0) {
        auto const at = las_number<std::uint64_t>(bytes.data() + 235);
        read_records(header.crs, file, at, file.size(), long_ones, true);
    }
    return header;
}

OGRSpatialReference crs_of_las(LasHeader const& header) {
    LasCrs const& crs = header.crs;
    bool const has_keys = !crs.directory.empty();
    if (has_text(crs.wkt) && (crs.is_wkt || !has_keys)) {
        return crs_of_wkt(header);
    }
    bool const is_empty =
        !has_keys || (is_directory_whole(crs.directory) && las_number<std::uint16_t>(crs.directory.data() + 6) == 0);
    return is_empty ? OGRSpatialReference() : crs_of_keys(header);
}

std::unique_ptr<LasRecords> open_las(LasHeader const& header) {
    return header.is_compressed ? open_laz(header) : std::make_unique<PlainRecords>(header);
}

} // namespace thalweg::io
